"""Words for numbers, shared by all sentences."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from railquake.findings.comparison import PairedComparison
from railquake.findings.resampling import Estimate

__all__ = [
    "capital", "chance", "interval", "listed", "number", "ratio", "sentence", "split",
]  # fmt: skip


def number(value: float, digits: int = 2) -> str:
    """A number as it stands in a sentence."""
    if not math.isfinite(value):
        return "unknown"
    return f"{round(value, digits) + 0.0:.{digits}f}".replace("-", "\u2212")


def interval(estimate: Estimate, digits: int = 2) -> str:
    """A value with its 95 % interval."""
    if not estimate.certain:
        return number(estimate.value, digits)
    ends = f"{number(estimate.low, digits)} to {number(estimate.high, digits)}"
    return f"{number(estimate.value, digits)} ({ends})"


def chance(p: float) -> str:
    """A p-value."""
    if not math.isfinite(p):
        return "no sign test"
    return "p < 0.001" if p < 0.001 else f"p = {p:.3f}" if p < 0.1 else f"p = {p:.2f}"


def ratio(found: PairedComparison) -> str:
    """The ratio with its interval and sign test, or why there is none."""
    if found.missing:
        return found.missing
    return f"{interval(found.median)} times, {split(found)}"


def split(found: PairedComparison) -> str:
    """For how many records it is higher, or lower, and the sign test."""
    most = max(found.records_above, found.records_below)
    way = "higher" if found.records_above >= found.records_below else "lower"
    return f"{way} for {most} of {found.records} records, {chance(found.p_value)}"


def listed(items: Sequence[str]) -> str:
    """Items with commas and an "and" before the last."""
    return items[0] if len(items) == 1 else ", ".join(items[:-1]) + " and " + items[-1]


def capital(text: str) -> str:
    """The text with a capital at its beginning, the rest as it is."""
    return f"{text[0].upper()}{text[1:]}"


def sentence(parts: Iterable[str]) -> str:
    """Parts as one sentence."""
    return f"{capital('; '.join(parts))}."
