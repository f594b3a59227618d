"""A suite of ground motions against the spectrum it is to meet."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from railquake.measures import STANDARD_GRAVITY
from railquake.plots.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    RED,
    blank,
    dress,
    heading,
    label,
    legend,
    plain,
    save,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from railquake.suite.hazard import TargetSpectrum
    from railquake.suite.spectra import SuiteSpectra

__all__ = ["draw_suite", "write_suite_picture"]


def draw_suite(
    ax: Axes,
    spectra: SuiteSpectra,
    target: TargetSpectrum | None = None,
    period_range: tuple[float, float] | None = None,
) -> None:
    """Draw each motion's spectrum thin, their mean and scatter, and the target.

    Parameters
    ----------
    ax : Axes
        Where to draw; both axes become logarithmic.
    spectra : SuiteSpectra
        From `railquake.suite.suite_spectra`.
    target : TargetSpectrum, optional
        What the mean is to meet.
    period_range : tuple of float, optional
        Range in which it was matched, s; what lies outside is shaded.
    """
    from matplotlib.ticker import LogLocator, NullFormatter

    dress(ax)
    periods = spectra["periods"]
    in_g = spectra["spectra"] / STANDARD_GRAVITY
    mean, spread = spectra["mean"] / STANDARD_GRAVITY, np.exp(spectra["scatter"])
    for k, values in enumerate(in_g):
        ax.plot(periods, values, color=GREY, linewidth=0.5, alpha=0.7,
                label="each motion" if k == 0 else None)  # fmt: skip
    ax.plot(periods, mean, color=BLUE, linewidth=2.0, label="geometric mean")
    if len(in_g) > 1:
        for k, bound in enumerate((mean * spread, mean / spread)):
            ax.plot(periods, bound, color=BLUE, linewidth=1.1, linestyle="--",
                    label="mean ± 1 standard deviation of ln" if k == 0 else None)  # fmt: skip
    shortest, longest = float(periods[0]), float(periods[-1])
    if target is not None:
        inside = (target.periods > shortest) & (target.periods < longest)
        ends = np.clip([shortest, longest], target.periods[0], target.periods[-1])
        at = np.concatenate([ends[:1], target.periods[inside], ends[1:]])
        ax.plot(at, target.at(at) / STANDARD_GRAVITY, color=RED, linewidth=2.0, label="target")
    if period_range is not None:
        for edge, outer in zip(period_range, (shortest, longest), strict=True):
            ax.axvline(edge, color=BLACK, linewidth=0.8, linestyle=":")
            if min(edge, outer) < max(edge, outer):
                ax.axvspan(min(edge, outer), max(edge, outer), color="#f4f4f4", zorder=0)
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.grid(visible=True, which="minor", color="#f2f2f2", linewidth=0.5)
    ax.set_xlim(shortest, longest)
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    label(ax, "period, s", "pseudo-acceleration, g", "Response spectra, 5 % damping")


def write_suite_picture(
    spectra: SuiteSpectra,
    path: Path,
    target: TargetSpectrum | None = None,
    period_range: tuple[float, float] | None = None,
    name: str = "suite",
) -> Path:
    """Draw a suite's spectra against its target, and below mean over target and scatter.

    Parameters
    ----------
    spectra : SuiteSpectra
        From `railquake.suite.suite_spectra`.
    path : Path
        PNG to write.
    target : TargetSpectrum, optional
        What the mean is to meet.
    period_range : tuple of float, optional
        Range in which it was matched, s.
    name : str
        What to call the suite.

    Returns
    -------
    Path
        The picture.
    """
    made = blank(8.5, 6.6)
    upper = made.add_axes((0.085, 0.365, 0.895, 0.525))
    draw_suite(upper, spectra, target, period_range)
    upper.set_xlabel("")
    upper.tick_params(labelbottom=False)
    legend(upper, loc="lower left")
    lower = dress(made.add_axes((0.085, 0.075, 0.895, 0.235), sharex=upper))
    periods, within = spectra["periods"], np.ones(len(spectra["periods"]), dtype=bool)
    if target is not None:
        within = (periods >= target.periods[0]) & (periods <= target.periods[-1])
        ratio = spectra["mean"][within] / target.at(periods[within]) - 1.0
        lower.plot(periods[within], 100.0 * ratio, color=BLUE, linewidth=1.6,
                   label="mean over target − 1")  # fmt: skip
        lower.axhline(0.0, color=RED, linewidth=1.0)
    lower.plot(periods, 100.0 * spectra["scatter"], color=ORANGE, linewidth=1.4,
               label="standard deviation of ln Sa")  # fmt: skip
    for edge in period_range or ():
        lower.axvline(edge, color=BLACK, linewidth=0.8, linestyle=":")
    lower.set_xlim(float(periods[0]), float(periods[-1]))
    label(lower, "period, s", "per cent")
    legend(lower)
    count = len(spectra["names"])
    told = f"{count} motion{'s' if count != 1 else ''}"
    if target is not None:
        told += f"; target: {target.title}"
    if period_range is not None:
        told += f"; matched from {period_range[0]:g} to {period_range[1]:g} s"
    heading(made, plain(f"Suite {name}"), plain(told) if len(told) <= 70 else told)
    return save(made, path)
