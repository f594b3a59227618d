"""The creepage coefficients against Kalker's table and CONTACT."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railquake.physics.creep.kalker import kalker_coefficients
from railquake.probe import creep_force
from railquake.validation.comparison import Outcome, Picture, Result, at_most, relative
from railquake.validation.reference import columns, numbers_beside

TITLE = "Kalker's creepage coefficients"
SOURCE = """Kalker (1990), *Three-Dimensional Elastic Bodies in Rolling Contact*, table E.3; and the
linear coefficients that CONTACT gives for three ellipses at nu 0.28, by the number of its grid's
elements. Both files lie beside the module."""
WHAT = """C11, C22 and C23 at every entry of the table (20 ratios, three values of Poisson's ratio);
their values in between at nu 0.28, as the force that the public probe gives at a creepage so small
that no law of saturation matters; and these beside CONTACT's finest grid."""
WHY = """The table is used as it stands to a/b 5, so its entries test the transcription; at 10 the
mean of its entry and CONTACT's stands, C23 2 % apart: 1 %. In between, log C is linear in log(a/b)
and C quadratic in nu; near a circle this is what the table gives if it is read linearly in the
ratio, within 1 %.
CONTACT's own coefficients are high by 2.3 % at 30 elements, 1.4 % at 60 and 0.5 % at 120: 2 % for
60, 1 % for 120."""

TOLERANCE = 0.01
GRID_TOLERANCE = {60: 0.02, 120: 0.01}  # by elements across the ellipse
SHEAR, POISSON, TINY = 82e9, 0.28, 1e-9
NAMES = ("C11", "C22", "C23")


def _entries() -> tuple[Any, dict[str, Any]]:
    """Ratios a/b of the table, and its columns."""
    table = columns(numbers_beside("kalker_coefficients", "kalker_table.csv"))
    ratio = np.where(table["part"] == "a/b<=1", table["ratio"], 1.0 / table["ratio"])
    return ratio, table


def _at_table() -> list[Result]:
    ratio, table = _entries()
    worst = dict.fromkeys(NAMES, 0.0)
    for poisson in (0.0, 0.25, 0.5):
        for name, ours in zip(NAMES, kalker_coefficients(ratio, poisson), strict=True):
            theirs = table[f"{name}_nu{poisson:g}"]
            worst[name] = max(worst[name], float(np.abs(ours / theirs - 1.0).max()))
    return [
        at_most(f"{name}, 60 entries of the table: largest relative difference", "",
                ours=value, bound=TOLERANCE)
        for name, value in worst.items()
    ]  # fmt: skip


def probed(a: float, b: float) -> dict[str, float]:
    """The coefficients from the forces of the public probe, semi-axes in m."""
    load, friction = 50e3, 0.3
    along, sideways, spinning = (
        creep_force((a, b), load, tuple(TINY * unit), friction, SHEAR, POISSON, "she")
        for unit in np.eye(3)
    )
    return {
        "C11": -along.longitudinal / (SHEAR * a * b * TINY),
        "C22": -sideways.lateral / (SHEAR * a * b * TINY),
        "C23": -spinning.lateral / (SHEAR * (a * b) ** 1.5 * TINY),
    }


def compare(data: Path | None) -> Outcome:
    """Compare the table, the values between its entries, and CONTACT's."""
    results = _at_table()
    grids = columns(numbers_beside("kalker_coefficients", "contact_kalker_coefficients.csv"))
    for geometry in dict.fromkeys(grids["geom"]):
        rows = np.flatnonzero(grids["geom"] == geometry)
        first = rows[0]
        ours = probed(1e-3 * grids["a_mm"][first], 1e-3 * grids["b_mm"][first])
        place = f"{geometry}, a/b {grids['a_over_b'][first]:.3f}"
        results += [
            relative(
                f"{place}: {name}, table", "",
                reference=grids[f"{name}_table"][first], ours=ours[name], tolerance=TOLERANCE,
            )
            for name in NAMES
        ]  # fmt: skip
        for name in NAMES:
            known = [row for row in rows if np.isfinite(grids[name][row])]
            finest = max(known, key=lambda row: grids["grid_m"][row])
            elements = int(grids["grid_m"][finest])
            results.append(
                relative(
                    f"{place}: {name}, CONTACT with {elements} elements", "",
                    reference=grids[name][finest], ours=ours[name],
                    tolerance=GRID_TOLERANCE[elements],
                )
            )  # fmt: skip
    return Outcome(
        tuple(results),
        (
            Picture(
                "coefficients",
                "The coefficients at nu 0.25 over the ratio of the ellipse's semi-axes.",
                write_picture,
            ),
        ),
    )


def write_picture(path: Path) -> Path:
    """Draw the three coefficients over a/b, with the table's entries."""
    from railquake.plots.style import BLUE, GREEN, ORANGE, figure, label, legend, save

    ratio, table = _entries()
    fine = np.geomspace(0.1, 10.0, 300)
    made, ax = figure(7.0, 4.0)
    ours = kalker_coefficients(fine, 0.25)
    for name, line, colour in zip(NAMES, ours, (BLUE, ORANGE, GREEN), strict=True):
        ax.plot(fine, line, color=colour, linewidth=1.2, label=f"{name}, railquake")
        ax.plot(ratio, table[f"{name}_nu0.25"], "o", color=colour, markersize=3.5,
                label="Kalker's table")  # fmt: skip
    ax.set_xscale("log")
    ax.set_yscale("log")
    label(ax, "a / b", "coefficient, 1")
    legend(ax, loc="upper left")
    return save(made, path)
