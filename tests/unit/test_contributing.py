"""The examples of CONTRIBUTING.md, "Where does this go?", put where they say and run."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import railquake

ROOT = Path(__file__).parents[2]
GUIDE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
BLOCKS = [
    (first.removeprefix("# "), body)
    for first, _, body in (
        block.partition("\n") for block in re.findall(r"```python\n(.*?)```", GUIDE, re.DOTALL)
    )
]

# What a block says beside its path: where it stands in a file that is there.
BEFORE = {
    "inputs/vehicle.py": "class Vehicle(FromPreset)",
    "assembly/vehicle.py": "    return VehicleMatrices(names",
    "inputs/support.py": "Support = Annotated[",
    "measures/train.py": '    Measure(\n        "flange_clearance_peak_m"',
    "march/peaks.py": "    raise_peak(S, state.PEAK_LOAD",
}
# ... and what it only tells of.
TOLD = {
    "inputs/vehicle.py": [
        ("    wheelset: Annotated[", "    roll_dashpots: Annotated[tuple[RollDashpot, ...], "
         'ByName(), Field(description="Roll dashpots")] = ()\n    wheelset: Annotated['),
    ],
    "inputs/support.py": [
        ("Pier | AtGrade | PrescribedTrack,", "Pier | AtGrade | PrescribedTrack | Isolated,"),
        ("    PositivePressure,\n", "    PositivePressure,\n    PositiveStiffness,\n"),
    ],
}  # fmt: skip

# Runs that use them, by what they set.
PIER = {"preset": "bart-berkeley"}
RUNS = {
    "creep": {"wheelrail": {"preset": "bart", "creep_law": "smooth"}},
    "restitution": {"wheelrail": {"preset": "bart", "restitution_law": "lankarani"}},
    "hinge": {
        "support": {
            **PIER, "hinge": "plastic", "plastic": {"k0": "38432 MN m/rad", "capacity": "1.2 MN m"}
        }
    },
    "element": {
        "vehicle": {
            "preset": "bart",
            "roll_dashpots": {"own": {"bodies": ["car", "bogie"], "damping": 2e5}},
        }
    },
    "support": {"support": {"kind": "isolated", "mass": "300 t", "stiffness": "12 MN/m"}},
}  # fmt: skip

SCRIPT = """
import json, sys
from dataclasses import replace
import railquake as rq
from railquake.findings.claims import every_claim
from railquake.march.compiler import PYTHON

found = {"claims": [claim.says for claim in every_claim()]}
for name, changes in json.loads(sys.argv[1]).items():
    motion = {"seed": 1, "duration": "6 s", "pga": "1.2 g"}
    system = rq.assemble(rq.scenario(synthetic=motion, contact="grid", dt="5e-5 s", **changes))
    drive = 0.0 * system.drive[:9]
    drive[1:, 0] = 80.0  # m/s2
    system = replace(system, drive=drive)
    response = rq.simulate(system, target=PYTHON)
    history = response.history
    found[name] = {
        **{key: value for key, value in rq.assess(response).items() if key != "versions"},
        "choices": system.choices,
        "channels": list(history),
        "roll_damping": system.vehicle.damping[2, 2],
    }
print(json.dumps(found))
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    """A copy of the package with every block in its place, and the files that each section took."""
    root = tmp_path_factory.mktemp("contributed") / "railquake"
    source = Path(railquake.__file__).parent
    shutil.copytree(source, root, ignore=shutil.ignore_patterns("__pycache__"))
    for title, body in BLOCKS:
        path, _, _ = title.partition(",")
        file = root / path
        if not file.exists():
            file.write_text(body, encoding="utf-8")
            continue
        text = file.read_text(encoding="utf-8")
        for former, new in TOLD.get(path, ()):
            assert text.count(former) == 1, (path, former)
            text = text.replace(former, new)
        mark = BEFORE.get(path)
        assert mark is None or text.count(mark) == 1, path
        joined = text + "\n\n" + body if mark is None else text.replace(mark, body + "\n\n" + mark)
        file.write_text(joined, encoding="utf-8")
    return root


@pytest.fixture(scope="module")
def found(package):
    runs = {"plain": {}, **RUNS}
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, json.dumps(runs)],
        env={**os.environ, "PYTHONPATH": str(package.parent)},
        capture_output=True, text=True, cwd=package.parent,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_each_takes_the_files_that_the_table_says():
    taken = {}
    for part in GUIDE.partition("## Where does this go?")[2].split("\n### ")[1:]:
        name, _, text = part.partition("\n")
        text = text.partition("\n## ")[0]
        taken[name] = len(set(re.findall(r"```python\n# ([\w/.]+)", text)))
    table = dict(re.findall(r"^\| ([^|]+?) \| (\d) \|", GUIDE, re.MULTILINE))
    assert taken == {
        "A creep law": int(table["creep law"]),
        "A restitution law": int(table["restitution law"]),
        "A hinge law": int(table["hinge law with its own state"]),
        "A force element": int(table["linear force element between bodies"]),
        "A kind of support": int(table["kind of support"]),
        "A measure": int(table["measure of a run"]),
        "A finding": int(table["finding of the report"]),
    }


def test_laws_stand_in_their_slots(found):
    assert found["creep"]["choices"]["creep law"] == "smooth"
    assert found["restitution"]["choices"]["restitution law"] == "lankarani"
    assert found["hinge"]["choices"]["hinge law"] == "plastic"
    assert all(found[name]["status"] == "safe" for name in ("plain", *RUNS))


def test_the_hinge_is_cut_off_and_shows_its_state(found):
    assert found["plain"]["base_moment_peak_n_m"] > 1.21e6
    assert found["hinge"]["base_moment_peak_n_m"] == pytest.approx(1.2e6, rel=1e-12)
    assert "hinge_plastic_rotation_rad" in found["hinge"]["channels"]


def test_the_dashpot_damps_the_roll(found):
    more = found["element"]["roll_damping"] - found["plain"]["roll_damping"]
    assert more == pytest.approx(2e5, rel=1e-9)


def test_the_deck_moves_on_its_bearings(found):
    assert found["support"]["choices"]["structure"] == "node"
    assert found["support"]["pbd_m"] > 1e-5


def test_the_measure_is_in_every_row(found):
    assert all(found[name]["roll_rate_peak_rad_s"] > 0.0 for name in ("plain", *RUNS))


def test_the_finding_is_known(found):
    assert "A yielding pier makes derailment less likely." in found["claims"]
