"""Single stages of a step by themselves: identities that hold to the last digits."""

import numpy as np
import pytest

from jolts import pushed
from railquake.march import contact, ground, sprung, structure, track, wheelset
from railquake.march.order import kernel_order
from railquake.march.rows import constant, state
from railquake.physics.hinge import bouc_wen
from stages import stage

DT = 2e-5


@pytest.fixture(scope="module")
def system():
    return pushed("to the right", DT)


@pytest.mark.parametrize("damping_of", ["column", "initial", "tangent"])
def test_structure_keeps_its_energy_to_the_last_digits(damping_of):
    """Constant average acceleration with trapezoids: work in = kinetic + elastic + hinge + lost."""
    system = pushed("to the right", DT, damping_of=damping_of)
    s, q = system.start.copy(), system.constants
    drawn = np.random.default_rng(2)
    k = q[constant.K : constant.K + 6, 0]
    c = q[constant.C : constant.C + 6, 0]
    mass = q[constant.MASS : constant.MASS + 3, 0]
    stiffness, damping = (
        np.array([[m[0], m[1], m[2]], [m[1], m[3], m[4]], [m[2], m[4], m[5]]]) for m in (k, c)
    )
    move_ground = stage(system, ground.move_ground)
    move_structure = stage(system, structure.move_structure)
    s[state.U_V : state.U_V + 3, 0] = drawn.normal(size=3) * (0.3, 0.2, 0.1)
    s[state.GROUND], s[state.GROUND_SLOPE] = 5.0, 0.7
    x, v = s[state.U : state.U + 3, 0].copy(), s[state.U_V : state.U_V + 3, 0].copy()
    node = np.array([s[state.NODE_U, 0], 0.0, s[state.NODE_THETA2, 0]])
    own, per_tangent = system.structure.hinge_damping
    s[state.DAMPING_MOMENT] = (own + per_tangent * s[state.TANGENT, 0]) * v[1]
    foot = s[state.MOMENT, 0] + s[state.DAMPING_MOMENT, 0]
    load = node - np.array([q[constant.GROUND_LOAD, 0] * 5.0, foot, 0.0])
    s[state.U_A : state.U_A + 3, 0] = (load - stiffness @ x - damping @ v) / mass

    def energy():
        x, v = s[state.U : state.U + 3, 0], s[state.U_V : state.U_V + 3, 0]
        return 0.5 * v @ (mass * v) + 0.5 * x @ stiffness @ x

    begun, before, work = energy(), x, 0.0
    for _ in range(40):
        move_ground(s, q, 0)
        move_structure(s, q, 0)
        x = s[state.U : state.U + 3, 0].copy()
        work += node @ (x - before)
        before = x
    given = work + s[state.WORK_GROUND, 0]
    kept = energy() - begun + s[state.HINGE_ENERGY, 0] + s[state.LOST_RAYLEIGH, 0]
    assert s[state.LOST_RAYLEIGH, 0] > 0.0
    assert kept == pytest.approx(given, abs=1e-9 * (abs(begun) + abs(given)))
    # and it is in balance at the end
    end = s[state.U_V : state.U_V + 3, 0], s[state.U_A : state.U_A + 3, 0]
    left = mass * end[1] + damping @ end[0] + stiffness @ x - node
    foot = s[state.MOMENT, 0] + s[state.DAMPING_MOMENT, 0]
    left += (q[constant.GROUND_LOAD, 0] * s[state.GROUND, 0], foot, 0.0)
    assert np.abs(left).max() < 1e-6 * np.abs(stiffness @ x).max()
    assert s[state.UNCONVERGED, 0] == 0.0


@pytest.mark.parametrize("tangent", [3e10, -2e9])
def test_damping_of_the_tangent_takes_the_hinges_own_at_the_steps_begin(tangent):
    """None where the hinge's moment falls as it turns: a dashpot never gives."""
    system = pushed("to the right", DT, damping_of="tangent")
    s, q = system.start.copy(), system.constants
    s[state.TANGENT] = tangent
    stage(system, structure.move_structure)(s, q, 0)
    expected = system.structure.hinge_damping.per_tangent * max(tangent, 0.0)
    assert s[state.DAMPING_MOMENT, 0] == pytest.approx(expected * s[state.THETA1_V, 0])
    assert s[state.TANGENT, 0] not in (0.0, tangent)


