"""Shared by all tests."""

import os
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
