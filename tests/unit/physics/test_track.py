"""The track on its offset: one map there and back, and the wheelset seen from it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.inputs.support import Pier
from railquake.march import contact, track, wheelset
from railquake.march.rows import constant, size, state
from railquake.march.slots import chosen
from railquake.physics import pier
from railquake.physics.track import turn_on

E, H = 2.3, 1.8  # of bart-berkeley
WHEELSET = np.array([size.WHEELSET_Y, size.WHEELSET_Z, size.WHEELSET_PHI])
place_track = chosen({"structure": "node"})[track.place_track]
numbers = st.floats(-1.0, 1.0, allow_subnormal=False)


def constants():
    q = np.zeros((size.CONSTANT_ROWS, 1))
    q[[constant.MAP_U, constant.MAP_PHI, constant.REACTION]] = 1.0
    q[constant.MAP_H], q[constant.MAP_E] = H, E
    q[[constant.DT, constant.RATE, constant.AXLES]] = 1.0
    q[constant.WHEELSET_HEIGHT] = 0.392
    return q


def moving(values):
    """Pier and wheelset somewhere, moving somehow, with a contact force in track axes."""
    s, q = np.zeros((size.STATE_ROWS, 1)), constants()
    s[state.ON_TRACK] = 1.0
    s[state.U, 0], s[state.THETA2, 0] = 0.05 * values[0], 0.05 * values[1]
    s[state.U_V, 0], s[state.THETA2_V, 0] = values[2], values[3]
    for k, degree in enumerate(WHEELSET):
        s[state.VEHICLE_X + degree, 0] = 0.1 * values[4 + k]
        s[state.VEHICLE_V + degree, 0] = values[7 + k]
    place_track(s, q, 0)
    track.orient_track(s, 0)
    wheelset.place_wheelset(s, q, 0)
    s[[state.LATERAL_LEFT, state.LOAD_RIGHT, state.FORCE_PSI], 0] = values[10:13]
    contact.add_wheels(s, q, 0)
    track.load_track(s, q, 0)
    return s[:, 0]


def test_track_hangs_on_the_top_by_a_rigid_arm():
    """physics.md, section 1: phi = -theta_2, right side down."""
    s, q = np.zeros((size.STATE_ROWS, 1)), constants()
    s[state.U, 0], s[state.THETA2, 0] = 0.01, -0.002
    place_track(s, q, 0)
    assert s[state.TRACK_PHI, 0] == 0.002
    assert s[state.TRACK_Y, 0] == pytest.approx(0.01 + H * 0.002)  # above the node: to the right
    assert s[state.TRACK_Z, 0] == pytest.approx(E * 0.002)  # right of the node: down


@given(st.lists(numbers, min_size=13, max_size=13))
def test_contact_does_the_same_work_on_the_node_as_on_the_track(values):
    """Forces go by the transpose of the map of displacements."""
    s = moving(values)
    on_track = (
        s[state.TRACK_FY] * s[state.TRACK_VY]
        + s[state.TRACK_FZ] * s[state.TRACK_VZ]
        + s[state.TRACK_MX] * s[state.TRACK_VPHI]
    )
    on_node = s[state.NODE_U] * s[state.U_V] + s[state.NODE_THETA2] * s[state.THETA2_V]
    assert on_node == pytest.approx(on_track, abs=1e-12)


@given(st.lists(numbers, min_size=13, max_size=13))
def test_contact_works_on_nothing_but_the_motion_of_wheel_relative_to_rail(values):
    """physics.md, section 5: leaving out the track's turning made the contact create energy."""
    s = moving(values)
    y, z, phi = state.VEHICLE_V + WHEELSET
    on_both = (
        s[state.WHEELSET_Y] * s[y]
        + s[state.WHEELSET_Z] * s[z]
        + s[state.WHEELSET_PHI] * s[phi]
        + s[state.TRACK_FY] * s[state.TRACK_VY]
        + s[state.TRACK_FZ] * s[state.TRACK_VZ]
        + s[state.TRACK_MX] * s[state.TRACK_VPHI]
    )
    relative = (
        s[state.FORCE_Y] * s[state.SHIFT_V]
        + s[state.FORCE_Z] * s[state.HEIGHT_V]
        + s[state.FORCE_PSI] * s[state.ROLL_V]
    )
    assert on_both == pytest.approx(relative, abs=1e-12)


@given(st.lists(numbers, min_size=13, max_size=13), st.floats(1e-6, 1e-5))
def test_rates_of_the_wheelset_are_those_of_its_place(values, dt):
    """Finite rotation of the track: place and rates agree with each other."""
    there = moving(values)
    places = []
    for sign in (-1.0, 1.0):
        later = list(values)
        for k, rate in ((0, values[2]), (1, values[3])):
            later[k] += sign * dt * rate / 0.05
        for k in range(3):
            later[4 + k] += sign * dt * values[7 + k] / 0.1
        places.append(moving(later))
    for row, rate in (
        (state.SHIFT, state.SHIFT_V),
        (state.HEIGHT, state.HEIGHT_V),
        (state.ROLL, state.ROLL_V),
    ):
        difference = (places[1][row] - places[0][row]) / (2.0 * dt)
        assert there[rate] == pytest.approx(difference, abs=1e-7)


@pytest.mark.parametrize("turn", [1e-3, -1e-3])
def test_a_small_turn_is_followed_to_the_second_order(turn):
    found = turn_on(np.sin(0.3), np.cos(0.3), turn)
    assert found == pytest.approx((np.sin(0.3 + turn), np.cos(0.3 + turn)), abs=abs(turn) ** 3 / 2)


@pytest.mark.parametrize("share", [0.05, 0.2, 0.5])
def test_weight_on_the_displaced_column_softens_it(share):
    """Cantilever: the square of its first frequency falls by P over Euler's load."""
    column = Pier.from_preset("bart-berkeley")
    ei = column.youngs_modulus * column.second_moment_of_area
    euler = np.pi**2 * ei / (4.0 * column.length**2)
    # the foot held fast, and hardly any rotational inertia at the top
    mass = np.array([column.mass, 1.0, 1.0])
    elastic = pier.stiffness_matrix(
        column.youngs_modulus, column.second_moment_of_area, column.length, 1e16
    )
    softened = elastic + pier.geometric_stiffness(share * euler, column.length)
    bare, loaded = (pier.natural_frequencies(mass, k)[0] for k in (elastic, softened))
    assert (loaded / bare) ** 2 == pytest.approx(1.0 - share, rel=0.02)


def test_rigid_column_on_a_spring_turns_over_at_k_over_length():
    """P-delta of a stiff column: the foot's spring k holds up to P = k/L."""
    length, spring = 6.0, 1e6
    unit = pier.geometric_stiffness(1.0, length)
    column = pier.stiffness_matrix(1e15, 1.0, length, spring)
    lean = np.array([-length, 1.0, 1.0])
    assert lean @ unit @ lean == pytest.approx(-length)
    assert lean @ column @ lean == pytest.approx(spring, rel=1e-3)
