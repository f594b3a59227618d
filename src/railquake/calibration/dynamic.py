"""The fitted hinge under ground motions that the fit has not seen, beside the fibre column.

Both stand for the same pier: the same mass and rotational inertia at the top, the same Rayleigh
coefficients a and b, set on the first two modes of the pier with the fitted hinge; b multiplies
each model's own initial stiffness.  No train's forces act, and gravity not on the displaced top.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.fem.column import FibreColumn, shake_column
from railquake.inputs.scenario import scenario
from railquake.inputs.support import Pier
from railquake.physics import pier as pier_model
from railquake.run.simulate import simulate

if TYPE_CHECKING:
    from railquake.inputs.motion import Motion

__all__ = ["Check", "check_motion", "rayleigh_coefficients"]

Array = np.ndarray[Any, np.dtype[np.float64]]

STEP = 0.005  # s, of the fibre column, at most; a whole part of the record's own
TIME_STEP = 5e-5  # s, of the pier
TRAIN = "bart"  # stands on the pier without acting on it


@dataclass(frozen=True)
class Check:
    """Two histories of the top's displacement.

    Attributes
    ----------
    name : str
        Of the motion.
    pga : float
        m/s2.
    time, reference, ours : array, shape (n,)
        s, and m of the fibre column and of the pier with the fitted hinge.
    reference_moment, moment : array, shape (n,)
        At the base, N m.
    length : float
        m.
    """

    name: str
    pga: float
    time: Array
    reference: Array
    ours: Array
    reference_moment: Array
    moment: Array
    length: float

    @property
    def peak_reference(self) -> float:
        """Largest displacement of the fibre column, m."""
        return float(np.abs(self.reference).max())

    @property
    def peak_ours(self) -> float:
        """Largest displacement of the pier, m."""
        return float(np.abs(self.ours).max())

    @property
    def peak_error(self) -> float:
        """Difference of the peaks over the fibre column's."""
        return self.peak_ours / self.peak_reference - 1.0

    @property
    def residual_error(self) -> float:
        """Difference of the displacements left at the end, over the fibre column's peak."""
        return float(self.ours[-1] - self.reference[-1]) / self.peak_reference

    @property
    def history_error(self) -> float:
        """Root of the mean square difference over the fibre column's peak."""
        return float(np.sqrt(np.mean((self.ours - self.reference) ** 2))) / self.peak_reference


def rayleigh_coefficients(pier: Pier) -> tuple[float, float]:
    """A (1/s) and b (s) of the pier's damping, C = a M + b K."""
    mass = np.array([pier.mass, pier.base_rotational_inertia, pier.rotational_inertia])
    stiffness = pier_model.stiffness_matrix(
        pier.youngs_modulus, pier.second_moment_of_area, pier.length, pier.bouc_wen.k0
    )
    return pier_model.rayleigh_coefficients(mass, stiffness, pier.damping_ratio)


def check_motion(
    fibre: FibreColumn,
    pier: Pier,
    motion: Motion,
    *,
    progress: Callable[[int, int], None] | None = None,
) -> Check:
    """Shake both models by a motion.

    Parameters
    ----------
    fibre : FibreColumn
    pier : Pier
        With the fitted hinge.
    motion : Motion
    progress : callable, optional
        Of the fibre column.

    Returns
    -------
    Check

    Raises
    ------
    InputError
        If the motion cannot be read, or the fibre column fails under it.
    """
    ground = motion.lateral_motion()
    step = ground.dt / math.ceil(ground.dt / STEP - 1e-9)
    reference, reference_moment = shake_column(
        fibre,
        mass=pier.mass,
        rotational_inertia=pier.rotational_inertia,
        damping=rayleigh_coefficients(pier),
        acceleration=ground.acceleration,
        dt=ground.dt,
        step=step,
        progress=progress,
    )
    time: Array = step * np.arange(len(reference), dtype=np.float64)
    response = simulate(
        scenario(
            vehicle=TRAIN,
            support=pier.model_copy(
                update={"hinge": "bouc-wen", "coupled": False, "p_delta": False}
            ),
            motion=ground,
            dt=TIME_STEP,
        )
    )
    return Check(
        name=ground.name,
        pga=ground.pga,
        time=time,
        reference=reference,
        ours=np.interp(time, response.times, response.channel("bridge_displacement_m")),
        reference_moment=reference_moment,
        moment=-np.interp(time, response.times, response.channel("base_moment_n_m")),
        length=pier.length,
    )
