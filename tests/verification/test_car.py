"""A car with finite rotations, gravity and stops, against a second writing from its potential.

The references (``oracles/car_*.csv``) are not the package's: they were computed by differentiating
the potential and the dissipation function numerically.
"""

import csv
import math

import numpy as np
import pytest

from railquake.assembly import refuse_unstable, vehicle_matrices
from railquake.errors import InputError
from railquake.inputs.vehicle import Vehicle
from railquake.physics.vehicle import GRAVITY, fixed_wheelset_modes
from railquake.probe import lean, shake_held

PRESETS = {"bart": "bart", "manchester_passenger": "manchester", "hsr_generic_jbg": "hsr-generic"}


def rows(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def car(name, **changes):
    return Vehicle.from_preset(name, {"kinematics": "finite", **changes})


def modes(vehicle, gravity=True):
    matrices = vehicle_matrices(vehicle)
    stiffness = matrices.stiffness if gravity else matrices.without_gravity
    return fixed_wheelset_modes(matrices.mass, stiffness)[0]


def test_modes_with_and_without_gravity_are_the_references(shared):
    found = rows(shared / "oracles/car_modes.csv")
    assert len(found) == 6
    for row in found:
        expected = [float(row[f"f{k}"]) for k in range(1, 7)]
        at = modes(car(PRESETS[row["set"]]), gravity=row["gravity"] == "1")
        np.testing.assert_allclose(at, expected, rtol=1e-5)


def test_bart_under_gravity_has_the_frequencies_that_bart_states():
    """Gomez & DeJong (2023), Table 1, "BART reference": 0.31, 0.96, 1.28 Hz."""
    np.testing.assert_allclose(modes(car("bart-under-gravity"))[:3], (0.31, 0.96, 1.28), atol=5e-4)


@pytest.mark.parametrize("name", ["bart-under-gravity", "manchester", "crh380a", "hsr-generic"])
def test_a_rigid_rocking_feels_minus_the_weight_times_its_height(name):
    """Second derivative of -sum W h (1 - cos phi), h from the wheelset's centre: -sum W h."""
    vehicle = car(name)
    matrices = vehicle_matrices(vehicle)
    height = {body.name: body.height - vehicle.bodies[-1].height for body in vehicle.bodies}
    assert vehicle.bodies[-1].name == "wheelset"
    rocking = np.zeros(len(matrices.mass))
    rocking[0::3] = [height[body] for body in matrices.bodies]
    rocking[2::3] = 1.0
    weights = GRAVITY * matrices.mass[0::3]
    expected = -sum(w * height[b] for w, b in zip(weights, matrices.bodies, strict=True))
    elastic = rocking @ matrices.without_gravity @ rocking
    assert rocking @ matrices.stiffness @ rocking == pytest.approx(expected, rel=1e-5)
    assert abs(elastic) < 1e-6 * abs(expected)


def test_the_manchester_car_leans_as_the_reference(shared):
    for row in rows(shared / "oracles/car_static_manchester.csv"):
        found = lean(car("manchester"), float(row["a_m_s2"])).displacements.ravel()
        expected = [float(value) for key, value in row.items() if key != "a_m_s2"]
        np.testing.assert_allclose(found, expected, rtol=1e-5)


def manchester_motion():
    """a(t) = 2.0 sin(2 pi 0.6 t) min(1, 0.6 t/2) m/s2, of the reference's header."""
    time = np.arange(0.0, 10.0 + 5e-4, 1e-3)
    return time, 2.0 * np.sin(1.2 * math.pi * time) * np.minimum(1.0, 0.3 * time)


def test_the_manchester_car_is_shaken_as_the_reference(shared):
    reference = rows(shared / "oracles/car_history_manchester.csv")
    time, lateral = manchester_motion()
    found = shake_held(car("manchester"), time, lateral, np.zeros(len(time)))
    at = np.array([float(row["t_s"]) for row in reference])
    assert at[-1] <= found.times[-1]
    for k, name in enumerate(list(reference[0])[1:]):
        expected = np.array([float(row[name]) for row in reference])
        history = found.displacements.reshape(len(found.times), -1)[:, k]
        off = np.abs(np.interp(at, found.times, history) - expected).max()
        assert off < 1e-3 * np.abs(expected).max(), name
    assert abs(found.energy_residual) < 1e-6


def test_a_stop_left_out_would_be_seen(shared):
    """The planted fault: without its stops the car goes where the reference does not."""
    free = car("manchester", stops={"lateral": {"force_factor": 1e-6}})
    found = rows(shared / "oracles/car_static_manchester.csv")
    row = next(r for r in found if r["a_m_s2"] == "2")
    assert lean(free, 2.0).displacements[0, 0] > 1.1 * float(row["car_y_m"])


def test_a_car_that_falls_over_by_its_own_weight_is_refused_with_what_would_hold_it():
    fault = (
        r"vehicle: car falls over by its own weight \(lowest mode -0.121 Hz, unstable\); "
        r"about 6\.6e\+05 N m/rad more roll stiffness between car and bogie would just hold it"
    )
    with pytest.raises(InputError, match=fault):
        refuse_unstable(vehicle_matrices(car("bart")))


def test_the_roll_stiffness_that_is_asked_for_does_hold_it():
    bar = {"bodies": ["car", "bogie"], "stiffness": 6.7e5}
    assert modes(car("bart", anti_roll_bars={"bar": bar}))[0] > 0.0
    bar["stiffness"] = 6.5e5
    assert modes(car("bart", anti_roll_bars={"bar": bar}))[0] < 0.0
