"""Single runs: the start, supports, plain Python, what is refused."""

import numpy as np
import pytest

import railquake as rq
from railquake.inputs.ground_motion import GroundMotion
from railquake.march.compiler import PYTHON

SHORT = {"seed": 3, "duration": "2 s", "pga": "0.6 g", "highpass_frequency": "0.6 Hz"}


def at_rest(seconds=0.2):
    return GroundMotion("at rest", 0.01, np.zeros(round(seconds / 0.01) + 1))


def test_names_at_the_top_are_functions_also_after_their_modules_were_imported():

    for name in ("assemble", "assess", "simulate"):
        assert callable(getattr(rq, name))


def test_a_standing_train_stays_where_it_stands():
    response = rq.simulate(rq.scenario(motion=at_rest(), hinge="bouc-wen"))
    row = rq.assess(response)
    assert row["status"] == "safe"
    load = response.system.static_wheel_load
    for side in ("left", "right"):
        history = response.channel(f"wheel_load_{side}_n")
        assert history == pytest.approx(history[0], rel=1e-3)
    total = response.channel("wheel_load_left_n") + response.channel("wheel_load_right_n")
    assert total == pytest.approx(2.0 * load, rel=1e-4)
    displacement = response.channel("bridge_displacement_m")
    assert displacement[0] != 0.0  # the car stands off the pier's axis and bends it
    assert displacement == pytest.approx(displacement[0], rel=1e-3)


def test_uncompiled_physics_gives_the_same_answer():
    motion = GroundMotion("kick", 0.005, 6.0 * np.sin(np.arange(5.0)))
    case = rq.scenario(motion=motion, dt="2e-5 s")
    system = rq.assemble(case)
    compiled, plain = rq.simulate(system), rq.simulate(system, target=PYTHON)
    # everything but the fetched cells, whose order of evaluation the compiler chooses
    state = system.layout.state
    rows = np.r_[: state.CELL_BASE, state.FORCE_Y : len(plain.end)]
    scale = np.maximum(np.abs(plain.end[rows]), 1e-6)
    assert np.abs(compiled.end[rows] - plain.end[rows]).max() == pytest.approx(0.0, abs=1e-3)
    assert (np.abs(compiled.end[rows] - plain.end[rows]) / scale)[: state.U + 9].max() < 1e-9


def test_decoupled_pier_does_not_feel_the_train():
    case = rq.scenario(synthetic=SHORT, coupled=False)
    heavy = case.with_changes({"vehicle.bodies.car.mass": 40000.0})
    assert rq.assess(rq.simulate(case))["pbd_m"] == rq.assess(rq.simulate(heavy))["pbd_m"]


def test_at_grade_nothing_but_the_train_moves():
    row = rq.assess(rq.simulate(rq.scenario(support="at-grade", synthetic=SHORT)))
    assert row["pbd_m"] == row["pbv_m_s"] == row["hinge_rotation_peak_rad"] == 0.0
    assert row["lateral_force_peak_n"] > 1e4
    assert row["pba_m_s2"] == pytest.approx(row["pga_m_s2"], rel=1e-2)


def test_vertical_component_works_the_springs():
    motion = GroundMotion("still", 0.01, np.zeros(101))
    bounce = GroundMotion("bounce", 0.01, 2.0 * np.sin(6.5 * np.arange(101) * 0.01))
    still, bounced = (
        rq.simulate(rq.scenario(motion=motion, vertical=vertical, hinge="elastic"))
        for vertical in (None, bounce)
    )
    assert np.ptp(bounced.channel("wheel_load_left_n")) > 10.0 * np.ptp(
        still.channel("wheel_load_left_n")
    )


@pytest.mark.parametrize("speed", ["0.01 km/h", "240 km/h"])
def test_slow_and_fast_trains_run(speed):
    row = rq.assess(rq.simulate(rq.scenario(synthetic=SHORT, speed=speed)))
    assert row["status"] == "safe"
    assert abs(row["energy_residual"]) < 1e-3


def test_a_step_above_the_critical_one_is_refused():
    with pytest.raises(rq.InputError, match=r"solver\.dt: 0\.001 s is above the critical"):
        rq.assemble(rq.scenario(synthetic=SHORT, dt="1e-3 s"))


def test_a_step_that_would_never_end_is_refused():
    with pytest.raises(rq.InputError, match=r"solver\.dt: 1e-15 s takes"):
        rq.assemble(rq.scenario(synthetic=SHORT, dt="1e-15 s"))


def test_critical_step_falls_with_the_trains_speed():
    slow, fast = (
        rq.assemble(rq.scenario(synthetic=SHORT, speed=speed)).critical_dt
        for speed in ("0.01 km/h", "80 km/h")
    )
    assert slow < fast  # creep damping is f22 / V


def test_profiles_that_never_meet_are_refused():
    with pytest.raises(rq.InputError, match="never"):
        rq.assemble(
            rq.scenario(wheelrail={"preset": "bart", "running_circle": "3 m"}, synthetic=SHORT)
        )


def test_history_has_names_units_and_a_time_axis():
    response = rq.simulate(rq.scenario(synthetic=SHORT))
    history = response.history
    assert history["bridge_displacement_m"].attrs["units"] == "m"
    assert float(history["time_s"][-1]) == pytest.approx(2.0, abs=6e-3)
    assert response.steps == 200_000 or response.steps == 199_500


def test_peaks_are_at_least_those_of_the_history():
    response = rq.simulate(rq.scenario(synthetic=SHORT))
    row = rq.assess(response)
    for key, channel in (
        ("pbd_m", "bridge_displacement_m"),
        ("pbv_m_s", "bridge_velocity_m_s"),
        ("pba_m_s2", "bridge_acceleration_m_s2"),
        ("relative_roll_peak_rad", "relative_roll_rad"),
        ("lateral_shift_peak_m", "lateral_shift_m"),
    ):
        peak = np.abs(response.channel(channel)[1:]).max()
        assert peak <= row[key] * (1.0 + 1e-9)
        assert row[key] <= 1.05 * peak
