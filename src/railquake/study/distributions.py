"""Distributions of inputs, and how they are sampled."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

__all__ = ["DISTRIBUTIONS", "METHODS", "Distribution", "Sampling", "unit_samples"]

METHODS = ("latin-hypercube", "sobol")


@dataclass(frozen=True)
class Sampling:
    """How distributions are sampled.

    Parameters
    ----------
    method : {"latin-hypercube", "sobol"}
        Of `scipy.stats.qmc`; both scrambled by the seed.
    count : int
        Number of samples; a power of two for sobol.
    seed : int
        The same seed gives the same samples.
    """

    method: str
    count: int
    seed: int

    def to_toml(self) -> dict[str, Any]:
        """The section as a study file has it."""
        return {"method": self.method, "count": self.count, "seed": self.seed}


@dataclass(frozen=True)
class Distribution:
    """A family of distributions.

    Attributes
    ----------
    parameters : mapping
        By name ``"value"`` for one with the input's unit, ``"number"`` for one without.
    quantile : callable
        Of probabilities and parameters.
    fault : callable
        Of parameters: what is wrong with them, or None.
    """

    parameters: Mapping[str, str]
    quantile: Callable[..., Any]
    fault: Callable[..., str | None]


def _ordered(*names: str) -> Any:
    def fault(**p: float) -> str | None:
        values = [p[name] for name in names]
        if any(a > b for a, b in pairwise(values)) or values[0] == values[-1]:
            return f"{' < '.join(names)} is needed, found {', '.join(f'{v:g}' for v in values)}"
        return None

    return fault


def _positive(*names: str) -> Any:
    def fault(**p: float) -> str | None:
        for name in names:
            if not p[name] > 0.0:
                return f"{name} must be over zero, found {p[name]:g}"
        return None

    return fault


def _both(*faults: Any) -> Any:
    return lambda **p: next((text for f in faults if (text := f(**p)) is not None), None)


def _uniform(u: Any, low: float, high: float) -> Any:
    return low + u * (high - low)


def _loguniform(u: Any, low: float, high: float) -> Any:
    return low * (high / low) ** u


def _normal(u: Any, mean: float, standard_deviation: float) -> Any:
    from scipy.special import ndtri

    return mean + standard_deviation * ndtri(u)


def _truncated_normal(
    u: Any, mean: float, standard_deviation: float, low: float, high: float
) -> Any:
    from scipy.stats import truncnorm

    a, b = (low - mean) / standard_deviation, (high - mean) / standard_deviation
    return truncnorm.ppf(u, a, b, loc=mean, scale=standard_deviation)


def _lognormal(u: Any, median: float, dispersion: float) -> Any:
    import numpy as np
    from scipy.special import ndtri

    return median * np.exp(dispersion * ndtri(u))


def _triangular(u: Any, low: float, mode: float, high: float) -> Any:
    from scipy.stats import triang

    return triang.ppf(u, (mode - low) / (high - low), loc=low, scale=high - low)


def _integers(u: Any, low: float, high: float) -> Any:
    import numpy as np

    return np.minimum(np.floor(low + u * (high - low + 1.0)), high)


DISTRIBUTIONS: Mapping[str, Distribution] = {
    "uniform": Distribution({"low": "value", "high": "value"}, _uniform, _ordered("low", "high")),
    "loguniform": Distribution(
        {"low": "value", "high": "value"},
        _loguniform,
        _both(_positive("low"), _ordered("low", "high")),
    ),
    "normal": Distribution(
        {"mean": "value", "standard_deviation": "value"},
        _normal,
        _positive("standard_deviation"),
    ),
    "truncated-normal": Distribution(
        {"mean": "value", "standard_deviation": "value", "low": "value", "high": "value"},
        _truncated_normal,
        _both(_positive("standard_deviation"), _ordered("low", "high")),
    ),
    "lognormal": Distribution(
        {"median": "value", "dispersion": "number"},
        _lognormal,
        _positive("median", "dispersion"),
    ),
    "triangular": Distribution(
        {"low": "value", "mode": "value", "high": "value"},
        _triangular,
        _ordered("low", "mode", "high"),
    ),
    "integers": Distribution({"low": "value", "high": "value"}, _integers, _ordered("low", "high")),
}
"""By name: parameters in the input's unit, but the dispersion, the standard deviation of the
logarithm."""


def unit_samples(dimensions: int, sampling: Sampling) -> Any:
    """Samples of the unit cube.

    Parameters
    ----------
    dimensions : int
        Of the cube.
    sampling : Sampling

    Returns
    -------
    (count, dimensions) array
    """
    import numpy as np
    from scipy.stats import qmc

    engine = {"latin-hypercube": qmc.LatinHypercube, "sobol": qmc.Sobol}[sampling.method]
    generator = np.random.default_rng(sampling.seed)
    try:
        sampler = engine(d=dimensions, rng=generator)
    except TypeError:  # SciPy before 1.15
        sampler = engine(d=dimensions, seed=generator)
    return sampler.random(sampling.count)
