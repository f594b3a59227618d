"""A car pressed aside steadily: its lateral force, and how its wheels share the weight."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railquake.validation.bodies import GRAVITY, motion
from railquake.validation.comparison import Outcome, Picture, relative

TITLE = "A car under a steady lateral acceleration"
SOURCE = """D'Alembert: ground that accelerates by $a$ for long is pushed back with $\\sum
m\\,a$, and the load that goes from one rail to the other is $\\sum m\\,a\\,h$ over the contacts'
distance, bodies' heights $h$ over the rails. (Weights that move aside tilt no more: the
suspension is linear about its undeformed shape.)"""
WHAT = """The car `bart`, its suspension stiffened tenfold and well damped so that it comes to
rest, on the level ground; 0.6 m/s² grow smoothly within 2 s and stay for 1.5 s more. Low-passed
force and wheel loads at the end, and by the springs the car's travel."""
WHY = """The wheels creep aside by some tenths of a millimetre meanwhile, 0.05 % of their
distance; what is left of the swing is about a tenth of a per cent."""

GROUND = 0.6
STIFFER = 10.0
TOLERANCE = 5e-3


def compare(data: Path | None) -> Outcome:
    """Press the car aside."""
    import railquake as rq
    from railquake.inputs.vehicle import Vehicle

    plain = Vehicle.from_preset("bart")
    car = {
        "preset": "bart",
        "speed": 0.0,
        "springs": {s.name: {"stiffness": STIFFER * s.stiffness} for s in plain.springs},
        "dashpots": {d.name: {"damping": 8.0 * d.damping} for d in plain.dashpots},
    }
    time = np.arange(0.0, 3.51, 0.01)
    ground = 0.5 * GROUND * (1.0 - np.cos(np.pi * np.minimum(time / 2.0, 1.0)))
    case: dict[str, Any] = {
        "vehicle": car, "support": "at-grade", "motion": motion(0.01, ground), "dt": 2e-5,
    }  # fmt: skip
    response = rq.simulate(rq.scenario(**case))
    bodies = response.system.scenario.vehicle.bodies
    total = sum(body.mass for body in bodies)
    heights = {body.name: body.height for body in bodies}
    tilting = sum(body.mass * body.height for body in bodies)
    pair = response.system.scenario.wheelrail
    moved = GROUND * tilting / (2.0 * pair.running_circle)

    def late(name: str) -> float:
        return float(response.channel(name)[-500:].mean())

    # the car on the springs below it: sway of both levels, and the tilt of each
    level = {s.name: s for s in response.system.scenario.vehicle.springs}
    masses = {body.name: body.mass for body in bodies}
    pull = {"primary": masses["car"] + masses["bogie"], "secondary": masses["car"]}
    lever = {
        name: sum(
            masses[b] * (heights[b] - level[f"{name}-lateral"].end_heights[0])
            for b in (("car", "bogie") if name == "primary" else ("car",))
        )
        for name in pull
    }
    travel = 0.0
    for name in pull:
        sideways, upright = level[f"{name}-lateral"], level[f"{name}-vertical"]
        travel += GROUND * pull[name] / (2.0 * sideways.stiffness)
        turn = GROUND * lever[name] / (2.0 * upright.stiffness * upright.lateral**2)
        travel += turn * (heights["car"] - sideways.end_heights[0])
    results = (
        relative("lateral force", "N", reference=-total * GROUND,
                 ours=late("lateral_force_filtered_n"), tolerance=TOLERANCE),
        relative("load of the left wheels", "N", reference=0.5 * total * GRAVITY + moved,
                 ours=late("wheel_load_left_filtered_n"), tolerance=TOLERANCE),
        relative("load of the right wheels", "N", reference=0.5 * total * GRAVITY - moved,
                 ours=late("wheel_load_right_filtered_n"), tolerance=TOLERANCE),
        relative("car's travel over the wheelset", "m", reference=-travel,
                 ours=late("car_lateral_m") - late("wheelset_lateral_m"), tolerance=TOLERANCE),
    )  # fmt: skip

    def draw(path: Path) -> None:
        from railquake.validation.drawing import curves

        force = 1e-3 * response.channel("lateral_force_filtered_n")
        expected = -1e-3 * total * np.interp(response.times, time, ground)
        curves(path, "time [s]", "lateral force [kN]", [(response.times, force, "low-passed")],
               [(response.times, expected, "mass times acceleration")])  # fmt: skip

    caption = "Lateral force of the car on the track under an acceleration that grows and stays."
    return Outcome(results, (Picture("force", caption, draw),))
