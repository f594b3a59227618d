"""Cars that must end so, and their neighbours that must not: tipping over, sliding off, climbing.

Each is a car at grade whose ground says what it must do, by a formula that knows nothing of
wheel and rail beyond their angle and friction.
"""

import math

import numpy as np
import pytest

import railquake as rq
from railquake.physics.derailment import EVENTS, ONSET, OVERTURNED
from railquake.validation.bodies import GRAVITY, block, motion, pair_of

HALF = 0.8721217  # m, half the contact spacing of `bart`


def growing(share, seconds=8.0, hold=4.0):
    """Ground acceleration that grows to that share of gravity; to the right where positive."""
    time = np.arange(0.0, seconds + hold, 0.01)
    return motion(0.01, GRAVITY * share * np.minimum(time / seconds, 1.0))


# --- tipping over -------------------------------------------------------------------------------

NEARLY_RIGID = {
    "vehicle.springs.secondary-lateral.stiffness": "20 MN/m",
    "vehicle.springs.secondary-vertical.stiffness": "20 MN/m",
    "vehicle.springs.primary-lateral.stiffness": "200 MN/m",
    "vehicle.springs.primary-vertical.stiffness": "200 MN/m",
    "vehicle.anti_roll_bars.secondary.stiffness": "20 MN m/rad",
}


def tipped(share):
    case = rq.scenario(
        vehicle="bart-under-gravity", support="at-grade", motion=growing(share), dt=1e-5
    )
    return rq.simulate(case.with_changes(NEARLY_RIGID))


@pytest.fixture(scope="module")
def slowest():
    return tipped(0.52)


def test_a_nearly_rigid_car_lifts_where_its_weight_no_longer_holds_it(slowest):
    """g b/h of the whole car is 0.51 g; the suspension's sway takes a little of it."""
    lifts = slowest.happenings[1]
    assert lifts.event == "uplift"
    assert lifts.side == "right"  # the ground goes right, the car stays behind
    assert 0.50 < 0.52 * lifts.time_s / 8.0 < 0.52


def test_a_nearly_rigid_car_stays_below_that():
    assert tipped(0.49).status == "safe"


@pytest.mark.parametrize("share", [0.52, 0.6, 0.8, 1.2, -0.52, -0.8])
def test_every_stronger_ramp_tips_it_over_and_none_slides_it_off(slowest, share):
    response = slowest if share == 0.52 else tipped(share)
    assert response.derailment_mode == f"overturned {'left' if share > 0.0 else 'right'}"
    times = {one.event: one.time_s for one in response.happenings}
    assert times["uplift"] < times["onset"] < times["overturned"]
    over = next(one for one in response.happenings if one.event == EVENTS[OVERTURNED])
    assert abs(over.roll_rad) == pytest.approx(math.pi / 6.0, abs=0.01)
    # the bearing wheel is still on its rail, though its wheelset's centre is 0.3 m to the side
    assert abs(over.displacement_m) < 0.05
    assert response.beyond_model is None
    assert response.status == "derailed"


def test_the_sequence_is_told_in_sentences(slowest):
    told = slowest.explain()
    assert told == rq.assess(slowest)["sequence"]
    parts = told.rstrip(".").split("; ")
    assert [part.split(" s ", 1)[1] for part in parts] == [
        "the left flange touches its rail",
        "right wheels lift",
        "onset: the lifted right flange is above its rail",
        "overturns to the left",
    ]
    assert [float(part.split()[0]) for part in parts] == pytest.approx(
        [one.time_s for one in slowest.happenings if one.event != "flange over"][:4], abs=5e-3
    )


# --- sliding off --------------------------------------------------------------------------------


def pushed(back):
    """A low block on a narrow track: pushed until its right wheel is up, then to the right.

    Its left wheel bears on its tread alone and slides (friction 0.1); 0.4 m from the middle.
    """
    time = np.arange(0.0, 3.0, 0.005)
    share = np.select([time < 0.2, time < 0.35, time < 0.7], [0.0, 1.2, -back], 0.0)
    pair = pair_of(0.4, friction=0.1, running_circle=0.4, rail_centre=0.4)
    return rq.simulate(
        rq.scenario(
            vehicle=block(4000.0, 300.0, 0.4), wheelrail=pair, support="at-grade",
            motion=motion(0.005, GRAVITY * share), dt=2e-5,
        )
    )  # fmt: skip


def test_a_lifted_block_that_is_pushed_back_lands_on_its_rails():
    response = pushed(0.2)
    assert response.status == "onset"
    onset = next(one for one in response.happenings if one.event == EVENTS[ONSET])
    assert onset.side == "right"
    assert response.explain().endswith("back on both rails.")


@pytest.mark.parametrize("back", [0.3, 2.0, 3.0])
def test_pushed_a_little_harder_it_slides_off_over_the_flange_that_had_lifted(back):
    response = pushed(back)
    assert response.derailment_mode == "slide-off right"
    assert abs(response.happenings[-1].roll_rad) < math.radians(10.0)


# --- climbing -----------------------------------------------------------------------------------


def leaning(share, speed, friction, radius=0.1):
    """A block so low that it cannot tip, pressed to the right against its right flange."""
    car = {**block(4000.0, 1000.0, radius), "speed": speed}
    case = rq.scenario(
        vehicle=car, wheelrail=pair_of(radius, friction=friction), support="at-grade",
        motion=growing(-share), dt=2e-5,
    )  # fmt: skip
    return rq.simulate(case)


def push_at(coefficient, friction, radius=0.1):
    """Acceleration over gravity at which the right wheel's Y/Q is so much, by statics.

    Of the block (weight 1, centre of gravity at ``radius``): its left wheel, free of lateral load
    but for friction, bears what the moment leaves it.
    """
    # Q = 1/2 + a r/(2 b), Y = a - mu (1 - Q) = coefficient Q
    lever = radius / (2.0 * HALF)
    return (0.5 * (coefficient + friction)) / (1.0 - lever * (coefficient - friction))


STEEPEST = math.tan(math.radians(64.55))  # of the flange; `test_profiles`


def test_a_standing_wheel_climbs_where_y_over_q_is_above_its_limit_and_not_below():
    """It slides straight up its flank: friction holds it, Y/Q = (tan g + mu)/(1 - mu tan g)."""
    mu = 0.05
    limit = push_at((STEEPEST + mu) / (1.0 - mu * STEEPEST), mu)
    below, above = leaning(0.95 * limit, 0.0, mu), leaning(1.1 * limit, 0.0, mu)
    assert below.status == "safe"
    assert above.derailment_mode == "climb right"
    assert above.happenings[-1].event in ("climb", "uplift")


def test_a_rolling_wheel_climbs_between_nadals_limit_and_the_flank_alone():
    """Creep along the rail takes friction away from the flank; none holds or lifts it fully.

    Nadal: Y/Q = (tan g - mu)/(1 + mu tan g) with all friction lifting; tan g without any.
    """
    mu = 0.3
    nadal = push_at((STEEPEST - mu) / (1.0 + mu * STEEPEST), mu)
    alone = push_at(STEEPEST, mu)
    assert leaning(0.95 * nadal, 22.0, mu).status == "safe"
    assert leaning(1.05 * alone, 22.0, mu).derailment_mode == "climb right"
