"""Joints between bodies that turn by any angle."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.physics.joint import (
    JointSpring,
    Pose,
    Sides,
    Tie,
    knee_force,
    pull,
    relative,
    spring_energy,
    spring_force,
    stop_force,
)

SPRING = JointSpring(3e5, 8e5, 2e6, 6e4, 4e4, 100.0, -1.5e5, 300.0)
TIE = Tie(1.0, 0.97, 1.0, -0.23)
GAP = (0.0, 0.1)

places = st.lists(st.floats(-0.3, 0.3), min_size=6, max_size=6)
rates = st.lists(st.floats(-2.0, 2.0), min_size=6, max_size=6)


def poses(x, v=(0.0,) * 6):
    return tuple(
        Pose(x[k], x[k + 1], x[k + 2], math.sin(x[k + 2]), math.cos(x[k + 2]), *v[k : k + 3])
        for k in (0, 3)
    )


def feels(x, v=(0.0,) * 6):
    return relative(*poses(x, v), TIE, GAP)


def forces(x, v=(0.0,) * 6):
    """Generalised forces of the spring on (y, z, phi) of both bodies."""
    at = feels(x, v)
    force, _ = spring_force(at, SPRING)
    found = pull(at, force, -SPRING.nr - SPRING.kr * (x[2] - x[5]))
    return np.array([found.y, found.z, found.upper_roll, -found.y, -found.z, found.lower_roll])


def energy(x):
    return spring_energy(feels(x), x[2] - x[5], SPRING)


@given(places)
def test_forces_are_the_slope_of_the_energy(x):
    slope = [
        (energy(np.array(x) + unit) - energy(np.array(x) - unit)) / 2e-6
        for unit in 1e-6 * np.eye(6)
    ]
    np.testing.assert_allclose(forces(x), -np.array(slope), rtol=1e-6, atol=0.05)


@given(places, rates)
def test_what_dashpots_take_is_the_power_of_their_forces(x, v):
    _, lost = spring_force(feels(x, v), SPRING)
    power = (forces(x, v) - forces(x)) @ np.array(v)
    assert -power == pytest.approx(lost, rel=1e-9, abs=1e-6)


@given(places, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-math.pi, math.pi))
def test_bodies_moved_as_one_feel_nothing(x, y, z, roll):
    """A rigid motion of both bodies together strains nothing."""
    # body centres 1.2 m apart, turned about the lower one's
    rise = TIE.lower_z - TIE.upper_z + GAP[1]
    upper = (y - math.sin(roll) * rise, z + math.cos(roll) * rise - rise, roll)
    at = feels((*upper, y, z, roll))
    assert (at.y, at.z) == pytest.approx((-math.sin(roll) * 0.0, 0.0), abs=1e-12)


@given(places, rates)
def test_a_mirrored_joint_pulls_the_mirrored_way(x, v):
    sign = np.array([-1.0, 1.0, -1.0] * 2)
    mirrored = Tie(-TIE.upper_y, TIE.upper_z, -TIE.lower_y, TIE.lower_z)
    there = relative(*poses(sign * x, sign * v), mirrored, GAP)
    here = feels(x, v)
    assert (there.y, there.z, there.vy, there.vz) == pytest.approx(
        (-here.y, here.z, -here.vy, here.vz), abs=1e-12
    )


def test_the_rate_is_that_of_the_displacement():
    x, v = np.array([0.1, 0.02, 0.3, -0.05, 0.01, -0.2]), np.array([1.0, -0.5, 0.7, 0.2, 0.3, -0.4])
    at, ahead, behind = feels(x, v), feels(x + 1e-6 * v), feels(x - 1e-6 * v)
    assert at.vy == pytest.approx((ahead.y - behind.y) / 2e-6, rel=1e-8)
    assert at.vz == pytest.approx((ahead.z - behind.z) / 2e-6, rel=1e-8)


@pytest.mark.parametrize(
    ("pushed", "rate", "force"),
    [(0.0, 1.0, 0.0), (100.0, 0.0, 100.0), (100.0, 1.0, 150.0), (100.0, -5.0, 0.0)],
)
def test_a_stop_is_damped_while_it_bears_and_does_not_hold_back(pushed, rate, force):
    assert stop_force(pushed, rate, Sides(1.0, 1.0, 50.0)) == force


@pytest.mark.parametrize(
    ("rate", "force"), [(0.05, 5.0), (-0.05, -5.0), (0.1, 10.0), (0.3, 14.0), (-0.3, -14.0)]
)
def test_beyond_its_knee_a_dashpot_takes_the_other_damping(rate, force):
    assert knee_force(rate, 0.1, 100.0, 20.0) == pytest.approx(force)
