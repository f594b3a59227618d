"""JMA's instrumental intensity: against the record that JMA itself works out."""

import gzip
import math

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.ground_motion import GroundMotion, jma_intensity
from railquake.inputs.ground_motion.jma import filter_weights, jma_acceleration

DT = 0.01


@pytest.fixture(scope="module")
def yonago(shared):
    """Yonago, 2000-10-06: north, east, up."""
    with gzip.open(shared / "field" / "AA06EA01.csv.gz", "rt", encoding="shift_jis") as file:
        lines = file.read().splitlines()
    first = next(k for k, line in enumerate(lines) if line.strip() == "NS,EW,UD") + 1
    values = np.array([[float(cell) for cell in line.split(",")[:3]] for line in lines[first:]])
    return [GroundMotion(f"component {k}", DT, 0.01 * values[:, k]) for k in range(3)]


def shaking(amplitude, seconds=20.0, frequency=1.0, dt=DT):
    time = np.arange(0.0, seconds, dt)
    return GroundMotion("sine", dt, amplitude * np.sin(2.0 * np.pi * frequency * time))


def test_jmas_worked_example(yonago):
    """JMA: a = 127.85 gal, intensity 5.1."""
    assert jma_acceleration(*yonago) == pytest.approx(1.2785, rel=1e-3)
    # rounded to two decimals, the second cut off
    assert math.floor(10.0 * round(jma_intensity(*yonago), 2)) / 10.0 == 5.1


def test_fewer_components_give_less(yonago):
    three, two, one = (jma_intensity(*yonago[:n]) for n in (3, 2, 1))
    assert one < two < three
    assert three - one < 0.3


def test_a_vector_has_no_preferred_axis(yonago):
    north, east, up = yonago
    c, s = math.cos(0.7), math.sin(0.7)
    turned = (
        GroundMotion("turned", DT, c * north.acceleration + s * east.acceleration),
        GroundMotion("turned", DT, c * east.acceleration - s * north.acceleration),
    )
    assert jma_intensity(up, *turned) == pytest.approx(jma_intensity(*yonago), rel=1e-9)


def test_a_sine_is_weighted_by_the_filter_at_its_frequency():
    """Of whole periods the filter makes a sine again, above this share of its peak for 0.3 s."""
    frequency, seconds = 1.0, 20.0
    weight = float(filter_weights(np.array([frequency]))[0])
    share = math.sin(0.5 * math.pi * (1.0 - 0.3 / seconds))
    found = jma_acceleration(shaking(2.0, seconds, frequency))
    assert found == pytest.approx(2.0 * weight * share, rel=2e-3)


def test_ten_times_the_shaking_is_two_degrees_more():
    rise = jma_intensity(shaking(1.0)) - jma_intensity(shaking(0.1))
    assert rise == pytest.approx(2.0, abs=1e-9)


def test_the_time_step_does_not_matter():
    coarse, fine = (jma_intensity(shaking(1.0, dt=dt)) for dt in (0.01, 0.002))
    assert coarse == pytest.approx(fine, abs=2e-3)
    # nor does that of another component, or its end
    up = shaking(0.5, seconds=15.0, frequency=3.0, dt=0.005)
    assert jma_intensity(shaking(1.0), up) > jma_intensity(shaking(1.0))


def test_no_intensity_without_shaking():
    assert jma_intensity(GroundMotion("rest", DT, np.zeros(200))) is None
    assert jma_intensity(GroundMotion("click", DT, np.ones(20))) is None


@pytest.mark.parametrize("count", [0, 4])
def test_one_to_three_components(count):
    with pytest.raises(InputError, match=f"one to three components, found {count}"):
        jma_intensity(*count * [shaking(1.0)])
