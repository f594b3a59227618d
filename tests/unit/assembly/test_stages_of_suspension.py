"""Which bodies the stages of a suspension are between, and at what level."""

from itertools import pairwise

import pytest

import railquake as rq
from railquake.assembly.vehicle import vehicle_matrices
from railquake.inputs.vehicle import Body, Spring, Vehicle
from railquake.march.compiler import PYTHON
from railquake.validation.bodies import block, motion, pair_of


def body(name, mass, height):
    return Body(name=name, mass=mass, roll_inertia=mass, height=height)


def spring(name, bodies, direction="lateral", stiffness=1e6, heights=(0.5, 0.5), pair=True):
    return Spring(name=name, bodies=bodies, direction=direction, stiffness=stiffness, lateral=1.0,
                  heights=heights, pair=pair)  # fmt: skip


def stages(bodies, springs):
    """Names of upper and lower body, and the heights of both points above the rails."""
    upright = [spring(f"{s.name} up", s.bodies, "vertical") for s in springs]
    found = vehicle_matrices(
        Vehicle(name="own", bodies=bodies, springs=(*springs, *upright), axles=1, speed=0.0)
    )
    heights = {one.name: one.height for one in bodies}
    named = []
    for stage in found.stages:
        upper, lower = found.bodies[stage.upper], found.bodies[stage.lower]
        levels = heights[upper] - stage.tie.upper_z, heights[lower] - stage.tie.lower_z
        assert stage.gap == pytest.approx((0.0, levels[1] - levels[0]))
        named.append((upper, lower, *map(pytest.approx, levels)))
    return named


WHEELSET, FRAME, CAR = body("wheelset", 2e3, 0.5), body("frame", 3e3, 0.6), body("car", 3e4, 1.8)


def test_stages_go_upwards_from_the_wheelset_whatever_stands_first():
    """A body's own height of a spring whose ends differ: 0.9 m on the car, 0.8 m on the frame."""
    springs = (
        spring("above", ("frame", "car"), heights=(0.8, 0.9)),
        spring("below", ("wheelset", "frame"), heights=(0.5, 0.55)),
    )
    expected = [("frame", "wheelset", 0.55, 0.5), ("car", "frame", 0.9, 0.8)]
    assert stages((WHEELSET, CAR, FRAME), springs) == expected
    assert stages((CAR, FRAME, WHEELSET), springs[::-1]) == expected


def test_the_level_of_several_springs_is_where_their_force_acts():
    springs = (
        spring("one", ("car", "wheelset"), stiffness=3e6, heights=(0.6, 0.6)),
        spring("other", ("car", "wheelset"), stiffness=2e6, heights=(1.2, 1.2), pair=False),
    )
    level = (6.0 * 0.6 + 2.0 * 1.2) / 8.0
    assert stages((CAR, WHEELSET), springs) == [("car", "wheelset", level, level)]


def test_a_stage_leads_to_the_heaviest_body():
    """Not to a gear box on the wheelset, nor from the car back to its frame."""
    gear = body("gear", 5e2, 0.5)
    springs = (
        spring("gear", ("gear", "wheelset")),
        spring("below", ("frame", "wheelset")),
        spring("above", ("car", "frame")),
    )
    found = stages((gear, FRAME, CAR, WHEELSET), springs)
    assert [stage[:2] for stage in found] == [("frame", "wheelset"), ("car", "frame")]


TRAVELS = ("suspension_travel_peak_m", "primary_travel_peak_m", "secondary_travel_peak_m")


@pytest.mark.parametrize("bodies", [1, 2, 3])
def test_a_stage_that_a_vehicle_does_not_have_has_no_travel(bodies):
    """None, not zero: a car without a secondary suspension is not one whose travel is small."""
    height = 0.5
    car = block(2e3, 1e3, height)
    above = ("wheelset", "frame", "car")[:bodies]
    for lower, upper in pairwise(above):
        car["bodies"][upper] = {"mass": 3e3, "roll_inertia": 1e3, "height": height + 0.1}
        for direction in ("lateral", "vertical"):
            car.setdefault("springs", {})[f"{upper}-{direction}"] = {
                "bodies": [upper, lower], "direction": direction, "stiffness": 1e6,
                "lateral": 0.8, "height": height,
            }  # fmt: skip
    car["kinematics"] = "linear"
    case = rq.scenario(
        vehicle=car, support="at-grade", wheelrail=pair_of(height), contact="grid", dt=5e-5,
        motion=motion(1e-3, [0.0, 40.0, 40.0]), allow_high_pga=True,
    )  # fmt: skip
    row = rq.assess(rq.simulate(case, target=PYTHON))
    assert [row[key] is None for key in TRAVELS] == [bodies < 2, bodies < 2, bodies < 3]
    found = [row[key] for key in TRAVELS[1:bodies]]
    assert all(travel > 0.0 for travel in found)
    assert row[TRAVELS[0]] == max(found, default=None)
    # the uppermost body, which the ground has only begun to shake, is that of the roll
    assert row["body_acceleration_peak_m_s2"] > 0.0
