"""What is shown of the comparisons: the table in a terminal, and the documentation's page."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from pathlib import Path

from railquake.errors import InputError
from railquake.files import whole_file, whole_folder
from railquake.messages import on_one_line, reason
from railquake.validation.comparison import Result
from railquake.validation.runner import Report, is_green

__all__ = ["check_page", "page_text", "summary", "text_table", "write_page"]

PICTURES = Path("images") / "validation"  # beside the page
HEAD = ("quantity", "reference", "ours", "difference", "tolerance", "verdict")
# Differences below this part of the tolerance hang on the compiler and are not printed.
FLOOR = 1e-3

INTRODUCTION = """\
# Validation

Every part of railquake is held here against something that it did not write: published numbers,
other programs, closed forms. The page is written by the program itself:

```
make validate                  # in a checkout; the reference data lie in ../shared
railquake validate --data DIR  # anywhere; pip install railquake[fem] brings OpenSees
```

The command ends with status 0 only if everything ran and agrees. A tolerance is stated before the
comparison is made, with its reason; where a law is known to be approximate the tolerance says by
how much, and the section says under which conditions. What none of this can show is on the page
[what this model cannot tell you](limits.md).
"""


def _number(value: float) -> str:
    return f"{value:.5g}"


def _with_unit(value: float | None, unit: str) -> str:
    if value is None:
        return "–"
    return f"{_number(value)} {unit}".rstrip()


def _share(value: float) -> str:
    """A relative number in per cent, or as a power of ten where that is shorter."""
    if value == 0.0 or value >= 1e-5 or not math.isfinite(value):
        return f"{100.0 * value:.2g} %"
    return _small(value)


def _small(value: float) -> str:
    mantissa, exponent = f"{value:.0e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def _difference(result: Result) -> str:
    if result.kind == "at most":
        return "–"
    floor = FLOOR * result.tolerance
    if result.kind == "absolute":
        if result.difference < floor:
            return f"below {_with_unit(floor, result.unit)}"
        return f"{result.difference:.2g} {result.unit}".rstrip()
    if result.difference < floor:
        return f"below {_share(floor)}"
    suffix = " of peak" if result.kind == "of peak" else ""
    return _share(result.difference) + suffix


def _tolerance(result: Result) -> str:
    if result.kind == "at most":
        return f"≤ {_with_unit(result.tolerance, result.unit)}"
    if result.kind == "absolute":
        return f"{result.tolerance:.3g} {result.unit}".rstrip()
    return _share(result.tolerance) + (" of peak" if result.kind == "of peak" else "")


def _cells(result: Result) -> tuple[str, ...]:
    return (
        result.quantity,
        _with_unit(result.reference, result.unit),
        _with_unit(result.ours, result.unit),
        _difference(result),
        _tolerance(result),
        result.verdict,
    )


def _reason(report: Report) -> str:
    return report.skipped or report.error or ""


def text_table(reports: Iterable[Report]) -> str:
    """The table for a terminal: a block for each comparison, its columns aligned."""
    blocks = []
    for report in reports:
        title = f"{report.name}: {report.comparison.TITLE}"
        if report.outcome is None or report.error:
            blocks.append(f"{title}\n  {report.verdict}: {_reason(report)}")
            continue
        rows = [HEAD, *(_cells(result) for result in report.outcome.results)]
        widths = [max(len(row[k]) for row in rows) for k in range(len(HEAD))]
        lines = [
            "  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True))
            for row in rows
        ]
        blocks.append("\n".join([title, *(line.rstrip() for line in lines)]))
    return "\n\n".join(blocks)


def summary(reports: Sequence[Report]) -> str:
    """One line: how many agree, and what became of the others."""
    colour = "green" if is_green(reports) else "not green"
    agreeing = sum(report.verdict == "agrees" for report in reports)
    others = [
        f"{count} {verdict}"
        for verdict in ("outside", "skipped", "failed")
        if (count := sum(report.verdict == verdict for report in reports))
    ]
    return ", ".join([f"{colour}: {agreeing} of {len(reports)} comparisons agree", *others])


def _markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(cell.replace("|", r"\|") for cell in row) + " |" for row in rows]
    return lines


def _unbroken(cells: Sequence[str]) -> tuple[str, ...]:
    """The row with each number, its sign, exponent and unit kept on one line."""
    return cells[0], *(
        cell.replace(" ", "\N{NO-BREAK SPACE}")
        .replace("\N{NO-BREAK SPACE}of\N{NO-BREAK SPACE}", " of ")
        .replace("-", "\N{MINUS SIGN}")
        for cell in cells[1:]
    )


def _section(report: Report, drawn: Sequence[tuple[str, str]]) -> list[str]:
    comparison = report.comparison
    lines = [f"({report.name})=", f"## {comparison.TITLE}", ""]
    slow = ", takes minutes" if getattr(comparison, "SLOW", False) else ""
    needs = [need for need in getattr(comparison, "NEEDS", ()) if need != "data"]
    tools = "".join(f", needs `railquake[{need}]`" for need in needs)
    data = getattr(comparison, "FILES", ()) or "data" in getattr(comparison, "NEEDS", ())
    folder = ", needs the reference data" if data else ""
    lines += [f"`railquake validate --only {report.name}`{tools}{folder}{slow}", ""]
    lines += [f"**Source.** {comparison.SOURCE.strip()}", ""]
    lines += [f"**What is compared.** {comparison.WHAT.strip()}", ""]
    lines += [f"**Why this tolerance.** {comparison.WHY.strip()}", ""]
    if report.outcome is None or report.error:
        return [*lines, f"**{report.verdict.capitalize()}.** {_reason(report)}", ""]
    rows = (_unbroken(_cells(result)) for result in report.outcome.results)
    lines += [*_markdown_table(HEAD, rows), ""]
    if report.outcome.note:
        lines += [report.outcome.note.strip(), ""]
    for file, caption in drawn:
        lines += [f"```{{figure}} {file}", ":width: 100%", "", caption, "```", ""]
    return lines


def _overview(reports: Sequence[Report]) -> list[str]:
    rows = []
    for report in reports:
        results = report.outcome.results if report.outcome else ()
        within = sum(result.agrees for result in results)
        count = f"{within} of {len(results)}" if results else "–"
        link = f"[{report.comparison.TITLE}](#{report.name})"
        rows.append((link, count, report.verdict))
    return _markdown_table(("comparison", "quantities that agree", "verdict"), rows)


def page_text(reports: Sequence[Report], drawn: dict[str, list[tuple[str, str]]]) -> str:
    """The page in Markdown; ``drawn`` has each comparison's pictures and captions."""
    lines = [INTRODUCTION, "## All comparisons", "", f"{summary(reports).capitalize()}.", ""]
    lines += [*_overview(reports), ""]
    for report in reports:
        lines += _section(report, drawn.get(report.name, []))
    return "\n".join(lines).rstrip() + "\n"


