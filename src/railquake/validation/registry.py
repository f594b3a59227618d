"""The comparisons, in the order in which they are run and shown."""

from __future__ import annotations

from importlib import import_module
from typing import cast

from railquake.validation.comparison import Comparison

__all__ = ["COMPARISONS", "load"]

# Modules of this package; the command line's names have hyphens for the underscores.
COMPARISONS: tuple[str, ...] = (
    # the parts against published numbers and other programs
    "vehicle_modes",
    "hinge_steps",
    "pier_steps",
    "pier_elastic",
    "pier_hinge",
    "pier_pinched",
    "contact_approach",
    "contact_place",
    "contact_lobes",
    "contact_rolled",
    "normal_law",
    "kalker_coefficients",
    "creep_laws",
    "creep_with_spin",
    # classical cases with closed forms
    "classical_free_vibration",
    "classical_resonance",
    "classical_overturning",
    "classical_sliding",
    "classical_flange",
    "classical_steady_force",
    "classical_bouncing",
    # the hinge of the case study against a fibre section
    "column_fit",
)


def load(name: str) -> Comparison:
    """The module of a comparison; hyphens in the name stand for underscores."""
    return cast(Comparison, import_module(f"railquake.validation.{name.replace('-', '_')}"))
