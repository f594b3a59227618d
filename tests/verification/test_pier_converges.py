"""The elastic pier against its exact motion: modes under a piecewise linear load, closed form."""

import numpy as np
import pytest

from railquake.inputs.support import Pier
from railquake.validation.structure import march_pier, pier_matrices


def exact(column, ground, frame):
    """Displacements at the frames' ends: modes under a load that is linear in each frame."""
    mass, _, _, stiffness = pier_matrices(column)
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
    column = Pier.from_preset(
        "bart-berkeley", {"hinge": "elastic", "base_rotational_inertia": 2.0e6}
    )
    frame = 0.01
    # smooth, since a jump of the load at the start would be felt at every order
    shape = 3.0 * np.sin(np.arange(61) * 0.25) * np.sin(np.arange(61) * np.pi / 60.0)
    expected = exact(column, shape, frame)
    errors = []
    for steps in (40, 80, 160):
        time = frame / steps * np.arange(1, 60 * steps + 1)
        ground = np.interp(time, frame * np.arange(61), shape)
        found = march_pier(column, ground, frame / steps)[steps - 1 :: steps, :3]
        errors.append(np.abs(found - expected[1:]).max(axis=0))
    assert np.all(errors[-1] < 1e-3 * np.abs(expected).max(axis=0))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.05)
