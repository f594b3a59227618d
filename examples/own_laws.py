"""Laws of your own, from outside the package: a creep law, and a hinge law with its own state.

    python examples/own_laws.py

runs a case with both by itself and many abreast, uncompiled, compiled and vectorised from the very
same lines below.  See "Where does this go?" in CONTRIBUTING.md for laws within the package.
"""

import math
from typing import Annotated, NamedTuple

from pydantic import Field

import railquake as rq
from railquake.inputs.model import InputModel
from railquake.inputs.units import PositiveMoment, PositiveNumber, PositiveRotationalStiffness
from railquake.laws import CREEP_LAWS, HINGE_LAWS
from railquake.physics.creep import CreepLaw
from railquake.physics.elementary import exponential
from railquake.physics.hinge import Answer, HingeLaw, Kept

# --- a creep law: how friction bounds Kalker's linear force -----------------------------------


def smooth(linear: float, limit: float) -> float:
    """F = mu N tanh(tau): the factor by which the linear force is reduced."""
    tau = abs(linear) / max(limit, 1e-30)
    decay = exponential(-2.0 * tau)  # the package's own, which many abreast can do
    return (1.0 - decay) / (1.0 + decay) / tau if tau > 1e-6 else 1.0


CREEP_LAWS.add(CreepLaw("tanh", smooth, "a textbook's regularised Coulomb law"))

# --- a hinge law: elastic and perfectly plastic, with kinematic hardening ----------------------


class Bilinear(InputModel):
    """The table [support.bilinear] of a case."""

    k0: Annotated[PositiveRotationalStiffness, Field(description="Initial stiffness [N m/rad]")]
    yield_moment: Annotated[PositiveMoment, Field(description="Where yielding begins [N m]")]
    hardening: Annotated[PositiveNumber, Field(description="Stiffness after yielding over k0 [1]")]


class State(NamedTuple):
    """What the hinge remembers between two steps."""

    plastic: Annotated[float, Kept("rad", "plastic rotation", "hinge_plastic_rotation_rad")]
    travel: Annotated[float, Kept("rad", "plastic rotation there and back, added up")]


class Parameters(NamedTuple):
    """What its equations need; k0 is the initial stiffness of every hinge law."""

    k0: Annotated[float, Kept("N m/rad", "initial stiffness")]
    yield_moment: Annotated[float, Kept("N m", "where yielding begins")]
    backbone: Annotated[float, Kept("N m/rad", "stiffness of the plastic rotation")]


def parameters(values: Bilinear, tolerance: float, iterations: int) -> Parameters:
    """From the table of the case; nothing is iterated here."""
    backbone = values.k0 * values.hardening / (1.0 - values.hardening)
    return Parameters(values.k0, values.yield_moment, backbone)


def advance(
    x: float, state: State, parameters: Parameters, free_step: float, flexibility: float
) -> Answer:
    """One step: dx = free_step - flexibility M, with M = k0 (x - plastic), bounded by yielding."""
    k0, backbone = parameters.k0, parameters.backbone
    # as if it stayed elastic
    step = (free_step - flexibility * k0 * (x - state.plastic)) / (1.0 + flexibility * k0)
    trial = k0 * (x + step - state.plastic)
    over = max(abs(trial - backbone * state.plastic) - parameters.yield_moment, 0.0)
    # the plastic rotation that takes it back to yielding; the structure gives way meanwhile
    softened = k0 / (1.0 + flexibility * k0)
    flow = math.copysign(over, trial - backbone * state.plastic) / (softened + backbone)
    step = step + flexibility * softened * flow
    plastic = state.plastic + flow
    tangent = k0 * backbone / (k0 + backbone) if over > 0.0 else k0
    return Answer(
        step, k0 * (x + step - plastic), tangent, 0.0, State(plastic, state.travel + abs(flow))
    )


HINGE_LAWS.add(
    HingeLaw(
        name="bilinear",
        source="a textbook's bilinear law",
        virgin=State(0.0, 0.0),
        parameter_fields=Parameters,
        parameters=parameters,
        advance=advance,
        inputs=Bilinear,
    )
)


def case(seed: int = 1) -> "rq.Scenario":
    """The built-in case with both laws."""
    return rq.scenario(
        synthetic={"seed": seed, "duration": "6 s", "pga": "1.2 g"},
        support={
            "preset": "bart-berkeley",
            "hinge": "bilinear",
            "bilinear": {"k0": "38432 MN m/rad", "yield_moment": "5 MN m", "hardening": 0.05},
        },
        wheelrail={"preset": "bart", "creep_law": "tanh"},
    )


def main() -> None:
    """Run it by itself and many abreast."""
    response = rq.simulate(case())
    plastic = response.channel("hinge_plastic_rotation_rad")
    row = rq.assess(response)
    print(f"by itself: {row['status']}, {1e3 * row['pbd_m']:.3f} mm, "
          f"plastic rotation at the end {1e3 * plastic[-1]:.4f} mrad")  # fmt: skip
    for index, row in rq.simulate_many(case(seed) for seed in range(1, 5)):
        print(f"abreast {index}: {row['status']}, {1e3 * row['pbd_m']:.3f} mm")


if __name__ == "__main__":
    main()
