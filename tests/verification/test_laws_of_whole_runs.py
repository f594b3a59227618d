"""What must hold for any input: energy, linear range, mirrored input, time step."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import railquake as rq
from railquake.inputs.ground_motion import GroundMotion
from railquake.march.order import kernel_order
from railquake.march.sprung import vehicle_energy
from stages import stage

STILL = GroundMotion("still", 0.01, np.zeros(6))  # 50 ms
CENTRED = {"preset": "bart-berkeley", "track_offset": 0.0}
FEW = settings(max_examples=12, deadline=None)


@cache
def at_rest(dt=2e-5, **pier):
    return rq.assemble(
        rq.scenario(support={**CENTRED, **pier}, motion=STILL, dt=dt, history_step=1e-3)
    )


def thrown(system, speeds, pier):
    """The system with speeds given to its bodies and its pier, at rest otherwise."""
    s, state = system.start.copy(), system.layout.state
    place = state.VEHICLE_V + np.argsort(kernel_order(9))
    s[place, 0] += speeds
    s[state.U_V : state.U_V + 3, 0] += pier
    return replace(system, start=s)


@cache
def thrown_and_run(speeds, pier, dt=2e-5, hinge="bouc-wen"):
    return rq.simulate(thrown(at_rest(dt, hinge=hinge), np.array(speeds), np.array(pier)))


lateral, upward, roll = st.floats(-0.5, 0.5), st.floats(-0.2, 0.2), st.floats(-0.3, 0.3)
body = st.tuples(lateral, upward, roll)
throws = st.tuples(body, body, body).map(lambda b: sum(b, ()))
pushes = st.tuples(st.floats(-0.3, 0.3), st.just(0.0), st.floats(-0.02, 0.02))


@FEW
@given(throws, pushes)
def test_energy_never_grows_without_input(speeds, pier):
    """Of train, pier and springs together, less gravity's and spin's work, over the whole run.

    Impact, creep, dashpots, Rayleigh and hinge only take.  What the staggered coupling makes of it
    is held to a thousandth of the energy thrown in.
    """
    system = thrown(at_rest(), np.array(speeds), np.array(pier))
    audit = rq.simulate(system).audit
    energy = stage(system, vehicle_energy)
    thrown_in = energy(system.start, system.constants, 0)
    thrown_in -= energy(at_rest().start, system.constants, 0)
    thrown_in += 0.5 * 262914.0 * pier[0] ** 2 + 0.5 * 2075226.0 * pier[2] ** 2
    kept = audit.kinetic + audit.elastic + audit.hertz
    assert kept <= audit.gravity + audit.spin + 1e-3 * thrown_in + 1.0
    for lost in (audit.impact, audit.creep, audit.dashpots, audit.rayleigh):
        assert lost >= -1e-9
    assert abs(audit.whole_residual) < 1e-3 * thrown_in + 1.0


@FEW
@given(throws, pushes)
def test_a_mirrored_throw_gives_the_mirrored_motion(speeds, pier):
    turned = np.tile([-1.0, 1.0, -1.0], 3)
    there = thrown_and_run(speeds, pier)
    back = thrown_and_run(tuple(turned * speeds), tuple(-v for v in pier))
    for name, sign in (
        ("bridge_displacement_m", -1.0),
        ("hinge_rotation_rad", -1.0),
        ("lateral_shift_m", -1.0),
        ("relative_roll_rad", -1.0),
        ("car_vertical_m", 1.0),
        ("car_roll_rad", -1.0),
    ):
        one, other = there.channel(name), back.channel(name)
        assert np.abs(one - sign * other).max() <= 1e-7 * np.abs(one).max() + 1e-13, name


@FEW
@given(throws, pushes, st.floats(0.05, 0.5))
def test_response_scales_in_the_linear_range(speeds, pier, share):
    """Tiny speeds, an elastic hinge: the wheels stay on the treads and hardly slide."""
    tiny = 1e-4 * np.array(speeds)
    tiny_pier = 1e-4 * np.array(pier)
    whole = thrown_and_run(tuple(tiny), tuple(tiny_pier), hinge="elastic")
    part = thrown_and_run(tuple(share * tiny), tuple(share * tiny_pier), hinge="elastic")
    for name in ("bridge_displacement_m", "top_rotation_rad", "car_lateral_m", "car_vertical_m"):
        rest = whole.channel(name)[0]
        full, scaled = whole.channel(name) - rest, part.channel(name) - rest
        assert np.abs(scaled - share * full).max() <= 0.01 * share * np.abs(full).max() + 1e-12, (
            name
        )


@FEW
@given(throws, pushes)
def test_the_time_step_does_not_matter(speeds, pier):
    """Displacements at 2e-5 and 1e-5 s, within 1 % of the largest."""
    coarse = thrown_and_run(speeds, pier)
    fine = thrown_and_run(speeds, pier, dt=1e-5)
    for name in ("bridge_displacement_m", "car_lateral_m", "wheelset_lateral_m"):
        one, other = coarse.channel(name), fine.channel(name)
        assert np.abs(one - other).max() <= 0.01 * np.abs(other).max() + 1e-7, name


@pytest.mark.parametrize("seconds", [0.05])
def test_nothing_moves_without_input(seconds):
    response = rq.simulate(at_rest())
    for name in ("bridge_displacement_m", "lateral_shift_m", "relative_roll_rad"):
        history = response.channel(name)
        assert np.abs(history - history[0]).max() < 1e-9
