"""The whole of a calibration: reference loop, fit, comparison with the former hinge, check."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from railquake.calibration.column import Column
from railquake.calibration.cyclic import EFFECTIVE, Loop
from railquake.calibration.dynamic import Check, check_motion
from railquake.calibration.fit import STARTS, Fit, fit_hinge
from railquake.calibration.loop import column_flexibility, drive_hinge
from railquake.calibration.misfit import energy_by_cycle
from railquake.calibration.section import concrete_modulus, fibre_column, gross_area
from railquake.errors import InputError
from railquake.fem.column import FibreColumn, push_column
from railquake.inputs.support import Pier
from railquake.measures import STANDARD_GRAVITY as GRAVITY

__all__ = ["Calibration", "LoopFacts", "calibrate_column", "calibrate_hinge", "loop_facts"]

Array = np.ndarray[Any, np.dtype[np.float64]]
Notify = Callable[[str], None]
Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class LoopFacts:
    """What an engineer reads off a loop.

    Attributes
    ----------
    initial_stiffness : float
        Moment per chord rotation of the first branch up to a quarter of the largest moment,
        N m/rad.
    effective_stiffness : float
        Secant where three quarters of the largest moment are first reached, N m/rad.
    largest_moment : float
        N m.
    energy : tuple of (float, float)
        Amplitude of chord rotation, rad, and dissipated energy, J, of each cycle.
    """

    initial_stiffness: float
    effective_stiffness: float
    largest_moment: float
    energy: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Calibration:
    """What was fitted, to what, and how it does.

    Attributes
    ----------
    name : str
    reference : str
        What the hinge was fitted to, for people.
    source : str
        Where the reference comes from.
    loop : Loop
    fit : Fit
    pier : Pier
        With the fitted hinge.
    former : Pier
        With the hinge that it had.
    former_moment : array, shape (n,)
        Of the former pier along the loop's path, N m; NaN where its hinge does not converge.
    column : FibreColumn or None
        Of a fibre column's calibration.
    checks : tuple of Check
    """

    name: str
    reference: str
    source: str
    loop: Loop
    fit: Fit
    pier: Pier
    former: Pier
    former_moment: Array
    column: FibreColumn | None
    checks: tuple[Check, ...]


def loop_facts(chord: Array, moment: Array) -> LoopFacts:
    """Read stiffness, strength and energy off a loop.

    Parameters
    ----------
    chord, moment : array, shape (n,)
        rad and N m, from the virgin state.
    """
    loop = Loop("", chord, moment, 0.0)
    largest = float(np.nanmax(np.abs(moment)))
    return LoopFacts(
        initial_stiffness=loop.initial_stiffness,
        effective_stiffness=loop.effective_stiffness,
        largest_moment=largest,
        energy=tuple(energy_by_cycle(chord, moment)),
    )


def calibrate_column(
    column: Column,
    *,
    starts: int = STARTS,
    check: bool = True,
    progress: Progress | None = None,
    notify: Notify | None = None,
) -> Calibration:
    """Fit the hinge of a column's support to its fibre model, and check it under its motions.

    Parameters
    ----------
    column : Column
    starts : int
        Of the search.
    check : bool
        Whether to shake both models by ``column.motions``.
    progress : callable, optional
        Called with the parts done and all parts of what runs now.
    notify : callable, optional
        Called with a line of text at the beginning of each stage.

    Returns
    -------
    Calibration

    Raises
    ------
    InputError
        If OpenSees is missing, the section cannot carry its axial load, or a motion's file
        cannot be used.
    """
    former = column.pier()
    axial_load = axial_load_of(column, former)
    fibre = fibre_column(column, former.length, axial_load)
    motions = column.motions if check else ()
    for motion in motions:
        motion.lateral_motion()  # a file that cannot be read is said before the work, not after
    say = notify or _silent
    say("pushing the fibre column through its protocol ...")
    chord = column.protocol.path()
    moment, rotation = push_column(fibre, chord * former.length, progress)
    stiffness = effective_flexural_stiffness(chord, moment, rotation, former.length)
    elastic = _elastic_column(column, stiffness)
    flexibility = column_flexibility(*elastic, former.length)
    loop = Loop(column.name, chord, moment, flexibility)
    if loop.effective_stiffness * flexibility >= 1.0:
        raise InputError(
            f"{column.name}: the elastic column that is given, 3 E I / L = {1.0 / flexibility:.4g} "
            f"N m/rad, is softer than the whole fibre column near yield, "
            f"{loop.effective_stiffness:.4g} N m/rad, so that nothing is left to a hinge; raise or "
            "leave out youngs_modulus and second_moment_of_area"
        )
    say("fitting the hinge ...")
    fit = fit_hinge(loop, mass=former.mass, starts=starts, progress=progress)
    pier = former.model_copy(
        update={
            "youngs_modulus": elastic[0],
            "second_moment_of_area": elastic[1],
            "bouc_wen": fit.hinge,
        }
    )
    checks = []
    for k, motion in enumerate(motions, 1):
        say(f"shaking both, motion {k} of {len(motions)} ...")
        checks.append(check_motion(fibre, pier, motion, progress=progress))
    return Calibration(
        name=column.name,
        reference="a fibre model of the column in OpenSees",
        source=column.source,
        loop=loop,
        fit=fit,
        pier=pier,
        former=former,
        former_moment=_drive(former, chord),
        column=fibre,
        checks=tuple(checks),
    )


def calibrate_hinge(
    loop: Loop,
    former: Pier,
    *,
    source: str = "",
    starts: int = STARTS,
    progress: Progress | None = None,
    notify: Notify | None = None,
) -> Calibration:
    """Fit the hinge of a pier to a measured loop.

    Parameters
    ----------
    loop : Loop
    former : Pier
        What the preset takes everything but the hinge from: for a loop of force and displacement
        with the specimen's length and elastic column.
    source : str
        Where the loop comes from.
    starts, progress, notify
        As in `calibrate_column`.

    Returns
    -------
    Calibration

    Raises
    ------
    InputError
        If no hinge follows the loop.
    """
    (notify or _silent)("fitting the hinge ...")
    fit = fit_hinge(loop, mass=former.mass, starts=starts, progress=progress)
    return Calibration(
        name=loop.name,
        reference="a measured loop",
        source=source,
        loop=loop,
        fit=fit,
        pier=former.model_copy(update={"bouc_wen": fit.hinge}),
        former=former,
        former_moment=(
            _drive(former, loop.chord)
            if loop.flexibility
            else drive_hinge(former.bouc_wen, loop.chord, substeps=50)
        ),
        column=None,
        checks=(),
    )


def axial_load_of(column: Column, pier: Pier) -> float:
    """The load that is given, by itself or over f'c Ag, or else the pier's weight, N."""
    if column.axial_load is not None:
        return column.axial_load
    if column.axial_ratio is not None:
        return column.axial_ratio * column.concrete.strength * gross_area(column.section)
    return pier.mass * GRAVITY


def effective_flexural_stiffness(
    chord: Array, moment: Array, rotation: Array, length: float
) -> float:
    """E I of the elastic column that turns its top as the fibre column does up to yield, N m2.

    With a hinge that turns by theta below an elastic column, u = theta L + M L^2 / (3 E I) and the
    top turns by theta + M L / (2 E I).  Both together give M L / (6 E I) = top - u / L,
    whatever the hinge does; E I is the least-squares one until three quarters of the largest moment
    are first reached.

    Parameters
    ----------
    chord, moment, rotation : array, shape (n,)
        u / L, base moment, and rotation of the top, rad and N m.
    length : float
        m.
    """
    end = int(np.argmax(np.abs(moment) >= EFFECTIVE * np.abs(moment).max())) + 1
    m, bent = moment[:end], (rotation - chord)[:end]
    return float(m @ m * length / (6.0 * (m @ bent)))


def _elastic_column(column: Column, stiffness: float) -> tuple[float, float]:
    """Young's modulus, Pa, and second moment of area, m4, as given or of the fibre column."""
    young = column.youngs_modulus or concrete_modulus(column.concrete)
    return young, column.second_moment_of_area or stiffness / young


def _drive(pier: Pier, chord: Array) -> Array:
    """Moment of a whole pier along a path of its chord's rotation."""
    flexibility = column_flexibility(pier.youngs_modulus, pier.second_moment_of_area, pier.length)
    return drive_hinge(pier.bouc_wen, chord, flexibility, substeps=50)


def _silent(text: str) -> None:
    """Nobody listens."""
