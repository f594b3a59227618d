"""The benchmark runs and names its figures; it is never timed here."""

from railquake.bench import speed


def test_every_figure_has_its_name():
    row = speed.run_bench(repeats=1, seconds=False, short=True)
    for key in ("scalar_steps_per_s", "elastic_steps_per_s", "grid_steps_per_s"):
        assert row[key] > 0.0
    assert "opensees_pier_steps_per_s" in row
    assert row["processor"]
