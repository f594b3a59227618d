"""Spectra of suites and Sa(T) of single motions."""

from pathlib import Path

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.ground_motion import response_spectrum
from railquake.inputs.scenario import scenario
from railquake.plots.suite import write_suite_picture
from railquake.suite import (
    Suite,
    SuiteMember,
    load_hazard,
    spectral_acceleration,
    suite_spectra,
)
from record_folders import SHORT, short_motion


def member(seed: int, factor: float) -> SuiteMember:
    return SuiteMember(f"m{seed}", {"synthetic": SHORT | {"seed": seed}}, factor)


def test_spectra_are_those_of_the_scaled_motions() -> None:
    suite = Suite("two", (member(1, 2.0), member(2, 0.5)))
    found = suite_spectra(suite, [0.1, 1.0])
    expected = np.array(
        [factor * response_spectrum(short_motion(seed), [0.1, 1.0]).psa
         for seed, factor in ((1, 2.0), (2, 0.5))]
    )  # fmt: skip
    assert found["names"] == ("m1", "m2")
    np.testing.assert_allclose(found["spectra"], expected, rtol=1e-12)
    np.testing.assert_allclose(found["mean"], np.sqrt(expected[0] * expected[1]), rtol=1e-12)
    np.testing.assert_allclose(
        found["scatter"], np.abs(np.log(expected[0] / expected[1])) / np.sqrt(2.0), rtol=1e-12
    )


def test_a_single_motion_has_no_scatter() -> None:
    found = suite_spectra(Suite("one", (member(1, 1.0),)), [0.2])
    assert found["scatter"].tolist() == [0.0]


def test_a_motion_of_zeros_has_no_place_in_logarithms() -> None:
    still = SuiteMember("still", {"acceleration": [0.0] * 10, "dt": 0.01}, 1.0)
    with pytest.raises(InputError, match="still: is zero throughout"):
        suite_spectra(Suite("s", (still,)))


def test_spectral_acceleration_of_a_motion_and_of_a_scenario() -> None:
    motion = short_motion(5)
    expected = response_spectrum(motion, [0.411]).psa[0]
    assert spectral_acceleration(motion, 0.411) == expected
    case = scenario(synthetic=SHORT | {"seed": 5}, scale=-2.0)
    assert spectral_acceleration(case, 0.411) == pytest.approx(2.0 * expected, rel=1e-12)
    assert spectral_acceleration(motion, 0.0) == motion.pga
    assert spectral_acceleration(motion, 0.411, 0.2) < expected


def test_the_picture_is_drawn_with_and_without_a_target(tmp_path: Path) -> None:
    found = suite_spectra(Suite("s", (member(1, 1.0), member(2, 2.0))), np.geomspace(0.005, 12, 20))
    target = load_hazard("berkeley", 0.05)
    sizes = [
        write_suite_picture(found, tmp_path / "a.png").stat().st_size,
        write_suite_picture(found, tmp_path / "b.png", target, (0.05, 2.0), "$x_$").stat().st_size,
    ]
    assert min(sizes) > 20_000 and sizes[0] != sizes[1]
