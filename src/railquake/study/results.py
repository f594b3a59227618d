"""The folder of a study: its file, the finished rows in parts, and the table."""

from __future__ import annotations

import json
import os
import tempfile
import uuid
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from railquake.errors import InputError
from railquake.inputs._toml import dumps, read_toml
from railquake.inputs.units import shown

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

    from railquake.inputs.scenario import Scenario
    from railquake.study.design import Design, Point
    from railquake.study.file import Study

__all__ = [
    "MEASURES",
    "TIMINGS",
    "ResultsFolder",
    "StudyResults",
    "merge_results",
    "open_results",
]

# What `assess` gives, but for numbers: all others are real numbers.
_TEXTS = ("status", "derailment_mode", "contact", "versions")
_FLAGS = ("derailed",)
_WHOLE = ("uplifts", "steps")
MEASURES = (
    "status", "derailed", "derailment_mode", "pga_m_s2", "pgv_m_s", "arias_intensity_m_s", "pbd_m",
    "pbv_m_s", "pba_m_s2", "hinge_rotation_peak_rad", "base_moment_peak_n_m",
    "top_rotation_peak_rad", "relative_roll_peak_rad", "uplift_ratio", "lateral_shift_peak_m",
    "wheel_load_static_n", "wheel_load_peak_n", "wheel_unloading_peak", "lateral_force_peak_n",
    "lateral_force_filtered_peak_n", "derailment_coefficient_peak", "flange_clearance_peak_m",
    "off_rail_time_s", "detached_time_s", "uplifts", "flange_contact_first_s", "uplift_first_s",
    "uplift_last_end_s", "onset_first_s", "flange_over_first_s", "derailed_s", "overturned_s",
    "energy_residual", "contact_energy_residual", "energy_dissipated_j", "steps", "steps_per_s",
    "wall_s", "dt_s", "dt_critical_s", "contact", "versions",
)  # fmt: skip
"""Keys of `assess`, columns of the table."""
TIMINGS = ("wall_s", "steps_per_s")
"""Columns that differ from one execution to the next."""
_DESIGN = ("row", "record", "level", "scale")
_KINDS = {"number": "float64", "integer": "int64", "flag": "bool", "text": "string"}
STUDY_FILE = "study.toml"
TABLE_FILE = "runs.parquet"
TIME_STEP_FILE = "time_step.json"
PARTS = "parts"


def table_schema(design: Design) -> pa.Schema:
    """Columns and types of a study's table, the same whatever happens in its runs.

    Parameters
    ----------
    design : Design

    Raises
    ------
    InputError
        If an axis is called like another column.
    """
    import pandas as pd
    import pyarrow as pa

    columns = {"row": "int64", "record": "string", "level": "string", "scale": "float64"}
    for axis in design.axes:
        if axis.column in (*_DESIGN, *MEASURES, "scenario_hash", "error"):
            raise InputError(
                f"{design.where}: axes.{axis.column}: the table has a column of this name "
                "already; choose another name"
            )
        columns[axis.column] = _KINDS.get(axis.kind, "string")
    columns["scenario_hash"] = "string"
    for name in MEASURES:
        kind = "text" if name in _TEXTS else "flag" if name in _FLAGS else "number"
        columns[name] = _KINDS["integer" if name in _WHOLE else kind]
    columns["error"] = "string"
    schema = pa.schema([(name, _arrow(kind)) for name, kind in columns.items()])
    # what pandas makes of it: types that know missing values, so that they never change
    empty = pd.DataFrame({name: pd.Series([], dtype=_pandas(n, k)) for n, k in columns.items()
                          for name in (n,)})  # fmt: skip
    return schema.with_metadata(pa.Schema.from_pandas(empty, preserve_index=False).metadata)


def _arrow(kind: str) -> pa.DataType:
    import pyarrow as pa

    return {"string": pa.string(), "bool": pa.bool_(), "int64": pa.int64()}.get(kind, pa.float64())


def _pandas(name: str, kind: str) -> str:
    if name == "row" or kind == "float64":
        return kind
    return {"int64": "Int64", "bool": "boolean", "string": "object"}[kind]


def table_row(
    point: Point, scenario_hash: str | None, measures: Mapping[str, Any]
) -> dict[str, Any]:
    """One row of the table.

    Parameters
    ----------
    point : Point
        Of the design.
    scenario_hash : str or None
        None where no scenario could be made.
    measures : mapping
        What `assess` gave, or the status ``failed`` and the error.
    """
    row = {
        "row": point.row,
        "record": point.record,
        "level": point.level,
        "scale": point.scale,
        **point.labels,
        "scenario_hash": scenario_hash,
        "error": None,
        **measures,
    }
    if isinstance(row.get("versions"), Mapping):
        row["versions"] = json.dumps(row["versions"], sort_keys=True)
    return row


