"""Laws that whole runs must keep: the same answer by other ways, smaller steps, mirrored input."""

import numpy as np
import pytest

import railquake as rq
from suite_files import record_path, scale_factor, strong_part

RECORDS = (
    "RSN006_IMPVALLH2",
    "RSN161_IMPVALLH2",
    "RSN174_IMPVALLH1",
    "RSN180_IMPVALLH1",
    "RSN183_IMPVALLH1",
)


def measured(shared, record, level, **inputs):
    """PBD, PBV and uplift ratio of the 12 s around the record's peak."""
    motion = strong_part(record_path(shared, record), before=4.0, after=8.0)
    case = rq.scenario(motion=motion, scale=level * scale_factor(shared, record), **inputs)
    row = rq.assess(rq.simulate(case))
    return np.array([row["pbd_m"], row["pbv_m_s"], row["uplift_ratio"]])


@pytest.mark.parametrize("level", [1.0, 1.38])
@pytest.mark.parametrize("record", RECORDS)
def test_table_and_grid_agree(shared, record, level):
    table = measured(shared, record, level, contact="table")
    grid = measured(shared, record, level, contact="grid")
    assert np.all(np.abs(table / grid - 1.0) < (0.005, 0.005, 0.02))


@pytest.mark.parametrize("hinge", ["elastic", "bouc-wen"])
@pytest.mark.parametrize("record", RECORDS)
def test_halving_the_time_step_leaves_displacement_and_velocity(shared, record, hinge):
    coarse = measured(shared, record, 1.0, hinge=hinge, dt="2e-5 s")
    fine = measured(shared, record, 1.0, hinge=hinge, dt="1e-5 s")
    assert np.all(np.abs(coarse / fine - 1.0)[:2] < 0.005)


@pytest.mark.parametrize("hinge", ["elastic", "bouc-wen"])
def test_a_mirrored_record_gives_the_mirrored_response(shared, hinge):
    motion = strong_part(record_path(shared, "RSN183_IMPVALLH1"), before=2.0, after=3.0)
    pier = {"preset": "bart-berkeley", "track_offset": "0 m", "hinge": hinge}
    right, left = (
        rq.simulate(rq.scenario(support=pier, motion=motion, scale=sign * 2.5))
        for sign in (1.0, -1.0)
    )
    assert right.channel("relative_roll_rad").max() > 1e-4  # the flanges do meet the rails
    for name in (
        "bridge_displacement_m",
        "hinge_rotation_rad",
        "lateral_shift_m",
        "relative_roll_rad",
        "lateral_force_n",
    ):
        there, back = right.channel(name), left.channel(name)
        assert np.abs(there + back).max() < 1e-6 * np.abs(there).max(), name
    assert right.channel("wheel_load_left_n") == pytest.approx(
        left.channel("wheel_load_right_n"), rel=1e-6, abs=1.0
    )
