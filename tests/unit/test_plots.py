"""Every picture is written, and none is empty."""

import warnings
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread

import railquake as rq
from railquake import plots
from railquake.inputs.ground_motion import GroundMotion
from railquake.inputs.vehicle import Vehicle
from railquake.physics.profiles import zone_extremum
from railquake.plots import section
from railquake.plots.outline import outlines
from railquake.plots.roll import write_relative_roll
from railquake.plots.style import LONGEST, plain, signed, thinned

SHORT = {"seed": 3, "duration": "2 s", "pga": "0.6 g", "highpass_frequency": "0.6 Hz"}
OF_EVERY_RUN = ("histories.png", "wheel-loads.png", "relative-roll.png", "section.png")


@pytest.fixture(autouse=True)
def _no_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


@pytest.fixture
def drawn(monkeypatch):
    """Every figure saved, by its file's name."""
    figures = {}
    save = Figure.savefig

    def keep(figure, path, **options):
        figures[path.name] = figure
        save(figure, path, **options)

    monkeypatch.setattr(Figure, "savefig", keep)
    return figures


@pytest.fixture(scope="module")
def on_pier():
    return rq.simulate(rq.scenario(synthetic=SHORT))


@pytest.fixture(scope="module")
def elastic():
    strong = {**SHORT, "duration": "6 s", "pga": "2.6 g", "ground_frequency": "1.2 Hz"}
    return rq.simulate(rq.scenario(synthetic=strong, hinge="elastic"))


def assert_drawn(figure, path):
    """Its axes hold finite data, all words are within it, and the file shows more than white."""
    for ax in figure.axes:
        if ax.get_label() == "<colorbar>" or ax.get_ylabel() == "uplift ratio, 1":
            continue  # scales without data
        lines = [line for line in ax.lines if np.isfinite(line.get_xydata()).all(axis=1).any()]
        assert lines or ax.collections or ax.texts, ax.get_ylabel()
    box = figure.bbox
    for text in figure.findobj(matplotlib.text.Text):
        if text.get_visible() and text.get_text() and text in figure.texts:
            extent = text.get_window_extent()
            assert extent.x0 >= 0.0 and extent.x1 <= box.x1, text.get_text()
    for ax in figure.axes:
        if ax.get_ylabel() and ax.axison:
            assert ax.yaxis.label.get_window_extent().x0 >= -1.0, ax.get_ylabel()
    pixels = imread(path)
    assert 400 <= pixels.shape[1] <= 1400 and 300 <= pixels.shape[0] <= 1600
    assert 0.01 < (pixels[..., :3].min(axis=2) < 0.9).mean() < 0.7
    assert 15_000 < path.stat().st_size < 400_000


def assert_all_drawn(response, folder, drawn, names):
    paths = plots.write_pictures(response, folder)
    assert sorted(path.name for path in paths) == sorted(names)
    for path in paths:
        assert_drawn(drawn[path.name], path)


def test_pictures_of_a_run_on_a_pier(on_pier, tmp_path, drawn):
    assert_all_drawn(on_pier, tmp_path, drawn, (*OF_EVERY_RUN, "hinge-loop.png"))


def test_pictures_at_grade_leave_out_bridge_and_hinge(tmp_path, drawn):
    response = rq.simulate(rq.scenario(synthetic=SHORT, support="at-grade"))
    assert_all_drawn(response, tmp_path, drawn, OF_EVERY_RUN)
    texts = [ax.get_ylabel() for ax in drawn["histories.png"].axes]
    assert not any("bridge" in text or "hinge" in text for text in texts)


def test_pictures_on_a_prescribed_track_show_the_track_and_no_ground(tmp_path, drawn):
    time = np.linspace(0.0, 1.0, 201)
    rows = np.column_stack([time, 0.004 * (1.0 - np.cos(4.0 * np.pi * time))])
    file = tmp_path / "track.csv"
    np.savetxt(file, rows, delimiter=",", header="t_s,y_m", comments="")
    response = rq.simulate(rq.scenario(support={"kind": "prescribed", "file": str(file)}))
    assert_all_drawn(response, tmp_path, drawn, OF_EVERY_RUN)
    texts = [ax.get_ylabel() for ax in drawn["histories.png"].axes]
    assert any("track" in text for text in texts)
    assert not any("ground" in text for text in texts)


def test_pictures_of_a_train_that_has_left_the_track(elastic, tmp_path, drawn):
    assert elastic.status == "derailed"
    assert np.isnan(elastic.channel("lateral_shift_m")[-1])
    assert np.isfinite(elastic.channel("bridge_displacement_m")).all()
    assert_all_drawn(elastic, tmp_path, drawn, (*OF_EVERY_RUN, "hinge-loop.png"))
    rows = [label.get_text() for label in drawn["relative-roll.png"].axes[0].get_yticklabels()]
    assert "uplift" in rows and "onset of slide-off" in rows


