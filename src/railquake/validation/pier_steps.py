"""The pier's integrator, step by step, against stored histories of OpenSees."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from railquake.inputs.ground_motion import read_motion
from railquake.inputs.support import Pier
from railquake.measures import STANDARD_GRAVITY
from railquake.validation.comparison import Outcome, Picture, of_peak, relative
from railquake.validation.pictures import write_histories
from railquake.validation.reference import columns, paper_record
from railquake.validation.structure import QUANTITIES, march_pier

TITLE = "The pier: stored histories under a recorded motion"
SOURCE = """OpenSees 0.1.32 (Python wheel `opensees`): zero-length hinge, elastic column, Newmark's
average acceleration at 0.5 ms, record RSN181_IMPVALLH1 as recorded, no train, no gravity. The files
`dyn_elastic.csv` and `dyn_hinge.csv` of the reference data, whose first lines hold every setting
and the peaks."""
WHAT = """The top's displacement, both rotations and the base's moment: the peaks over all steps,
and every printed value (each 10 ms for 39 s). The pier is `bart-berkeley` with `m = 1`, stepped by
the integrator of the kernel."""
WHY = """The same equations in the same steps: 1e-6 of the peak, although 0.1 % would do. The peaks
are printed with nine digits."""

NEEDS = ("data",)
FILES = ("oracles/dyn_elastic.csv", "oracles/dyn_hinge.csv")
TOLERANCE = 1e-6
RECORD, DT, GRAVITY = "RSN181_IMPVALLH1", 5e-4, 9.81
UNITS = {"u": "m", "theta1": "rad", "theta2": "rad", "M_base": "N m"}
PEAKS = {
    "elastic": {
        "u": 0.0162544026, "theta1": 0.000222437098, "theta2": 0.00445854795,
        "M_base": 8548702.53,
    },
    "bouc-wen": {
        "u": 0.0163325802, "theta1": 0.000311941668, "theta2": 0.00419818716,
        "M_base": 8483186.25,
    },
}  # fmt: skip


def compare(data: Path | None) -> Outcome:
    """March both hinges and hold them against the files."""
    motion = read_motion(paper_record(data, RECORD))
    assert data is not None
    results, pictures = [], []
    for hinge, file in zip(PEAKS, FILES, strict=True):
        pier = Pier.from_preset("bart-berkeley", {"hinge": hinge, "bouc_wen": {"m": 1.0}})
        expected = columns(data / file)
        time = DT * np.arange(1, round(expected["t"][-1] / DT) + 1)
        ground = np.interp(time, motion.time, motion.acceleration * (GRAVITY / STANDARD_GRAVITY))
        found = march_pier(pier, ground, DT)
        printed = np.rint(expected["t"][1:] / DT).astype(int) - 1
        for k, (name, unit) in enumerate(UNITS.items()):
            results += [
                relative(
                    f"{hinge}, {name}: peak", unit, reference=PEAKS[hinge][name],
                    ours=float(np.abs(found[:, k]).max()), tolerance=TOLERANCE,
                ),
                of_peak(
                    f"{hinge}, {name}: history", unit, reference=expected[name][1:],
                    ours=found[printed, k], tolerance=TOLERANCE,
                ),
            ]  # fmt: skip
        place = list(QUANTITIES).index("u")
        drawn = [
            ("displacement, mm", 1e3 * expected["u"][1:], 1e3 * found[printed, place]),
            ("base moment, MN m", 1e-6 * expected["M_base"][1:], 1e-6 * found[printed, 3]),
        ]
        pictures.append(
            Picture(
                hinge,
                f"The pier with its hinge {hinge} under RSN181: OpenSees, railquake over it, and "
                "the difference.",
                partial(write_histories, expected["t"][1:], drawn),
            )
        )
    return Outcome(tuple(results), tuple(pictures))
