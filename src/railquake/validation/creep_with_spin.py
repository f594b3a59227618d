"""Creep force with the spin of a flange and longitudinal slip: each law beside CONTACT."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from railquake.probe import creep_force
from railquake.validation.comparison import Outcome, Result, at_most
from railquake.validation.reference import columns, numbers_beside, toml

__all__ = ["LAWS", "compare", "errors", "numbers", "summary"]

TITLE = "Creep force on flanges, each law"
SOURCE = """CONTACT (Vollebregt; Kalker's exact half-space theory; open source, revision 2707),
steady rolling of Hertzian ellipses with a/b 0.3 to 18, steel G 82 GPa, nu 0.28, mu 0.3, the grid's
error extrapolated away. `contact_flange_creep.csv` beside the module holds the reference data's
columns that are needed; its first lines hold every setting and the signs."""
WHAT = """Both forces over mu N for 396 combinations of longitudinal and lateral creepage: 144
without spin, 202 with the spin of a flange of 20 to 70 degrees, 50 of spin alone."""
WHY = """The law for large spin is to be within 0.06 of friction's limit in the mean and 0.2
everywhere, for either force. The other laws' errors are properties of the laws, not of the program:
their bounds are those found, rounded up, and are there for a user to choose by. CONTACT's own error
is 0.002 at most."""

FRICTION, SHEAR, POISSON = 0.3, 82e9, 0.28
LAWS = {
    "fastsim": "Kalker's simplified theory",
    "she": "Shen-Hedrick-Elkins",
    "carter": "Carter",
    "polach": "Polach",
    "coulomb": "Coulomb cap",
}
PARTS = {"no_spin": "no spin", "flange": "with a flange's spin", "pure_spin": "spin alone"}
ALL_MEAN, ALL_LARGEST = 0.06, 0.2  # what the law for large spin is to keep


@cache
def numbers() -> dict[str, Any]:
    """CONTACT's forces."""
    return columns(numbers_beside("creep_with_spin", "contact_flange_creep.csv"))


@cache
def errors(law: str) -> Any:
    """Ours minus CONTACT's (F_x, F_y) over mu N, shape (rows, 2)."""
    table = numbers()
    names = ("N_kN", "a_mm", "b_mm", "xi_x", "xi_y", "phi_1_per_m")
    found = []
    for load, a, b, *creepages in zip(*(table[name] for name in names), strict=True):
        along, lateral, spin = creepages
        force = creep_force(
            (1e-3 * a, 1e-3 * b), 1e3 * load, (along, lateral, spin),
            FRICTION, SHEAR, POISSON, law,
        )  # fmt: skip
        found.append(np.array([force.longitudinal, force.lateral]) / (FRICTION * 1e3 * load))
    return np.array(found) - np.column_stack([table["Fx_over_muN"], table["Fy_over_muN"]])


def summary(law: str) -> dict[str, float]:
    """Mean and largest absolute error of either force on all rows, and the largest by part."""
    off = np.abs(errors(law))
    found = {
        "mean_x": float(off[:, 0].mean()),
        "mean_y": float(off[:, 1].mean()),
        "largest_x": float(off[:, 0].max()),
        "largest_y": float(off[:, 1].max()),
    }
    for part in PARTS:
        found[part] = float(off[numbers()["part"] == part].max())
    return found


def compare(data: Path | None) -> Outcome:
    """Hold every law against every number."""
    bounds = toml(numbers_beside("creep_with_spin", "bounds.toml"))
    results: list[Result] = []
    note = [
        "Errors of either force over mu N on all rows, and the largest of both by kind of row:",
        "",
        "| `creep_law` | | mean, F_x | F_y | largest, F_x | F_y | "
        + " | ".join(PARTS.values())
        + " |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for law, name in LAWS.items():
        found = summary(law)
        for key, words in (("mean", "mean"), ("largest", "largest")):
            for axis in ("x", "y"):
                results.append(
                    at_most(f"{name}: {words} error of F_{axis}/(mu N)", "",
                            ours=found[f"{key}_{axis}"], bound=bounds[law][f"{key}_{axis}"])
                )  # fmt: skip
        cells = " | ".join(f"{value:.3f}" for value in found.values())
        note.append(f"| `{law}` | {name} | {cells} |")
    off = np.abs(errors("fastsim"))
    results += [
        at_most("Kalker's simplified theory: mean error of the worse force", "",
                ours=float(off.mean(axis=0).max()), bound=ALL_MEAN),
        at_most("Kalker's simplified theory: largest error of either force", "",
                ours=float(off.max()), bound=ALL_LARGEST),
    ]  # fmt: skip
    note += [
        "",
        "The laws that reduce the magnitude of the linear force cannot turn it: spin alone pushes",
        "with them as long as it grows, while in truth the slip turns about the middle of the",
        "contact and pushes less and less.",
    ]
    return Outcome(tuple(results), note="\n".join(note))
