"""Studies whose files lie elsewhere by now."""

import pytest

from railquake.errors import InputError
from railquake.study.folder import ResultsFolder
from railquake.study.moved import FOLDER, found_again


@pytest.fixture
def places(tmp_path):
    """A folder of records of which three bear one name, and a study's tables that name them."""
    for name in ("old/recs/a/R.AT2", "old/recs/b/R.AT2", "old/recs/R.AT2", "old/rail.prr"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(name)
    old = tmp_path / "old"
    tables = {
        FOLDER: str(old / "study"),
        "base": {"wheelrail": {"rail": {"file": str(old / "rail.prr")}}},
        "suite": {
            "members": [
                {"name": name, "motion": {"record": str(old / f"recs/{name}/R.AT2")}}
                for name in "ab"
            ]
        },
        "axes": {"motion.vertical": [str(old / "recs/a/R.AT2")]},
    }
    return tmp_path, tables


def read(tables):
    """What the study would read now."""
    paths = [member["motion"]["record"] for member in tables["suite"]["members"]]
    paths += [tables["base"]["wheelrail"]["rail"]["file"], *tables["axes"]["motion.vertical"]]
    return [open(path).read() for path in paths]


WANTED = ["old/recs/a/R.AT2", "old/recs/b/R.AT2", "old/rail.prr", "old/recs/a/R.AT2"]


def test_a_study_that_was_moved_alone_finds_its_files(places):
    root, tables = places
    found = found_again(tables, root / "elsewhere", None)
    assert FOLDER not in found
    assert read(found) == WANTED


def test_a_study_that_was_moved_with_its_files_finds_them(places):
    root, tables = places
    (root / "old").rename(root / "new")
    assert read(found_again(tables, root / "new/study", None)) == WANTED


@pytest.mark.parametrize("inside", ["", "recs"])
def test_moved_records_are_found_by_as_much_of_their_paths_as_is_there(places, inside):
    root, tables = places
    (root / "old/recs").rename(root / "moved")
    if inside:
        (root / "holder").mkdir()
        (root / "moved").rename(root / "holder/recs")
    folder = root / "holder" if inside else root / "moved"
    assert read(found_again(tables, root / "old/study", folder)) == WANTED


def test_a_record_that_is_not_there_is_said_with_both_places(places):
    root, tables = places
    (root / "empty").mkdir()
    with pytest.raises(InputError, match=r"--records .*/empty: holds no R.AT2, .*old/recs/a/R.AT2"):
        found_again(tables, root / "old/study", root / "empty")
    with pytest.raises(InputError, match="there is no such folder"):
        found_again(tables, root / "old/study", root / "none")


def test_the_folder_of_a_file_does_not_tell_studies_apart_but_its_name_does(tmp_path):
    def tables(record):
        return {"suite": {"members": [{"name": "a", "motion": {"record": record}}]}}

    folder = ResultsFolder(tmp_path)
    (tmp_path / "study.toml").write_text(
        '[[suite.members]]\nname = "a"\nmotion = { record = "/here/A.AT2" }\n'
    )
    folder.compare(tables("/there/A.AT2"), print)
    with pytest.raises(InputError, match='record was "A.AT2", now is "B.AT2"'):
        folder.compare(tables("/here/B.AT2"), print)
