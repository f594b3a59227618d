"""What may be swapped: every slot of the march by a neutral name, and what may stand there.

A slot is a function, or some that belong together, that the march and the physics call by a
neutral name; what stands in its place is chosen when a kernel is bound.  `SLOTS` is the one list of
them: assembly, the key of the cache and the documentation read it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from railquake.laws import CREEP_LAWS, HINGE_LAWS, RESTITUTION_LAWS, Family
from railquake.march import contact, frames, ground, momentum, sprung, structure, track
from railquake.march.joints import joined_laws
from railquake.march.packing import reader, writer
from railquake.march.rows import UNJOINED, Joined
from railquake.physics import creep, elementary, hinge, impact
from railquake.physics.creep import CreepLaw
from railquake.physics.hinge import HingeLaw
from railquake.physics.momentum import (
    counted_moment,
    counted_place,
    moment_undeformed,
    place_undeformed,
)

__all__ = ["SLOTS", "Slot", "chosen", "joining", "solving"]

Law = Callable[..., Any]
Laws = Mapping[Law, Law]


@dataclass(frozen=True)
class Slot:
    """One choice.

    Attributes
    ----------
    name : str
    decided_by : str
        Which input, or what else.
    functions : tuple of function
        The neutral functions that are replaced.
    laws : callable
        ``name of a choice -> {neutral function: what stands in its place}``.
    names : callable
        ``() -> names that may be chosen``.
    source : callable
        ``name of a choice -> its publication``, where it has one.
    """

    name: str
    decided_by: str
    functions: tuple[Law, ...]
    laws: Callable[[str], Laws]
    names: Callable[[], tuple[str, ...]]
    source: Callable[[str], str] = lambda _: ""


def _family(
    name: str,
    decided_by: str,
    family: Family[Any],
    functions: tuple[Law, ...],
    laws: Callable[[Any], Laws],
) -> Slot:
    return Slot(
        name,
        decided_by,
        functions,
        lambda choice: laws(family[choice]),
        family.names,
        lambda choice: str(family[choice].source),
    )


def _fixed(name: str, decided_by: str, choices: Mapping[str, Laws]) -> Slot:
    functions = tuple(dict.fromkeys(slot for laws in choices.values() for slot in laws))
    return Slot(name, decided_by, functions, choices.__getitem__, lambda: tuple(choices))


def _creep(law: CreepLaw, saturation: Law, bound: Law) -> Laws:
    """A law that bounds the magnitude, or all by itself."""
    if law.bound is not None:
        return {bound: law.bound}
    assert law.saturation is not None  # a law has one of the two
    return {saturation: law.saturation}


def _hinge(law: HingeLaw) -> Laws:
    state = type(law.virgin)
    return {
        hinge.advance: law.advance,
        hinge.refresh: law.refresh,
        structure.read_hinge: reader(state),
        structure.write_hinge: writer(state),
        structure.read_hinge_parameters: reader(law.parameter_fields),
    }


_NODE: Laws = {
    structure.move_structure: structure.move_structure_with_hinge,
    track.place_track: track.place_carried_track,
    track.lead_track: track.lead_carried_track,
    ground.begin_frame: ground.begin_frame_on_ground,
}
_PRESCRIBED: Laws = {
    structure.move_structure: structure.hold_structure,
    track.place_track: track.place_prescribed_track,
    track.lead_track: track.lead_prescribed_track,
    ground.begin_frame: ground.begin_frame_on_prescribed_track,
}
_LINEAR: Laws = {
    sprung.accelerate_free: sprung.accelerate_linear,
    sprung.vehicle_energy: sprung.linear_energy,
    sprung.stage_travel: sprung.linear_travel,
    counted_place: place_undeformed,
    counted_moment: moment_undeformed,
    momentum.stiffness_of_ends: momentum.couple_of_ends,
    momentum.damping_of_ends: momentum.held_by_ends,
}
_TABLE: Laws = {
    contact.locate_cells: contact.locate_in_table,
    contact.fetch_cells: contact.fetch_polynomials,
    contact.patch: contact.patch_by_table,
}
_GRID: Laws = {
    contact.locate_cells: contact.no_cells,
    contact.fetch_cells: contact.no_polynomials,
    contact.patch: contact.patch_by_grid,
}
_WRITTEN_OUT: Laws = {
    elementary.exponential: elementary.exponential_polynomial,
    elementary.power: elementary.power_polynomial,
}
_ABREAST: Laws = {
    frames.look_again: frames.look_again_abreast,
    contact.flange_near: contact.any_flange_near,
    contact.press_patch: contact.evaluated_patch,
    contact.press_flange: contact.bearing_flanges,
    **_WRITTEN_OUT,
}
_ALONE: Laws = {
    frames.look_again: frames.nothing_again,
    contact.flange_near: contact.every_flange_near,
    contact.press_patch: contact.closed_patch,
    contact.press_flange: contact.every_flange,
    **_WRITTEN_OUT,
}

SLOTS: tuple[Slot, ...] = (
    _family(
        "creep law",
        "`wheelrail.creep_law`",
        CREEP_LAWS,
        (creep.saturation, creep.bound_on_tread),
        lambda law: _creep(law, creep.saturation, creep.bound_on_tread),
    ),
    _family(
        "flange creep law",
        "`wheelrail.flange_creep_law`",
        CREEP_LAWS,
        (creep.flange_saturation, creep.bound_on_flange),
        lambda law: _creep(law, creep.flange_saturation, creep.bound_on_flange),
    ),
    _family(
        "restitution law",
        "`wheelrail.restitution_law`",
        RESTITUTION_LAWS,
        (impact.hysteresis,),
        lambda law: {impact.hysteresis: law.hysteresis},
    ),
    _family(
        "hinge law",
        "`support.hinge`",
        HINGE_LAWS,
        (
            hinge.advance,
            hinge.refresh,
            structure.read_hinge,
            structure.write_hinge,
            structure.read_hinge_parameters,
        ),
        _hinge,
    ),
    _fixed("structure", "`support.kind`", {"node": _NODE, "prescribed": _PRESCRIBED}),
    # of a car with finite rotations each has its own: `joining`
    _fixed(
        "kinematics", "`vehicle.kinematics`", {"linear": _LINEAR, "finite": joined_laws(UNJOINED)}
    ),
    _fixed("contact method", "`solver.contact`", {"table": _TABLE, "grid": _GRID}),
    _fixed(
        "engine",
        "whether a run is by itself, many are abreast, or each is a thread on a GPU",
        {
            "alone": _ALONE,
            "abreast": _ABREAST,
            "device": {
                **_ABREAST,
                contact.press_patch: contact.closed_patch,
                contact.press_flange: contact.every_flange,
            },
        },
    ),
)


def chosen(choices: Mapping[str, str]) -> dict[Law, Law]:
    """What stands in the slots.

    Parameters
    ----------
    choices : mapping of str to str
        Name of the choice by name of the slot; a slot left out stays empty.

    Returns
    -------
    dict
        For `compiler.bind`.
    """
    return {slot: law for each in _laws_of(choices) for slot, law in each.items()}


def _laws_of(choices: Mapping[str, str]) -> Iterator[Laws]:
    known = {slot.name: slot for slot in SLOTS}
    for name, choice in choices.items():
        yield known[name].laws(choice)


def joining(joined: Joined) -> dict[Law, Law]:
    """What stands in the slots of the vehicle for a car with these joints, if it has any."""
    return dict(joined_laws(joined)) if joined.elements else {}


def solving(hinge_law: str, linearised: bool, abreast: bool) -> dict[Law, Law]:
    """How the hinge's equation is solved.

    Parameters
    ----------
    hinge_law : str
    linearised : bool
        By one consistently linearised solve a step (``solver.hinge_solve``).
    abreast : bool
        With what the law puts in the place of its functions where many run abreast.
    """
    law = HINGE_LAWS[hinge_law]
    laws: dict[Law, Law] = dict(law.abreast) if abreast else {}
    if linearised and law.linearised is not None:
        laws[hinge.advance] = law.linearised
    return laws
