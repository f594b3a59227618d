"""Runs that gave no usable numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from railquake.findings.resampling import FINISHED
from railquake.report.context import ReportSection, Table, Text

if TYPE_CHECKING:
    from railquake.report.context import Context

__all__ = ["section"]

TITLE = "Failures"
MOST = 40


def section(context: Context) -> ReportSection:
    """Runs that failed, diverged or did not converge, by reason."""
    table = context.table
    rows = table[~table["status"].isin(FINISHED)]
    if not len(rows):
        text = f"None: all {len(table):,} runs came to an end."
        return ReportSection("failures", TITLE, (Text(text),))
    reasons = rows["error"].fillna("").astype(str) if "error" in rows else rows["status"] * 0
    listed = []
    groups = rows.assign(reason=reasons).groupby(["status", "reason"], sort=False)
    for (status, reason), group in groups:
        numbers = [int(row) for row in group["row"]]
        shown = ", ".join(map(str, numbers[:8])) + (" ..." if len(numbers) > 8 else "")
        listed.append(
            (str(status), reason or _meaning(str(status)), str(len(numbers)), shown,
             context.command(numbers[0]))
        )  # fmt: skip
    caption = f"{len(rows):,} of {len(table):,} runs gave no usable numbers and are left out above."
    if len(listed) > MOST:
        caption += f" The first {MOST} of {len(listed)} different reasons are shown."
    head = ("status", "reason", "runs", "rows", "to look into the first")
    return ReportSection("failures", TITLE, (Table(head, tuple(listed[:MOST]), caption),))


def _meaning(status: str) -> str:
    return {
        "diverged": "a state left every plausible bound; take a smaller solver.dt",
        "not converged": "the hinge’s iteration failed in some step; take a smaller solver.dt",
    }.get(status, "no reason was noted")
