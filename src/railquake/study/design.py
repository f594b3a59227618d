"""The design of a study: which run is which, and the scenario of each."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from railquake.errors import InputError
from railquake.inputs.identity import fingerprint, hash_of_fingerprints
from railquake.inputs.layers import with_overrides
from railquake.inputs.marks import Place
from railquake.inputs.model import validated
from railquake.inputs.motion import Motion
from railquake.inputs.scenario import Scenario, scenario_from_dict
from railquake.memory import Bounded
from railquake.study.axes import Axis, DistributionAxis, VariantAxis, sampled
from railquake.suite import Suite, SuiteMember

if TYPE_CHECKING:
    from railquake.inputs.vehicle import Vehicle
    from railquake.run.time_step import TimeStep
    from railquake.study.file import StudyInputs

__all__ = ["Design", "Point"]

_SECTIONS = tuple(key for key in Scenario.model_fields if key != "motion")
_NO_SECTION: dict[str, Any] = {}
_REMEMBERED = 512  # sections, and motions
_MOST_CHECKED = 4096  # combinations of values that are tried before anything runs
_ANY_MOTION = {"acceleration": (0.0, 0.0), "dt": 1.0}  # stands for a motion where none matters


@dataclass(frozen=True)
class Point:
    """One run of a design.

    Attributes
    ----------
    row : int
        Its number, from 0.
    record, level : str or None
        Names of its motion and level.
    scale : float
        Factor on the motion, all told.
    member : int
        Number of its motion in the suite.
    motion : mapping
        Its table, without the scale.
    motion_key : str
        Tells motions of a member apart that axes have changed.
    changes : dict
        What they change elsewhere.
    labels : dict
        Values of the axes' columns.
    """

    row: int
    record: str
    level: str | None
    scale: float
    member: int
    motion: Mapping[str, Any]
    motion_key: str
    changes: dict[str, Any]
    labels: dict[str, Any]


class Design:
    """All combinations of a study's motions, levels and axes.

    Rows are numbered with the motion changing slowest, then the level, then the axes in their
    order; samples of distributions, drawn together, change fastest.

    Parameters
    ----------
    study : StudyInputs
        Its suite loaded.
    time_step : TimeStep, optional
        What was chosen where the study leaves it open; without it scenarios leave it open, too.
    """

    def __init__(self, study: StudyInputs, time_step: TimeStep | None = None) -> None:
        assert study.suite is None or isinstance(study.suite, Suite), "the suite is loaded first"
        self.study = study
        self.where = study.where
        self.time_step = time_step
        base = dict(study.base)
        motion = base.pop("motion", None)
        self._base = base
        if study.suite is not None:
            # what is meant by the base case's own motion holds for those in its place
            meant = isinstance(motion, Mapping) and motion.get("allow_high_pga") is True
            self.members: tuple[SuiteMember, ...] = tuple(
                replace(one, motion={**one.motion, "allow_high_pga": True}) if meant else one
                for one in study.suite.members
            )
        else:
            table = {} if motion is None else dict(motion)
            factor = table.pop("scale", 1.0)
            self.members = (SuiteMember(_motion_name(table), table, factor),)
        self.levels: tuple[tuple[str | None, float], ...] = tuple(study.levels.items()) or (
            (None, 1.0),
        )
        self.grid = [axis for axis in study.axes if not isinstance(axis, DistributionAxis)]
        self.drawn = [axis for axis in study.axes if isinstance(axis, DistributionAxis)]
        self.samples = study.sampling.count if study.sampling is not None else 1
        self._moves = any(map(_is_motion, self._paths()))
        self._sections = Bounded[tuple[str, str], tuple[Any, str]](_REMEMBERED)
        self._solvers = Bounded[tuple[str, ...], tuple[Any, str]](_REMEMBERED)
        self._motions = Bounded[tuple[int, str], Motion](_REMEMBERED)

    def _paths(self) -> Iterator[str]:
        for axis in self.study.axes:
            yield from axis.paths if hasattr(axis, "paths") else (axis.path,)

    @property
    def size(self) -> int:
        """Number of runs."""
        count = len(self.members) * len(self.levels) * self.samples
        for axis in self.grid:
            count *= axis.size
        return count

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Axes in the study's order."""
        return tuple(self.study.axes)

    @cached_property
    def _drawn_values(self) -> dict[str, list[Any]]:
        if self.study.sampling is None:
            return {}
        return sampled(self.drawn, self.study.sampling)

    def point(self, row: int) -> Point:
        """What a row stands for.

        Parameters
        ----------
        row : int
            From 0 to `size`, excluded.
        """
        rest, sample = divmod(row, self.samples)
        picks: list[int] = []
        for axis in reversed(self.grid):
            rest, pick = divmod(rest, axis.size)
            picks.append(pick)
        member_index, level_index = divmod(rest, len(self.levels))
        member, (level, factor) = self.members[member_index], self.levels[level_index]
        changes: dict[str, Any] = {}
        labels: dict[str, Any] = {axis.column: None for axis in self.study.axes}
        for axis, pick in zip(self.grid, reversed(picks), strict=True):
            changes.update(axis.changes(pick))
            labels[axis.column] = axis.label(pick)
        for drawn in self.drawn:
            changes[drawn.path] = labels[drawn.column] = self._drawn_values[drawn.path][sample]
        own = member.scale_factor
        record, table, key = member.name, member.motion, ""
        if self._moves:
            if "motion.scale" in changes:
                scale = changes.pop("motion.scale")
                own = scale if self.study.suite is None else own * scale
            changed = {path: changes.pop(path) for path in list(changes) if _is_motion(path)}
            if changed:
                key = repr(changed)
                table = with_overrides({"motion": table}, changed, Place((Scenario,)))["motion"]
                record = _motion_name(table) if self.study.suite is None else record
        return Point(row, record, level, own * factor, member_index, table, key, changes, labels)

    def vehicle(self, point: Point) -> Vehicle:
        """The vehicle of a run; its motion, and whether it can be read, do not matter.

        Parameters
        ----------
        point : Point
            Of `point`.

        Raises
        ------
        InputError
            If the inputs do not make one.
        """
        own = {path: value for path, value in point.changes.items() if path.startswith("vehicle.")}
        vehicle: Vehicle = self._section("vehicle", own)[0]
        return vehicle

    def scenario(self, point: Point) -> Scenario:
        """The scenario of a run.

        Parameters
        ----------
        point : Point
            Of `point`.

        Returns
        -------
        Scenario
            The same as the base case with all changes gives, made from parts that are remembered.

        Raises
        ------
        InputError
            If its inputs do not make one.
        """
        return self.identified(point)[0]

    def identified(self, point: Point) -> tuple[Scenario, str, tuple[str, ...]]:
        """The scenario of a run, its content hash, and what tells apart all but motions.

        Parameters
        ----------
        point : Point
            Of `point`.

        Raises
        ------
        InputError
            If its inputs do not make a scenario, or one of its files cannot be read.
        """
        by_section: dict[str, dict[str, Any]] = {}
        for path, value in point.changes.items():
            by_section.setdefault(path.partition(".")[0], {})[path] = value
        parts = {key: self._section(key, by_section.get(key, _NO_SECTION)) for key in _SECTIONS}
        motion = self._motion(point)
        if motion is None and parts["support"][0].needs_motion:
            self._in_full(point)  # says what is missing
        if motion is not None:
            motion = motion.model_copy(update={"scale": point.scale})
        # every part has been validated
        scenario = Scenario.model_construct(
            motion=motion, **{key: section for key, (section, _) in parts.items()}
        )
        if scenario.solver.dt == "auto" and self.time_step is not None:
            parts["solver"] = self._settled(scenario, tuple(text for _, text in parts.values()))
            scenario = scenario.model_copy(update={"solver": parts["solver"][0]})
        texts = {key: text for key, (_, text) in parts.items()}
        key = hash_of_fingerprints({**texts, "motion": fingerprint(motion)})
        return scenario, key, tuple(texts.values())

    def _section(self, key: str, changes: Mapping[str, Any]) -> tuple[Any, str]:
        """A part of the base case with some changes and its fingerprint, made once."""

        def make() -> tuple[Any, str]:
            tables = {**self._base, "motion": _ANY_MOTION}
            made = scenario_from_dict(tables, overrides=changes, where=f"{self.where}: base")
            section = getattr(made, key)
            return section, fingerprint(section)

        return self._sections.get((key, repr(changes)), make)

    def _settled(self, scenario: Scenario, name: tuple[str, ...]) -> tuple[Any, str]:
        """The solver with the time step that was chosen, found once for all motions."""
        step = self.time_step
        assert step is not None  # by the caller

        def make() -> tuple[Any, str]:
            solver = step.settled(scenario).solver
            return solver, fingerprint(solver)

        return self._solvers.get(name, make)

    def _motion(self, point: Point) -> Motion | None:
        """A member's motion with an axis's changes, validated once."""
        if not point.motion:
            return None
        where = f"{self.where}: motion"
        if self.study.suite is not None:
            where = f"{self.where}: suite: {point.record}"
        return self._motions.get(
            (point.member, point.motion_key), lambda: validated(Motion, point.motion, where)
        )

    def _in_full(self, point: Point) -> Scenario:
        tables = dict(self._base)
        if point.motion:
            tables["motion"] = {**point.motion, "scale": point.scale}
        return scenario_from_dict(tables, overrides=point.changes, where=f"{self.where}: base")

    def check(self) -> None:
        """Refuse a design of which some run is wrong, before anything runs.

        All combinations of listed values are tried, without motions; where they are too many,
        each value beside the first of the others.  Then each motion of the suite is read.

        Raises
        ------
        InputError
            Naming what was found wrong first.
        """
        choices = [range(axis.size) for axis in self.grid]
        combinations = 1
        for choice in choices:
            combinations *= len(choice)
        picks: Any = itertools.product(*choices)
        if combinations > _MOST_CHECKED:
            picks = (
                tuple(pick if k == at else 0 for k in range(len(choices)))
                for at, choice in enumerate(choices)
                for pick in choice
            )
        inner = self.samples
        for pick in picks:
            row = 0
            for axis, index in zip(self.grid, pick, strict=True):
                row = row * axis.size + index
            self.scenario(self.point(row * inner))
        rows_of_member = self.size // len(self.members)
        for member in range(len(self.members)):
            for row in self._extremes(
                range(member * rows_of_member, (member + 1) * rows_of_member)
            ):
                self._check_motions(self.point(row))

    def _extremes(self, rows: range) -> list[int]:
        """A motion's first row, and those with its largest factors.

        The first values of the other axes stand beside each level and each factor of an axis.
        """
        where = [k for k, axis in enumerate(self.grid) if _scales(axis)]
        inner = [self.samples] * len(self.grid)
        for k in reversed(range(len(self.grid) - 1)):
            inner[k] = inner[k + 1] * self.grid[k + 1].size
        of_level = len(rows) // len(self.levels)
        offsets = [
            sum(pick * inner[k] for k, pick in zip(where, picks, strict=True))
            for picks in itertools.product(*(range(self.grid[k].size) for k in where))
        ]
        if any(axis.path == "motion.scale" for axis in self.drawn):
            offsets = [at + sample for at in offsets for sample in range(self.samples)]
        tried = [
            rows.start + level * of_level + at
            for level in range(len(self.levels))
            for at in offsets[:_MOST_CHECKED]
        ]
        scales = [self.point(row).scale for row in tried]
        chosen = {rows.start, tried[max(range(len(tried)), key=lambda k: abs(scales[k]))]}
        return sorted(chosen | {tried[k] for k, scale in enumerate(scales) if scale == 0.0})

    def _check_motions(self, point: Point) -> None:
        scenario = self.scenario(point)
        try:
            scenario.ground_motion()
            scenario.vertical_motion()
        except InputError as error:
            if self.study.suite is None:
                raise InputError(f"{self.where}: row {point.row}: {error}") from None
            raise InputError(f"{self.where}: suite: {point.record}: {error}") from None


def _scales(axis: Axis) -> bool:
    """Whether an axis changes the factor on the motion."""
    paths = axis.paths if isinstance(axis, VariantAxis) else {axis.path}
    return "motion.scale" in paths or "motion.allow_high_pga" in paths


def _is_motion(path: str) -> bool:
    return path.startswith("motion.")


def _motion_name(table: Mapping[str, Any]) -> str:
    """What to call a motion that belongs to no suite."""
    if table.get("name"):
        return str(table["name"])
    if table.get("record"):
        return Path(str(table["record"])).stem
    if isinstance(table.get("synthetic"), Mapping):
        return f"synthetic-{table['synthetic'].get('seed', 1)}"
    return "samples" if table else "at rest"
