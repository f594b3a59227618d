"""Plain curves of the classical cases."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

__all__ = ["curves"]


def curves(
    path: Path,
    abscissa: str,
    ordinate: str,
    ours: Iterable[tuple[np.ndarray, np.ndarray, str]],
    references: Iterable[tuple[np.ndarray, np.ndarray, str]] = (),
    *,
    style: str = "-",
) -> None:
    """Write a picture of ours in matplotlib's ``style``, and of the references, dashed and thin."""
    from railquake.plots.style import figure, label, legend, save

    drawing, axes = figure(7.0, 3.4)
    for x, y, name in ours:
        axes.plot(x, y, style, linewidth=1.3, label=name)
    for x, y, name in references:
        axes.plot(x, y, "k--", linewidth=0.9, label=name)
    label(axes, abscissa, ordinate)
    legend(axes, loc="best")
    save(drawing, path)
