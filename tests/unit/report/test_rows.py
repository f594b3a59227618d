"""A report takes its numbers from the rows, and completes those of older versions."""

import pandas as pd
import pyarrow.parquet as pq
import pytest

from railquake.errors import InputError
from railquake.report import (
    curves,
    decoupled,
    failures,
    hinges,
    lateral,
    spectra,
    summary,
    trust,
    uplift,
    vehicle,
)
from railquake.report.context import Context, Text
from railquake.report.older import completed
from railquake.study import StudyResults, engine, open_results
from study_for_reports import study

LATER = ["friction", "t1_s", "sa_t1_m_s2", "substeps", "hinge_law", "lateral_force_filter_hz"]
NUMERIC = (summary, vehicle, spectra, uplift, decoupled, lateral, curves, failures)


def context(folder):
    return Context(open_results(folder), str(folder), lambda _: None)


@pytest.fixture
def older_folder(folder):
    """The study as a version left it whose rows carried less."""
    for path in (folder / "runs.parquet", *(folder / "parts").glob("*.parquet")):
        pq.write_table(pq.read_table(path).drop_columns(LATER), path, write_page_checksum=True)
    return folder


def test_a_report_opens_no_scenario_for_a_number(kept_folder, monkeypatch):
    def opened(self, row):
        raise AssertionError(f"row {row}: a scenario was asked for")

    monkeypatch.setattr(StudyResults, "scenario", opened)
    asked = context(kept_folder)
    for module in NUMERIC:
        section = module.section(asked)
        if module is not curves:  # these runs are too few to reach the onset
            assert not all(isinstance(block, Text) and block.kind for block in section.blocks)
    assert asked.table["sa_t1_m_s2"].notna().sum() == 48  # on piers
    (chart,) = lateral.section(asked).blocks
    assert "low-pass at 20 Hz" in chart.caption
    assert len(hinges._telling(asked)) >= 2


def test_what_is_run_again_says_so_where_it_cannot_be(kept_folder, monkeypatch):
    def gone(self, row):
        raise InputError("record.at2: cannot be read")

    monkeypatch.setattr(StudyResults, "scenario", gone)
    asked = context(kept_folder)
    (said,) = hinges.section(asked).blocks
    assert said.text == "The runs cannot be made again: record.at2: cannot be read."
    residuals, _, said, origin = trust.section(asked).blocks
    assert said.text == "Its error cannot be measured: record.at2: cannot be read."
    assert residuals.points > 0 and origin.rows


def test_rows_of_an_older_version_are_completed_to_the_same_numbers(older_folder, kept_folder):
    new, old = open_results(kept_folder).table, open_results(older_folder).table
    assert old[LATER].isna().all(axis=None)
    found = completed(open_results(older_folder))
    for name in ("friction", "t1_s", "sa_t1_m_s2", "lateral_force_filter_hz"):
        pd.testing.assert_series_equal(found[name], new[name], rtol=1e-12)
    assert found["hinge_law"].tolist() == new["hinge_law"].tolist()
    assert uplift.section(context(older_folder)).blocks[1].panels
    whole = open_results(kept_folder)
    assert completed(whole) is whole.table


def test_rows_of_an_older_version_whose_scenarios_are_gone_lack_the_numbers(
    older_folder, monkeypatch
):
    def gone(self, row):
        raise InputError("record.at2: cannot be read")

    monkeypatch.setattr(StudyResults, "scenario", gone)
    asked = context(older_folder)
    assert asked.table[LATER].isna().all(axis=None)
    (said,) = lateral.section(asked).blocks
    assert said.text == "No run has a lateral force to show."
    charts = [block.name for block in uplift.section(asked).blocks]
    assert charts == ["figure-7-uplift", "measures"]


def test_a_study_of_an_older_version_is_not_run_again(older_folder, monkeypatch):
    def run_batch(batch, stop=None):
        raise AssertionError(f"rows {batch.rows} are run")

    monkeypatch.setattr(engine, "run_batch", run_batch)
    said = []
    table = study().run(older_folder, jobs=1, notify=said.append)
    assert len(table) == 60 and said == []
    assert table[LATER].isna().all(axis=None)
    assert set(table["status"]) <= {"safe", "onset", "derailed"}
