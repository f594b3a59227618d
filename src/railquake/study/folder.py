"""The folder of a study: its file, the finished rows in parts, and the table."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from railquake.errors import InputError
from railquake.files import prepare_folder, random_name, set_aside, whole_file
from railquake.inputs.toml import dumps, read_toml
from railquake.messages import reason, shown
from railquake.parts import sweep
from railquake.run.assess import physics
from railquake.run.time_step import TimeStep
from railquake.study.file import MADE_BY
from railquake.study.moved import FOLDER, without_folders
from railquake.study.table import distinct, in_columns

if TYPE_CHECKING:
    import pyarrow as pa

    from railquake.study.file import StudyInputs

__all__ = [
    "STUDY_FILE",
    "TABLE_FILE",
    "ResultsFolder",
    "made_by_this",
    "no_note",
    "read_parquet",
]

STUDY_FILE = "study.toml"
TABLE_FILE = "runs.parquet"
TIME_STEP_FILE = "time_step.json"
PARTS = "parts"


def write_parquet(table: pa.Table, path: Path) -> None:
    """Write a table with checksums of its pages; whole or not at all, and on the disk."""
    import pyarrow.parquet as pq

    with whole_file(path, durable=True) as part:
        pq.write_table(table, part, compression="zstd", write_page_checksum=True)


def read_parquet(path: Path) -> pa.Table:
    """Read a table and check it against its own checksums."""
    import pyarrow.parquet as pq

    with path.open("rb") as file:
        return pq.read_table(file, page_checksum_verification=True)


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

    def prepare(
        self, study: StudyInputs, notify: Callable[[str], None], made_by: Mapping[str, str]
    ) -> None:
        """Make the folder, or make sure that it holds results of this very study.

        Parameters
        ----------
        study : StudyInputs
        notify : callable
            Called with a line if its rows were made by another version.
        made_by : mapping
            What makes the rows; see `made_by_this`.

        Raises
        ------
        InputError
            If it holds another study, or something else, or cannot be written.
        """
        prepare_folder(self.path)
        file = self.path / STUDY_FILE
        tables = {**made_by, FOLDER: str(self.path.absolute()), **study.to_dict()}
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
            for folder in (self.path, self.parts):
                sweep(folder)  # what an execution that was killed was writing
            if not file.exists():
                text = "# Written by railquake: the study of this folder.\n" + dumps(tables)
                with whole_file(file, durable=True) as part:
                    part.write_text(text, encoding="utf-8")
        except UnicodeEncodeError:
            raise InputError(
                f"--out {self.path}: a path of the study is not UTF-8 and cannot be noted in "
                f"{STUDY_FILE}; rename it, or set a locale with UTF-8, such as LC_ALL=C.UTF-8"
            ) from None
        except OSError as error:
            raise InputError(f"--out {self.path}: cannot be written: {reason(error)}") from None

    def compare(self, tables: Mapping[str, Any], notify: Callable[[str], None]) -> None:
        """Refuse a study that is not the one of this folder.

        Raises
        ------
        InputError
            Naming what differs.
        """
        file = self.path / STUDY_FILE
        old, new = dict(read_toml(file)), dict(tables)
        for read in (old, new):
            read.pop(FOLDER, None)
        former, now = ({key: table.pop(key, None) for key in MADE_BY} for table in (old, new))
        # written and read once, so that both have the same form
        differences = _differences(old, _as_read(new))
        if differences:
            more = f" and {len(differences) - 4} more" if len(differences) > 4 else ""
            raise InputError(
                f"--out {self.path}: holds another study; {'; '.join(differences[:4])}{more}; "
                "take another folder, or change the study back"
            )
        for key in MADE_BY:
            if None not in (former[key], now[key]) and former[key] != now[key]:
                notify(f"rows in {self.path} were made by {key} {former[key]}, new ones by "
                       f"{now[key]}; for rows of one kind take another folder")  # fmt: skip

    def made_by(self) -> dict[str, str]:
        """What made its rows, as far as it was noted; see `made_by_this`."""
        return {k: v for k, v in read_toml(self.path / STUDY_FILE).items() if k in MADE_BY}

    def add(self, rows: Sequence[Mapping[str, Any]], schema: pa.Schema) -> None:
        """Keep finished rows: a new part.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        import pyarrow as pa

        table = pa.Table.from_pylist(sorted(rows, key=lambda row: row["row"]), schema=schema)
        path = self.parts / random_name(".parquet")
        try:
            write_parquet(table, path)
        except OSError as error:
            raise InputError(
                f"{self.parts}: cannot be written: {reason(error)}; {self.kept} rows that "
                "finished before are kept: make room and run the same command again to go on"
            ) from None
        self.kept += len(rows)

    def take_over(
        self, source: ResultsFolder, schema: pa.Schema, notify: Callable[[str], None]
    ) -> None:
        """Copy the rows, and the choice of a time step, of another folder of the same study.

        Raises
        ------
        InputError
            If they cannot be written.
        """
        table = distinct(source.load(schema, notify))
        path = self.parts / random_name(".parquet")
        try:
            write_parquet(table, path)
            choice = source.time_step()
            if choice is not None:
                self.note_time_step(choice)
        except OSError as error:
            raise InputError(f"--out {self.path}: cannot be written: {reason(error)}") from None

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
                tables.append(in_columns(read_parquet(path), schema))
            except FileNotFoundError:
                continue
            except (pa.ArrowException, OSError, KeyError, ValueError):
                notify(f"{path}: truncated or damaged; its rows are computed again")
                set_aside(path, ".damaged")
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
                write_parquet(table, self.path / TABLE_FILE)
            except OSError as error:
                raise InputError(
                    f"{self.path / TABLE_FILE}: cannot be written: {reason(error)}; all rows are "
                    f"kept in {self.parts}: make room and run the same command again"
                ) from None
            if names == self.names():
                return table

    def time_step(self) -> TimeStep | None:
        """The time step that was chosen for the study.

        Raises
        ------
        InputError
            If its file is damaged.
        """
        file = self.path / TIME_STEP_FILE
        try:
            found = json.loads(file.read_text(encoding="utf-8"))
            return TimeStep(
                int(found["halvings"]),
                float(found["error"]),
                float(found["tolerance"]),
                int(found["tried"]),
            )
        except FileNotFoundError:
            return None
        except (OSError, ValueError, KeyError, TypeError):
            raise InputError(
                f"{file}: is damaged; delete the folder and run the study again"
            ) from None

    def note_time_step(self, choice: TimeStep) -> TimeStep:
        """Note the time step that was chosen; what holds: another shard may have been faster."""
        file = self.path / TIME_STEP_FILE
        text = json.dumps({**asdict(choice), "text": choice.text}, indent=2) + "\n"
        try:
            with whole_file(file, replace=False) as part:
                part.write_text(text, encoding="utf-8")
        except OSError as error:
            raise InputError(f"{file}: cannot be written: {reason(error)}") from None
        found = self.time_step()
        assert found is not None  # it has just been written
        return found


def made_by_this() -> dict[str, str]:
    """What makes rows here: the version of railquake, and that of its physics and compiler."""
    from railquake.version import __version__

    return {"railquake": __version__, "physics": physics()}


def no_note(_: str) -> None:
    """Say nothing."""


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
    a, b = (
        {k: without_folders(k, v) for k, v in x.items() if not k.endswith(".name")} for x in (a, b)
    )
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
    return json.dumps(_named({key: value for key, value in tables.items() if key != "base"}))


def _named(value: Any, path: str = "") -> Any:
    """The same with names of files for their paths."""
    if isinstance(value, Mapping):
        return {key: _named(item, key) for key, item in value.items()}
    if isinstance(value, list):
        return [_named(item, path) for item in value]
    return without_folders(path, value)
