"""Creep force against creepage: each law beside CONTACT."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from railquake.probe import creep_force
from railquake.validation.comparison import Outcome, Picture, Result, at_most
from railquake.validation.reference import columns, numbers_beside, toml

__all__ = ["LAWS", "compare", "deviations", "forces", "numbers"]

TITLE = "Creep force against creepage, each law"
SOURCE = """CONTACT (Vollebregt; Kalker's exact half-space theory), steady rolling of a Hertzian
ellipse of a conical wheel (radius 460 mm) on a rail crown of radius 300 mm, steel G 82 GPa, nu
0.28, mu 0.3, 48 by 48 elements. `contact_creep.csv` beside the module is the reference data's file;
its first lines hold every setting and the signs."""
WHAT = """93 lateral forces over mu N for three loads, with and without the spin of a 1:40 cone. For
each law the largest deviation of F/(mu N), 1 being the limit of friction."""
WHY = """The deviations are properties of the laws, not errors of the program: the bounds are those
found, rounded up, and are there for a user to choose by. Below 2 % nothing can be said, for the
grid makes CONTACT's own forces up to 2 % too large at small creepage. There, where all laws have
Kalker's slope, CONTACT may be above each by 3 % (2 % of the grid, 1 % of beginning saturation) and
below by 0.5 %; and spin alone must push as it does in CONTACT within 2 %."""

FRICTION, SHEAR, POISSON = 0.3, 82e9, 0.28
LAWS = {
    "she": "Shen-Hedrick-Elkins",
    "carter": "Carter",
    "polach": "Polach",
    "coulomb": "Coulomb cap",
}
SMALL = 2e-5  # creepage, below which saturation takes at most 1 %


@cache
def numbers() -> dict[str, Any]:
    """CONTACT's forces."""
    return columns(numbers_beside("creep_laws", "contact_creep.csv"))


def forces(law: str) -> Any:
    """Ours over mu N, for each row of the numbers."""
    table = numbers()
    found = []
    for load, a, b, creepage, spin in zip(
        *(table[name] for name in ("N_kN", "a_mm", "b_mm", "upsilon_y", "phi_1_per_m")),
        strict=True,
    ):
        force = creep_force(
            (1e-3 * a, 1e-3 * b), 1e3 * load, (0.0, creepage, spin), FRICTION, SHEAR, POISSON, law
        )
        found.append(force.lateral / (FRICTION * 1e3 * load))
    return np.array(found)


def deviations(law: str) -> dict[str, dict[str, float]]:
    """Of F/(mu N): largest, root mean square, and the creepage of the largest, by spin."""
    table = numbers()
    error = forces(law) - table["Fy_over_muN"]
    spinning = table["phi_1_per_m"] != 0.0
    found = {}
    for key, rows in (("none", ~spinning), ("spin", spinning)):
        worst = int(np.argmax(np.abs(error[rows])))
        found[key] = {
            "largest": float(np.abs(error[rows]).max()),
            "rms": float(np.sqrt(np.mean(error[rows] ** 2))),
            "creepage": float(table["upsilon_y"][rows][worst]),
            # both forces are negative: a positive error is a force that is too small
            "sign": float(-np.sign(error[rows][worst])),
        }
    return found


def compare(data: Path | None) -> Outcome:
    """Hold every law against every number."""
    bounds = toml(numbers_beside("creep_laws", "bounds.toml"))
    table = numbers()
    small = (table["phi_1_per_m"] == 0.0) & (table["upsilon_y"] < SMALL)
    alone = table["upsilon_y"] == 0.0
    results: list[Result] = []
    note = [
        "How far each law is from CONTACT, in parts of the limit of friction, and at which",
        "creepage; the sign says whether its force is too large (+) or too small (−) there:",
        "",
        "| `creep_law` | | no spin: largest | rms | with spin: largest | rms |",
        "|---|---|---|---|---|---|",
    ]
    for law, name in LAWS.items():
        found = deviations(law)
        cells = []
        for key, words in (("none", "no spin"), ("spin", "with spin")):
            results.append(
                at_most(f"{name}, {words}: largest deviation of F/(mu N)", "",
                        ours=found[key]["largest"], bound=bounds[law][key])
            )  # fmt: skip
            sign = "+" if found[key]["sign"] > 0.0 else "−"
            cells += [
                f"{sign}{found[key]['largest']:.3f} at {found[key]['creepage']:.2g}",
                f"{found[key]['rms']:.3f}",
            ]
        note.append(f"| `{law}` | {name} | {' | '.join(cells)} |")
        ratio = table["Fy_over_muN"][small] / forces(law)[small]
        place = f"{name}, creepage below {SMALL:g}: CONTACT's largest"
        results += [
            at_most(f"{place} excess", "", ours=float(ratio.max() - 1.0), bound=0.03),
            at_most(f"{place} deficit", "", ours=float(max(1.0 - ratio.min(), 0.0)), bound=0.005),
        ]
    # the plain cap leaves the linear force alone
    spin = forces("coulomb")[alone] / table["Fy_over_muN"][alone]
    results.append(
        at_most("spin alone, linear: largest relative difference", "",
                ours=float(np.abs(spin - 1.0).max()), bound=0.02)
    )  # fmt: skip
    note += [
        "",
        "Without spin Shen-Hedrick-Elkins, the default, is nearest; with the spin of a tread,",
        "Carter. Polach's law approaches the limit slowly and is too small where the others slide.",
        "The plain cap is far off in between and serves for bounds only. All four have Kalker's",
        "slope at small creepage.",
    ]
    return Outcome(
        tuple(results),
        (
            Picture(
                "curves",
                "The four laws and CONTACT, without and with the spin of a 1:40 cone; below, the "
                "deviation at each of CONTACT's points, all loads.",
                write_picture,
            ),
        ),
        note="\n".join(note),
    )


def write_picture(path: Path) -> Path:
    """Draw the laws over CONTACT's points for the largest load, and the deviations for all."""
    from railquake.plots.style import BLUE, GREEN, GREY, ORANGE, RED, figure, label, legend, save

    table = numbers()
    colours = dict(zip(LAWS, (BLUE, ORANGE, GREEN, GREY), strict=True))
    made, axes = figure(9.0, 6.6, 2, 2, sharex=True, sharey="row")
    load = table["N_kN"].max()
    for column, spinning in enumerate((False, True)):
        rows = ((table["phi_1_per_m"] != 0.0) == spinning) & (table["upsilon_y"] > 0.0)
        drawn = np.flatnonzero(rows & (table["N_kN"] == load))
        first = drawn[0]
        creepage = table["upsilon_y"][drawn]
        spin = table["phi_1_per_m"][first]
        axes_m = (1e-3 * table["a_mm"][first], 1e-3 * table["b_mm"][first])
        smooth = np.geomspace(creepage.min(), creepage.max(), 300)
        upper, lower = axes[0][column], axes[1][column]
        for law, colour in colours.items():
            curve = [
                -creep_force(axes_m, 1e3 * load, (0.0, u, spin), FRICTION, SHEAR, POISSON, law)[0]
                / (FRICTION * 1e3 * load)
                for u in smooth
            ]
            upper.plot(smooth, curve, color=colour, linewidth=1.4, label=LAWS[law])
            error = -(forces(law) - table["Fy_over_muN"])
            lower.plot(table["upsilon_y"][rows], error[rows], "o", color=colour, markersize=3.0)
        upper.plot(creepage, -table["Fy_over_muN"][drawn], "o", color="black", markersize=4.0,
                   label="CONTACT")  # fmt: skip
        upper.axhline(1.0, color=RED, linewidth=0.7, linestyle=":")
        lower.axhline(0.0, color="black", linewidth=0.7)
        upper.set_xscale("log")
        words = f"spin {spin:.3f} 1/m" if spinning else "no spin"
        label(upper, "", "", f"{load:g} kN, {words}")
        label(lower, "lateral creepage, 1")
    label(axes[0][0], "", "force / (friction × load), 1", f"{load:g} kN, no spin")
    label(axes[1][0], "lateral creepage, 1", "law minus CONTACT, 1")
    legend(axes[0][0], loc="center left")
    return save(made, path)
