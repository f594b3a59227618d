"""Faults planted in the march, and which check sees each: an audit, or only a comparison.

What has a wrong size or the wrong line of action on its way from the rails to the bodies, or among
them, breaks a balance of momentum.  A force that is wrong where it arises acts on both sides alike:
no balance can see it, and it is held against the equations written a second time
(`independent_model`).  The hinge's damping, another such, stands in `test_damping_of_the_pier`.
"""

from dataclasses import replace

import numpy as np
import pytest

import railquake as rq
from jolts import EVERY, FINE, FRAME, STORED, pushed, set_off
from railquake.assembly import system as assembled
from railquake.inputs.ground_motion import GroundMotion
from railquake.march.compiler import PYTHON
from railquake.march.contact import add_wheels
from railquake.march.rows import constant, state
from railquake.physics.creep import LinearForce, linear_force
from railquake.physics.joint import pull
from railquake.run.doubts import BARS

DT = 2e-5
STILL = GroundMotion("still", 0.01, np.zeros(4))  # 30 ms
# car, bogie, wheelset: y, z, phi; leaning over, so that its weight turns it farther
LEANT = np.array([0.03, 0.0, -0.02, 0.005, 0.0, -0.005, 0.0, 0.0, 0.0])
# of 30 degrees
COSINE, SINE = 0.8660254037844386, 0.5


@pytest.fixture
def planted(monkeypatch):
    """Runs a system, uncompiled, with other functions in the place of some."""
    bind = assembled.bind

    def run(system, faults):
        def faulty(entry, target, laws, layout):
            return bind(entry, target, {**laws, **faults}, layout)

        with monkeypatch.context() as patched:
            patched.setattr(assembled, "bind", faulty)
            return rq.simulate(system, target=PYTHON)

    return run


def leaning(vehicle):
    """A car at grade that is let go as it leans; nothing shakes it."""
    system = rq.assemble(
        rq.scenario(
            vehicle=vehicle, support="at-grade", motion=STILL, dt=5e-5, history_step=1e-3
        )
    )  # fmt: skip
    return set_off(system, LEANT, np.zeros(9))


# --- seen by an audit ---------------------------------------------------------------------------


def pull_along_the_bodies(at, force, moment):
    """Gravity's moment left out: what a joint bears at rest goes along with its points."""
    found = pull(at, force, moment)
    half = 0.5 * (force[0] * at.apart[1] - force[1] * at.apart[0])
    return found._replace(upper_roll=found.upper_roll - half, lower_roll=found.lower_roll - half)


def one_axle_turns(S, Q, lane):
    """`axles` forgotten in the moment on the wheelset."""
    moment = S[state.FORCE_PSI, lane]
    add_wheels(S, Q, lane)
    S[state.FORCE_PSI, lane] = moment
    S[state.WHEELSET_PHI, lane] = moment


def one_axle_bears(S, Q, lane):
    """`axles` forgotten in the loads."""
    for side in range(2):
        S[state.LOAD + side, lane] /= Q[constant.AXLES, lane]
    add_wheels(S, Q, lane)


def one_axle_guides(S, Q, lane):
    """`axles` forgotten in the lateral forces."""
    for side in range(2):
        S[state.LATERAL + side, lane] /= Q[constant.AXLES, lane]
    add_wheels(S, Q, lane)


@pytest.mark.parametrize("vehicle", ["bart", "bart-under-gravity"])
def test_without_a_fault_momentum_is_explained(planted, vehicle):
    """A linear car's own equations keep it to the last digits, finite turns to the second order."""
    momentum = planted(leaning(vehicle), {}).momentum
    assert momentum.linear_relative < 1e-10
    assert momentum.angular_relative < (1e-10 if vehicle == "bart" else 1e-6)


def test_angular_momentum_sees_gravity_s_moment_left_out(planted):
    found = planted(leaning("bart-under-gravity"), {pull: pull_along_the_bodies})
    assert found.momentum.angular_relative > 100.0 * BARS["angular_momentum_residual"]
    assert found.momentum.linear_relative < BARS["linear_momentum_residual"]


