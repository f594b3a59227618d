"""Degrading pinched Bouc-Wen hinge (Eqs. 11 and 12 of the paper).

The moment of the hinge under the rotation x (theta_1 of the pier) is ::

    M  = alpha kp x + (1 - alpha) kp z                                              (Eq. 11)
    z' = A x' - beta ( abs(x') abs(z)^(n-1) z + eta0 x' abs(z)^n )                  (Eq. 12)

with the state

========  =====================================================================================
z         hysteretic rotation, rad
eps       hysteretic energy per mass, (1/m) * integral of (1 - alpha) kp z dx, m2/s2
x_max     largest abs(x) so far, rad
d         damage index  rho_eps m eps / (Fy xu) + rho_x x_max / xu
pk        exp(-phi d)
A         exp(-delta_k d pk)
beta      beta0 A exp(n delta_f d)
kp        k0 [1 - rho_p exp(-1/2 (abs(x)/sigma)^u) (1 - exp(-1/2 (eps/eps_p)^8))]
========  =====================================================================================

In time: kp from the committed x and eps; backward Euler on z; eps and x_max at their trial values.
Eq. 12 as printed lacks a z after abs(z)^(n-1).

Source: Pellicciari, Marano, Cuoghi, Briseghella, Lavorato and Tarantino (2018, 2020), as given in
Gomez and DeJong (2023).
"""

import math
from typing import Annotated, Any, NamedTuple

from railquake.physics.elementary import exponential, power
from railquake.physics.hinge import Answer, HingeLaw, Kept

__all__ = [
    "LAW",
    "Degradation",
    "Parameters",
    "State",
    "advance",
    "advance_linearised",
    "damage_index",
    "degradation",
    "degradation_extrapolated",
    "degradation_now",
    "hysteretic_slope",
    "parameters",
    "pinched_stiffness",
    "pinched_stiffness_kept",
    "pinched_stiffness_now",
    "refresh",
]


class State(NamedTuple):
    """Of the hinge between two steps; what is known of degradation and pinching goes with it."""

    z: Annotated[float, Kept("rad", "hysteretic rotation z", "hinge_z_rad")]
    eps: Annotated[float, Kept("m2/s2", "hysteretic energy per mass", "hinge_energy_per_mass")]
    x_max: Annotated[
        float, Kept("rad", "largest hinge rotation so far", "hinge_largest_rotation_rad")
    ]
    z_step: Annotated[float, Kept("rad", "last increment of z")]
    d: Annotated[float, Kept("1", "damage for which A, beta and dlnA are known; -1: none")]
    a: Annotated[float, Kept("1", "A at that damage")]
    beta: Annotated[float, Kept("rad^-n", "beta at that damage")]
    log_a: Annotated[float, Kept("1", "d(ln A)/dd at that damage")]
    kp: Annotated[float, Kept("N m/rad", "stiffness after pinching, as last evaluated")]


class Parameters(NamedTuple):
    """What the law is given, some of it divided beforehand."""

    k0: Annotated[float, Kept("N m/rad", "initial stiffness")]
    alpha: Annotated[float, Kept("1", "post-yield stiffness over initial")]
    n: Annotated[float, Kept("1", "sharpness of yielding")]
    eta0: Annotated[float, Kept("1", "shape of unloading")]
    beta0: Annotated[float, Kept("rad^-n", "limit of z, through A/beta")]
    rho_eps_m: Annotated[float, Kept("kg/J", "rho_eps m / (Fy xu)")]
    rho_x: Annotated[float, Kept("1/rad", "rho_x / xu")]
    phi: Annotated[float, Kept("1", "slows degradation as damage grows")]
    delta_k: Annotated[float, Kept("1", "degradation of stiffness")]
    delta_f: Annotated[float, Kept("1", "degradation of strength")]
    per_sigma: Annotated[float, Kept("1/rad", "1/sigma, range of pinching in rotation")]
    u: Annotated[float, Kept("1", "sharpness of pinching in rotation")]
    per_eps_p: Annotated[float, Kept("kg/J", "1/eps_p, energy where pinching sets in")]
    rho_p: Annotated[float, Kept("1", "loss of stiffness by pinching")]
    per_mass: Annotated[float, Kept("1/kg", "1/m")]
    tolerance: Annotated[float, Kept("rad", "largest last correction of z")]
    max_iterations: Annotated[float, Kept("1", "Newton iterations at most")]


