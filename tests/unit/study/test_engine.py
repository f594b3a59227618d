"""Running a study: every run is a row, whatever becomes of it."""

import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import railquake as rq
from railquake.errors import InputError
from railquake.measures import all_keys
from railquake.run import many
from railquake.run.time_step import TimeStep
from railquake.study import batches, engine, open_results
from railquake.study.design import Design
from railquake.study.plan import plan
from study_files import BASE, MODELS, small, tables, untimed


def study(data=None):
    return rq.Study.from_dict(data or small())


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    out = tmp_path_factory.mktemp("study")
    return study().run(out, jobs=2), out


def test_there_is_a_row_for_every_run_in_the_designs_order(finished):
    table, _ = finished
    assert table["row"].tolist() == list(range(12))
    assert table["record"].tolist() == ["a"] * 6 + ["b"] * 6
    assert table["level"].tolist() == (["low"] * 3 + ["high"] * 3) * 2
    assert table["scale"].tolist() == [0.5] * 3 + [1.5] * 3 + [1.0] * 3 + [3.0] * 3
    assert table["model"].tolist() == ["coupled", "decoupled", "at-grade"] * 4
    assert set(table["status"]) <= {"safe", "onset", "derailed"}


def test_rows_are_those_of_the_lockstep_engine(finished):
    table, out = finished
    results = open_results(out)
    rows = dict(rq.simulate_many([results.scenario(row) for row in range(12)], threads=1))
    for row, measures in rows.items():
        for key in set(measures) - {"wall_s", "steps_per_s", "versions"}:
            found = table.loc[row, key]
            if measures[key] is None:
                assert found is None or np.isnan(found)
            else:
                assert found == measures[key], (row, key)


def test_columns_are_the_design_the_hash_the_keys_of_a_run_and_the_error(finished):
    table, _ = finished
    single = rq.assess(rq.simulate(open_results(finished[1]).scenario(0)))
    assert set(all_keys()) == set(single)
    design = ["row", "record", "level", "scale", "model", "scenario_hash"]
    assert list(table.columns) == [*design, *all_keys(), "error"]


def test_any_executor_and_number_of_threads_gives_the_same_table(finished, tmp_path):
    table, _ = finished
    assert untimed(study().run(tmp_path / "one", jobs=1)).equals(untimed(table))
    with ThreadPoolExecutor(3) as executor:
        own = study().run(tmp_path / "own", executor=executor)
    assert untimed(own).equals(untimed(table))


@pytest.fixture
def gpu(monkeypatch):
    """The CPU in the GPU's place; what it was asked for."""
    asked = []

    def on_cpu(scenarios, *, threads, device):
        asked.append((threads, device))
        return many.simulate_many(scenarios, threads=threads)

    def lanes_on(device, real=engine.lanes_on):
        asked.append(device)
        return real("cpu")

    monkeypatch.setattr(engine, "simulate_many", on_cpu)
    monkeypatch.setattr(engine, "lanes_on", lanes_on)
    return asked


def test_a_gpu_gives_the_same_table_and_takes_its_rows_as_one_queue(finished, gpu, tmp_path):
    seen = []
    table = study().run(tmp_path, device="cuda", progress=seen.append)
    assert gpu == ["cuda", (None, "cuda")]
    assert untimed(table).equals(untimed(finished[0]))
    assert [progress.done for progress in seen] == list(range(13))
    assert study().run(tmp_path).equals(table)  # complete, wherever it goes on


def test_a_stop_of_a_gpus_study_leaves_what_has_finished(gpu, tmp_path):
    def interrupt(progress):
        if progress.done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study().run(tmp_path, device="cuda", progress=interrupt)
    assert len(open_results(tmp_path).table) == 3


def test_a_gpu_that_is_not_there_is_refused_before_anything_is_written(tmp_path, monkeypatch):
    monkeypatch.setattr("railquake.run.gpu.missing_for_cuda", lambda: "none here")
    with pytest.raises(InputError, match="device: cuda cannot be used: none here"):
        study().run(tmp_path / "out", device="cuda")
    with pytest.raises(InputError, match='device: must be cpu or cuda, found "gpu"'):
        study().run(tmp_path / "out", device="gpu")
    assert not (tmp_path / "out").exists()


def test_a_gpu_goes_with_no_other_executor(gpu, tmp_path):
    with ThreadPoolExecutor(1) as executor:
        for other in ({"executor": executor}, {"scheduler": "tcp://127.0.0.1:1"}):
            with pytest.raises(InputError, match="give each GPU a shard"):
                study().run(tmp_path, device="cuda", **other)


