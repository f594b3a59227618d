"""Fibres of an octagonal or circular section, its concretes, and what it bears under axial load.

Confinement after J. B. Mander, M. J. N. Priestley and R. Park (1988), *Theoretical stress-strain
model for confined concrete*, Journal of Structural Engineering 114(8), for circular hoops or
spirals; plastic hinge length after M. J. N. Priestley, F. Seible and G. M. Calvi (1996), *Seismic
Design and Retrofit of Bridges*.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from railquake.calibration.column import Column, Concrete, Section, Steel
from railquake.errors import InputError
from railquake.fem.column import ConcreteLaw, FibreColumn, Fibres, SteelLaw

__all__ = [
    "concrete_modulus",
    "confined_concrete",
    "fibre_column",
    "gross_area",
    "gross_second_moment",
    "squash_load",
    "unconfined_concrete",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

STRIPS = 40  # across the section; twice as many change the case study's loop by 0.1 % of its peak
LONGEST_HINGE = 0.2  # of the length; the element's integration wants less than a quarter
FINE = 50  # points to a strip's area
MPA = 1e6


def gross_area(section: Section) -> float:
    """Area of the section, m2."""
    return _area(section, section.diameter)


def gross_second_moment(section: Section) -> float:
    """Second moment of area of the concrete section about a diameter, m4."""
    if section.shape == "circular":
        return math.pi / 64.0 * section.diameter**4
    # regular octagon across flats: (1 + 2 sqrt(2)) / 12 a^4, with the side a = (sqrt(2) - 1) D
    side = (math.sqrt(2.0) - 1.0) * section.diameter
    return (11.0 + 8.0 * math.sqrt(2.0)) / 12.0 * side**4


def squash_load(section: Section, concrete: Concrete, steel: Steel) -> float:
    """Largest axial load, 0.85 f'c (Ag - As) + fy As (ACI 318), N."""
    gross = gross_area(section)
    bars = section.longitudinal_ratio * gross
    return 0.85 * concrete.strength * (gross - bars) + steel.yield_strength * bars


def unconfined_concrete(concrete: Concrete) -> ConcreteLaw:
    """Curve of the cover."""
    return ConcreteLaw(
        concrete.strength,
        concrete.peak_strain,
        concrete.spalling_strain,
        concrete_modulus(concrete),
    )


def confined_concrete(section: Section, concrete: Concrete, steel: Steel) -> ConcreteLaw:
    """Curve of the core, from the volumetric ratio of the hoops.

    Mander's equations 5 and 12 to 14, with the ultimate strain of Priestley et al. (1996),
    eps_cu = 0.004 + 1.4 rho_v fyh eps_su / f'cc.
    """
    strength = concrete.strength
    lateral = (
        0.5 * section.confinement_effectiveness * section.transverse_ratio * steel.hoop_strength
    )
    ratio = lateral / strength
    confined = strength * (-1.254 + 2.254 * math.sqrt(1.0 + 7.94 * ratio) - 2.0 * ratio)
    peak = concrete.peak_strain * (1.0 + 5.0 * (confined / strength - 1.0))
    ultimate = (
        0.004
        + 1.4
        * section.transverse_ratio
        * steel.hoop_strength
        * steel.hoop_ultimate_strain
        / confined
    )
    return ConcreteLaw(confined, peak, ultimate, concrete_modulus(concrete))


