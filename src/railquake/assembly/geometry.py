"""From two profiles to the arrays and the contact table that the kernel reads."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.interpolate import PchipInterpolator

from railquake.errors import InputError
from railquake.laws import CREEP_LAWS
from railquake.march.compiler import SCALAR, bind, cache_folder, source_hash
from railquake.march.compiler.cache import keep, kept
from railquake.memory import Bounded
from railquake.physics.contact_table import FIELDS, Axis, RunningCircle, axis_nodes, fill_table
from railquake.physics.hertz import hertz_table
from railquake.physics.profiles import Geometry

if TYPE_CHECKING:
    from railquake.inputs.profile import Profile
    from railquake.inputs.wheelrail import WheelRail

__all__ = [
    "DISPLACEMENT_AXIS",
    "FLOOR",
    "ROLL_AXIS",
    "build_geometry",
    "law_table",
    "running_circle",
    "with_table",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

WHEEL_SPACING = 0.5e-3  # between wheel grid points along the arc, m
RAIL_SPACING = 0.025e-3  # between rail grid points, m
FLANGE_ANGLE = 0.2  # the flange zone begins where the wheel is steeper than this, rad
FLOOR = 0.15  # depth below the crown at which the ground beside a rail is put, m
STEEPEST = 40.0  # slope with which a rail's faces are carried on below the drawn head

# Fine where a wheel runs, coarse where it has left the rail; see the accuracy in the docs.
DISPLACEMENT_AXIS = Axis(fine=0.016, fine_step=0.1e-3, coarse_step=1.0e-3, end=0.130)
ROLL_AXIS = Axis(fine=0.030, fine_step=0.5e-3, coarse_step=5.0e-3, end=1.050)


def build_geometry(wheelrail: WheelRail) -> Geometry:
    """Sample both profiles for the grid method; the table is left empty.

    Raises
    ------
    InputError
        If the profiles fold back or never meet.
    """
    wheel = wheelrail.wheel_profile()
    rail = wheelrail.rail_profile()
    centre = wheelrail.rail_half_distance(rail)
    wheel_y, wheel_z, wheel_dy, wheel_dz, wheel_curvature = _wheel_grid(wheel)
    steep = np.abs(wheel_dz) > np.tan(FLANGE_ANGLE) * np.abs(wheel_dy)
    inner = np.flatnonzero(steep & (wheel_y < 0.0))
    if inner.size == 0:
        raise InputError(
            f"profile {wheel.name}: nowhere inside the running circle steeper than "
            f"{FLANGE_ANGLE} rad, so it has no flange; give the whole wheel"
        )
    rail_start, rail_z, rail_slope, rail_curvature = _rail_grid(rail, centre)
    hertz = hertz_table(wheelrail.youngs_modulus, wheelrail.poisson_ratio)
    lateral = wheelrail.running_circle + wheel_y
    rail_end = rail_start + RAIL_SPACING * (len(rail_z) - 1)
    if lateral[-1] < rail_start or lateral[0] > rail_end:
        raise InputError(
            f"wheel and rail never touch: the wheel spans {lateral[0]:.4f} to {lateral[-1]:.4f} m "
            f"from the track's centre, the rail {rail_start:.4f} to {rail_end:.4f} m; check "
            "wheelrail.running_circle, rail_centre and gauge"
        )
    return Geometry(
        lateral,
        wheelrail.rolling_radius + wheel_z,
        wheel_dy,
        wheel_dz,
        wheel_curvature,
        int(inner[-1]) + 1,
        rail_start,
        RAIL_SPACING,
        rail_z,
        rail_slope,
        rail_curvature,
        hertz.stiffness,
        hertz.area,
        hertz.along,
        hertz.creep,
        hertz.spin,
        np.log(hertz.a_over_b),
        np.zeros(1),
        len(axis_nodes(DISPLACEMENT_AXIS)),
        *(
            law_table(law, wheelrail.poisson_ratio)
            for law in (wheelrail.creep_law, wheelrail.flange_creep_law)
        ),
    )


def _wheel_grid(wheel: Profile) -> tuple[Array, Array, Array, Array, Array]:
    """Evenly spaced points of the wheel with tangents per point number, and curvature."""
    arc = wheel.arc_length
    count = int(np.ceil(arc[-1] / WHEEL_SPACING)) + 1
    at = np.linspace(0.0, arc[-1], count)
    step = at[1] - at[0]
    y = PchipInterpolator(arc, wheel.y)
    z = PchipInterpolator(arc, wheel.z)
    nearest = np.searchsorted(0.5 * (arc[1:] + arc[:-1]), at)
    return (
        y(at),
        z(at),
        step * y.derivative()(at),
        step * z.derivative()(at),
        wheel.curvature[nearest].copy(),
    )


def _rail_grid(rail: Profile, centre: float) -> tuple[float, Array, Array, Array]:
    """Height, slope and curvature of the rail, evenly spaced in y, its faces carried on down."""
    crown = int(np.argmin(rail.z))
    first, last = crown, crown
    # the part of the outline that is seen from above: y strictly rising
    while first > 0 and rail.y[first - 1] < rail.y[first] - 1e-12:
        first -= 1
    while last < len(rail.y) - 1 and rail.y[last + 1] > rail.y[last] + 1e-12:
        last += 1
    if last - first < 2:
        raise InputError(
            f"profile {rail.name}: folds back at its crown; y must rise from the gauge side to "
            "the field side over the rail's head"
        )
    y, z = rail.y[first : last + 1], rail.z[first : last + 1] - rail.z[crown]
    curve = PchipInterpolator(y, z)
    beside = FLOOR / STEEPEST + 2.0 * RAIL_SPACING
    low = np.floor((y[0] - beside) / RAIL_SPACING) * RAIL_SPACING
    count = int(np.ceil((y[-1] + beside - low) / RAIL_SPACING)) + 1
    at = low + RAIL_SPACING * np.arange(count)
    inside = (at >= y[0]) & (at <= y[-1])
    height = np.where(at < y[0], z[0] + STEEPEST * (y[0] - at), z[-1] + STEEPEST * (at - y[-1]))
    slope = np.where(at < y[0], -STEEPEST, STEEPEST)
    height[inside] = curve(at[inside])
    slope[inside] = curve.derivative()(at[inside])
    on_floor = height >= FLOOR
    height[on_floor] = FLOOR
    slope[on_floor] = 0.0
    nearest = first + np.searchsorted(0.5 * (y[1:] + y[:-1]), at)
    curvature = np.where(inside, rail.curvature[nearest], 0.0)
    return centre + low, height, slope, curvature


def running_circle(wheelrail: WheelRail) -> RunningCircle:
    """Where the pair's wheels roll as drawn."""
    return RunningCircle(wheelrail.running_circle, wheelrail.rolling_radius)


