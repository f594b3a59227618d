"""Small studies for tests: motions of one second, a few milliseconds a run."""

from __future__ import annotations

from typing import Any

TIMINGS = ["wall_s", "steps_per_s"]
MOTION = {
    "seed": 3, "duration": "1 s", "dt": "0.01 s", "pga": "0.6 g", "highpass_frequency": "1.2 Hz",
}  # fmt: skip
BASE: dict[str, Any] = {
    "vehicle": {"preset": "bart", "speed": "80 km/h"},
    "support": {"preset": "bart-berkeley", "hinge": "elastic"},
    "wheelrail": {"preset": "bart"},
    "motion": {"synthetic": MOTION},
    "solver": {"dt": "5e-5 s"},
}
MODELS = [
    {"name": "coupled", "set": {"support.coupled": True}},
    {"name": "decoupled", "set": {"support.coupled": False}},
    {"name": "at-grade", "set": {"support.kind": "at-grade"}},
]


def tables(**axes: Any) -> dict[str, Any]:
    """Tables of a study: the base case and some axes."""
    return {"base": BASE, "axes": axes}


def small() -> dict[str, Any]:
    """Twelve runs of all kinds of columns."""
    return {
        "base": BASE,
        "suite": {
            "name": "two",
            "levels": {"low": 0.5, "high": 1.5},
            "members": [
                {"name": "a", "scale_factor": 1.0, "motion": {"synthetic": {**MOTION, "seed": 0}}},
                {"name": "b", "scale_factor": 2.0, "motion": {"synthetic": {**MOTION, "seed": 1}}},
            ],
        },
        "axes": {"model": MODELS},
    }  # fmt: skip


def many(seeds: int) -> dict[str, Any]:
    """Motions of one second, three models each; for kills."""
    return {
        "base": {**BASE, "solver": {"dt": "1e-5 s"}},
        "axes": {"motion.synthetic.seed": list(range(seeds)), "model": MODELS},
    }


def untimed(table: Any) -> Any:
    """The table without what differs from one execution to the next."""
    return table.drop(columns=TIMINGS).reset_index(drop=True)
