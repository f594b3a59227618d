"""The audit's sums: each entry from the rows it stands for, both balances by hand."""

from dataclasses import fields, replace

import numpy as np
import pytest

from jolts import pushed
from railquake.march.order import kernel_order
from railquake.march.rows import constant, state
from railquake.physics.energy import EnergyAudit
from railquake.run.audit import audit

ROWS = {
    "ground": state.WORK_GROUND,
    "gravity": state.WORK_GRAVITY,
    "hinge": state.HINGE_ENERGY,
    "rayleigh": state.LOST_RAYLEIGH,
    "dashpots": state.LOST_DASHPOTS,
    "contact_vehicle": state.WORK_VEHICLE,
    "contact_track": state.WORK_TRACK,
    "impact": state.LOST_IMPACT,
    "creep": state.LOST_CREEP,
    "spin": state.SPIN_INPUT,
    "forward": state.FORWARD_INPUT,
}


@pytest.fixture(scope="module")
def system():
    return pushed("to the right")


def drawn(system, seed, on_track=1.0):
    """Some state with energies on record."""
    values = np.random.default_rng(seed).normal(size=system.start.shape)
    values[state.ON_TRACK] = on_track
    return values


def audited(system, first, last, **structure):
    """The audit between two states, with other values of the structure."""
    return audit(
        replace(system, start=first, structure=replace(system.structure, **structure)), last
    )


def mechanical(system, s, column=None):
    """Kinetic and elastic energy by the matrices."""
    matrices, order = system.vehicle, kernel_order(9)
    x, v = np.empty(9), np.empty(9)
    x[order] = s[state.VEHICLE_X : state.VEHICLE_X + 9, 0]
    v[order] = s[state.VEHICLE_V : state.VEHICLE_V + 9, 0]
    q = system.constants[:, 0]
    k = q[constant.K : constant.K + 6]
    if column is None:
        column = np.array([[k[0], k[1], k[2]], [k[1], k[3], k[4]], [k[2], k[4], k[5]]])
    u, u_v = s[state.U : state.U + 3, 0], s[state.U_V : state.U_V + 3, 0]
    car = 0.5 * v @ (matrices.mass * v), 0.5 * x @ matrices.stiffness @ x
    bridge = 0.5 * u_v @ (q[constant.MASS : constant.MASS + 3] * u_v), 0.5 * u @ column @ u
    return np.array(car), np.array(bridge)


@pytest.mark.parametrize("reaction", [1.0, 0.0])
def test_each_entry_and_both_balances(system, reaction):
    column = np.array([[3.0, 1.0, -2.0], [1.0, 7.0, 0.5], [-2.0, 0.5, 5.0]])  # all different
    first, last = drawn(system, 1), drawn(system, 2)
    found = audited(system, first, last, reaction=reaction, stiffness=column)
    for name, row in ROWS.items():
        assert getattr(found, name) == last[row, 0]
    change = sum(mechanical(system, last, column)) - sum(mechanical(system, first, column))
    assert (found.kinetic, found.elastic) == pytest.approx(tuple(change))
    hertz = last[state.HERTZ_ENERGY, 0] + last[state.HERTZ_LEFT, 0] - first[state.HERTZ_ENERGY, 0]
    assert found.hertz == pytest.approx(hertz)
    given = found.ground + found.gravity + found.contact_vehicle + reaction * found.contact_track
    kept = found.kinetic + found.elastic + found.hinge + found.rayleigh + found.dashpots
    assert found.whole_residual == pytest.approx(given - kept)
    work = found.contact_vehicle + found.contact_track
    left = -work - found.hertz - found.impact - found.creep + found.spin + found.forward
    assert found.contact_residual == pytest.approx(left)


def test_a_support_without_mass_has_no_energy(system):
    first, last = drawn(system, 1), drawn(system, 2)
    found = audited(system, first, last, ground_load=np.zeros(3))
    change = mechanical(system, last)[0] - mechanical(system, first)[0]
    assert (found.kinetic, found.elastic) == pytest.approx(tuple(change))


def test_a_train_that_left_took_its_energy_along(system):
    """What it had when it left is on record; its springs stay as they were then."""
    first, last = drawn(system, 1), drawn(system, 2, on_track=0.0)
    last[state.VEHICLE_V : state.VEHICLE_V + 9] = 0.0  # released: it stands
    last[state.VEHICLE_ENERGY] = 1e9
    found = audited(system, first, last)
    change = sum(mechanical(system, last)) - sum(mechanical(system, first))
    elastic = mechanical(system, last)[0][1]
    assert found.kinetic == pytest.approx(change[0] + 1e9 - elastic)
    assert found.elastic == pytest.approx(change[1])


def test_relative_residuals_are_over_what_is_lost():
    values = {field.name: 1.0 for field in fields(EnergyAudit)}
    some = EnergyAudit(**{**values, "impact": 2.0, "creep": 3.0, "whole_residual": 0.4,
                          "contact_residual": 0.1, "hinge": 5.0})  # fmt: skip
    assert some.dissipated == 1.0 + 1.0 + 5.0 + 2.0 + 3.0 - 1.0  # forward
    assert some.whole_relative == pytest.approx(0.4 / 11.0)
    assert some.contact_relative == pytest.approx(0.1 / 4.0)
    nothing = EnergyAudit(**dict.fromkeys(values, 0.0))
    assert nothing.whole_relative == nothing.contact_relative == 0.0
