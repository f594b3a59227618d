"""What a study is given: a base case, a suite of motions and axes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from numbers import Real
from pathlib import Path
from typing import Any, Self

from pydantic import create_model

from railquake.errors import InputError
from railquake.inputs.layers import merged, with_absolute_paths
from railquake.inputs.marks import Place, alternatives
from railquake.inputs.motion import Motion
from railquake.inputs.scenario import Scenario
from railquake.inputs.toml import is_path, read_toml
from railquake.messages import did_you_mean, refuse_unknown, shown, toml_type
from railquake.study.axes import VariantAxis
from railquake.study.distributions import Sampling
from railquake.study.moved import FOLDER
from railquake.study.parsing import parse_axes, parse_sampling
from railquake.suite import SUITES, Suite, SuiteMember, load_suite

__all__ = ["AUTO", "FILE", "MADE_BY", "StudyInputs"]

AUTO = "auto"  # a time step that is chosen for the study
MADE_BY = ("railquake", "physics")  # what a study's folder notes of what made its rows
_SECTIONS = ("base", "suite", "axes", "sampling")
_CASE = Place((Scenario,))
# An axis' name is the path of an input: what excludes each other in a case does so here, too.
FILE = Place((create_model("StudyFile", base=(Scenario, ...), axes=(Scenario, ...)),))
_SUITE_KEYS = ("manifest", "levels", "name", "members")
_MOTIONS = tuple(f"motion.{key}" for group in alternatives(Motion) for key in group)


@dataclass(frozen=True)
class StudyInputs:
    """What a study is given; see `railquake.Study`, which also runs."""

    base: Any
    suite: Suite | str | Path | None = None
    levels: Mapping[str, float] = field(default_factory=dict)
    axes: Any = field(default_factory=dict)
    sampling: Any = None
    folder: str | Path | None = None
    where: str = "study"

    def __post_init__(self) -> None:
        folder = (Path.cwd() if self.folder is None else Path(self.folder)).absolute()
        axes = self.axes
        if isinstance(axes, Mapping) or not isinstance(axes, tuple):
            axes = parse_axes(axes, folder, f"{self.where}: axes")
        sampling = self.sampling
        if not isinstance(sampling, Sampling):
            sampling = parse_sampling(sampling, axes, f"{self.where}: sampling")
        for name, value in (
            ("folder", folder),
            ("base", _base_tables(self.base, folder, f"{self.where}: base")),
            ("suite", _suite(self.suite, folder)),
            ("levels", _levels(self.levels, f"{self.where}: suite.levels")),
            ("axes", axes),
            ("sampling", sampling),
        ):
            object.__setattr__(self, name, value)
        self._check_motion()

    def _check_motion(self) -> None:
        for axis in self.axes:
            paths = axis.paths if isinstance(axis, VariantAxis) else {axis.path}
            for path in sorted(paths):
                if self.suite is not None and path.startswith(_MOTIONS):
                    raise InputError(
                        f"{self.where}: axes.{axis.column}: {path} is given by the suite; leave "
                        "out one of them"
                    )

    @classmethod
    def from_dict(
        cls, tables: Mapping[str, Any], folder: str | Path | None = None, *, where: str = "study"
    ) -> Self:
        """Make a study from the tables of a study file.

        Parameters
        ----------
        tables : mapping
            With ``base`` and, as needed, ``suite``, ``axes`` and ``sampling``.
        folder : str or Path, optional
            What relative paths start from; the working folder by default.
        where : str
            What to call the tables in messages.

        Raises
        ------
        InputError
            Naming the field, what was found and what to write.
        """
        refuse_unknown(
            (key for key in tables if key not in (*MADE_BY, FOLDER)), _SECTIONS, f"{where}: "
        )
        if "base" not in tables:
            raise InputError(
                f'{where}: base: missing; write e.g. [base] case = "case.toml", or the tables of a '
                "case as [base.vehicle], [base.support] ..."
            )
        table = tables.get("suite", {})
        if not isinstance(table, Mapping):
            raise InputError(
                f"{where}: suite: must be a table, found {toml_type(table)}; write e.g. [suite] "
                'manifest = "paper-suite"'
            )
        for key in table:
            if key not in _SUITE_KEYS:
                advice = did_you_mean(key, _SUITE_KEYS[:2])
                raise InputError(f"{where}: suite.{key}: unknown key; {advice}")
        suite: Suite | str | None = table.get("manifest")
        if suite is not None and "members" in table:
            raise InputError(f"{where}: suite: give either manifest or members, found both")
        if suite is not None and not isinstance(suite, str):
            raise InputError(
                f"{where}: suite.manifest: must be a built-in suite's name or a CSV file, found "
                f"{toml_type(suite)}"
            )
        if "members" in table:
            suite = _members(table["members"], table.get("name", "suite"), f"{where}: suite")
        return cls(
            base=tables["base"],
            suite=suite,
            levels=table.get("levels", {}),
            axes=tables.get("axes", {}),
            sampling=tables.get("sampling"),
            folder=folder,
            where=where,
        )

    def to_dict(self) -> dict[str, Any]:
        """Tables of a study file that gives this study again, values in SI units."""
        data: dict[str, Any] = {"base": self.base}
        suite: dict[str, Any] = {}
        if isinstance(self.suite, Suite):
            suite["name"] = self.suite.name
            suite["members"] = [
                {"name": m.name, "scale_factor": float(m.scale_factor), "motion": dict(m.motion)}
                for m in self.suite.members
            ]
        elif self.suite is not None:
            suite["manifest"] = str(self.suite)
        if self.levels:
            suite["levels"] = dict(self.levels)
        if suite:
            data["suite"] = suite
        if self.axes:
            data["axes"] = {axis.column: axis.to_toml() for axis in self.axes}
        if self.sampling is not None:
            data["sampling"] = self.sampling.to_toml()
        return data

    def with_suite(self, records: str | Path | None = None) -> Self:
        """The study with its suite loaded.

        Parameters
        ----------
        records : str or Path, optional
            The folder that holds the suite's records.

        Raises
        ------
        InputError
            If the suite is not known or records are missing.
        """
        if self.suite is None or isinstance(self.suite, Suite):
            return self
        return replace(
            self, suite=load_suite(self.suite, None if records is None else Path(records))
        )

    @property
    def chooses_time_step(self) -> bool:
        """Whether the time step is left to the study."""
        solver = self.base.get("solver")
        return isinstance(solver, Mapping) and solver.get("dt") == AUTO


def _base_tables(base: Any, folder: Path, where: str) -> dict[str, Any]:
    """Tables of the base case, paths absolute."""
    if isinstance(base, Scenario):
        return base.to_dict()
    if isinstance(base, str | Path):
        base = {"case": str(base)}
    if not isinstance(base, Mapping):
        raise InputError(f'{where}: must be a table, found {toml_type(base)}; write case = "..."')
    tables = dict(base)
    case = tables.pop("case", None)
    sections = list(Scenario.model_fields)
    refuse_unknown(tables, ["case", *sections], f"{where}.")
    for key, table in tables.items():
        if not isinstance(table, Mapping):
            raise InputError(f"{where}.{key}: must be a table, found {toml_type(table)}")
    tables = with_absolute_paths(tables, folder, _CASE)
    if case is None:
        return tables
    if not isinstance(case, str):
        raise InputError(f"{where}.case: must be a case file, found {toml_type(case)}")
    path = folder / case
    found = read_toml(path)
    for key, table in found.items():
        if not isinstance(table, Mapping):
            raise InputError(f"{path}: {key}: must be a table, found {toml_type(table)}")
    return merged(with_absolute_paths(found, path.parent, _CASE), tables, _CASE)


def _suite(suite: Suite | str | Path | None, folder: Path) -> Suite | str | None:
    if suite is None or isinstance(suite, Suite):
        return suite
    name = str(suite)
    return name if name in SUITES or not is_path(name) else str((folder / name).absolute())


def _levels(levels: Any, where: str) -> dict[str, float]:
    example = 'write e.g. levels = { "50%" = 0.21, "5%" = 1.0 }'
    if not isinstance(levels, Mapping):
        raise InputError(
            f"{where}: must be a table of factors, found {toml_type(levels)}; {example}"
        )
    found: dict[str, float] = {}
    for name, factor in levels.items():
        found[str(name)] = _factor(factor, f"{where}.{name}")
    return found


def _factor(value: Any, where: str) -> float:
    """A factor on motions."""
    if isinstance(value, Real) and not isinstance(value, bool):
        with suppress(OverflowError):  # a whole number of hundreds of digits
            if 0.0 < float(value) < math.inf:
                return float(value)
    raise InputError(f"{where}: must be a number over zero, found {shown(value)}")


def _members(items: Any, name: Any, where: str) -> Suite:
    if not isinstance(items, list | tuple) or not items:
        raise InputError(f"{where}.members: must be a list of tables, found {toml_type(items)}")
    members: list[SuiteMember] = []
    for item in items:
        try:
            name_of, motion, factor = str(item["name"]), dict(item["motion"]), item["scale_factor"]
        except (KeyError, TypeError, ValueError):
            raise InputError(
                f"{where}.members: each needs name, motion and scale_factor, found "
                + toml_type(item)
            ) from None
        factor = _factor(factor, f"{where}.members.{name_of}.scale_factor")
        members.append(SuiteMember(name_of, motion, factor))
    return Suite(str(name), tuple(members))
