"""Laws and tables against the second writing's (`independent_model`): Hertz, Kalker, the gap."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import independent_model
import railquake as rq
from jolts import jolt
from kalker import kalker_table
from railquake.assembly.geometry import build_geometry
from railquake.assembly.supports import structure_of
from railquake.inputs.solver import Solver
from railquake.physics import hertz, newmark, pier
from railquake.physics.contact_table import (
    FIELDS,
    Axis,
    RunningCircle,
    axis_cell,
    axis_cells,
    axis_nodes,
    fill_table,
)
from railquake.physics.creep.kalker import kalker_coefficients
from railquake.physics.profiles import rail_at, zone_contact, zone_extremum
from railquake.physics.vehicle import fixed_wheelset_modes

STEEL = (2e11, 0.27)  # of the preset


@pytest.fixture(scope="module")
def second(shared):
    case = jolt("to the right")
    return independent_model.Contact(case, kalker_table(shared))


@pytest.fixture(scope="module")
def geometry():
    return build_geometry(jolt("to the right").wheelrail)


@pytest.fixture(scope="module")
def pair(second, geometry):
    """Both, as something that a failing property can print."""
    return lambda: (second, geometry)


def ellipse(second, lateral, rolling):
    """K, f11/delta, f22/delta, f23/delta^1.5 and log(a/b) by the second writing."""
    ratio = min(lateral, rolling) / max(lateral, rolling)
    k, stiff, area = (np.interp(ratio, second.curvatures, c) for c in second.ellipse)
    ab = area / (lateral + rolling)
    place = math.log(k if lateral < rolling else 1.0 / k)
    c11, c22, c23 = (math.exp(np.interp(place, second.kalker[0], c)) for c in second.kalker[1:])
    stiffness = second.modulus * stiff / math.sqrt(lateral + rolling)
    f11, f22 = second.shear * ab * c11, second.shear * ab * c22
    return stiffness, f11, f22, second.shear * ab**1.5 * c23, place


@settings(max_examples=60, deadline=None)
@given(st.floats(0.05, 60.0), st.floats(0.5, 3.0))
def test_hertz_and_kalker_of_any_curvatures(second, lateral, rolling):
    """Johnson's formulas in the semi-axes' ratio, Kalker's table in their logarithms."""
    table = hertz.hertz_table(*STEEL)
    found = hertz.hertz_lookup(
        lateral, rolling, table.stiffness, table.area, table.along, table.creep, table.spin,
        np.log(table.a_over_b),
    )  # fmt: skip
    # where two of Kalker's straight pieces meet between nodes of the package's table: 3e-4
    assert found == pytest.approx(ellipse(second, lateral, rolling), rel=5e-4, abs=2e-4)


def test_axes_of_the_ellipse_are_tabulated_the_right_way_round():
    """A = 4 B: the ellipse is longer along the rolling direction, a/b > 1; and the other way."""
    table = hertz.hertz_table(*STEEL)
    for rolling, lateral, longer in ((1.0, 4.0, True), (4.0, 1.0, False)):
        angle = math.acos((rolling - lateral) / (rolling + lateral))
        at = round(angle / math.pi * (len(table.a_over_b) - 1))
        assert (table.a_over_b[at] > 1.0) == longer
        m, n, _ = hertz.hertz_coefficients(np.array([angle]))
        assert table.a_over_b[at] == pytest.approx(m[0] / n[0], rel=2e-3)
        assert hertz.hertz_coefficients(angle)[0] == pytest.approx(m[0])  # a plain number too


@pytest.mark.parametrize(("end", "ratio"), [(0.0, 0.1), (math.pi, 40.0)])
def test_nearly_line_contacts_keep_kalkers_last_column(end, ratio):
    table = hertz.hertz_table(*STEEL)
    _, c22, c23 = kalker_coefficients(np.array([ratio]), STEEL[1])
    shear = STEEL[0] / (2.0 * (1.0 + STEEL[1]))
    at = 0 if end == 0.0 else -1
    assert table.creep[at] == pytest.approx(shear * c22[0], rel=1e-9)
    assert table.spin[at] == pytest.approx(shear * c23[0], rel=1e-9)
    assert math.isfinite(table.stiffness[at])


@pytest.mark.parametrize("factor", [1.2, 1e2])
def test_kalkers_coefficients_are_held_at_their_ends(factor):
    for beyond, last in ((40.0 * factor, 40.0), (0.1 / factor, 0.1)):
        assert np.concatenate(kalker_coefficients(beyond * np.ones(1), 0.3)) == pytest.approx(
            np.concatenate(kalker_coefficients(last * np.ones(1), 0.3))
        )


