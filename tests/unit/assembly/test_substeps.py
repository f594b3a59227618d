"""Structure and sprung bodies take longer steps than the wheelset, where they are slow enough."""

import pytest

import railquake as rq

SHORT = {"seed": 3, "duration": "2 s", "pga": "0.6 g", "highpass_frequency": "0.6 Hz"}
LIGHT = {"preset": "bart-berkeley", "mass": "20 t", "rotational_inertia": "1e5 kg*m^2"}


def assembled(**inputs):
    return rq.assemble(rq.scenario(synthetic=SHORT, **inputs))


@pytest.mark.parametrize(
    ("what", "substeps"),
    [
        ({}, 10),
        ({"dt": "2e-5 s"}, 5),  # no longer than 1e-4 s
        ({"dt": "1e-4 s"}, 1),
        ({"speed": "10 km/h"}, 5),  # creep is stiffer the slower the train
        ({"speed": "0.01 km/h"}, 2),
        ({"history_step": "7e-5 s"}, 7),  # as many as divide a frame
        ({"support": LIGHT}, 5),  # a light pier bounces under the wheels
        ({"support": LIGHT, "speed": "0.01 km/h"}, 1),
        ({"support": {**LIGHT, "coupled": False}}, 10),  # but not if they do not press it
    ],
)
def test_they_are_as_many_as_leave_slow_what_must_be(what, substeps):
    system = assembled(**what)
    assert system.substeps == 1
    assert system.with_substeps(10).substeps == substeps
    assert system.with_substeps(1).substeps == 1
    assert assembled(**what, substeps=10).substeps == substeps


def test_the_time_step_stays():
    system = assembled()
    longer = system.with_substeps(4)
    assert longer.dt == system.dt
    assert longer.frame_steps == system.frame_steps
    assert longer.substeps == 4
    assert system.with_substeps(3).substeps == 2


def test_a_run_by_itself_takes_them_where_it_is_told():
    """With an elastic hinge hardly anything is lost."""
    alike, longer = (
        rq.assess(rq.simulate(assembled(hinge="elastic", **what)))
        for what in ({}, {"substeps": 10})
    )
    assert alike["pbd_m"] != longer["pbd_m"]
    for key in ("pbd_m", "pbv_m_s", "pba_m_s2", "uplift_ratio"):
        assert longer[key] == pytest.approx(alike[key], rel=1e-4), key
    assert longer["steps"] == alike["steps"]


@pytest.mark.parametrize("wrong", [0, 1.5, -2])
def test_their_number_is_whole_and_positive(wrong):
    with pytest.raises(rq.InputError, match="substeps"):
        rq.scenario(synthetic=SHORT, substeps=wrong)


def test_a_step_that_is_chosen_is_the_same_for_all():
    """The tolerance of ``dt = "auto"`` holds for the structure's step, too."""
    auto = rq.scenario(synthetic=SHORT, dt="auto")
    assert auto.with_step(1e-5).solver.substeps == 1
    told = auto.with_changes({"solver.substeps": 5})
    assert told.with_step(1e-5).solver.substeps == 5