def test_contact_points_lie_where_wheel_and_rail_overlap(on_pier):
    geometry = on_pier.system.geometry
    frame = on_pier.worst_frame
    place = section._Place(
        *(
            float(on_pier.channel(name)[frame])
            for name in ("lateral_shift_m", "wheelset_height_m", "relative_roll_rad")
        )
    )
    for side, sign in (("left", -1.0), ("right", 1.0)):
        for contact in section._contacts(on_pier, frame, side, place):
            first, last = (geometry.flange_points, len(geometry.wheel_y))
            if contact.zone == "flange":
                first, last = 0, geometry.flange_points
            gap = zone_extremum(sign * place.shift, sign * place.roll, first, last, geometry)[0]
            depth = on_pier.channel(f"penetration_{side}_{contact.zone}_m")[frame]
            assert place.height - gap == pytest.approx(depth, abs=1e-5)
            assert sign * contact.y > 0.7  # on its own side


def test_pictures_can_be_drawn_in_threads_and_leave_the_settings_alone(on_pier, tmp_path):
    settings = dict(matplotlib.rcParams)
    folders = [tmp_path / str(k) for k in range(2)]
    for folder in folders:
        folder.mkdir()
    with ThreadPoolExecutor(2) as pool:
        first, second = pool.map(lambda folder: plots.write_pictures(on_pier, folder), folders)
    assert dict(matplotlib.rcParams) == settings
    for one, other in zip(first, second, strict=True):
        assert one.read_bytes() == other.read_bytes(), one.name


@pytest.mark.parametrize(
    "name", ["$x^$", "a\\$b$", "\\frac{$1}", "記録\n1", "_" * 300, "$\\undefined$"]
)
def test_names_of_files_are_text_whatever_they_hold(on_pier, tmp_path, name):
    ground = replace(on_pier.system.ground, name=name)
    response = replace(on_pier, system=replace(on_pier.system, ground=ground))
    path = write_relative_roll(response, tmp_path / "roll.png")
    assert path.stat().st_size > 15_000
    motion = GroundMotion(name, 0.01, np.sin(np.arange(400) / 20.0))
    assert plots.write_motion_picture(motion, tmp_path / "m.png").stat().st_size > 15_000


def test_pictures_of_components(on_pier, tmp_path, drawn):
    x = 1e-3 * np.linspace(0.0, 1.0, 500) * np.sin(np.linspace(0.0, 20.0, 500))
    car = Vehicle.from_preset("bart")
    for path in (
        plots.write_motion_picture(on_pier.system.ground, tmp_path / "motion.png"),
        plots.write_hinge_picture(x, 1e9 * x, tmp_path / "hinge.png"),
        plots.write_creep_picture(1e7, 1.5e4, tmp_path / "creep.png"),
        plots.write_modes_picture(car, ["$a$ mode"] * 6, tmp_path / "modes.png"),
        plots.write_modes_picture(car, None, tmp_path / "numbered.png"),
    ):
        assert_drawn(drawn[path.name], path)


@pytest.mark.parametrize("moment", [[0.0], [0.0, 0.0], [1.0, 1.0, 1.0]])
def test_a_hinge_that_stays_where_it_is(tmp_path, moment):
    path = plots.write_hinge_picture(np.zeros(len(moment)), np.array(moment), tmp_path / "h.png")
    assert path.stat().st_size > 10_000


def test_every_preset_vehicle_has_an_outline_for_each_body():
    for preset in ("bart", "bart-2023-runs"):
        car = Vehicle.from_preset(preset)
        shapes = outlines(car)
        assert set(shapes) == {body.name for body in car.bodies}
        for outline in shapes.values():
            assert outline.y[0] == outline.y[-1] and outline.z[0] == outline.z[-1]


def test_text_from_files_is_no_formula():
    assert plain("$x$") == r"\$x\$"
    assert len(plain("x" * 1000)) == LONGEST


def test_numbers_have_a_minus_sign_and_three_digits():
    assert [signed(v) for v in (-0.5, 8.35, 34.2, 1513.2, -0.0)] == [
        "−0.500", "8.35", "34.2", "1513", "0.00",
    ]  # fmt: skip


def test_thinning_keeps_the_extremes():
    time = np.linspace(0.0, 1.0, 100_000)
    values = np.random.default_rng(1).normal(size=time.size)
    values[123], values[456] = 99.0, -99.0
    values[-50_000:] = np.nan
    kept_time, kept = thinned(time, values)
    assert len(kept) < 10_000
    assert np.nanmax(kept) == 99.0
    assert np.nanmin(kept) == -99.0
    assert kept_time[np.isfinite(kept)][-1] == time[49_999]  # drawn up to the gap
