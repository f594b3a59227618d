r"""Choose and scale records so that a suite's mean meets a target spectrum.

On `POINTS` periods, evenly spaced in the logarithm over the period range, let
:math:`x_{ij} = \ln S_a(T_j)` of record i as recorded and :math:`y_j` the logarithm of the target.

**Scale factors** in closed form: :math:`\ln s_i`, the mean over the periods of
:math:`y_j - x_{ij}`, minimises the record's own mean squared log misfit; it is then bounded to
between 1 / L and L, L the largest scale factor.  With the residuals
:math:`r_{ij} = x_{ij} + \ln s_i - y_j` the choice of n records S minimises

.. math:: J(S) = \frac{1}{m} \sum_j \Big(\frac{1}{n} \sum_{i \in S} r_{ij}\Big)^2
          \; \Big[ + \frac{1}{m} \sum_j (\sigma_j(S) - \sigma)^2 \Big],

the mean squared log misfit of the suite's GEOMETRIC mean; where a scatter :math:`\sigma` is asked
for, the mean squared deviation from it of the standard deviation :math:`\sigma_j` of
:math:`\ln S_a` is added (as Jayaram, Lin & Baker 2011 match a spectrum's mean and variance).

**Greedy start**: the record that makes J smallest is added until there are n.  **Exchanges**: of
all swaps of one chosen for one other record the best is made, until none lowers J.  Ties go to the
first in the order of the files.  So the result is a local optimum, and the same every time.

Jayaram, N., Lin, T. & Baker, J. W. (2011), "A computationally efficient ground-motion selection
algorithm for matching a target response spectrum mean and variance", Earthquake Spectra 27(3),
797-815.
"""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from railquake.errors import InputError
from railquake.inputs.ground_motion import STANDARD_GRAVITY, response_spectrum
from railquake.suite.hazard import TargetSpectrum
from railquake.suite.model import Suite, SuiteMember
from railquake.suite.records import Component, Skipped, find_components
from railquake.suite.spectra import log_mean

__all__ = ["Choice", "Selection", "choose", "manifest_text", "scale_factors", "select_records"]

Array = NDArray[np.float64]

POINTS = 40
"""Periods at which suite and target are compared."""
SMALLEST_GAIN = 1e-12
"""Relative gain that makes an exchange worth while: above rounding, so that it must end."""


@dataclass(frozen=True, eq=False)
class Choice:
    """Which of the candidates were taken.

    Parameters
    ----------
    chosen : tuple of int
        Rows of the residuals, increasing.
    greedy : float
        Objective J after the greedy start.
    final : float
        Objective J after the exchanges.
    exchanges : int
        How many were made.
    """

    chosen: tuple[int, ...]
    greedy: float
    final: float
    exchanges: int


@dataclass(frozen=True, eq=False)
class Selection:
    """A suite that was selected, and how well it meets its target.

    Parameters
    ----------
    suite : Suite
        In the order of the files.
    components : tuple of Component
        The records of its members.
    target : TargetSpectrum
        What it is to meet.
    periods : ndarray, shape (m,)
        Where the two were compared, s.
    spectra : ndarray, shape (n, m)
        Scaled pseudo-spectral accelerations, m/s2.
    considered : int
        How many components there were to choose from.
    skipped : tuple of Skipped
        Files that took no part.
    misfit_before : float
        Root mean square of ln(mean / target), all components as recorded.
    misfit_greedy, misfit : float
        The same for the greedy start and for the suite.
    exchanges : int
        How many exchanges led from one to the other.
    """

    suite: Suite
    components: tuple[Component, ...]
    target: TargetSpectrum
    periods: Array
    spectra: Array
    considered: int
    skipped: tuple[Skipped, ...]
    misfit_before: float
    misfit_greedy: float
    misfit: float
    exchanges: int

    @property
    def deviation(self) -> Array:
        """Geometric mean over target, less 1, at each period."""
        return np.asarray(log_mean(self.spectra) / self.target.at(self.periods) - 1.0)