def test_failed_runs_are_rows_with_their_reason(tmp_path):
    data = tables(**{"solver.dt": ["5e-5 s", "4.9e-4 s"], "motion.scale": [1.0, 2.0]})
    table = study(data).run(tmp_path)
    assert table["status"].tolist() == ["safe", "safe", "failed", "failed"]
    assert table["error"][2].startswith("solver.dt: 0.00049 s is above the critical time step")
    assert table["error"][0] is None
    assert np.isnan(table["pbv_m_s"][2])


def test_an_unforeseen_fault_of_one_run_is_a_row_and_the_others_finish(tmp_path, monkeypatch):
    def assemble(scenario, real=many.assemble):
        if scenario.motion.scale == 2.0:
            raise ZeroDivisionError("nobody foresaw this")
        return real(scenario)

    monkeypatch.setattr(many, "assemble", assemble)
    table = study(tables(**{"motion.scale": [1.0, 2.0, 3.0]})).run(tmp_path)
    assert table["status"].tolist() == ["safe", "failed", "safe"]
    assert table["error"][1] == "unexpected: ZeroDivisionError: nobody foresaw this"


def test_column_types_do_not_depend_on_what_happened(finished, tmp_path):
    data = small()
    data["base"] = {**BASE, "solver": {"dt": "4.9e-4 s"}}
    table = study(data).run(tmp_path)
    assert set(table["status"]) == {"failed"}
    assert table.dtypes.equals(finished[0].dtypes)


def test_equal_scenarios_are_run_once_and_each_is_a_row(tmp_path, monkeypatch):
    ran = []
    real = engine.run_batch
    monkeypatch.setattr(
        engine, "run_batch", lambda batch, stop=None: ran.extend(batch.rows) or real(batch, stop)
    )
    # the length of a pier that is not there does not matter
    data = tables(**{"support.length": [5.0, 6.0, 7.0], "model": [MODELS[2]]})
    table = study(data).run(tmp_path)
    assert ran == [0]
    assert table["row"].tolist() == [0, 1, 2]
    assert table["support.length"].tolist() == [5.0, 6.0, 7.0]
    assert table["pga_m_s2"].nunique() == 1


def test_shards_are_disjoint_and_together_the_whole(finished, tmp_path):
    rows = []
    for number in (1, 2, 3):
        part = study().run(tmp_path, shard=(number, 3))
        rows += part["row"].tolist()
    assert sorted(rows) == list(range(12))
    assert untimed(open_results(tmp_path).table).equals(untimed(finished[0]))


@pytest.mark.parametrize("shard", ["0/3", "4/3", "1", "a/b", "1/0", (2, 1)])
def test_a_wrong_shard_is_refused(shard, tmp_path):
    with pytest.raises(InputError, match="--shard: must be I/N"):
        study().run(tmp_path, shard=shard)


def test_a_shard_without_runs_is_refused(tmp_path):
    with pytest.raises(InputError, match="13/20 is empty, the study has 12 runs"):
        study().run(tmp_path, shard="13/20")


def test_progress_grows_to_the_whole(tmp_path):
    seen = []
    study().run(tmp_path, progress=seen.append)
    done = [progress.done for progress in seen]
    assert done == sorted(done) and done[-1] == 12
    assert {progress.total for progress in seen} == {12}
    assert seen[-1].remaining_s == 0.0 and seen[-1].runs_per_s > 0.0


def test_batches_share_a_kernel_and_are_of_similar_length():
    data = tables(
        **{
            "motion.synthetic.duration": [1.0, 2.0],
            "motion.synthetic.seed": list(range(20)),
            "support.hinge": ["elastic", "bouc-wen"],
        }
    )
    design = Design(study(data))
    work = plan(design, range(design.size), set(), workers=2)
    assert sorted(row for batch in work.batches for row in batch) == list(range(80))
    for batch in work.batches:
        labels = [design.point(row).labels for row in batch]
        assert len({label["support.hinge"] for label in labels}) == 1
    longest = [max(work.steps[row] for row in batch) for batch in work.batches]
    assert longest[0] == max(longest)


