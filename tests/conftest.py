"""Shared by all tests."""

import os
import re
import sys
from pathlib import Path

import pytest


def _shared_folder() -> Path:
    given = os.environ.get("RAILQUAKE_SHARED")
    return Path(given) if given else Path(__file__).resolve().parents[2] / "shared"


EACH_BY_ITSELF = ("test_suite_paper.py", "test_comparisons.py", "test_classical_cases.py",
                  "test_pins.py", "test_whole_runs.py", "test_calibrate.py")  # fmt: skip
"""Long files whose tests share nothing but what is on disk."""


def pytest_xdist_make_scheduler(config, log):
    """What a file's tests share, such as a compiled kernel, is made in one worker.

    So its tests stay together, but for those of long files that share nothing.
    """
    if config.getvalue("dist") != "loadscope":
        return None
    from xdist.scheduler import LoadScopeScheduling

    class ByFile(LoadScopeScheduling):
        def _split_scope(self, nodeid):
            file = nodeid.split("::")[0]
            return nodeid if file.endswith(EACH_BY_ITSELF) else file

    return ByFile(config, log)


@pytest.fixture(scope="session")
def shared() -> Path:
    """Folder of reference data beside the checkout; without it the test skips, but not in CI."""
    folder = _shared_folder()
    if not folder.is_dir():
        message = f"no reference data at {folder} (or set RAILQUAKE_SHARED)"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)
    return folder


@pytest.fixture
def another_claim(tmp_path, monkeypatch):
    """Lays the file of another claim of the paper beside the others: the documentation's example.

    Called with two texts, the second stands in the place of the first.
    """
    from railquake.findings import claims

    folder = tmp_path / "claims"
    folder.mkdir()
    page = Path(__file__).resolve().parents[1] / "docs" / "theory" / "findings.md"
    (text,) = re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), re.S)
    name = "fewer_derailments"
    monkeypatch.setattr(claims, "__path__", [*claims.__path__, str(folder)])

    def lay(old="", new=""):
        assert old in text
        (folder / f"{name}.py").write_text(text.replace(old, new), encoding="utf-8")

    yield lay
    sys.modules.pop(f"{claims.__name__}.{name}", None)
