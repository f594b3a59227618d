"""The pier alone in OpenSees, with its own DegradingPinchedBW hinge."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.fem import opensees
from railquake.physics.pier import rayleigh_coefficients, stiffness_matrix

if TYPE_CHECKING:
    from railquake.inputs.hinge import BoucWenHinge
    from railquake.inputs.support import Pier

__all__ = ["PierHistory", "hinge_material", "opensees_pier", "time_opensees_pier"]

Array = np.ndarray[Any, np.dtype[np.float64]]

HINGE, TOP = 1, 3  # tags of the hinge's element and the top's node
MATERIAL_TOLERANCE = 1e-12  # absolute, of z


@dataclass(frozen=True)
class PierHistory:
    """What the pier did, relative to the ground; arrays of one length, a value each sample.

    Attributes
    ----------
    displacement : array
        Of the top, m.
    hinge_rotation, top_rotation : array
        rad, positive against the displacement's sense: a rigid column has u = -L theta.
    base_moment : array
        Of the hinge, without its damping, N m.
    """

    displacement: Array
    hinge_rotation: Array
    top_rotation: Array
    base_moment: Array


def hinge_material(ops: Any, tag: int, hinge: BoucWenHinge, *, elastic: bool = False) -> None:
    """Define the hinge's material in the current model: M = k0 x where elastic.

    OpenSees' tolerance is absolute and of z, which is a few 1e-4 rad in a concrete hinge; the
    material's usual 1e-3 would end the iteration before it begins.
    """
    if elastic:
        ops.uniaxialMaterial("Elastic", tag, hinge.k0)
        return
    h = hinge
    ops.uniaxialMaterial(
        "DegradingPinchedBW", tag, h.m, h.Fy, h.xu, h.alpha, h.k0, h.n, h.eta0, h.beta0,
        h.rho_eps, h.rho_x, h.phi, h.delta_k, h.delta_f, h.sigma, h.u, h.eps_p, h.rho_p,
        MATERIAL_TOLERANCE, 1000,
    )  # fmt: skip


def _prepare(ops: Any, pier: Pier, acceleration: Array, dt: float, gravity: float) -> None:
    """Model, load, damping and Newmark's method, ready to be stepped."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for tag, y in ((1, 0.0), (2, 0.0), (TOP, pier.length)):
        ops.node(tag, 0.0, y)
    ops.fix(1, 1, 1, 1)
    ops.fix(2, 1, 1, 0)
    ops.fix(TOP, 0, 1, 0)
    ops.mass(2, 0.0, 0.0, pier.base_rotational_inertia)
    ops.mass(TOP, pier.mass, 0.0, pier.rotational_inertia)
    hinge_material(ops, 1, pier.bouc_wen, elastic=pier.hinge == "elastic")
    of_hinge = 0 if pier.damping_of == "column" else 1
    ops.element("zeroLength", HINGE, 1, 2, "-mat", 1, "-dir", 6, "-doRayleigh", of_hinge)
    ops.geomTransf("Linear", 1)
    # the area is no part of the model: the top is held vertically
    ops.element(
        "elasticBeamColumn", 2, 2, TOP, 1.0, pier.youngs_modulus, pier.second_moment_of_area, 1
    )
    ops.timeSeries("Path", 1, "-dt", dt, "-values", *acceleration.tolist(), "-factor", gravity)
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    mass = np.array([pier.mass, pier.base_rotational_inertia, pier.rotational_inertia])
    initial = stiffness_matrix(
        pier.youngs_modulus, pier.second_moment_of_area, pier.length, pier.bouc_wen.k0
    )
    a, b = rayleigh_coefficients(mass, initial, pier.damping_ratio)
    # of the initial stiffness, or of that at the last step's end; the column has but one
    ops.rayleigh(a, 0.0, *((0.0, b) if pier.damping_of == "tangent" else (b, 0.0)))
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("ProfileSPD")
    ops.test("NormDispIncr", 1e-12, 50)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")


def opensees_pier(
    pier: Pier,
    acceleration: Array,
    dt: float,
    step: float,
    steps: int,
    *,
    gravity: float = 1.0,
    every: int = 1,
) -> PierHistory:
    """Run the pier alone in OpenSees.

    Parameters
    ----------
    pier : Pier
        Its hinge elastic or not.
    acceleration : array
        Of the ground at intervals of ``dt`` from time zero; times ``gravity`` it is in m/s2.
    dt, step : float
        Interval of the record and time step, s.
    steps : int
    gravity : float
    every : int
        Steps from one sample of the history to the next; the last steps that make no whole sample
        are left out.

    Returns
    -------
    PierHistory
        The first sample is that after ``every`` steps.

    Raises
    ------
    InputError
        Without OpenSees.
    RuntimeError
        If OpenSees does not converge.
    """
    ops = opensees()
    _prepare(ops, pier, acceleration, dt, gravity)
    found = np.empty((steps // every, 4))
    try:
        for k in range(len(found)):
            if ops.analyze(every, step):
                raise RuntimeError(f"OpenSees did not converge before {every * (k + 1) * step:g} s")
            moment = ops.eleResponse(HINGE, "material", 1, "stress")
            rotation = ops.nodeDisp(2, 3)
            found[k] = ops.nodeDisp(TOP, 1), rotation, ops.nodeDisp(TOP, 3), moment
    finally:
        ops.wipe()
    return PierHistory(*found.T)


def time_opensees_pier(
    pier: Pier, acceleration: Array, dt: float, step: float, steps: int
) -> float:
    """Wall time of the same analysis in a single call, without histories, s.

    Raises
    ------
    InputError
        Without OpenSees.
    RuntimeError
        If OpenSees does not converge.
    """
    ops = opensees()
    _prepare(ops, pier, acceleration, dt, 1.0)
    begin = time.perf_counter()
    failed = ops.analyze(steps, step)
    spent = time.perf_counter() - begin
    ops.wipe()
    if failed:
        raise RuntimeError("OpenSees did not converge")
    return spent
