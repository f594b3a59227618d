"""Free vibration of the pier in each of its modes, and of a car on its springs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railquake.validation.bodies import disturbed, motion
from railquake.validation.comparison import Outcome, Picture, relative

TITLE = "Free vibration: frequencies and damping of each mode"
SOURCE = """A mode of $M\\ddot x + C\\dot x + Kx = 0$ with $C = aM + bK$ swings at
$\\omega\\sqrt{1-\\zeta^2}$ and decays by $\\zeta = \\frac12(a/\\omega + b\\omega)$; $a$ and $b$
from the ratio wanted in the first two modes. The stiffness of the column by slope and
deflection, its eigenvalues by NumPy. A body on springs and dashpots: $\\omega^2 = k/m$, $\\zeta
= c/(2m\\omega)$."""
WHAT = """The pier `bart-berkeley` with an elastic hinge, decoupled from its train, is let go in
the shape of each mode; the foot has an inertia that makes its third mode one that can be
followed. Frequency and damping from the logarithmic decrement of the mode's own coordinate. Then
the car of `bart` is let go 1 mm above its rest, at grade, on a bogie that hardly gives."""
WHY = """Newmark's method lengthens a period by $(\\omega\\,\\Delta t)^2/12$, 0.01 % for the
third mode, and damps nothing. The car's wheels stand on contact springs a thousand times as
stiff as the suspension."""

RATIO = 0.02
FOOT = 2e6  # kg m2
DT = 1e-4


def compare(data: Path | None) -> Outcome:
    """Let the pier go in three modes, and the car."""
    results, lines = [], []
    mass, stiffness = pier_matrices()
    for mode, (name, omega, ratio, shape) in enumerate(pier_modes(mass, stiffness)):
        time, histories = let_pier_go(1e-3 * shape / np.abs(shape).max(), 12.0 * 2 * np.pi / omega)
        coordinate = histories @ (mass * shape)
        coordinate /= coordinate[0]
        found, damping = swing(time, coordinate)
        results += [
            relative(f"{name}: frequency", "Hz", reference=damped(omega, ratio), ours=found,
                     tolerance=1e-4),
            relative(f"{name}: damping ratio", "", reference=ratio, ours=damping, tolerance=1e-3),
        ]  # fmt: skip
        lines.append((time * omega / 2 / np.pi, coordinate, f"mode {mode + 1}"))
    results += bounce_of_the_car()
    caption = "Coordinates of the pier's modes, let go one by one."
    return Outcome(tuple(results), (Picture("modes", caption, lambda path: draw(lines, path)),))


def pier_matrices() -> tuple[np.ndarray, np.ndarray]:
    """Diagonal of M, and K by slope and deflection, of the preset with the foot's inertia."""
    from railquake.inputs.support import Pier

    pier = Pier.from_preset("bart-berkeley")
    length, ei = pier.length, pier.youngs_modulus * pier.second_moment_of_area
    # rotations of the ends from the chord, and their moments 4 EI/L and 2 EI/L
    chord = np.array([[1.0 / length, 1.0, 0.0], [1.0 / length, 0.0, 1.0]])
    stiffness = chord.T @ (ei / length * np.array([[4.0, 2.0], [2.0, 4.0]])) @ chord
    stiffness[1, 1] += pier.bouc_wen.k0
    return np.array([pier.mass, FOOT, pier.rotational_inertia]), stiffness


def pier_modes(
    mass: np.ndarray, stiffness: np.ndarray
) -> list[tuple[str, float, float, np.ndarray]]:
    """Name, circular frequency, damping ratio and shape of each mode."""
    root = 1.0 / np.sqrt(mass)
    values, vectors = np.linalg.eigh(stiffness * np.outer(root, root))
    omega = np.sqrt(values)
    a = 2.0 * RATIO * omega[0] * omega[1] / (omega[0] + omega[1])
    b = 2.0 * RATIO / (omega[0] + omega[1])
    return [
        (f"pier, mode {k + 1}", float(w), float(0.5 * (a / w + b * w)), root * vectors[:, k])
        for k, w in enumerate(omega)
    ]


