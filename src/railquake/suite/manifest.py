"""A suite from a manifest: a CSV file with a row for each record and its scale factor."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from railquake.errors import InputError
from railquake.files import is_file, read_file
from railquake.messages import no_folder, unreadable
from railquake.suite.model import Suite, SuiteMember
from railquake.suite.peer import is_search_report, search_rows
from railquake.suite.rows import SuiteRow, positive_number

__all__ = ["SuiteRow", "read_manifest", "read_rows", "suite_of_rows"]

REQUIRED = ("file", "scale_factor")
"""Columns that every manifest has; others that are not known here are left alone."""
READER = ("channel", "units", "dt")
"""Columns that say how a file is read, where it does not say so itself."""
MOST_ROWS = 100_000
_RSN = re.compile(r"rsn0*([0-9]+)", re.IGNORECASE)


def read_manifest(path: Path, records: Path | None) -> Suite:
    """Read a suite's manifest and find its records.

    Parameters
    ----------
    path : Path
        CSV with the columns file and scale_factor.  Optional: name; channel, units and dt, as in
        ``[motion]``; rsn, which the number in the file's name must agree with.  Other columns are
        left alone, lines that start with # are remarks.  Or PEER's _SearchResults.csv: both
        horizontal components of each record with its scale factor.
    records : Path or None
        Folder that relative files start from; the manifest's own folder if None.

    Returns
    -------
    Suite
        In the order of the rows.

    Raises
    ------
    InputError
        If the manifest or a record is missing, or a row is wrong: file, line and column.
    """
    try:
        text = read_file(path).decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError(f"{path}: there is no such manifest of a suite; check the path") from None
    except (OSError, UnicodeDecodeError) as error:
        raise unreadable(path, error) from None
    rows = (search_rows if is_search_report(text) else read_rows)(text, str(path))
    return suite_of_rows(path.stem, rows, records or path.parent)


def read_rows(text: str, where: str) -> tuple[SuiteRow, ...]:
    """The rows of a manifest, each checked by itself.

    Parameters
    ----------
    text : str
        The file's content.
    where : str
        The file's path, for messages.

    Raises
    ------
    InputError
        Naming the line and the column.
    """
    lines = _lines(text, where)
    number, header = next(lines, (0, []))
    if not number:
        raise InputError(f"{where}: is empty; a header with file,scale_factor and rows are needed")
    for column in REQUIRED:
        if column not in header:
            raise InputError(
                f"{where}, line {number}: column {column} is missing among "
                f"{', '.join(map(repr, header))}"
            )
    for column in header:
        if column and header.count(column) > 1:
            raise InputError(f"{where}, line {number}: column {column!r} is there twice")
    rows: list[SuiteRow] = []
    for number, cells in lines:
        place = f"{where}, line {number}"
        if len(cells) != len(header):
            raise InputError(
                f"{place}: {len(cells)} cells under {len(header)} columns; "
                "a text with a comma needs quotation marks"
            )
        rows.append(_row(dict(zip(header, cells, strict=True)), place))
        if len(rows) > MOST_ROWS:
            raise InputError(f"{place}: over {MOST_ROWS} rows")
    if not rows:
        raise InputError(f"{where}: has a header but no rows; a row for each record is needed")
    return tuple(rows)


def _lines(text: str, where: str) -> Iterator[tuple[int, list[str]]]:
    """Number and cells of every line that is neither blank nor a remark."""
    # remarks become blank lines first: a quotation mark in one means nothing
    lines = ("" if line.startswith("#") else line for line in text.splitlines())
    reader = csv.reader(lines, strict=True)
    try:
        for cells in reader:
            stripped = [cell.strip() for cell in cells]
            if any(stripped):
                yield reader.line_num, stripped
    except csv.Error as error:
        raise InputError(f"{where}, line {reader.line_num}: is no CSV: {error}") from None


def _row(cells: dict[str, str], place: str) -> SuiteRow:
    file = cells["file"]
    if not file or not file.isprintable():
        raise InputError(f"{place}: file: a record's file is needed, found {file!r}")
    factor = positive_number(cells["scale_factor"], f"{place}: scale_factor")
    given = _RSN.search(Path(file).name)
    wanted = cells.get("rsn", "")
    if wanted:
        if not (wanted.isascii() and wanted.isdigit()):
            raise InputError(f"{place}: rsn: must be a whole number, found {wanted!r}")
        if given is not None and int(given[1]) != int(wanted):
            raise InputError(
                f"{place}: rsn: is {int(wanted)}, but the file is called {file}; "
                "correct one of them"
            )
    return SuiteRow(place, file, factor, {key: text for key, text in cells.items() if key and text})


def suite_of_rows(
    name: str,
    rows: tuple[SuiteRow, ...],
    records: Path,
    missing: Callable[[list[SuiteRow], int, Path], str] | None = None,
) -> Suite:
    """Find each row's record in the folder.

    Parameters
    ----------
    name : str
        Of the suite.
    rows : tuple of SuiteRow
        Its members.
    records : Path
        Folder that relative files start from.
    missing : callable, optional
        Makes the message from the rows without a record, the number of rows and the folder.

    Raises
    ------
    InputError
        If a record is there twice, or missing: the first is named, all are counted.
    """
    if not records.is_dir():
        raise no_folder(records, "give the one that holds the records")
    motions: list[dict[str, Any]] = []
    seen: dict[tuple[object, ...], SuiteRow] = {}
    for row in rows:
        path = (records / row.file).absolute()
        key = (path.resolve(), row.cells.get("channel"))
        if key in seen:
            raise InputError(
                f"{row.place}: file: {row.file} is there already "
                f"({seen[key].place.rpartition(', ')[2]}); a record counts once"
            )
        seen[key] = row
        motions.append({"record": str(path)} | _reading(row))
    gaps = [row for row, table in zip(rows, motions, strict=True) if not is_file(table["record"])]
    if gaps:
        raise InputError((missing or _missing)(gaps, len(rows), records))
    return Suite(
        name,
        tuple(
            SuiteMember(label, motion, row.scale_factor)
            for label, motion, row in zip(_labels(rows), motions, rows, strict=True)
        ),
    )


def _missing(missing: list[SuiteRow], count: int, records: Path) -> str:
    first = missing[0]
    others = f" ({len(missing)} of {count} are missing)" if len(missing) > 1 else ""
    return (
        f"{first.place}: file: {first.file} is not in {records}{others}; "
        "give the folder of the records with --records"
    )


def _reading(row: SuiteRow) -> dict[str, Any]:
    """What a row says about reading its file, as in ``[motion]``."""
    table: dict[str, Any] = {key: row.cells[key] for key in READER if key in row.cells}
    if table.get("channel", "").isdigit():
        table["channel"] = int(table["channel"])
    if "dt" in table:
        table["dt"] = positive_number(table["dt"], f"{row.place}: dt")
    return table


def _labels(rows: tuple[SuiteRow, ...]) -> list[str]:
    """A name for each row: its own, its file's, or with folder and channel where that is not it."""
    labels = [row.label for row in rows]
    for fuller in (
        [row.file for row in rows],
        [f"{row.file} {row.cells.get('channel', '')}".rstrip() for row in rows],
    ):
        count = Counter(labels)
        labels = [b if count[a] > 1 else a for a, b in zip(labels, fuller, strict=True)]
    return labels
