"""Marks of fields: a new field needs nothing but its mark."""

from typing import Annotated

import pytest
from pydantic import Field, create_model

from railquake.errors import InputError
from railquake.inputs import fields
from railquake.inputs.fields import input_at
from railquake.inputs.identity import files_of, fingerprint
from railquake.inputs.layers import merged, with_absolute_paths, with_overrides
from railquake.inputs.marks import AsText, ByName, File, KnownLaw, Label, OneOf, Place, Samples
from railquake.inputs.model import InputModel, Name, Text, validated
from railquake.inputs.scenario import Scenario, scenario
from railquake.inputs.support import Pier
from railquake.inputs.toml import is_path
from railquake.inputs.units import PositiveLength
from railquake.laws import Family


class Picture(InputModel):
    """What a file or a word gives."""

    file: Annotated[Name | None, File()] = None
    word: Annotated[Name | None, Field()] = None


class Stone(InputModel):
    """One of several things with names."""

    name: Name
    survey: Annotated[Name | None, File()] = None
    width: PositiveLength = 1.0


def read(text):
    return {"file": text} if is_path(text) else {"word": text}


class Toy(InputModel):
    """A section of a case, with a field of each mark."""

    title: Annotated[Text, Label()] = ""
    soil: Annotated[Name | None, File()] = None
    picture: Annotated[Picture, AsText(read)] = Picture(word="none")
    stones: Annotated[tuple[Stone, ...], ByName()] = ()
    height: Annotated[PositiveLength | None, OneOf("height")] = None
    heights: Annotated[tuple[PositiveLength, ...] | None, OneOf("height")] = None
    samples: Annotated[tuple[float, ...] | None, Samples()] = None


PLACE = Place((Toy,))
TABLES = {
    "soil": "soil.csv",
    "picture": "a.png",
    "stones": {"one": {"survey": "one.csv"}, "two": {}},
    "height": "2 m",
}


def test_paths_start_from_the_folder_wherever_a_file_is_named(tmp_path):
    made = with_absolute_paths(TABLES, tmp_path, PLACE)
    assert made["soil"] == str(tmp_path / "soil.csv")
    assert made["picture"] == {"file": str(tmp_path / "a.png")}
    assert made["stones"]["one"]["survey"] == str(tmp_path / "one.csv")
    listed = {"stones": [{"name": "one", "survey": "one.csv"}]}
    made = with_absolute_paths(listed, tmp_path, PLACE)
    assert made["stones"] == [{"name": "one", "survey": str(tmp_path / "one.csv")}]
    assert with_absolute_paths({"picture": "word"}, tmp_path, PLACE)["picture"] == {"word": "word"}


def test_contents_of_files_count_and_labels_do_not(tmp_path):
    for name in ("soil.csv", "a.png", "one.csv"):
        (tmp_path / name).write_text(name)

    def made(**changes):
        return validated(Toy, with_absolute_paths({**TABLES, **changes}, tmp_path, PLACE), "toy")

    assert sorted(files_of(made())) == sorted(
        str(tmp_path / name) for name in ("soil.csv", "a.png", "one.csv")
    )
    text = fingerprint(made())
    assert str(tmp_path) not in text
    assert fingerprint(made(title="other")) == text
    (tmp_path / "one.csv").write_text("changed")
    assert fingerprint(made()) != text
    assert len(fingerprint(made(samples=[0.0] * 10_000))) < 2000


def test_a_table_is_made_as_a_case_file_has_it():
    toy = validated(Toy, {"stones": {"one": {"width": "2 m"}}, "picture": "a.png"}, "toy")
    assert toy.table() == {
        "title": "",
        "picture": {"file": "a.png"},
        "stones": {"one": {"width": 2.0}},
    }
    assert Toy(**toy.table()) == toy


