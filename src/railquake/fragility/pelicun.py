"""Curves in the layout of pelicun's damage model parameters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from railquake.errors import InputError
from railquake.measures import intensities
from railquake.messages import csv_cell

__all__ = ["LognormalCurve", "write_csv"]


class LognormalCurve(Protocol):
    """What a limit state is written from: the median in the measure's unit, and the dispersion."""

    @property
    def measure(self) -> str:
        """Short name of the measure."""

    @property
    def theta(self) -> float:
        """Median."""

    @property
    def beta(self) -> float:
        """Dispersion."""


def write_csv(
    path: str | Path,
    curves: Mapping[str, Sequence[LognormalCurve]],
    *,
    first_period_s: float | None = None,
) -> None:
    """Write curves in the layout of pelicun's damage model parameters.

    A row a component, the limit states in columns (tried with pelicun 3.10).

    Parameters
    ----------
    path : str or Path
    curves : mapping of str to list of Fragility
        By the component's identifier (a dash in it becomes a point): its limit states in order of
        severity (onset, then derailed), all against one measure.
    first_period_s : float, optional
        Period of the spectral acceleration, where a curve is against that.

    Raises
    ------
    InputError
        If the curves of a component are against different measures or one that pelicun has no
        name for, if the period is missing, or the file cannot be written.
    """
    import pandas as pd

    declared = intensities()
    states = max((len(limits) for limits in curves.values()), default=0)
    rows = {}
    for identifier, limits in curves.items():
        names = {curve.measure for curve in limits}
        if len(names) != 1 or not names <= set(declared):
            raise InputError(
                f"{path}: {identifier}: its curves must be against one measure of "
                f"{', '.join(declared)}, found {', '.join(sorted(names)) or 'none'}"
            )
        name = next(iter(names))
        of = declared[name].intensity
        assert of is not None  # by `intensities`
        demand = of.demand_type
        if of.has_period:
            if first_period_s is None:
                raise InputError(f"{path}: {identifier}: {name} needs its period, first_period_s")
            demand = f"{demand}|{first_period_s:.3g}"
        row: dict[str, Any] = {
            "Incomplete": 0,
            "Demand-Type": demand,
            "Demand-Unit": of.demand_unit,
            "Demand-Offset": 0,
            "Demand-Directional": 1,
        }
        for k in range(states):
            curve = limits[k] if k < len(limits) else None
            row[f"LS{k + 1}-Family"] = "" if curve is None else "lognormal"
            row[f"LS{k + 1}-Theta_0"] = "" if curve is None else f"{curve.theta:.6g}"
            row[f"LS{k + 1}-Theta_1"] = "" if curve is None else f"{curve.beta:.6g}"
            row[f"LS{k + 1}-DamageStateWeights"] = ""
        # pelicun splits names at the dash
        rows[csv_cell(identifier.replace("-", "."))] = row
    table = pd.DataFrame.from_dict(rows, orient="index")
    table.index.name = "ID"
    try:
        table.to_csv(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
