"""What the ground and the track ask of a train: held against histories and response spectra."""

import numpy as np
import pytest

import railquake as rq
from railquake.inputs.ground_motion import (
    GroundMotion,
    jma_intensity,
    response_spectrum,
    spectral_intensity,
)
from railquake.measures import housner

MOTION = {"seed": 3, "duration": "8 s", "dt": "0.005 s", "pga": "0.6 g"}
# the track on the pier's axis and at its top, so that it moves as the top does
PIER = {"preset": "bart-berkeley", "track_offset": 0.0, "track_height": 0.0}
CASES = {
    "on a pier": {"support": PIER},
    "decoupled": {"support": {**PIER, "coupled": False}},
    "at grade": {"support": "at-grade"},
}


def case(name, **more):
    return rq.scenario(synthetic=MOTION, **CASES[name], **more)


@pytest.fixture(scope="module", params=CASES)
def run(request):
    return rq.simulate(case(request.param))


def track(response):
    """Absolute lateral acceleration of the track once a frame, and the ground's velocity there."""
    ground = response.system.ground
    velocity = np.interp(response.times, ground.time, ground.velocity())
    place = np.linspace(-1.0, 1.0, velocity.size)
    velocity -= velocity.mean() + place * (place @ velocity) / (place @ place)
    return response.channel("bridge_acceleration_m_s2"), velocity


def test_peak_velocity_of_the_track_is_that_of_ground_and_top_together(run):
    _, ground = track(run)
    expected = np.abs(ground + run.channel("bridge_velocity_m_s")).max()
    assert rq.assess(run)["track_velocity_peak_m_s"] == pytest.approx(expected, rel=2e-3)


def test_spectral_intensity_of_the_track_is_that_of_its_acceleration(run):
    acceleration, _ = track(run)
    motion = GroundMotion("track", 1e-3, acceleration)
    found = rq.assess(run)["si_track_m_s"]
    assert found == pytest.approx(spectral_intensity(motion), rel=5e-3)


def test_spectral_intensity_of_the_ground_is_the_mean_of_its_spectrum(run):
    """A spectrum in steps of 10 ms instead of 0.1 s."""
    periods = np.linspace(0.1, 2.5, 241)
    psv = response_spectrum(run.system.ground, periods, 0.2).psv
    expected = np.trapezoid(psv, periods) / 2.4
    assert rq.assess(run)["si_ground_m_s"] == pytest.approx(expected, rel=2e-3)


def test_at_grade_the_track_does_what_the_ground_does():
    row = rq.assess(rq.simulate(case("at grade")))
    assert row["track_velocity_peak_m_s"] == pytest.approx(row["pgv_m_s"], rel=2e-3)
    assert row["si_track_m_s"] == pytest.approx(row["si_ground_m_s"], rel=2e-3)


def test_a_track_at_a_height_moves_with_the_tops_rotation_too():
    support = {**PIER, "coupled": False, "track_height": "1.8 m"}
    row = rq.assess(rq.simulate(rq.scenario(synthetic=MOTION, support=support)))
    level = rq.assess(rq.simulate(case("decoupled")))
    assert row["pbv_m_s"] == pytest.approx(level["pbv_m_s"], rel=1e-9)
    assert row["track_velocity_peak_m_s"] > 1.1 * level["track_velocity_peak_m_s"]


@pytest.mark.parametrize("frame", ["5e-4 s", "2.5e-3 s"])
def test_frames_do_not_matter(frame):
    """Those that divide the motion's step, so that it stays the same motion."""
    usual, other = (
        rq.assess(rq.simulate(case("on a pier", history_step=step))) for step in ("1e-3 s", frame)
    )
    for key, tolerance in (("track_velocity_peak_m_s", 2e-4), ("si_track_m_s", 2e-3)):
        assert other[key] == pytest.approx(usual[key], rel=tolerance), key


def test_many_abreast_measure_the_same():
    rows = dict(rq.simulate_many([case(name) for name in CASES], threads=1))
    for k, name in enumerate(CASES):
        alone = rq.assess(rq.simulate(case(name)))
        for key in ("track_velocity_peak_m_s", "si_track_m_s", "si_ground_m_s", "jma_intensity"):
            assert rows[k][key] == pytest.approx(alone[key], rel=1e-3), (name, key)


def test_jmas_intensity_takes_the_vertical_motion_where_there_is_one():
    up = GroundMotion("up", 0.01, 5.0 * np.sin(12.0 * np.arange(0.0, 8.0, 0.01)))
    with_it = rq.scenario(synthetic=MOTION, vertical=up, support="at-grade")
    found = rq.assess(rq.simulate(with_it))["jma_intensity"]
    ground = with_it.ground_motion()
    assert found == pytest.approx(jma_intensity(ground, up))
    assert found > jma_intensity(ground)


def test_a_ground_at_rest_has_no_intensity(tmp_path):
    file = tmp_path / "track.csv"
    lines = [f"{0.01 * k:.2f},{0.02 * np.sin(0.06 * k):.9f}" for k in range(101)]
    file.write_text("t_s,y_m\n" + "\n".join(lines) + "\n", encoding="utf-8")
    response = rq.simulate(rq.scenario(support={"kind": "prescribed", "file": str(file)}))
    row = rq.assess(response)
    assert row["jma_intensity"] is None
    assert row["si_ground_m_s"] == 0.0
    # a sine of 6 rad/s and 20 mm, which moves from the first moment on
    assert row["track_velocity_peak_m_s"] == pytest.approx(0.12, rel=2e-3)
    assert row["si_track_m_s"] > 0.0
    assert len(housner.PERIODS) == 25
