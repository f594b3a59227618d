"""How far two loops, or two histories, lie apart."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

__all__ = ["LoopMisfit", "dissipated", "energy_by_cycle", "loop_misfit"]

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class LoopMisfit:
    """Difference of two moments along the same path, sampled at equal steps of the path.

    Attributes
    ----------
    over_peak : float
        Root of the mean square difference over the largest absolute reference moment: the
        normalised loop misfit.
    over_rms : float
        The same over the root of the mean square of the reference: always larger.
    largest : float
        Largest difference over the largest reference moment.
    energy : float
        Energy dissipated along the whole path over that of the reference, less 1.
    """

    over_peak: float
    over_rms: float
    largest: float
    energy: float


def loop_misfit(rotation: Array, reference: Array, moment: Array) -> LoopMisfit:
    """Measure ``moment`` against ``reference`` along ``rotation``, shapes (n,)."""
    difference = moment - reference
    rms = float(np.sqrt(np.mean(difference**2)))
    peak = float(np.abs(reference).max())
    return LoopMisfit(
        over_peak=rms / peak,
        over_rms=rms / float(np.sqrt(np.mean(reference**2))),
        largest=float(np.abs(difference).max()) / peak,
        energy=dissipated(rotation, moment) / dissipated(rotation, reference) - 1.0,
    )


def dissipated(rotation: Array, moment: Array) -> float:
    """Integral of M d theta along the path from the origin, J; elastic energy at its end included.

    By the trapezoid rule.
    """
    x, m = np.concatenate([[0.0], rotation]), np.concatenate([[0.0], moment])
    return float(np.sum(0.5 * (m[1:] + m[:-1]) * np.diff(x)))


def energy_by_cycle(rotation: Array, moment: Array) -> list[tuple[float, float]]:
    """Amplitude and dissipated energy (rad, J) of each full cycle.

    A cycle runs from one upward passage of the rotation through zero to the next.
    """
    x, m = np.concatenate([[0.0], rotation]), np.concatenate([[0.0], moment])
    # the path begins at zero, going either way; a cycle closes with the second passage
    side = np.sign(x)
    crossings = [0]
    last = 0.0
    for k, s in enumerate(side):
        if s == 0.0 or s == last:
            continue
        if last != 0.0:
            crossings.append(k)
        last = s
    marks = crossings[::2]
    if len(crossings) % 2 == 0:  # the last cycle ends with the path
        marks = [*marks, len(x) - 1]
    found = []
    for a, b in pairwise(marks):
        piece = slice(a, b + 1)
        energy = float(np.sum(0.5 * (m[piece][1:] + m[piece][:-1]) * np.diff(x[piece])))
        found.append((float(np.abs(x[piece]).max()), energy))
    return found
