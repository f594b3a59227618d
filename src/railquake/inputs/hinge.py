"""The hinge at the column's base: a degrading, pinched Bouc-Wen law.

Pellicciari, M. et al. (2020), A degrading Bouc-Wen model for the hysteresis of reinforced concrete
structural elements, Structure and Infrastructure Engineering 16(7).
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from railquake.inputs.model import InputModel, inconsistent
from railquake.inputs.units import (
    NonNegativeNumber,
    Number,
    PositiveAngle,
    PositiveMass,
    PositiveMoment,
    PositiveNumber,
    PositiveRotationalStiffness,
    PositiveSpecificEnergy,
)
from railquake.laws import HINGE_LAWS

TABLES: dict[str, type[InputModel]] = {}
"""Models of tables ``[support.NAME]`` that hinge laws of this package have, by the law's name."""


def table_of(law: str) -> str:
    """Name of the table with a hinge law's own parameters: ``my_law`` for ``my-law``."""
    return law.replace("-", "_")


def model_of(law: str) -> type[InputModel] | None:
    """Model of the table with a hinge law's own parameters.

    Returns
    -------
    type or None
        What the law's record has as ``inputs``, or what `TABLES` has for its name.  Without one the
        law takes its values from ``[support.bouc_wen]``, as ``elastic`` does.
    """
    return getattr(HINGE_LAWS[law], "inputs", None) or TABLES.get(law)


class BoucWenHinge(InputModel):
    """Parameters of M = alpha kp x + (1 - alpha) kp z, with x the rotation of the hinge.

    The names are those of the published law, and of the case file.  ``Fy`` only normalises the
    damage index; the largest moment follows from ``k0``, ``beta0`` and ``n``.

    Raises
    ------
    InputError
        For a value outside the law's valid range.
    """

    Fy: Annotated[PositiveMoment, Field(description="Yield moment; normalises damage [N m]")]
    xu: Annotated[PositiveAngle, Field(description="Ultimate rotation; normalises damage [rad]")]
    alpha: Annotated[Number, Field(description="Post-yield stiffness over initial, 0 < alpha < 1")]
    k0: Annotated[PositiveRotationalStiffness, Field(description="Initial stiffness [N m/rad]")]
    n: Annotated[Number, Field(description="Sharpness of yielding, at least 1")]
    eta0: Annotated[Number, Field(description="Shape of unloading, from -1 to 1")] = 0.0
    beta0: Annotated[PositiveNumber, Field(description="Limit of z, through A / beta [rad^-n]")]
    rho_eps: Annotated[NonNegativeNumber, Field(description="Damage by dissipated energy")] = 0.0
    rho_x: Annotated[NonNegativeNumber, Field(description="Damage by largest rotation")] = 0.0
    phi: Annotated[NonNegativeNumber, Field(description="Slows degradation as damage grows")] = 0.0
    delta_k: Annotated[NonNegativeNumber, Field(description="Degradation of stiffness")] = 0.0
    delta_f: Annotated[NonNegativeNumber, Field(description="Degradation of strength")] = 0.0
    sigma: Annotated[PositiveAngle, Field(description="Rotation range of pinching [rad]")]
    u: Annotated[NonNegativeNumber, Field(description="Sharpness of pinching in rotation")]
    eps_p: Annotated[
        PositiveSpecificEnergy, Field(description="Energy per mass where pinching sets in [J/kg]")
    ]
    rho_p: Annotated[Number, Field(description="Loss of stiffness by pinching, 0 <= rho_p < 1")] = (
        0.0
    )
    m: Annotated[PositiveMass, Field(description="Mass by which the energy is divided [kg]")]

    @model_validator(mode="after")
    def _in_valid_range(self) -> BoucWenHinge:
        for key, valid, wanted in (
            ("alpha", 0.0 < self.alpha < 1.0, "between 0 and 1, both excluded"),
            ("n", self.n >= 1.0, "at least 1"),
            ("eta0", -1.0 <= self.eta0 <= 1.0, "from -1 to 1"),
            ("rho_p", 0.0 <= self.rho_p < 1.0, "at least 0 and below 1"),
        ):
            if not valid:
                raise inconsistent(f"must be {wanted}, found {getattr(self, key)!r}", key)
        return self
