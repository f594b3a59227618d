"""Results of a study: its table, and the scenario of each row; merging those of shards."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from railquake.errors import InputError
from railquake.inputs.toml import read_toml
from railquake.messages import no_folder
from railquake.study.design import Design
from railquake.study.folder import STUDY_FILE, TABLE_FILE, ResultsFolder, no_note, read_parquet
from railquake.study.moved import found_again
from railquake.study.study import Study
from railquake.study.table import distinct, in_columns, table_schema, to_pandas

if TYPE_CHECKING:
    import pandas as pd

    from railquake.inputs.scenario import Scenario

__all__ = ["StudyResults", "merge_results", "open_results"]


@dataclass(frozen=True)
class StudyResults:
    """Results of a study.

    Parameters
    ----------
    folder : Path
    study : Study
        As it was resolved: its suite loaded, values in SI units.
    """

    folder: Path
    study: Study

    @cached_property
    def design(self) -> Design:
        """Which run is which."""
        return Design(self.study, ResultsFolder(self.folder).time_step())

    @cached_property
    def table(self) -> pd.DataFrame:
        """All finished rows in the design's order.

        Columns: ``row`` (from 0), ``record``, ``level``, ``scale`` (factor on the motion, all
        told), one for each axis (SI units), ``scenario_hash``, the keys of `assess` (``versions``
        as JSON; what was not measured yet when a row was made is missing), and ``error`` (None
        unless the run failed).
        """
        schema = table_schema(self.design)
        file = self.folder / TABLE_FILE
        if not file.exists():
            return to_pandas(distinct(ResultsFolder(self.folder).load(schema, no_note)))
        import pyarrow as pa

        try:
            return to_pandas(in_columns(read_parquet(file), schema))
        except (pa.ArrowException, OSError, KeyError, ValueError):
            raise InputError(
                f"{file}: is damaged; run the study again with the same --out to make it anew"
            ) from None

    @property
    def missing(self) -> int:
        """Number of runs that have not finished."""
        return self.design.size - len(self.table)

    def scenario(self, row: int) -> Scenario:
        """Rebuild the scenario of a row.

        Parameters
        ----------
        row : int
            Its number in the design, from 0: the column ``row``.

        Returns
        -------
        Scenario

        Raises
        ------
        InputError
            If there is no such row, or a file has changed since it was run.
        """
        size = self.design.size
        if not 0 <= row < size:
            raise InputError(f"{self.folder}: there is no row {row}; rows are 0 to {size - 1}")
        scenario = self.design.scenario(self.design.point(row))
        known = self.table.loc[self.table["row"] == row, "scenario_hash"]
        if len(known) and known.iloc[0] is not None and known.iloc[0] != scenario.content_hash():
            raise InputError(
                f"{self.folder}: row {row}: its record, another of its files or a preset has "
                "changed since it was run; run the study again"
            )
        return scenario


def open_results(folder: str | Path, *, records: str | Path | None = None) -> StudyResults:
    """Open the folder of a study.

    Parameters
    ----------
    folder : str or Path
        As given to `Study.run`; the study may be unfinished.
    records : str or Path, optional
        The folder in which the records are now, if they are not where they were.  What was moved
        together with the study's folder is found without it.

    Returns
    -------
    StudyResults

    Raises
    ------
    InputError
        If the folder is not there, is empty, or holds something else; or the folder of the
        records lacks one.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise no_folder(folder, "give the one that railquake study wrote")
    file = folder / STUDY_FILE
    if not file.exists():
        what = "is empty" if not any(folder.iterdir()) else f"holds no study (no {STUDY_FILE})"
        raise InputError(f"{folder}: {what}; give the folder that railquake study wrote")
    place = None if records is None else Path(records)
    tables = found_again(read_toml(file), folder.absolute(), place)
    study = Study.from_dict(tables, folder, where=str(file))
    if not ResultsFolder(folder).names() and not (folder / TABLE_FILE).exists():
        raise InputError(f"{folder}: holds a study without any finished run; run it first")
    return StudyResults(folder, study)


def merge_results(
    folders: Sequence[str | Path],
    out: str | Path,
    notify: Callable[[str], None] | None = None,
) -> StudyResults:
    """Merge the parts of shards into one table.

    Parameters
    ----------
    folders : sequence of str or Path
        Folders of shards of one study.
    out : str or Path
        Folder for the whole; may be one of them.
    notify : callable, optional
        Called with a line about rows that are missing or parts that are damaged.

    Returns
    -------
    StudyResults

    Raises
    ------
    InputError
        If a folder holds no study, or another one.
    """
    say = notify or no_note
    if not folders:
        raise InputError("merge: give the folders of the shards")
    target = ResultsFolder(Path(out))
    first = open_results(folders[0])
    made_by = ResultsFolder(first.folder).made_by()
    target.prepare(first.study, say, made_by)
    step = ResultsFolder(first.folder).time_step()
    for folder in folders:
        results, source = open_results(folder), ResultsFolder(Path(folder))
        target.compare({**source.made_by(), **results.study.to_dict()}, say)
        if source.time_step() != step:
            raise InputError(f"{folder}: its time step is not that of {folders[0]}; run it again")
        if target.path.resolve() == source.path.resolve():
            continue
        target.take_over(source, table_schema(results.design), say)
    merged = open_results(out)
    target.write_table(table_schema(merged.design))
    if merged.missing:
        say(f"{merged.missing} of {merged.design.size} rows are missing")
    return merged
