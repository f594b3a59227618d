"""The approach of wheel and rail under load, against CONTACT."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from railquake.validation import contact_states
from railquake.validation.comparison import Outcome, Picture, relative

TITLE = "Normal contact: the approach under load"
SOURCE = contact_states.SOURCE
WHAT = (
    contact_states.SETTINGS
    + """ The approach (how far the bodies come together along the
contact normal) for eight shifts and three loads each."""
)
WHY = f"""The law is Hertz' at the point of first contact; where the profiles are curved as there
over the whole patch, nothing but the profiles' own difference is left, and every state is within
{100 * contact_states.HERTZIAN_TOLERANCE:g} %; the tolerances are those found at each shift,
rounded up. Where the profiles fit closely Hertz' ellipse is only a rough picture. Whether they do
is decided from the profiles alone: a contact is called *nearly conformal* where the undeformed gap
differs from the parabola that Hertz assumes by more than {100 * contact_states.CONFORMAL:g} % of
its value at the edge of the ellipse. There, and nowhere else, larger tolerances are stated: they
are not errors of the implementation but what a point contact costs. Shifts of -7 and -9 mm put the
flange on the rail with the wheelset held level, a test of the geometry alone."""


def compare(data: Path | None) -> Outcome:
    """Compare all states with a single patch."""
    states = contact_states.states()
    results = tuple(
        relative(
            state.name, "mm", reference=state.theirs["approach"], ours=state.ours["approach"],
            tolerance=state.tolerance["approach"],
        )
        for state in states
    )  # fmt: skip
    worst = {
        kind: max(r.difference for r, s in zip(results, states, strict=True) if s.conformal == kind)
        for kind in (True, False)
    }
    return Outcome(
        results,
        (Picture("loads", "Normal force against approach for each shift.", write_picture),),
        note=f"In short: within {100 * worst[False]:.1f} % where the contact is not nearly "
        f"conformal, and up to {100 * worst[True]:.0f} % too large where it is.",
    )


def write_picture(path: Path) -> Path:
    """Draw the approach for each shift: CONTACT's as dots, ours as lines."""
    from railquake.plots.style import BLUE, ORANGE, RED, figure, label, save

    states = contact_states.states()
    shifts = sorted({state.shift for state in states})
    made, axes = figure(9.0, 5.6, 3, 3, sharex=True, sharey=True)
    for ax, shift in zip(np.ravel(axes), shifts, strict=False):
        chosen = [state for state in states if state.shift == shift]
        loads = np.geomspace(4.0, 180.0, 40)
        ours = [1e3 * max(contact_states.patches(1e-3 * shift, 1e3 * load))[1] for load in loads]
        ax.plot(ours, loads, color=BLUE, linewidth=1.0, label="railquake")
        for conformal, colour, name in (
            (False, ORANGE, "CONTACT"),
            (True, RED, "CONTACT, nearly conformal"),
        ):
            points = [state for state in chosen if state.conformal == conformal]
            ax.plot(
                [state.theirs["approach"] for state in points],
                [state.load for state in points],
                "o", color=colour, markersize=4.0, label=name,
            )  # fmt: skip
        ax.set_xscale("log")
        ax.set_yscale("log")
        label(ax, "", "", f"shift {shift:g} mm".replace("-", "\u2212"))
    for ax in axes[-1]:
        label(ax, "approach, mm")
    for ax in axes[:, 0]:
        label(ax, "", "normal force, kN")
    for ax in np.ravel(axes)[len(shifts) :]:
        ax.set_axis_off()
    named = np.ravel(axes)[0].get_legend_handles_labels()
    made.legend(*named, loc="lower right", bbox_to_anchor=(0.95, 0.15), frameon=False, fontsize=9)
    return save(made, path)
