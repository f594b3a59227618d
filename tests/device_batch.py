"""A short batch on the CPU and under the CUDA simulator; `tests/unit/test_device.py` runs it.

The simulator is chosen when the process starts (NUMBA_ENABLE_CUDASIM=1), so it has one of its own.
"""

import json
import sys
import tempfile
from pathlib import Path

import numpy as np

import railquake as rq
from railquake.inputs.ground_motion import GroundMotion
from railquake.run import gpu, many
from railquake.run.assess import assess

DT = 0.005


def pulse(seconds, size, begin, turn):
    """An acceleration of this size and then its opposite, so that the velocity comes back to 0."""
    time = DT * np.arange(round(seconds / DT) + 1)
    there = np.where((time >= begin) & (time < turn), size, 0.0)
    return there - np.where((time >= turn) & (time < 2.0 * turn - begin), size, 0.0)


def case(hinge, side, seconds, **more):
    """The ground jerks sideways and drops away below the train, which falls back onto it."""
    return rq.scenario(
        motion=GroundMotion("side", DT, pulse(seconds, side, 0.005, 0.06)),
        vertical=GroundMotion("drop", DT, pulse(seconds, -200.0, 0.01, 0.03)),
        allow_high_pga=True,
        hinge=hinge,
        dt="1e-4 s",
        **more,
    )


def batch():
    """Two groups, each with more scenarios than lanes, of different lengths."""
    return [
        case("bouc-wen", 15.0, 0.16),
        case("elastic", 15.0, 0.12),
        case("bouc-wen", 15.0, 0.10, scale=0.5),
        case("elastic", 15.0, 0.12, scale=-1.0, vehicle="bart-2023-runs"),
        case("bouc-wen", 25.0, 0.12, scale=-1.0),
        case("elastic", 80.0, 0.16),
    ]


def rows(where):
    found = dict(many.simulate_many(batch(), threads=1, device=where))
    return [found[index] for index in range(len(found))]


def shared_motions():
    """Three systems with two motions; rows that were sent, and after many others came and went."""
    systems = [rq.assemble(case("elastic", 15.0, 0.1, scale=scale)) for scale in (1.0, 1.0, 0.5)]
    lanes = gpu.DeviceLanes(systems[0], 10)
    loaded = [lanes.load(lane, system) for lane, system in enumerate(systems)]
    first = lanes.motions.end
    for k in range(40):
        lanes.release(0)
        lanes.load(0, rq.assemble(case("elastic", 15.0, 0.1, scale=1.0 + 0.01 * (k + 1))))
    used = lanes.taken[1]
    kept = lanes.motions.drive[used.first : used.first + len(systems[1].drive)]
    return {
        "rows_of_a_motion": len(systems[0].drive),
        "rows": first,
        "shared": loaded[0].drive is loaded[1].drive and loaded[0].ground is loaded[1].ground,
        "rows_later": len(lanes.motions.drive),
        "still_there": bool(np.array_equal(kept, systems[1].drive)),
    }


def studies():
    """A study of the same laws and lengths, on the GPU and on the CPU."""
    study = rq.Study.from_dict(
        {
            "base": {
                "vehicle": {"preset": "bart"},
                "support": {"preset": "bart-berkeley"},
                "wheelrail": {"preset": "bart"},
                "motion": {"acceleration": list(pulse(0.08, 15.0, 0.005, 0.03)), "dt": DT},
                "solver": {"dt": "1e-4 s"},
            },
            "axes": {"support.hinge": ["elastic", "bouc-wen"], "motion.scale": [1.0, -0.5]},
        }
    )
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for where in ("cpu", "cuda"):
            table = study.run(Path(folder) / where, device=where)
            found[where] = table[["status", "pbd_m", "wheel_load_peak_n"]].to_dict("list")
    return found


if __name__ == "__main__":
    # the rows leave this loss out
    many.assess = lambda response: {**assess(response), "impact_j": response.audit.impact}
    # lanes are few, so that they are given the next scenario; chunks are short
    gpu.DeviceLanes.most = 2
    gpu.FIRST_LANES = 1
    gpu.CHUNK = 50
    answer = {"cpu": rows("cpu"), "cuda": rows("cuda")}
    gpu.DeviceLanes.most = 3
    answer["motions"] = shared_motions()
    answer["studies"] = studies()
    json.dump(answer, sys.stdout)
