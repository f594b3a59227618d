"""Running of comparisons: one that fails or cannot run does not stop the others."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from railquake.errors import InputError
from railquake.messages import did_you_mean, on_one_line
from railquake.validation import registry
from railquake.validation.comparison import Comparison, Outcome, Unavailable

__all__ = ["Report", "chosen", "is_green", "run", "run_one"]

# The package that an extra brings and a comparison imports.
EXTRAS = {"fem": ("OpenSees", "opensees.openseespy")}


@dataclass(frozen=True)
class Report:
    """What became of a comparison: an outcome, or the reason why there is none.

    Attributes
    ----------
    name : str
        As the command line has it.
    comparison : Comparison
    outcome : Outcome or None
    skipped : str or None
        Why it could not run: what is missing and how to get it.
    error : str or None
        What it raised.
    seconds : float
    """

    name: str
    comparison: Comparison
    outcome: Outcome | None
    skipped: str | None
    error: str | None
    seconds: float

    @property
    def agrees(self) -> bool:
        """Whether it ran and every quantity is within its tolerance."""
        return (
            self.outcome is not None
            and bool(self.outcome.results)
            and all(result.agrees for result in self.outcome.results)
        )

    @property
    def verdict(self) -> str:
        """In a word: ``agrees``, ``outside``, ``skipped`` or ``failed``."""
        if self.skipped is not None:
            return "skipped"
        if self.error is not None:
            return "failed"
        return "agrees" if self.agrees else "outside"

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        results = self.outcome.results if self.outcome else ()
        return {
            "name": self.name,
            "title": self.comparison.TITLE,
            "verdict": self.verdict,
            "skipped": self.skipped,
            "error": self.error,
            "seconds": self.seconds,
            "results": [{**vars(result), "verdict": result.verdict} for result in results],
        }


def chosen(only: Iterable[str] = ()) -> tuple[str, ...]:
    """Names of the comparisons, all or those asked for, in the registry's order.

    Raises
    ------
    InputError
        For a name that none has.
    """
    known = tuple(name.replace("_", "-") for name in registry.COMPARISONS)
    wanted = [name.replace("_", "-") for name in only]
    for name in wanted:
        if name not in known:
            raise InputError(
                f'--only: no comparison is called "{name}"; {did_you_mean(name, known)}'
            )
    return tuple(name for name in known if not wanted or name in wanted)


def run(
    names: Iterable[str],
    data: Path | None,
    report: Callable[[Report], None] | None = None,
    begin: Callable[[str], None] | None = None,
) -> tuple[Report, ...]:
    """Run comparisons one after another.

    Parameters
    ----------
    names : iterable of str
        See `chosen`.
    data : Path, optional
        Folder of reference data.
    report : callable, optional
        Called with each report when it is there.
    begin : callable, optional
        Called with the name of each comparison before it runs.

    Returns
    -------
    tuple of Report
    """
    reports = []
    for name in names:
        if begin is not None:
            begin(name)
        reports.append(run_one(name, registry.load(name), data))
        if report is not None:
            report(reports[-1])
    return tuple(reports)


def run_one(name: str, comparison: Comparison, data: Path | None) -> Report:
    """Run a comparison; whatever it raises is part of the report."""
    begin = time.perf_counter()
    outcome = skipped = error = None
    try:
        _look_for_needs(comparison, data)
        outcome = comparison.compare(data)
        if not outcome.results:
            error = "compares nothing"
    except Unavailable as reason:
        skipped = str(reason)
    except Exception as problem:
        error = on_one_line(problem)
    return Report(name, comparison, outcome, skipped, error, time.perf_counter() - begin)


def _look_for_needs(comparison: Comparison, data: Path | None) -> None:
    files = getattr(comparison, "FILES", ())
    for need in (*getattr(comparison, "NEEDS", ()), *(("data",) if files else ())):
        if need == "data":
            if data is None:
                raise Unavailable("needs the folder of reference data: --data DIR")
            continue
        tool, module = EXTRAS[need]
        try:
            import_module(module)
        except ImportError:
            raise Unavailable(f"needs {tool}: pip install railquake[{need}]") from None
    for file in files:
        if data is not None and not (data / file).is_file():
            raise Unavailable(f"needs {file} in {data}")


def is_green(reports: Iterable[Report]) -> bool:
    """Whether every comparison ran and agrees."""
    reports = tuple(reports)
    return bool(reports) and all(report.agrees for report in reports)
