"""Kernels of one process share what they have in common, and nothing else."""

import sys

import numpy as np
import pytest

from railquake.march.compiler import PYTHON, SCALAR, bind
from railquake.march.rows import layout_of, state
from railquake.physics.hinge import HINGE_LAWS

binding = sys.modules["railquake.march.compiler.bind"]
FACTOR = 3.0


def law(x):
    raise NotImplementedError


def doubled(x):
    return 2.0 * x


def squared(x):
    return x * x


def apart(x):
    return x + 1.0


def by_law(x):
    return law(x) + apart(x)


def entry(x):
    return by_law(x) + apart(x)


def scaled(x):
    return FACTOR * x


def entry_scaled(x):
    return scaled(x)


def read_last(S, lane):
    return S[state.HINGE_Z, lane]


def entry_rows(S):
    return read_last(S, 0)


@pytest.fixture
def compiled(monkeypatch, tmp_path):
    """Names of the called functions as they are compiled, in order; nothing was before."""
    monkeypatch.setenv("RAILQUAKE_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(binding, "_called", {})
    names = []
    compile_called = binding.cpu.compile_called

    def noted(function, lanes):
        names.append(function.__name__)
        return compile_called(function, lanes)

    monkeypatch.setattr(binding.cpu, "compile_called", noted)
    binding._bind_cached.cache_clear()
    yield names
    binding._bind_cached.cache_clear()


def test_another_law_leaves_what_does_not_depend_on_it(compiled):
    assert bind(entry, SCALAR, {law: doubled}).call(3.0) == 6.0 + 4.0 + 4.0
    assert bind(entry, SCALAR, {law: squared}).call(3.0) == 9.0 + 4.0 + 4.0
    assert sorted(compiled) == ["apart", "by_law", "by_law", "doubled", "squared"]


def test_a_constant_that_has_changed_is_seen(compiled, monkeypatch):
    assert bind(entry_scaled, SCALAR).call(2.0) == 6.0
    binding._bind_cached.cache_clear()
    monkeypatch.setitem(scaled.__globals__, "FACTOR", 5.0)
    monkeypatch.setenv("RAILQUAKE_CACHE_DIR", "/dev/null/nowhere")  # compiled code of the former
    assert bind(entry_scaled, SCALAR).call(2.0) == 10.0


def test_rows_at_other_places_are_read_there(compiled):
    usual, longer = (layout_of(HINGE_LAWS["bouc-wen"], bodies=bodies) for bodies in (3, 5))
    assert usual.state.HINGE_Z != longer.state.HINGE_Z
    for layout in (usual, longer, usual):
        S = np.arange(float(layout.size.STATE_ROWS)).reshape(-1, 1)
        for target in (PYTHON, SCALAR):
            assert bind(entry_rows, target, layout=layout).call(S) == layout.state.HINGE_Z
    assert compiled == ["read_last", "read_last"]
