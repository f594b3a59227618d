"""Cases with closed forms, through the whole engine: each is a comparison of the package."""

import pytest

from railquake.validation import registry
from railquake.validation.runner import run_one

CASES = [name for name in registry.COMPARISONS if name.startswith("classical_")]


@pytest.mark.parametrize("name", CASES)
def test_engine_agrees_with_the_closed_form(name):
    report = run_one(name, registry.load(name), None)
    assert report.error is None
    outside = [r for r in report.outcome.results if not r.agrees]
    assert not outside, outside
