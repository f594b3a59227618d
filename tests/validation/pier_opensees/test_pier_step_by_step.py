"""The pier's integrator, step by step, against OpenSees and the exact solution (see readme.md)."""

import numpy as np
import pytest

from railquake.assembly.statics import UNKNOWN_DEGRADATION
from railquake.assembly.system import hinge_parameters
from railquake.inputs.motion import read_motion
from railquake.inputs.support import Pier
from railquake.physics import boucwen, constant, newmark, pier, state
from railquake.physics.kernel import SCALAR, bind
from reference_numbers import columns, reference
from suite_files import record_path

NUMBERS = reference(__file__)
QUANTITIES = {"u": state.U, "theta1": state.THETA1, "theta2": state.THETA2, "M_base": state.MOMENT}
UPPER = np.triu_indices(3)


def preset(m=1.0, **changes):
    bouc_wen = Pier.from_preset("bart-berkeley").bouc_wen.model_dump()
    return Pier.from_preset("bart-berkeley", {"bouc_wen": {**bouc_wen, "m": m}, **changes})


def matrices(column, ratio=0.02):
    mass = np.array([column.mass, column.base_rotational_inertia, column.rotational_inertia])
    bare = pier.stiffness_matrix(
        column.youngs_modulus, column.second_moment_of_area, column.length, 0.0
    )
    initial = bare + np.diag([0.0, column.bouc_wen.k0, 0.0])
    return mass, pier.rayleigh_damping(mass, initial, ratio), bare, initial


def march(column, hinge, ground, dt):
    """States after every step, the ground's acceleration being given at their ends."""
    mass, damping, bare, _ = matrices(column)
    q = np.zeros((constant.VEHICLE, 1))
    q[constant.DT], q[constant.RATE] = dt, 1.0 / dt
    q[constant.PIER_LOAD] = column.mass
    q[constant.M_U : constant.M_U + 3, 0] = mass
    q[constant.K : constant.K + 6, 0] = bare[UPPER]
    q[constant.C : constant.C + 6, 0] = damping[UPPER]
    effective = newmark.effective_matrix(np.diag(mass), damping, bare, dt)
    q[constant.FLEX : constant.FLEX + 6, 0] = np.linalg.inv(effective)[UPPER]
    parameters = hinge_parameters(column.bouc_wen, 1e-6, 50)
    q[constant.K0 : constant.K0 + len(parameters), 0] = parameters
    s = np.zeros((state.VEHICLE, 1))
    s[state.DAMAGE : state.DAMAGE + 5, 0] = UNKNOWN_DEGRADATION
    laws = {boucwen.advance: boucwen.advance_elastic} if hinge == "elastic" else {}
    step = bind(pier.move_structure, SCALAR, laws).call
    rows = list(QUANTITIES.values())
    found = np.empty((len(ground), len(rows)))
    for k, acceleration in enumerate(ground):
        s[state.GROUND, 0] = acceleration
        step(s, q, 0)
        found[k] = s[rows, 0]
    assert s[state.UNCONVERGED, 0] == 0.0
    return found


@pytest.mark.parametrize("hinge", ["elastic", "bouc-wen"])
def test_history_and_peaks_are_those_of_opensees(shared, hinge):
    numbers = NUMBERS[hinge]
    dt = NUMBERS["dt_s"]
    motion = read_motion(record_path(shared, "RSN181_IMPVALLH1"))
    expected = columns(shared / "oracles" / numbers["file"])
    time = dt * np.arange(1, round(expected["t"][-1] / dt) + 1)
    ground = np.interp(time, motion.time, motion.acceleration * (NUMBERS["g_m_s2"] / 9.80665))
    found = march(preset(), hinge, ground, dt)
    printed = np.rint(expected["t"][1:] / dt).astype(int) - 1
    for k, name in enumerate(QUANTITIES):
        peak = np.abs(found[:, k]).max()
        assert peak == pytest.approx(abs(numbers["peaks"][name]), rel=NUMBERS["peak_tolerance"])
        error = np.abs(found[printed, k] - expected[name][1:]).max()
        assert error < NUMBERS["history_tolerance"] * peak, name


def exact(column, ground, frame):
    """Displacements at the frames' ends: modes under a load that is linear in each frame."""
    mass, _, _, stiffness = matrices(column)
    root = 1.0 / np.sqrt(mass)
    values, vectors = np.linalg.eigh(stiffness * np.outer(root, root))
    shapes = root[:, None] * vectors
    omega = np.sqrt(values)
    a = 2.0 * 0.02 * omega[0] * omega[1] / (omega[0] + omega[1])
    b = 2.0 * 0.02 / (omega[0] + omega[1])
    found = np.zeros((len(ground), 3))
    for k in range(3):
        w2, c = values[k], a + b * values[k]
        load = -shapes[0, k] * mass[0] * ground
        roots = np.roots([1.0, c, w2]).astype(complex)
        x = v = 0.0
        for n in range(1, len(ground)):
            p, r = load[n - 1], (load[n] - load[n - 1]) / frame
            # particular solution r t / w2 + p0, then the free motion of the rest
            p0 = p / w2 - c * r / w2**2
            free = np.linalg.solve(
                np.array([[1.0, 1.0], roots]), np.array([x - p0, v - r / w2], dtype=complex)
            )
            later = free * np.exp(roots * frame)
            x = later.sum().real + p0 + r * frame / w2
            v = (later * roots).sum().real + r / w2
            found[n] += shapes[:, k] * x
    return found


def test_elastic_pier_converges_to_the_exact_motion_with_second_order():
    """Three modes well within reach of the step: a base inertia as large as the top's."""
    column = preset(base_rotational_inertia=2.0e6)
    frame = 0.01
    # smooth, since a jump of the load at the start would be felt at every order
    shape = 3.0 * np.sin(np.arange(61) * 0.25) * np.sin(np.arange(61) * np.pi / 60.0)
    expected = exact(column, shape, frame)
    errors = []
    for steps in (40, 80, 160):
        time = frame / steps * np.arange(1, 60 * steps + 1)
        ground = np.interp(time, frame * np.arange(61), shape)
        found = march(column, "elastic", ground, frame / steps)[steps - 1 :: steps, :3]
        errors.append(np.abs(found - expected[1:]).max(axis=0))
    assert np.all(errors[-1] < 1e-3 * np.abs(expected).max(axis=0))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.05)
