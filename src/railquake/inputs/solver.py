"""How the equations are marched in time."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from railquake.inputs._model import InputModel, Integer, inconsistent
from railquake.inputs.units import (
    NonNegativeNumber,
    PositiveFrequency,
    PositiveNumber,
    PositiveTime,
)


class Solver(InputModel):
    """How the equations are marched in time."""

    dt: Annotated[PositiveTime, Field(description="Time step [s]")] = 1e-5
    contact: Annotated[
        Literal["table", "grid"], Field(description="How contact is found; grid is the reference")
    ] = "table"
    hinge_solve: Annotated[
        Literal["newton", "linearised"],
        Field(description="Newton iterations, or one consistently linearised solve per step"),
    ] = "newton"
    phi: Annotated[
        NonNegativeNumber, Field(le=1.0, description="Zhai's parameter of velocity [1]")
    ] = 0.5
    psi: Annotated[
        NonNegativeNumber, Field(le=1.0, description="Zhai's parameter of displacement [1]")
    ] = 0.5
    history_step: Annotated[PositiveTime, Field(description="Step of the stored history [s]")] = (
        1e-3
    )
    newton_tolerance: Annotated[
        PositiveNumber,
        Field(
            lt=1.0,
            description="Newton stops once its last correction of the hinge's z, relative to a "
            "yielded hinge, is below this; the error left is of the order of its square [1]",
        ),
    ] = 1e-4
    newton_max_iterations: Annotated[
        Integer, Field(ge=1, le=1000, description="Newton iterations before a step fails")
    ] = 20
    lateral_force_filter: Annotated[
        PositiveFrequency, Field(description="Low-pass corner of the filtered lateral force [Hz]")
    ] = 20.0

    @model_validator(mode="after")
    def _history_is_coarser(self) -> Solver:
        if self.history_step < self.dt * (1.0 - 1e-9):
            raise inconsistent(
                f"must be at least the time step, {self.dt:g} s, found {self.history_step:g} s",
                "history_step",
            )
        return self
