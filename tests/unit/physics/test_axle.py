"""The axle that turns: implicit step, balance, and what a flange does to it."""

import numpy as np
import pytest

import railquake as rq
from railquake.assembly.start import contact_stages, settle_axle
from railquake.march import wheelset
from railquake.march.rows import constant, state
from railquake.physics.axle import axle_step, distance_from_axle
from stages import stage


@pytest.fixture(scope="module")
def system():
    return rq.assemble(rq.scenario(synthetic={"seed": 1, "duration": "6 s"}, support="at-grade"))


def test_distance_from_a_rolled_axle_is_that_of_the_turned_point():
    psi, radius, along = 0.3, 0.4, 0.8
    y = along * np.cos(psi) - radius * np.sin(psi)
    z = along * np.sin(psi) + radius * np.cos(psi)
    assert distance_from_axle(y, z, np.sin(psi), np.cos(psi)) == pytest.approx(radius)


@pytest.mark.parametrize("dt", [1e-6, 1e-4, 1.0])
def test_a_step_of_a_linear_axle_is_eulers_implicit_one(dt):
    """J w' = -c (w - w0) from w = 0, whatever the step: w = w0 c dt/(J + c dt)."""
    inertia, c, even = 30.0, 1e5, 57.0
    assert axle_step(c * even, c, inertia, dt) == pytest.approx(even * c * dt / (inertia + c * dt))
    assert axle_step(c * even, c, 0.0, dt) == pytest.approx(even)  # Newton's step
    assert axle_step(0.0, 0.0, 0.0, dt) == 0.0  # a wheelset in the air


def test_at_rest_the_moments_balance_and_the_wheels_roll(system):
    rest = system.start[:, 0]
    assert abs(rest[state.AXLE_MOMENT]) < 1e-6
    radius = rest[state.AXLE_RATE] and system.scenario.vehicle.speed / rest[state.AXLE_RATE]
    assert radius == pytest.approx(system.scenario.wheelrail.rolling_radius, rel=1e-3)
    assert rest[state.FORWARD_POWER] == pytest.approx(0.0, abs=1e-6)


def test_a_standing_trains_axles_stand():
    still = rq.assemble(
        rq.scenario(synthetic={"seed": 1, "duration": "6 s"}, support="at-grade", speed="0 km/h")
    )
    assert still.start[state.AXLE_RATE, 0] == 0.0
    assert still.start[state.SPIN_POWER, 0] == 0.0


def pressed(system, shift):
    """State and forces with the wheelset held at a shift, its axle's moments in balance."""
    s, q = system.start.copy(), system.constants
    s[state.VEHICLE_X + 4] += shift
    stages = contact_stages(system.choices, system.layout)
    settle_axle(s, q, system.geometry, stages, system.layout)
    return s[:, 0]


def test_a_flange_rolls_on_its_larger_radius_and_the_treads_slip_back(system):
    """Contact of the right flange at 34.7 degrees from a shift of 7.96 mm on (physics.md, 4)."""
    free, held = pressed(system, 0.0), pressed(system, 8.3e-3)
    assert abs(held[state.AXLE_MOMENT]) < 1e-3
    slower = 1.0 - held[state.AXLE_RATE] / free[state.AXLE_RATE]
    assert 0.0 < slower < 0.028  # between the treads' and the flange's own rate
    assert held[state.FORWARD_POWER] > 0.0


def test_the_axle_turns_with_what_the_contacts_give_it(system):
    s, q = system.start.copy(), system.constants
    s[state.AXLE_MOMENT], s[state.AXLE_DAMPING], s[state.AXLE_RATE] = 100.0, 5e4, 50.0
    turn = stage(system, wheelset.turn_axle)
    turn(s, q, 0)
    inertia, dt = q[constant.AXLE_INERTIA, 0], q[constant.DT, 0]
    assert inertia == pytest.approx(0.3 * 648.0 * 0.392**2, rel=2e-3)
    assert s[state.AXLE_RATE, 0] == pytest.approx(50.0 + 100.0 / (inertia / dt + 5e4))
    s[state.ON_TRACK], now = 0.0, s[state.AXLE_RATE, 0]
    turn(s, q, 0)
    assert s[state.AXLE_RATE, 0] == now  # a train that has left


def test_inertia_not_given_is_estimated_from_the_wheelset():
    vehicle = rq.scenario(synthetic={"seed": 1}).vehicle.model_copy(update={"axle_inertia": None})
    assert vehicle.inertia_about_axle(0.4) == pytest.approx(0.3 * 2592.0 / 4 * 0.16)