@settings(max_examples=80, deadline=None)
@given(st.floats(-0.013, 0.013), st.floats(-0.016, 0.016), st.sampled_from([0, 1]))
def test_gap_and_what_acts_there(pair, shift, roll, zone):
    """Both zones of the right-hand wheel, where the smallest gap is not at a zone's end."""
    second, geometry = pair()
    gap, at, y, height, slope = (v[2 + zone] for v in second.find(shift, roll))
    low, high = second.zones[2 + zone]
    if not low + 1.5e-3 < at < high - 1.5e-3:
        return
    count = len(geometry.wheel_y)
    limits = (geometry.flange_points, count) if zone == 0 else (0, geometry.flange_points)
    found = zone_extremum(shift, roll, *limits, geometry)
    # the package's wheel is a curve through points half a millimetre apart, across joints too
    assert found[0] == pytest.approx(gap, abs=2e-7)
    assert found[1] == pytest.approx(slope, abs=1e-2)
    assert found[3] == pytest.approx(y, abs=5e-5)
    assert found[4] == pytest.approx(height, abs=5e-5)
    # dG/dpsi = -(y_r + tan(gamma) z_r), the arm from the wheelset's centre at Z = 0 raised by -G
    assert found[2] == pytest.approx(-(y - shift) - slope * (height - gap), abs=5e-3)
    radius = float(second.wheel(at)[1])
    assert found[7] == pytest.approx(radius, abs=2e-3)
    lean = math.atan(slope) - roll
    assert found[6] == pytest.approx(0.5 * max(math.cos(lean), 0.05) / radius, rel=5e-3)
    wheel, rail = (
        independent_model._nearest(np.array([x + d for d in (-3e-4, 0.0, 3e-4)]), *c)
        for x, c in ((at, second.wheel_curvature), (y, second.rail_curvature))
    )
    if np.ptp(wheel) == np.ptp(rail) == 0.0:  # not where two arcs meet
        assert found[5] == pytest.approx(max(0.5 * (wheel[1] + rail[1]), 0.05), rel=1e-6)
        *expected, place = ellipse(second, found[5], found[6])
        forces = zone_contact(shift, roll, *limits, geometry)
        assert forces[:4] == (found[0], found[1], found[2], found[4])
        assert forces[4:8] == pytest.approx(tuple(expected), rel=5e-4)
        assert forces.log_ratio == pytest.approx(place, abs=1e-3)


def test_a_zone_that_ends_before_its_smallest_gap_keeps_its_last_point(geometry):
    """The tread's smallest gap far out on the field side is the last point itself."""
    last = len(geometry.wheel_y)
    first = last - 8
    gap, *_ = zone_extremum(-0.002, -0.3, first, last, geometry)
    points = [(geometry.wheel_y[i], geometry.wheel_z[i]) for i in range(first, last)]
    sine, cosine = math.sin(-0.3), math.cos(-0.3)
    by_hand = min(
        rail_at(
            -0.002 + s * cosine - q * sine, geometry.rail_start, geometry.rail_step,
            geometry.rail_z, geometry.rail_slope,
        )[0] - s * sine - q * cosine
        for s, q in points
    )  # fmt: skip
    assert gap == pytest.approx(by_hand, abs=1e-5)


def test_rail_beside_its_drawing_is_held_at_its_ends(geometry):
    start, step = geometry.rail_start, geometry.rail_step
    end = start + step * (len(geometry.rail_z) - 1)
    for y, at in ((start - 0.1, 0), (end + 0.1, -1)):
        z, slope = rail_at(y, start, step, geometry.rail_z, geometry.rail_slope)
        assert z == pytest.approx(geometry.rail_z[at], abs=1e-9)
        assert slope == pytest.approx(geometry.rail_slope[at], abs=1e-6)
    k = len(geometry.rail_z) // 2
    z, slope = rail_at(start + step * k, start, step, geometry.rail_z, geometry.rail_slope)
    assert z == pytest.approx(geometry.rail_z[k], abs=1e-12)
    assert slope == pytest.approx(geometry.rail_slope[k], abs=1e-6)


AXIS = Axis(fine=0.4, fine_step=0.1, coarse_step=0.3, end=1.0)


def test_nodes_of_an_axis_are_coarse_fine_coarse():
    expected = [-1.0, -0.7, -0.4, -0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3, 0.4, 0.7, 1.0]
    assert axis_nodes(AXIS) == pytest.approx(expected, abs=1e-12)
    assert axis_cells(AXIS) == pytest.approx((0.4, 1.0, 10.0, 1.0 / 0.3, 2.0, 8.0))