def write_page(reports: Sequence[Report], path: Path) -> list[str]:
    """Write the page, and its pictures in a folder ``images/validation`` beside it.

    All are written under temporary names and moved when the last is drawn.  Pictures of
    comparisons that are not among the reports are left alone.

    Parameters
    ----------
    reports : sequence of Report
    path : Path
        Markdown file to write.

    Returns
    -------
    list of str
        A line for each plot that could not be drawn; the page does without it.

    Raises
    ------
    InputError
        If the folder is not there or cannot be written to.
    """
    check_page(path)
    try:
        with whole_file(path) as part, whole_folder(path.parent / PICTURES) as pictures:
            drawn, complaints = _draw(reports, pictures)
            part.write_text(page_text(reports, drawn), encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {reason(error)}") from None
    return complaints


def _draw(
    reports: Sequence[Report], folder: Path
) -> tuple[dict[str, list[tuple[str, str]]], list[str]]:
    """Draw all pictures; links and captions by comparison, and what could not be drawn."""
    drawn: dict[str, list[tuple[str, str]]] = {}
    complaints = []
    for report in reports:
        for picture in report.outcome.pictures if report.outcome else ():
            file = f"{report.name}-{picture.name}.png"
            try:
                picture.draw(folder / file)
            except Exception as error:
                (folder / file).unlink(missing_ok=True)
                said = on_one_line(error)
                complaints.append(f"{report.name}: plot {picture.name} failed: {said}")
                continue
            link = (PICTURES / file).as_posix()
            drawn.setdefault(report.name, []).append((link, picture.caption))
    return drawn, complaints


def check_page(path: Path) -> None:
    """Refuse a page that could not be written, before anything is run.

    Raises
    ------
    InputError
        If its folder is not there or it is a folder itself.
    """
    if path.is_dir() or not path.parent.is_dir():
        what = "is a folder" if path.is_dir() else "its folder is not there"
        raise InputError(f"--page: {path}: {what}; name a file such as docs/validation.md")
