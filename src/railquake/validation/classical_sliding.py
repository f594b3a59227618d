"""A block that slides over its rails at mu g."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railquake.validation.bodies import GRAVITY, block, disturbed, motion, pair_of
from railquake.validation.comparison import Outcome, Picture, relative

TITLE = "A block that slides"
SOURCE = """Coulomb: over ground that accelerates by $a > \\mu g$ a block is left behind with
$a-\\mu g$, and pushes it by $\\mu$ times its weight."""
WHAT = """A standing block on two cylindrical treads; the ground starts with $a$ at once.
Relative acceleration from a parabola through 20 to 60 ms, before a flange is reached, and the
lateral force then. Two accelerations, both directions."""
WHY = """Friction is Kalker's creep, saturated: sliding is full from a slip of some mm/s, after
the first milliseconds. The rails' crowns are round, and the block settles on them by some
micrometres."""

MASS, DT = 4000.0, 2e-5
CASES = ((0.3, 5.0), (0.3, -5.0), (0.15, 4.0))


def compare(data: Path | None) -> Outcome:
    """Slide by each case."""
    results, lines, references = [], [], []
    for friction, ground in CASES:
        time, shift, force = slide(friction, ground)
        expected = -np.sign(ground) * (abs(ground) - friction * GRAVITY)
        within = (time > 0.02) & (time < 0.06)
        found = 2.0 * np.polyfit(time[within], shift[within], 2)[0]
        where = f"$\\mu$ = {friction:g}, ground {ground:g} m/s²"
        results += [
            relative(
                f"relative acceleration, {where}", "m/s²",
                reference=expected, ours=float(found), tolerance=0.005,
            ),
            relative(
                f"lateral force, {where}", "N",
                reference=-np.sign(ground) * friction * MASS * GRAVITY,
                ours=float(force[within].mean()), tolerance=0.002,
            ),
        ]  # fmt: skip
        lines.append((1e3 * time, 1e3 * shift, where))
        references.append((1e3 * time, 500.0 * expected * time**2, ""))
    caption = "Shift of the block on its rails, and $\\frac12(a-\\mu g)t^2$ (dashed)."
    return Outcome(
        tuple(results), (Picture("shift", caption, lambda path: draw(lines, references, path)),)
    )


def slide(friction: float, ground: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, lateral shifts and lateral forces on the track."""
    import railquake as rq
    from railquake.march.compiler import PYTHON

    case: dict[str, Any] = {
        "vehicle": block(MASS, 2000.0, 0.4),
        "wheelrail": pair_of(0.4, friction=friction),
        "support": "at-grade",
        "motion": motion(5e-3, [ground] * 13),
        "dt": DT,
    }
    response = rq.simulate(disturbed(rq.assemble(rq.scenario(**case)), {}, {}), target=PYTHON)
    return response.times, response.channel("lateral_shift_m"), response.channel("lateral_force_n")


def draw(lines: list[Any], references: list[Any], path: Path) -> None:
    """Shifts against time."""
    from railquake.validation.drawing import curves

    curves(path, "time [ms]", "lateral shift [mm]", lines, references)
