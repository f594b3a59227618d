"""The normal contact of one bearing wheel whose wheelset has rolled, against CONTACT."""

from __future__ import annotations

import math
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np

from railquake.validation import contact_states
from railquake.validation.comparison import Outcome, Picture, absolute, relative
from railquake.validation.reference import columns, numbers_beside

TITLE = "Normal contact of a wheel that bears alone"
SOURCE = """CONTACT (Vollebregt; Kalker's exact half-space theory), revision 2707, S1002 wheel on
UIC60 rail, 1:40, frictionless, steel E 209.92 GPa, nu 0.28. The file beside the module holds the
columns used here of the reference data's `contact_rolled.csv`."""
WHAT = """The wheelset has rolled by 0.3 to 4 degrees about its left wheel, whose own displacement
on its rail is 6 to 12 mm towards the flange; normal forces of 20, 60 and 150 kN. The approach and
the contact angle, and the displacement at which the contact jumps from the throat to the
flange."""
WHY = """As with the level wheelset a point contact knows nothing of what the profiles do beside
it: states that are nearly conformal by the profiles alone and those that bear on two patches or on
a patch with two lobes are listed and not bounded. So are those beside the jump, nearer than its own
bound: there the angle changes by 40 degrees within a tenth of a millimetre, and CONTACT's patch
reaches over the jump."""

HALF_SPACING, RADIUS = 0.750, 0.460  # m, of the running circle
STEP = 0.01  # mm, of the search for the jump
APPROACH, ANGLE, JUMP = 0.05, 1.0, 0.3  # relative, degrees, mm


class State(NamedTuple):
    """One of CONTACT's results, and ours."""

    roll: float  # degrees
    displacement: float  # of the left wheel, mm to the right
    load: float  # kN
    excluded: str  # why it is listed only; empty: it is bounded
    theirs: tuple[float, float]  # approach, mm; angle, degrees
    ours: tuple[float, float]


def shift(displacement: float, roll: float) -> float:
    """Of the wheelset's centre to the right, m, whose left wheel is displaced so; roll in rad."""
    return displacement + HALF_SPACING * (math.cos(roll) - 1.0) - RADIUS * math.sin(roll)


def deepest(displacement: float, roll: float, load: float) -> tuple[float, float, float]:
    """Share, approach (mm) and angle (degrees, positive on the flange) of the patch in most load.

    Displacement in m, roll in rad, load in N.
    """
    found = contact_states.patches(shift(displacement, roll), load, roll=roll)
    share, approach, _, angle = max(found)
    return share, 1e3 * approach, math.degrees(angle)


def states() -> list[State]:
    """All of CONTACT's states, in the order of the file."""
    table = columns(numbers_beside("contact_rolled", "rolled.csv"))
    keys = list(
        dict.fromkeys(zip(table["roll_deg"], table["y_wheel_mm"], table["N_kN"], strict=True))
    )
    found = []
    for roll, displacement, load in keys:
        rows = np.flatnonzero(
            (table["roll_deg"] == roll)
            & (table["y_wheel_mm"] == displacement)
            & (table["N_kN"] == load)
        )
        most = rows[np.argmax(table["Fn_patch_kN"][rows])]
        normal = 1e3 * float(table["Fn_total_kN"][most])
        angle = math.radians(roll)
        share, *ours = deepest(1e-3 * displacement, angle, normal)
        excluded = _excluded(
            len(rows) > 1 or table["n_lobes"][rows].max() > 1.0 or share < 0.9999,
            contact_states.departure(shift(1e-3 * displacement, angle), normal, angle),
            abs(displacement - jump(float(roll))),
        )
        found.append(
            State(
                float(roll), float(displacement), float(load), excluded,
                (float(table["pen_mm"][most]), math.degrees(table["angle_rad"][most])),
                (ours[0], ours[1]),
            )
        )  # fmt: skip
    return found


