"""The commands: a column from end to end, a measured loop, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest

import railquake as rq
from railquake.calibration import (
    calibrate_column,
    column_flexibility,
    drive_hinge,
    load_column,
)
from railquake.calibration.calibrate import effective_flexural_stiffness
from railquake.cli import main
from railquake.inputs.support import Pier

EXAMPLE = Path(__file__).parents[3] / "examples" / "column.toml"

SMALL = """
name = "small-column"
support = "bart-berkeley"
[section]
shape = "circular"
diameter = "1.25 m"
cover = "50 mm"
longitudinal_ratio = 0.02
transverse_ratio = 0.007
[concrete]
strength = "34.5 MPa"
[steel]
yield_strength = "331 MPa"
hoop_strength = "331 MPa"
[protocol]
drifts = [0.005, 0.01, 0.02]
cycles = 1
increment = 5e-4
[[motions]]
synthetic = { seed = 2, duration = "4 s", pga = "0.5 g", highpass_frequency = "0.4 Hz" }
"""


def refused(capsys, *arguments):
    """The single line with which a command is refused."""
    assert main(["calibrate", *(str(a) for a in arguments)]) == 2
    lines = [
        line
        for line in capsys.readouterr().err.splitlines()
        if not line.endswith("...")  # what is being done
    ]
    assert len(lines) == 1, lines
    return lines[0]


@pytest.fixture
def column_file(tmp_path):
    path = tmp_path / "column.toml"
    path.write_text(SMALL)
    return path


@pytest.fixture
def loop_file(tmp_path, known_hinge, cycles):
    """A specimen with the preset's elastic column."""
    pier = Pier.from_preset("bart-berkeley")
    flexibility = column_flexibility(pier.youngs_modulus, pier.second_moment_of_area, pier.length)
    moment = drive_hinge(known_hinge, cycles, flexibility, substeps=10)
    path = tmp_path / "test.csv"
    rows = [
        f"{1e3 * float(u)!r},{1e-3 * float(f)!r}"
        for u, f in zip(6.0 * cycles, moment / 6.0, strict=True)
    ]
    path.write_text("\n".join(["displacement_mm,force_kN", *rows]) + "\n")
    return path


def test_column_from_end_to_end(column_file, tmp_path, capsys, opensees):
    out = tmp_path / "fit"
    assert main(["calibrate", "column", str(column_file), "--out", str(out), "--starts", "2"]) == 0
    printed = capsys.readouterr().out
    assert "loop misfit" in printed and "bart-berkeley" in printed and "synthetic-2" in printed
    names = {path.name for path in out.iterdir()}
    assert names == {"hinge.toml", "fit.json", "loops.png", "histories.png", "parameters.png"}
    row = json.loads((out / "fit.json").read_text())
    assert row["misfit"]["over_peak"]
    assert row["misfit"]["over_rms"] > row["misfit"]["over_peak"]
    assert len(row["parameters"]) == 13
    assert set(row["bounds_touched"]) <= {p["name"] for p in row["parameters"]}
    (check,) = row["checks"]
    assert abs(check["peak_error"]) < 0.5
    # the calibrated pier stands in a scenario, with its provenance
    pier = Pier.from_preset(str(out / "hinge.toml"))
    assert "a fibre model of the column in OpenSees" in pier.source
    assert "hinge rotations up to" in pier.note
    motion = {"seed": 2, "duration": "2 s", "pga": "0.3 g", "highpass_frequency": "0.6 Hz"}
    case = rq.scenario(support=str(out / "hinge.toml"), synthetic=motion, dt="5e-5 s")
    assert rq.assess(rq.simulate(case))["status"] == "safe"


def test_measured_loop_from_end_to_end(loop_file, known_hinge, tmp_path, capsys):
    out = tmp_path / "fit"
    arguments = ["--cyclic", loop_file, "--length", "6 m", "--out", out, "--starts", "1"]
    arguments += ["--source", "a made loop", "--json"]
    assert main(["calibrate", "hinge", *(str(a) for a in arguments)]) == 0
    row = json.loads(capsys.readouterr().out)
    assert row == json.loads((out / "fit.json").read_text())
    assert row["misfit"]["over_peak"] < 0.01
    assert row["checks"] == [] and row["fibre_column"] is None
    pier = Pier.from_preset(str(out / "hinge.toml"))
    assert pier.bouc_wen.k0 == pytest.approx(known_hinge.k0, rel=0.1)
    assert "a measured loop" in pier.summary and "a made loop" in pier.source
    assert not (out / "histories.png").exists()


