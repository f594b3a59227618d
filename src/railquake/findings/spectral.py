"""Spectral acceleration at the pier's first period, for tables made before rows carried it."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.errors import InputError
from railquake.inputs.support import Pier
from railquake.run.spectral import DAMPING, first_period

if TYPE_CHECKING:
    import pandas as pd

    from railquake.inputs.scenario import Scenario

__all__ = ["first_period", "with_spectral_acceleration"]

MOST = 1000  # different piers and motions that are looked at
# what does not change Sa(T1) over the scale
_OTHERS = ("row", "level", "scale")
_OTHER_SECTIONS = ("vehicle.", "wheelrail.", "solver.", "motion.scale")


def with_spectral_acceleration(
    table: pd.DataFrame, scenario_of: Callable[[int], Scenario]
) -> pd.DataFrame:
    """The table with Sa(T1), 5 % damping.

    Parameters
    ----------
    table : DataFrame
        Rows of a study.
    scenario_of : callable
        Number of a row -> its scenario.

    Returns
    -------
    DataFrame
        With the columns ``t1_s`` and ``sa_t1_m_s2`` (pseudo-spectral acceleration of the motion as
        it was scaled); NaN at grade, where the scenario cannot be made any more, and throughout
        where piers and motions are more than `MOST`.
    """
    from railquake.suite import spectral_acceleration

    names = list(table.columns)
    design = names[: names.index("scenario_hash")] if "scenario_hash" in names else []
    keys = [n for n in design if n not in _OTHERS and not n.startswith(_OTHER_SECTIONS)]
    if not keys or len(table.drop_duplicates(keys)) > MOST:
        return table.assign(t1_s=math.nan, sa_t1_m_s2=math.nan)
    known: dict[Any, tuple[float, float]] = {}
    spectra: dict[Any, float] = {}
    found = []
    for row in table.to_dict("records"):
        scale = abs(float(row["scale"]))
        key = tuple(row[name] for name in keys)
        if key not in known and scale > 0.0:
            known[key] = _of(row["row"], scale, scenario_of, spectra, spectral_acceleration)
        period, unit = known.get(key, (math.nan, math.nan))
        found.append((period, unit * scale))
    values = np.array(found).reshape(-1, 2)
    return table.assign(t1_s=values[:, 0], sa_t1_m_s2=values[:, 1])


def _of(
    row: int,
    scale: float,
    scenario_of: Callable[[int], Scenario],
    spectra: dict[Any, float],
    spectral_acceleration: Callable[..., float],
) -> tuple[float, float]:
    """Period, and spectral acceleration for a scale of one."""
    try:
        scenario = scenario_of(row)
        if not isinstance(scenario.support, Pier) or scenario.motion is None:
            return math.nan, math.nan
        period = first_period(scenario.support)
        motion = scenario.motion.model_dump(exclude={"scale", "vertical", "vertical_acceleration"})
        key = json.dumps(motion, sort_keys=True, default=str), round(period, 9)
        if key not in spectra:
            spectra[key] = spectral_acceleration(scenario, period, DAMPING) / scale
    except InputError:
        return math.nan, math.nan
    return period, spectra[key]
