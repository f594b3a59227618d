"""A block on two rails: the acceleration that lifts it, its rocking, and what an impact takes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railquake.validation.bodies import GRAVITY, block, disturbed, motion, pair_of
from railquake.validation.comparison import Outcome, Picture, relative

TITLE = "A block that rocks on two rails"
SOURCE = """Housner (1963), *The behavior of inverted pendulum structures during earthquakes*: a
block of half-width $b$ and height of the centre of gravity $h$ lifts at $a = g\\,b/h$; about an
edge $I_0\\ddot\\theta = -mgR\\sin(\\alpha-\\theta)$, whence the free rocking period by one
quadrature; for a slender block $\\frac4p\\cosh^{-1}\\frac1{1-\\theta_0/\\alpha}$, $p^2 =
mgR/I_0$. The impact on the other rail with restitution $e$, no slip, the other edge free:
$\\omega'/\\omega = (A-b(1+2e))/(A+b)$, $A = (I+mh^2)/(mb)$, which for $e = 0$ is Housner's
$1-\\frac{mR^2}{I_0}(1-\\cos2\\alpha)$."""
WHAT = """A tall block on wheels with a flat tread, on rails with a narrow head (10 mm),
standing, with much friction. The ground's acceleration grows slowly until a wheel lifts; the
block is let go from a tilt of 0.12 $\\alpha$ and from 0.9 $\\alpha$, and the time to the upright is
a quarter of the period; the roll rate just before and just after the first impact gives its ratio,
for two calibrated restitutions."""
WHY = """The pivot moves with the head's rounding, by up to 10 mm times the tilt, and creeps
sideways. During the impact the other wheel's contact spring unloads, and creep lets the feet
slip a little."""

MASS, INERTIA, HEIGHT = 4000.0, 10000.0, 2.5
HEAD = 0.010  # m, radius of the rail's head
HALF = 0.8721217  # m, half the distance of the crowns: 34.3355 in
ALPHA = np.arctan2(HALF, HEIGHT)
TILT, FAR = 0.12, 0.9  # of alpha
IMPACTS = (0.2, 0.5)


def compare(data: Path | None) -> Outcome:
    """Lift, rock, strike."""
    reach = np.hypot(HALF, HEIGHT)
    about_edge = INERTIA + MASS * reach**2
    p = np.sqrt(MASS * GRAVITY * reach / about_edge)
    time, roll = rock(0.5)
    to_upright = upright(roll)
    results = [
        relative("acceleration at which a wheel lifts", "m/s²", reference=GRAVITY * HALF / HEIGHT,
                 ours=lifting_acceleration(), tolerance=5e-3),
        relative("quarter of the rocking period", "s", reference=time_from_tilt(p, 0.0),
                 ours=float(np.interp(0.0, -roll[:to_upright], time[:to_upright])), tolerance=0.01),
        relative("quarter of the rocking period from 0.9 of the critical angle", "s",
                 reference=time_from_tilt(p, 0.0, FAR), ours=far_quarter(), tolerance=0.02),
    ]  # fmt: skip
    sway = (INERTIA + MASS * HEIGHT**2) / (MASS * HALF)
    for restitution in IMPACTS:
        expected = (sway - HALF * (1.0 + 2.0 * restitution)) / (sway + HALF)
        results.append(
            relative(f"roll rate after over before the impact, $e$ = {restitution:g}", "",
                     reference=float(expected), ours=strike(restitution), tolerance=0.02)
        )  # fmt: skip
    tilts = TILT * ALPHA * (1.0 - np.linspace(0.02, 1.0, 50) ** 2)
    closed = np.array([time_from_tilt(p, tilt) for tilt in tilts])

    def draw(path: Path) -> None:
        from railquake.validation.drawing import curves

        curves(path, "time [s]", "roll [mrad]", [(time, 1e3 * roll, "run")],
               [(closed, 1e3 * tilts, "closed form")])  # fmt: skip

    caption = "The block let go from a tilt: a quarter period, an impact on the other rail."
    return Outcome(tuple(results), (Picture("rocking", caption, draw),))


def far_quarter() -> float:
    """Time to the upright from far up, s."""
    time, roll = rock(0.5, 3.0, FAR)
    to_upright = upright(roll)
    return float(np.interp(0.0, -roll[:to_upright], time[:to_upright]))


def time_from_tilt(p: float, roll: float, tilt: float = TILT) -> float:
    """Time from the tilt down to a roll, by the energy integral of the equation of motion."""
    from scipy.integrate import quad

    start = tilt * ALPHA

    def slowness(s: float) -> float:  # theta = start (1 - s^2) takes the singularity out
        drop = np.cos(ALPHA - start) - np.cos(ALPHA - start * (1.0 - s * s))
        return float(2.0 * start * s / (p * np.sqrt(2.0 * drop)))

    return float(quad(slowness, 1e-9, np.sqrt(1.0 - roll / start))[0])


def upright(roll: np.ndarray) -> int:
    """Number of the first frame past the upright, and one more."""
    return int(np.argmax(roll < 0.0)) + 1


def case(**changes: Any) -> dict[str, Any]:
    """The block on its rails."""
    deep = 0.05
    arc = {
        "kind": "arc", "start": [0.0, 0.0], "end": [HEAD * np.sin(1.4), HEAD * (1 - np.cos(1.4))],
        "centre": [0.0, HEAD], "radius": HEAD,
    }  # fmt: skip
    side = {
        "kind": "line", "start": arc["end"],
        "end": [HEAD * np.sin(1.4) + deep / np.tan(1.4), HEAD * (1 - np.cos(1.4)) + deep],
    }  # fmt: skip
    wheel = [
        {"kind": "line", "start": [0.07, 0.0], "end": [-0.04, 0.0]},
        {"kind": "line", "start": [-0.04, 0.0], "end": [-0.05, 0.03]},
        {"kind": "line", "start": [-0.05, 0.03], "end": [-0.07, 0.0]},
    ]
    return {
        "vehicle": block(MASS, INERTIA, HEIGHT),
        "wheelrail": pair_of(
            HEIGHT, friction=2.0, running_circle=HALF, rail_centre=HALF,
            wheel={"unit": "m", "segments": wheel},
            rail={"unit": "m", "mirror": True, "segments": [arc, side]},
            restitution_law="calibrated", **{"restitution": 0.5, **changes.pop("wheelrail", {})},
        ),
        "support": "at-grade",
        "dt": 2e-5,
        **changes,
    }  # fmt: skip


def lifting_acceleration() -> float:
    """Ground acceleration when a wheel first leaves its rail; it grows by 1 m/s2 each second."""
    import railquake as rq

    expected = GRAVITY * HALF / HEIGHT
    time = np.arange(0.0, 1.2 * expected, 0.01)
    response = rq.simulate(rq.scenario(**case(motion=motion(0.01, time))))
    lifts = next(event for event in response.events if event.name == "uplift")
    return lifts.begin_s


def rock(
    restitution: float, seconds: float = 1.6, share: float = TILT, **changes: Any
) -> tuple[np.ndarray, np.ndarray]:
    """Times and rolls of the block let go from a share of alpha about the right rail."""
    import railquake as rq

    tilt = share * ALPHA
    steps = int(seconds / 0.01) + 1
    system = rq.assemble(
        rq.scenario(
            **case(
                motion=motion(0.01, [0.0] * steps),
                wheelrail={"restitution": restitution},
                **changes,
            )
        )
    )
    # turned about the right-hand contact: right side down, the centre moves right and up
    moved = (
        HEIGHT * np.sin(tilt) + HALF * (1.0 - np.cos(tilt)),
        HEIGHT * (1.0 - np.cos(tilt)) - HALF * np.sin(tilt),
        tilt,
    )
    response = rq.simulate(disturbed(system, {"wheelset": moved}, {}))
    # the first frame is still that at rest
    return response.times[1:], response.channel("relative_roll_rad")[1:]


def strike(restitution: float) -> float:
    """Roll rate after the first impact over that before it."""
    time, roll = rock(restitution, history_step=2e-4)
    at = int(np.argmax(roll < 0.0))
    before, after = slice(at - 60, at - 10), slice(at + 10, at + 40)
    rates = [np.polyfit(time[part], roll[part], 1)[0] for part in (before, after)]
    return float(rates[1] / rates[0])
