"""Quantities: texts with units and bare numbers become SI, and nothing else gets through."""

import math
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.errors import InputError
from railquake.inputs.units import DIMENSIONS, to_si


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("6.0 m", "length", 6.0),
        ("0.25 inch", "length", 0.25 * 0.0254),
        ("-2 in", "length", -0.0508),
        ("15.4291 in", "length", 15.4291 * 0.0254),
        ("2 ft", "length", 0.6096),
        ("1435mm", "length", 1.435),
        ("80 km/h", "speed", 80 / 3.6),
        ("50 mph", "speed", 50 * 1609.344 / 3600),
        ("29.6 t", "mass", 29600.0),
        ("1.3312 MN/m", "stiffness", 1.3312e6),
        ("68.272 kN s/m", "damping", 68272.0),
        ("68.272 kN*s/m", "damping", 68272.0),
        ("3.2e4 kg m2", "roll inertia", 3.2e4),
        ("3.2e4 kg·m²", "roll inertia", 3.2e4),
        ("3.2e4 kg*m^2", "roll inertia", 3.2e4),
        ("3.2e4 kg m**2", "roll inertia", 3.2e4),
        ("0.1825 m4", "second moment of area", 0.1825),
        ("44.8 GPa", "pressure", 44.8e9),
        ("29000 ksi", "pressure", 29000 * 6894757.293168361),
        ("38.432 MN m", "moment", 38.432e6),
        ("1 kip-in", "moment", 4448.2216152605 * 0.0254),
        ("3.8432e10 N m/rad", "rotational stiffness", 3.8432e10),
        ("3.8432e10 N m", "rotational stiffness", 3.8432e10),
        ("180 deg", "angle", math.pi),
        ("10 mrad", "angle", 0.01),
        ("20 Hz", "frequency", 20.0),
        ("20 s-1", "frequency", 20.0),
        ("1 ms", "time", 1e-3),
        ("1e-5 s", "time", 1e-5),
        ("0.3 g", "acceleration", 0.3 * 9.80665),
        ("981 cm/s2", "acceleration", 9.81),
        ("981 Gal", "acceleration", 9.81),
        ("50 g", "mass", 0.05),
        ("2 %", "number", 0.02),
        ("1e-3", "number", 1e-3),
    ],
)
def test_texts_become_si(text, dimension, expected):
    assert to_si(text, dimension, "field") == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("value", "dimension", "found"),
    [
        ("7 s", "mass", "(a time)"),
        ("80 km", "speed", "(a length)"),
        ("7 rad", "length", "(an angle)"),
        ("7 rad/s", "frequency", "7 rad/s"),
        ("7 g", "length", "(a mass)"),
        ("0.3 m", "number", "(a length)"),
        ("7", "length", "without a unit"),
        ("m", "length", '"m"'),
        ("", "length", '""'),
        ("seven m", "length", "seven m"),
        ("7 furlongs", "length", 'unknown unit "furlongs"'),
        ("7 m**99", "length", "unknown unit"),
        ("7 m 5", "length", "unknown unit"),
        ("7 (m", "length", "unknown unit"),
        ("7 m/0", "length", "unknown unit"),
        ("7 __import__('os')", "length", "unknown unit"),
        ("1 m\n2 m", "length", "1 m 2 m"),
        (True, "mass", "True"),
        (None, "mass", "None"),
        ([1.0], "mass", "[1.0]"),
        (float("nan"), "mass", "nan"),
        (float("inf"), "mass", "inf"),
        ("1e999 kg", "mass", "1e999 kg"),
        (10**400, "mass", "digits"),
    ],
)
def test_wrong_values_are_refused_with_field_finding_and_example(value, dimension, found):
    with pytest.raises(InputError) as caught:
        to_si(value, dimension, "case.toml: vehicle.thing")
    message = str(caught.value)
    assert message.startswith("case.toml: vehicle.thing: ")
    assert found in message
    assert DIMENSIONS[dimension].example in message or "finite" in message
    assert "\n" not in message


@pytest.mark.parametrize(("value", "sign"), [(0, "positive"), ("-1 m", "positive"), (-1, "any")])
def test_signs(value, sign):
    if sign == "any":
        assert to_si(value, "length", "field", sign="any") == -1.0
        return
    with pytest.raises(InputError, match="must be positive"):
        to_si(value, "length", "field", sign="positive")
    with pytest.raises(InputError, match="zero or positive"):
        to_si("-1 m", "length", "field", sign="non-negative")


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_bare_numbers_are_si_as_they_stand(number):
    assert to_si(number, "length", "field") == number


@given(
    st.floats(min_value=-1e12, max_value=1e12),
    st.sampled_from(
        [("km/h", "speed", 1 / 3.6), ("MN/m", "stiffness", 1e6), ("in", "length", 0.0254)]
    ),
)
def test_number_times_factor(number, unit):
    name, dimension, factor = unit
    assert to_si(f"{number!r} {name}", dimension, "f") == pytest.approx(number * factor, rel=1e-12)


@given(
    st.one_of(
        st.text(max_size=80),
        st.from_regex(
            r"-?[0-9]{1,3}(\.[0-9]+)?(e[0-9]{1,2})? [A-Za-z0-9*/^ .()%-]{0,20}", fullmatch=True
        ),
        st.integers(),
        st.floats(),
        st.lists(st.integers(), max_size=2),
    ),
    st.sampled_from(sorted(DIMENSIONS)),
)
def test_anything_gives_a_finite_number_or_one_clear_line(value, dimension):
    try:
        number = to_si(value, dimension, "field")
    except InputError as error:
        message = str(error)
    else:
        message = "field: must be "
        assert math.isfinite(number)
    assert message.startswith("field: must be ")
    assert "\n" not in message


@pytest.mark.parametrize("dimension", sorted(DIMENSIONS))
def test_each_example_and_each_si_unit_is_accepted(dimension):
    kind = DIMENSIONS[dimension]
    assert to_si(kind.example, dimension, "field") > 0.0
    assert to_si(f"2 {kind.si_unit}", dimension, "field") == pytest.approx(2.0)


def test_heavy_libraries_wait_until_they_are_needed():
    code = (
        "import sys, railquake.inputs.scenario\n"
        "print([m for m in ('pint', 'numpy', 'scipy', 'xarray', 'numba') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
