"""Where wheel and rail touch and under which angle, against CONTACT."""

from __future__ import annotations

from pathlib import Path

from railquake.validation import contact_states
from railquake.validation.comparison import Outcome, Picture, absolute

TITLE = "Contact place and angle"
SOURCE = contact_states.SOURCE
WHAT = (
    contact_states.SETTINGS
    + """ Ours is the point of first contact, CONTACT's the centre of
pressure and the angle of the contact plane at its reference point; both in track axes."""
)
WHY = """A point is held against the centre of a patch that is 4 to 25 mm wide: where the curvatures
change across it the centre lies beside the point of first contact, by up to 0.5 mm for most states
and 4 mm where the contact is nearly conformal (decided from the profiles, see
[the approach](#contact-approach)). The tolerances are those found at each shift, rounded up. At
-7 mm from 50 kN on CONTACT's reference point moves along the curved flange, hence the angle's
tolerance there."""


def compare(data: Path | None) -> Outcome:
    """Compare all states with a single patch."""
    results = []
    for state in contact_states.states():
        for quantity, unit in (("place", "mm"), ("angle", "rad")):
            results.append(
                absolute(
                    f"{state.name}: {quantity}", unit,
                    reference=state.theirs[quantity], ours=state.ours[quantity],
                    tolerance=state.tolerance[quantity],
                )
            )  # fmt: skip
    return Outcome(
        tuple(results),
        (
            Picture(
                "shifts",
                "Place and angle of the contact over the wheelset's shift; CONTACT's points for "
                "all loads, and the jump of ours where the contact leaves one part of the profiles "
                "for another.",
                write_picture,
            ),
        ),
    )


def write_picture(path: Path) -> Path:
    """Draw place and angle over the shift."""
    import numpy as np

    from railquake.plots.style import BLUE, ORANGE, RED, figure, label, legend, save

    states = contact_states.states()
    made, axes = figure(8.5, 5.4, 2, 1, sharex=True)
    shifts = np.linspace(-9.3, 5.3, 293)
    first = [max(contact_states.patches(1e-3 * shift, 1e3)) for shift in shifts]
    lines = {"place": [1e3 * patch[2] for patch in first], "angle": [patch[3] for patch in first]}
    for ax, quantity, unit in zip(axes, ("place", "angle"), ("mm", "rad"), strict=True):
        line = np.array(lines[quantity])
        line[1:][np.abs(np.diff(line)) > 0.1 * np.ptp(line)] = np.nan
        ax.plot(shifts, line, color=BLUE, linewidth=1.2, label="railquake, 1 kN")
        for conformal, colour, name in (
            (False, ORANGE, "CONTACT"),
            (True, RED, "CONTACT, nearly conformal"),
        ):
            points = [state for state in states if state.conformal == conformal]
            ax.plot(
                [state.shift for state in points],
                [state.theirs[quantity] for state in points],
                "o", color=colour, markersize=4.5, label=name,
            )  # fmt: skip
        label(ax, "", f"{quantity}, {unit}")
    legend(axes[0])
    label(axes[-1], "shift of the wheelset, mm")
    return save(made, path)
