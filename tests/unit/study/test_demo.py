"""The built-in study: the paper's in every run, but for the motions."""

import tomllib
from pathlib import Path

import railquake.study
from railquake.cli import main
from railquake.study import DEMO_FILE, load_study

PAPER = Path(__file__).parents[3] / "examples" / "paper-study.toml"


def test_the_demo_is_the_papers_study_with_synthetic_motions():
    demo = tomllib.loads(DEMO_FILE.read_text())
    paper = tomllib.loads(PAPER.read_text())
    assert demo.pop("suite") == {**paper.pop("suite"), "manifest": "synthetic-berkeley"}
    assert demo["base"].pop("solver") == {"dt": "auto"}
    paper["base"].pop("solver")
    assert demo == paper
    assert load_study(DEMO_FILE).with_suite().size == 1200


def test_demo_runs_its_study_and_writes_the_report(tmp_path, monkeypatch, capsys):
    """A cut of it: one level, one speed, two models."""
    cut = tmp_path / "cut.toml"
    text = DEMO_FILE.read_text()
    head, *models = text.split("[[axes.model]]")
    head = head.replace('["0.01 km/h", "80 km/h", "240 km/h"]', '["80 km/h"]')
    head = head.replace('{ "50%" = 0.21, "10%" = 0.74, "5%" = 1.0, "2%" = 1.38 }', '{ "5%" = 1.0 }')
    cut.write_text("[[axes.model]]".join([head, *models[:2]]))
    monkeypatch.setattr(railquake.study, "DEMO_FILE", cut)
    assert main(["demo", "--out", str(tmp_path / "demo")]) == 0
    said = capsys.readouterr().out
    assert "40 runs" in said and "report.html" in said
    assert (tmp_path / "demo" / "report.html").stat().st_size > 1e6
    assert (tmp_path / "demo" / "runs.parquet").exists()
