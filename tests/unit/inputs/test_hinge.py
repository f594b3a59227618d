"""The hinge's valid ranges."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.errors import InputError
from railquake.inputs.hinge import BoucWenHinge
from railquake.inputs.support import Pier

VALUES = Pier.from_preset("bart-berkeley").bouc_wen.model_dump()


def test_the_shipped_hinge_has_the_published_values():
    expected = {
        "Fy": pytest.approx(38.432e6), "xu": 0.01, "alpha": 0.007, "k0": 3.8432e10, "n": 1.28,
        "eta0": 0.0, "beta0": 17000.0, "rho_eps": 0.0, "rho_x": 0.25, "phi": 1.6,
        "delta_k": 15.0, "delta_f": 0.5, "sigma": 0.01, "u": 4.0, "eps_p": 0.001, "rho_p": 0.1,
        "m": 262914.0,
    }  # fmt: skip
    assert expected == VALUES


@pytest.mark.parametrize(
    ("name", "bad"),
    [
        ("alpha", [0.0, 1.0, -0.1, 1.1]),
        ("n", [0.99, 0.0, -1.0]),
        ("beta0", [0.0, -1.0]),
        ("eta0", [-1.01, 1.01]),
        ("rho_p", [-0.01, 1.0, 2.0]),
        *((name, [0.0, -1.0]) for name in ("sigma", "eps_p", "xu", "Fy", "k0", "m")),
        *((name, [-1e-9]) for name in ("rho_eps", "rho_x", "phi", "delta_k", "delta_f", "u")),
    ],
)
def test_values_out_of_range_are_refused_by_name(name, bad):
    for value in [*bad, float("nan"), float("inf"), "three"]:
        with pytest.raises(InputError, match=rf"^BoucWenHinge: {name}: must be"):
            BoucWenHinge(**(VALUES | {name: value}))


@given(
    alpha=st.floats(1e-6, 1 - 1e-6),
    n=st.floats(1.0, 20.0),
    eta0=st.floats(-1.0, 1.0),
    rho_p=st.floats(0.0, 0.999),
    u=st.floats(0.0, 20.0),
)
def test_values_in_range_are_taken_as_they_are(**values):
    hinge = BoucWenHinge(**(VALUES | values))
    assert all(getattr(hinge, key) == value for key, value in values.items())


def test_units_of_the_hinge():
    hinge = BoucWenHinge(**(VALUES | {"Fy": "38.432 MN m", "k0": "38.432 GN m/rad", "m": "1 t"}))
    assert (hinge.Fy, hinge.m) == (pytest.approx(38.432e6), 1000.0)
    assert hinge.k0 == pytest.approx(3.8432e10)
    with pytest.raises(InputError, match="Fy: must be a moment"):
        BoucWenHinge(**(VALUES | {"Fy": "38.432 MN"}))


def test_missing_and_misspelt_parameters():
    with pytest.raises(InputError, match='k_0: unknown key; did you mean "k0"'):
        BoucWenHinge(**VALUES, k_0=1.0)
    with pytest.raises(InputError, match="beta0: missing"):
        BoucWenHinge(**{key: value for key, value in VALUES.items() if key != "beta0"})
