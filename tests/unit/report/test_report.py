"""The report: whole, self-contained, true to the study, and clear where something is missing."""

import csv
import json
import re
import shutil

import pytest

import railquake as rq
from railquake.cli import main
from railquake.report import trust, write_report
from railquake.report.context import Context, Text
from railquake.study import open_results
from study_for_reports import NASTY, study

SECTIONS = (
    "summary", "vehicle", "spectra", "hinges", "uplift", "decoupled", "lateral", "fragility",
    "failures", "trust",
)  # fmt: skip


def charts(page):
    """What the page's script draws."""
    text = page.read_text(encoding="utf-8")
    found = re.search(r'<script type="application/json" id="charts">(.*?)</script>', text, re.S)
    return json.loads(found[1])


def test_the_report_has_all_sections_and_each_figure_three_times(report):
    text = report.read_text(encoding="utf-8")
    assert re.findall(r'<section id="(\w+)">', text) == list(SECTIONS)
    names = [chart["name"] for chart in charts(report)["charts"]]
    assert {"suite-spectra", "hinge-loops", "figure-7-uplift", "measures", "figures-8-9-decoupled",
            "figure-10-lateral-force", "energy-residuals"} <= set(names)  # fmt: skip
    for name in names:
        assert (report.parent / "figures" / f"{name}.png").stat().st_size > 5000
        assert (report.parent / "figures" / f"{name}.csv").stat().st_size > 100


def test_nothing_is_fetched_and_the_file_is_of_moderate_size(report):
    text = report.read_text(encoding="utf-8")
    outside_plotly = re.sub(r"<script>\n/\*\*.*?</script>", "", text, count=1, flags=re.S)
    assert len(outside_plotly) < 1_500_000
    assert not re.search(r'(src|href)\s*=\s*["\'](https?:)?//', outside_plotly)
    assert "default-src 'none'" in text
    assert report.stat().st_size < 8_000_000


def test_texts_from_files_are_escaped(report):
    text = report.read_text(encoding="utf-8")
    assert "<img" not in text.split('id="charts"')[0]
    assert "&lt;img src=x" in text or "\\u0026lt;img src=x" in text
    assert text.count("</script>") == 3


def test_every_point_knows_the_run_that_it_shows(report):
    page = charts(report)
    assert page["command"] == [f"railquake rerun '{report.parent}'", "--out result"]
    table = open_results(report.parent).table.set_index("row")
    (uplift,) = [chart for chart in page["charts"] if chart["name"] == "figure-7-uplift"]
    drawn = [
        trace for panel in uplift["panels"] for trace in panel["data"] if "customdata" in trace
    ]
    assert sum(len(trace["x"]) for trace in drawn) == 24 + 36  # PBV on piers; PBA at grade, too
    for trace in drawn:
        assert "%{customdata}" in trace["hovertemplate"]
        for row, y in zip(trace["customdata"], trace["y"], strict=True):
            assert y == pytest.approx(table.at[row, "uplift_ratio"], rel=1e-3)


