"""The start: nothing pulls at a standing train, whatever car and support it is."""

import itertools

import numpy as np
import pytest

import railquake as rq
from independent_car import FiniteCar
from railquake.assembly import stability, vehicle_matrices
from railquake.inputs.ground_motion import GroundMotion
from railquake.inputs.vehicle import Vehicle
from railquake.march.compiler import PYTHON
from railquake.march.order import kernel_order
from railquake.physics.vehicle import GRAVITY

STILL = GroundMotion("still", 1e-3, np.zeros(4))  # 3 ms

LEVELS = {
    "box": {"mass": "30 t", "roll_inertia": "30 t m2", "height": "1.9 m"},
    "cradle": {"mass": "3 t", "roll_inertia": "2 t m2", "height": "1.0 m"},
    "frame": {"mass": "5 t", "roll_inertia": "3 t m2", "height": "0.6 m"},
    "wheelset": {"mass": "2600 kg", "roll_inertia": "1400 kg m2", "height": "0.392 m"},
}


def car(*names, pair=True):
    """A linear car of some of the bodies above, each sprung on the next lower one."""
    springs, dashpots = {}, {}
    for upper, lower in itertools.pairwise(names):
        for direction, stiffness in (("lateral", "0.5 MN/m"), ("vertical", "1.5 MN/m")):
            common = {
                "bodies": [upper, lower],
                "direction": direction,
                "lateral": "0.6 m",
                "height": LEVELS[lower]["height"],
            }
            springs[f"{upper} {direction}"] = {**common, "stiffness": stiffness}
            dashpots[f"{upper} {direction}"] = {**common, "damping": "60 kN s/m"}
    if not pair:  # stiffer on the right: bounce and roll hang together
        springs["extra"] = {
            **springs[f"{names[0]} vertical"], "stiffness": "0.2 MN/m", "pair": False,
        }  # fmt: skip
    return {
        "name": "car of " + ", ".join(names),
        "bodies": {name: LEVELS[name] for name in names},
        "springs": springs,
        "dashpots": dashpots,
        "axles": 4,
        "speed": "80 km/h",
        "kinematics": "linear",
    }


CASES = {
    "bart": {},
    "bart, 2023": {"vehicle": "bart-2023-runs", "wheelrail": "bart-2023-runs"},
    "european wheels": {"wheelrail": "s1002-60e1"},
    "elastic hinge": {"hinge": "elastic"},
    "decoupled": {"coupled": False},
    "P-delta": {"support": {"preset": "bart-berkeley", "p_delta": True}},
    "at grade": {"support": "at-grade"},
    "grid": {"contact": "grid"},
    "two bodies": {"vehicle": car("box", "wheelset")},
    "four bodies": {"vehicle": car("box", "cradle", "frame", "wheelset")},
    "lopsided": {"vehicle": car("box", "wheelset", pair=False)},
    "under gravity": {"vehicle": "bart-under-gravity"},
    "manchester": {"vehicle": "manchester", "wheelrail": "s1002-60e1"},
}


def assembled(case, **more):
    return rq.assemble(rq.scenario(motion=STILL, **{"dt": "1e-5 s", **CASES[case], **more}))


@pytest.mark.parametrize("case", CASES)
def test_forces_on_every_body_are_in_balance(case):
    system = assembled(case)
    s, q, matrices = system.start[:, 0], system.constants[:, 0], system.vehicle
    state, constant = system.layout.state, system.layout.constant
    dofs = len(matrices.mass)
    weight = np.where(np.arange(dofs) % 3 == 1, matrices.mass * GRAVITY, 0.0)
    displaced = np.empty(dofs)
    displaced[kernel_order(dofs)] = s[state.VEHICLE_X : state.VEHICLE_X + dofs]
    # all bodies drift at one speed, if any: dashpots do not work
    if system.scenario.vehicle.kinematics == "finite":
        held, _ = FiniteCar(system.scenario.vehicle).at_work(displaced, np.zeros(dofs))
    else:
        held = matrices.stiffness @ displaced
    pull = weight - held
    pull[-3:] += s[state.WHEELSET_Y : state.WHEELSET_Y + 3]
    total = weight.sum()
    assert np.abs(pull).max() < 1e-7 * total
    assert s[state.WHEELSET_Z] == pytest.approx(-total, rel=1e-7)
    assert s[state.LOAD_LEFT] + s[state.LOAD_RIGHT] == pytest.approx(
        total, rel=1e-3
    )  # in the track
    if q[constant.GROUND_LOAD] > 0.0:
        u, theta1, theta2 = s[state.U : state.U + 3]
        k = q[constant.K : constant.K + 6]
        node = q[constant.REACTION] * s[[state.NODE_U, state.NODE_THETA2]]
        left = (
            node[0] - k[0] * u - k[1] * theta1 - k[2] * theta2,
            -s[state.MOMENT] - k[1] * u - k[3] * theta1 - k[4] * theta2,
            node[1] - k[2] * u - k[4] * theta1 - k[5] * theta2,
        )
        assert np.abs(left).max() < 1e-6 * total