def parameters(values: Any, tolerance: float, iterations: int) -> Parameters:
    """From the hinge's input; ``tolerance`` is relative to the z of a yielded hinge."""
    # z of a fully yielded hinge, without damage
    yielded = (1.0 / (values.beta0 * (1.0 + abs(values.eta0)))) ** (1.0 / values.n)
    return Parameters(
        k0=values.k0,
        alpha=values.alpha,
        n=values.n,
        eta0=values.eta0,
        beta0=values.beta0,
        rho_eps_m=values.rho_eps * values.m / (values.Fy * values.xu),
        rho_x=values.rho_x / values.xu,
        phi=values.phi,
        delta_k=values.delta_k,
        delta_f=values.delta_f,
        per_sigma=1.0 / values.sigma,
        u=values.u,
        per_eps_p=1.0 / values.eps_p,
        rho_p=values.rho_p,
        per_mass=1.0 / values.m,
        tolerance=tolerance * yielded,
        max_iterations=float(iterations),
    )


class Degradation(NamedTuple):
    """A, beta and d(ln A)/dd at a damage d."""

    d: float
    a: float
    beta: float
    log_a: float


def pinched_stiffness(x: float, eps: float, parameters: Parameters) -> float:
    """Stiffness kp after pinching, N m/rad, at the committed rotation and energy."""
    slip = exponential(-0.5 * power(abs(x) * parameters.per_sigma, parameters.u))
    r = eps * parameters.per_eps_p
    r2 = r * r
    r4 = r2 * r2
    r8 = r4 * r4
    # beyond 80 the exponential is lost in the last digit
    onset = 1.0 - exponential(-0.5 * r8) if r8 < 80.0 else 1.0
    return parameters.k0 * (1.0 - parameters.rho_p * slip * onset)


def damage_index(eps: float, x_max: float, parameters: Parameters) -> float:
    """Damage d."""
    return parameters.rho_eps_m * eps + parameters.rho_x * x_max


def degradation(d: float, parameters: Parameters) -> Degradation:
    """A, beta and d(ln A)/dd at the damage d."""
    pk = exponential(-parameters.phi * d)
    a = exponential(-parameters.delta_k * d * pk)
    return Degradation(
        d,
        a,
        parameters.beta0 * a * exponential(parameters.n * parameters.delta_f * d),
        -parameters.delta_k * pk * (1.0 - parameters.phi * d),
    )


def degradation_now(d: float, known: Degradation, parameters: Parameters) -> Degradation:
    """`degradation` at d; what is ``known`` is kept while the damage stands still."""
    if d == known.d:
        return known
    return degradation(d, parameters)


def degradation_extrapolated(d: float, known: Degradation, parameters: Parameters) -> Degradation:
    """`degradation` at d near what is ``known``, to the first order in the difference."""
    rise = d - known.d
    return Degradation(
        d,
        known.a * (1.0 + known.log_a * rise),
        known.beta * (1.0 + (known.log_a + parameters.n * parameters.delta_f) * rise),
        known.log_a,
    )


def pinched_stiffness_now(x: float, state: State, parameters: Parameters) -> float:
    """`pinched_stiffness`, evaluated in every step."""
    return pinched_stiffness(x, state.eps, parameters)


def pinched_stiffness_kept(x: float, state: State, parameters: Parameters) -> float:
    """`pinched_stiffness` as it was last evaluated."""
    return state.kp


def hysteretic_slope(
    z: float, direction: float, known: Degradation, parameters: Parameters
) -> tuple[float, float, float]:
    """Phi = dz/dx of Eq. 12 and its derivatives by z (damage held) and by the damage d.

    ``direction`` is the sign of x' z: +1 loading, -1 unloading.
    """
    n = parameters.n
    size = abs(z)
    flow_per_z = known.beta * power(size, n - 1.0) * (parameters.eta0 + direction)
    flow = flow_per_z * size
    slope_z = -n * math.copysign(1.0, z) * flow_per_z
    # d(ln beta)/dd = d(ln A)/dd + n delta_f
    slope_d = known.a * known.log_a - flow * (known.log_a + n * parameters.delta_f)
    return known.a - flow, slope_z, slope_d


def advance(
    x: float, state: State, parameters: Parameters, free_step: float, flexibility: float
) -> Answer:
    """One step of the hinge within a structure that is linear but for it, by Newton's method.

    Since M is linear in x and z, one scalar equation for z remains,
    f(z) = z - z_n - Phi(z, dx(z)) dx(z) = 0.

    Parameters
    ----------
    x : float
        Rotation at the step's begin, rad.
    state : State
    parameters : Parameters
        ``tolerance`` bounds the last correction of z: Newton's error after it is of the order of
        its square.
    free_step : float
        Increment of rotation under no hinge moment, rad.
    flexibility : float
        Rotation per hinge moment, rad/(N m).

    Returns
    -------
    Answer
    """
    tolerance, most = parameters.tolerance, parameters.max_iterations
    return solve(x, state, parameters, free_step, flexibility, tolerance, most)


