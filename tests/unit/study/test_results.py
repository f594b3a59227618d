"""The folder of a study: nothing that has finished is lost, and nothing foreign is taken in."""

import errno
import json
import re
import shutil

import pandas as pd
import pytest

import railquake as rq
from railquake.errors import InputError
from railquake.study import engine, folder, merge_results, open_results
from railquake.study import table as columns
from study_files import BASE, MODELS, small, tables, untimed


def study(data=None):
    return rq.Study.from_dict(data or small())


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    out = tmp_path_factory.mktemp("whole") / "study"
    return study().run(out, jobs=1), out


@pytest.fixture
def copy(whole, tmp_path):
    """A finished study to damage."""
    out = tmp_path / "copy"
    shutil.copytree(whole[1], out)
    return out


@pytest.fixture
def ran(monkeypatch):
    """Rows that are run."""
    rows = []
    real = engine.run_batch

    def run_batch(batch, stop=None):
        rows.extend(batch.rows)
        return real(batch, stop)

    monkeypatch.setattr(engine, "run_batch", run_batch)
    return rows


def test_a_finished_study_is_read_and_not_run_again(whole, ran):
    table, out = whole
    assert study().run(out).equals(table)
    assert not ran


def test_the_table_on_the_disk_is_the_one_in_memory(whole):
    table, out = whole
    assert open_results(out).table.equals(table)
    read = pd.read_parquet(out / "runs.parquet")
    assert list(read.columns) == list(table.columns)
    assert read["pbv_m_s"].equals(table["pbv_m_s"])
    assert read["uplifts"].dtype == table["uplifts"].dtype
    assert read["derailed"].dtype == table["derailed"].dtype


def test_a_row_gives_its_scenario_again(whole):
    table, out = whole
    opened = open_results(out)
    for row in range(12):
        assert opened.scenario(row).content_hash() == table["scenario_hash"][row]
    with pytest.raises(InputError, match="there is no row 12; rows are 0 to 11"):
        opened.scenario(12)


def test_missing_rows_are_run_and_the_table_is_that_of_an_undisturbed_run(copy, whole, ran):
    here = folder.ResultsFolder(copy)
    schema = columns.table_schema(open_results(copy).design)
    rows = columns.distinct(here.load(schema, print)).take([0, 3, 7])
    for part in (copy / "parts").iterdir():
        part.unlink()
    folder.write_parquet(rows, copy / "parts" / "some.parquet")
    (copy / "runs.parquet").unlink()
    assert open_results(copy).missing == 9
    table = study().run(copy)
    assert sorted(ran) == [1, 2, 4, 5, 6, 8, 9, 10, 11]
    assert untimed(table).equals(untimed(whole[0]))


@pytest.mark.parametrize("keep", [0, 1, 100, -8, -200])
def test_a_truncated_part_is_reported_and_computed_again(copy, whole, keep):
    part = next((copy / "parts").glob("*.parquet"))
    part.write_bytes(part.read_bytes()[:keep])
    said = []
    table = study().run(copy, notify=said.append)
    assert len(said) == 1 and "truncated or damaged" in said[0] and part.name in said[0]
    assert untimed(table).equals(untimed(whole[0]))
    assert study().run(copy, notify=said.append).equals(table)
    assert len(said) == 1


def test_flipped_bits_of_a_part_are_found(copy, whole):
    part = next((copy / "parts").glob("*.parquet"))
    data = bytearray(part.read_bytes())
    for place in range(200, 400):
        data[place] ^= 0xFF
    part.write_bytes(bytes(data))
    said = []
    table = study().run(copy, notify=said.append)
    assert "truncated or damaged" in said[0]
    assert untimed(table).equals(untimed(whole[0]))


def test_a_changed_study_is_refused_with_what_differs(copy):
    data = small()
    data["suite"]["levels"]["low"] = 0.6
    data["base"] = {**BASE, "vehicle": {**BASE["vehicle"], "speed": "90 km/h"}}
    with pytest.raises(InputError) as error:
        study(data).run(copy)
    text = str(error.value)
    assert "\n" not in text and "holds another study" in text
    assert 'base.vehicle.speed was "80 km/h", now is "90 km/h"' in text
    assert "suite.levels.low was 0.5, now is 0.6" in text


def test_another_order_of_levels_is_another_study(copy):
    data = small()
    data["suite"]["levels"] = {"high": 1.5, "low": 0.5}
    with pytest.raises(InputError, match="the order of axes, levels or motions was another"):
        study(data).run(copy)


