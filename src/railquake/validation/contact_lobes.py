"""Tread and flange bearing at once, against CONTACT's two lobes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from railquake.validation import contact_states
from railquake.validation.comparison import Outcome, Picture, absolute, at_most

TITLE = "Two points of contact near the flange"
SOURCE = contact_states.SOURCE
WHAT = (
    contact_states.SETTINGS
    + """ At a shift of -5 mm CONTACT finds two lobes of pressure, one on
the tread and one in the flange's throat, which it counts as one patch; ours are two patches. Their
places, and how they share the load."""
)
WHY = """The places: as for [a single contact](#contact-place), 1 mm. The share hangs on hundredths
of a millimetre in the profiles, as much as the approach itself; it is held within 0.08 at 100 kN.
At smaller loads the honest measure is the height by which the flange's side would have to be moved
to give CONTACT's share: it must be within 0.05 mm, the accuracy with which our profiles are its
profiles."""

OFFSET = 0.05  # mm


def compare(data: Path | None) -> Outcome:
    """Compare the lobes at every load."""
    case = contact_states.lobe_case()
    table = contact_states.numbers("lobes.csv")
    at_shift = table["y_ws_mm"] == case["shift"]
    shift = 1e-3 * case["shift"]
    results, shares = [], []
    for load in np.unique(table["N_kN"][at_shift]):
        rows = np.flatnonzero(at_shift & (table["N_kN"] == load))
        theirs = table["Fn_share"][rows]
        if len(rows) != 2:
            raise ValueError(f"{len(rows)} lobes at {load:g} kN")
        found = contact_states.patches(shift, 1e3 * load)
        shares.append((float(load), theirs, [patch[0] for patch in found]))
        for k, part in enumerate(("tread", "throat")):
            results.append(
                absolute(
                    f"{load:g} kN, {part}: place", "mm",
                    reference=table["y_cog_planar_mm"][rows][k], ours=1e3 * found[k][2],
                    tolerance=case["place"],
                )
            )  # fmt: skip
        if load == case["load"]:
            results.append(
                absolute(
                    f"{load:g} kN: share of the throat", "",
                    reference=theirs[1], ours=found[1][0], tolerance=case["share"],
                )
            )  # fmt: skip
        offset = brentq(
            lambda z, load=load, share=theirs[1]: (
                contact_states.patches(shift, 1e3 * load, z)[1][0] - share
            ),
            -2e-4, 2e-4, xtol=1e-9,
        )  # fmt: skip
        results.append(
            at_most(
                f"{load:g} kN: offset of the throat that gives CONTACT's share", "mm",
                ours=1e3 * abs(float(offset)), bound=OFFSET,
            )
        )  # fmt: skip
    text = "; ".join(
        f"{load:g} kN: here {100 * ours[0]:.0f} : {100 * ours[1]:.0f}, in CONTACT "
        f"{100 * theirs[0]:.0f} : {100 * theirs[1]:.0f}"
        for load, theirs, ours in shares
    )
    return Outcome(
        tuple(results),
        (
            Picture(
                "share",
                "Share of the flange's throat in the load at a shift of -5 mm, and what a move of "
                "its profile by 0.01 and 0.02 mm makes of it.",
                lambda path: write_picture(shift, shares, path),
            ),
        ),
        note=f"Tread and throat share the load as follows. {text}.",
    )


def write_picture(
    shift: float, shares: list[tuple[float, np.ndarray, list[float]]], path: Path
) -> Path:
    """Draw the throat's share over the load."""
    from railquake.plots.style import BLUE, ORANGE, SKY, figure, label, legend, save

    made, ax = figure(7.5, 3.6)
    loads = np.geomspace(3.0, 150.0, 60)
    for offset, style in ((0.0, "-"), (-1e-5, "--"), (-2e-5, ":")):
        share = [contact_states.patches(shift, 1e3 * load, offset)[1][0] for load in loads]
        name = "railquake" if offset == 0.0 else f"moved closer by {-1e3 * offset:g} mm"
        ax.plot(loads, share, style, color=SKY if offset else BLUE, linewidth=1.3, label=name)
    ax.plot(
        [load for load, _, _ in shares], [theirs[1] for _, theirs, _ in shares], "o",
        color=ORANGE, label="CONTACT",
    )  # fmt: skip
    ax.set_xscale("log")
    label(ax, "normal force, kN", "share of the throat, 1")
    legend(ax)
    return save(made, path)
