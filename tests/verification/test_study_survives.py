"""A study that is killed again and again ends with the table of one that was left alone."""

import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import railquake as rq
from railquake.inputs.toml import dumps
from railquake.study import open_results
from study_files import many, untimed

KILLS = 10
SEEDS = 80  # times three runs, a few seconds in all


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """The table, and how long it takes."""
    study = rq.Study.from_dict(many(SEEDS))
    list(rq.simulate_many([rq.scenario(synthetic={"seed": 1, "duration": "6 s"})], threads=1))
    begin = time.monotonic()
    table = study.run(tmp_path_factory.mktemp("undisturbed"), jobs=2)
    return table, time.monotonic() - begin


def started(file: Path, out: Path, *more: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "railquake", "study", str(file), "--out", str(out), *more]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def rows_on_disk(out: Path) -> int:
    return len(list((out / "parts").glob("*.parquet"))) if (out / "parts").is_dir() else 0


def test_ten_kills_at_random_moments_leave_no_trace(undisturbed, tmp_path):
    table, took = undisturbed
    (tmp_path / "study.toml").write_text(dumps(many(SEEDS)))
    out = tmp_path / "out"
    chance = random.Random(20231)
    kept = [0]
    for _ in range(KILLS):
        process = started(tmp_path / "study.toml", out)
        while process.poll() is None and rows_on_disk(out) == kept[-1] and len(kept) % 2:
            time.sleep(0.02)  # every other one dies after its first part, whenever that comes
        time.sleep(chance.uniform(0.0, 0.3 * took))
        process.send_signal(signal.SIGKILL)
        process.communicate()
        kept.append(rows_on_disk(out))
    assert kept == sorted(kept) and kept[-1] > 0  # what was kept stays
    process = started(tmp_path / "study.toml", out)
    _, errors = process.communicate()
    assert process.returncode == 0, errors
    assert untimed(open_results(out).table).equals(untimed(table))


def test_ctrl_c_says_how_to_go_on_and_keeps_what_has_finished(tmp_path):
    seeds = 5 * SEEDS  # some parts' worth, so that it is stopped in the middle
    (tmp_path / "study.toml").write_text(dumps(many(seeds)))
    out = tmp_path / "out"
    process = started(tmp_path / "study.toml", out, "--jobs", "1")
    while rows_on_disk(out) == 0:
        assert process.poll() is None
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert errors.count("\n") == 1 and "run the same command again to go on" in errors
    kept = open_results(out).table
    assert 0 < len(kept) < 3 * seeds
    process = started(tmp_path / "study.toml", out)
    process.communicate()
    table = open_results(out).table
    assert len(table) == 3 * seeds
    before = table[table["row"].isin(kept["row"])].reset_index(drop=True)
    assert before.equals(kept.reset_index(drop=True))  # timings too: they were not run again
