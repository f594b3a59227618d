"""A study that can be run: what it is given, and the work above it."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from pathlib import Path
from typing import TYPE_CHECKING

from railquake.inputs.layers import Overrides, with_overrides
from railquake.inputs.toml import read_toml
from railquake.study.design import Design
from railquake.study.engine import StudyProgress, run_study
from railquake.study.file import FILE, StudyInputs

if TYPE_CHECKING:
    import pandas as pd

    from railquake.run.many import Device

__all__ = ["Study", "load_study"]


class Study(StudyInputs):
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

    @property
    def size(self) -> int:
        """Number of runs; the suite must be loaded."""
        return Design(self).size

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
    tables = with_overrides(read_toml(path), overrides, FILE, f"{path}: --set")
    return Study.from_dict(tables, Path(path).absolute().parent, where=str(path))
