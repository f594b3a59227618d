"""A car pushed aside steadily: what is measured of it, by d'Alembert's principle."""

import numpy as np
import pytest

import railquake as rq
from railquake.inputs.vehicle import Vehicle
from railquake.validation.bodies import motion

GROUND = 0.6  # m/s2
STIFFER = 10.0  # so that it comes to rest


@pytest.fixture(scope="module")
def pressed():
    """Car `bart`, well damped, under an acceleration that grows within 6 s and stays for 1 s."""
    plain = Vehicle.from_preset("bart")
    car = {
        "preset": "bart",
        "speed": 0.0,
        "springs": {s.name: {"stiffness": STIFFER * s.stiffness} for s in plain.springs},
        "dashpots": {d.name: {"damping": 8.0 * d.damping} for d in plain.dashpots},
    }
    time = np.arange(0.0, 7.01, 0.01)
    ground = 0.5 * GROUND * (1.0 - np.cos(np.pi * np.minimum(time / 6.0, 1.0)))
    case = rq.scenario(vehicle=car, support="at-grade", motion=motion(0.01, ground), dt=2e-5)
    return rq.simulate(case)


def test_measures_of_a_steady_push_are_those_of_statics(pressed):
    """Travel is what lies above a spring over its stiffness, and a body's roll the sum of both.

    A travel between centres of gravity in the place of the springs' level would be three times as
    large; a body's acceleration without the ground's would be none; a force of one side, half.
    """
    vehicle = pressed.system.scenario.vehicle
    mass = {body.name: body.mass for body in vehicle.bodies}
    height = {body.name: body.height for body in vehicle.bodies}
    of = {spring.name: spring for spring in vehicle.springs}
    row = rq.assess(pressed)

    push = GROUND * sum(mass.values())
    # what is left of the swing is 0.2 %
    assert row["lateral_force_sustained_peak_n"] == pytest.approx(push, rel=3e-3)
    assert row["lateral_force_tread_peak_n"] == pytest.approx(push, rel=5e-3)
    assert row["lateral_force_tread_peak_n"] == row["lateral_force_filtered_peak_n"]
    assert row["body_acceleration_peak_m_s2"] == pytest.approx(GROUND, rel=2e-2)

    above = {"primary": ("bogie", "car"), "secondary": ("car",)}
    roll = 0.0
    for stage, bodies in above.items():
        aside, upright = of[f"{stage}-lateral"], of[f"{stage}-vertical"]
        travel = GROUND * sum(mass[body] for body in bodies) / (2.0 * aside.stiffness)
        assert row[f"{stage}_travel_peak_m"] == pytest.approx(travel, rel=5e-3)
        moment = GROUND * sum(mass[b] * (height[b] - aside.height) for b in bodies)
        roll += moment / (2.0 * upright.stiffness * upright.lateral**2)
    assert row["body_roll_peak_rad"] == pytest.approx(roll, rel=1e-2)
    assert row["suspension_travel_peak_m"] == row["primary_travel_peak_m"]

    # the ground goes right, the load to the left wheels
    tilting = GROUND * sum(mass[body] * height[body] for body in mass)
    moved = tilting / (2.0 * pressed.system.scenario.wheelrail.running_circle)
    share = moved / pressed.system.static_wheel_load
    assert row["load_ratio_right_least"] == pytest.approx(1.0 - share, rel=5e-3)
    assert row["load_ratio_left_least"] == pytest.approx(1.0, abs=1e-3)
    assert row["wheel_unloading_peak"] == pytest.approx(share, rel=2e-2)


def test_no_wheel_climbs_under_a_steady_push(pressed):
    row = rq.assess(pressed)
    assert row["flange_climb_time_left_s"] == row["flange_climb_time_right_s"] == 0.0
    # both creep alike to the left; Hertz's contacts bear that as their loads to the power 2/3
    left = 2.0 - row["load_ratio_right_least"]
    shares = left ** (2.0 / 3.0) + (2.0 - left) ** (2.0 / 3.0)
    expected = 2.0 * GROUND / 9.80665 * left ** (-1.0 / 3.0) / shares
    assert row["flange_climb_left_peak"] == pytest.approx(expected, rel=2e-2)
    assert row["flange_climb_peak"] == row["flange_climb_left_peak"]
