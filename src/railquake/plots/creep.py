"""The creep laws beside each other."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from railquake.assembly.geometry import law_table
from railquake.physics.creep import CREEP_LAWS, LinearForce, bounded_force
from railquake.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    RED,
    blank,
    dress,
    heading,
    label,
    legend,
    save,
)

__all__ = ["write_creep_picture"]


def write_creep_picture(
    slope: float, limit: float, path: Path, log_ratio: float = 0.0, poisson: float = 0.28
) -> Path:
    """Draw all laws: force over mu N against the lateral creepage, without spin.

    Parameters
    ----------
    slope : float
        f22 = G a b C22, N.
    limit : float
        mu N, N.
    path : Path
        PNG to write.
    log_ratio : float
        log(a/b) of the ellipse.
    poisson : float
        Poisson's ratio.

    Returns
    -------
    Path
    """
    made = blank(7.2, 4.9)
    ax = dress(made.add_axes((0.095, 0.105, 0.88, 0.72)))
    creepage = np.linspace(0.0, 5.0 * limit / slope, 400)
    styles = {
        "coulomb": ("Coulomb cap", GREY, "-"),
        "she": ("Shen-Hedrick-Elkins", BLUE, "-"),
        "carter": ("Carter", ORANGE, "--"),
        "polach": ("Polach", GREEN, "-."),
        "fastsim": ("Kalker, simplified", RED, "--"),
    }
    for law in dict.fromkeys((*styles, *CREEP_LAWS)):
        name, colour, dashes = styles.get(law, (law, RED, ":"))
        table = law_table(law, poisson)
        force = [
            bounded_force(
                CREEP_LAWS[law], LinearForce(0.0, slope * xi, 0.0), limit, log_ratio, table
            ).creep
            / limit
            for xi in creepage
        ]
        ax.plot(1e3 * creepage, force, color=colour, linestyle=dashes, linewidth=1.6, label=name)
    start = np.array([0.0, 1.15 * limit / slope])
    ax.plot(1e3 * start, slope * start / limit, color=BLACK, linewidth=0.8, linestyle=":",
            label="Kalker, linear")  # fmt: skip
    ax.set_xlim(0.0, 1e3 * creepage[-1])
    ax.set_ylim(0.0, 1.18)
    label(ax, "lateral creepage, 10⁻³", "force / (friction × load), 1")
    legend(ax)
    heading(
        made,
        f"Lateral creep force without spin, {len(CREEP_LAWS)} laws",
        f"f₂₂ = {1e-6 * slope:.4g} MN, friction × load = {1e-3 * limit:.4g} kN",
    )
    return save(made, path)
