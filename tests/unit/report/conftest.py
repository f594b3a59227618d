"""A small study, run once; a test that changes its folder copies it."""

import shutil

import pytest

from study_for_reports import study


@pytest.fixture(scope="session")
def kept_folder(tmp_path_factory):
    """Folder of the small study: 60 runs."""
    folder = tmp_path_factory.mktemp("study") / "small"
    study().run(folder, jobs=1)
    return folder


@pytest.fixture
def folder(kept_folder, tmp_path):
    """A copy of it, to be written to."""
    return shutil.copytree(kept_folder, tmp_path / "small")


@pytest.fixture(scope="session")
def report(kept_folder, tmp_path_factory):
    """The small study's report."""
    from railquake.report import write_report

    copy = shutil.copytree(kept_folder, tmp_path_factory.mktemp("report") / "small study")
    return write_report(copy)
