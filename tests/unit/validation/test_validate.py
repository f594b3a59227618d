"""`railquake validate`: what makes it green, what it prints and writes, and what it refuses."""

import json
import sys
from types import SimpleNamespace

import pytest

from railquake.cli import main
from railquake.errors import InputError
from railquake.validation import registry
from railquake.validation.comparison import Outcome, Picture, Unavailable, absolute, relative
from railquake.validation.reference import columns, data_folder
from railquake.validation.runner import run_one


def raising(error):
    def compare(data):
        raise error

    return compare


def comparison(compare, **more):
    return SimpleNamespace(
        TITLE="A cart", SOURCE="A book.", WHAT="Its speed.", WHY="Rounding.", compare=compare,
        **more,
    )  # fmt: skip


def draw(path):
    path.write_bytes(b"\x89PNG")


GOOD = Outcome(
    (relative("speed | left", "m/s", reference=2.0, ours=2.01, tolerance=0.01),),
    (Picture("cart", "A cart.", draw),),
    note="Carts are slow.",
)
BAD = Outcome((absolute("place", "mm", reference=1.0, ours=2.5, tolerance=0.5),))
KNOWN = {
    "good_one": comparison(lambda data: GOOD),
    "outside": comparison(lambda data: BAD),
    "broken": comparison(raising(ZeroDivisionError("by\nzero"))),
    "wanting": comparison(raising(Unavailable("needs a ruler: buy one")), SLOW=True),
    "idle": comparison(lambda data: Outcome(())),
    "with_tool": comparison(lambda data: GOOD, NEEDS=("fem",)),
    "with_data": comparison(lambda data: GOOD, NEEDS=("data",), FILES=("records/a.AT2",)),
}


@pytest.fixture(autouse=True)
def known(monkeypatch):
    """Seven comparisons instead of the real ones."""
    monkeypatch.setattr(registry, "COMPARISONS", tuple(KNOWN))
    monkeypatch.setattr(registry, "load", lambda name: KNOWN[name.replace("-", "_")])
    monkeypatch.delenv("RAILQUAKE_SHARED", raising=False)


def validate(capsys, *only, more=()):
    names = [part for name in only for part in ("--only", name)]
    status = main(["validate", *names, *map(str, more)])
    return status, capsys.readouterr().out


def refused(capsys, *arguments):
    assert main(["validate", *map(str, arguments)]) == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert len(printed.err.splitlines()) == 1
    return printed.err


def test_all_within_is_green(capsys):
    status, text = validate(capsys, "good-one")
    assert status == 0
    assert "good-one: A cart" in text
    row = next(line for line in text.splitlines() if "speed" in line)
    assert row.split("  ")[-1] == "agrees"
    assert "2 m/s" in row and "2.01 m/s" in row and "0.5 %" in row and "1 %" in row
    assert text.splitlines()[-1] == "green: 1 of 1 comparisons agree"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("outside", "outside"),
        ("broken", "failed: ZeroDivisionError: by zero"),
        ("wanting", "skipped: needs a ruler: buy one"),
        ("idle", "failed: compares nothing"),
    ],
)
def test_anything_else_is_not_green_and_the_others_run(capsys, name, words):
    status, text = validate(capsys, "good-one", name)
    assert status == 1
    assert words in text and "speed" in text
    verdict = words.split(":")[0]
    assert text.splitlines()[-1] == f"not green: 1 of 2 comparisons agree, 1 {verdict}"


def test_they_run_in_the_registrys_order_whatever_is_asked_first(capsys):
    _, text = validate(capsys, "outside", "good_one")
    assert text.index("good-one:") < text.index("outside:")


def test_missing_tool_names_the_extra(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "opensees.openseespy", None)
    status, text = validate(capsys, "with-tool")
    assert status == 1
    assert "skipped: needs OpenSees: pip install railquake[fem]" in text


def test_missing_data_is_said(tmp_path):
    report = run_one("with-data", KNOWN["with_data"], None)
    assert report.skipped == "needs the folder of reference data: --data DIR"
    (tmp_path / "records").mkdir()
    report = run_one("with-data", KNOWN["with_data"], tmp_path)
    assert report.skipped == f"needs records/a.AT2 in {tmp_path}"
    (tmp_path / "records" / "a.AT2").touch()
    assert run_one("with-data", KNOWN["with_data"], tmp_path).agrees


def test_numbers_that_lack_make_a_skipped_comparison(tmp_path):
    report = run_one("reads", comparison(lambda data: columns(data / "none.csv")), tmp_path)
    assert report.verdict == "skipped" and "none.csv" in report.skipped


