"""What the live comparisons of the pier share: one set of records, run here and in OpenSees."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from railquake.fem.pier import opensees_pier
from railquake.inputs.scenario import scenario
from railquake.inputs.support import Pier
from railquake.simulation import simulate
from railquake.validation.comparison import Outcome, Picture, Result, of_peak
from railquake.validation.pictures import write_histories, write_loops
from railquake.validation.reference import paper_record

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario
    from railquake.response import Response

__all__ = ["FILES", "RECORDS", "SETTINGS", "compare_pier"]

RECORDS = (
    "RSN006_IMPVALLH2", "RSN170_IMPVALLH2", "RSN171_IMPVALLH1", "RSN181_IMPVALLH1",
    "RSN182_IMPVALLH2",
)  # fmt: skip
MANIFEST = "records/paper_suite/manifest.csv"
FILES = (MANIFEST, *(f"records/paper_suite/{record}.AT2" for record in RECORDS))
DT = 2.5e-4  # s, of both; below the train's critical step
FURTHER, FURTHER_TOLERANCE = 1e-6, 1e-6  # of Newton's method, and of the moment's peak
QUANTITIES = (
    # channel here, in OpenSees, name, unit
    ("bridge_displacement_m", "displacement", "top displacement", "m"),
    ("hinge_rotation_rad", "hinge_rotation", "hinge rotation", "rad"),
    ("top_rotation_rad", "top_rotation", "top rotation", "rad"),
    ("base_moment_n_m", "base_moment", "base moment", "N m"),
)
SETTINGS = """The whole program runs the case with the train aboard but decoupled, so that no force
of the train reaches the pier; OpenSees runs the bare pier live (zero-length hinge, elastic column,
Newmark's average acceleration, Newton's method to 1e-12). Both take steps of 0.25 ms under five of
the paper's records, scaled as in the paper for 5 % in 50 years."""


def _run(case: Scenario) -> Response:
    response = simulate(case)
    if response.status in ("diverged", "not converged"):
        raise ArithmeticError(f"{response.system.ground.name}: {response.status}")
    return response


def scale_factors(data: Path) -> dict[str, float]:
    """The paper's scale factor of each of its records."""
    with open(data / MANIFEST, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {row["file"].removesuffix(".AT2"): float(row["scale_factor"]) for row in rows}


def compare_pier(data: Path | None, pier: Mapping[str, Any], tolerance: float) -> Outcome:
    """Run a pier under every record, here and in OpenSees.

    A pier whose hinge yields is run once more here, with Newton's method carried further.

    Parameters
    ----------
    data : Path
        Folder of reference data.
    pier : mapping
        The case's table ``[support]``.
    tolerance : float
        Of each history over its peak.
    """
    results: list[Result] = []
    pictures: list[Picture] = []
    loops: list[tuple[str, Any, Any, Any]] = []
    for record in RECORDS:
        path = paper_record(data, record)
        assert data is not None
        factor = scale_factors(data)[record]
        inputs: dict[str, Any] = {
            "support": {**pier, "coupled": False}, "record": path, "scale": factor, "dt": DT,
        }  # fmt: skip
        case = scenario(**inputs)
        response = _run(case)
        ground = case.ground_motion()
        assert isinstance(case.support, Pier)
        theirs = opensees_pier(
            case.support, ground.acceleration, ground.dt, response.system.dt, response.steps,
            every=response.system.frame_steps,
        )  # fmt: skip
        ours = {name: response.channel(channel)[1:] for channel, name, _, _ in QUANTITIES}
        results += [
            of_peak(
                f"{record} × {factor:g}: {text}", unit,
                reference=getattr(theirs, name), ours=ours[name], tolerance=tolerance,
            )
            for _, name, text, unit in QUANTITIES
        ]  # fmt: skip
        yields = case.support.hinge != "elastic"
        if yields:
            further = _run(scenario(**inputs, newton_tolerance=FURTHER, newton_max_iterations=200))
            results.append(
                of_peak(
                    f"{record} × {factor:g}: base moment, Newton's method to 1e-6", "N m",
                    reference=theirs.base_moment, ours=further.channel("base_moment_n_m")[1:],
                    tolerance=FURTHER_TOLERANCE,
                )
            )  # fmt: skip
        if record == RECORDS[0]:
            time = response.times[1:]
            rows = [
                ("displacement, mm", 1e3 * theirs.displacement, 1e3 * ours["displacement"]),
                ("base moment, MN m", 1e-6 * theirs.base_moment, 1e-6 * ours["base_moment"]),
            ]
            pictures.append(
                Picture(
                    "histories",
                    f"Histories under {record} × {factor:g}.",
                    partial(write_histories, time, rows),
                )
            )
        if yields and record in (RECORDS[0], RECORDS[-1]):
            loops.append(
                (
                    f"{record} × {factor:g}",
                    1e3 * ours["hinge_rotation"],
                    1e-6 * theirs.base_moment,
                    1e-6 * ours["base_moment"],
                )
            )
    if loops:
        label = ("hinge rotation, mrad", "base moment, MN m")
        pictures.append(
            Picture(
                "loops",
                "Base moment against hinge rotation, OpenSees (dots) and railquake (line).",
                lambda path: write_loops(loops, (label, label), path),
            )
        )
    return Outcome(tuple(results), tuple(pictures))
