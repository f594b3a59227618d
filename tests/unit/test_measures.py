"""Measures are declared once, and rows, tables, axes and the documentation follow from that."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lsim

import railquake as rq
from railquake import measures
from railquake.cli import single
from railquake.inputs.ground_motion import GroundMotion, response_spectrum, spectral_intensity
from railquake.measures import Intensity, Kind, Measure, StateRow, all_keys, named
from railquake.report import uplift
from railquake.report.context import Context
from railquake.run import spectral
from railquake.study import open_results
from study_files import small

DOCS = Path(__file__).parents[2] / "docs"
SHORT = {"seed": 3, "duration": "1 s", "dt": "0.01 s", "pga": "0.6 g", "highpass_frequency": "1 Hz"}


def cases():
    return [
        rq.scenario(synthetic=SHORT),
        rq.scenario(synthetic=SHORT, hinge="elastic"),
        rq.scenario(synthetic=SHORT, support="at-grade"),
        rq.scenario(synthetic=SHORT, wheelrail={"preset": "bart", "friction": 0.45}, substeps=4),
    ]


@pytest.fixture(scope="module")
def rows():
    """Of each engine, in the order of the cases."""
    many = dict(rq.simulate_many(cases(), threads=1))
    return {
        "one by one": [rq.assess(rq.simulate(case)) for case in cases()],
        "many abreast": [many[k] for k in range(len(many))],
    }


@pytest.fixture(params=["one by one", "many abreast"])
def engine(request):
    return request.param


# --- the declarations --------------------------------------------------------------------------


def test_every_key_of_a_row_is_declared_and_nothing_else_is_in_a_row(rows, engine):
    for row in rows[engine]:
        assert tuple(row) == all_keys()


def test_values_are_of_the_declared_kind_and_none_only_where_that_is_said(rows, engine):
    for row in rows[engine]:
        for measure in measures.MEASURES:
            value = row[measure.key]
            if value is None:
                assert measure.optional, measure.key
            elif measure.key != "versions":
                assert type(value) is measure.value, measure.key


def test_every_measure_has_a_unit_a_caption_a_short_name_and_a_meaning():
    assert len(set(all_keys())) == len(all_keys())
    for measure in measures.MEASURES:
        assert measure.short and measure.caption and measure.meaning, measure.key
        assert bool(measure.unit) == (measure.value in (float, int)), measure.key


def test_a_key_ends_with_its_unit():
    ends = {"m": "_m", "m/s": "_m_s", "m/s2": "_m_s2", "rad": "_rad", "N": "_n", "N m": "_n_m",
            "s": "_s", "J": "_j", "Hz": "_hz", "1/s": "_per_s"}  # fmt: skip
    for measure in measures.MEASURES:
        if measure.unit not in ("", "1"):
            assert measure.key.endswith(ends[measure.unit]), measure.key


def test_the_paper_s_choice_comes_first_of_what_uplift_is_held_against():
    assert measures.correlated()[0] == "pbv_m_s"
    assert [measures.short_name(key) for key in measures.correlated()] == [
        "PBV", "PBA", "PGV", "PGA", "Sa(T₁)",
    ]  # fmt: skip


def test_a_run_made_again_has_the_same_measures_but_for_those_that_do_not_repeat(rows, engine):
    again = {
        "one by one": lambda: rq.assess(rq.simulate(cases()[1])),
        "many abreast": lambda: dict(rq.simulate_many(cases()[1:2], threads=1))[0],
    }[engine]()
    for measure in measures.MEASURES:
        if measure.repeats:
            assert again[measure.key] == rows[engine][1][measure.key], measure.key


def test_axes_carry_caption_and_unit():
    assert named("pbv_m_s").named_axis == "PBV: peak bridge velocity, m/s"
    assert named("pba_m_s2").axis == "peak bridge acceleration, m/s²"
    assert named("pbd_m").axis == "peak bridge displacement, mm"
    assert named("uplift_ratio").axis == "normalised uplift"


@pytest.mark.parametrize(
    ("key", "value", "line"),
    [
        ("pga_m_s2", 4.903325, "peak ground acceleration 0.5 g"),
        ("pba_m_s2", 1.25, "peak bridge acceleration 1.25 m/s2"),
        ("uplift_ratio", 0.5, "normalised uplift        0.5 (1: ...)"),
        ("lateral_force_filtered_peak_n", 2e4, "peak lateral force       20 kN, impacts filtered"),
        ("pbd_m", None, "peak bridge displacement -"),
    ],
)
def test_a_run_s_lines_are_in_the_units_in_which_people_read(key, value, line):
    remark = "(1: ...)" if key == "uplift_ratio" else ""
    assert single._line(named(key), value, remark) == line


# --- what rows carry ---------------------------------------------------------------------------


def test_rows_carry_what_was_run(rows):
    for name, usual in (("one by one", 1), ("many abreast", 10)):
        elastic, at_grade, other = rows[name][1:]
        assert (elastic["friction"], other["friction"]) == (0.3, 0.45)
        assert (elastic["substeps"], other["substeps"]) == (usual, 4)
        assert (elastic["hinge_law"], other["hinge_law"]) == ("elastic", "bouc-wen")
        assert elastic["lateral_force_filter_hz"] == 20.0
        assert at_grade["friction"] == 0.3
        assert at_grade["t1_s"] is at_grade["sa_t1_m_s2"] is at_grade["hinge_law"] is None


def test_period_and_spectral_acceleration_are_those_of_an_oscillator(rows, engine):
    motion = cases()[1].ground_motion()
    row = rows[engine][1]
    assert row["t1_s"] == pytest.approx(0.411, abs=5e-4)  # authors' pier with an elastic hinge
    assert rows[engine][0]["t1_s"] == row["t1_s"]
    omega = 2.0 * np.pi / row["t1_s"]
    oscillator = ([-1.0], [1.0, 2.0 * 0.05 * omega, omega**2])  # ground acceleration to position
    _, position, _ = lsim(oscillator, motion.acceleration, motion.time, interp=True)
    assert row["sa_t1_m_s2"] == pytest.approx(omega**2 * np.abs(position).max(), rel=1e-9)


@pytest.mark.parametrize(("dt", "period"), [(0.01, 0.411), (0.02, 0.1), (0.005, 3.0)])
def test_spectral_acceleration_is_that_of_the_spectra(dt, period):
    motion = GroundMotion("noise", dt, np.random.default_rng(1).standard_normal(1500))
    known = response_spectrum(motion, [period], 0.05).psa[0]
    assert spectral.spectral_acceleration(motion, period) == pytest.approx(known, rel=1e-12)


@pytest.mark.parametrize(
    ("remembered", "key"),
    [(spectral._ordinate, "sa_t1_m_s2"), (spectral._intensity, "si_ground_m_s")],
)
def test_runs_that_share_a_motion_share_its_spectrum(remembered, key):
    many = dict(rq.simulate_many(cases()[:2], threads=1))
    before = remembered.cache_info()
    again = dict(rq.simulate_many(cases()[:2], threads=1))
    after = remembered.cache_info()
    assert after.hits == before.hits + 2 and after.misses == before.misses
    assert many[0][key] == again[1][key]


def test_spectral_intensity_of_a_row_is_that_of_the_motion():
    motion = rq.scenario(synthetic=SHORT).ground_motion()
    assert spectral.spectral_intensity(motion) == pytest.approx(
        spectral_intensity(motion), rel=1e-12
    )


# --- a measure that comes later ----------------------------------------------------------------


@pytest.fixture
def planted(monkeypatch):
    """A measure of a row of the state, declared and nothing else."""
    measure = Measure(
        "planted_peak_rad", Kind.STRUCTURE, "rad", "PLT", "peak of something",
        meaning="planted by a test", place=StateRow("PEAK_THETA2"), step_floor=0.0,
        intensity=Intensity(9, "plt", "Peak Something", "rad"),
    )  # fmt: skip
    monkeypatch.setattr(measures, "MEASURES", (*measures.MEASURES, measure))
    return measure


def test_a_new_measure_is_in_row_table_and_report_once_it_is_declared(planted, tmp_path):
    row = rq.assess(rq.simulate(cases()[1]))
    assert row["planted_peak_rad"] == row["top_rotation_peak_rad"] > 0.0

    data = small()
    data["axes"] = {"model": data["axes"]["model"][:1]}
    data["suite"]["levels"] = {"low": 0.5, "high": 1.5, "higher": 2.0}
    table = rq.Study.from_dict(data).run(tmp_path / "out", jobs=1)
    assert table["planted_peak_rad"].equals(
        table["top_rotation_peak_rad"].rename("planted_peak_rad")
    )

    context = Context(open_results(tmp_path / "out"), "out", lambda _: None)
    charts = {chart.name: chart for chart in uplift.section(context).blocks}
    ticks = [name for _, name in charts["measures"].panels[0].y_ticks]
    assert ticks == ["PBV", "PBA", "PGV", "PGA", "Sa(T₁)", "PLT"]
    assert measures.named("planted_peak_rad").axis == "peak of something, rad"

    reached = np.arange(len(table)) % 2 == 0
    curve = rq.Fragility.from_table(
        table.assign(status=np.where(reached, "derailed", "safe")), "derailed", "plt", replicates=0
    )
    assert curve.measure == "plt"
    curve.to_csv(tmp_path / "plt.csv", "train")
    assert "Peak Something,rad" in (tmp_path / "plt.csv").read_text()
    assert "`planted_peak_rad`" in generated().measures(Kind.STRUCTURE)


# --- the documentation -------------------------------------------------------------------------


def generated():
    """The module that makes reference pages."""
    spec = importlib.util.spec_from_file_location("generated", DOCS / "generated.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_documentation_s_tables_are_the_list():
    make = generated().measures
    rows = [
        [cell.strip() for cell in line.split(" | ")]
        for kind in Kind
        for line in make(kind).splitlines()[2:]
    ]
    listed = [row[0].strip("| `") for row in rows]
    assert sorted(listed) == sorted(all_keys())
    for row, key in zip(rows, listed, strict=True):
        measure = named(key)
        assert row[1] == measures.printed(measure.unit)
        assert measure.caption in row[2] and measure.short in row[2]
        assert row[3].removesuffix(" |") == measure.meaning


def test_the_page_of_measures_shows_all_kinds_under_their_headings():
    page = (DOCS / "measures.md").read_text(encoding="utf-8")
    shown = re.findall(r"^## (.+)\n(?:(?!^## )[\s\S])*?reference/measures-(\w+)\.md", page, re.M)
    assert shown == [(kind.value, kind.name.lower()) for kind in Kind]
    for key in all_keys():  # no table by hand beside them
        assert f"| `{key}`" not in page
