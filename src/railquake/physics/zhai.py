"""Zhai's explicit two-step integrator for the vehicle (Eqs. 2 and 3 of the paper).

The equations as printed have misplaced dots; as meant ::

    X(n+1) = X + V dt + (1/2 + psi) A dt^2 - psi A(n-1) dt^2                              (Eq. 2)
    V(n+1) = V + (1 + phi) A dt - phi A(n-1) dt                                           (Eq. 3)

then A(n+1) from the equations of motion.  On the first step A(n-1) = A(n).

Source: Zhai (1996), International Journal for Numerical Methods in Engineering 39, 4199-4214.
"""

__all__ = ["predict_displacement", "predict_velocity"]


def predict_displacement(v: float, a: float, a_before: float, dt: float, psi: float) -> float:
    """Increment X(n+1) - X(n) of Eq. 2."""
    return dt * (v + dt * ((0.5 + psi) * a - psi * a_before))


def predict_velocity(a: float, a_before: float, dt: float, phi: float) -> float:
    """Increment V(n+1) - V(n) of Eq. 3."""
    return dt * ((1.0 + phi) * a - phi * a_before)
