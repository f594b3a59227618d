"""Where each row of the state ``S[row, lane]`` and of the constants ``Q[row, lane]`` stands.

Each row, or block of rows, is declared once (`rows_state`, `rows_constant`, and the hinge's by its
law) with its unit and its meaning; where it stands follows from those before it and from the sizes
of the run.  ``state`` and ``constant`` give the numbers, ``S[state.MOMENT, lane]``, of a block the
first one, ``S[state.TRACK + k, lane]``, and of a block with named parts each part's,
``state.TRACK_PHI``.  ``size`` gives the sizes, ``range(size.DOFS)``.

In this module they are those of the usual run: a car of three bodies that is symmetric about its
middle, on a column whose hinge is the Bouc-Wen one.  A kernel is bound to the `Layout` of its run.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple, get_type_hints

from railquake.march.declaration import Part, Row
from railquake.march.rows_constant import CONSTANT_ROWS
from railquake.march.rows_state import PATCHES, STATE_ROWS
from railquake.physics.contact_table import Polynomials
from railquake.physics.hinge import HINGE_LAWS
from railquake.physics.joint import JointSpring, Sides, Tie

if TYPE_CHECKING:
    from railquake.physics.hinge import HingeLaw

__all__ = [
    "UNJOINED",
    "USUAL",
    "Joined",
    "Layout",
    "Numbers",
    "constant",
    "layout_of",
    "size",
    "state",
]


class Numbers:
    """Names of rows, or of sizes, and their numbers; ``kind`` says of what."""

    def __init__(self, kind: str, numbers: Mapping[str, Any]) -> None:
        self.kind = kind
        self.__dict__.update(numbers)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"no {self.kind} is called {name}")

    @cached_property
    def module(self) -> ModuleType:
        """The same as a module, whose members a compiler takes for constants.

        Its name holds its content: the compiler takes modules of one name for the same.
        """
        numbers = {name: value for name, value in self.__dict__.items() if name.isupper()}
        digest = hashlib.sha256(repr(sorted(numbers.items())).encode()).hexdigest()[:16]
        made = ModuleType(f"{self.kind}_{digest}".replace(" ", "_"))
        made.__dict__.update(numbers)
        return made


class Joined(NamedTuple):
    """Which joints a car with finite rotations has; what they are like stands in the constants."""

    elements: tuple[tuple[str, int, int], ...]
    """Kind ("spring", "lateral stop", "vertical knee", ...), upper and lower body; springs first,
    then stops, then dashpots with a knee."""
    ramps: int
    """Most changes of stiffness of any stop."""

    def count(self, family: str) -> int:
        """How many are a "spring", a "stop" or a "knee"."""
        return sum(kind.split()[-1] == family for kind, _, _ in self.elements)


UNJOINED = Joined((), 0)
"""The linear car, whose joints are matrices."""


@dataclass(frozen=True)
class Layout:
    """Numbers of all rows of one kind of run.

    Attributes
    ----------
    state, constant, size : Numbers
    state_blocks, constant_blocks : dict of str to slice
        All rows of each declaration, by its name.
    state_parts : tuple of (Part, int, bool)
        Each named row of the state, its number, and whether it is the train's.
    """

    state: Numbers
    constant: Numbers
    size: Numbers
    state_blocks: dict[str, slice]
    constant_blocks: dict[str, slice]
    state_parts: tuple[tuple[Part, int, bool], ...]

    def numbers(self, kind: str) -> Numbers:
        """``state``, ``constant`` or ``size``, whichever is of that kind."""
        return {found.kind: found for found in (self.state, self.constant, self.size)}[kind]

    @cached_property
    def key(self) -> str:
        """What tells two layouts apart."""
        return "-".join(found.module.__name__ for found in (self.state, self.constant, self.size))


def hinge_parts(prefix: str, fields: type) -> Row:
    """The rows of a hinge law's state or parameters, from the annotations of its named tuple."""
    hints = get_type_hints(fields, include_extras=True)
    parts = []
    for name, hint in hints.items():
        (kept,) = hint.__metadata__
        parts.append(Part(f"{prefix}_{name.upper()}", kept.unit, kept.meaning, kept.channel))
    units = " or ".join(dict.fromkeys(part.unit for part in parts))
    return Row(prefix, units, f"the hinge's own: {fields.__doc__}", len(parts), tuple(parts), False,
               False)  # fmt: skip


class _Placed(NamedTuple):
    """Where declared rows stand."""

    numbers: dict[str, Any]
    blocks: dict[str, slice]
    parts: tuple[tuple[Part, int, bool], ...]
    total: int


