"""A study knows with which physics its rows were made, and mixes them with no others unsaid."""

import pytest

import railquake as rq
from railquake.errors import InputError
from railquake.inputs.toml import read_toml
from railquake.run.assess import physics, versions
from railquake.study import batches, cluster
from railquake.study.folder import ResultsFolder, made_by_this, no_note
from study_files import small


@pytest.fixture
def study():
    return rq.Study.from_dict(small()).with_suite(None)


def test_versions_of_a_run_tell_the_physics_and_the_compiler():
    from railquake.march.compiler import source_hash

    found = versions()
    assert found["physics"] == source_hash()
    assert physics() == (
        f"{source_hash()} with Numba {found['numba']} and llvmlite {found['llvmlite']}"
    )


def test_a_batch_with_other_physics_is_refused_by_the_workers_name(study, monkeypatch):
    monkeypatch.setattr(batches.platform, "node", lambda: "node-7")
    batch = batches.Batch("key", study, None, (0,), "older")
    with pytest.raises(
        InputError, match=r"^study: the worker node-7, process \d+ has physics"
    ) as e:
        batches.run_batch(batch)
    assert physics() in str(e.value) and "the study older" in str(e.value)
    assert "\n" not in str(e.value)


class Client:
    def __init__(self, answers):
        self.answers = answers

    def run(self, function, on_error):
        assert function is physics and on_error == "return"
        return self.answers


def test_a_workers_physics_are_asked_before_anything_runs():
    same = {"tcp://a:1": physics(), "tcp://b:1": physics()}
    cluster._refuse_other_physics(Client(same))
    for other in ("older", AttributeError("no attribute 'physics'")):
        with pytest.raises(InputError, match="the worker tcp://c:1 has physics"):
            cluster._refuse_other_physics(Client({**same, "tcp://c:1": other}))


def test_a_folder_notes_the_physics_and_a_resumption_after_an_upgrade_says_so(study, tmp_path):
    said = []
    folder = ResultsFolder(tmp_path / "out")
    folder.prepare(study, said.append, made_by_this())
    assert read_toml(tmp_path / "out" / "study.toml")["physics"] == physics()
    assert folder.made_by() == made_by_this()
    folder.prepare(study, said.append, made_by_this())
    assert said == []
    folder.prepare(study, said.append, {**made_by_this(), "physics": "newer"})
    assert said == [
        f"rows in {folder.path} were made by physics {physics()}, new ones by newer; for rows of "
        "one kind take another folder"
    ]
    assert folder.made_by() == made_by_this()


def test_a_folder_of_a_version_that_noted_no_physics_is_resumed(study, tmp_path):
    said = []
    folder = ResultsFolder(tmp_path / "out")
    folder.prepare(study, no_note, {})
    folder.prepare(study, said.append, made_by_this())
    assert said == []