def _excluded(two: bool, departs: float, from_jump: float) -> str:
    if two:
        return "two patches or lobes"
    if departs > contact_states.CONFORMAL:
        return "nearly conformal"
    return "beside the jump" if from_jump < JUMP + STEP else ""


@cache
def jump(roll: float) -> float:
    """Displacement of the left wheel at which a light contact jumps to the flange, mm."""
    places = np.arange(-5.0, -11.0, -STEP)
    angles = [deepest(1e-3 * place, math.radians(roll), 100.0)[2] for place in places]
    return float(places[int(np.argmax(np.diff(angles))) + 1])


def compare(data: Path | None) -> Outcome:
    """The largest differences at each roll, and the jump."""
    known = states()
    results = []
    for roll in sorted({state.roll for state in known}):
        bounded = [state for state in known if state.roll == roll and not state.excluded]
        far = max(bounded, key=lambda state: abs(state.ours[0] / state.theirs[0] - 1.0))
        turned = max(bounded, key=lambda state: abs(state.ours[1] - state.theirs[1]))
        at = f"{roll:g}°, {len(bounded)} states"
        results += [
            relative(f"{at}: largest difference of the approach", "mm", reference=far.theirs[0],
                     ours=far.ours[0], tolerance=APPROACH),
            absolute(f"{at}: largest difference of the angle", "°", reference=turned.theirs[1],
                     ours=turned.ours[1], tolerance=ANGLE),
        ]  # fmt: skip
        light = [state for state in known if state.roll == roll and state.load == 20.0]
        before, after = next(
            pair for pair in pairwise(light) if pair[1].theirs[1] - pair[0].theirs[1] > 15.0
        )
        ours = jump(roll)
        nearest = min(max(ours, after.displacement), before.displacement)
        results.append(
            absolute(f"{at}: jump to the flange (theirs: the nearest place between its states)",
                     "mm", reference=nearest, ours=ours, tolerance=JUMP)
        )  # fmt: skip
    listed = "; ".join(
        f"{s.roll:g}°, {s.displacement:g} mm, {s.load:g} kN ({s.excluded}): approach "
        f"{100.0 * (s.ours[0] / s.theirs[0] - 1.0):+.1f} %, angle {s.ours[1] - s.theirs[1]:+.1f}°"
        for s in known
        if s.excluded
    )
    return Outcome(
        tuple(results),
        (Picture("angles", "Contact angle over the wheel's displacement.", write_picture),),
        note=f"Listed only: {listed}.",
    )


def write_picture(path: Path) -> Path:
    """Draw the angle over the displacement: CONTACT's as dots, ours as lines."""
    from railquake.plots.style import BLUE, ORANGE, RED, figure, label, save

    known = states()
    rolls = sorted({state.roll for state in known})
    made, axes = figure(9.0, 5.2, 2, 2, sharex=True, sharey=True)
    for ax, roll in zip(np.ravel(axes), rolls, strict=True):
        places = np.arange(-12.5, -5.5, 0.05)
        ours = [deepest(1e-3 * place, math.radians(roll), 20e3)[2] for place in places]
        ax.plot(places, ours, color=BLUE, linewidth=1.0, label="railquake, 20 kN")
        for excluded, colour, name in (
            (False, ORANGE, "CONTACT"), (True, RED, "CONTACT, listed only"),
        ):  # fmt: skip
            points = [s for s in known if s.roll == roll and bool(s.excluded) == excluded]
            ax.plot(
                [s.displacement for s in points], [s.theirs[1] for s in points], "o", color=colour,
                markersize=3.5, label=name,
            )  # fmt: skip
        label(ax, "", "", f"roll {roll:g}°")
    for ax in axes[-1]:
        label(ax, "displacement of the wheel, mm")
    for ax in axes[:, 0]:
        label(ax, "", "contact angle, °")
    np.ravel(axes)[0].legend(frameon=False, fontsize=8)
    return save(made, path)
