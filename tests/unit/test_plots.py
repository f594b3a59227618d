"""Every picture is written, and none is empty."""

import numpy as np
import pytest

import railquake as rq
from railquake import plots
from railquake.inputs.vehicle import Vehicle
from railquake.plots.style import plain, thinned

SHORT = {"seed": 3, "duration": "2 s", "pga": "0.6 g", "highpass_frequency": "0.6 Hz"}


@pytest.mark.parametrize(
    ("inputs", "loop"), [({}, True), ({"support": "at-grade"}, False)], ids=["pier", "at grade"]
)
def test_pictures_of_a_run(tmp_path, inputs, loop):
    response = rq.simulate(rq.scenario(synthetic=SHORT, **inputs))
    paths = plots.write_pictures(response, tmp_path)
    names = {path.name for path in paths}
    assert {"histories.png", "wheel-loads.png", "relative-roll.png", "section.png"} <= names
    assert ("hinge-loop.png" in names) == loop
    for path in paths:
        assert path.read_bytes().startswith(b"\x89PNG")
        assert path.stat().st_size > 15_000


def test_pictures_of_a_train_that_has_left_the_track(tmp_path):
    strong = {**SHORT, "duration": "6 s", "pga": "2.6 g", "ground_frequency": "1.2 Hz"}
    response = rq.simulate(rq.scenario(synthetic=strong, hinge="elastic"))
    assert response.status == "derailed"
    assert np.isnan(response.channel("lateral_shift_m")[-1])
    assert np.isfinite(response.channel("bridge_displacement_m")).all()
    assert len(plots.write_pictures(response, tmp_path)) == 5


def test_pictures_of_components(tmp_path):
    motion = rq.scenario(synthetic=SHORT).ground_motion()
    x = np.linspace(0.0, 1e-3, 50)
    car = Vehicle.from_preset("bart")
    for path in (
        plots.write_motion_picture(motion, tmp_path / "motion.png"),
        plots.write_hinge_picture(x, 1e9 * x, tmp_path / "hinge.png"),
        plots.write_creep_picture(1e7, 1.5e4, tmp_path / "creep.png"),
        plots.write_modes_picture(car, ["mode"] * 6, tmp_path / "modes.png"),
    ):
        assert path.stat().st_size > 10_000


def test_text_from_files_is_no_formula():
    assert plain("$x$") == r"\$x\$"


def test_thinning_keeps_the_extremes():
    time = np.linspace(0.0, 1.0, 100_000)
    values = np.random.default_rng(1).normal(size=time.size)
    values[123], values[456] = 99.0, -99.0
    values[-50_000:] = np.nan
    _, kept = thinned(time, values)
    assert len(kept) < 10_000
    assert np.nanmax(kept) == 99.0
    assert np.nanmin(kept) == -99.0
