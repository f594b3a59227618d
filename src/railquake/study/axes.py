"""Axes of a study: lists, named variants and distributions."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from railquake.study.distributions import DISTRIBUTIONS, Sampling, unit_samples

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Axis", "DistributionAxis", "ListAxis", "Variant", "VariantAxis", "sampled"]


@dataclass(frozen=True)
class ListAxis:
    """An input that takes each of some values.

    Parameters
    ----------
    path : str
        The input, ``"vehicle.speed"``.
    values : tuple
        In SI units.
    kind : str
        See `inputs.paths.Input`.
    """

    path: str
    values: tuple[Any, ...]
    kind: str = "any"

    @property
    def column(self) -> str:
        """Name of its column in the table."""
        return self.path

    @property
    def size(self) -> int:
        """Number of its values."""
        return len(self.values)

    def changes(self, index: int) -> dict[str, Any]:
        """What it sets."""
        return {self.path: self.values[index]}

    def label(self, index: int) -> Any:
        """What stands in its column."""
        value = self.values[index]
        return value if isinstance(value, bool | int | float | str) else json.dumps(value)

    def to_toml(self) -> Any:
        """The axis as a study file has it."""
        return list(self.values)


@dataclass(frozen=True)
class Variant:
    """One of several named cases; it sets several inputs at once."""

    name: str
    changes: Mapping[str, Any]


@dataclass(frozen=True)
class VariantAxis:
    """Named variants, each of which sets several inputs.

    Parameters
    ----------
    column : str
        Name of the axis.
    variants : tuple of Variant
        At least one.
    """

    column: str
    variants: tuple[Variant, ...]
    kind: str = field(default="text", init=False)

    @property
    def size(self) -> int:
        """Number of variants."""
        return len(self.variants)

    @property
    def paths(self) -> set[str]:
        """All inputs that some variant sets."""
        return {path for variant in self.variants for path in variant.changes}

    def changes(self, index: int) -> dict[str, Any]:
        """What a variant sets."""
        return dict(self.variants[index].changes)

    def label(self, index: int) -> str:
        """A variant's name."""
        return self.variants[index].name

    def to_toml(self) -> Any:
        """The axis as a study file has it."""
        return [{"name": v.name, "set": dict(v.changes)} for v in self.variants]


@dataclass(frozen=True)
class DistributionAxis:
    """An input that is sampled from a distribution.

    Parameters
    ----------
    path : str
        The input.
    distribution : str
        One of `DISTRIBUTIONS`.
    parameters : mapping
        In SI units.
    kind : str
        ``"number"`` or ``"integer"``.
    """

    path: str
    distribution: str
    parameters: Mapping[str, float]
    kind: str = "number"

    @property
    def column(self) -> str:
        """Name of its column in the table."""
        return self.path

    def quantile(self, probability: NDArray[np.float64]) -> list[Any]:
        """Values that the input is below with the given probabilities.

        Parameters
        ----------
        probability : (n,) array
            Between 0 and 1.

        Returns
        -------
        list of float or int
            In SI units.
        """
        import numpy as np

        # a sequence may touch 0, where a normal distribution has no value
        inside = np.clip(probability, 1e-12, 1.0 - 1e-12)
        values = DISTRIBUTIONS[self.distribution].quantile(inside, **self.parameters)
        return [int(v) for v in values] if self.kind == "integer" else [float(v) for v in values]

    def to_toml(self) -> Any:
        """The axis as a study file has it."""
        return {"distribution": self.distribution, **self.parameters}


Axis = ListAxis | VariantAxis | DistributionAxis


def sampled(axes: Sequence[DistributionAxis], sampling: Sampling) -> dict[str, list[Any]]:
    """Samples of the distributions.

    Parameters
    ----------
    axes : sequence of DistributionAxis
        One dimension each, in this order.
    sampling : Sampling

    Returns
    -------
    dict
        For each path a list of `sampling.count` values in SI units.
    """
    unit = unit_samples(len(axes), sampling)
    return {axis.path: axis.quantile(unit[:, k]) for k, axis in enumerate(axes)}
