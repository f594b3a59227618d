"""One component by itself, as the command line offers it."""

import csv
import json
import math

import numpy as np
import pytest

from railquake.assembly import vehicle_matrices
from railquake.cli import main
from railquake.errors import InputError
from railquake.inputs.hinge import BoucWenHinge
from railquake.inputs.vehicle import Vehicle
from railquake.inputs.wheelrail import WheelRail
from railquake.physics.hertz import effective_modulus, hertz_coefficients
from railquake.physics.hinge import HINGE_LAWS
from railquake.physics.hinge.bouc_wen import pinched_stiffness
from railquake.probe import creep_force, mode_labels, run_hinge, standing_wheelset

CONTACT_STEEL = {"youngs_modulus": 209.92e9, "poisson_ratio": 0.28}
# The parameters in the header of dev_generic.csv.
GENERIC = (
    "m=1 Fy=1 xu=10 alpha=0.05 k0=1 n=1.5 eta0=0 beta0=1 rho_eps=0.1 rho_x=0.2 phi=0.5 "
    "delta_k=0.4 delta_f=0.1 sigma=1 u=2 eps_p=1 rho_p=0.3"
)


def columns(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


@pytest.mark.parametrize(("name", "changes"), [("dev_hinge", "m=1"), ("dev_generic", GENERIC)])
def test_hinge_follows_opensees_in_every_step(shared, tmp_path, name, changes):
    """OpenSees' DegradingPinchedBW, shared/oracles: within 1e-9 of the peak, from file to file."""
    path, out = shared / "oracles" / f"{name}.csv", tmp_path / "m.csv"
    sets = [word for change in changes.split() for word in ("--set", change)]
    arguments = ["--preset", "bart-berkeley", "--path", str(path), "--out", str(out), *sets]
    assert main(["probe", "hinge", *arguments]) == 0
    expected, found = columns(path), columns(out)
    assert np.array_equal(found["x"], expected["x"])
    for ours, theirs in (("moment", "F"), ("z", "z_own"), ("damage", "damage_own")):
        peak = np.abs(expected[theirs]).max()
        assert np.abs(found[ours] - expected[theirs]).max() < 1e-9 * peak, ours


def berkeley(**changes):
    values = {
        "Fy": 38.432e6, "xu": 0.01, "alpha": 0.007, "k0": 3.8432e10, "n": 1.28, "eta0": 0.0,
        "beta0": 17000.0, "rho_eps": 0.0, "rho_x": 0.25, "phi": 1.6, "delta_k": 15.0,
        "delta_f": 0.5, "sigma": 0.01, "u": 4.0, "eps_p": 0.001, "rho_p": 0.1, "m": 1.0,
    }  # fmt: skip
    return BoucWenHinge.model_validate(values | changes)


def test_standing_still_evaluates_the_pinching_anew():
    """A repeated rotation keeps z, but kp is that of the energy at the step's end."""
    hinge = berkeley(rho_p=0.8)
    path = np.concatenate([np.linspace(0.0, 5e-3, 100), [5e-3, 5e-3]])
    moment, z, _ = run_hinge(hinge, path).T
    assert z[-2] == z[-3] and moment[-2] != moment[-3]
    assert moment[-1] == moment[-2]
    step = np.diff(path, prepend=0.0)
    eps = 0.0
    for k in range(100):
        kp = moment[k] / (hinge.alpha * path[k] + (1 - hinge.alpha) * z[k]) if k else hinge.k0
        eps += (1.0 - hinge.alpha) * kp * z[k] * step[k] / hinge.m
    kp = pinched_stiffness(5e-3, eps, HINGE_LAWS["bouc-wen"].parameters(hinge, 1e-13, 200))
    expected = kp * (hinge.alpha * 5e-3 + (1.0 - hinge.alpha) * z[-1])
    assert moment[-1] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("largest", [1e3, 1e300])
def test_steps_out_of_reach_are_refused_by_row(largest):
    with pytest.raises(InputError, match="row 2"):
        run_hinge(berkeley(), np.array([0.0, largest]))


def test_default_path_is_cyclic(capsys):
    assert main(["probe", "hinge", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found) == {"x", "moment", "z", "damage"}
    assert min(found["x"]) == pytest.approx(-max(found["x"]))
    assert found["x"][-1] == 0.0


def test_elastic_hinge(capsys):
    assert main(["probe", "hinge", "--hinge", "elastic", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["moment"] == pytest.approx([3.8432e10 * x for x in found["x"]], rel=1e-12)


# --- contact -----------------------------------------------------------------------------------


@pytest.mark.parametrize("load", ["5e3", "20e3", "50e3", "150e3"])
def test_normal_law_of_s1002_on_60e1(capsys, load):
    """N/delta^1.5 = 1.5e11 within 10 %, CONTACT's steel (the bar set for this pair)."""
    steel = ["--young", "209.92e9", "--poisson", "0.28", "--gauge", "1.435"]
    arguments = ["--preset", "s1002-60e1", "--shift", "0.0", "--load", load, *steel, "--json"]
    assert main(["probe", "contact", *arguments]) == 0
    for row in json.loads(capsys.readouterr().out):
        assert row["normal_n"] / row["approach_m"] ** 1.5 == pytest.approx(1.5e11, rel=0.1)
        assert row["normal_n"] * math.cos(row["angle_rad"]) == pytest.approx(float(load), rel=1e-6)


def test_half_length_in_the_rolling_direction_against_contact(shared):
    """CONTACT (exact), left wheel, one element of its grid or 3 %; nearly conformal ones apart."""
    pair = WheelRail.from_preset("s1002-60e1", CONTACT_STEEL)
    with open(shared / "oracles" / "contact_normal.csv", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    compared = 0
    for row in rows:
        if row["y_ws_mm"] not in ("-3", "1", "3", "5"):
            continue
        shift, load = 1e-3 * float(row["y_ws_mm"]), 1e3 * float(row["FZ_track_kN"])
        (left,) = [p for p in standing_wheelset(pair, shift, load).patches if p.side == "left"]
        length = 1e-3 * float(row["half_length_x_mm"])
        assert left.a_m == pytest.approx(length, rel=0.03, abs=1e-3 * float(row["dx_mm"]))
        assert left.approach_m == pytest.approx(1e-3 * float(row["pen_mm"]), rel=0.05)
        assert left.angle_rad == pytest.approx(float(row["angle_rad"]), abs=0.006)
        assert left.y_m == pytest.approx(1e-3 * float(row["y_cp_track_mm"]), abs=2e-3)
        compared += 1
    assert compared == 12


@pytest.mark.parametrize("preset", ["bart", "s1002-60e1"])
@pytest.mark.parametrize("shift", [-0.02, -0.0085, -0.006, 0.0, 0.003, 0.012])
def test_each_wheel_bears_its_load(preset, shift):
    standing = standing_wheelset(WheelRail.from_preset(preset), shift, 40e3)
    for side in ("left", "right"):
        carried = sum(
            p.normal_n * math.cos(p.angle_rad) for p in standing.patches if p.side == side
        )
        assert carried == pytest.approx(40e3, rel=1e-6)


def test_flange_touches_on_the_side_it_is_shifted_to():
    pair = WheelRail.from_preset("bart")
    right = standing_wheelset(pair, 0.0085, 50e3)
    left = standing_wheelset(pair, -0.0085, 50e3)
    flange = max(right.patches, key=lambda patch: patch.angle_rad)
    assert flange.side == "right"
    assert math.degrees(flange.angle_rad) == pytest.approx(43.0, abs=3.0)
    assert max(left.patches, key=lambda patch: patch.angle_rad).side == "left"
    assert left.roll == pytest.approx(-right.roll, abs=1e-12)
    assert left.height == pytest.approx(right.height, abs=1e-12)


def test_semi_axes_are_those_of_hertz():
    """physics.md, Eq. 6: radii 460 and 300 mm, 50 kN, a 5.709 and b 4.294 mm, a along x."""
    load, radii = 50e3, (0.460, 0.300)
    rolling, lateral = (0.5 / radius for radius in radii)
    total = rolling + lateral
    m, n, _ = hertz_coefficients(np.array([math.acos((rolling - lateral) / total)]))
    size = (3.0 * load / (4.0 * effective_modulus(209.92e9, 0.28) * total)) ** (1.0 / 3.0)
    assert 1e3 * m[0] * size == pytest.approx(5.709, abs=1e-3)
    assert 1e3 * n[0] * size == pytest.approx(4.294, abs=1e-3)


@pytest.mark.parametrize(("shift", "load"), [(0.0, 1e7), (0.1, 1e3), (0.4, 1e3), (-0.1, 5e4)])
def test_wheelset_that_cannot_stand_is_refused(shift, load):
    with pytest.raises(InputError, match="take a smaller"):
        standing_wheelset(WheelRail.from_preset("bart"), shift, load)


# --- creep and modes ---------------------------------------------------------------------------


@pytest.mark.parametrize("law", ["coulomb", "she", "carter", "polach", "fastsim"])
def test_creep_force_opposes_creepage_and_spin_and_ends_at_friction(law):
    given = ((6e-3, 5e-3), 50e3)
    steel = (0.3, 82e9, 0.28, law)
    small = creep_force(*given, (0.0, 1e-9, 0.0), *steel)
    assert small.lateral == pytest.approx(-1e-9 * small.f22, rel=1e-4)
    assert creep_force(*given, (0.0, 0.0, 0.05), *steel).lateral < 0.0
    large = creep_force(*given, (0.0, -1.0, 0.0), *steel)
    assert large.lateral == pytest.approx(0.3 * 50e3, rel=2e-3)
    both = creep_force(*given, (1.0, -1.0, 0.0), *steel)  # friction bounds the vector
    assert math.hypot(both.lateral, both.longitudinal) == pytest.approx(0.3 * 50e3, rel=1e-2)
    assert both.longitudinal < 0.0 < both.lateral


def test_modes_are_named_by_their_shapes():
    car = Vehicle.from_preset("bart")
    assert mode_labels(car, vehicle_matrices(car)) == [
        "Carbody lower sway", "Carbody upper sway", "Carbody bounce",
        "Bogie lateral", "Bogie bounce", "Bogie roll",
    ]  # fmt: skip
