"""Hazard targets: the numbers of the built-in ones, their interpolation, files of the user's."""

import hashlib
from pathlib import Path

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.ground_motion import STANDARD_GRAVITY
from railquake.suite import hazard_names, load_hazard, read_hazard

LEVELS = {0.5: 0.21, 0.1: 0.74, 0.05: 1.0, 0.02: 1.38}
"""Factors relative to 5 % in 50 years of Gomez and DeJong's study, by probability of exceedance."""

CURVE = """# Source: somebody,
#   in two lines
# NOTE: made up
period_s,sa_poe10_50yr_g,sa_poe2.5_50yr_g
0.1,0.5,1.0
1.0,0.05,0.2
"""


def refused(name: str | Path, poe: float = 0.1) -> str:
    with pytest.raises(InputError) as caught:
        load_hazard(name, poe)
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_both_sites_of_berkeley_are_built_in_with_source_and_note() -> None:
    assert hazard_names() == ("berkeley", "berkeley-rock")
    for name in hazard_names():
        hazard = read_hazard(name)
        assert tuple(hazard.curves) == (0.5, 0.1, 0.05, 0.02)
        assert "OpenSHA" in hazard.source and "NGA-West2" in hazard.source
        assert "INTERPOLATED" in hazard.note
    assert "HYBRID" in read_hazard("berkeley").note and "270" in read_hazard("berkeley").note
    assert "HYBRID" not in read_hazard("berkeley-rock").note


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("berkeley", "berkeley_uhs_vs30_270_hybrid.csv"),
        ("berkeley-rock", "berkeley_uhs_vs30_733.csv"),
    ],
)
def test_built_in_ordinates_are_those_of_the_reference_data(
    name: str, file: str, shared: Path
) -> None:
    lines = (shared / "hazard" / file).read_text().splitlines()
    rows = np.array([[float(c) for c in line.split(",")] for line in lines if line[0].isdigit()])
    hazard = read_hazard(name)
    np.testing.assert_array_equal(hazard.periods, rows[:, 0])
    for column, poe in enumerate((0.5, 0.1, 0.05, 0.02), 1):
        np.testing.assert_allclose(hazard.curves[poe] / STANDARD_GRAVITY, rows[:, column], 1e-14)


def test_a_curve_goes_through_its_points_and_is_straight_in_log_log_between() -> None:
    target = load_hazard("berkeley", 0.05)
    np.testing.assert_allclose(target.at(target.periods), target.ordinates, rtol=1e-13)
    between = np.sqrt(0.4 * 0.5)
    assert target.at(between) == pytest.approx(
        STANDARD_GRAVITY * np.sqrt(1.4378 * 1.3907), rel=1e-13
    )


def test_beyond_the_curve_nothing_is_made_up() -> None:
    target = load_hazard("berkeley", 0.05)
    for period in (0.005, 12.0):
        with pytest.raises(InputError, match=r"from 0\.01 to 10 s; .* s is outside"):
            target.at([1.0, period])


def test_curves_cannot_be_changed() -> None:
    target = load_hazard("berkeley", 0.05)
    with pytest.raises(ValueError, match="read-only"):
        target.ordinates[0] = 1.0


def test_the_factors_of_the_four_levels_are_ratios_of_ordinates_at_long_periods() -> None:
    """Not at the pier's period, 0.411 s: there the hazard's levels lie closer together."""
    hazard = read_hazard("berkeley")
    reference = hazard.target(0.05)

    def ratio(poe: float, period: float) -> float:
        return float(hazard.target(poe).at(period) / reference.at(period))

    assert ratio(0.1, 1.0) == pytest.approx(LEVELS[0.1], abs=0.005)
    assert ratio(0.02, 1.0) == pytest.approx(LEVELS[0.02], abs=0.005)
    assert ratio(0.5, 2.0) == pytest.approx(LEVELS[0.5], abs=0.005)
    at_the_pier = [ratio(poe, 0.411) for poe in LEVELS]
    np.testing.assert_allclose(at_the_pier, [0.342, 0.790, 1.0, 1.290], atol=0.001)


def test_unknown_names_and_levels_are_refused_with_those_there_are() -> None:
    assert "known are berkeley, berkeley-rock" in refused("unknown")
    assert "did you mean berkeley?" in refused("berkely")
    assert "known are 0.5, 0.1, 0.05, 0.02" in refused("berkeley", 0.03)
    assert "cannot be read" in refused("not-there.csv")


def test_a_file_in_the_same_layout_works(tmp_path: Path) -> None:
    path = tmp_path / "mine.csv"
    path.write_text(CURVE)
    hazard = read_hazard(path)
    assert (hazard.name, hazard.source, hazard.note) == (
        "mine", "somebody, in two lines", "NOTE: made up",
    )  # fmt: skip
    assert hazard.target(0.025).at(1.0) == pytest.approx(0.2 * STANDARD_GRAVITY)
    assert load_hazard(path, 0.1).at(np.sqrt(0.1)) == pytest.approx(
        STANDARD_GRAVITY * np.sqrt(0.5 * 0.05)
    )


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (CURVE, "", "is empty"),
        ("1.0,0.05,0.2\n", "", "holds 1 rows"),
        ("period_s", "T", "line 4: the first column must be period_s"),
        ("sa_poe10_50yr_g", "sa_10", "line 4: column \"sa_10\": sa_poe10_50yr_g is expected"),
        ("sa_poe10_50yr_g", "sa_poe2.5_50yr_g", "the level is there twice"),
        (",sa_poe10_50yr_g,sa_poe2.5_50yr_g", "", "line 4: no curve"),
        ("0.1,0.5,1.0", "0.1,0.5", "line 5: 2 cells under 3 columns"),
        ("0.1,0.5,1.0", "0.1,0.5,x", "line 5: \"x\": a finite number over zero"),
        ("0.1,0.5,1.0", "0.1,0.5,-1", "line 5: \"-1\": a finite number over zero"),
        ("0.1,0.5,1.0", "0.1,inf,1", "line 5: \"inf\": a finite number over zero"),
        ("1.0,0.05", "0.1,0.05", "line 6: period_s: 0.1 does not exceed 0.1"),
    ],
)  # fmt: skip
def test_a_wrong_file_is_refused_with_its_line(
    tmp_path: Path, old: str, new: str, told: str
) -> None:
    path = tmp_path / "mine.csv"
    path.write_text(CURVE.replace(old, new))
    message = refused(path)
    assert message.startswith(str(path)) and told in message


def test_the_paper_suite_ships_the_reference_numbers(shared: Path) -> None:
    """Files, RSN, stations and factors of the reference manifest, remarks apart."""
    from railquake.suite.built_in import _data

    ours = [line for line in _data("paper_suite.csv").splitlines() if not line.startswith("#")]
    theirs = (shared / "records" / "paper_suite" / "manifest.csv").read_text().splitlines()
    digest = [hashlib.sha256("\n".join(lines).encode()).hexdigest() for lines in (ours, theirs)]
    assert digest[0] == digest[1]
