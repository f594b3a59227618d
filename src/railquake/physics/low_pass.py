"""A low-pass filter that takes short impacts out of forces (the paper's Figure 10).

Second-order Butterworth by the bilinear transform, prewarped: what
``scipy.signal.butter(2, corner, fs=1/frame)`` gives, without that package's long import.
"""

import math
from typing import NamedTuple

__all__ = ["Coefficients", "Memory", "low_pass", "low_pass_coefficients"]


class Coefficients(NamedTuple):
    """y = b0 x + b1 x(-1) + b2 x(-2) - a1 y(-1) - a2 y(-2)."""

    b0: float
    b1: float
    b2: float
    a1: float
    a2: float


class Memory(NamedTuple):
    """Past inputs and outputs, the last first."""

    x1: float
    x2: float
    y1: float
    y2: float


def low_pass(value: float, memory: Memory, by: Coefficients) -> Memory:
    """The filter fed with ``value``; its new output stands in ``y1``."""
    output = (
        by.b0 * value
        + by.b1 * memory.x1
        + by.b2 * memory.x2
        - by.a1 * memory.y1
        - by.a2 * memory.y2
    )
    return Memory(value, memory.x1, output, memory.y1)


def low_pass_coefficients(corner: float, frame: float) -> Coefficients:
    """Coefficients for a corner frequency.

    Parameters
    ----------
    corner : float
        Hz; held below the Nyquist frequency.
    frame : float
        Sampling interval, s.
    """
    warped = math.tan(0.5 * math.pi * min(2.0 * corner * frame, 0.99))
    scale = 1.0 / (1.0 + math.sqrt(2.0) * warped + warped**2)
    b0 = scale * warped**2
    return Coefficients(
        b0,
        2.0 * b0,
        b0,
        2.0 * scale * (warped**2 - 1.0),
        scale * (1.0 - math.sqrt(2.0) * warped + warped**2),
    )
