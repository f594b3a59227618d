"""The hinge's law, step by step, against OpenSees' material."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from railquake.assembly.hinge import drive_hinge
from railquake.inputs.hinge import BoucWenHinge
from railquake.march.compiler import PYTHON, SCALAR
from railquake.validation.comparison import Outcome, Picture, of_peak
from railquake.validation.pictures import write_loops
from railquake.validation.reference import columns, header, numbers_beside

__all__ = ["compare", "deviation", "hinge_of", "numbers"]

TITLE = "The hinge: every step of two cyclic histories"
SOURCE = """OpenSees' material `DegradingPinchedBW` (Python wheel `opensees` 0.1.32, its tolerance
1e-12), driven through cycles of growing amplitude. Parameters, units and paths stand in the first
lines of the two files beside the module."""
WHAT = """The moment after each of 560 and 1440 steps, from the law as plain Python and as compiled.
`generic` is without dimensions and has every term of the damage switched on but `eta0`; `hinge` is
the hinge of the preset `bart-berkeley` with `m = 1`. OpenSees' tangents are no reference, since
they leave out the damage's change at a new largest rotation: ours are tested against finite
differences."""
WHY = """The same equations in the same steps, with Newton's method carried to 1e-6 of a yielded
hinge's z: nothing but rounding and the numbers' fifteen digits is left. 1e-9 of the largest moment
is a hundredth of what the solver's own tolerance costs in steps of this length."""

TOLERANCE = 1e-9
NEWTON_TOLERANCE = 1e-6
SETS = ("generic", "hinge")

# OpenSees' names, where they differ from the published ones
NAMES = {
    "ko": "k0", "eta": "eta0", "beta": "beta0", "rhoeps": "rho_eps", "rhox": "rho_x",
    "deltak": "delta_k", "deltaf": "delta_f", "epsp": "eps_p", "rhop": "rho_p",
}  # fmt: skip

Array = np.ndarray[Any, np.dtype[np.float64]]


def numbers(name: str) -> Path:
    """File of a set."""
    return numbers_beside("hinge_steps", f"{name}.csv")


def hinge_of(path: Path) -> BoucWenHinge:
    """The hinge of a file's first lines."""
    line = next(line for line in header(path) if line.startswith("parameters:"))
    values = {NAMES.get(key, key): float(value) for key, value in re.findall(r"(\w+)=(\S+)", line)}
    return BoucWenHinge(**values)


def moments(name: str, tolerance: float, target: Any) -> Array:
    """Ours for the path of a set; ``tolerance`` of z as in `Solver`.

    Raises
    ------
    ArithmeticError
        If Newton's method does not converge in a step.
    """
    path = columns(numbers(name))["x"]
    driven = drive_hinge(
        "bouc-wen",
        hinge_of(numbers(name)),
        path,
        tolerance=tolerance,
        iterations=50,
        target=target,
    )
    if driven.solved < len(path):
        raise ArithmeticError(f"the hinge does not converge in step {driven.solved}")
    return driven.moment


def deviation(name: str, tolerance: float, target: Any) -> float:
    """Largest error of the moment over the largest moment."""
    theirs = columns(numbers(name))["F"]
    return float(np.abs(moments(name, tolerance, target) - theirs).max() / np.abs(theirs).max())


def compare(data: Path | None) -> Outcome:
    """Drive both sets."""
    results, loops = [], []
    for name in SETS:
        path = columns(numbers(name))
        for how, target in (("plain", PYTHON), ("compiled", SCALAR)):
            ours = moments(name, NEWTON_TOLERANCE, target)
            results.append(
                of_peak(
                    f"{name}, {how}: moment", "N m" if name == "hinge" else "",
                    reference=path["F"], ours=ours, tolerance=TOLERANCE,
                )
            )  # fmt: skip
        scales = (1e3, 1e-6) if name == "hinge" else (1.0, 1.0)
        loops.append((name, scales[0] * path["x"], scales[1] * path["F"], scales[1] * ours))
    labels = (("rotation, 1", "moment, 1"), ("rotation, mrad", "moment, MN m"))
    return Outcome(
        tuple(results),
        (
            Picture(
                "loops",
                "Moment against rotation: OpenSees (dots, every fifth step) and railquake (line).",
                lambda path: write_loops(loops, labels, path),
            ),
        ),
    )
