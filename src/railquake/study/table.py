"""Columns of a study's table: the same in every part, whatever happened in its runs."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from railquake import measures
from railquake.errors import InputError

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

    from railquake.study.design import Design, Point

__all__ = ["distinct", "in_columns", "table_row", "table_schema", "to_pandas"]

_DESIGN = ("row", "record", "level", "scale")
_KINDS = {"number": "float64", "integer": "int64", "flag": "bool", "text": "string"}  # of an axis
_VALUES = {float: "float64", int: "int64", bool: "bool", str: "string"}  # of a measure


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
        if axis.column in (*_DESIGN, *measures.all_keys(), "scenario_hash", "error"):
            raise InputError(
                f"{design.where}: axes.{axis.column}: the table has a column of this name "
                "already; choose another name"
            )
        columns[axis.column] = _KINDS.get(axis.kind, "string")
    columns["scenario_hash"] = "string"
    for measure in measures.MEASURES:
        columns[measure.key] = _VALUES[measure.value]
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
    point: Point, scenario_hash: str | None, measured: Mapping[str, Any]
) -> dict[str, Any]:
    """One row of the table.

    Parameters
    ----------
    point : Point
        Of the design.
    scenario_hash : str or None
        None where no scenario could be made.
    measured : mapping
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
        **measured,
    }
    if isinstance(row.get("versions"), Mapping):
        row["versions"] = json.dumps(row["versions"], sort_keys=True)
    return row


def in_columns(table: pa.Table, schema: pa.Schema) -> pa.Table:
    """A table that was read, in the columns of its study.

    A measure that was not taken yet when the rows were made is null, so that a folder outlives the
    measures that come later.

    Parameters
    ----------
    table : pyarrow.Table
    schema : pyarrow.Schema
        Of `table_schema`.

    Raises
    ------
    KeyError
        If another column is missing.
    pyarrow.ArrowException
        If values are of another type.
    """
    import pyarrow as pa

    for name in measures.all_keys():
        if name != "status" and name not in table.column_names:
            table = table.append_column(name, pa.nulls(table.num_rows, schema.field(name).type))
    return table.select(schema.names).cast(schema)


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
