"""The time step chosen, not guessed: what ``solver.dt = "auto"`` stands for.

The longest step that a scenario might take is `SAFE_SHARE` of its own critical step (that of the
system linearised at static load), and at most `LONGEST`.  A *choice* says by how much all scenarios
of a study shorten that: it is found by running a few of them, the hardest, with the longest step,
half of it, a quarter and so on.  The error of each is estimated from the next shorter one: the
methods are of second order, but impacts are of first, for which the difference between a step and
its half is half the error.  So twice the largest difference must be within the tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from railquake import measures
from railquake.assembly import critical_time_step
from railquake.errors import InputError

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario

__all__ = ["LONGEST", "SAFE_SHARE", "TimeStep", "search_time_step"]

Run = Callable[[Sequence["Scenario"]], Sequence[Mapping[str, Any]]]

SAFE_SHARE = 0.5
"""Of the critical step at static load; steeper and harder pressed contacts are stiffer."""
LONGEST = 1e-4
"""No step is longer, s: a flange may come nearer by some tenths of a millimetre in it."""
HALVINGS = 5
LEAST = 1e-300  # so that nothing is divided by zero


@dataclass(frozen=True)
class TimeStep:
    """A choice of time steps for all scenarios of a study.

    Attributes
    ----------
    halvings : int
        How often each scenario's longest step is halved.
    error : float
        Estimated largest relative error of PBD, PBV and uplift ratio in the scenarios tried.
    tolerance : float
        What was asked for.
    tried : int
        Scenarios that were run to find it.
    """

    halvings: int
    error: float
    tolerance: float
    tried: int

    def of(self, scenario: Scenario) -> float:
        """Time step of a scenario, s: a whole number of them make a frame."""
        return _step(scenario, self.halvings)

    def settled(self, scenario: Scenario) -> Scenario:
        """The scenario with this time step; as it is where it names one itself."""
        if scenario.solver.dt != "auto":
            return scenario
        return scenario.with_step(self.of(scenario))

    @property
    def text(self) -> str:
        """What was chosen and the error seen, in one line."""
        *names, last = (measure.short for measure in measures.telling_of_the_step())
        kept = "" if self.error <= self.tolerance else "; NOT within the tolerance"
        return (
            f"time step: {0.5**self.halvings:g} of the longest ({SAFE_SHARE:g} of the critical "
            f"one, at most {LONGEST:g} s); estimated error {100.0 * self.error:.2g} % of "
            f"{', '.join(names)} and {last} over {self.tried} scenarios tried, "
            f"{100.0 * self.tolerance:g} % allowed{kept}"
        )


def search_time_step(
    scenarios: Sequence[Scenario], run: Run, tolerance: float | None = None
) -> TimeStep:
    """Find the longest time steps that keep peaks within the scenarios' tolerance.

    Parameters
    ----------
    scenarios : sequence of Scenario
        The hardest of those that will be run; the smallest of their tolerances counts.
    run : callable
        Gives the rows (see `assess`) of some scenarios, in their order.
    tolerance : float, optional
        Instead of the scenarios' own.

    Returns
    -------
    TimeStep
        If no step tried is within the tolerance, the shortest, with its error.

    Raises
    ------
    InputError
        If there is no scenario, or one cannot be run.
    """
    if not scenarios:
        raise InputError("time step: no scenario to try it on")
    if tolerance is None:
        tolerance = min(scenario.solver.time_step_tolerance for scenario in scenarios)
    error = math.inf
    coarse = run([scenario.with_step(_step(scenario, 0)) for scenario in scenarios])
    for halvings in range(HALVINGS):
        fine = run([scenario.with_step(_step(scenario, halvings + 1)) for scenario in scenarios])
        error = 2.0 * max(_difference(a, b) for a, b in zip(coarse, fine, strict=True))
        if error <= tolerance:
            return TimeStep(halvings, float(error), tolerance, len(scenarios))
        coarse = fine
    return TimeStep(HALVINGS, float(0.5 * error), tolerance, len(scenarios))


def _difference(coarse: Mapping[str, Any], fine: Mapping[str, Any]) -> float:
    """Largest relative difference of the measures; infinite if either run came to nothing."""
    for row in (coarse, fine):
        if row["status"] == "failed":
            raise InputError(f"time step: a scenario to try it on cannot be run: {row['error']}")
    if {coarse["status"], fine["status"]} & {"diverged", "not converged"}:
        return math.inf
    differences = []
    for measure in measures.telling_of_the_step():
        key, floor = measure.key, max(measure.step_floor or 0.0, LEAST)
        differences.append(abs(coarse[key] - fine[key]) / max(abs(fine[key]), floor))
    return max(differences)


def _step(scenario: Scenario, halvings: int) -> float:
    longest = min(SAFE_SHARE * critical_time_step(scenario), LONGEST) * 0.5**halvings
    frame = scenario.solver.history_step
    return frame / math.ceil(frame / longest * (1.0 - 1e-9))
