"""PEER's report of a search, _SearchResults.csv, as a manifest: its files and scale factors.

Criteria stand at the top; behind the line "-- Summary of Metadata of Selected Records --" come a
header and a row for each record, which ends in the names of the two horizontal components and the
vertical one; spectra follow.  The report is read as the site delivers it, with a blank behind each
comma, and as spreadsheets save it again: quotation marks doubled, empty cells at the ends of lines,
a station's name with a comma in two cells.
"""

from __future__ import annotations

import csv
import re
from pathlib import Path

from railquake.errors import InputError
from railquake.suite.rows import SuiteRow, positive_number

__all__ = ["is_search_report", "search_rows"]

SUMMARY = "summary of metadata of selected records"
RSN, FACTOR, FILE = "record sequence number", "scale factor", "horizontal-1 acc. filename"
FILES_AT_END = 3
"""Two horizontal components and the vertical one."""

_NAME = re.compile(r"[^,;\"]+\.AT2", re.IGNORECASE)


def is_search_report(text: str) -> bool:
    """Whether a text is such a report."""
    return SUMMARY in text[:20_000].lower()


def search_rows(text: str, where: str) -> tuple[SuiteRow, ...]:
    """Both horizontal components of each record, with the record's scale factor.

    Parameters
    ----------
    text : str
        The report.
    where : str
        The file's path, for messages.

    Returns
    -------
    tuple of SuiteRow

    Raises
    ------
    InputError
        Naming the line and the column.
    """
    lines = text.splitlines()
    start = next(i for i, line in enumerate(lines) if SUMMARY in line.lower()) + 1
    while start < len(lines) and not lines[start].strip(' ,;"'):
        start += 1
    if start == len(lines):
        raise InputError(f"{where}: ends behind its criteria; fetch the report again")
    separator = ";" if lines[start].count(";") > lines[start].count(",") else ","
    header = [cell.lower() for cell in _cells(lines[start], separator)]
    for column in (RSN, FACTOR, FILE):
        if column not in header:
            raise InputError(f"{where}, line {start + 1}: column {column!r} is missing")
    rows: list[SuiteRow] = []
    for number, line in enumerate(lines[start + 1 :], start + 2):
        if not line.strip(' ,;"'):
            break
        rows += _record(_cells(line, separator), header, f"{where}, line {number}")
    if not rows:
        raise InputError(f"{where}: lists no records; search again with other criteria")
    return tuple(rows)


def _cells(line: str, separator: str) -> list[str]:
    """Cells without the quotation marks and blanks around them, nor empty ones at the end."""
    cells = next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    cells = [cell.strip().strip('"').strip() for cell in cells]
    while cells and not cells[-1]:
        cells.pop()
    return cells


def _record(cells: list[str], header: list[str], place: str) -> list[SuiteRow]:
    # A comma in a name may have made two cells of one: count from either end.
    files = cells[-FILES_AT_END:]
    if len(cells) < len(header) or not all(_NAME.fullmatch(file) for file in files[:-1]):
        raise InputError(
            f"{place}: should end in the names of three .AT2 files, found "
            f"{', '.join(map(repr, files))[:100]}; fetch the report again"
        )
    factor = positive_number(cells[header.index(FACTOR)], f"{place}: scale factor")
    number = cells[header.index(RSN)]
    rows = []
    for file in files[:-1]:
        given = re.match(r"rsn0*([0-9]+)", Path(file).name, re.IGNORECASE)
        if given is not None and given[1] != number.lstrip("0"):
            raise InputError(
                f"{place}: record sequence number: is {number}, but the file is called {file}"
            )
        rows.append(SuiteRow(place, file, factor, {"rsn": number, "file": file}))
    return rows
