"""A reinforced-concrete cantilever of fibres in OpenSees: the reference of `calibrate column`.

One force-based element with two-point Gauss-Radau integration over the plastic hinge at its base
(Scott and Fenves 2006), so that the response past the peak depends on a chosen plastic hinge
length and not on the mesh.  Concrete follows Mander, Priestley and Park (1988) in compression
(``Concrete04``, Popovics' curve) and bears no tension; bars follow Giuffre, Menegotto and Pinto
(``Steel02``).  Bending is in one plane, so the fibres are strips.  Plane sections remain plane;
shear, slip of the bars in the footing, buckling and fracture of bars are not in the model.

The unit is that of the arguments throughout: N, m, s.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from railquake.errors import InputError
from railquake.fem import opensees

__all__ = [
    "ConcreteLaw",
    "FibreColumn",
    "Fibres",
    "SteelLaw",
    "push_column",
    "shake_column",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

BASE, TOP, COLUMN = 1, 2, 1
TOP_HINGE = 0.02  # of the length: the integration wants a hinge at the top, too
CRUSHED = 0.02  # shortening over the length: a column that has lost its core
HALVINGS = 6  # of a step that does not converge


@dataclass(frozen=True)
class ConcreteLaw:
    """Compression curve of a concrete, all positive.

    Attributes
    ----------
    strength : float
        Pa.
    peak_strain, ultimate_strain : float
    youngs_modulus : float
        Pa.
    """

    strength: float
    peak_strain: float
    ultimate_strain: float
    youngs_modulus: float


@dataclass(frozen=True)
class SteelLaw:
    """Reinforcing bars.

    Attributes
    ----------
    yield_strength, youngs_modulus : float
        Pa.
    hardening : float
        Slope after yield over Young's modulus.
    """

    yield_strength: float
    youngs_modulus: float
    hardening: float


@dataclass(frozen=True)
class Fibres:
    """Strips of one material: places across the section, m, and areas, m2."""

    place: Array
    area: Array


@dataclass(frozen=True)
class FibreColumn:
    """The cantilever.

    Attributes
    ----------
    length, plastic_length : float
        m.
    axial_load : float
        Compression, N.
    cover, core, bars : Fibres
    unconfined, confined : ConcreteLaw
        Of cover and core.
    steel : SteelLaw
    """

    length: float
    plastic_length: float
    axial_load: float
    cover: Fibres
    core: Fibres
    bars: Fibres
    unconfined: ConcreteLaw
    confined: ConcreteLaw
    steel: SteelLaw


def push_column(
    column: FibreColumn,
    displacement: Array,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Array, Array]:
    """Move the top along a path.

    Parameters
    ----------
    column : FibreColumn
    displacement : array, shape (n,)
        Of the top, m.
    progress : callable, optional
        Called with the steps done and all steps, now and then.

    Returns
    -------
    moment, rotation : array, shape (n,)
        At the base, N m: lateral force times length; of the top, rad, of the sign of the
        displacement.

    Raises
    ------
    InputError
        Without OpenSees; if the column does not bear its axial load; or where the path leads
        beyond what the section bears.
    """
    ops = opensees()
    try:
        _build(ops, column)
        ops.timeSeries("Linear", 2)
        ops.pattern("Plain", 2, 2)
        ops.load(TOP, 1.0, 0.0, 0.0)
        moment, rotation = np.empty(len(displacement)), np.empty(len(displacement))
        for k, target in enumerate(displacement):
            found = _push(ops, float(target) - float(ops.nodeDisp(TOP, 1)))
            if not found or _shortening(ops, column) > CRUSHED:
                raise InputError(
                    f"the fibre column bears its axial load no longer at a drift of "
                    f"{target / column.length:.2%}, step {k + 1} of the protocol: the section "
                    "fails there; lower the largest drift, or the axial load"
                )
            moment[k] = float(ops.getLoadFactor(2)) * column.length
            rotation[k] = -float(ops.nodeDisp(TOP, 3))
            if progress is not None and k % 50 == 0:
                progress(k, len(displacement))
        return moment, rotation
    finally:
        ops.wipe()


def shake_column(
    column: FibreColumn,
    *,
    mass: float,
    rotational_inertia: float,
    damping: tuple[float, float],
    acceleration: Array,
    dt: float,
    step: float,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Array, Array]:
    """Move the ground under the column (Newmark's mean acceleration).

    Parameters
    ----------
    column : FibreColumn
    mass, rotational_inertia : float
        At the top, kg and kg m2.
    damping : (float, float)
        Rayleigh's a, 1/s, and b, s: C = a M + b K with the initial stiffness.
    acceleration : array
        Of the ground, m/s2, at intervals of ``dt`` (s), the first one at time 0.
    step : float
        Time step, s; not above ``dt``.
    progress : callable, optional

    Returns
    -------
    displacement, moment : array
        Of the top, relative to the ground, m, and at the base, N m, at the multiples of ``step``
        from 0; the moment has the sign of a displacement that causes it.

    Raises
    ------
    InputError
        As `push_column`.
    """
    ops = opensees()
    try:
        _build(ops, column)
        ops.mass(TOP, mass, 0.0, rotational_inertia)
        ops.rayleigh(damping[0], 0.0, damping[1], 0.0)
        ops.timeSeries("Path", 2, "-dt", dt, "-values", *acceleration.tolist())
        ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
        ops.wipeAnalysis()
        _analysis(ops, 1e-8 * column.length)
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")
        count = round((len(acceleration) - 1) * dt / step)
        displacement, moment = np.zeros(count + 1), np.zeros(count + 1)
        for k in range(1, count + 1):
            found = _retry(ops, lambda part: ops.analyze(1, part), step)
            if not found or _shortening(ops, column) > CRUSHED:
                raise InputError(
                    f"the fibre column bears its axial load no longer at {k * step:.2f} s of the "
                    f"motion, at a drift of {displacement[k - 1] / column.length:.2%}: it fails "
                    "there; take a weaker motion"
                )
            displacement[k] = float(ops.nodeDisp(TOP, 1))
            moment[k] = float(ops.eleResponse(COLUMN, "forces")[2])
            if progress is not None and k % 50 == 0:
                progress(k, count)
        return displacement, moment
    finally:
        ops.wipe()


def _build(ops: Any, column: FibreColumn) -> None:
    """The column under its axial load."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.node(BASE, 0.0, 0.0)
    ops.node(TOP, 0.0, column.length)
    ops.fix(BASE, 1, 1, 1)
    for tag, law in ((1, column.unconfined), (2, column.confined)):
        ops.uniaxialMaterial(
            "Concrete04", tag, -law.strength, -law.peak_strain, -law.ultimate_strain,
            law.youngs_modulus,
        )  # fmt: skip
    steel = column.steel
    # R0, cR1, cR2: the middle of what the manual of OpenSees recommends
    ops.uniaxialMaterial(
        "Steel02", 3, steel.yield_strength, steel.youngs_modulus, steel.hardening, 18.0, 0.925, 0.15
    )
    ops.section("Fiber", 1)
    for tag, fibres in ((1, column.cover), (2, column.core), (3, column.bars)):
        for place, area in zip(fibres.place, fibres.area, strict=True):
            ops.fiber(float(place), 0.0, float(area), tag)
    ops.geomTransf("Linear", 1)
    ops.beamIntegration("HingeRadau", 1, 1, column.plastic_length, 1, TOP_HINGE * column.length, 1)
    ops.element("forceBeamColumn", COLUMN, BASE, TOP, 1, 1, "-iter", 50, 1e-10)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(TOP, 0.0, -column.axial_load, 0.0)
    _analysis(ops, 1e-9 * column.length)
    ops.integrator("LoadControl", 0.05)
    ops.analysis("Static")
    # beyond its peak strain the concrete falls, and the bars alone would go on yielding
    if ops.analyze(20) or _shortening(ops, column) > column.confined.peak_strain:
        raise InputError(
            f"the section cannot carry its axial load of {1e-3 * column.axial_load:.4g} kN; lower "
            "the load or enlarge the section"
        )
    ops.loadConst("-time", 0.0)


def _shortening(ops: Any, column: FibreColumn) -> float:
    """Of the column's axis over its length."""
    return -float(ops.nodeDisp(TOP, 2)) / column.length


def _analysis(ops: Any, tolerance: float) -> None:
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", tolerance, 40)
    ops.algorithm("Newton")


def _push(ops: Any, distance: float) -> bool:
    def part(length: float) -> int:
        ops.integrator("DisplacementControl", TOP, 1, length)
        return int(ops.analyze(1))

    return abs(distance) < 1e-14 or _retry(ops, part, distance)


def _retry(ops: Any, advance: Callable[[float], int], whole: float) -> bool:
    """Advance by a step; where it does not converge, with another method, then in halves."""
    if advance(whole) == 0:
        return True
    ops.algorithm("KrylovNewton")
    found = advance(whole) == 0
    ops.algorithm("Newton")
    return found or _in_parts(advance, whole, HALVINGS)


def _in_parts(advance: Callable[[float], int], whole: float, halvings: int) -> bool:
    if halvings == 0:
        return False
    half = 0.5 * whole
    return all(advance(half) == 0 or _in_parts(advance, half, halvings - 1) for _ in range(2))
