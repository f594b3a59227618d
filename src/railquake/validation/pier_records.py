"""What the live comparisons of the pier share: one set of records, run here and in OpenSees."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.fem.pier import PierHistory, opensees_pier
from railquake.inputs.scenario import scenario
from railquake.inputs.support import Pier
from railquake.run.simulate import simulate
from railquake.validation.comparison import Outcome, Picture, Result, of_peak
from railquake.validation.pictures import write_histories, write_loops
from railquake.validation.reference import paper_record

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario
    from railquake.run.response import Response

__all__ = ["FILES", "RECORDS", "SETTINGS", "compare_pier"]

Array = np.ndarray[Any, np.dtype[np.float64]]

RECORDS = (
    "RSN006_IMPVALLH2", "RSN170_IMPVALLH2", "RSN171_IMPVALLH1", "RSN181_IMPVALLH1",
    "RSN182_IMPVALLH2",
)  # fmt: skip
FILES = (
    "records/paper_suite/manifest.csv",
    *(f"records/paper_suite/{record}.AT2" for record in RECORDS),
)
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


@dataclass(frozen=True)
class Pair:
    """One record's histories, here and in OpenSees, by the names of `PierHistory`."""

    record: str
    factor: float
    time: Array
    ours: Mapping[str, Array]
    theirs: PierHistory
    further: Array | None
    """Our base moment with Newton's method carried further, where the hinge yields."""

    @property
    def title(self) -> str:
        """Record and scale factor."""
        return f"{self.record} × {self.factor:g}"


def compare_pier(data: Path | None, pier: Mapping[str, Any], tolerance: float) -> Outcome:
    """Run a pier under every record, here and in OpenSees.

    Parameters
    ----------
    data : Path
        Folder of reference data.
    pier : mapping
        The case's table ``[support]``.
    tolerance : float
        Of each history over its peak.
    """
    pairs = [_run_both(record, data, pier) for record in RECORDS]
    results = [result for pair in pairs for result in _results(pair, tolerance)]
    return Outcome(tuple(results), tuple(_pictures([pairs[0], pairs[-1]])))


def _run_both(record: str, data: Path | None, pier: Mapping[str, Any]) -> Pair:
    path = paper_record(data, record)
    factor = _scale_factor(path)
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
    further = None
    if case.support.hinge != "elastic":
        again = _run(scenario(**inputs, newton_tolerance=FURTHER, newton_max_iterations=200))
        further = again.channel("base_moment_n_m")[1:]
    return Pair(record, factor, response.times[1:], ours, theirs, further)


def _scale_factor(record: Path) -> float:
    """The paper's, from the manifest beside the record."""
    with open(record.with_name("manifest.csv"), newline="", encoding="utf-8") as file:
        factors = {row["file"]: float(row["scale_factor"]) for row in csv.DictReader(file)}
    return factors[record.name]


def _run(case: Scenario) -> Response:
    response = simulate(case)
    if response.status in ("diverged", "not converged"):
        raise ArithmeticError(f"{response.system.ground.name}: {response.status}")
    return response


def _results(pair: Pair, tolerance: float) -> list[Result]:
    results = [
        of_peak(
            f"{pair.title}: {text}", unit,
            reference=getattr(pair.theirs, name), ours=pair.ours[name], tolerance=tolerance,
        )
        for _, name, text, unit in QUANTITIES
    ]  # fmt: skip
    if pair.further is not None:
        results.append(
            of_peak(
                f"{pair.title}: base moment, Newton's method to 1e-6", "N m",
                reference=pair.theirs.base_moment, ours=pair.further, tolerance=FURTHER_TOLERANCE,
            )
        )  # fmt: skip
    return results


def _pictures(pairs: list[Pair]) -> list[Picture]:
    """Histories of the first pair, and the loops of all where the hinge yields."""
    first = pairs[0]
    rows = [
        ("displacement, mm", 1e3 * first.theirs.displacement, 1e3 * first.ours["displacement"]),
        ("base moment, MN m", 1e-6 * first.theirs.base_moment, 1e-6 * first.ours["base_moment"]),
    ]
    draw = partial(write_histories, first.time, rows)
    pictures = [Picture("histories", f"Histories under {first.title}.", draw)]
    if first.further is not None:
        loops = [
            (
                pair.title,
                1e3 * pair.ours["hinge_rotation"],
                1e-6 * pair.theirs.base_moment,
                1e-6 * pair.ours["base_moment"],
            )
            for pair in pairs
        ]
        labels = [("hinge rotation, mrad", "base moment, MN m")] * len(loops)
        caption = "Base moment against hinge rotation, OpenSees (dots) and railquake (line)."
        pictures.append(Picture("loops", caption, partial(write_loops, loops, labels)))
    return pictures