def _place(rows: Sequence[Row], sizes: Mapping[str, int]) -> _Placed:
    """One after the other."""
    numbers: dict[str, Any] = {}
    blocks = {}
    parts = []
    released = []
    at = 0
    for row in rows:
        count = sizes[row.rows] if isinstance(row.rows, str) else row.rows
        numbers[row.name] = at
        blocks[row.name] = slice(at, at + count)
        place = 0
        for part in row.parts:
            if part.at is not None:
                place = sizes[part.at] if isinstance(part.at, str) else part.at
            numbers[part.name] = at + place
            parts.append((part, at + place, row.train))
            place += 1
        if row.released:
            released.append((at, at + count))
        at += count
    numbers["RELEASED"] = tuple(released)
    return _Placed(numbers, blocks, tuple(parts), at)


@cache
def _layout(
    hinge: HingeLaw,
    bodies: int,
    lateral: int,
    structure: tuple[int, int, int, int],
    lanes: int,
    joined: Joined,
) -> Layout:
    dofs = 3 * bodies
    count, top, hinge_at, top_roll = structure
    sizes = {
        "LANES": lanes,
        "BODIES": bodies,
        "DOFS": dofs,
        "LATERAL": lateral,
        "VEHICLE_ENTRIES": dofs * (dofs + 1) // 2,
        "WHEELSET_Y": 2 * bodies - 2,
        "WHEELSET_PHI": 2 * bodies - 1,
        "WHEELSET_Z": dofs - 1,
        "STRUCTURE": count,
        "STRUCTURE_ENTRIES": count * (count + 1) // 2,
        "TOP": top,
        "HINGE": hinge_at,
        "TOP_ROLL": top_roll,
        **_joined_sizes(joined, bodies),
        "POLYNOMIAL_FIELDS": len(Polynomials._fields),
        "POLYNOMIAL_ROWS": len(PATCHES) * len(Polynomials._fields),
    }
    own = hinge_parts("HINGE", type(hinge.virgin))
    given = hinge_parts("HINGE", hinge.parameter_fields)
    states = _place((*STATE_ROWS, own), sizes)
    constants = _place((*CONSTANT_ROWS, given), sizes)
    sizes["STATE_ROWS"], sizes["CONSTANT_ROWS"] = states.total, constants.total
    return Layout(
        Numbers("row of the state", states.numbers),
        Numbers("row of the constants", constants.numbers),
        Numbers("size", sizes),
        states.blocks,
        constants.blocks,
        states.parts,
    )


def _joined_sizes(joined: Joined, bodies: int) -> dict[str, int]:
    """Sizes of the joints' rows."""
    elements, stops = len(joined.elements), joined.count("stop")
    return {
        "TURNED": bodies if elements else 0,
        "STOPS": stops,
        "RAMPS": joined.ramps,
        "TIE_FIELDS": len(Tie._fields),
        "SPRING_FIELDS": len(JointSpring._fields),
        "SIDES_FIELDS": len(Sides._fields),
        "TIE_ROWS": len(Tie._fields) * elements,
        "GAP_ROWS": 2 * elements,
        "SPRING_ROWS": len(JointSpring._fields) * joined.count("spring"),
        "SIDES_ROWS": len(Sides._fields) * stops,
        "RAMP_ROWS": joined.ramps * stops,
        "KNEE_ROWS": 3 * joined.count("knee"),
    }


PIER = (3, 0, 1, 2)
"""Degrees of freedom of the pier, and which are the top's displacement, the hinge's rotation and
the top's rotation."""


def layout_of(
    hinge: HingeLaw,
    bodies: int = 3,
    lateral: int = 6,
    structure: tuple[int, int, int, int] = PIER,
    lanes: int = 1,
    joined: Joined = UNJOINED,
) -> Layout:
    """Layout of a run.

    Parameters
    ----------
    hinge : HingeLaw
    bodies : int
        Of the vehicle, the wheelset among them.
    lateral : int
        Rows of the vehicle's first block, see `order.lateral_block`.
    structure : (int, int, int, int)
        Its degrees of freedom, and which are the displacement and rotation of the node that
        carries the track and the rotation of its hinge; see `PIER`.
    lanes : int
        Scenarios abreast.
    joined : Joined
        The vehicle's joints, if it turns by any angle.
    """
    return _layout(hinge, bodies, lateral, structure, lanes, joined)


USUAL = layout_of(HINGE_LAWS["bouc-wen"])
state, constant, size = USUAL.state, USUAL.constant, USUAL.size