def select_records(
    records: str | Path,
    target: TargetSpectrum,
    count: int = 20,
    *,
    period_range: tuple[float, float] = (0.05, 2.0),
    largest_scale: float = 5.0,
    scatter: float | None = None,
    name: str = "suite",
    progress: Callable[[int, int], None] | None = None,
) -> Selection:
    """Choose and scale records of a folder; the module's text has the method.

    Parameters
    ----------
    records : path
        Folder with records, of mixed formats if need be; see `find_components`.
    target : TargetSpectrum
        What the suite's geometric mean is to meet.
    count : int
        How many records.
    period_range : tuple of float
        Shortest and longest period, s, within the target.
    largest_scale : float
        Scale factors lie between 1 / `largest_scale` and `largest_scale`; over 1.
    scatter : float, optional
        Standard deviation of ln Sa to aim at, too; none by default.
    name : str
        What to call the suite.
    progress : callable, optional
        Called with the number of files done and of all files.

    Returns
    -------
    Selection

    Raises
    ------
    InputError
        If an argument is out of range, or the folder holds no records or fewer than `count`.
    """
    _check(count, period_range, largest_scale, scatter)
    target.at(period_range)  # refused here, an end outside the target is named as it was given
    periods = np.geomspace(*period_range, POINTS)
    wanted = np.log(target.at(periods))
    folder = Path(records)
    components, skipped = find_components(folder, progress)
    if len(components) < count:
        raise InputError(
            f"{folder}: holds {len(components)} usable components, {count} are wanted; lower the "
            "count or add records"
        )
    logs = np.log([response_spectrum(one.motion, periods).psa for one in components])
    factors = scale_factors(logs, wanted, largest_scale)
    residuals = logs + np.log(factors)[:, None] - wanted
    choice = choose(residuals, count, scatter)
    chosen = list(choice.chosen)
    greedy = list(choose(residuals, count, scatter, exchange=False).chosen)
    return Selection(
        suite=Suite(name, _members(folder, [components[i] for i in chosen], factors[chosen])),
        components=tuple(components[i] for i in chosen),
        target=target,
        periods=periods,
        spectra=np.exp(residuals[chosen] + wanted),
        considered=len(components),
        skipped=skipped,
        misfit_before=_misfit(logs - wanted),
        misfit_greedy=_misfit(residuals[greedy]),
        misfit=_misfit(residuals[chosen]),
        exchanges=choice.exchanges,
    )


def manifest_text(selection: Selection) -> str:
    """The manifest of a selected suite: CSV with its target in remarks at the top.

    Files are relative to the folder of the records.
    """
    text = io.StringIO()
    target, periods = selection.target, selection.periods
    text.write(
        f"# Selected from {selection.considered} components to meet hazard {target.title}\n"
        f"#   in the geometric mean from {periods[0]:g} to {periods[-1]:g} s, 5 % damping;\n"
        f"#   rms of ln(mean / target): {selection.misfit:.4f}. Files are relative to the\n"
        "#   folder of the records; PGA and PGV are of the record before scaling.\n"
    )
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["file", "channel", "scale_factor", "dt_s", "npts", "pga_g", "pgv_m_s"])
    for member, one in zip(selection.suite.members, selection.components, strict=True):
        motion = one.motion
        table.writerow(
            [one.file, "" if one.channel is None else one.channel, repr(member.scale_factor),
             repr(motion.dt), motion.npts, f"{motion.pga / STANDARD_GRAVITY:.6g}",
             f"{motion.pgv:.4g}"]
        )  # fmt: skip
    return text.getvalue()


def _check(
    count: int, period_range: tuple[float, float], largest_scale: float, scatter: float | None
) -> None:
    if count < 1:
        raise InputError(f"count: must be 1 or more, found {count}")
    shortest, longest = period_range
    if not (math.isfinite(longest) and 0.0 < shortest < longest):
        raise InputError(
            f"period range: two increasing periods in s are needed, found {shortest:g},{longest:g}"
        )
    if not (math.isfinite(largest_scale) and largest_scale >= 1.0):
        raise InputError(f"largest scale: must be finite and 1 or more, found {largest_scale:g}")
    if scatter is not None and not 0.0 <= scatter <= 2.0:
        raise InputError(
            f"scatter: a standard deviation of ln Sa from 0 to 2 is needed, found {scatter:g}"
        )


