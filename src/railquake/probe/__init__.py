"""One component by itself: a hinge, a standing wheelset, a creep force, a vehicle's modes."""

from railquake.probe.car import Lean, Shaken, lean, shake_held
from railquake.probe.contact import Patch, StandingWheelset, standing_contact, standing_wheelset
from railquake.probe.creep import CreepForce, creep_force
from railquake.probe.hinge import run_hinge
from railquake.probe.modes import mode_labels

__all__ = [
    "CreepForce",
    "Lean",
    "Patch",
    "Shaken",
    "StandingWheelset",
    "creep_force",
    "lean",
    "mode_labels",
    "run_hinge",
    "shake_held",
    "standing_contact",
    "standing_wheelset",
]