def fibre_column(column: Column, length: float, axial_load: float) -> FibreColumn:
    """The column as OpenSees gets it.

    Parameters
    ----------
    column : Column
    length : float
        m.
    axial_load : float
        N.

    Raises
    ------
    InputError
        If the section cannot carry its axial load, bars fill the core, or the column is shorter
        than five plastic hinges.
    """
    section, concrete, steel = column.section, column.concrete, column.steel
    squash = squash_load(section, concrete, steel)
    if axial_load >= squash:
        raise InputError(
            f"{column.name}: the section cannot carry its axial load of {1e-3 * axial_load:.4g} kN:"
            f" it is crushed at {1e-3 * squash:.4g} kN, 0.85 f'c (Ag - As) + fy As; lower the load "
            "or enlarge the section"
        )
    core_diameter = section.diameter - 2.0 * section.cover
    steel_area = section.longitudinal_ratio * gross_area(section)
    bar_area = steel_area / section.bars
    bar_diameter = math.sqrt(4.0 * bar_area / math.pi)
    radius = 0.5 * core_diameter - 0.5 * bar_diameter
    angles = 2.0 * math.pi * (np.arange(section.bars) + 0.5) / section.bars
    places = np.round(radius * np.sin(angles), 9)
    place, count = np.unique(places, return_counts=True)
    edges = np.linspace(-0.5 * section.diameter, 0.5 * section.diameter, STRIPS + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    whole = _strips(section, section.diameter, edges)
    core = _strips(section, core_diameter, edges)
    # bars stand in the place of concrete of the core
    share = 1.0 - steel_area / core.sum()
    if share <= 0.5:
        raise InputError(
            f"{column.name}: section.longitudinal_ratio: bars of {1e4 * steel_area:.4g} cm2 fill "
            f"half of the core of {1e4 * core.sum():.4g} cm2 or more; lower it or the cover"
        )
    hinge = plastic_length(column, length, bar_diameter)
    if hinge > LONGEST_HINGE * length:
        raise InputError(
            f"{column.name}: the plastic hinge would be {hinge:.3g} m long, more than a fifth of "
            f"the column's {length:g} m: so short a column does not fail in bending; lengthen it, "
            "or give plastic_length"
        )
    inside = core > 0.0
    outside = whole - core > 1e-9
    return FibreColumn(
        length=length,
        plastic_length=hinge,
        axial_load=axial_load,
        cover=Fibres(middle[outside], (whole - core)[outside]),
        core=Fibres(middle[inside], share * core[inside]),
        bars=Fibres(np.asarray(place, dtype=np.float64), bar_area * count.astype(np.float64)),
        unconfined=unconfined_concrete(concrete),
        confined=confined_concrete(section, concrete, steel),
        steel=SteelLaw(steel.yield_strength, steel.youngs_modulus, steel.hardening),
    )


def plastic_length(column: Column, length: float, bar_diameter: float) -> float:
    """0.08 L + 0.022 fy d_b, at least 0.044 fy d_b (fy in MPa), m, unless it is given."""
    if column.plastic_length is not None:
        return column.plastic_length
    penetration = 0.022 * column.steel.yield_strength / MPA * bar_diameter
    return max(0.08 * length + penetration, 2.0 * penetration)


def concrete_modulus(concrete: Concrete) -> float:
    """Young's modulus, Ec = 4700 sqrt(f'c) in MPa (ACI 318), unless it is given; Pa."""
    if concrete.youngs_modulus is not None:
        return concrete.youngs_modulus
    return 4700.0 * math.sqrt(concrete.strength / MPA) * MPA


def _area(section: Section, diameter: float) -> float:
    if section.shape == "circular":
        return 0.25 * math.pi * diameter**2
    return 2.0 * (math.sqrt(2.0) - 1.0) * diameter**2


def _width(section: Section, diameter: float, y: Array) -> Array:
    """Width at the distance y from the axis of bending."""
    radius = 0.5 * diameter
    inside = np.abs(y) < radius
    if section.shape == "circular":
        return np.where(inside, 2.0 * np.sqrt(np.maximum(radius**2 - y**2, 0.0)), 0.0)
    flat = radius * math.tan(math.pi / 8.0)
    return np.where(inside, np.minimum(diameter, diameter - 2.0 * (np.abs(y) - flat)), 0.0)


def _strips(section: Section, diameter: float, edges: Array) -> Array:
    """Areas of the strips of a section of that diameter, exact in their sum."""
    parts = np.linspace(0.0, 1.0, 2 * FINE + 1)[1::2]
    y = edges[:-1, None] + np.diff(edges)[:, None] * parts
    areas = _width(section, diameter, y).mean(axis=1) * np.diff(edges)
    exact: Array = areas * (_area(section, diameter) / areas.sum())
    return exact
