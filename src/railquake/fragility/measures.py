"""The measures that a fragility may be fitted against."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

__all__ = ["MEASURES", "Measure"]


@dataclass(frozen=True)
class Measure:
    """A measure that a fragility may be fitted against.

    Parameters
    ----------
    column : str
        Of the table of runs.
    unit : str
    demand_type, demand_unit : str
        pelicun's names; see `write_csv`.
    """

    column: str
    unit: str
    demand_type: str
    demand_unit: str


MEASURES: Mapping[str, Measure] = {
    "pbv": Measure("pbv_m_s", "m/s", "Peak Floor Velocity", "mps"),
    "pba": Measure("pba_m_s2", "m/s2", "Peak Floor Acceleration", "mps2"),
    "pbd": Measure("pbd_m", "m", "Peak Floor Displacement", "m"),
    "pga": Measure("pga_m_s2", "m/s2", "Peak Ground Acceleration", "mps2"),
    "pgv": Measure("pgv_m_s", "m/s", "Peak Ground Velocity", "mps"),
    "sa_t1": Measure("sa_t1_m_s2", "m/s2", "Peak Spectral Acceleration", "mps2"),
}
"""Measures by their short names."""
