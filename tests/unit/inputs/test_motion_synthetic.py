"""Synthetic motions: the same from the same seed, at rest at the end, of the stated spectrum."""

from typing import Any

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.ground_motion import (
    STANDARD_GRAVITY,
    SyntheticParameters,
    synthetic_from_mapping,
    synthetic_motion,
)
from railquake.inputs.ground_motion.synthetic import envelope, filter_gain, white_noise

NOISE_OF_SEED_1 = [0.7141932764878985, 0.302315998956082, 0.9107613142984461, -0.10107255277433493]
MOTION_OF_SEED_1 = [
    0.6169613002119757,
    -2.850435445132218,
    -0.21543268777697833,
    0.11236218304517169,
]
"""m/s2, at samples 500, 1000, 2000 and 4000 of the default motion."""


def test_the_noise_of_a_seed_is_fixed() -> None:
    """Numbers that must never change, whatever the version of NumPy."""
    np.testing.assert_allclose(white_noise(1, 4), NOISE_OF_SEED_1, rtol=1e-13)
    assert white_noise(1, 5).shape == (5,)


def test_the_motion_of_a_seed_is_fixed() -> None:
    motion = synthetic_motion({"seed": 1})
    np.testing.assert_allclose(
        motion.acceleration[[500, 1000, 2000, 4000]], MOTION_OF_SEED_1, rtol=1e-9
    )
    again = synthetic_motion(SyntheticParameters(seed=1))
    np.testing.assert_array_equal(motion.acceleration, again.acceleration)
    other = synthetic_motion({"seed": 2})
    assert not np.allclose(motion.acceleration, other.acceleration)


@pytest.mark.parametrize("seed", range(5))
def test_velocity_and_displacement_end_at_zero(seed: int) -> None:
    motion = synthetic_motion({"seed": seed, "pga": 3.0})
    assert motion.pga == pytest.approx(3.0, rel=1e-14)
    assert motion.duration == pytest.approx(30.0)
    velocity, displacement = motion.velocity(), motion.displacement()
    assert abs(velocity[-1]) < 1e-10 * np.max(np.abs(velocity))
    assert abs(displacement[-1]) < 1e-10 * np.max(np.abs(displacement))
    assert motion.acceleration[0] == 0.0
    assert abs(motion.acceleration[-1]) < 1e-12
    assert motion.baseline_check() == ()


def test_arias_intensity_can_be_the_target() -> None:
    motion = synthetic_motion({"arias_intensity": 1.5})
    assert motion.arias_intensity == pytest.approx(1.5, rel=1e-12)


def test_default_pga_is_0_4_g_and_the_source_tells_all() -> None:
    motion = synthetic_motion()
    assert motion.pga == pytest.approx(0.4 * STANDARD_GRAVITY)
    assert motion.name == "synthetic-1"
    assert "seed = 1" in motion.source
    assert "ground_frequency = 2.5" in motion.source


def test_envelope_has_its_peak_and_its_end_where_stated() -> None:
    time = np.linspace(0.0, 20.0, 20001)
    height = envelope(time, 20.0, 0.2)
    assert time[np.argmax(height)] == pytest.approx(4.0, abs=1e-3)
    assert height.max() == pytest.approx(1.0)
    assert height[-1] == pytest.approx(0.05)


def test_gain_is_the_stated_power_spectral_density() -> None:
    p = SyntheticParameters()
    f = np.array([0.05, 0.2, 1.0, 2.5, 10.0])
    w, wg, wf = 2 * np.pi * f, 2 * np.pi * p.ground_frequency, 2 * np.pi * p.highpass_frequency
    zg, zf = p.ground_damping, p.highpass_damping
    soil = (wg**4 + 4 * zg**2 * wg**2 * w**2) / ((wg**2 - w**2) ** 2 + 4 * zg**2 * wg**2 * w**2)
    high = w**4 / ((wf**2 - w**2) ** 2 + 4 * zf**2 * wf**2 * w**2)
    np.testing.assert_allclose(np.abs(filter_gain(f, p)) ** 2, soil * high, rtol=1e-12)


def test_mean_spectrum_of_many_motions_follows_the_model() -> None:
    """Power in bands, averaged over seeds, against the density: within a quarter."""
    p = SyntheticParameters(duration=40.0, dt=0.01)
    power = np.zeros(2001)
    for seed in range(40):
        motion = synthetic_motion(SyntheticParameters(seed=seed, duration=40.0, dt=0.01))
        line = np.abs(np.fft.rfft(motion.acceleration)) ** 2
        power += line / line.sum()
    frequency = np.fft.rfftfreq(4001, 0.01)
    model = np.abs(filter_gain(frequency, p)) ** 2
    bands = [(0.4, 1.0), (1.0, 2.0), (2.0, 4.0), (4.0, 8.0), (8.0, 20.0)]
    found, stated = (
        np.array([v[(frequency >= a) & (frequency < b)].sum() for a, b in bands])
        for v in (power, model)
    )
    np.testing.assert_allclose(found / found.sum(), stated / stated.sum(), rtol=0.25)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ({"sed": 1}, r"motion.synthetic: 'sed' is not known; did you mean seed\?"),
        ({"colour": 1}, "'colour' is not known; known are seed, duration"),
        ({"seed": 1.5}, "motion.synthetic: seed must be a whole number"),
        ({"seed": True}, "seed must be a whole number"),
        ({"seed": -1}, "seed must be from 0"),
        ({"seed": 2**63}, "seed must be from 0"),
        ({"pga": 0.0}, "pga must be finite and over zero"),
        ({"pga": float("nan")}, "pga must be finite"),
        ({"pga": [1]}, "pga must be a number"),
        ({"pga": 1.0, "arias_intensity": 1.0}, "not both"),
        ({"dt": 1e-9}, "samples"),
        ({"duration": 0.01}, "samples"),
        ({"ground_frequency": 90.0}, "ground_frequency 90 Hz needs a dt"),
        ({"ground_damping": 5.0}, "ground_damping must be from 0.01 to 2"),
        ({"highpass_frequency": 5.0}, "highpass_frequency must be"),
        ({"highpass_frequency": 0.001}, "highpass_frequency must be"),
        ({"strong_duration": 99.0}, "longer than duration"),
        ({"rise": 0.95}, "rise must be"),
        ({"rise": "0.2"}, r"motion.synthetic.rise: a plain number is needed, found '0.2'"),
        ("seed = 1", "a table such as"),
    ],
)
def test_bad_tables_are_refused(table: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        synthetic_from_mapping(table)


def test_quantities_with_units() -> None:
    found = synthetic_from_mapping(
        {"seed": 3, "pga": "0.5 g", "dt": "5 ms", "ground_frequency": "3 Hz", "duration": "20 s"}
    )
    assert found.pga == pytest.approx(0.5 * STANDARD_GRAVITY)
    assert (found.dt, found.ground_frequency, found.duration) == (0.005, 3.0, 20.0)
    assert synthetic_from_mapping({"arias_intensity": "1.2 m/s"}).arias_intensity == 1.2
    with pytest.raises(InputError, match=r"motion.synthetic.pga"):
        synthetic_from_mapping({"pga": "0.5 m"})
