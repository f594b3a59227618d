"""Study files: a base case, a suite of motions and axes."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pydantic import create_model

from railquake.errors import InputError
from railquake.inputs.layers import Overrides, merged, with_absolute_paths, with_overrides
from railquake.inputs.marks import Place
from railquake.inputs.scenario import Scenario
from railquake.inputs.toml import is_path, read_toml
from railquake.messages import did_you_mean, refuse_unknown, shown, toml_type
from railquake.study.axes import VariantAxis
from railquake.study.distributions import Sampling
from railquake.study.parsing import parse_axes, parse_sampling
from railquake.suite import SUITES, Suite, SuiteMember, load_suite

if TYPE_CHECKING:
    import pandas as pd

    from railquake.run.many import Device
    from railquake.study.engine import StudyProgress

__all__ = ["AUTO", "Study", "load_study"]

AUTO = "auto"  # a time step that is chosen for the study
_SECTIONS = ("base", "suite", "axes", "sampling")
_CASE = Place((Scenario,))
# An axis' name is the path of an input: what excludes each other in a case does so here, too.
_FILE = Place((create_model("StudyFile", base=(Scenario, ...), axes=(Scenario, ...)),))
_SUITE_KEYS = ("manifest", "levels", "name", "members")
_MOTIONS = ("motion.record", "motion.synthetic", "motion.acceleration")


@dataclass(frozen=True)
class Study:
    """A base case, a suite of motions and axes: every combination is a run.

    Parameters
    ----------
    base : Scenario, mapping, str or Path
        A case, its tables, or its file.  ``dt = "auto"`` of its solver lets the study choose the
        time step.
    suite : Suite, str, Path or None
        Motions with their scale factors: a suite, a built-in suite's name, or a manifest's path.
        Without one the base case's own motion is taken.
    levels : mapping
        Factors on all motions by name, such as hazard levels; 1 without a name by default.
    axes : mapping
        As in a study file: by path a list of values or a distribution, or by a name a list of
        variants, tables with ``name`` and ``set``.
    sampling : Sampling, mapping or None
        How distributions are sampled.
    folder : str, Path or None
        What relative paths of files start from; the working folder by default.
    where : str
        What to call the study in messages.

    Raises
    ------
    InputError
        In one line: what is wrong, and what to write.

    Examples
    --------
    >>> study = Study(
    ...     base={"vehicle": {"preset": "bart"}, "support": {"preset": "bart-berkeley"},
    ...           "wheelrail": {"preset": "bart"}, "motion": {"synthetic": {"seed": 1}}},
    ...     axes={"vehicle.speed": ["0.01 km/h", "80 km/h"], "motion.scale": [1.0, 2.0]},
    ... )
    >>> study.size
    4
    """

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
    ) -> Study:
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
        refuse_unknown((key for key in tables if key != "railquake"), _SECTIONS, f"{where}: ")
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

    def with_suite(self, records: str | Path | None = None) -> Study:
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
    def size(self) -> int:
        """Number of runs; the suite must be loaded."""
        from railquake.study.design import Design

        return Design(self).size

    @property
    def chooses_time_step(self) -> bool:
        """Whether the time step is left to the study."""
        solver = self.base.get("solver")
        return isinstance(solver, Mapping) and solver.get("dt") == AUTO

    def run(
        self,
        out: str | Path,
        *,
        jobs: int | None = None,
        records: str | Path | None = None,
        progress: Callable[[StudyProgress], None] | None = None,
        notify: Callable[[str], None] | None = None,
        executor: Executor | None = None,
        scheduler: str | None = None,
        shard: tuple[int, int] | str | None = None,
        device: Device = "cpu",
    ) -> pd.DataFrame:
        """Run the study, or what is left of it.

        Parameters
        ----------
        out : str or Path
            Folder for the results.  If it holds results of this study, only what is missing is
            run.
        jobs : int, optional
            Threads; all processors by default, two for a GPU.
        records : str or Path, optional
            Folder that holds the suite's records.
        progress : callable, optional
            Called with a `StudyProgress` whenever runs have ended.
        notify : callable, optional
            Called with a line of text about what is worth knowing.
        executor : concurrent.futures.Executor, optional
            Runs the batches instead of threads of this process.
        scheduler : str, optional
            Address of a Dask scheduler whose workers run the batches: ``"tcp://host:8786"``.
        shard : (int, int) or str, optional
            ``(3, 8)`` or ``"3/8"``: only the third of eight parts of the study.
        device : {"cpu", "cuda"}
            See `simulate_many`; ``cuda`` goes with neither executor nor scheduler.

        Returns
        -------
        pandas.DataFrame
            A row for each run, in the design's order; see `StudyResults.table`.  Of a shard, its
            own rows.

        Raises
        ------
        InputError
            If an input is wrong, the folder holds another study or cannot be written, or the
            scheduler or the GPU is not there.  Finished rows are kept.
        """
        from railquake.study.engine import run_study

        return run_study(
            self,
            Path(out),
            jobs=jobs,
            records=None if records is None else Path(records),
            progress=progress,
            notify=notify,
            executor=executor,
            scheduler=scheduler,
            shard=shard,
            device=device,
        )


def load_study(path: str | Path, overrides: Overrides = ()) -> Study:
    """Read a study file.

    Parameters
    ----------
    path : str or Path
        TOML file; relative paths in it start from its folder.
    overrides : iterable of str, or mapping
        Values to change, by their paths in the file: ``["base.solver.dt=auto"]``.

    Returns
    -------
    Study

    Raises
    ------
    InputError
        Naming the file and the line or field, what was found and what to write.
    """
    tables = with_overrides(read_toml(path), overrides, _FILE, f"{path}: --set")
    return Study.from_dict(tables, Path(path).absolute().parent, where=str(path))


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
        number = isinstance(factor, int | float) and not isinstance(factor, bool)
        if not number or not (math.isfinite(factor) and factor > 0.0):
            raise InputError(f"{where}.{name}: must be a number over zero, found {shown(factor)}")
        found[str(name)] = float(factor)
    return found


def _members(items: Any, name: Any, where: str) -> Suite:
    if not isinstance(items, list | tuple) or not items:
        raise InputError(f"{where}.members: must be a list of tables, found {toml_type(items)}")
    members: list[SuiteMember] = []
    for item in items:
        try:
            member = SuiteMember(
                str(item["name"]), dict(item["motion"]), float(item["scale_factor"])
            )
        except (KeyError, TypeError, ValueError):
            raise InputError(
                f"{where}.members: each needs name, motion and scale_factor, found "
                + toml_type(item)
            ) from None
        members.append(member)
    return Suite(str(name), tuple(members))