# --- files --------------------------------------------------------------------------------------


def _replace(path: Path, write: Callable[[Path], None]) -> None:
    """Write a file under a temporary name, make sure that it is on the disk, and move it."""
    part = path.with_name(f".{path.name}.{uuid.uuid4().hex[:8]}.tmp")
    try:
        write(part)
        with part.open("rb+") as file:
            os.fsync(file.fileno())
        part.replace(path)
        with suppress(OSError):  # not every file system can
            folder = os.open(path.parent, os.O_RDONLY)
            try:
                os.fsync(folder)
            finally:
                os.close(folder)
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)


def _write_parquet(table: pa.Table, path: Path) -> None:
    import pyarrow.parquet as pq

    pq.write_table(table, path, compression="zstd", write_page_checksum=True)


def _read_parquet(path: Path) -> pa.Table:
    import pyarrow.parquet as pq

    with path.open("rb") as file:
        return pq.read_table(file, page_checksum_verification=True)


def _writable(folder: Path) -> None:
    """Make sure, before a long run, that the folder can be made and written to."""
    if os.path.lexists(folder) and not folder.is_dir():
        raise InputError(f"--out {folder}: is no folder; name a folder")
    there = folder.absolute()
    while not os.path.lexists(there):
        there = there.parent
    try:
        with tempfile.TemporaryFile(dir=there):
            pass
    except OSError as error:
        raise InputError(f"--out {folder}: cannot be written: {_reason(error)}") from None


def _reason(error: OSError) -> str:
    return error.strerror or str(error)


