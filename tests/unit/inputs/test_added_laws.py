"""Laws from outside the package: named in a case like the package's own."""

import tomllib
from types import SimpleNamespace
from typing import Annotated

import pytest
from pydantic import Field

from railquake.errors import InputError
from railquake.inputs.fields import input_at
from railquake.inputs.hinge import BoucWenHinge
from railquake.inputs.marks import File
from railquake.inputs.model import InputModel, Name
from railquake.inputs.scenario import load_scenario, scenario, scenario_from_dict
from railquake.inputs.schema import json_schema
from railquake.inputs.support import AtGrade, Pier
from railquake.inputs.units import PositiveMoment, PositiveRotationalStiffness
from railquake.laws import CREEP_LAWS, HINGE_LAWS, RESTITUTION_LAWS
from railquake.study import Study
from railquake.study.design import Design


class Takeda(InputModel):
    """Parameters of a law from outside."""

    k0: Annotated[PositiveRotationalStiffness, Field(description="Initial stiffness [N m/rad]")]
    yield_moment: PositiveMoment = 1e6
    backbone: Annotated[Name | None, File()] = None


@pytest.fixture(autouse=True)
def laws(monkeypatch):
    """The families, with laws that are gone after the test."""
    for family in (CREEP_LAWS, HINGE_LAWS, RESTITUTION_LAWS):
        family.names()  # the package's own are there
        monkeypatch.setattr(family, "_laws", dict(family._laws))
    HINGE_LAWS.add(SimpleNamespace(name="my-takeda", inputs=Takeda))
    HINGE_LAWS.add(SimpleNamespace(name="rigid"))
    CREEP_LAWS.add(SimpleNamespace(name="my-creep"))
    RESTITUTION_LAWS.add(SimpleNamespace(name="my-impact"))


CASE = """
[vehicle]
preset = "bart"
[support]
preset = "bart-berkeley"
hinge = "my-takeda"
[support.my_takeda]
k0 = "300 MN m/rad"
backbone = "curve.csv"
[wheelrail]
preset = "bart"
creep_law = "my-creep"
restitution_law = "my-impact"
[motion]
synthetic = { seed = 1 }
"""


@pytest.fixture
def case(tmp_path):
    (tmp_path / "curve.csv").write_text("1")
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path


def test_a_case_names_them(case):
    loaded = load_scenario(case)
    assert (loaded.wheelrail.creep_law, loaded.wheelrail.restitution_law) == (
        "my-creep",
        "my-impact",
    )
    assert loaded.support.hinge_parameters == Takeda(
        k0=3e8, backbone=str(case.parent / "curve.csv")
    )
    assert loaded.support.my_takeda is loaded.support.hinge_parameters
    assert isinstance(loaded.support.bouc_wen, BoucWenHinge)
    hash(loaded.support)  # assemblies are remembered by it


def test_laws_without_a_table_take_the_hinges_values():
    pier = Pier.from_preset("bart-berkeley", {"hinge": "rigid"})
    assert pier.hinge_parameters is pier.bouc_wen
    for law in ("bouc-wen", "elastic"):
        pier = Pier.from_preset("bart-berkeley", {"hinge": law})
        assert pier.hinge_parameters is pier.bouc_wen


def test_the_parameters_are_written_and_read_again(case, tmp_path):
    loaded = load_scenario(case)
    tables = tomllib.loads(loaded.to_toml())
    assert tables["support"]["my_takeda"]["k0"] == 3e8
    assert scenario_from_dict(tables) == loaded
    assert scenario(support=loaded.support, synthetic={"seed": 1}).support == loaded.support
    (tmp_path / "preset.toml").write_text(
        'preset = "bart-berkeley"\nhinge = "my-takeda"\n[my_takeda]\nk0 = 1e8\n'
    )
    other = load_scenario(case, ["support.preset=preset.toml"])
    assert other.support == loaded.support  # the case's own values win


def test_they_can_be_overridden(case):
    loaded = load_scenario(case, ["support.my_takeda.k0=400 MN m/rad"])
    assert loaded.support.hinge_parameters.k0 == 4e8
    changed = loaded.with_changes({"support.my_takeda.yield_moment": "2 MN m"})
    assert (changed.support.my_takeda.k0, changed.support.my_takeda.yield_moment) == (4e8, 2e6)
    back = loaded.with_changes({"support.hinge": "elastic"})
    assert back.support.hinge_parameters is back.support.bouc_wen
    assert back.support.my_takeda == loaded.support.my_takeda