def test_a_record_that_has_changed_is_run_again(tmp_path, ran):
    record = tmp_path / "motion.csv"

    def write(peak):
        lines = [f"{0.01 * k:.2f},{peak if k == 50 else 0.0}" for k in range(101)]
        record.write_text("\n".join(lines) + "\n")

    write(0.2)
    data = {"base": {**BASE, "motion": {"record": str(record), "units": "g"}}}
    first = study(data).run(tmp_path / "out")
    write(0.25)
    with pytest.raises(InputError, match="has changed since it was run"):
        open_results(tmp_path / "out").scenario(0)
    second = study(data).run(tmp_path / "out")
    assert ran == [0, 0]
    assert len(second) == 1
    assert second["pga_m_s2"][0] == pytest.approx(1.25 * first["pga_m_s2"][0])


def test_failed_runs_are_tried_again(tmp_path, ran):
    data = tables(**{"solver.dt": ["4.9e-4 s"]})
    table = study(data).run(tmp_path)
    assert study(data).run(tmp_path).equals(table)
    assert ran == [0, 0]


def test_a_full_disk_is_one_line_and_finished_rows_are_kept(tmp_path, monkeypatch, whole):
    real, calls = folder.write_parquet, []

    def full(table, path):
        calls.append(path)
        if len(calls) > 1:
            path.write_bytes(b"PAR1")  # what fitted
            raise OSError(errno.ENOSPC, "No space left on device")
        real(table, path)

    monkeypatch.setattr(engine, "FLUSH_S", 0.0)
    monkeypatch.setattr(folder, "write_parquet", full)
    with pytest.raises(InputError, match=r"No space left on device; \d+ rows.*are kept") as error:
        study().run(tmp_path / "out", jobs=1)
    assert "\n" not in str(error.value)
    monkeypatch.setattr(folder, "write_parquet", real)
    kept = int(re.search(r"(\d+) rows", str(error.value))[1])
    assert 0 < kept < 12
    assert open_results(tmp_path / "out").missing == 12 - kept
    assert not list((tmp_path / "out" / "parts").glob(".*"))
    assert untimed(study().run(tmp_path / "out")).equals(untimed(whole[0]))


def test_a_folder_that_cannot_be_written_is_refused_before_anything_runs(tmp_path, ran):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="is no folder"):
        study().run(tmp_path / "file")
    with pytest.raises(InputError, match="cannot be written"):
        study().run("/proc/nowhere/study")
    assert not ran


def test_results_of_nobody_knows_what_are_left_alone(tmp_path):
    (tmp_path / "parts").mkdir()
    with pytest.raises(InputError, match=r"no study\.toml that says of which study"):
        study().run(tmp_path)


def test_an_empty_a_foreign_and_an_unfinished_folder_are_refused(tmp_path, whole):
    with pytest.raises(InputError, match="there is no such folder"):
        open_results(tmp_path / "none")
    with pytest.raises(InputError, match="is empty"):
        open_results(tmp_path)
    (tmp_path / "photo.jpg").write_text("")
    with pytest.raises(InputError, match="holds no study"):
        open_results(tmp_path)
    shutil.copy(whole[1] / "study.toml", tmp_path)
    with pytest.raises(InputError, match="without any finished run"):
        open_results(tmp_path)


def test_a_damaged_table_is_named(copy):
    (copy / "runs.parquet").write_bytes(b"PAR1")
    with pytest.raises(InputError, match="is damaged; run the study again"):
        _ = open_results(copy).table


@pytest.fixture(scope="module")
def shards(tmp_path_factory):
    folder = tmp_path_factory.mktemp("shards")
    for number in (1, 2):
        study().run(folder / str(number), shard=(number, 2))
    return folder


def test_shards_in_folders_of_their_own_merge_into_the_whole(shards, whole, tmp_path):
    merged = merge_results([shards / "1", shards / "2"], tmp_path / "all")
    assert merged.missing == 0
    assert untimed(merged.table).equals(untimed(whole[0]))


def test_merging_says_how_many_rows_are_missing(shards, tmp_path):
    said = []
    merged = merge_results([shards / "2"], tmp_path / "all", notify=said.append)
    assert merged.table["row"].tolist() == [1, 3, 5, 7, 9, 11]
    assert said == ["6 of 12 rows are missing"]


def test_shards_of_different_studies_do_not_merge(shards, tmp_path):
    other = small()
    other["axes"] = {"model": MODELS[:2]}
    study(other).run(tmp_path / "other", shard=(1, 2))
    with pytest.raises(InputError, match="holds another study"):
        merge_results([shards / "1", tmp_path / "other"], tmp_path / "all")


def test_an_axis_may_not_be_called_like_a_measure(tmp_path):
    data = tables(status=[{"name": "a", "set": {}}])
    with pytest.raises(InputError, match="axes.status: the table has a column of this name"):
        study(data).run(tmp_path / "out")


def test_a_damaged_time_step_is_refused(copy):
    (copy / "time_step.json").write_text(json.dumps({"dt": 1}))
    with pytest.raises(InputError, match="time_step.json: is damaged"):
        folder.ResultsFolder(copy).time_step()
