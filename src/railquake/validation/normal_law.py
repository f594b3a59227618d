"""The normal law of a centred wheelset against a published stiffness."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from railquake.validation.comparison import Outcome, Picture, relative

TITLE = "Normal law of a centred wheelset"
SOURCE = """N / delta^1.5 = 1.5e11 N/m^1.5 for S1002 on UIC60 in the middle of the track: a fit of
CONTACT's exact results from 5 to 150 kN per wheel."""
WHAT = """Normal force over approach^1.5 of the wheels of a wheelset that stands still, from the
public probe of the standing contact, with CONTACT's steel (E 209.92 GPa, nu 0.28)."""
WHY = """The exact law is not quite a power of 1.5, because the contact is nearly conformal there:
CONTACT's own results go from 1.48e11 to 1.61e11 N/m^1.5."""

REFERENCE, TOLERANCE = 1.5e11, 0.1  # N/m^1.5
LOADS = (5e3, 10e3, 20e3, 50e3, 100e3, 150e3)  # N


def _stiffness(load: float) -> tuple[float, float]:
    """Stiffness (N/m^1.5) and approach (m) of the left wheel."""
    from railquake.inputs.wheelrail import WheelRail
    from railquake.probe import standing_contact

    pair = WheelRail.from_preset("s1002-60e1", {"youngs_modulus": 209.92e9, "poisson_ratio": 0.28})
    patches = standing_contact(pair, 0.0, load)
    if [patch.side for patch in patches] != ["left", "right"]:
        raise ValueError(f"at {load:g} N the wheelset bears on {len(patches)} patches")
    left = patches[0]
    return left.normal_n / left.approach_m**1.5, left.approach_m


def compare(data: Path | None) -> Outcome:
    """Press the wheelset down with each load."""
    found = [_stiffness(load) for load in LOADS]
    results = tuple(
        relative(
            f"{1e-3 * load:g} kN per wheel", "N/m^1.5",
            reference=REFERENCE, ours=stiffness, tolerance=TOLERANCE,
        )
        for load, (stiffness, _) in zip(LOADS, found, strict=True)
    )  # fmt: skip
    return Outcome(
        results,
        (
            Picture(
                "loads",
                "Load against approach; the band is the reference within 10 %.",
                lambda path: write_picture([approach for _, approach in found], path),
            ),
        ),
    )


def write_picture(approaches: list[float], path: Path) -> Path:
    """Draw ours over the band."""
    from railquake.plots.style import BLUE, ORANGE, figure, label, legend, save

    made, ax = figure(6.5, 3.8)
    delta = np.geomspace(0.9 * min(approaches), 1.1 * max(approaches), 50)
    law = 1e-3 * REFERENCE * delta**1.5
    ax.fill_between(
        1e3 * delta, (1.0 - TOLERANCE) * law, (1.0 + TOLERANCE) * law, color=ORANGE, alpha=0.25,
        linewidth=0.0, label="reference",
    )  # fmt: skip
    ax.plot(1e3 * np.array(approaches), 1e-3 * np.array(LOADS), "o", color=BLUE, label="railquake")
    ax.set_xscale("log")
    ax.set_yscale("log")
    label(ax, "approach, mm", "load per wheel, kN")
    legend(ax)
    return save(made, path)
