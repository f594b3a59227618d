"""Spectral intensity: how hard a motion shakes what stands on it.

    SI = 1/(T_2 - T_1) * integral of S_v(T) dT from T_1 = 0.1 s to T_2 = 2.5 s

with the pseudo-velocity spectrum S_v at 20 % damping, as Japanese railways measure it (there in
kine, cm/s).

Source: Housner (1952), "Spectrum intensities of strong-motion earthquakes", Symposium on
Earthquake and Blast Effects on Structures, Los Angeles.
"""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["DAMPING", "PERIODS", "spectral_intensity"]

DAMPING = 0.2
PERIODS = tuple(0.1 * k for k in range(1, 26))  # s; ten times as many change SI by 0.1 %


def spectral_intensity(pseudo_velocities: Sequence[float]) -> float:
    """SI by the trapezoid rule, m/s.

    Parameters
    ----------
    pseudo_velocities : sequence of float
        Pseudo-velocity at each of `PERIODS`, with `DAMPING`, m/s.
    """
    ends = 0.5 * (pseudo_velocities[0] + pseudo_velocities[-1])
    return float((ends + sum(pseudo_velocities[1:-1])) / (len(PERIODS) - 1))
