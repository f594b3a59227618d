"""Plastic hinge: degrading pinched Bouc-Wen model (Eqs. 11 and 12 of the paper).

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

from railquake.physics.elementary import exponential, power

__all__ = [
    "advance",
    "advance_elastic",
    "advance_linearised",
    "damage_index",
    "degradation",
    "degradation_extrapolated",
    "degradation_now",
    "hysteretic_slope",
    "pinched_stiffness",
    "pinched_stiffness_kept",
    "pinched_stiffness_now",
]


def pinched_stiffness(
    x: float, eps: float, k0: float, rho_p: float, per_sigma: float, u: float, per_eps_p: float
) -> float:
    """Stiffness kp after pinching, N m/rad, at the committed rotation and energy.

    ``per_sigma`` and ``per_eps_p`` are 1/sigma and 1/eps_p.
    """
    slip = exponential(-0.5 * power(abs(x) * per_sigma, u))
    r = eps * per_eps_p
    r2 = r * r
    r4 = r2 * r2
    r8 = r4 * r4
    # beyond 80 the exponential is lost in the last digit
    onset = 1.0 - exponential(-0.5 * r8) if r8 < 80.0 else 1.0
    return k0 * (1.0 - rho_p * slip * onset)


def damage_index(eps: float, x_max: float, rho_eps_m: float, rho_x: float) -> float:
    """Damage d, with rho_eps_m = rho_eps m / (Fy xu) and rho_x here divided by xu."""
    return rho_eps_m * eps + rho_x * x_max


def degradation(
    d: float, phi: float, delta_k: float, delta_f: float, n: float, beta0: float
) -> tuple[float, float, float]:
    """A, beta and d(ln A)/dd at the damage d."""
    pk = exponential(-phi * d)
    a = exponential(-delta_k * d * pk)
    return a, beta0 * a * exponential(n * delta_f * d), -delta_k * pk * (1.0 - phi * d)


def degradation_now(
    d: float,
    d_known: float,
    a: float,
    beta: float,
    log_a: float,
    phi: float,
    delta_k: float,
    delta_f: float,
    n: float,
    beta0: float,
) -> tuple[float, float, float]:
    """`degradation` at d; what is known for ``d_known`` is kept while the damage stands still."""
    if d == d_known:
        return a, beta, log_a
    return degradation(d, phi, delta_k, delta_f, n, beta0)


def degradation_extrapolated(
    d: float,
    d_known: float,
    a: float,
    beta: float,
    log_a: float,
    phi: float,
    delta_k: float,
    delta_f: float,
    n: float,
    beta0: float,
) -> tuple[float, float, float]:
    """`degradation` at d near ``d_known``, to the first order in the difference."""
    rise = d - d_known
    return a * (1.0 + log_a * rise), beta * (1.0 + (log_a + n * delta_f) * rise), log_a


def pinched_stiffness_now(
    kp: float,
    x: float,
    eps: float,
    k0: float,
    rho_p: float,
    per_sigma: float,
    u: float,
    per_eps_p: float,
) -> float:
    """`pinched_stiffness`, evaluated in every step."""
    return pinched_stiffness(x, eps, k0, rho_p, per_sigma, u, per_eps_p)


def pinched_stiffness_kept(
    kp: float,
    x: float,
    eps: float,
    k0: float,
    rho_p: float,
    per_sigma: float,
    u: float,
    per_eps_p: float,
) -> float:
    """`pinched_stiffness` as it was last evaluated."""
    return kp


def hysteretic_slope(
    z: float,
    direction: float,
    a: float,
    beta: float,
    log_a: float,
    n: float,
    eta0: float,
    n_delta_f: float,
) -> tuple[float, float, float]:
    """Phi = dz/dx of Eq. 12 and its derivatives by z (damage held) and by the damage d.

    ``direction`` is the sign of x' z: +1 loading, -1 unloading.
    """
    size = abs(z)
    flow_per_z = beta * power(size, n - 1.0) * (eta0 + direction)
    flow = flow_per_z * size
    slope_z = -n * math.copysign(1.0, z) * flow_per_z
    # d(ln beta)/dd = d(ln A)/dd + n delta_f
    return a - flow, slope_z, a * log_a - flow * (log_a + n_delta_f)


def advance(
    x: float,
    z: float,
    z_guess: float,
    eps: float,
    x_max: float,
    d: float,
    a: float,
    beta: float,
    log_a: float,
    kp: float,
    free_step: float,
    flexibility: float,
    k0: float,
    alpha: float,
    n: float,
    eta0: float,
    beta0: float,
    rho_eps_m: float,
    rho_x: float,
    phi: float,
    delta_k: float,
    delta_f: float,
    per_sigma: float,
    u: float,
    per_eps_p: float,
    rho_p: float,
    per_mass: float,
    tolerance: float,
    max_iterations: float,
) -> tuple[float, float, float, float, float, float, float, float, float, float, float, float]:
    """One step of the hinge within a structure that is linear but for it, by Newton's method.

    Condensed on the hinge, the structure answers ``dx = free_step - flexibility * M``; with
    ``flexibility = 0`` the increment of rotation is prescribed.  Since M is linear in x and z, one
    scalar equation for z remains, f(z) = z - z_n - Phi(z, dx(z)) dx(z) = 0.

    Parameters
    ----------
    x, z, eps, x_max : float
        Committed state.
    d, a, beta, log_a : float
        Damage for which `degradation` is known, and its results.
    kp : float
        The last `pinched_stiffness`.
    z_guess : float
        Where Newton's method starts.
    free_step : float
        Increment of rotation under no hinge moment, rad.
    flexibility : float
        Rotation per hinge moment, rad/(N m).
    k0 ... per_mass : float
        Parameters; ``rho_eps_m`` and ``rho_x`` as in `damage_index`; 1/sigma, 1/eps_p and 1/m.
    tolerance : float
        Largest last correction of z, rad: Newton's error after it is of the order of its square.
    max_iterations : float

    Returns
    -------
    dx, z, eps, x_max : float
        Increment of rotation and the new state.
    moment : float
        N m.
    tangent : float
        Consistent dM/dx, N m/rad.
    correction : float
        Last correction of z; above ``tolerance`` the iteration has not converged.
    d, a, beta, log_a, kp : float
        What is known of degradation and pinching now.
    """
    kp = pinched_stiffness_now(kp, x, eps, k0, rho_p, per_sigma, u, per_eps_p)
    backbone = alpha * kp
    hysteretic = (1.0 - alpha) * kp
    energy = hysteretic * per_mass  # eps grows by this times z dx
    softening = 1.0 / (1.0 + flexibility * backbone)
    step_z = -flexibility * hysteretic * softening  # d(dx)/dz
    z_new = z_guess
    correction = 2.0 * tolerance + 1.0
    iteration = 0.0
    step = 0.0
    slope = 0.0
    derivative = 1.0
    slope_x = 0.0
    while abs(correction) > tolerance and iteration < max_iterations:
        step = (free_step - flexibility * (backbone * x + hysteretic * z_new)) * softening
        direction = -1.0 if step * z_new < 0.0 else 1.0
        reach = abs(x + step)
        grows = 1.0 if reach > x_max else 0.0
        now = damage_index(eps + energy * z_new * step, max(x_max, reach), rho_eps_m, rho_x)
        a, beta, log_a = degradation_now(now, d, a, beta, log_a, phi, delta_k, delta_f, n, beta0)
        d = now
        slope, slope_z, slope_d = hysteretic_slope(
            z_new, direction, a, beta, log_a, n, eta0, n * delta_f
        )
        # chain rule through eps(z, dx) and x_max(dx)
        slope_z = slope_z + slope_d * rho_eps_m * energy * step
        slope_x = slope_d * (
            rho_eps_m * energy * z_new + rho_x * grows * math.copysign(1.0, x + step)
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
    return (
        step,
        z_new,
        eps + energy * z_new * step,
        max(x_max, abs(x + step)),
        backbone * (x + step) + hysteretic * z_new,
        backbone + hysteretic * z_x,
        correction,
        d,
        a,
        beta,
        log_a,
        kp,
    )


def advance_linearised(
    x: float,
    z: float,
    z_guess: float,
    eps: float,
    x_max: float,
    d: float,
    a: float,
    beta: float,
    log_a: float,
    kp: float,
    free_step: float,
    flexibility: float,
    k0: float,
    alpha: float,
    n: float,
    eta0: float,
    beta0: float,
    rho_eps_m: float,
    rho_x: float,
    phi: float,
    delta_k: float,
    delta_f: float,
    per_sigma: float,
    u: float,
    per_eps_p: float,
    rho_p: float,
    per_mass: float,
    tolerance: float,
    max_iterations: float,
) -> tuple[float, float, float, float, float, float, float, float, float, float, float, float]:
    """`advance` with a single, consistently linearised solve and no iteration."""
    step, z_new, eps_new, reach, moment, tangent, _, d, a, beta, log_a, kp = advance(
        x, z, z_guess, eps, x_max, d, a, beta, log_a, kp, free_step, flexibility,
        k0, alpha, n, eta0, beta0, rho_eps_m, rho_x, phi, delta_k, delta_f,
        per_sigma, u, per_eps_p, rho_p, per_mass, 0.0, 1.0,
    )  # fmt: skip
    return step, z_new, eps_new, reach, moment, tangent, 0.0, d, a, beta, log_a, kp


def advance_elastic(
    x: float,
    z: float,
    z_guess: float,
    eps: float,
    x_max: float,
    d: float,
    a: float,
    beta: float,
    log_a: float,
    kp: float,
    free_step: float,
    flexibility: float,
    k0: float,
    alpha: float,
    n: float,
    eta0: float,
    beta0: float,
    rho_eps_m: float,
    rho_x: float,
    phi: float,
    delta_k: float,
    delta_f: float,
    per_sigma: float,
    u: float,
    per_eps_p: float,
    rho_p: float,
    per_mass: float,
    tolerance: float,
    max_iterations: float,
) -> tuple[float, float, float, float, float, float, float, float, float, float, float, float]:
    """Elastic hinge, M = k0 x, with the arguments and results of `advance`."""
    step = (free_step - flexibility * k0 * x) / (1.0 + flexibility * k0)
    reach = max(x_max, abs(x + step))
    return step, z, eps, reach, k0 * (x + step), k0, 0.0, d, a, beta, log_a, kp
