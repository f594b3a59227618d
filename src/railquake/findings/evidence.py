"""What the sentences are made from: all statistics of a study, put together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from railquake.findings.comparison import PairedComparison
from railquake.findings.correlation import Correlations
from railquake.findings.lateral import LevelOff
from railquake.findings.models import COUPLED

__all__ = ["Evidence", "Outcomes"]


@dataclass(frozen=True)
class Outcomes:
    """How the runs of a model ended.

    Attributes
    ----------
    runs, flange, lifted, onset, derailed : int
        Finished runs; those in which a flange touched its rail; in which a wheel left its rail;
        that reached the onset; that left the track.
    modes : mapping of str to int
        Derailments by mode, sides together.
    """

    runs: int
    flange: int
    lifted: int
    onset: int
    derailed: int
    modes: Mapping[str, int]


@dataclass(frozen=True)
class Evidence:
    """All statistics that the sentences are made from.

    Attributes
    ----------
    correlations, within_level : mapping
        By model: uplift against the measures, over all runs and with the levels' means taken away.
    comparisons : mapping
        By quantity, model and reference.
    level_offs : mapping
        By model: lateral force against PBA.
    outcomes : mapping
        By model.
    """

    correlations: Mapping[str, Correlations] = field(default_factory=dict)
    within_level: Mapping[str, Correlations] = field(default_factory=dict)
    comparisons: Mapping[tuple[str, str, str], PairedComparison] = field(default_factory=dict)
    level_offs: Mapping[str, LevelOff] = field(default_factory=dict)
    outcomes: Mapping[str, Outcomes] = field(default_factory=dict)

    def ratio(self, quantity: str, model: str, reference: str) -> PairedComparison:
        """A comparison, or one that says why it is missing."""
        known = self.comparisons.get((quantity, model, reference))
        if known is not None:
            return known
        return PairedComparison(quantity, model, reference, missing="not compared")

    def coupled_level_offs(self) -> dict[str, LevelOff]:
        """Lateral force against PBA of the coupled models, as far as it could be fitted."""
        return {
            name: self.level_offs[name]
            for name in COUPLED
            if name in self.level_offs and self.level_offs[name].slope_beyond.known
        }
