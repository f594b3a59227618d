"""Longitudinal slip and the axle's rate of turning.

A flange bears on a larger radius than a tread, and both turn with one axle, of rate w ::

    J_y w' = -sum r F_x      r = arm_z cos(psi) - arm_y sin(psi)      xi_x = (V - w r)/V

r is the contact point's distance from the axle, (arm_y, arm_z) its place from the wheelset's centre
in track axes and psi the relative roll; in xi_x the V that divides has a lower bound, and where the
train stands w is zero.  F_x is the force on the wheel, forwards, from `creep`.
"""

__all__ = ["axle_step", "distance_from_axle"]


def distance_from_axle(arm_y: float, arm_z: float, roll_sin: float, roll_cos: float) -> float:
    """Rolling radius of a contact point, m."""
    return arm_z * roll_cos - arm_y * roll_sin


def axle_step(moment: float, damping: float, inertia: float, dt: float) -> float:
    """Change of the axle's rate in a time step, by the linearised implicit Euler method, rad/s.

    Parameters
    ----------
    moment : float
        -sum r F_x at the step's begin, N m.
    damping : float
        How much it falls per rate, N m s; it is stiff where the train is slow.
    inertia : float
        J_y, kg m2; without any, the step is Newton's to the rate at which the moments balance.
    dt : float
        s.
    """
    return dt * moment / max(inertia + dt * damping, 1e-30)
