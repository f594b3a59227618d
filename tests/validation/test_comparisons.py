"""Every comparison of `railquake validate` agrees; the numbers it uses are its source's."""

import os
from pathlib import Path

import numpy as np
import pytest

from railquake.validation import registry
from railquake.validation.reference import columns, numbers_beside, toml
from railquake.validation.runner import run_one

DOCS = Path(__file__).resolve().parents[2] / "docs"
IN_CI = bool(os.environ.get("CI"))


def comparisons():
    """The registry's; those that take minutes run in continuous integration only.

    Those with closed forms need no data: `test_classical_cases` runs them.
    """
    for name in registry.COMPARISONS:
        if name.startswith("classical_"):
            continue
        slow = getattr(registry.load(name), "SLOW", False)
        marks = [pytest.mark.skipif(not IN_CI, reason="takes minutes; set CI=1")] if slow else []
        yield pytest.param(name, marks=marks, id=name)


@pytest.mark.parametrize("name", list(comparisons()))
def test_agrees(shared, name):
    report = run_one(name, registry.load(name), shared)
    if report.skipped and not IN_CI:
        pytest.skip(report.skipped)
    assert report.skipped is None and report.error is None
    outside = [result for result in report.outcome.results if not result.agrees]
    assert not outside


@pytest.mark.parametrize("name", registry.COMPARISONS)
def test_says_its_source_what_is_compared_and_why_the_tolerance(name):
    comparison = registry.load(name)
    for text in (comparison.TITLE, comparison.SOURCE, comparison.WHAT, comparison.WHY):
        assert len(text) > 10
    assert "\n" not in comparison.TITLE


@pytest.mark.parametrize(
    ("comparison", "here", "source"),
    [
        ("hinge_steps", "generic.csv", "dev_generic.csv"),
        ("hinge_steps", "hinge.csv", "dev_hinge.csv"),
        ("contact_states", "normal.csv", "contact_normal.csv"),
        ("contact_states", "lobes.csv", "contact_normal_lobes.csv"),
        ("creep_laws", "contact_creep.csv", "contact_creep.csv"),
        ("creep_with_spin", "contact_flange_creep.csv", "contact_flange_creep.csv"),
        ("kalker_coefficients", "kalker_table.csv", "kalker_table.csv"),
        (
            "kalker_coefficients",
            "contact_kalker_coefficients.csv",
            "contact_kalker_coefficients.csv",
        ),
    ],
)
def test_the_numbers_here_are_those_of_the_source(shared, comparison, here, source):
    theirs = columns(shared / "oracles" / source)
    for column, values in columns(numbers_beside(comparison, here)).items():
        np.testing.assert_array_equal(values, theirs[column])


def test_docs_state_each_creep_laws_error_as_it_is_held():
    lines = (DOCS / "theory" / "creep.md").read_text().splitlines()
    for law, bounds in toml(numbers_beside("creep_laws", "bounds.toml")).items():
        cells = f"| {bounds['none']:.3f} | {bounds['spin']:.3f} |"
        assert any(line.startswith(f'| `"{law}"`') and cells in line for line in lines), law


def test_docs_state_each_creep_laws_error_on_flanges_as_it_is_held():
    lines = (DOCS / "theory" / "creep.md").read_text().splitlines()
    for law, bounds in toml(numbers_beside("creep_with_spin", "bounds.toml")).items():
        cells = " | ".join(f"{value:.3f}" for value in bounds.values())
        assert any(line.startswith(f'| `"{law}"`') and cells in line for line in lines), law


def test_the_docs_page_has_every_comparison_and_its_plots():
    page = (DOCS / "validation.md").read_text()
    for name in registry.COMPARISONS:
        assert f"({name.replace('_', '-')})=" in page, "run make validate"
    drawn = [line.split()[-1] for line in page.splitlines() if line.startswith("```{figure}")]
    assert drawn and all((DOCS / file).is_file() for file in drawn)
    here = {path.name for path in (DOCS / "images" / "validation").iterdir()}
    assert here == {Path(file).name for file in drawn}  # none is left from a former run
