"""A wheel sliding on its flange: Nadal's limit, and the limit of climbing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railquake.validation.bodies import block, disturbed, motion, pair_of
from railquake.validation.comparison import Outcome, Picture, relative

TITLE = "A wheel on its flange: Nadal's limit"
SOURCE = """Nadal (1908): a wheel that slides down on a flange of angle $\\gamma$ has $Y/Q =
(\\tan\\gamma-\\mu)/(1+\\mu\\tan\\gamma)$, one that climbs $Y/Q =
(\\tan\\gamma+\\mu)/(1-\\mu\\tan\\gamma)$; the flank of the drawn wheel has 64.55°."""
WHAT = """A standing block, raised on its right-hand flange's flank, is let go downwards and
pushed upwards at 0.3 m/s, the ground holding it against the rail; lateral over vertical force of
that wheel while the flank touches, for two coefficients of friction."""
WHY = """The flank is straight, so the angle is exact but for the wheelset's roll, which is
measured and taken off. The flank's friction is Coulomb's, as in the closed forms."""

FLANK = np.degrees(np.arctan2(0.6471 - 0.4278, 1.7424 - 1.6380))
TOLERANCE = 1e-3
RADIUS = 0.392  # m
CASES = ((0.15, -1.0), (0.15, 1.0), (0.3, -1.0), (0.3, 1.0))


def compare(data: Path | None) -> Outcome:
    """Slide down and up."""
    results = []
    for friction, way in CASES:
        angle, found = slide(friction, way)
        tangent = np.tan(angle)
        expected = (tangent + way * friction) / (1.0 - way * friction * tangent)
        name = "climbing" if way > 0.0 else "sliding down (Nadal)"
        results.append(
            relative(f"Y/Q {name}, $\\mu$ = {friction:g}, {np.degrees(angle):.2f}°", "",
                     reference=float(expected), ours=found, tolerance=TOLERANCE)
        )  # fmt: skip

    def draw(path: Path) -> None:
        from railquake.validation.drawing import curves

        mu = np.linspace(0.0, 0.4, 100)
        tangent = np.tan(np.radians(FLANK))
        limits = [((tangent + w * mu) / (1.0 - w * mu * tangent), w) for w in (-1.0, 1.0)]
        ours = [
            (np.array([c[0] for c in CASES if c[1] == way]),
             np.array([r.ours for r, c in zip(results, CASES, strict=True) if c[1] == way]), name)
            for way, name in ((-1.0, "sliding down"), (1.0, "climbing"))
        ]  # fmt: skip
        closed = [(mu, limit, "") for limit, _ in limits]
        curves(path, "friction", "Y/Q", ours, closed, style="o")

    caption = "Lateral over vertical force on the flange: runs (points), closed forms (dashed)."
    return Outcome(tuple(results), (Picture("limit", caption, draw),))


def slide(friction: float, way: float) -> tuple[float, float]:
    """Contact angle in the track's axes, and Y/Q of the right-hand wheel."""
    import railquake as rq
    from railquake.march.compiler import PYTHON

    case: dict[str, Any] = {
        "vehicle": block(4000.0, 2000.0, RADIUS),
        "wheelrail": pair_of(
            RADIUS, friction=friction, restitution=0.0, flange_creep_law="coulomb"
        ),
        "support": "at-grade",
        # the block is left behind to the right, against the rail
        "motion": motion(1e-3, [-40.0] * 5),
        "allow_high_pga": True,
        "dt": 1e-5,
        "history_step": 1e-4,
    }
    system = rq.assemble(rq.scenario(**case))
    slope = np.radians(FLANK)
    velocity = 0.3 * way * np.array([np.cos(slope), -np.sin(slope), 0.0])
    # on the middle of the flank, both wheels lifted alike, until it just touches
    shift, rise = 11e-3, 4e-3
    for _ in range(2):
        pushed = disturbed(
            system, {"wheelset": (shift, -rise, 0.0)}, {"wheelset": velocity.tolist()}
        )
        response = rq.simulate(pushed, target=PYTHON)
        rise += float(response.channel("penetration_right_flange_m")[1]) - 1e-4
    within = slice(20, 36)
    ratio = (
        response.channel("lateral_force_n")[within] / response.channel("wheel_load_right_n")[within]
    )
    roll = response.channel("relative_roll_rad")[within]
    return float(slope - roll.mean()), float(ratio.mean())
