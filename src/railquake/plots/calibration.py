"""Calibration of a hinge: loops, histories and how well each parameter is known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from railquake.plots.style import (
    BLACK,
    BLUE,
    FAINT,
    GREY,
    PALE,
    RED,
    blank,
    dress,
    heading,
    label,
    legend,
    plain,
    remark,
    save,
    stack,
    thinned,
)  # fmt: skip

__all__ = [
    "HistoryPair",
    "ParameterMark",
    "write_check_picture",
    "write_loop_picture",
    "write_parameter_picture",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

REFERENCE: dict[str, Any] = {"color": BLACK, "linewidth": 1.5}
FITTED: dict[str, Any] = {"color": RED, "linewidth": 0.9}


@dataclass(frozen=True)
class HistoryPair:
    """Two histories of a displacement, m, at the times (s), and a line of text."""

    name: str
    time: Array
    reference: Array
    fitted: Array
    text: str


@dataclass(frozen=True)
class ParameterMark:
    """A parameter's place between its bounds (0 to 1), its error there, and its value as text."""

    name: str
    place: float
    error: float
    text: str
    determined: bool


def write_loop_picture(
    chord: Array,
    reference: Array,
    fitted: Array,
    path: Path,
    *,
    title: str,
    name: str,
    drift: bool,
    facts: str,
) -> Path:
    """Draw moment (N m) against rotation (rad) of the reference and of the fitted hinge.

    ``drift`` says that the rotation is the top's displacement over the length.
    """
    made = blank(7.2, 5.4)
    ax = dress(made.add_axes((0.1, 0.1, 0.87, 0.725)))
    ax.axhline(0.0, color=GREY, linewidth=0.6)
    ax.axvline(0.0, color=GREY, linewidth=0.6)
    x = (100.0 if drift else 1e3) * np.concatenate([[0.0], chord])
    ax.plot(x, 1e-6 * np.concatenate([[0.0], reference]), label="reference", **REFERENCE)
    ax.plot(x, 1e-6 * np.concatenate([[0.0], fitted]), label="fitted Bouc-Wen hinge", **FITTED)
    label(
        ax, "drift of the top, %" if drift else "hinge rotation, mrad", "moment at the base, MN m"
    )
    legend(ax)
    heading(made, plain(title), plain(name), facts)
    return save(made, path)


def write_check_picture(pairs: Sequence[HistoryPair], path: Path, *, name: str) -> Path:
    """Draw histories of the top's displacement under motions that are not in the fit."""
    made, axes = stack([1.55] * len(pairs), gaps=0.55, share=False, top=0.95)
    for k, (ax, pair) in enumerate(zip(axes, pairs, strict=True)):
        ax.axhline(0.0, color=GREY, linewidth=0.6)
        for values, text, style in (
            (pair.reference, "fibre column", REFERENCE),
            (pair.fitted, "pier with the fitted hinge", FITTED),
        ):
            time, shown = thinned(pair.time, values)
            ax.plot(time, 1e3 * shown, label=text, **style)
        ax.set_xlim(0.0, pair.time[-1])
        label(ax, "time, s" if k == len(pairs) - 1 else "", "displacement of\nthe top, mm")
        remark(ax, f"{plain(pair.name)}: {pair.text}")
    legend(axes[0], bbox_to_anchor=(1.0, 1.1))
    heading(made, "Under motions that the fit has not seen", plain(name))
    return save(made, path)


def write_parameter_picture(marks: Sequence[ParameterMark], path: Path, *, name: str) -> Path:
    """Draw each parameter between its bounds, with one standard error to either side."""
    made = blank(7.2, 0.9 + 0.28 * len(marks) + 0.55)
    height = made.get_figheight()
    ax = dress(made.add_axes((0.15, 0.5 / height, 0.6, 1.0 - 1.3 / height)), grid=False)
    ax.spines["left"].set_visible(False)
    for k, mark in enumerate(marks):
        colour = BLUE if mark.determined else GREY
        ax.plot([0.0, 1.0], [k, k], color=PALE, linewidth=5.0, solid_capstyle="butt", zorder=1)
        low, high = max(mark.place - mark.error, 0.0), min(mark.place + mark.error, 1.0)
        ax.plot([low, high], [k, k], color=colour, linewidth=2.0, zorder=2)
        ax.plot(mark.place, k, "o", color=colour, markersize=5.0, zorder=3, clip_on=False)
        ax.text(
            1.04, k, mark.text, fontsize=8, va="center", color=BLACK if mark.determined else FAINT
        )
    ax.set_yticks(range(len(marks)), [mark.name for mark in marks])
    ax.tick_params(axis="y", length=0)
    ax.set_ylim(len(marks) - 0.5, -0.5)
    ax.set_xlim(0.0, 1.0)
    ax.set_xticks([0.0, 0.5, 1.0], ["lower bound", "scaled", "upper bound"])
    heading(
        made,
        "How well the loop determines each parameter",
        plain(name),
        "dot: fitted value between the bounds of the fit; bar: one standard error; grey: not "
        "determined",
    )
    return save(made, path)
