"""Means over a sliding window, against the integral of the same values."""

import numpy as np
import pytest

from railquake.physics.sliding_mean import BLOCKS, Filling, Window, filled, window_of

FRAME = 1e-3


def slid(values, window):
    """Frames in which a window ends, and its mean, from a plain list of all blocks."""
    filling, blocks, found = Filling(0.0, 0.0, 0.0), [], {}
    for n, value in enumerate(values):
        now = filled(value, filling, window)
        assert now.at == len(blocks) % window.blocks
        if now.ends:
            blocks.append(now.mean)
        if now.is_full:
            found[n] = np.mean(blocks[-int(window.blocks) :])
        filling = now.then
    return found


@pytest.mark.parametrize("frames", [90.0, 30.0, 24.0, 300.0, 37.3, 12.5, 10.0, 7.3, 3.0, 1.0, 0.2])
def test_a_mean_is_the_integral_over_the_window_s_own_length(frames):
    """Whatever of a frame the next block is owed must reach it, and no block count twice."""
    values = np.random.default_rng(5).normal(size=1000)
    window = window_of(frames * FRAME, FRAME)
    integral = np.concatenate([[0.0], np.cumsum(values)])

    def until(place):
        return np.interp(place, np.arange(len(integral)), integral)

    length = max(frames, 1.0)
    block = length / window.blocks
    assert 1.0 <= window.blocks <= BLOCKS and block * (1.0 + 1e-12) >= 1.0
    found = slid(values, window)
    ends = block * np.arange(window.blocks, int(1000.0 / block + 1e-9) + 1)
    assert list(found) == [int(np.ceil(end - 1e-6)) - 1 for end in ends]
    expected = [(until(end) - until(end - length)) / length for end in ends]
    assert list(found.values()) == pytest.approx(expected, abs=1e-12)


def test_a_window_of_ten_frames_or_less_slides_by_single_frames():
    values = np.random.default_rng(6).normal(size=40)
    found = slid(values, window_of(7.0 * FRAME, FRAME))
    assert list(found) == list(range(6, 40))
    means = np.convolve(values, np.full(7, 1.0 / 7.0), "valid")
    assert list(found.values()) == pytest.approx(means)


def test_a_block_whose_frames_add_up_to_it_but_for_rounding_has_ended():
    """Seven sevenths make 0.9999999999999998: not to be completed by the frame after."""
    found = slid(np.ones(70), Window(1.0 / 7.0, 10.0))
    assert found == {69: pytest.approx(1.0)}
