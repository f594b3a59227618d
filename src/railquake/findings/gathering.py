"""From a study's table to the evidence."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from railquake.findings.claims import every_claim
from railquake.findings.comparison import compare_models
from railquake.findings.correlation import correlate
from railquake.findings.evidence import Evidence, Outcomes
from railquake.findings.lateral import force_ratio, level_off
from railquake.findings.models import COUPLED, DECOUPLED, ELASTIC, MODELS, NONLINEAR
from railquake.findings.resampling import REPLICATES, finished
from railquake.measures import paired

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["gather"]

PAIRS = ((NONLINEAR, ELASTIC), *((DECOUPLED[name], name) for name in COUPLED))


def gather(
    table: pd.DataFrame, friction: Any = None, *, replicates: int = REPLICATES, seed: int = 0
) -> Evidence:
    """All statistics of a study.

    Parameters
    ----------
    table : DataFrame
        Rows of a study; with ``sa_t1_m_s2`` if that is to be compared.
    friction : float or array_like, optional
        mu of wheel on rail, of all runs or of each; by default the rows' own.
    replicates, seed : int
        Of the bootstrap.

    Returns
    -------
    Evidence
        Empty where the study has no axis ``model``.
    """
    if "model" not in table:
        return Evidence()
    options: dict[str, Any] = {"replicates": replicates, "seed": seed}
    present = [name for name in MODELS if (table["model"] == name).any()]
    ratio = force_ratio(table, friction)
    correlations, within, levels, outcomes = {}, {}, {}, {}
    for name in present:
        chosen = (table["model"] == name).to_numpy()
        rows = table[chosen]
        outcomes[name] = _outcomes(rows)
        correlations[name] = correlate(rows, **options)
        if "level" in rows and rows["level"].nunique() > 1:
            within[name] = correlate(rows, within="level", **options)
        levels[name] = level_off(rows, ratio[chosen], replicates=replicates // 2, seed=seed)
    comparisons = {key: compare_models(table, *key, **options) for key in _compared()}
    return Evidence(correlations, within, comparisons, levels, outcomes)


def _compared() -> dict[tuple[str, str, str], None]:
    """Quantity, model and reference of every comparison, each once.

    What is compared in every study, and what a claim needs beyond.
    """
    always = [(quantity, *pair) for pair in PAIRS for quantity in paired()]
    return dict.fromkeys([*always, *(key for claim in every_claim() for key in claim.needs)])


def _outcomes(rows: pd.DataFrame) -> Outcomes:
    done = finished(rows)
    modes: dict[str, int] = {}
    for mode in done["derailment_mode"].dropna():
        kind = str(mode).removesuffix(" left").removesuffix(" right")
        modes[kind] = modes.get(kind, 0) + 1
    onset = done["status"].isin(("onset", "derailed")) | done["onset_first_s"].notna()
    return Outcomes(
        len(done),
        int(done["flange_contact_first_s"].notna().sum()),
        int((done["off_rail_time_s"] > 0.0).sum()),
        int(onset.sum()),
        int((done["status"] == "derailed").sum()),
        modes,
    )
