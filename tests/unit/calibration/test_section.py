"""Fibres of the section: areas and moments of area in closed form, confinement, squash load."""

import math

import numpy as np
import pytest

from railquake.calibration.column import Column, Concrete, Steel
from railquake.calibration.section import (
    confined_concrete,
    fibre_column,
    gross_area,
    gross_second_moment,
    squash_load,
    unconfined_concrete,
)
from railquake.errors import InputError

SECTION = {
    "diameter": "1.25 m",
    "cover": "50 mm",
    "longitudinal_ratio": 0.02,
    "transverse_ratio": 0.007,
}
CONCRETE = {"strength": "34.5 MPa"}
STEEL = {"yield_strength": "331 MPa", "hoop_strength": "331 MPa"}


def column(shape="octagonal", **changes):
    return Column(
        name="test", section={"shape": shape, **SECTION, **changes}, concrete=CONCRETE, steel=STEEL
    )


def polygon(diameter):
    """Area and second moment of a regular octagon across flats, by Green's theorem."""
    radius = 0.5 * diameter / math.cos(math.pi / 8.0)
    angle = math.pi / 8.0 + math.pi / 4.0 * np.arange(9)
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    cross = x[:-1] * y[1:] - x[1:] * y[:-1]
    second = cross * (y[:-1] ** 2 + y[:-1] * y[1:] + y[1:] ** 2)
    return 0.5 * cross.sum(), second.sum() / 12.0


@pytest.mark.parametrize("shape", ["octagonal", "circular"])
def test_gross_section_is_that_of_the_figure(shape):
    section = column(shape).section
    area, second = (
        polygon(1.25)
        if shape == "octagonal"
        else (math.pi / 4.0 * 1.25**2, math.pi / 64.0 * 1.25**4)
    )
    assert gross_area(section) == pytest.approx(area, rel=1e-12)
    assert gross_second_moment(section) == pytest.approx(second, rel=1e-12)


@pytest.mark.parametrize("shape", ["octagonal", "circular"])
def test_fibres_add_up_to_the_section(shape):
    whole = column(shape)
    fibres = fibre_column(whole, 6.0, 2.6e6)
    area = fibres.cover.area.sum() + fibres.core.area.sum() + fibres.bars.area.sum()
    assert area == pytest.approx(gross_area(whole.section), rel=1e-9)
    assert fibres.bars.area.sum() == pytest.approx(0.02 * area, rel=1e-12)
    # strips at their middles: the second moment is a little small
    second = sum((part.area * part.place**2).sum() for part in (fibres.cover, fibres.core))
    bars = fibres.bars
    concrete = gross_second_moment(whole.section) - second
    # what is missing is the concrete in the bars' place, spread over the core
    assert concrete == pytest.approx(bars.area.sum() * 1.15**2 / 16.0, rel=0.08)
    for part in (fibres.cover, fibres.core, bars):
        assert (part.area * part.place).sum() == pytest.approx(0.0, abs=1e-9)


def test_confinement_raises_strength_as_mander_computes():
    """Mander et al. (1988), their worked order of magnitude: 10 % lateral pressure gives 1.56."""
    steel = Steel(yield_strength=331e6, hoop_strength=331e6)
    concrete = Concrete(strength=30e6)
    ratio = 2.0 * 0.1 * 30e6 / (0.95 * 331e6)
    section = column(transverse_ratio=ratio).section
    law = confined_concrete(section, concrete, steel)
    assert law.strength / 30e6 == pytest.approx(1.5649, abs=2e-4)
    assert law.peak_strain == pytest.approx(0.002 * (1.0 + 5.0 * 0.5649), rel=1e-3)


def test_without_hoops_the_core_is_as_strong_as_the_cover():
    whole = column(transverse_ratio=1e-9)
    confined = confined_concrete(whole.section, whole.concrete, whole.steel)
    assert confined.strength == pytest.approx(
        unconfined_concrete(whole.concrete).strength, rel=1e-5
    )


def test_axial_load_beyond_the_squash_load_is_refused():
    whole = column()
    squash = squash_load(whole.section, whole.concrete, whole.steel)
    # ACI 318: 0.85 f'c (Ag - As) + fy As
    area = polygon(1.25)[0]
    assert squash == pytest.approx(0.85 * 34.5e6 * 0.98 * area + 331e6 * 0.02 * area)
    fibre_column(whole, 6.0, 0.99 * squash)
    with pytest.raises(InputError, match="cannot carry its axial load of .* kN: it is crushed at"):
        fibre_column(whole, 6.0, 1.01 * squash)


def test_bars_that_fill_the_core_are_refused():
    with pytest.raises(InputError, match="longitudinal_ratio: bars of .* fill half of the core"):
        fibre_column(column(longitudinal_ratio=0.14, cover="300 mm"), 6.0, 1e6)


def test_column_shorter_than_five_hinges_is_refused():
    with pytest.raises(InputError, match="more than a fifth of the column's 2 m"):
        fibre_column(column(), 2.0, 1e6)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"section": {"shape": "square", **SECTION}}, 'section.shape: must be "octagonal" or'),
        ({"section": {"shape": "circular", **SECTION, "cover": "0.5 m"}}, "section.cover: must be"),
        ({"section": {"shape": "circular", **SECTION, "diameter": "2 kN"}}, "must be a length"),
        ({"concrete": {"strength": 34.5}}, "concrete.strength: must be at least 5e"),
        ({"steel": {**STEEL, "yield_strength": "331 kPa"}}, "steel.yield_strength: must be at"),
        ({"protocol": {"drifts": [0.5, 1.0, 2.0]}}, "protocol.drifts: must be at most 0.15"),
        ({"axial_load": "2 MN", "axial_ratio": 0.1}, "give either axial_load or axial_ratio"),
        ({"colour": "grey"}, "colour: unknown key"),
    ],
)
def test_wrong_columns_are_refused_by_field(changes, message):
    table = {
        "name": "test",
        "section": {"shape": "octagonal", **SECTION},
        "concrete": CONCRETE,
        "steel": STEEL,
    }
    with pytest.raises(InputError) as error:
        Column(**{**table, **changes})
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_protocol_goes_to_each_drift_both_ways_and_home():
    protocol = column().protocol
    path = protocol.path()
    assert path[-1] == 0.0
    assert path.max() == max(protocol.drifts) and path.min() == -max(protocol.drifts)
    for drift in protocol.drifts:
        assert drift in np.round(path, 12) and -drift in np.round(path, 12)
    assert np.abs(np.diff(path, prepend=0.0)).max() < 1.5 * protocol.increment