def _members(folder: Path, components: list[Component], factors: Array) -> tuple[SuiteMember, ...]:
    """Suite members named by file, with the channel where the file has several."""
    stems = [Path(one.file).stem for one in components]
    members = []
    for one, stem, factor in zip(components, stems, factors, strict=True):
        table: dict[str, object] = {"record": str((folder / one.file).absolute())}
        label = stem if stems.count(stem) == 1 else one.file
        if one.channel is not None:
            table["channel"] = one.channel
            label = f"{one.file} {one.channel}" if stems.count(stem) > 1 else label
        members.append(SuiteMember(label, table, float(factor)))
    return tuple(members)


def _misfit(residuals: Array) -> float:
    """Root mean square over the periods of the mean residual."""
    return float(np.sqrt(np.mean(np.mean(residuals, axis=0) ** 2)))


def scale_factors(logs: Array, wanted: Array, largest: float) -> Array:
    """Each record's best factor by itself, bounded.

    Parameters
    ----------
    logs : ndarray, shape (n, m)
        ln Sa of the records as recorded.
    wanted : ndarray, shape (m,)
        ln Sa of the target.
    largest : float
        Bound L; factors lie between 1 / L and L.

    Returns
    -------
    ndarray, shape (n,)
        Rounded to four digits, so that a manifest holds exactly what was used.
    """
    best = np.exp(np.mean(wanted - logs, axis=1))
    rounded = np.array([float(f"{factor:.4g}") for factor in best])
    return np.asarray(np.clip(rounded, 1.0 / largest, largest))


def choose(
    residuals: Array, count: int, scatter: float | None = None, *, exchange: bool = True
) -> Choice:
    """Choose rows so that their mean is close to zero; the module's text has the method.

    Parameters
    ----------
    residuals : ndarray, shape (n, m)
        Log misfit of each candidate at each period.
    count : int
        How many to take, 1 to n.
    scatter : float, optional
        Standard deviation to aim at, too.
    exchange : bool
        Whether exchanges follow the greedy start.

    Returns
    -------
    Choice
    """
    squares = residuals**2
    total = np.zeros(residuals.shape[1])
    total_squares = np.zeros_like(total)
    chosen: list[int] = []
    free = np.ones(len(residuals), dtype=bool)
    objective = math.inf
    for size in range(1, count + 1):
        scores = _objective(total + residuals, total_squares + squares, size, scatter)
        scores[~free] = np.inf
        best = int(np.argmin(scores))
        objective = float(scores[best])
        chosen.append(best)
        free[best] = False
        total, total_squares = total + residuals[best], total_squares + squares[best]
    greedy, exchanges = objective, 0
    while exchange and free.any():
        out, new, score = _best_exchange(residuals, squares, chosen, free, scatter)
        if not score < objective * (1.0 - SMALLEST_GAIN):
            break
        free[[chosen[out], new]] = True, False
        chosen[out] = new
        objective = score
        exchanges += 1
    return Choice(tuple(sorted(chosen)), greedy, objective, exchanges)


def _best_exchange(
    residuals: Array, squares: Array, chosen: list[int], free: NDArray[np.bool_],
    scatter: float | None,
) -> tuple[int, int, float]:  # fmt: skip
    """Place in `chosen`, row to put there, and the objective then."""
    # Summed anew each time: sums that are carried on would gather rounding.
    total, total_squares = residuals[chosen].sum(axis=0), squares[chosen].sum(axis=0)
    best = (0, 0, math.inf)
    for place in np.argsort(chosen):
        leaving = chosen[place]
        scores = _objective(
            total - residuals[leaving] + residuals,
            total_squares - squares[leaving] + squares,
            len(chosen),
            scatter,
        )
        scores[~free] = np.inf
        row = int(np.argmin(scores))
        if scores[row] < best[2]:
            best = (int(place), row, float(scores[row]))
    return best


def _objective(total: Array, total_squares: Array, size: int, scatter: float | None) -> Array:
    """J of sets with these sums of residuals and of their squares, shape (n,)."""
    mean = total / size
    value = np.mean(mean**2, axis=1)
    if scatter is not None and size > 1:
        variance = np.maximum(total_squares - size * mean**2, 0.0) / (size - 1)
        value = value + np.mean((np.sqrt(variance) - scatter) ** 2, axis=1)
    return np.asarray(value)
