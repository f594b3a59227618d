"""What a measure is: its key, unit and names, and where it is read."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from enum import Enum

__all__ = [
    "AttributeOf",
    "EventTime",
    "Intensity",
    "Kind",
    "Measure",
    "Place",
    "StateRow",
    "StateTime",
    "WorkedOut",
    "printed",
]

_SUPERSCRIPTS = str.maketrans("23", "²³")


class Kind(Enum):
    """What a measure tells of; the value is the heading under which the documentation lists it."""

    OUTCOME = "How it ended"
    GROUND = "The ground"
    STRUCTURE = "The structure"
    TRAIN = "The train"
    TIME = "When"
    RUN = "How it was computed"


# --- where a measure is read; `run.assess` knows how


@dataclass(frozen=True)
class StateRow:
    """The last value of a row of the state, by the row's name.

    Where the march declares no such row, it is one of its own: zero at the start, in the measure's
    unit.
    """

    name: str


@dataclass(frozen=True)
class StateTime:
    """A row of the state that holds a time, s; negative there, None here: it did not happen."""

    name: str


@dataclass(frozen=True)
class EventTime:
    """When an event first held, s, by the event's name; None: never."""

    event: str


@dataclass(frozen=True)
class AttributeOf:
    """An attribute of the response, its path with points, such as ``system.ground.pga``."""

    path: str


@dataclass(frozen=True)
class WorkedOut:
    """A function of `run.assess`, by its name, that makes it of the response."""

    function: str


Place = StateRow | StateTime | EventTime | AttributeOf | WorkedOut


@dataclass(frozen=True)
class Intensity:
    """What makes a measure one that outcomes are held against.

    Parameters
    ----------
    rank : int
        Place where such measures are listed; the first is the paper's choice.
    name : str
        In ``probability(pbv=1.2)`` and ``from_table(table, "derailed", "pbv")``.
    demand_type, demand_unit : str
        pelicun's names; see `fragility.write_csv`.
    has_period : bool
        Whether it belongs to a period, which pelicun wants to know.
    with_uplift : bool
        Whether the report holds the uplift against it as well.
    """

    rank: int
    name: str
    demand_type: str
    demand_unit: str
    has_period: bool = False
    with_uplift: bool = True


@dataclass(frozen=True)
class Measure:
    r"""A measure of a run.

    Parameters
    ----------
    key : str
        In a row, and of the column; its unit stands at its end.
    kind : Kind
    unit : str
        SI; ``1`` for a plain number, empty for a text or a flag.
    short : str
        Such as ``PBV``.
    caption : str
        Such as ``peak bridge velocity``; what follows a comma may be left out beside the number.
    meaning : str
        A line of the documentation, in Markdown with :math:`\TeX`.
    place : Place
        Where `assess` reads it.
    value : type
        ``float``, ``int``, ``bool`` or ``str``.  (``versions`` is a mapping, JSON in a table.)
    optional : bool
        Whether it is None, in a table missing, where it did not happen or does not apply.
    factor : float
        SI times this is in `shown_unit`.
    shown_unit : str
        In which people read it; empty: as `unit`.
    intensity : Intensity, optional
        Where outcomes are held against it.
    step_floor : float, optional
        Where the error of the time step is told by it: smaller values count as this large.
    paired : bool
        Whether models are compared by it, run by run.
    repeats : bool
        Whether the same run gives it again; times do not.
    """

    key: str
    kind: Kind
    unit: str
    short: str
    caption: str
    _: KW_ONLY
    meaning: str
    place: Place
    value: type[float] | type[int] | type[bool] | type[str] = float
    optional: bool = False
    factor: float = 1.0
    shown_unit: str = ""
    intensity: Intensity | None = None
    step_floor: float | None = None
    paired: bool = False
    repeats: bool = True

    @property
    def axis(self) -> str:
        """Label of an axis, in the unit in which people read it."""
        unit = self.shown_unit or self.unit
        return self.caption if unit in ("", "1") else f"{self.caption}, {printed(unit)}"

    @property
    def named_axis(self) -> str:
        """The same behind its short name."""
        return f"{self.short}: {self.axis}"

    @property
    def title(self) -> str:
        """The caption as a heading."""
        return f"{self.caption[0].upper()}{self.caption[1:]}"


def printed(unit: str) -> str:
    """A unit as it is printed, ``m/s²``."""
    return unit.translate(_SUPERSCRIPTS)
