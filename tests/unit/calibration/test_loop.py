"""The hinge under the chord's rotation, and measures of two loops."""

import numpy as np
import pytest

from railquake.calibration.cyclic import Loop, resampled
from railquake.calibration.loop import column_flexibility, drive_hinge
from railquake.calibration.misfit import dissipated, energy_by_cycle, loop_misfit
from railquake.march.compiler import PYTHON
from railquake.probe import run_hinge


def test_prescribed_rotation_gives_the_moments_of_the_probe(known_hinge, cycles):
    found = drive_hinge(known_hinge, cycles)
    expected = run_hinge(known_hinge, cycles)[:, 0]
    assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()


def test_compiled_loop_is_the_plain_one(known_hinge, cycles):
    flexibility = column_flexibility(44.8e9, 0.16425, 6.0)
    path = cycles[:120]
    plain = drive_hinge(known_hinge, path, flexibility, target=PYTHON)
    compiled = drive_hinge(known_hinge, path, flexibility)
    assert np.abs(plain - compiled).max() < 1e-9 * np.abs(plain).max()


def test_column_takes_its_share_of_the_chords_rotation(known_hinge, cycles):
    """With the column's share taken out, the hinge alone gives the same moments."""
    flexibility = column_flexibility(30e9, 0.1, 6.0)
    moment = drive_hinge(known_hinge, cycles, flexibility)
    rotation = Loop("", cycles, moment, flexibility).hinge_rotation
    again = drive_hinge(known_hinge, rotation)
    assert np.abs(again - moment).max() < 1e-6 * np.abs(moment).max()


def test_first_stiffness_is_that_of_hinge_and_column_in_series(known_hinge):
    flexibility = column_flexibility(30e9, 0.1, 6.0)
    assert flexibility == pytest.approx(6.0 / (3.0 * 30e9 * 0.1))
    moment = drive_hinge(known_hinge, np.array([1e-7]), flexibility)
    assert moment[0] / 1e-7 == pytest.approx(1.0 / (1.0 / known_hinge.k0 + flexibility), rel=1e-3)


def test_finer_steps_converge(known_hinge, cycles):
    coarse, fine, finest = (
        drive_hinge(known_hinge, cycles, substeps=count) for count in (2, 8, 32)
    )
    assert np.abs(fine - finest).max() < 0.5 * np.abs(coarse - finest).max()


def test_loop_misfit_by_its_definition():
    x = np.linspace(0.1, 1.0, 10)
    reference = 2.0 * x
    found = loop_misfit(x, reference, reference + 0.2)
    assert found.over_peak == pytest.approx(0.1)
    assert found.largest == pytest.approx(0.1)
    assert found.over_rms == pytest.approx(0.2 / np.sqrt(np.mean(reference**2)))
    assert loop_misfit(x, reference, reference).over_peak == 0.0


def test_energy_of_an_ellipse_is_its_area():
    """x = a sin, M = b sin(. + phase): pi a b sin(phase) a cycle."""
    phase, a, b = 0.4, 0.01, 5e6
    t = np.linspace(0.0, 6.0 * np.pi, 3001)[1:]
    x, m = a * np.sin(t), b * np.sin(t + phase)
    area = np.pi * a * b * np.sin(phase)
    cycles = energy_by_cycle(x, m)
    assert len(cycles) == 3
    for amplitude, energy in cycles[1:]:
        assert amplitude == pytest.approx(a, rel=1e-4)
        assert energy == pytest.approx(area, rel=1e-2)
    assert dissipated(x, m) == pytest.approx(3.0 * area, rel=2e-2)


def test_resampling_keeps_the_loop_and_forgets_the_speed():
    turns = np.array([0.0, 0.01, -0.01, 0.02, -0.02, 0.0])
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(turns)))])
    slow = np.interp(np.linspace(0.0, 1.0, 4000) ** 2 * way[-1], way, turns)
    x, m = resampled(slow, 1e8 * slow)
    steps = np.abs(np.diff(x))
    assert np.allclose(m, 1e8 * x)
    assert x.max() == pytest.approx(0.02, rel=0.01) and x.min() == pytest.approx(-0.02, rel=0.01)
    # equal steps but at the turns
    assert np.quantile(steps, 0.95) == pytest.approx(np.median(steps), rel=1e-6)