class ResultsFolder:
    """The folder that a study leaves.

    ``study.toml`` is the study as it was resolved, ``parts/*.parquet`` the finished rows,
    ``runs.parquet`` the table in the design's order; ``time_step.json`` what was chosen where the
    study leaves the time step open.

    Parameters
    ----------
    path : Path
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.parts = path / PARTS
        self.kept = 0  # rows of this execution that are on the disk

    def prepare(self, study: Study, notify: Callable[[str], None]) -> None:
        """Make the folder, or make sure that it holds results of this very study.

        Raises
        ------
        InputError
            If it holds another study, or something else, or cannot be written.
        """
        from railquake import __version__

        _writable(self.path)
        file = self.path / STUDY_FILE
        tables = {"railquake": __version__, **study.to_dict()}
        if file.exists():
            self.compare(tables, notify)
        elif self.path.exists() and any(
            (self.path / name).exists() for name in (PARTS, TABLE_FILE)
        ):
            raise InputError(
                f"--out {self.path}: holds results but no {STUDY_FILE} that says of which study; "
                "take another folder"
            )
        try:
            self.parts.mkdir(parents=True, exist_ok=True)
            if not file.exists():
                text = "# Written by railquake: the study of this folder.\n" + dumps(tables)
                _replace(file, lambda path: _write_text(path, text))
        except OSError as error:
            raise InputError(f"--out {self.path}: cannot be written: {_reason(error)}") from None

    def compare(self, tables: Mapping[str, Any], notify: Callable[[str], None]) -> None:
        """Refuse a study that is not the one of this folder.

        Raises
        ------
        InputError
            Naming what differs.
        """
        file = self.path / STUDY_FILE
        old, new = dict(read_toml(file)), dict(tables)
        made_by = old.pop("railquake", None)
        version = new.pop("railquake", None)
        # written and read once, so that both have the same form
        differences = _differences(old, _as_read(new))
        if differences:
            more = f" and {len(differences) - 4} more" if len(differences) > 4 else ""
            raise InputError(
                f"--out {self.path}: holds another study; {'; '.join(differences[:4])}{more}; "
                "take another folder, or change the study back"
            )
        if made_by is not None and version is not None and made_by != version:
            notify(f"rows in {self.path} were made by railquake {made_by}, new ones by {version}")

    def add(self, rows: Sequence[Mapping[str, Any]], schema: pa.Schema) -> None:
        """Keep finished rows: a new part.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        import pyarrow as pa

        table = pa.Table.from_pylist(sorted(rows, key=lambda row: row["row"]), schema=schema)
        path = self.parts / f"{uuid.uuid4().hex}.parquet"
        try:
            _replace(path, lambda part: _write_parquet(table, part))
        except OSError as error:
            raise InputError(
                f"{self.parts}: cannot be written: {_reason(error)}; {self.kept} rows that "
                "finished before are kept: make room and run the same command again to go on"
            ) from None
        self.kept += len(rows)

    def names(self) -> list[str]:
        """Names of the parts, the oldest first."""
        found = []
        with suppress(FileNotFoundError):
            for path in self.parts.iterdir():
                if path.suffix == ".parquet" and not path.name.startswith("."):
                    found.append((path.stat().st_mtime_ns, path.name))
        return [name for _, name in sorted(found)]

    def load(
        self, schema: pa.Schema, notify: Callable[[str], None], names: Iterable[str] | None = None
    ) -> pa.Table:
        """All rows of all parts, as they come.

        A part that is damaged is reported and set aside; its rows count as not finished.

        Parameters
        ----------
        schema : pyarrow.Schema
            Of the study.
        notify : callable
        names : iterable of str, optional
            Parts to read; all by default.
        """
        import pyarrow as pa

        tables = [schema.empty_table()]
        for name in self.names() if names is None else names:
            path = self.parts / name
            try:
                found = _read_parquet(path)
                tables.append(found.select(schema.names).cast(schema))
            except FileNotFoundError:
                continue
            except (pa.ArrowException, OSError, KeyError, ValueError):
                notify(f"{path}: truncated or damaged; its rows are computed again")
                with suppress(OSError):
                    path.replace(path.with_suffix(".damaged"))
        return pa.concat_tables(tables)

    def write_table(
        self, schema: pa.Schema, hashes: Mapping[int, str | None] | None = None
    ) -> pa.Table:
        """Write ``runs.parquet`` from all parts; what it holds.

        Another shard may add a part meanwhile: then it is written again.

        Parameters
        ----------
        schema : pyarrow.Schema
            Of the study.
        hashes : mapping, optional
            See `distinct`.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        while True:
            names = self.names()
            table = distinct(self.load(schema, no_note, names), hashes)
            try:
                _replace(self.path / TABLE_FILE, partial(_write_parquet, table))
            except OSError as error:
                raise InputError(
                    f"{self.path / TABLE_FILE}: cannot be written: {_reason(error)}; all rows are "
                    f"kept in {self.parts}: make room and run the same command again"
                ) from None
            if names == self.names():
                return table

    def time_step(self) -> float | None:
        """The time step that was chosen for the study, s.

        Raises
        ------
        InputError
            If its file is damaged.
        """
        file = self.path / TIME_STEP_FILE
        try:
            return float(json.loads(file.read_text(encoding="utf-8"))["dt_s"])
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, TypeError):
            raise InputError(
                f"{file}: is damaged; delete the folder and run the study again"
            ) from None

    def note_time_step(self, facts: Mapping[str, Any]) -> float:
        """Note the time step that was chosen; what holds: another shard may have been faster."""
        file = self.path / TIME_STEP_FILE
        text = json.dumps(dict(facts), indent=2) + "\n"
        draft = file.with_name(f".{file.name}.{uuid.uuid4().hex[:8]}.tmp")
        try:
            _write_text(draft, text)
            with suppress(FileExistsError):
                os.link(draft, file)
        except OSError as error:
            raise InputError(f"{file}: cannot be written: {_reason(error)}") from None
        finally:
            with suppress(OSError):
                draft.unlink(missing_ok=True)
        found = self.time_step()
        assert found is not None  # it has just been written
        return found


def distinct(table: pa.Table, hashes: Mapping[int, str | None] | None = None) -> pa.Table:
    """Each row once, in the design's order.

    Of rows that are there twice, one that did not fail; of these the last.

    Parameters
    ----------
    table : pyarrow.Table
        Of `ResultsFolder.load`.
    hashes : mapping, optional
        Hashes that rows must have: others stem from an older state of the study's files.
    """
    import numpy as np
    import pyarrow as pa

    if hashes is not None:
        pairs = zip(
            table.column("row").to_pylist(), table.column("scenario_hash").to_pylist(), strict=True
        )
        table = table.filter(pa.array([hashes.get(r, h) == h for r, h in pairs], pa.bool_()))
    if not table.num_rows:
        return table
    rows = table.column("row").to_numpy()
    failed = table.column("status").to_numpy() == "failed"
    order = np.lexsort((-np.arange(len(rows)), failed, rows))
    first = np.ones(len(order), dtype=bool)
    first[1:] = rows[order][1:] != rows[order][:-1]
    return table.take(pa.array(order[first])).combine_chunks()


def no_note(_: str) -> None:
    """Say nothing."""


def _write_text(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


def _as_read(tables: Mapping[str, Any]) -> dict[str, Any]:
    import tomllib

    return tomllib.loads(dumps(tables))


def _flat(value: Any, path: str = "") -> dict[str, Any]:
    if isinstance(value, Mapping) and value:
        return {k: v for key, item in value.items()
                for k, v in _flat(item, f"{path}.{key}" if path else key).items()}  # fmt: skip
    if isinstance(value, list) and value and all(isinstance(item, Mapping) for item in value):
        named = {str(item.get("name", k)): item for k, item in enumerate(value)}
        return {k: v for key, item in named.items()
                for k, v in _flat(item, f"{path}.{key}").items()}  # fmt: skip
    return {path: value}


def _differences(old: Mapping[str, Any], new: Mapping[str, Any]) -> list[str]:
    """What differs between two studies, a phrase each."""
    a, b = _flat(old), _flat(new)
    a, b = ({k: v for k, v in x.items() if not k.endswith(".name")} for x in (a, b))
    found = []
    for key in dict.fromkeys((*a, *b)):
        if key not in b:
            found.append(f"{key} was {shown(a[key])}, now is not there")
        elif key not in a:
            found.append(f"{key} was not there, now is {shown(b[key])}")
        elif a[key] != b[key]:
            found.append(f"{key} was {shown(a[key])}, now is {shown(b[key])}")
    if not found and _as_listed(old) != _as_listed(new):
        found.append("the order of axes, levels or motions was another")
    return found


def _as_listed(tables: Mapping[str, Any]) -> str:
    return json.dumps({key: value for key, value in tables.items() if key != "base"})


# --- reading ------------------------------------------------------------------------------------


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
        from railquake.study.design import Design

        return Design(self.study, ResultsFolder(self.folder).time_step())

    @cached_property
    def table(self) -> pd.DataFrame:
        """All finished rows in the design's order.

        Columns: ``row`` (from 0), ``record``, ``level``, ``scale`` (factor on the motion, all
        told), one for each axis (SI units), ``scenario_hash``, the keys of `assess` (``versions``
        as JSON), and ``error`` (None unless the run failed).
        """
        schema = table_schema(self.design)
        file = self.folder / TABLE_FILE
        if not file.exists():
            return to_pandas(distinct(ResultsFolder(self.folder).load(schema, no_note)))
        import pyarrow as pa

        try:
            return to_pandas(_read_parquet(file).select(schema.names).cast(schema))
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


def to_pandas(table: pa.Table) -> pd.DataFrame:
    """The table as pandas has it; types do not depend on the values."""
    import pandas as pd

    frame = table.to_pandas(
        types_mapper={
            _arrow("int64"): pd.Int64Dtype(),
            _arrow("bool"): pd.BooleanDtype(),
        }.get,
    )
    frame["row"] = frame["row"].astype("int64")
    for name in (field.name for field in table.schema if field.type == _arrow("string")):
        frame[name] = frame[name].astype("object").where(frame[name].notna(), None)
    return frame


def open_results(folder: str | Path) -> StudyResults:
    """Open the folder of a study.

    Parameters
    ----------
    folder : str or Path
        As given to `Study.run`; the study may be unfinished.

    Returns
    -------
    StudyResults

    Raises
    ------
    InputError
        If the folder is not there, is empty, or holds something else.
    """
    from railquake.study.file import Study

    folder = Path(folder)
    if not folder.is_dir():
        what = "is no folder" if folder.exists() else "there is no such folder"
        raise InputError(f"{folder}: {what}; give the one that railquake study wrote")
    file = folder / STUDY_FILE
    if not file.exists():
        what = "is empty" if not any(folder.iterdir()) else f"holds no study (no {STUDY_FILE})"
        raise InputError(f"{folder}: {what}; give the folder that railquake study wrote")
    study = Study.from_dict(read_toml(file), folder, where=str(file))
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
    target.prepare(first.study, say)
    step = ResultsFolder(first.folder).time_step()
    for folder in folders:
        results, source = open_results(folder), ResultsFolder(Path(folder))
        target.compare(results.study.to_dict(), say)
        if source.time_step() != step:
            raise InputError(f"{folder}: its time step is not that of {folders[0]}; run it again")
        if target.path.resolve() == source.path.resolve():
            continue
        schema = table_schema(results.design)
        found = distinct(source.load(schema, say))
        try:
            name = f"from-{source.path.resolve().name}-{uuid.uuid4().hex}.parquet"
            _replace(target.parts / name, partial(_write_parquet, found))
            if step is not None and target.time_step() is None:
                target.note_time_step(
                    json.loads((source.path / TIME_STEP_FILE).read_text(encoding="utf-8"))
                )
        except OSError as error:
            raise InputError(f"--out {out}: cannot be written: {_reason(error)}") from None
    merged = open_results(out)
    target.write_table(table_schema(merged.design))
    if merged.missing:
        say(f"{merged.missing} of {merged.design.size} rows are missing")
    return merged