@pytest.mark.parametrize(
    "x", [-1.0, -0.99, -0.5, -0.39, -0.05, 0.0, 0.07, 0.395, 0.4, 0.65, 0.71, 1.0]
)
def test_a_place_lies_in_its_cell(x):
    nodes = axis_nodes(AXIS)
    cell, place, rate = axis_cell(x, axis_cells(AXIS))
    k = int(cell)
    assert 0 <= k <= len(nodes) - 2
    assert 0.0 <= place <= 1.0
    assert rate == pytest.approx(1.0 / (nodes[k + 1] - nodes[k]))
    assert nodes[k] + place / rate == pytest.approx(x, abs=1e-12)


@pytest.mark.parametrize(("x", "end"), [(-7.0, -1.0), (7.0, 1.0)])
def test_beyond_the_axis_a_place_is_held_at_its_end(x, end):
    assert axis_cell(x, axis_cells(AXIS)) == axis_cell(end, axis_cells(AXIS))


def test_table_is_filled_row_by_row_with_tread_and_flange(geometry):
    """A few nodes, one by one; the gap and its derivatives by the point that the wheel turns about.

    That point (b, r0) of the wheelset stays where it is when the wheelset rolls by phi: its shift
    is then u + b - (b cos phi - r0 sin phi), its height less by b sin phi + r0 cos phi.
    """
    b, r0 = 0.872, 0.392
    displacements, rolls = np.array([-0.001, 0.002, 0.0085]), np.array([-0.003, 0.001, 0.4])
    table = np.full(len(displacements) * len(rolls) * 2 * FIELDS, math.nan)
    fill_table(displacements, rolls, RunningCircle(b, r0), geometry, table)
    held = table.reshape(len(rolls), len(displacements), 2, FIELDS)
    count, flange = len(geometry.wheel_y), geometry.flange_points
    h = 1e-6

    def gap(u, roll, first, last):
        shift = u + b - (b * math.cos(roll) - r0 * math.sin(roll))
        found = zone_contact(shift, roll, first, last, geometry)
        return found.gap + b * math.sin(roll) + r0 * math.cos(roll), found

    for i, roll in enumerate(rolls):
        for j, u in enumerate(displacements):
            for zone, limits in enumerate([(flange, count), (0, flange)]):
                rise, found = gap(u, roll, *limits)
                by_roll = (gap(u, roll + h, *limits)[0] - gap(u, roll - h, *limits)[0]) / (2.0 * h)
                assert held[i, j, zone, 0] == pytest.approx(rise)
                assert held[i, j, zone, 1] == found.slope
                assert held[i, j, zone, 2] == pytest.approx(by_roll, abs=1e-5)
                assert held[i, j, zone, 3:] == pytest.approx(found[3:])


@pytest.mark.parametrize("damping_of", ["column", "initial"])
def test_column_and_its_damping(damping_of):
    """Stiffness by slope and deflection; damping by two equations for a and b."""
    support = jolt("to the right", damping_of=damping_of).support
    _, damping, stiffness = independent_model.column_matrices(support)
    found = pier.stiffness_matrix(
        support.youngs_modulus, support.second_moment_of_area, support.length, 0.0
    )
    assert found == pytest.approx(stiffness)
    made = structure_of(support, Solver(), 0.0)
    assert made.damping + np.diag([0.0, made.hinge_damping.constant, 0.0]) == pytest.approx(damping)


def test_newmarks_matrix():
    m, c, k = (
        2.0 * np.eye(2),
        np.array([[3.0, 1.0], [1.0, 5.0]]),
        np.array([[7.0, 0.0], [0.0, 9.0]]),
    )
    by_hand = np.array([[800.0 + 60.0 + 7.0, 20.0], [20.0, 800.0 + 100.0 + 9.0]])  # dt = 0.1 s
    assert newmark.effective_matrix(m, c, k, 0.1) == pytest.approx(by_hand)


def test_modes_with_the_wheelset_held_have_unit_mass_and_solve_their_equation():
    car = rq.assemble(jolt("to the right")).vehicle
    frequencies, shapes = fixed_wheelset_modes(car.mass, car.stiffness)
    mass, stiffness = np.diag(car.mass[:6]), car.stiffness[:6, :6]
    assert shapes.T @ mass @ shapes == pytest.approx(np.eye(6), abs=1e-9)
    expected = np.diag((2.0 * math.pi * frequencies) ** 2)
    assert shapes.T @ stiffness @ shapes == pytest.approx(expected, abs=1e-6 * expected.max())