def with_table(geometry: Geometry, circle: RunningCircle) -> Geometry:
    """The geometry with its contact table, from the cache on disk or made now by the grid method.

    The cache's key is the content of the arrays, the table's axes and the physics' source.
    """
    digest = hashlib.sha256(source_hash().encode())
    for part in geometry:
        digest.update(np.ascontiguousarray(part).tobytes())
    digest.update(repr((DISPLACEMENT_AXIS, ROLL_AXIS, FIELDS, circle)).encode())
    key = digest.hexdigest()
    return geometry._replace(table=_TABLES.get(key, lambda: _table(key, geometry, circle)))


def law_table(name: str, poisson: float) -> Array:
    """The table of a creep law for a material; one number where the law has none.

    Its key is the law, its nodes and the physics' source.
    """
    law = CREEP_LAWS[name]
    if law.table is None:
        return np.zeros(1)
    nodes = law.table.nodes(poisson)
    digest = hashlib.sha256(f"{source_hash()} {name} {law.table.size}".encode())
    digest.update(np.ascontiguousarray(nodes).tobytes())
    key = digest.hexdigest()

    def fill(table: Array) -> None:
        bind(law.table.fill, SCALAR).call(nodes, table)

    return _TABLES.get(key, lambda: _kept(key, law.table.size, fill))


_TABLES: Bounded[str, Array] = Bounded(12)


def _table(digest: str, geometry: Geometry, circle: RunningCircle) -> Array:
    """The contact table from the cache on disk, or made now and kept there."""
    displacements, rolls = axis_nodes(DISPLACEMENT_AXIS), axis_nodes(ROLL_AXIS)

    def fill(table: Array) -> None:
        bind(fill_table, SCALAR).call(displacements, rolls, circle, geometry, table)

    return _kept(digest, len(displacements) * len(rolls) * 2 * FIELDS, fill)


def _kept(digest: str, size: int, fill: Callable[[Array], None]) -> Array:
    """A table from the cache on disk, or made now and kept there."""
    path = cache_folder() / "tables" / f"{digest[:32]}.table"
    content = kept(path)
    if content is not None and len(content) == size * np.dtype(np.float64).itemsize:
        return np.frombuffer(content).copy()  # for the compiler one that is read only is another
    table = np.empty(size)
    fill(table)
    keep(path, table.tobytes())
    return table
