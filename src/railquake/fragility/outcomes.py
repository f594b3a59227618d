"""Which runs reached an outcome."""

from __future__ import annotations

from typing import TYPE_CHECKING

from railquake.errors import InputError
from railquake.fragility.probit import Flags

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["FINISHED", "OUTCOMES", "outcome"]

OUTCOMES = ("onset", "derailed")
FINISHED = ("safe", "onset", "derailed")


def outcome(table: pd.DataFrame, event: str) -> Flags:
    """Whether each run reached the outcome.

    Parameters
    ----------
    table : DataFrame
        Rows of a study.
    event : {"onset", "derailed"}
        The onset of slide-off was reached (then or before a derailment), or the train left the
        track.

    Returns
    -------
    array of bool, shape (runs,)

    Raises
    ------
    InputError
        If the outcome is not known.
    """
    if event not in OUTCOMES:
        raise InputError(f'outcome "{event}": is not known; write {" or ".join(OUTCOMES)}')
    reached = (table["status"] == "derailed").to_numpy(dtype=bool)
    if event == "onset":
        reached = reached | (table["status"] == "onset").to_numpy(dtype=bool)
        if "onset_first_s" in table:
            reached = reached | table["onset_first_s"].notna().to_numpy(dtype=bool)
    return reached
