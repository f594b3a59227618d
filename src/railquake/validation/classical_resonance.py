"""The pier under harmonic ground motion: amplitudes at and about its resonance."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railquake.validation.bodies import motion
from railquake.validation.classical_free_vibration import FOOT, pier_matrices
from railquake.validation.comparison import Outcome, Picture, relative

TITLE = "Resonance: steady amplitudes under harmonic ground motion"
SOURCE = """The steady answer to $\\ddot u_g = a\\,\\sin\\Omega t$ is $|(K-\\Omega^2M+i\\Omega
C)^{-1}M\\,t|\\,a$; for a single mode at resonance, $\\Gamma\\phi a/(2\\zeta\\omega^2)$. Solved
by NumPy with matrices of its own."""
WHAT = """The pier `bart-berkeley` with an elastic hinge, decoupled, 5 % damping, under a sine of
0.1 m/s² at 0.5, 0.9, 1 and 1.5 of its first frequency; amplitudes of displacement and of the
hinge's rotation over the last five periods."""
WHY = """After 25 periods the start's transient, which decays by 0.73 in each, is down to 0.04 %.
The ground's sine is linear between samples a hundredth of a period apart, which lowers it by
0.03 %."""

RATIO, GROUND = 0.05, 0.1
SHARES = (0.5, 0.9, 1.0, 1.5)
TOLERANCE = 2e-3


def compare(data: Path | None) -> Outcome:
    """Shake at each frequency."""
    mass, stiffness = pier_matrices()
    root = 1.0 / np.sqrt(mass)
    omega = np.sqrt(np.linalg.eigvalsh(stiffness * np.outer(root, root)))
    a, b = 2.0 * RATIO / (omega[0] + omega[1]) * np.array([omega[0] * omega[1], 1.0])

    def answer(frequency: float) -> np.ndarray:
        dynamic = stiffness - frequency**2 * np.diag(mass)
        dynamic = dynamic + 1j * frequency * (a * np.diag(mass) + b * stiffness)
        return np.abs(np.linalg.solve(dynamic, [mass[0] * GROUND, 0.0, 0.0]))

    results, found = [], []
    for share in SHARES:
        displacement, rotation = shake(share * omega[0])
        u, theta, _ = answer(share * omega[0])
        results += [
            relative(f"displacement at {share:g} of the first frequency", "m",
                     reference=float(u), ours=displacement, tolerance=TOLERANCE),
            relative(f"hinge's rotation at {share:g} of the first frequency", "rad",
                     reference=float(theta), ours=rotation, tolerance=TOLERANCE),
        ]  # fmt: skip
        found.append(1e3 * displacement)
    shares = np.linspace(0.3, 1.7, 300)
    curve = 1e3 * np.array([answer(s * omega[0])[0] for s in shares])

    def draw(path: Path) -> None:
        from railquake.validation.drawing import curves

        ours = [(np.array(SHARES), np.array(found), "runs")]
        closed = [(shares, curve, "closed form")]
        curves(
            path, "ground's frequency over the first one", "amplitude [mm]", ours, closed, style="o"
        )

    caption = "Amplitude of the pier's top: runs (points) and closed form (dashed)."
    return Outcome(tuple(results), (Picture("amplitude", caption, draw),))


def shake(omega: float) -> tuple[float, float]:
    """Amplitudes of displacement and hinge rotation of the last periods."""
    import railquake as rq

    period = 2.0 * np.pi / omega
    step = period / 100.0
    time = step * np.arange(round(30.0 * period / step) + 1)
    case: dict[str, Any] = {
        "support": {
            "preset": "bart-berkeley", "hinge": "elastic", "coupled": False,
            "damping_ratio": RATIO, "base_rotational_inertia": FOOT,
        },
        "motion": motion(step, GROUND * np.sin(omega * time)),
        "dt": 1e-4,
    }  # fmt: skip
    response = rq.simulate(rq.scenario(**case))
    late = response.times > 25.0 * period
    return tuple(  # type: ignore[return-value]
        amplitude(response.times[late], response.channel(name)[late], omega)
        for name in ("bridge_displacement_m", "hinge_rotation_rad")
    )


def amplitude(time: np.ndarray, values: np.ndarray, omega: float) -> float:
    """Of the sine of that circular frequency which fits best."""
    basis = np.column_stack([np.sin(omega * time), np.cos(omega * time)])
    weights, *_ = np.linalg.lstsq(basis, values, rcond=None)
    return float(np.hypot(*weights))
