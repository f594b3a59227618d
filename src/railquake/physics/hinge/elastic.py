"""The elastic hinge: M = k0 x."""

from typing import Annotated, Any, NamedTuple

from railquake.physics.hinge import Answer, HingeLaw, Kept

__all__ = ["LAW", "Parameters", "State"]


class State(NamedTuple):
    """The names of the Bouc-Wen hinge, so that both have the same histories; z and eps stay 0."""

    z: Annotated[float, Kept("rad", "hysteretic rotation z", "hinge_z_rad")]
    eps: Annotated[float, Kept("m2/s2", "hysteretic energy per mass", "hinge_energy_per_mass")]
    x_max: Annotated[
        float, Kept("rad", "largest hinge rotation so far", "hinge_largest_rotation_rad")
    ]


class Parameters(NamedTuple):
    """What the law is given."""

    k0: Annotated[float, Kept("N m/rad", "stiffness")]


def parameters(values: Any, tolerance: float, iterations: int) -> Parameters:
    """From the hinge's input, of which it takes ``k0`` alone."""
    return Parameters(values.k0)


def advance(
    x: float, state: State, parameters: Parameters, free_step: float, flexibility: float
) -> Answer:
    """One step, see `HingeLaw`."""
    k0 = parameters.k0
    step = (free_step - flexibility * k0 * x) / (1.0 + flexibility * k0)
    reach = max(state.x_max, abs(x + step))
    return Answer(step, k0 * (x + step), k0, 0.0, State(state.z, state.eps, reach))


LAW = HingeLaw(
    name="elastic",
    source="M = k0 x",
    virgin=State(0.0, 0.0, 0.0),
    parameter_fields=Parameters,
    parameters=parameters,
    advance=advance,
)