def test_a_stop_leaves_what_has_finished(tmp_path):
    """Ctrl-C reaches the thread that waits; the rows of the batches in work are kept."""
    data = tables(**{"motion.synthetic.seed": list(range(400)), "model": MODELS[:1]})

    def interrupt(progress):
        if progress.done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study(data).run(tmp_path, jobs=1, progress=interrupt)
    assert not [t for t in threading.enumerate() if t.name.startswith("railquake")]
    kept = len(open_results(tmp_path).table)
    assert 0 < kept < 400
    assert len(study(data).run(tmp_path)) == 400


def test_batches_stop_when_they_are_told():
    data = tables(**{"motion.synthetic.duration": ["600 s"]})
    batch = batches.Batch("stop", study(data), None, (0,), batches.physics())
    stop = threading.Event()
    threading.Timer(0.5, stop.set).start()
    begin = time.monotonic()
    assert batches.run_batch(batch, stop) == []
    assert time.monotonic() - begin < 60.0  # the run itself takes minutes


@pytest.fixture
def chooser(monkeypatch):
    """A chooser of time steps that notes what it was given."""
    given = []

    def choose_time_step(scenarios, tolerance=None, *, threads=None):
        given.extend(scenarios)
        return TimeStep(halvings=2, error=0.004, tolerance=0.01, tried=len(scenarios))

    monkeypatch.setattr(engine, "choose_time_step", choose_time_step)
    return given


def test_a_time_step_left_open_is_chosen_once_from_the_hardest_runs(chooser, tmp_path):
    data = small()
    data["base"] = {**BASE, "solver": {"dt": "auto"}}
    said = []
    table = study(data).run(tmp_path, notify=said.append)
    choice = TimeStep(halvings=2, error=0.004, tolerance=0.01, tried=3)
    assert said == [choice.text]
    hardest = {(s.support.kind, getattr(s.support, "coupled", None)) for s in chooser}
    assert hardest == {("pier", True), ("pier", False), ("at-grade", None)}
    assert {s.motion.scale for s in chooser} == {3.0}
    assert table["dt_s"].tolist()[:3] == [choice.of(s) for s in sorted_as_models(chooser)]
    assert set(table["dt_error"]) == {0.004}
    chooser.clear()
    assert study(data).run(tmp_path).equals(table)
    assert not chooser
    opened = open_results(tmp_path)
    assert [opened.scenario(row).solver.dt for row in range(12)] == table["dt_s"].tolist()


def sorted_as_models(scenarios):
    order = [("pier", True), ("pier", False), ("at-grade", None)]
    return sorted(
        scenarios, key=lambda s: order.index((s.support.kind, getattr(s.support, "coupled", None)))
    )


def test_an_axis_of_motions_keeps_memory_bounded(monkeypatch):
    from railquake.study import design as module

    monkeypatch.setattr(module, "_REMEMBERED", 8)
    made = Design(study(tables(**{"motion.synthetic.seed": list(range(40))})))
    for row in range(made.size):
        made.scenario(made.point(row))
    assert len(made._motions) == 8


def test_both_an_executor_and_a_scheduler_are_refused(tmp_path):
    with ThreadPoolExecutor(1) as executor, pytest.raises(InputError, match="not both"):
        study().run(tmp_path, executor=executor, scheduler="tcp://127.0.0.1:1")
    with pytest.raises(InputError, match="--jobs"):
        study().run(tmp_path, jobs=0)


# --- rows that cannot be made ------------------------------------------------------------------


@pytest.mark.parametrize("dt", ["5e-5 s", "auto"])
def test_a_row_that_raises_whatever_it_likes_stops_nothing_now_or_later(tmp_path, monkeypatch, dt):
    def assemble(scenario):
        if scenario.vehicle.speed == 20.0:
            raise ZeroDivisionError("of this row alone")
        return whole(scenario)

    import railquake.assembly

    whole = many.assemble
    monkeypatch.setattr(many, "assemble", assemble)
    monkeypatch.setattr(railquake.assembly, "assemble", assemble)
    monkeypatch.setattr(
        "railquake.study.plan.critical_time_step",
        lambda scenario: assemble(scenario.with_step(5e-5)).critical_dt,
    )
    data = tables(**{"vehicle.speed": [20.0, 10.0]})
    data["base"] = {**BASE, "solver": {"dt": dt}}
    for _ in range(2):  # the second time nothing but that row is left
        table = study(data).run(tmp_path / "out", jobs=1)
        assert (table["status"] == "failed").tolist() == [True, False]
        assert table["error"][0] == "unexpected: ZeroDivisionError: of this row alone"