def test_they_count_in_the_hash_with_the_content_of_their_files(case):
    first = load_scenario(case).content_hash()
    assert load_scenario(case, ["support.my_takeda.k0=301 MN m/rad"]).content_hash() != first
    (case.parent / "curve.csv").write_text("22")
    assert load_scenario(case).content_hash() != first


def test_a_case_without_them_keeps_its_hash():
    plain = scenario(synthetic={"seed": 1})
    assert "my_takeda" not in plain.to_toml()
    with pytest.MonkeyPatch.context() as patch:
        known = {name: HINGE_LAWS[name] for name in HINGE_LAWS.built_in()}
        patch.setattr(HINGE_LAWS, "_laws", known)
        assert scenario(synthetic={"seed": 1}).content_hash() == plain.content_hash()


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("support.my_takeda.k0=3 m", r"support\.my_takeda\.k0: must be a rotational stiffness"),
        ("support.my_takeda.k_0=3", r'support\.my_takeda\.k_0: unknown key; did you mean "k0"'),
        ("support.takeda.k0=3", r'support\.takeda: unknown key; did you mean "my_takeda"'),
        ("support.my_takeda=3", r"support\.my_takeda: must be a table, found 3"),
        ("support.hinge=my_takeda", r'support\.hinge: there is no "my_takeda"; known: .*"my-tak'),
    ],
)
def test_wrong_ones_are_refused_in_one_line(case, override, message):
    with pytest.raises(InputError, match=message) as caught:
        load_scenario(case, [override])
    assert str(caught.value).startswith(f"{case}: ")


def test_what_the_chosen_law_needs_is_told():
    message = r"my_takeda\.k0: missing; write e\.g\. k0 = "
    with pytest.raises(InputError, match=message):
        Pier.from_preset("bart-berkeley", {"hinge": "my-takeda"})
    with pytest.raises(InputError, match=r"my_law: unknown key"):
        Pier.from_preset("bart-berkeley", {"my_law": {"k0": 1.0}})
    with pytest.raises(InputError, match=r"^Pier: my_takeda\.k0: must be positive"):
        Pier(**Pier.from_preset("bart-berkeley").model_dump(), my_takeda={"k0": -1.0})


def test_at_grade_leaves_them_out(case):
    assert load_scenario(case, ["support.kind=at-grade"]).support == AtGrade()


def test_a_study_varies_them(case):
    axes = {
        "support.my_takeda.k0": ["300 MN m/rad", "400 MN m/rad"],
        "support.hinge": ["my-takeda", "elastic"],
    }
    design = Design(Study(base=str(case), axes=axes))
    found = [design.scenario(design.point(row)).support for row in range(design.size)]
    assert [pier.my_takeda.k0 for pier in found] == [3e8, 3e8, 4e8, 4e8]
    assert [pier.hinge for pier in found] == ["my-takeda", "elastic"] * 2
    hashes = {design.identified(design.point(row))[1] for row in range(design.size)}
    assert len(hashes) == 4
    assert input_at("support.my_takeda.k0", "x").dimension == "rotational stiffness"
    assert input_at("support.my_takeda.backbone", "x").file == "always"
    with pytest.raises(InputError, match=r'"k_0" is unknown, did you mean "k0"'):
        input_at("support.my_takeda.k_0", "x")


def test_the_schema_has_the_packages_own_names_and_the_added_table():
    properties = json_schema()["$defs"]["Support"]["properties"]
    assert properties["hinge"]["enum"] == list(HINGE_LAWS.built_in())
    assert set(properties["my_takeda"]["properties"]) == {"k0", "yield_moment", "backbone"}


def test_a_table_cannot_have_the_name_of_a_key():
    HINGE_LAWS.add(SimpleNamespace(name="length", inputs=Takeda))
    with pytest.raises(InputError, match=r'hinge law "length": its table \[support\.length\]'):
        Pier.from_preset("bart-berkeley")
