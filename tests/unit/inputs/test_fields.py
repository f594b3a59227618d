"""Inputs by their paths: what they take, and what names none."""

import pytest

from railquake.errors import InputError
from railquake.inputs.fields import input_at
from railquake.inputs.scenario import Scenario, scenario


@pytest.mark.parametrize(
    ("path", "kind", "dimension"),
    [
        ("vehicle.speed", "number", "speed"),
        ("vehicle.preset", "text", None),
        ("vehicle.axles", "integer", None),
        ("vehicle.bodies.car.mass", "number", "mass"),
        ("support.kind", "text", None),
        ("support.hinge", "text", None),
        ("support.coupled", "flag", None),
        ("support.length", "number", "length"),
        ("support.file", "text", None),
        ("support.bouc_wen.m", "number", "mass"),
        ("wheelrail.friction", "number", "number"),
        ("wheelrail.gauge", "number", "length"),
        ("wheelrail.wheel", "any", None),
        ("motion.scale", "number", "number"),
        ("motion.synthetic.seed", "integer", None),
        ("motion.synthetic.pga", "number", "acceleration"),
        ("motion.channel", "any", None),
        ("solver.dt", "number", "time"),
    ],
)
def test_a_path_names_an_input(path, kind, dimension):
    found = input_at(path, "here")
    assert (found.kind, found.dimension) == (kind, dimension)


def test_every_value_of_a_case_has_a_path_that_takes_it():
    case = scenario(synthetic={"seed": 1}).to_dict()

    def leaves(table, prefix=""):
        for key, value in table.items():
            if isinstance(value, dict):
                yield from leaves(value, f"{prefix}{key}.")
            else:
                yield f"{prefix}{key}", value

    paths = dict(leaves(case))
    assert {path.partition(".")[0] for path in paths} == set(Scenario.model_fields)
    for path, value in paths.items():
        assert input_at(path, "here").in_si(value, "here") == value


@pytest.mark.parametrize(
    ("path", "advice"),
    [
        ("vehicle.sped", 'did you mean "speed"'),
        ("supprt.hinge", 'did you mean "support"'),
        ("support.bouc_wen.k", 'did you mean "k0"'),
        ("support.length.x", "support.length holds no others"),
        ("motion.synthetic.sed", 'did you mean "seed"'),
        ("vehicle.bodies.car.maas", 'did you mean "mass"'),
        ("", "known: vehicle, support"),
        ("vehicle.", "known: name"),
    ],
)
def test_a_path_that_names_none_is_refused_with_the_nearest(path, advice):
    with pytest.raises(InputError, match="names no input") as error:
        input_at(path, "here")
    assert advice in str(error.value)


def test_a_value_of_another_kind_is_refused():
    for path, value, wanted in (
        ("vehicle.axles", 2.5, "a whole number"),
        ("vehicle.axles", True, "a whole number"),
        ("support.coupled", 1, "true or false"),
        ("support.hinge", 3, "a text"),
        ("support.length", "-1 m", "positive"),
    ):
        with pytest.raises(InputError, match=wanted):
            input_at(path, "here").in_si(value, "here")