def test_the_moment_that_a_linear_car_leaves_out_is_told(planted):
    """Of its weight at its lean, over 30 ms: not small beside what its springs give."""
    linear, finite = (
        planted(leaning(vehicle), {}).momentum for vehicle in ("bart", "bart-under-gravity")
    )
    weights = 9.80665 * np.array([29600.0, 2 * 3621.0])
    start = 0.03 * weights @ LEANT[[0, 3]]
    assert linear.omitted_impulse == pytest.approx(start, rel=0.1)
    assert linear.omitted_relative > 0.1
    assert finite.omitted_impulse == 0.0


@pytest.mark.parametrize("vehicle", ["bart", "bart-under-gravity"])
@pytest.mark.parametrize(
    ("fault", "kind"),
    [(one_axle_turns, "angular"), (one_axle_bears, "linear"), (one_axle_guides, "linear")],
)
def test_momentum_sees_axles_forgotten_in_one_place(planted, vehicle, fault, kind):
    found = planted(leaning(vehicle), {add_wheels: fault})
    residual = getattr(found.momentum, f"{kind}_relative")
    assert residual > 100.0 * BARS[f"{kind}_momentum_residual"]
    assert abs(found.audit.whole_relative) < BARS["energy_residual"]  # which does not see it


def test_momentum_sees_axles_forgotten_at_assembly(planted):
    system = leaning("bart")
    constants = system.constants.copy()
    constants[constant.AXLES] = 1.0
    found = planted(replace(system, constants=constants), {}).momentum
    assert found.linear_relative > 100.0 * BARS["linear_momentum_residual"]
    assert found.angular_relative > 100.0 * BARS["angular_momentum_residual"]


@pytest.mark.parametrize("body", [0, 1, 2])
def test_momentum_sees_a_body_of_another_mass(planted, body):
    """A tenth lighter than it was said to be; the energy audit counts with the same mass."""
    system = leaning("bart")
    constants = system.constants.copy()
    constants[system.layout.constant.INVERSE_MASS + 2 * body] /= 0.9
    found = planted(replace(system, constants=constants), {})
    assert found.momentum.linear_relative > 10.0 * BARS["linear_momentum_residual"]
    assert abs(found.audit.whole_relative) < BARS["energy_residual"]


# --- seen by a comparison only ------------------------------------------------------------------


def spun_back(f11, f22, f23, creepages):
    """Spin's sign turned."""
    force = linear_force(f11, f22, f23, creepages)
    return LinearForce(force.along, force.creep, -force.spin)


def turned_aside(f11, f22, f23, creepages):
    """Friction turned by 30 degrees in the tangent plane."""
    force = linear_force(f11, f22, f23, creepages)
    across = force.creep + force.spin
    return LinearForce(
        COSINE * force.along - SINE * across,
        SINE * force.along + COSINE * across - force.spin,
        force.spin,
    )


def slippery(system):
    """With half of mu."""
    constants = system.constants.copy()
    constants[system.layout.constant.FRICTION] *= 0.5
    return replace(system, constants=constants)


def off(response, channel):
    """From the second writing, over its peak; 0.01 is what `test_jolts` allows."""
    expected = np.array(STORED["to the right"][channel])
    found = response.channel(channel)[:: round(EVERY * FINE / FRAME)]
    return np.abs(found - expected).max() / np.abs(expected).max()


@pytest.mark.parametrize(
    ("faults", "changed", "times"),
    [
        ({linear_force: spun_back}, lambda system: system, 10.0),
        ({linear_force: turned_aside}, lambda system: system, 5.0),
        ({}, slippery, 5.0),
    ],
    ids=["spin's sign", "friction's direction", "mu"],
)
def test_the_second_writing_sees_friction_that_no_balance_sees(planted, faults, changed, times):
    """The wheelset's roll is off by many times what is allowed; all balances hold as before."""
    sound = planted(pushed("to the right", DT), {})
    found = planted(changed(pushed("to the right", DT)), faults)
    assert off(sound, "relative_roll_rad") < 0.01
    assert off(found, "relative_roll_rad") > 0.01 * times
    assert abs(found.audit.whole_relative) < BARS["energy_residual"]
    assert abs(found.audit.gravity_relative) < BARS["gravity_work_residual"]
    assert found.momentum.linear_relative < BARS["linear_momentum_residual"]
    assert found.momentum.angular_relative < BARS["angular_momentum_residual"]
