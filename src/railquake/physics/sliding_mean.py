"""Mean over a window that slides, kept as the means of a few blocks of it.

A window is divided into up to ten blocks of equal length; a block is filled frame by frame, and
where it ends within a frame, that frame's value is shared between it and the next.  So a mean is
exact over the window's length, whatever that is in frames, of values that are constant over each
frame; it is taken whenever a block has been filled: its resolution is a tenth of the window, or a
frame where that is longer.
"""

import math
from typing import Final, NamedTuple

from railquake.physics.elementary import floor_of

__all__ = ["BLOCKS", "Filled", "Filling", "Window", "filled", "window_of"]

BLOCKS: Final = 10  # most in a window
NEARLY: Final = 1e-9  # of a block that is missing is rounding


class Window(NamedTuple):
    """How a window is divided."""

    per_frame: float  # blocks that a frame fills, at most 1
    blocks: float  # in the window, whole, from 1 to `BLOCKS`


class Filling(NamedTuple):
    """The block that is being filled."""

    share: float  # full to this, 0 to 1
    part: float  # its mean times that
    before: float  # blocks filled before it


class Filled(NamedTuple):
    """What a frame has added."""

    mean: float  # of the block that was being filled; its whole mean where it has ended
    at: float  # that block's place among those of the window, from 0
    ends: bool  # whether it has ended in this frame
    is_full: bool  # whether a whole window has ended with it
    then: Filling  # of the block that is filled next


def window_of(length: float, frame: float) -> Window:
    """A window of a length, s, in frames of a length, s; at least one frame."""
    frames = max(length / frame, 1.0)
    blocks = min(BLOCKS, math.floor(frames + NEARLY))
    return Window(min(blocks / frames, 1.0), float(blocks))


def filled(value: float, filling: Filling, window: Window) -> Filled:
    """A frame's value added to the block that is being filled.

    Parameters
    ----------
    value : float
        Mean over the frame.
    filling : Filling
    window : Window
    """
    reached = filling.share + window.per_frame
    ends = reached >= 1.0 - NEARLY
    over = max(reached - 1.0, 0.0)
    part = filling.part + (window.per_frame - over) * value
    at = filling.before - window.blocks * floor_of(filling.before / window.blocks)
    before = filling.before + (1.0 if ends else 0.0)
    return Filled(
        part,
        at,
        ends,
        ends and before >= window.blocks,
        Filling(over if ends else reached, over * value if ends else part, before),
    )