def advance_linearised(
    x: float, state: State, parameters: Parameters, free_step: float, flexibility: float
) -> Answer:
    """`advance` with a single, consistently linearised solve and no iteration."""
    once = solve(x, state, parameters, free_step, flexibility, 0.0, 1.0)
    return Answer(once.step, once.moment, once.tangent, 0.0, once.state)


def solve(
    x: float,
    state: State,
    parameters: Parameters,
    free_step: float,
    flexibility: float,
    tolerance: float,
    most: float,
) -> Answer:
    """`advance` to that tolerance of z, rad, with at most so many iterations."""
    z, eps, x_max = state.z, state.eps, state.x_max
    known = Degradation(state.d, state.a, state.beta, state.log_a)
    kp = pinched_stiffness_now(x, state, parameters)
    backbone = parameters.alpha * kp
    hysteretic = (1.0 - parameters.alpha) * kp
    energy = hysteretic * parameters.per_mass  # eps grows by this times z dx
    softening = 1.0 / (1.0 + flexibility * backbone)
    step_z = -flexibility * hysteretic * softening  # d(dx)/dz
    z_new = z + state.z_step
    correction = 2.0 * tolerance + 1.0
    iteration = 0.0
    step = 0.0
    slope = 0.0
    derivative = 1.0
    slope_x = 0.0
    while abs(correction) > tolerance and iteration < most:
        step = (free_step - flexibility * (backbone * x + hysteretic * z_new)) * softening
        direction = -1.0 if step * z_new < 0.0 else 1.0
        reach = abs(x + step)
        grows = 1.0 if reach > x_max else 0.0
        d = damage_index(eps + energy * z_new * step, max(x_max, reach), parameters)
        known = degradation_now(d, known, parameters)
        slope, slope_z, slope_d = hysteretic_slope(z_new, direction, known, parameters)
        # chain rule through eps(z, dx) and x_max(dx)
        slope_z = slope_z + slope_d * parameters.rho_eps_m * energy * step
        slope_x = slope_d * (
            parameters.rho_eps_m * energy * z_new
            + parameters.rho_x * grows * math.copysign(1.0, x + step)
        )
        derivative = 1.0 - slope_z * step - (slope + slope_x * step) * step_z
        correction = (z_new - z - slope * step) / derivative
        z_new = z_new - correction
        iteration = iteration + 1.0
    step_old = step
    step = (free_step - flexibility * (backbone * x + hysteretic * z_new)) * softening
    # the derivative by z at fixed dx is what the consistent tangent needs
    by_z = derivative + (slope + slope_x * step_old) * step_z
    z_x = (slope + slope_x * step_old) / by_z
    return Answer(
        step,
        backbone * (x + step) + hysteretic * z_new,
        backbone + hysteretic * z_x,
        # the last correction of a large z is never below its last digit
        1.0 if abs(correction) > max(tolerance, 1e-15 * abs(z_new)) else 0.0,
        State(
            z_new,
            eps + energy * z_new * step,
            max(x_max, abs(x + step)),
            z_new - z,
            known.d,
            known.a,
            known.beta,
            known.log_a,
            kp,
        ),
    )


def refresh(x: float, state: State, parameters: Parameters) -> State:
    """Degradation and pinching of the hinge as it is.

    In between they are extrapolated and kept (`degradation_extrapolated`,
    `pinched_stiffness_kept`).
    """
    now = degradation(damage_index(state.eps, state.x_max, parameters), parameters)
    return State(
        state.z,
        state.eps,
        state.x_max,
        state.z_step,
        now.d,
        now.a,
        now.beta,
        now.log_a,
        pinched_stiffness(x, state.eps, parameters),
    )


def standing(state: State) -> State:
    """The state of a hinge that stands still: Newton's method starts from where z is."""
    return state._replace(z_step=0.0)


def damage(state: State, parameters: Parameters) -> float:
    """Damage index d of a state."""
    return damage_index(state.eps, state.x_max, parameters)


LAW = HingeLaw(
    name="bouc-wen",
    source="Pellicciari et al. (2020)",
    virgin=State(0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0),
    parameter_fields=Parameters,
    parameters=parameters,
    advance=advance,
    linearised=advance_linearised,
    refresh=refresh,
    abreast={
        degradation_now: degradation_extrapolated,
        pinched_stiffness_now: pinched_stiffness_kept,
    },
    standing=standing,
    damage=damage,
)