def test_json_has_everything_and_nothing_else_is_printed(capsys):
    status, text = validate(capsys, "good-one", "outside", "wanting", "broken", more=["--json"])
    assert status == 1
    found = json.loads(text)
    assert found["green"] is False
    by_name = {row["name"]: row for row in found["comparisons"]}
    assert by_name["good-one"]["results"][0]["verdict"] == "agrees"
    assert by_name["good-one"]["results"][0]["difference"] == pytest.approx(0.005)
    assert by_name["outside"]["results"][0]["verdict"] == "outside"
    assert by_name["wanting"]["skipped"] == "needs a ruler: buy one"
    assert by_name["broken"]["error"] == "ZeroDivisionError: by zero"


def test_page_has_a_section_with_source_reason_table_and_plot_for_each(capsys, tmp_path):
    page = tmp_path / "validation.md"
    status, _ = validate(capsys, "good-one", "wanting", "broken", more=["--page", page])
    assert status == 1
    text = page.read_text().replace("\N{NO-BREAK SPACE}", " ")
    picture = tmp_path / "images" / "validation" / "good-one-cart.png"
    assert picture.read_bytes() == b"\x89PNG"
    assert "```{figure} images/validation/good-one-cart.png" in text
    for words in ("**Source.** A book.", "**Why this tolerance.** Rounding.", "Carts are slow."):
        assert words in text
    assert r"| speed \| left | 2 m/s | 2.01 m/s | 0.5 % | 1 % | agrees |" in text
    assert "**Skipped.** needs a ruler: buy one" in text
    assert "**Failed.** ZeroDivisionError: by zero" in text
    assert not [path for path in tmp_path.iterdir() if path.name.startswith(".")]


def test_plot_that_fails_is_named_and_the_page_written_without_it(capsys, monkeypatch, tmp_path):
    bad = Picture("wheel", "A wheel.", raising(ZeroDivisionError("round")))
    outcome = Outcome(GOOD.results, (bad, *GOOD.pictures))
    monkeypatch.setitem(KNOWN, "good_one", comparison(lambda data: outcome))
    page = tmp_path / "validation.md"
    assert main(["validate", "--only", "good-one", "--page", str(page)]) == 1
    complaint = "railquake: good-one: plot wheel failed: ZeroDivisionError: round\n"
    assert capsys.readouterr().err == complaint
    assert "good-one-cart.png" in page.read_text() and "wheel" not in page.read_text()


def test_the_page_is_the_same_when_written_again(capsys, tmp_path):
    for name in ("a.md", "b.md"):
        validate(capsys, "good-one", "outside", more=["--page", tmp_path / name])
    assert (tmp_path / "a.md").read_text() == (tmp_path / "b.md").read_text()


def test_differences_that_hang_on_the_compiler_are_not_printed(capsys, monkeypatch):
    tiny = relative("speed", "", reference=1.0, ours=1.0 + 3e-13, tolerance=1e-6)
    monkeypatch.setitem(KNOWN, "good_one", comparison(lambda data: Outcome((tiny,))))
    _, text = validate(capsys, "good-one")
    assert "below 1e-9" in text  # a thousandth of the tolerance


def test_stop_leaves_no_page(capsys, monkeypatch, tmp_path):
    monkeypatch.setitem(KNOWN, "outside", comparison(raising(KeyboardInterrupt())))
    page = tmp_path / "validation.md"
    assert main(["validate", "--page", str(page)]) == 130
    assert "stopped" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_wrong_input_is_one_line(capsys, tmp_path):
    line = refused(capsys, "--only", "good-on")
    assert 'no comparison is called "good-on"; did you mean "good-one"?' in line
    assert "nothing at" in refused(capsys, "--data", tmp_path / "none")
    (tmp_path / "file").touch()
    assert "found a file" in refused(capsys, "--data", tmp_path / "file")
    assert "neither oracles/ nor records/" in refused(capsys, "--data", tmp_path)
    assert "is a folder" in refused(capsys, "--page", tmp_path)
    assert "folder is not there" in refused(capsys, "--page", tmp_path / "no" / "page.md")


def test_the_environment_may_name_the_data(monkeypatch, tmp_path):
    (tmp_path / "oracles").mkdir()
    monkeypatch.setenv("RAILQUAKE_SHARED", str(tmp_path))
    assert data_folder(None) == tmp_path
    monkeypatch.setenv("RAILQUAKE_SHARED", str(tmp_path / "none"))
    with pytest.raises(InputError, match="RAILQUAKE_SHARED"):
        data_folder(None)


def test_help_ends_with_an_example(capsys):
    assert main(["validate", "--help"]) == 0
    assert "Example: railquake validate" in capsys.readouterr().out


def test_what_begins_is_said_on_a_terminal_only(capsys, monkeypatch):
    assert main(["validate", "--only", "good-one"]) == 0
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    assert main(["validate", "--only", "good-one"]) == 0
    assert capsys.readouterr().err == "railquake: good-one ...\n"