def test_an_elastic_hinge_is_damped_alike_by_its_initial_and_its_tangent_stiffness():
    ends = []
    for damping_of in ("initial", "tangent"):
        system = pushed("to the left, elastic", DT, damping_of=damping_of)
        s = system.start.copy()
        s[state.GROUND] = 500.0
        for _ in range(10):
            stage(system, structure.move_structure)(s, system.constants, 0)
        ends.append(s[:, 0])
    assert ends[0] == pytest.approx(ends[1], rel=1e-9, abs=1e-15)
    assert abs(ends[0][state.DAMPING_MOMENT]) > 1e3


def test_ground_and_gravity_work_on_the_steps_of_the_bodies(system):
    s, q = np.zeros_like(system.start), system.constants
    steps = np.random.default_rng(4).normal(size=9)
    s[state.VEHICLE_STEP : state.VEHICLE_STEP + 9, 0] = steps
    s[[state.GROUND, state.GROUND_SLOPE, state.GROUND_Z, state.GROUND_Z_SLOPE], 0] = (
        3.0,
        0.4,
        2.0,
        0.6,
    )
    s[state.DASHPOT_POWER] = 9.0
    # the wheelset has come by its steps from where it set off
    s[state.VEHICLE_X + np.array([4, 8]), 0] = 0.3, -0.2
    stage(system, wheelset.keep_place)(s, 0)
    s[state.VEHICLE_X + np.array([4, 8]), 0] += steps[[4, 8]]
    stage(system, sprung.work_on_bodies)(s, q, 0)
    mass = system.vehicle.mass[0::3]
    lateral, down = mass @ steps[0:6:2], mass @ steps[6:]
    # the ground's mean over the step that has just passed
    assert s[state.WORK_GROUND, 0] == pytest.approx(-(3.0 - 0.2) * lateral - (2.0 - 0.3) * down)
    assert s[state.WORK_GRAVITY, 0] == pytest.approx(9.80665 * down)
    assert s[state.DASHPOT_POWER_OLD, 0] == 9.0
    assert s[state.DASHPOT_POWER, 0] == 0.0


def test_accelerations_are_those_of_the_equations_of_motion(system):
    """Eq. 1, row by row, against its matrices; and the dashpots' power."""
    s, q, matrices = system.start.copy(), system.constants, system.vehicle
    drawn = np.random.default_rng(6).normal(size=18)
    order = kernel_order(9)
    s[state.VEHICLE_X : state.VEHICLE_X + 9, 0] = drawn[:9]
    s[state.VEHICLE_V : state.VEHICLE_V + 9, 0] = drawn[9:]
    s[state.GROUND], s[state.GROUND_Z] = 1.5, -0.5
    s[state.DASHPOT_POWER] = 0.0
    s[[state.WHEELSET_Y, state.WHEELSET_Z, state.WHEELSET_PHI], 0] = 1e4, -2e4, 3e3
    x, v = np.empty(9), np.empty(9)
    x[order], v[order] = drawn[:9], drawn[9:]
    lateral = stage(system, sprung.accelerate_lateral)
    vertical = stage(system, sprung.accelerate_vertical)
    for i in range(6):
        lateral(s, q, i, 0)
    for i in range(6, 9):
        vertical(s, q, i, 0)
    s[state.DASHPOT_POWER_OLD] = 3.0
    stage(system, sprung.lose_to_dashpots)(s, q, 0)
    s[state.WHEELSET_FORCE_OLD : state.WHEELSET_FORCE_OLD + 3, 0] = 5e3, 4e3, -1e3
    wheelset_steps = np.array([1e-3, -2e-3, 3e-3])
    s[state.VEHICLE_STEP + np.array([4, 8, 5]), 0] = wheelset_steps
    stage(system, wheelset.keep_suspension)(s, q, 0)
    stage(system, wheelset.push_wheelset)(s, q, 0)
    expected = -(matrices.stiffness @ x + matrices.damping @ v)
    expected[-3:] += 1e4, -2e4, 3e3
    expected /= matrices.mass
    expected[0::3] -= 1.5
    expected[1::3] += 9.80665 + 0.5
    assert s[state.VEHICLE_A : state.VEHICLE_A + 9, 0] == pytest.approx(expected[order])
    power = v @ matrices.damping @ v
    assert s[state.LOST_DASHPOTS, 0] == pytest.approx(0.5 * DT * (3.0 + power))
    mean = 0.5 * np.array([5e3 + 1e4, 4e3 - 2e4, -1e3 + 3e3])
    assert s[state.WORK_VEHICLE, 0] == pytest.approx(mean @ wheelset_steps)
    kept = s[state.WHEELSET_FORCE_OLD : state.WHEELSET_FORCE_OLD + 3, 0]
    assert kept.tolist() == [1e4, -2e4, 3e3]


