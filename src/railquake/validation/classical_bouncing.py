"""A wheel that bounces: rebound over approach against what the normal law promises."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railquake.validation.bodies import GRAVITY, block, disturbed, motion, pair_of
from railquake.validation.comparison import Outcome, Picture, relative

TITLE = "A bouncing wheel"
SOURCE = """Hunt and Crossley (1975): with $x = \\delta'/\\delta'_0$ the motion during a free
impact gives $\\alpha(1+e) = \\ln\\frac{1+\\alpha}{1-\\alpha e}$ for the rebound $e$, whatever
mass, stiffness and speed; it is solved here. As printed $\\alpha = \\frac32(1-c_r)$; as
calibrated it is chosen so that $e = c_r$. With constant hysteresis $\\alpha$ grows with
$\\delta'_0$, and is the printed one at 1 m/s."""
WHAT = """A block on its two wheels falls on the rails at 1 m/s, weightless (the ground falls
with $g$) and without friction; the speed at which it leaves them over that at which it met them."""
WHY = """The contact lasts some hundred steps of 5e-6 s, and its onset and loss are noticed
within one of them, when next to no force acts: a tenth of a per cent is ample."""

TOLERANCE = 1e-3
CASES = (
    ("hunt-crossley", 0.9), ("hunt-crossley", 0.6), ("hunt-crossley", 0.3), ("hunt-crossley", 0.0),
    ("calibrated", 0.9), ("calibrated", 0.6), ("calibrated", 0.3), ("constant-hysteresis", 0.6),
)  # fmt: skip
MASS, SPEED, DT = 2000.0, 1.0, 5e-6


def compare(data: Path | None) -> Outcome:
    """Bounce once by each law and coefficient."""
    bounces = {case: bounce(*case) for case in CASES}
    results = tuple(
        relative(
            f"rebound, {law}, $c_r$ = {restitution:g}", "",
            reference=promised(law, restitution), ours=float(-speed[-1] / speed[0]),
            tolerance=TOLERANCE,
        )
        for (law, restitution), (_, speed) in bounces.items()
    )  # fmt: skip
    return Outcome(results, (Picture("speeds", CAPTION, lambda path: draw(bounces, path)),))


def promised(law: str, restitution: float) -> float:
    """Rebound of a free impact."""
    from scipy.optimize import brentq

    if law == "calibrated":
        return restitution
    alpha = 1.5 * (1.0 - restitution)  # of the constant law at its reference rate, `SPEED`

    def excess(e: float) -> float:
        return float(alpha * (1.0 + e) - np.log((1.0 + alpha) / (1.0 - alpha * e)))

    # e = -1 is the trivial root; at the pole 1/alpha the excess falls without bound
    return float(brentq(excess, 1e-9, min(1.0, (1.0 - 1e-12) / alpha)))


def bounce(law: str, restitution: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and downward speeds, from just before the impact to just after."""
    import railquake as rq
    from railquake.march.compiler import PYTHON

    frames = 50
    case: dict[str, Any] = {
        "vehicle": block(MASS, 1000.0, 0.4),
        "wheelrail": pair_of(0.4, friction=0.0, restitution=restitution, restitution_law=law),
        "support": "at-grade",
        "motion": motion(1e-4, [0.0] * (frames + 1)),
        "vertical": motion(1e-4, [-GRAVITY] * (frames + 1)),
        "dt": DT,
        "history_step": 1e-4,
    }
    system = rq.assemble(rq.scenario(**case))
    falling = disturbed(system, {"wheelset": (0.0, -4e-4, 0.0)}, {"wheelset": (0.0, SPEED, 0.0)})
    response = rq.simulate(falling, target=PYTHON)
    speed = np.diff(response.channel("wheelset_vertical_m")) / 1e-4
    return response.times[2:], speed[1:]


CAPTION = "Downward speed of the wheel: from 1 m/s to its rebound, by each law."


def draw(bounces: dict[tuple[str, float], tuple[np.ndarray, np.ndarray]], path: Path) -> None:
    """Speeds against time."""
    from railquake.validation.drawing import curves

    lines = [
        (1e3 * time, speed, f"{law}, $c_r$ = {restitution:g}")
        for (law, restitution), (time, speed) in bounces.items()
    ]
    curves(path, "time [ms]", "downward speed [m/s]", lines)
