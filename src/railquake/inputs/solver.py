"""How the equations are marched in time."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from railquake.errors import InputError
from railquake.inputs.model import InputModel, Integer, inconsistent
from railquake.inputs.units import (
    NonNegativeNumber,
    PositiveFrequency,
    PositiveNumber,
    PositiveTime,
    Quantity,
)


class Solver(InputModel):
    """How the equations are marched in time."""

    dt: Annotated[
        float | Literal["auto"],
        Quantity("time", "positive", word="auto"),
        Field(
            description='Time step [s], or "auto": the longest that keeps peak displacement, peak '
            "velocity and uplift within time_step_tolerance"
        ),
    ] = 1e-5
    time_step_tolerance: Annotated[
        PositiveNumber,
        Field(lt=1.0, description='Relative error that dt = "auto" may make [1]'),
    ] = 0.01
    contact: Annotated[
        Literal["table", "grid"], Field(description="How contact is found; grid is the reference")
    ] = "table"
    hinge_solve: Annotated[
        Literal["newton", "linearised"] | None,
        Field(
            description="Newton iterations, or one consistently linearised solve per step; without "
            "it newton in a run by itself and linearised where many run abreast"
        ),
    ] = None
    substeps: Annotated[
        Integer | None,
        Field(
            ge=1,
            le=1000,
            description="Time steps of the wheelset on its rails in one of structure and sprung "
            "bodies, at most; without it 1 in a run by itself and 10 where many run abreast [1]",
        ),
    ] = None
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

    def without_effect(self) -> set[str]:
        """Fields on which nothing that is computed depends."""
        return set() if self.dt == "auto" else {"time_step_tolerance"}

    @property
    def step(self) -> float:
        """The time step, s; ``dt = "auto"`` has been settled before (`run.simulate.settled`)."""
        if self.dt == "auto":
            raise InputError(
                'solver.dt: "auto" is not settled; run the scenario by simulate or simulate_many, '
                "or name a time step"
            )
        return float(self.dt)

    @model_validator(mode="after")
    def _history_is_coarser(self) -> Solver:
        if self.dt != "auto" and self.history_step < self.step * (1.0 - 1e-9):
            raise inconsistent(
                f"must be at least the time step, {self.step:g} s, found {self.history_step:g} s",
                "history_step",
            )
        return self
