"""Study files: what they may hold, and what is refused."""

import tomllib

import pytest

import railquake as rq
from railquake.errors import InputError
from railquake.inputs.toml import dumps
from study_files import BASE, MODELS, small, tables


def test_a_base_case_may_be_a_file_with_values_over_it(tmp_path):
    (tmp_path / "case.toml").write_text(dumps(BASE))
    (tmp_path / "study.toml").write_text(
        '[base]\ncase = "case.toml"\n[base.solver]\ndt = "1e-5 s"\n'
    )
    study = rq.load_study(tmp_path / "study.toml")
    assert study.base["solver"]["dt"] == "1e-5 s"
    assert study.base["vehicle"] == BASE["vehicle"]
    assert study.size == 1


def test_a_study_is_made_in_python_as_in_a_file():
    scenario = rq.scenario(synthetic=BASE["motion"]["synthetic"])
    study = rq.Study(base=scenario, levels={"low": 0.5}, axes={"vehicle.speed": [10.0, 20.0]})
    assert study.size == 2


def test_the_study_as_it_is_kept_is_a_study_file_again():
    data = {
        **small(),
        "axes": {
            "vehicle.speed": ["36 km/h", "72 km/h"],
            "model": MODELS,
            "wheelrail.friction": {"distribution": "lognormal", "median": 0.3, "dispersion": 0.1},
        },
        "sampling": {"method": "sobol", "count": 4, "seed": 1},
    }
    study = rq.Study.from_dict(data)
    text = dumps(study.to_dict())
    again = rq.Study.from_dict(tomllib.loads(text))
    assert dumps(again.to_dict()) == text
    assert again.size == study.size == 2 * 2 * 2 * 3 * 4
    assert again.axes == study.axes


def test_files_of_the_base_case_start_from_the_studys_folder(tmp_path):
    data = {"base": {**BASE, "motion": {"record": "r.AT2"}}}
    study = rq.Study.from_dict(data, tmp_path)
    assert study.base["motion"]["record"] == str(tmp_path / "r.AT2")


WRONG = [
    ({}, "base: missing"),
    ({**tables(), "axis": {}}, 'axis: unknown key; did you mean "axes"'),
    ({"base": "case.toml"}, "case.toml: cannot be read"),
    ({"base": {"case": "none.toml"}}, "none.toml: cannot be read"),
    ({"base": {**BASE, "wheels": {}}}, "base.wheels: unknown key"),
    ({**tables(), "suite": {"manifst": "x"}}, 'suite.manifst: unknown key; did you mean "manif'),
    ({**tables(), "suite": {"levels": {"5%": -1}}}, "levels.5%: must be a number over zero"),
    ({**tables(), "suite": {"levels": [1.0]}}, "levels: must be a table of factors"),
    ({**tables(), "suite": {"manifest": 3}}, "manifest: must be a built-in suite's name"),
    ({**tables(), "suite": {"members": []}}, "members: must be a list of tables"),
    ({**tables(), "suite": {"members": [{"name": "a"}]}}, "each needs name, motion and scale"),
    (
        {**small(), "axes": {"motion.synthetic.seed": [1]}},
        "motion.synthetic.seed is given by the suite",
    ),
    (tables(**{"solver.dt": ["auto"]}), "solver.dt: must be a time"),
]


@pytest.mark.parametrize(("data", "message"), WRONG)
def test_a_wrong_study_is_refused_in_one_line(data, message, tmp_path):
    with pytest.raises(InputError, match=message) as error:
        rq.Study.from_dict(data, tmp_path, where="study.toml")
    assert "\n" not in str(error.value)


def test_an_unknown_suite_and_a_missing_manifest_are_refused(tmp_path):
    for manifest, message in (("paper-suit", "paper-suite"), ("none.csv", "none.csv")):
        study = rq.Study.from_dict({**tables(), "suite": {"manifest": manifest}}, tmp_path)
        with pytest.raises(InputError, match=message):
            study.run(tmp_path / "out")
    assert not (tmp_path / "out").exists()