def let_pier_go(shape: np.ndarray, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Times, and (u, theta_1, theta_2) from there on."""
    import railquake as rq

    case: dict[str, Any] = {
        "support": {
            "preset": "bart-berkeley", "hinge": "elastic", "coupled": False,
            "damping_ratio": RATIO, "base_rotational_inertia": FOOT,
        },
        "motion": motion(0.01, [0.0] * (int(seconds / 0.01) + 2)),
        "dt": DT,
    }  # fmt: skip
    system = disturbed(rq.assemble(rq.scenario(**case)), {"pier": shape.tolist()}, {})
    mass, stiffness = pier_matrices()
    accelerations = system.layout.state_blocks["STRUCTURE_A"]
    system.start[accelerations, 0] = -(stiffness @ shape) / mass
    response = rq.simulate(system)
    names = ("bridge_displacement_m", "hinge_rotation_rad", "top_rotation_rad")
    return response.times, np.column_stack([response.channel(name) for name in names])


def swing(time: np.ndarray, values: np.ndarray) -> tuple[float, float]:
    """Damped frequency (Hz) and damping ratio, from the extremes of either sign."""
    middle = np.arange(1, len(values) - 1)
    turns = middle[
        (np.abs(values[middle]) >= np.abs(values[middle - 1]))
        & (np.abs(values[middle]) > np.abs(values[middle + 1]))
    ]
    before, here, after = values[turns - 1], values[turns], values[turns + 1]
    bend = before - 2.0 * here + after
    at = time[turns] + 0.5 * (time[1] - time[0]) * (before - after) / bend
    size = np.abs(here - 0.125 * (before - after) ** 2 / bend)
    half, _ = np.polyfit(np.arange(len(at)), at, 1)
    decay, _ = np.polyfit(np.arange(len(at)), -np.log(size), 1)
    return float(0.5 / half), float(decay / np.hypot(np.pi, decay))


def damped(omega: float, ratio: float) -> float:
    """Frequency of a damped swing, Hz."""
    return float(omega * np.sqrt(1.0 - ratio**2) / (2.0 * np.pi))


def bounce_of_the_car() -> list[Any]:
    """The car on soft springs over a bogie: two vertical modes with the wheelset held fast."""
    import railquake as rq

    case: dict[str, Any] = {
        "support": "at-grade",
        "motion": motion(0.01, [0.0] * 301),
        "vehicle": {
            "preset": "bart",
            # the upper springs take all, so that one body swings: 2 k / m and 2 c / m
            "springs": {"primary-vertical": {"stiffness": "2000 MN/m"}},
            "dashpots": {
                "primary-vertical": {"damping": 0.0},
                "secondary-vertical": {"damping": "10000 N s/m"},
            },
        },
        "dt": 5e-5,
    }
    system = rq.assemble(rq.scenario(**case))
    car = next(b for b in system.scenario.vehicle.bodies if b.name == "car")
    spring = next(s for s in system.scenario.vehicle.springs if s.name == "secondary-vertical")
    omega = np.sqrt(2.0 * spring.stiffness / car.mass)
    ratio = 2.0 * 10000.0 / (2.0 * car.mass * omega)
    response = rq.simulate(disturbed(system, {"car": (0.0, -1e-3, 0.0)}, {}))
    place = response.channel("car_vertical_m")
    found, damping = swing(response.times, place - place[0] - 1e-3)
    return [
        relative("car's bounce: frequency", "Hz", reference=damped(omega, ratio), ours=found,
                 tolerance=2e-3),
        relative("car's bounce: damping ratio", "", reference=ratio, ours=damping, tolerance=1e-2),
    ]  # fmt: skip


def draw(lines: list[Any], path: Path) -> None:
    """Coordinates against time in periods."""
    from railquake.validation.drawing import curves

    curves(path, "time [periods]", "modal coordinate", lines)