@pytest.mark.parametrize("substeps", [1, 5])
def test_reaction_is_the_contact_force_one_time_step_before(system, substeps):
    """Carried on linearly over the rest of the structure's step; the one before is kept."""
    system = system.with_substeps(substeps)
    s, q = system.start.copy(), system.constants
    s[[state.ARM_Y, state.ARM_Z], 0] = 0.02, -0.4
    rows = slice(state.TRACK_FY, state.TRACK_FY + 3)
    load_track = stage(system, track.load_track)
    found = []
    for share in (1.0, 1.5):
        on_wheelset = share * np.array([1e4, -2e4, 3e3])
        s[[state.WHEELSET_Y, state.WHEELSET_Z, state.WHEELSET_PHI], 0] = on_wheelset
        load_track(s, q, 0)
        found.append(s[rows, 0].copy())
    contact = -np.array([1e4, -2e4, 3e3 + 0.02 * -2e4 + 0.4 * 1e4])
    assert found[1] == pytest.approx((1.5 + 0.5 * (substeps - 1) / substeps) * contact)
    kept = s[state.TRACK_FORCE_OLD : state.TRACK_FORCE_OLD + 3, 0]
    assert kept.tolist() == found[0].tolist()


@pytest.mark.parametrize("substeps", [1, 5])
def test_track_gets_to_where_the_structure_has_moved(system, substeps):
    """At Newmark's own constant acceleration; its roll's sine and cosine go along."""
    system = system.with_substeps(substeps)
    s, q = system.start.copy(), system.constants
    s[state.U_V : state.U_V + 3, 0] = 0.3, 0.2, 0.4
    s[state.WORK_TRACK] = 0.0
    old, new = np.array([1.0, 2.0, 3.0]), np.array([40.0, 50.0, 60.0])
    stage(system, track.place_track)(s, q, 0)
    stage(system, track.orient_track)(s, 0)
    begun = s[state.TRACK_Y : state.TRACK_Y + 3, 0].copy()
    stage(system, structure.move_structure)(s, q, 0)
    s[state.TRACK_FORCE_OLD : state.TRACK_FORCE_OLD + 3, 0] = old
    s[state.TRACK_FY : state.TRACK_FY + 3, 0] = new
    stage(system, track.lead_track)(s, q, 0)
    move_track = stage(system, track.move_track)
    for _ in range(substeps):
        move_track(s, q, 0)
    on_node = stage(system, track.track_on_node)
    wanted = np.array([*on_node(s, q, state.STRUCTURE_X, 0), *on_node(s, q, state.STRUCTURE_V, 0)])
    assert s[state.TRACK_Y : state.TRACK_Y + 6, 0] == pytest.approx(wanted, rel=1e-10, abs=1e-16)
    assert s[state.WORK_TRACK, 0] == pytest.approx(0.5 * (old + new) @ (wanted[:3] - begun))
    roll = s[state.TRACK_PHI, 0]
    assert s[state.TRACK_SIN, 0] == pytest.approx(np.sin(roll), rel=1e-14)
    assert s[state.TRACK_COS, 0] == pytest.approx(np.cos(roll), rel=1e-14)


def test_suspension_is_carried_on_between_its_evaluations(system):
    """Linearly, by what it has changed since the one before; evaluated, it is what it is."""
    system = system.with_substeps(5)
    s, q = system.start.copy(), system.constants
    rows = state.VEHICLE_A + np.array([4, 8, 5])  # y, z, phi
    free = slice(state.WHEELSET_FREE, state.WHEELSET_FREE + 3)
    keep, carry_on = (
        stage(system, one) for one in (wheelset.keep_suspension, wheelset.carry_suspension_on)
    )
    for value in (1.0, 3.0):
        s[rows, 0] = value * np.array([1.0, -2.0, 4.0])
        keep(s, q, 0)
        assert s[free, 0] == pytest.approx(s[rows, 0])
    for n in range(1, 5):
        carry_on(s, 0)
        assert s[free, 0] == pytest.approx((3.0 + 0.4 * n) * np.array([1.0, -2.0, 4.0]))