def test_a_former_calibration_in_the_folder_is_replaced(loop_file, tmp_path, capsys):
    out = tmp_path / "fit"
    out.mkdir()
    (out / "histories.png").write_text("former")
    (out / "notes.txt").write_text("mine")
    arguments = ["--cyclic", loop_file, "--length", "6 m", "--out", out, "--starts", "1"]
    assert main(["calibrate", "hinge", *(str(a) for a in arguments)]) == 0
    names = {path.name for path in out.iterdir()}
    assert names == {"hinge.toml", "fit.json", "loops.png", "parameters.png", "notes.txt"}


def test_flexural_stiffness_of_an_elastic_column_over_any_hinge():
    length, stiffness = 6.0, 3e9
    moment = np.linspace(0.0, 5e6, 40)[1:]
    hinge = 0.02 * (moment / 5e6) ** 3
    chord = hinge + moment * length / (3.0 * stiffness)
    top = hinge + moment * length / (2.0 * stiffness)
    found = effective_flexural_stiffness(chord, moment, top, length)
    assert found == pytest.approx(stiffness, rel=1e-12)


def test_example_is_a_column():
    column = load_column(EXAMPLE)
    assert column.pier().length / column.section.diameter == pytest.approx(4.8)
    assert len(column.motions) == 3


def test_bare_numbers_are_si_at_the_command_line(loop_file, tmp_path, capsys):
    arguments = ["--cyclic", loop_file, "--length", "6.0", "--out", tmp_path / "o", "--starts", "1"]
    assert main(["calibrate", "hinge", *(str(a) for a in arguments)]) == 0


def test_wrong_inputs_are_one_line(column_file, loop_file, tmp_path, capsys, monkeypatch):
    text = column_file.read_text()
    heavy = tmp_path / "heavy.toml"
    heavy.write_text(text.replace('support = "bart', 'axial_load = "90 MN"\nsupport = "bart'))
    assert "cannot carry its axial load of 9e+04 kN" in refused(capsys, "column", heavy)
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(text.replace("diameter", "diametre"))
    assert f"{wrong}: section.diametre: unknown key" in refused(capsys, "column", wrong)
    lost = tmp_path / "lost.toml"
    lost.write_text(text.replace("synthetic = {", 'record = "none.AT2" #'))
    assert "none.AT2" in refused(capsys, "column", lost)
    assert "cannot be read" in refused(capsys, "column", tmp_path / "no.toml")
    unknown = tmp_path / "unknown.toml"
    unknown.write_text(text.replace("bart-berkeley", "bart-oakland"))
    assert "bart-oakland" in refused(capsys, "column", unknown)
    assert "--length" in refused(capsys, "hinge", "--cyclic", loop_file)
    assert "--young: must be a pressure" in refused(
        capsys, "hinge", "--cyclic", loop_file, "--length", "6 m", "--young", "3 m"
    )
    out = tmp_path / "file"
    out.write_text("")
    assert "is no folder" in refused(
        capsys, "hinge", "--cyclic", loop_file, "--length", "6 m", "--out", out
    )
    monkeypatch.setitem(__import__("sys").modules, "opensees.openseespy", None)
    assert "pip install railquake[fem]" in refused(
        capsys, "column", column_file, "--out", tmp_path / "x"
    )
    assert not (tmp_path / "x").exists()


def test_both_models_move_and_resist_the_same_way(column_file, opensees):
    found = calibrate_column(load_column(column_file), starts=1)
    (check,) = found.checks
    assert len(check.time) == len(check.reference) == len(check.ours)
    assert np.corrcoef(check.reference, check.ours)[0, 1] > 0.8
    assert np.corrcoef(check.reference_moment, check.moment)[0, 1] > 0.8
    assert check.peak_error == pytest.approx(
        np.abs(check.ours).max() / np.abs(check.reference).max() - 1.0
    )
    # the hinge carries what the column lacks: the same column as the fibres' own
    assert found.pier.bouc_wen == found.fit.hinge
    assert found.pier.mass == found.former.mass
    stiffness = found.pier.youngs_modulus * found.pier.second_moment_of_area
    assert 1e9 < stiffness < 4e9  # cracked, below Ec Ig = 3.3e9 with bars


def test_soft_elastic_column_is_refused(column_file, opensees):
    column = load_column(column_file).model_copy(update={"second_moment_of_area": 0.01})
    with pytest.raises(rq.InputError, match="nothing is left to a hinge"):
        calibrate_column(column, check=False)
