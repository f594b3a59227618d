"""The models that the paper compares: values of a study's axis ``model``."""

from __future__ import annotations

__all__ = ["AT_GRADE", "COUPLED", "DECOUPLED", "ELASTIC", "MODELS", "NONLINEAR", "PIERS"]

ELASTIC, NONLINEAR = "coupled-elastic", "coupled-nonlinear"
COUPLED = (ELASTIC, NONLINEAR)
DECOUPLED = {ELASTIC: "decoupled-elastic", NONLINEAR: "decoupled-nonlinear"}
AT_GRADE = "at-grade"
MODELS = (*COUPLED, *DECOUPLED.values(), AT_GRADE)
PIERS = {ELASTIC: "elastic pier", NONLINEAR: "nonlinear pier"}