def test_one_of_several_takes_the_others_out():
    assert merged({"height": 1, "soil": "a"}, {"heights": [1, 2]}, PLACE) == {
        "soil": "a",
        "heights": [1, 2],
    }
    over = with_overrides({"height": 1}, ["heights=[1, 2]"], PLACE)
    assert over == {"heights": [1, 2]}
    # elsewhere the same words mean nothing
    assert merged({"height": 1}, {"heights": 2}, Place()) == {"height": 1, "heights": 2}


def test_what_may_be_a_text_is_replaced_whole():
    base = {"picture": {"word": "a"}, "stones": {"one": {"width": 1}}}
    over = {"picture": {"file": "x.png"}, "stones": {"one": {"survey": "y"}}}
    assert merged(base, over, PLACE) == {
        "picture": {"file": "x.png"},
        "stones": {"one": {"width": 1, "survey": "y"}},
    }


def test_a_field_of_a_scenario_that_names_a_file_needs_its_mark_alone(tmp_path, monkeypatch):
    field = (Annotated[Name | None, File(), Field(description="Profile of the soil")], None)
    with_soil = create_model("Pier", __base__=Pier, soil=field)
    support = (with_soil, ...)
    case = create_model("Scenario", __base__=Scenario, support=support)
    monkeypatch.setattr(fields, "Scenario", case)
    # an axis of a study may set it, from the folder of the study
    known = input_at("support.soil", "here")
    assert known.kind == "text"
    assert known.absolute("soil.csv", tmp_path) == str(tmp_path / "soil.csv")
    # a case names it beside itself, and its content counts
    tables = {"support": {"preset": "bart-berkeley", "soil": "soil.csv"}}
    made = with_absolute_paths(tables, tmp_path, Place((case,)))
    assert made["support"]["soil"] == str(tmp_path / "soil.csv")
    pier = with_soil.from_preset("bart-berkeley", {"soil": str(tmp_path / "soil.csv")})
    with pytest.raises(InputError, match=r"soil\.csv: cannot be read"):
        fingerprint(pier)
    (tmp_path / "soil.csv").write_text("1")
    first = fingerprint(pier)
    (tmp_path / "soil.csv").write_text("22")
    assert fingerprint(pier) != first


@pytest.mark.parametrize(
    ("path", "value", "expected"),
    [
        ("support.file", "a", "FOLDER/a"),
        ("motion.record", "a", "FOLDER/a"),
        ("motion.vertical", "a", "FOLDER/a"),
        ("wheelrail.wheel", "s1002", "s1002"),
        ("wheelrail.wheel", "a.prw", "FOLDER/a.prw"),
        ("wheelrail.rail.file", "a", "FOLDER/a"),
        ("vehicle.preset", "bart", "bart"),
        ("support.preset", "my/a", "FOLDER/my/a"),
        ("vehicle.name", "a.b", "a.b"),
        ("support.hinge", "a.b", "a.b"),
    ],
)
def test_axes_tell_paths_from_names(tmp_path, path, value, expected):
    found = input_at(path, "here").absolute(value, tmp_path)
    assert found == expected.replace("FOLDER", str(tmp_path))


def test_files_of_the_shipped_sections(tmp_path):
    case = scenario(record=tmp_path / "r.AT2", vertical=tmp_path / "v.AT2")
    assert list(files_of(case.motion)) == [str(tmp_path / "r.AT2"), str(tmp_path / "v.AT2")]
    assert list(files_of(case.wheelrail)) == list(files_of(case.vehicle)) == []


def test_a_law_is_known_by_its_name():
    family = Family("toy law")
    family.add(type("Law", (), {"name": "linear"}))
    model = create_model("Model", __base__=InputModel, law=(Annotated[str, KnownLaw(family)], ...))
    assert model(law="linear").law == "linear"
    with pytest.raises(InputError, match=r'law: there is no "cubic"; known: "linear"'):
        model(law="cubic")
    with pytest.raises(InputError, match=r"law: must be a text, found 3"):
        model(law=3)
    family.add(type("Law", (), {"name": "cubic"}))
    assert model(law="cubic").model_dump() == {"law": "cubic"}