def test_eccentric_train_bends_the_pier_by_its_weight_times_the_offset():
    """physics.md, section 1: Q_phi = h F_y + e F_z, so the foot carries e W (no lateral force)."""
    system = assembled("bart")
    weight = system.scenario.vehicle.mass * GRAVITY
    offset = system.scenario.support.track_offset
    state = system.layout.state
    assert abs(system.start[state.MOMENT, 0]) == pytest.approx(weight * offset, rel=0.01)
    assert system.start[state.TRACK_PHI, 0] > 0.0  # the track is right of the column: right down
    assert system.start[state.U, 0] > 0.0


def test_decoupled_pier_starts_unloaded():
    system = assembled("decoupled")
    state = system.layout.state
    assert np.abs(system.start[state.U : state.U + 9, 0]).max() < 1e-20


@pytest.mark.parametrize(
    "case", ["two bodies", "four bodies", "lopsided", "european wheels", "under gravity"]
)
def test_other_cars_run_and_stay_where_they_stand(case):
    response = rq.simulate(assembled(case), target=PYTHON)
    assert response.status == "safe"
    s = response.end[:, 0]
    start = response.system.start[:, 0]
    state = response.system.layout.state
    dofs = len(response.system.vehicle.mass)
    places = slice(state.VEHICLE_X, state.VEHICLE_X + dofs)
    moved = s[places] - start[places]
    drift = start[state.VEHICLE_V] * STILL.duration
    assert np.abs(moved).max() < 1e-7 + abs(drift)
    assert s[state.WHEELSET_Z] == pytest.approx(start[state.WHEELSET_Z], rel=1e-3)


def test_a_lopsided_car_with_finite_rotations_stands_as_it_is_drawn():
    """Stiffer on the right: what its springs bear at rest is in balance all the same."""
    extra = {"bodies": ["car", "bogie"], "direction": "vertical", "stiffness": "0.2 MN/m",
             "lateral": "1 m", "height": "0.9 m", "pair": False}  # fmt: skip
    car = vehicle_matrices(Vehicle.from_preset("manchester", {"springs": {"extra": extra}}))
    left = (car.weight - car.held_by(np.zeros(len(car.mass))))[:-3]
    assert np.abs(left).max() < 1e-9 * car.weight.sum()


@pytest.mark.parametrize("case", ["two bodies", "four bodies"])
def test_shaken_ground_leaves_every_sprung_body_behind_alike(case):
    """The frame moves with the ground, so every body feels -a, not only those near the track."""
    shaken = rq.scenario(
        support="at-grade", motion=GroundMotion("jump", 1e-3, [2.0, 2.0]), **CASES[case]
    )
    response = rq.simulate(shaken, target=PYTHON)
    for name in response.system.vehicle.bodies[:-1]:
        moved = np.diff(response.channel(f"{name}_lateral_m"))
        assert moved == pytest.approx(-0.5 * 2.0 * 1e-3**2, rel=0.05)


def test_rates_of_a_mass_on_spring_and_dashpot():
    """Undamped the circular frequency; a dashpot alone c/m."""
    mass = np.array([4.0])
    spring, dashpot, nothing = np.array([[100.0]]), np.array([[12.0]]), np.zeros((1, 1))
    assert stability.fastest_rate(mass, spring, nothing) == pytest.approx(5.0)
    assert stability.fastest_rate(mass, nothing, dashpot) == pytest.approx(3.0)