def test_wheels_of_a_section_act_together(system):
    """Forces and powers of the patches of one axle, times the axles, in ground axes too."""
    s, q = np.zeros_like(system.start), system.constants
    axles = q[constant.AXLES, 0]
    s[state.ON_TRACK] = 1.0
    s[[state.TRACK_SIN, state.TRACK_COS], 0] = 0.6, 0.8
    powers = [state.HERTZ_ENERGY, state.IMPACT_POWER, state.CREEP_POWER, state.SPIN_POWER]
    powers.append(state.FORWARD_POWER)
    s[powers, 0] = 1.0, 2.0, 3.0, 4.0, 5.0
    sides = [state.LOAD_LEFT, state.LOAD_RIGHT, state.LATERAL_LEFT, state.LATERAL_RIGHT]
    s[sides, 0] = 10.0, 20.0, 5.0, -7.0
    s[state.FORCE_PSI] = 9.0
    add_wheels = stage(system, contact.add_wheels)
    add_wheels(s, q, 0)
    assert s[powers, 0].tolist() == [axles * k for k in (1.0, 2.0, 3.0, 4.0, 5.0)]
    assert s[sides, 0].tolist() == [10.0 * axles, 20.0 * axles, 5.0 * axles, -7.0 * axles]
    forces = s[state.FORCE_Y : state.FORCE_PSI + 1, 0]
    assert forces.tolist() == [2.0 * axles, -30.0 * axles, 9.0 * axles]  # on the wheelset
    turned = s[state.WHEELSET_Y : state.WHEELSET_PHI + 1, 0]
    assert turned == pytest.approx(
        axles * np.array([0.8 * 2.0 + 0.6 * 30.0, 0.6 * 2.0 - 0.8 * 30.0, 9.0])
    )
    s[state.ON_TRACK] = 0.0
    add_wheels(s, q, 0)
    assert not s[[*powers, *sides, state.WHEELSET_Y, state.WHEELSET_Z, state.WHEELSET_PHI]].any()


def test_what_the_patches_add_up_begins_at_nothing(system):
    s = system.start.copy()
    sums = np.r_[
        state.FORCE_PSI : state.FORWARD_POWER + 1, state.LOAD_LEFT : state.LATERAL_RIGHT + 1
    ]
    sums = np.r_[sums, state.AXLE_MOMENT, state.AXLE_DAMPING]
    s[sums] = 7.0
    stage(system, contact.clear_forces)(s, 0)
    assert not s[sums].any()


def test_one_iteration_is_one_newton_correction(system):
    """z - f/f', f' by differences; so is the linearised law, whatever is left."""
    h = system.scenario.support.bouc_wen
    parameters = bouc_wen.parameters(h, 1e-12, 1)._replace(tolerance=0.0, max_iterations=1.0)
    x, z, eps, x_max = 2e-4, 1.2e-4, 1e-4, 3e-4
    free, flexibility = 2e-4, 2e-11
    pinching = {"rho_p": h.rho_p, "per_sigma": 1 / h.sigma, "u": h.u, "per_eps_p": 1 / h.eps_p}
    kp = bouc_wen.pinched_stiffness(x, eps, parameters._replace(**pinching))

    def rest(guess):
        dx = free - flexibility * (h.alpha * kp * x + (1 - h.alpha) * kp * guess)
        dx /= 1.0 + flexibility * h.alpha * kp
        reach = max(x_max, abs(x + dx))
        new = eps + (1 - h.alpha) * kp * guess * dx / h.m
        d = h.rho_eps * h.m * new / (h.Fy * h.xu) + h.rho_x * reach / h.xu
        a = np.exp(-h.delta_k * d * np.exp(-h.phi * d))
        beta = h.beta0 * a * np.exp(h.n * h.delta_f * d)
        sign = np.sign(dx * guess)
        return guess - z - (a - beta * abs(guess) ** h.n * (h.eta0 + sign)) * dx

    step = 1e-9
    slope = (rest(z + step) - rest(z - step)) / (2.0 * step)
    expected = z - rest(z) / slope
    begun = bouc_wen.LAW.virgin._replace(z=z, eps=eps, x_max=x_max)
    for law in (bouc_wen.advance, bouc_wen.advance_linearised):
        found = law(x, begun, parameters, free, flexibility)
        assert found.state.z - z == pytest.approx(expected - z, rel=1e-5)


@pytest.mark.parametrize(("iterations", "missed"), [(1.0, 3.0), (50.0, 0.0)])
def test_steps_whose_hinge_does_not_converge_are_counted(system, iterations, missed):
    s, q = system.start.copy(), system.constants.copy()
    q[constant.HINGE_TOLERANCE], q[constant.HINGE_MAX_ITERATIONS] = 1e-13, iterations
    s[state.GROUND] = 900.0
    move_structure = stage(system, structure.move_structure)
    for _ in range(3):
        move_structure(s, q, 0)
    assert s[state.UNCONVERGED, 0] == missed
