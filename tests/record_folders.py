"""Folders of records made of synthetic motions, for tests of suites."""

from pathlib import Path
from typing import Any

from railquake.inputs.ground_motion import STANDARD_GRAVITY, GroundMotion, synthetic_motion

SHORT: dict[str, Any] = {
    "duration": 8.0, "dt": 0.01, "pga": 0.3 * STANDARD_GRAVITY, "highpass_frequency": 0.3,
}  # fmt: skip


def short_motion(seed: int, **parameters: Any) -> GroundMotion:
    return synthetic_motion(SHORT | {"seed": seed} | parameters)


def write_at2(path: Path, motion: GroundMotion) -> Path:
    """Write a motion as PEER AT2."""
    values = "\n".join(f"{a / STANDARD_GRAVITY:.12E}" for a in motion.acceleration)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(
        "PEER NGA STRONG MOTION DATABASE RECORD\nmade for a test\n"
        "ACCELERATION TIME SERIES IN UNITS OF G\n"
        f"NPTS= {motion.npts}, DT= {motion.dt:.4f} SEC,\n{values}\n"
    )
    return path


def write_records(folder: Path, count: int) -> Path:
    """Write records of different frequency content."""
    for seed in range(1, count + 1):
        frequency = 0.8 + 0.35 * (seed % 9)
        write_at2(folder / f"r{seed:02d}.AT2", short_motion(seed, ground_frequency=frequency))
    return folder