def test_figures_as_tables_hold_the_study_s_own_numbers(report):
    table = open_results(report.parent).table.set_index("row")
    with open(report.parent / "figures" / "figure-7-uplift.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["kind"] == "point"]
    for row in rows:
        assert float(row["y"]) == pytest.approx(table.at[int(row["row"]), "uplift_ratio"], rel=1e-6)


def test_the_summary_comes_first_and_answers_three_questions_with_numbers(report):
    text = report.read_text(encoding="utf-8")
    summary = text[text.index('<section id="summary">') : text.index('<section id="vehicle">')]
    assert summary.count('class="question"') == 3
    assert "60 runs under 6 ground motions" in summary
    assert len(re.findall(r"\d\.\d\d \(.?\d\.\d\d to .?\d\.\d\d\)", summary)) > 5
    assert summary.count('class="verdict') == 12


def test_another_claim_s_file_is_enough_for_the_report(folder, another_claim):
    another_claim()
    text = write_report(folder).read_text(encoding="utf-8")
    assert text.count('class="verdict') == 13
    assert "A yielding pier makes derailment less likely." in text


def test_trust_shows_the_step_s_measured_error_versions_and_hashes(report):
    text = report.read_text(encoding="utf-8")
    trust = text[text.index('<section id="trust">') :]
    assert "Time step: 3e-05 s" in trust and "half the step" in trust
    assert f"railquake {rq.__version__}" in trust
    assert re.search(r"[0-9a-f]{64}", trust)


def test_a_chosen_time_step_is_told_with_its_error(folder):
    facts = {"halvings": 0, "error": 0.004, "tolerance": 0.01, "tried": 8}
    facts["text"] = "estimated error 0.4 % over 8 scenarios tried"
    (folder / "time_step.json").write_text(json.dumps(facts))
    section = trust.section(Context(open_results(folder), str(folder), print))
    (said,) = [block.text for block in section.blocks if isinstance(block, Text)]
    assert "chosen by the program" in said and facts["text"] in said


def test_out_names_the_page_and_another_report_replaces_the_first(capsys, folder, tmp_path):
    page = tmp_path / "elsewhere" / "page.html"
    page.parent.mkdir()
    page.write_text("an older one")
    (page.parent / "figures").mkdir()
    (page.parent / "figures" / "mine.txt").write_text("not the report's")
    assert main(["report", str(folder), "--out", str(page)]) == 0
    said = capsys.readouterr()
    assert str(page) in said.out and NASTY not in said.out
    assert page.stat().st_size > 1_000_000
    assert (page.parent / "figures" / "mine.txt").exists()
    assert not (folder / "report.html").exists()
    assert sorted(path.name for path in page.parent.iterdir()) == ["figures", "page.html"]


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: study(("coupled-nonlinear",)), "does not have both"),
        (lambda: study(("at-grade",)), "no loops to show"),
        (lambda: study(axes={"support.hinge": ["elastic"]}), "which this study does not have"),
        (lambda: study(axes={}, levels={}, members=1), "which this study does not have"),
        (lambda: study(("coupled-elastic",), dt=1e-3, members=2), "nothing to fit"),
    ],
    ids=["one model", "at grade", "one hinge", "one run", "all failed"],
)
def test_another_study_gets_a_sensible_report(made, said, tmp_path):
    made().run(tmp_path / "other", jobs=1)
    text = write_report(tmp_path / "other").read_text(encoding="utf-8")
    assert re.findall(r'<section id="(\w+)">', text) == list(SECTIONS)
    assert said in text


def test_failed_runs_are_listed_with_their_reason_and_their_command(tmp_path):
    study(("coupled-elastic", "at-grade"), dt=1e-3, members=2).run(tmp_path / "failed", jobs=1)
    text = write_report(tmp_path / "failed").read_text(encoding="utf-8")
    failures = text[text.index('<section id="failures">') : text.index('<section id="trust">')]
    assert "above the critical time step" in failures
    assert f"railquake rerun {tmp_path / 'failed'} 0 --out result" in failures


def test_a_record_that_is_gone_is_told_and_the_rest_is_reported(tmp_path, shared):
    record = shutil.copy(shared / "records" / "formats" / "at2_lowercase_long_header.at2", tmp_path)
    (tmp_path / "suite.csv").write_text(f"file,scale_factor\n{record},1.0\n")
    from railquake.study import Study

    base = {"vehicle": {"preset": "bart"}, "support": {"preset": "bart-berkeley"},
            "wheelrail": {"preset": "bart"}, "solver": {"dt": 1e-5}}  # fmt: skip
    Study(base=base, suite=tmp_path / "suite.csv").run(tmp_path / "gone", jobs=1)
    (tmp_path / "at2_lowercase_long_header.at2").unlink()
    text = write_report(tmp_path / "gone").read_text(encoding="utf-8")
    assert "cannot be read" in text
    assert re.findall(r'<section id="(\w+)">', text) == list(SECTIONS)


def refused(capsys, *arguments):
    """The one line with which the command refuses."""
    assert main(["report", *map(str, arguments)]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith("railquake: ") and said.err.count("\n") == 1
    return said.err


def test_folders_that_are_no_study_s_are_refused_in_one_line(capsys, tmp_path):
    assert "no such folder" in refused(capsys, tmp_path / "nowhere")
    (tmp_path / "empty").mkdir()
    assert "is empty" in refused(capsys, tmp_path / "empty")
    (tmp_path / "foreign").mkdir()
    (tmp_path / "foreign" / "holiday.jpg").write_bytes(b"x")
    assert "no study" in refused(capsys, tmp_path / "foreign")
    assert "no folder" in refused(capsys, tmp_path / "foreign" / "holiday.jpg")


def test_a_damaged_table_is_refused_in_one_line(capsys, folder):
    (folder / "runs.parquet").write_bytes(b"PAR1 no more")
    assert "damaged" in refused(capsys, folder)
    assert not (folder / "report.html").exists()


def test_wrong_options_are_refused_before_the_work(capsys, folder, tmp_path):
    assert "hazard" in refused(capsys, folder, "--hazard", "atlantis")
    assert "is a folder" in refused(capsys, folder, "--out", tmp_path)
    (tmp_path / "file").write_text("")
    assert "is no folder" in refused(capsys, folder, "--out", tmp_path / "file" / "page.html")
