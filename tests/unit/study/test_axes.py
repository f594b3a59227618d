"""Axes: lists, variants and distributions, as written and as they are sampled."""

from pathlib import Path

import numpy as np
import pytest
import scipy.stats

from railquake.errors import InputError
from railquake.study.axes import sampled
from railquake.study.parsing import parse_axes, parse_sampling

HERE = Path("/somewhere")
LATIN = {"method": "latin-hypercube", "count": 256, "seed": 7}


def axes(**tables):
    return parse_axes(tables, HERE, "study.toml: axes")


def drawn(path, distribution, sampling=None, **parameters):
    found = axes(**{path: {"distribution": distribution, **parameters}})
    return np.array(sampled(found, parse_sampling(sampling or LATIN, found, "sampling"))[path])


def test_values_of_a_list_are_in_si_units():
    (axis,) = axes(**{"vehicle.speed": ["36 km/h", 20.0]})
    assert axis.values == pytest.approx((10.0, 20.0))
    assert axis.column == "vehicle.speed"
    assert axis.changes(1) == {"vehicle.speed": 20.0}


def test_a_path_may_be_written_as_tables_in_tables():
    assert axes(vehicle={"speed": ["36 km/h"]}) == axes(**{"vehicle.speed": [10.0]})


def test_a_variant_sets_several_inputs():
    (axis,) = axes(
        model=[
            {"name": "stiff", "set": {"support.length": "5 m", "support.hinge": "elastic"}},
            {"name": "as it is", "set": {}},
        ]
    )
    assert axis.label(0) == "stiff"
    assert axis.changes(0) == {"support.length": 5.0, "support.hinge": "elastic"}
    assert axis.changes(1) == {}


def test_files_start_from_the_studys_folder():
    (axis,) = axes(**{"vehicle.preset": ["bart", "cars/mine.toml"]})
    assert axis.values == ("bart", "/somewhere/cars/mine.toml")


@pytest.mark.parametrize(
    ("distribution", "parameters", "reference"),
    [
        ("uniform", {"low": 0.1, "high": 0.5}, scipy.stats.uniform(0.1, 0.4)),
        ("loguniform", {"low": 0.1, "high": 0.5}, scipy.stats.loguniform(0.1, 0.5)),
        ("normal", {"mean": 0.4, "standard_deviation": 0.05}, scipy.stats.norm(0.4, 0.05)),
        ("lognormal", {"median": 0.3, "dispersion": 0.2}, scipy.stats.lognorm(0.2, scale=0.3)),
        (
            "truncated-normal",
            {"mean": 0.3, "standard_deviation": 0.1, "low": 0.2, "high": 0.6},
            scipy.stats.truncnorm(-1.0, 3.0, 0.3, 0.1),
        ),
        (
            "triangular",
            {"low": 0.1, "mode": 0.2, "high": 0.5},
            scipy.stats.triang(0.25, 0.1, 0.4),
        ),
    ],
)
def test_samples_follow_their_distribution(distribution, parameters, reference):
    values = drawn("wheelrail.friction", distribution, **parameters)
    # a Latin hypercube has one sample in each of its 256 strata
    strata = np.sort(np.floor(reference.cdf(values) * 256.0))
    assert strata.tolist() == list(range(256))


def test_parameters_take_units():
    values = drawn("vehicle.speed", "uniform", low="36 km/h", high="72 km/h")
    assert values.min() >= 10.0 and values.max() <= 20.0


def test_whole_numbers_are_drawn_with_their_ends():
    values = drawn("motion.synthetic.seed", "integers", low=3, high=5)
    assert set(values) == {3, 4, 5}


@pytest.mark.parametrize("method", ["latin-hypercube", "sobol"])
def test_the_same_seed_gives_the_same_samples(method):
    one = {"method": method, "count": 64, "seed": 1}
    first, again, other = (
        drawn("wheelrail.friction", "uniform", sampling, low=0.1, high=0.5)
        for sampling in (one, one, {**one, "seed": 2})
    )
    assert first.tolist() == again.tolist()
    assert first.tolist() != other.tolist()


WRONG = [
    ({"vehicle.sped": [1.0]}, 'names no input.*did you mean "speed"'),
    ({"vehicle.speed": []}, "list is empty"),
    ({"vehicle.speed": "80 km/h"}, r'must be a list.*write e.g. \["80 km/h"\]'),
    ({"vehicle.speed": ["80 kg"]}, "vehicle.speed: must be a speed"),
    ({"vehicle.speed": ["36 km/h", 10.0]}, "is there twice"),
    ({"support.coupled": ["yes"]}, "must be true or false"),
    ({"model": [{"name": "a", "set": {"support.hing": "elastic"}}]}, 'mean "hinge"'),
    ({"model": [{"name": "a", "set": {}}, {"name": "a", "set": {}}]}, "two variants are called a"),
    ({"model": [{"name": "a"}]}, "each variant needs name and set"),
    (
        {"support.length": [5.0], "model": [{"name": "a", "set": {"support.length": 6.0}}]},
        "support.length is set by the axis support.length already",
    ),
    ({"vehicle.speed": [1.0], "vehicle": {"speed": [2.0]}}, "an axis vehicle.speed already"),
    (
        {"wheelrail.friction": {"distribution": "gauss", "mean": 0.3}},
        "unknown distribution.*uniform, loguniform, normal",
    ),
    (
        {"wheelrail.friction": {"distribution": "normal", "mean": 0.3}},
        "standard_deviation is missing",
    ),
    (
        {"wheelrail.friction": {"distribution": "uniform", "low": 0.3, "high": 0.1}},
        "low < high is needed",
    ),
    (
        {"wheelrail.friction": {"distribution": "uniform", "lo": 0.3, "high": 0.1}},
        'unknown key lo; did you mean "low"',
    ),
    (
        {"wheelrail.friction": {"distribution": "lognormal", "median": -1, "dispersion": 0.1}},
        "median must be over zero",
    ),
    ({"support.hinge": {"distribution": "uniform", "low": 0, "high": 1}}, "takes no numbers"),
    (
        {"motion.synthetic.seed": {"distribution": "uniform", "low": 0, "high": 9}},
        "must be integers",
    ),
]


@pytest.mark.parametrize(("tables", "message"), WRONG)
def test_a_wrong_axis_is_refused_in_one_line(tables, message):
    with pytest.raises(InputError, match=message) as error:
        axes(**tables)
    assert "\n" not in str(error.value)
    assert str(error.value).startswith("study.toml: axes")


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (None, "is missing, wheelrail.friction is to be sampled"),
        ({"count": 0}, "count: must be a whole number from 1"),
        ({}, "count: must be a whole number from 1.*found nothing"),
        ({"count": 8, "method": "monte-carlo"}, "known: latin-hypercube, sobol"),
        ({"count": 100, "method": "sobol"}, "power of two.*take 64 or 128"),
        ({"count": 8, "sede": 1}, 'did you mean "seed"'),
        ({"count": 8, "seed": -1}, "seed: must be a whole number from 0"),
    ],
)
def test_a_wrong_sampling_is_refused(table, message):
    found = axes(**{"wheelrail.friction": {"distribution": "uniform", "low": 0.1, "high": 0.5}})
    with pytest.raises(InputError, match=message):
        parse_sampling(table, found, "study.toml: sampling")


def test_sampling_without_a_distribution_is_refused():
    with pytest.raises(InputError, match="no axis is a distribution"):
        parse_sampling({"count": 8}, (), "study.toml: sampling")
