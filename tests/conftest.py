"""Shared by all tests."""

import os
import re
import sys
from pathlib import Path

import pytest


def _shared_folder() -> Path:
    given = os.environ.get("RAILQUAKE_SHARED")
    return Path(given) if given else Path(__file__).resolve().parents[2] / "shared"


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
