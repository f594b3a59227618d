"""The summary: the three questions, and how far the paper's findings are borne out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from railquake.findings import Answer, Finding, answer_questions
from railquake.report.context import ReportSection, Text

if TYPE_CHECKING:
    import pandas as pd

    from railquake.report.context import Context

__all__ = ["Answers", "Findings", "section"]


@dataclass(frozen=True)
class Answers:
    """Block: the questions with their answers."""

    items: tuple[Answer, ...]


@dataclass(frozen=True)
class Findings:
    """Block: the findings with their verdicts."""

    items: tuple[Finding, ...]


def section(context: Context) -> ReportSection:
    """How the runs ended, and what they say together."""
    answers, findings = answer_questions(context.evidence)
    blocks: list[object] = [Text(_counts(context))]
    if not context.evidence.outcomes:
        blocks.append(
            Text(
                "The three questions of Gomez and DeJong (2023) need the axis “model” with their "
                "variants (coupled-elastic, coupled-nonlinear, decoupled-elastic, ...), which this "
                "study does not have: they do not apply.",
                "note",
            )
        )
        return ReportSection("summary", "Summary", tuple(blocks))
    blocks += [
        Answers(answers),
        Text("The paper’s findings, one by one", "heading"),
        Findings(findings),
        Text(
            "Numbers in parentheses are 95 % intervals of a bootstrap that draws records with all "
            "their runs, because runs of one record are not independent of each other. Sign tests "
            "count each record once. “Uplift” is the peak roll of the wheelset against the track "
            "over the roll at which slide-off begins.",
            "note",
        ),
    ]
    return ReportSection("summary", "Summary", tuple(blocks))


def _counts(context: Context) -> str:
    table = context.table
    counts = table["status"].value_counts()
    order = ("safe", "onset", "derailed", "not converged", "diverged", "failed")
    names = {"safe": "stay safe", "onset": "reach the onset of slide-off and stay",
             "derailed": "derail", "not converged": "do not converge", "diverged": "diverge",
             "failed": "fail"}  # fmt: skip
    listed = ", ".join(
        f"{counts[name]:,} {names[name]}" + (_modes(table) if name == "derailed" else "")
        for name in order
        if name in counts
    )
    missing = context.results.missing
    unfinished = f" {missing:,} runs of the study have not finished." if missing > 0 else ""
    records = table["record"].nunique()
    return (
        f"{len(table):,} runs under {records} ground motion{'s' if records != 1 else ''}: "
        f"{listed}.{unfinished}{_beyond(table)}"
    )


def _modes(table: pd.DataFrame) -> str:
    """How the derailed runs derailed, in parentheses."""
    modes = table["derailment_mode"].dropna().astype(str).str.split().str[0].value_counts()
    said = ", ".join(f"{count:,} {mode}" for mode, count in modes.items())
    return f" ({said})" if said else ""


def _beyond(table: pd.DataFrame) -> str:
    """How often the car was where its model ends."""
    if "beyond_model" not in table or not table["beyond_model"].notna().any():
        return ""
    beyond = table[table["beyond_model"].notna()]
    reasons = beyond["beyond_model"].value_counts()
    said = "; ".join(f"{count:,}: {reason}" for reason, count in reasons.items())
    derailed = int((beyond["status"] == "derailed").sum())
    return (
        f" In {len(beyond):,} of them the car has been where its model ends ({said}); what follows "
        f"there is not to be believed, and {derailed:,} of them derail."
    )
