"""Each creep law beside CONTACT's exact results: a table and a figure for the docs.

    python benchmarks/creep_deviation.py [FOLDER]

FOLDER holds contact_creep.csv; ../shared/oracles beside the checkout by default.
"""

import csv
import sys
from pathlib import Path

import numpy as np

from railquake.plots.style import BLUE, GREEN, GREY, ORANGE, RED, figure, label, legend, save
from railquake.probe import creep_force

ROOT = Path(__file__).resolve().parents[1]
FRICTION, SHEAR, POISSON = 0.3, 82e9, 0.28  # of CONTACT's runs, from the file's first lines
LAWS = {
    "she": "Shen-Hedrick-Elkins",
    "carter": "Carter",
    "polach": "Polach",
    "coulomb": "Coulomb cap",
}


def read(folder):
    """Rows of the file as dictionaries of numbers."""
    with open(folder / "contact_creep.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return [{k: v if k == "geom" else float(v) for k, v in row.items()} for row in rows]


def ours(row, law):
    """Force over mu N of one row by one of our laws."""
    load = 1e3 * row["N_kN"]
    axes = (1e-3 * row["a_mm"], 1e-3 * row["b_mm"])
    spin = row["phi_1_per_m"]
    force, _ = creep_force(axes, load, row["upsilon_y"], spin, FRICTION, SHEAR, POISSON, law)
    return force / (FRICTION * load)


def table(rows):
    """Markdown: largest and root-mean-square deviation of each law."""
    lines = [
        "| geometry (wheel x rail radius, mm) | spin | points | "
        + " | ".join(f"{name}: max, rms" for name in LAWS.values())
        + " |",
        "|---" * (3 + len(LAWS)) + "|",
    ]
    for geometry in sorted({row["geom"] for row in rows}):
        for spinning in (False, True):
            chosen = [
                r for r in rows if r["geom"] == geometry and (r["phi_1_per_m"] != 0.0) == spinning
            ]
            if not chosen:
                continue
            cells = []
            for law in LAWS:
                d = np.array([ours(r, law) - r["Fy_over_muN"] for r in chosen])
                cells.append(f"{np.abs(d).max():.3f}, {np.sqrt(np.mean(d**2)):.3f}")
            spin = "with" if spinning else "none"
            lines.append(f"| {geometry} | {spin} | {len(chosen)} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def picture(rows, path):
    """Curves of one geometry and load, without and with spin."""
    made, axes = figure(9.0, 4.2, 1, 2, sharey=True)
    load = max(r["N_kN"] for r in rows)
    for ax, spinning in zip(axes, (False, True), strict=True):
        chosen = [
            r
            for r in rows
            if r["geom"] == "460x300"
            and r["N_kN"] == load
            and (r["phi_1_per_m"] != 0.0) == spinning
            and r["upsilon_y"] > 0.0  # the axis is logarithmic
        ]
        creepage = [r["upsilon_y"] for r in chosen]
        smooth = np.geomspace(min(creepage), max(creepage), 300)
        for law, colour in zip(LAWS, (BLUE, ORANGE, GREEN, GREY), strict=True):
            curve = [-ours({**chosen[0], "upsilon_y": u}, law) for u in smooth]
            ax.plot(smooth, curve, color=colour, label=LAWS[law])
        theirs = [-r["Fy_over_muN"] for r in chosen]
        ax.plot(creepage, theirs, "o", markersize=4, color="black", label="CONTACT")
        ax.axhline(1.0, color=RED, linewidth=0.7, linestyle=":")
        ax.set_xscale("log")
        spin = f"spin {chosen[0]['phi_1_per_m']:.3f} 1/m" if spinning else "no spin"
        label(ax, "lateral creepage, 1", "", f"{load:g} kN, {spin}")
    label(
        axes[0], "lateral creepage, 1", "force / (friction times load), 1", f"{load:g} kN, no spin"
    )
    legend(axes[0], loc="center left")
    save(made, path)


def main():
    """Write the docs' table and figure."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT.parent / "shared" / "oracles"
    rows = read(folder)
    text = table(rows)
    (ROOT / "docs" / "theory").mkdir(exist_ok=True, parents=True)
    (ROOT / "docs" / "images").mkdir(exist_ok=True, parents=True)
    (ROOT / "docs" / "theory" / "creep-deviation.md").write_text(text)
    picture(rows, ROOT / "docs" / "images" / "creep-laws.png")
    print(text)


if __name__ == "__main__":
    main()
