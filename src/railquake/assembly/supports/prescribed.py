"""A track whose motion is known: nothing else moves it."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from railquake.assembly.supports import Structure
from railquake.assembly.supports.at_grade import idle_column
from railquake.inputs.solver import Solver
from railquake.inputs.support import PrescribedTrack

__all__ = ["KIND", "structure"]

KIND = PrescribedTrack

Array = np.ndarray[Any, np.dtype[np.float64]]


def structure(support: PrescribedTrack, solver: Solver, train_mass: float) -> Structure:
    """The motion of the file, held where it ends."""
    track = support.track_motion()
    known = track.dt * np.arange(len(track.y))

    def motion(times: Array) -> list[Array]:
        columns = []
        for values in (track.y, track.z, track.roll):
            curve = CubicSpline(known, values)
            at = np.minimum(times, known[-1])
            columns += [curve(at), np.where(times > known[-1], 0.0, curve(at, 1))]
        return columns

    return replace(idle_column(), choice="prescribed", prescribed=motion)
