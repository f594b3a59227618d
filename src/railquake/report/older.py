"""Tables of older versions: what their rows lack is worked out from the study's scenarios.

A row carries all that a report needs.  Rows that were made before it did are completed here, so
that nothing else in a report asks where a number comes from.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

from railquake.errors import InputError
from railquake.findings import with_spectral_acceleration
from railquake.findings.resampling import FINISHED
from railquake.inputs.support import Pier

if TYPE_CHECKING:
    from railquake.study import StudyResults

__all__ = ["completed"]

_INPUTS = ("friction", "hinge_law", "lateral_force_filter_hz")
_DECIDING = ("support.kind", "support.hinge", "solver.lateral_force_filter")  # axes, and named ones


def completed(results: StudyResults) -> pd.DataFrame:
    """The table of a study with what rows of older versions lack.

    Parameters
    ----------
    results : StudyResults

    Returns
    -------
    DataFrame
        The table itself where no row lacks anything: then no scenario is made.  Missing is what
        cannot be told because the scenario cannot be made any more.
    """
    table = results.table
    # every run has its friction
    lacking = table["status"].isin(FINISHED) & table["friction"].isna()
    if not lacking.any():
        return table
    older = with_spectral_acceleration(table[lacking], results.scenario)
    inputs = _inputs(results, older)
    if "wheelrail.friction" in older:
        inputs["friction"] = older["wheelrail.friction"]
    whole = table.copy()
    for name in ("t1_s", "sa_t1_m_s2"):
        whole.loc[lacking, name] = older[name]
    for name in _INPUTS:
        whole.loc[lacking, name] = inputs[name]
    # as everywhere in a table, None for a text that is missing
    whole["hinge_law"] = whole["hinge_law"].where(whole["hinge_law"].notna(), None)
    return whole


def _inputs(results: StudyResults, rows: pd.DataFrame) -> pd.DataFrame:
    """What runs were given, one scenario for all that the axes cannot tell apart."""
    axes = [axis.column for axis in results.study.axes]
    deciding = [name for name in axes if "." not in name or name in _DECIDING]
    known: dict[Any, tuple[Any, ...]] = {}
    found = []
    for row in rows[["row", *deciding]].to_dict("records"):
        key = tuple(row[name] for name in deciding)
        if key not in known:
            known[key] = _inputs_of(results, int(row["row"]))
        found.append(known[key])
    return pd.DataFrame(found, index=rows.index, columns=list(_INPUTS))


def _inputs_of(results: StudyResults, row: int) -> tuple[Any, ...]:
    try:
        scenario = results.scenario(row)
    except InputError:
        return float("nan"), None, float("nan")
    support = scenario.support
    hinge = support.hinge if isinstance(support, Pier) else None
    return scenario.wheelrail.friction, hinge, scenario.solver.lateral_force_filter
