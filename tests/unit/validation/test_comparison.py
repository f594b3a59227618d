"""How a quantity is compared and judged."""

import math

import numpy as np
import pytest

from railquake.validation.comparison import absolute, at_most, of_peak, relative


def test_relative_difference_is_over_the_reference():
    result = relative("f", "Hz", reference=-2.0, ours=-2.1, tolerance=0.06)
    assert result.difference == pytest.approx(0.05)
    assert result.agrees and result.verdict == "agrees"
    assert relative("f", "Hz", reference=-2.0, ours=-2.1, tolerance=0.04).verdict == "outside"


def test_absolute_difference_is_in_the_values_unit():
    assert absolute("y", "mm", reference=-740.0, ours=-740.4, tolerance=0.5).agrees
    assert not absolute("y", "mm", reference=0.0, ours=-0.6, tolerance=0.5).agrees


def test_bound_is_itself_allowed():
    assert at_most("error", "", ours=0.024, bound=0.024).agrees
    assert not at_most("error", "", ours=0.0241, bound=0.024).agrees


def test_history_is_compared_at_every_value_over_the_references_peak():
    theirs = np.array([0.0, 1.0, -4.0, 1.0])
    result = of_peak(
        "u", "m", reference=theirs, ours=np.array([0.0, 1.0, -4.0, 1.2]), tolerance=0.1
    )
    assert result.difference == pytest.approx(0.05)
    assert (result.reference, result.ours) == (4.0, 4.0)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_what_is_no_number_never_agrees(value):
    assert not relative("f", "Hz", reference=1.0, ours=value, tolerance=1e9).agrees
    assert not relative("f", "Hz", reference=math.nan, ours=1.0, tolerance=1e9).agrees
    assert not at_most("error", "", ours=value, bound=1e9).agrees
    history = np.array([1.0, value])
    assert not of_peak("u", "", reference=np.ones(2), ours=history, tolerance=1e9).agrees


def test_comparisons_without_a_measure_are_refused():
    with pytest.raises(ValueError, match="relative to a reference of 0"):
        relative("f", "Hz", reference=0.0, ours=1.0, tolerance=0.1)
    with pytest.raises(ValueError, match="0 throughout"):
        of_peak("u", "m", reference=np.zeros(3), ours=np.zeros(3), tolerance=0.1)
    with pytest.raises(ValueError, match="shapes"):
        of_peak("u", "m", reference=np.ones(3), ours=np.ones(4), tolerance=0.1)
    with pytest.raises(ValueError, match="shapes"):
        of_peak("u", "m", reference=np.ones(0), ours=np.ones(0), tolerance=0.1)
    for tolerance in (math.nan, math.inf, -1.0):
        with pytest.raises(ValueError, match="tolerance"):
            at_most("error", "", ours=0.0, bound=tolerance)
