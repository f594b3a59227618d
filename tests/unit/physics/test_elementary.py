"""Elementary functions that a vector unit can do, against the library's."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from railquake.march import peaks
from railquake.march.compiler import SCALAR, bind
from railquake.physics import elementary


@given(st.floats(-1.0, 1.0))
def test_sine_and_cosine(x):
    assert elementary.sin_cos(x) == pytest.approx((math.sin(x), math.cos(x)), abs=3e-15)


@given(st.floats(-700.0, 700.0))
def test_exponential(x):
    expected = math.exp(x)
    assert elementary.exponential_polynomial(x) == pytest.approx(expected, rel=3e-13)


@given(st.floats(1e-12, 1e6), st.floats(0.1, 8.0))
def test_power(x, n):
    assert elementary.power_polynomial(x, n) == pytest.approx(x**n, rel=3e-13)


def test_nothing_to_a_power_is_next_to_nothing():
    assert elementary.power_polynomial(0.0, 1.28) < 1e-200
    assert elementary.power_polynomial(0.0, 0.0) == 1.0


def test_bits_compiled_are_the_bits_of_the_plain_functions():
    compiled = bind(elementary.power_polynomial, SCALAR).call
    for x in (1e-9, 0.3, 1.0, 7.5):
        assert compiled(x, 1.28) == pytest.approx(elementary.power_polynomial(x, 1.28), rel=1e-15)


@settings(deadline=None)  # the first call compiles
@given(st.floats(0.0, 1e300), st.floats(-1e300, 1e300))
def test_a_peak_is_raised_alike_compiled_and_plain(peak, value):
    for raise_peak in (peaks.raise_peak, bind(peaks.raise_peak, SCALAR).call):
        S = np.array([[peak]])
        raise_peak(S, 0, value, 0)
        assert S[0, 0] == max(peak, abs(value))
