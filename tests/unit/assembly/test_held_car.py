"""A car by itself, its wheelset held, uncompiled."""

import math

import numpy as np
import pytest

from railquake.assembly import held_car
from railquake.inputs.vehicle import Vehicle
from railquake.march.compiler import PYTHON
from railquake.march.held import march_held


def car(name):
    return Vehicle.from_preset(name)


def marched(vehicle, lateral, steps=100, step=1e-4):
    """A short history in plain Python, with a vertical motion of half the lateral one."""
    held = held_car(vehicle, step, 10)
    drive = np.column_stack([lateral, 0.5 * np.abs(lateral)])
    block = held.layout.state_blocks["VEHICLE_X"]
    history = np.empty((len(drive), block.stop - block.start))
    end = held.start.copy()
    rows_kept = np.arange(block.start, block.stop)
    held.bind(march_held, PYTHON)(end, held.constants, drive, rows_kept, history)
    return history, held.energy_residual(end)


JOLT = 30.0 * np.sin(np.linspace(0.0, 2.0 * math.pi, 81))  # onto the stops within 80 ms


@pytest.mark.parametrize("name", ["manchester", "crh380a", "bart-under-gravity"])
def test_a_mirrored_jolt_moves_the_car_the_mirrored_way(name):
    here, residual = marched(car(name), JOLT)
    there, _ = marched(car(name), -JOLT)
    bodies = here.shape[1] // 3
    sign = np.concatenate([np.full(2 * bodies, -1.0), np.ones(bodies)])
    np.testing.assert_allclose(there, sign * here, atol=1e-12)
    assert abs(residual) < 1e-6 * 100.0  # a coarse step: 1e-4 s


@pytest.mark.parametrize("name", ["manchester", "bart"])
def test_the_energy_of_a_car_is_what_its_forces_take_from_it(name):
    """The slope of the energy along any displacement is the force that holds it there."""
    matrices = held_car(car(name), 1e-4, 10).matrices
    x = np.array([0.2, 0.01, 0.05, 0.02, -0.01, 0.02, 0.0, 0.005, 0.01])  # onto its stops
    slope = [
        (matrices.elastic_energy(x + move) - matrices.elastic_energy(x - move)) / 2e-6
        for move in 1e-6 * np.eye(9)
    ]
    assert matrices.held_by(x) == pytest.approx(slope, rel=1e-5, abs=1.0)
