"""A track whose motion is known: followed exactly, whatever the frames."""

import numpy as np
import pytest

import railquake as rq
from railquake.march import ground, structure, track
from railquake.march.compiler import PYTHON
from railquake.march.rows import constant, size, state
from railquake.march.slots import chosen


def polynomials(t):
    """y, z, roll of a track: cubics, which a cubic within a frame gives exactly."""
    y = 2e-3 + 0.4 * t - 30.0 * t**2 + 900.0 * t**3
    z = -1e-3 + 0.1 * t + 10.0 * t**2 - 500.0 * t**3
    roll = 1e-3 - 0.2 * t + 6.0 * t**2 + 200.0 * t**3
    return np.array([y, z, roll])


def slopes(t):
    y = 0.4 - 60.0 * t + 2700.0 * t**2
    z = 0.1 + 20.0 * t - 1500.0 * t**2
    roll = -0.2 + 12.0 * t + 600.0 * t**2
    return np.array([y, z, roll])


STEPS, DT = 4, 2.5e-4
ENDS = STEPS * DT * np.arange(4)


def drive():
    track, rates = polynomials(ENDS), slopes(ENDS)
    lateral = np.array([0.0, 8.0, 4.0, 6.0])
    velocity = 0.5 + STEPS * DT * np.array([0.0, 4.0, 10.0, 15.0])
    ground = np.array([lateral, [1.0, 3.0, -1.0, 0.0], velocity])
    columns = [*ground, *(v for pair in zip(track, rates, strict=True) for v in pair)]
    return np.column_stack(columns)


@pytest.mark.parametrize("substeps", [1, 2])
def test_position_velocity_and_work_at_every_step(substeps):
    stages = chosen({"structure": "prescribed"})
    s = np.zeros((size.STATE_ROWS, 1))
    q = np.zeros((size.CONSTANT_ROWS, 1))
    q[constant.FRAME_STEPS], q[constant.DT], q[constant.SUBSTEPS] = STEPS, DT, substeps
    q[constant.RATE] = 1.0 / (substeps * DT)
    force = np.array([3.0, -5.0, 7.0])
    s[state.TRACK_FORCE_OLD : state.TRACK_FORCE_OLD + 3, 0] = 0.5 * force
    s[state.TRACK_FY : state.TRACK_FY + 3, 0] = 1.5 * force
    before = polynomials(0.0)
    for frame in range(3):
        stages[ground.begin_frame](s, q, drive(), frame, 0)
        begun = drive()[frame, 2] + slopes(ENDS[frame])[0]
        assert s[state.TRACK_V_BEGUN, 0] == pytest.approx(begun)
        for n in range(0, STEPS, substeps):
            ground.move_ground(s, q, 0)
            stages[track.place_track](s, q, 0)
            t = DT * (frame * STEPS + n)
            assert s[state.TRACK_Y : state.TRACK_Y + 3, 0] == pytest.approx(before, abs=1e-12)
            assert s[state.TRACK_VY : state.TRACK_VY + 3, 0] == pytest.approx(slopes(t), abs=1e-9)
            stages[structure.move_structure](s, q, 0)
            s[state.WORK_TRACK] = 0.0
            stages[track.lead_track](s, q, 0)
            for _ in range(substeps):
                track.move_track(s, q, 0)
            t = DT * (frame * STEPS + n + substeps)
            now = polynomials(t)
            # on the way at constant acceleration: the cubic's third part is 900 h^3/2
            there = s[state.TRACK_Y : state.TRACK_Y + 3, 0]
            assert there == pytest.approx(now, abs=500.0 * (substeps * DT) ** 3)
            assert s[state.TRACK_VY : state.TRACK_VY + 3, 0] == pytest.approx(slopes(t), abs=1e-9)
            assert s[state.WORK_TRACK, 0] == pytest.approx(force @ (now - before), abs=1e-12)
            before = now
            # what the bridge's measures show
            assert s[state.U, 0] == pytest.approx(now[0], abs=1e-12)
            assert s[state.U_V, 0] == pytest.approx(slopes(t)[0], abs=1e-9)
            assert s[state.U_A, 0] == pytest.approx(-60.0 + 5400.0 * t, abs=1e-6)
            assert s[state.THETA2, 0] == pytest.approx(-now[2], abs=1e-12)
            assert s[state.THETA2_V, 0] == pytest.approx(-slopes(t)[2], abs=1e-9)
            # and the ground, linear within the frame
            lateral = np.interp(t, ENDS, drive()[:, 0])
            assert s[state.GROUND, 0] == pytest.approx(lateral)
            if n + substeps == STEPS:
                assert s[state.GROUND_V, 0] == pytest.approx(drive()[frame + 1, 2])
            assert s[state.GROUND_Z, 0] == pytest.approx(np.interp(t, ENDS, drive()[:, 1]))


def test_a_wheelset_on_a_track_that_sinks_evenly_keeps_its_load(tmp_path):
    """Even sinking, from rest in a moving frame: only the jump of the start is felt, and dies."""
    time = np.arange(0.0, 0.0051, 1e-3)
    table = np.column_stack([time, np.zeros_like(time), 1e-4 * np.ones_like(time), 0.0 * time])
    file = tmp_path / "track.csv"
    lines = ["t_s,y_m,z_m,roll_rad", *(",".join(f"{v:.9g}" for v in row) for row in table)]
    file.write_text("\n".join(lines))
    case = rq.scenario(support={"kind": "prescribed", "file": str(file)}, dt="2e-5 s")
    response = rq.simulate(case, target=PYTHON)
    loads = response.channel("wheel_load_left_n")
    assert loads == pytest.approx(loads[0], rel=1e-6)
    assert response.channel("track_vertical_m") == pytest.approx(1e-4)
