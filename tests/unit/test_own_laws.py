"""Laws from outside the package: examples/own_laws.py, by itself and many abreast."""

import subprocess
import sys
from dataclasses import replace
from importlib import util
from pathlib import Path

import numpy as np
import pytest

import railquake as rq
from railquake.assembly.hinge import drive_hinge
from railquake.laws import CREEP_LAWS, HINGE_LAWS
from railquake.march.compiler import PYTHON, bind
from railquake.march.slots import chosen
from railquake.physics.patch import patch_forces

EXAMPLE = Path(__file__).parents[2] / "examples" / "own_laws.py"


@pytest.fixture(scope="module")
def own():
    """The example as a module; its laws are gone again afterwards."""
    known = [(family, dict(family._laws)) for family in (CREEP_LAWS, HINGE_LAWS) if family.names()]
    spec = util.spec_from_file_location("own_laws", EXAMPLE)
    module = util.module_from_spec(spec)
    sys.modules["own_laws"] = module
    spec.loader.exec_module(module)
    yield module
    for family, laws in known:
        family._laws.clear()
        family._laws.update(laws)
    del sys.modules["own_laws"]


def test_example_runs_as_it_stands():
    """Single and abreast, compiled."""
    done = subprocess.run([sys.executable, str(EXAMPLE)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[0].startswith("by itself: ")
    assert "plastic rotation at the end 0.0000 mrad" not in lines[0]
    rows = {line.split(":")[0]: line.split(":")[1] for line in lines}
    assert set(rows) == {"by itself", *(f"abreast {k}" for k in range(4))}
    # the same scenario both ways, but for the longer step of the structure
    alone, abreast = (
        float(rows[name].split(",")[1].split()[0]) for name in ("by itself", "abreast 0")
    )
    assert abreast == pytest.approx(alone, rel=2e-3)


def test_own_hinge_follows_its_equations(own):
    """Bilinear with kinematic hardening: k0 = 2, yields at 1, goes on with a tenth of k0."""
    values = own.Bilinear(k0=2.0, yield_moment=1.0, hardening=0.1)
    path = np.array([0.25, 0.5, 1.5, 0.5, -0.5, 0.0])
    driven = drive_hinge("bilinear", values, path, tolerance=1e-6, iterations=1)
    # elastic to 1 at 0.5; 1 + 0.2 at 1.5; elastic back by 2; then along the other side
    assert driven.moment == pytest.approx([0.5, 1.0, 1.2, -0.8, -1.0, 0.0], abs=1e-12)
    # with an elastic column over it the same moments belong to larger rotations
    bent = drive_hinge(
        "bilinear", values, path + 0.3 * driven.moment, tolerance=1e-6, iterations=1,
        flexibility=0.3,
    )  # fmt: skip
    assert bent.moment == pytest.approx(driven.moment, abs=1e-12)


def test_own_rows_are_kept_and_shown(own):
    system = rq.assemble(own.case())
    system = replace(system, drive=2.0 * system.drive[1500:1512])
    response = rq.simulate(system, target=PYTHON)
    assert response.system.choices["hinge law"] == "bilinear"
    assert response.history["hinge_plastic_rotation_rad"].attrs["units"] == "rad"
    assert "hinge_z_rad" not in response.history


def test_own_creep_law_stands_in_the_slot(own):
    saturation = own.smooth
    assert saturation(1e-9, 1.0) == 1.0
    assert saturation(5.0, 10.0) * 5.0 == pytest.approx(10.0 * np.tanh(0.5), rel=1e-12)
    bound = bind(patch_forces, PYTHON, chosen({"creep law": "tanh"})).call
    on_tread, on_flange = (bound.__globals__[f"bound_on_{zone}"] for zone in ("tread", "flange"))
    assert on_tread.__globals__["saturation"].__code__ is saturation.__code__
    assert on_flange.__globals__["flange_saturation"].__code__ is not saturation.__code__


def test_name_that_is_taken_is_refused(own):
    with pytest.raises(rq.InputError, match='creep law "tanh" already'):
        CREEP_LAWS.add(CREEP_LAWS["tanh"]._replace(source="another"))


def test_unknown_law_names_those_that_are_there(own):
    with pytest.raises(rq.InputError, match='there is no "takeda"; known: .*"bilinear"'):
        rq.scenario(synthetic={"seed": 1}, support={"preset": "bart-berkeley", "hinge": "takeda"})
