"""Charts: page, picture and table show the same numbers, and texts of files stay texts."""

import csv
import io
import json

import numpy as np
import pytest

from railquake.report.chart import MOST_POINTS, Band, Chart, Line, Panel, Points, Rule, limits
from railquake.report.context import ReportSection, Table, Text
from railquake.report.interactive import figures_of
from railquake.report.page import page_html
from railquake.report.pictures import csv_text, write_png

NASTY = '<b onclick="x">%{y}</b></script>$x$'


def points(n=3, **options):
    values = np.arange(1.0, n + 1.0)
    given = {"label": "runs", "colour": "#0072B2", "x": values, "y": values**2}
    given |= {"rows": np.arange(n), "texts": [NASTY] * n}
    return Points(**(given | options))


def chart(*layers, **panel):
    made = Panel("title", "across, m", "up, m", layers or (points(),), **panel)
    return Chart("name", "Title", "Caption.", (made,))


def test_the_page_shows_the_numbers_that_the_table_holds():
    drawn = chart(points(5))
    (figure,) = figures_of(drawn)
    rows = list(csv.DictReader(io.StringIO(csv_text(drawn))))
    assert [float(row["x"]) for row in rows] == figure["data"][0]["x"]
    assert [float(row["y"]) for row in rows] == figure["data"][0]["y"]
    assert [int(row["row"]) for row in rows] == figure["data"][0]["customdata"]
    assert rows[0]["remark"] == NASTY


def test_numbers_are_rounded_and_what_is_none_is_null():
    (figure,) = figures_of(
        chart(Line("l", "#000000", np.array([1.23456789, np.nan]), np.array([1e-9, np.inf])))
    )
    assert figure["data"][0]["x"] == [1.235, None]
    assert json.dumps(figure, allow_nan=False)


def test_texts_in_labels_are_escaped_for_plotly():
    layer = points(label=NASTY)
    text = json.dumps(figures_of(chart(layer)))
    assert "<b onclick" not in text and "&lt;b onclick" in text


def test_texts_in_the_page_are_escaped_everywhere():
    drawn = Chart("name", NASTY, NASTY, (Panel(NASTY, NASTY, NASTY, (points(label=NASTY),)),))
    section = ReportSection("key", NASTY, (Text(NASTY), Table((NASTY,), ((NASTY,),), NASTY), drawn))
    page = page_html([section], title=NASTY, subtitle=NASTY, footer=NASTY, command=(NASTY, NASTY))
    assert "<b onclick" not in page
    assert page.count("</script>") == 3  # those of the page itself
    assert page.count("&lt;b onclick=&quot;x&quot;&gt;") >= 9


@pytest.mark.parametrize("log", [True, False])
def test_all_that_is_drawn_lies_within_the_axes(log):
    panel = Panel("t", "x", "y", (points(9), Line("l", "#000000", np.array([0.5, 20.0]),
                  np.array([0.1, 300.0])), Rule("r", y=400.0)), log_x=log, log_y=log)  # fmt: skip
    (low_x, high_x), (low_y, high_y) = limits(panel)
    assert low_x < 0.5 < 20.0 < high_x
    assert low_y < 0.1 < 400.0 < high_y


def test_square_panels_have_one_range():
    x, y = limits(Panel("t", "x", "y", (points(9),), square=True))
    assert x == y


def test_no_points_at_all_still_make_axes():
    empty = points(0)
    assert limits(Panel("t", "x", "y", (empty,), log_x=True, log_y=True)) == ((0.1, 10.0),) * 2


def test_many_points_are_thinned_in_the_page_and_not_in_the_table():
    many = chart(points(2 * MOST_POINTS + 10))
    (figure,) = figures_of(many)
    assert len(figure["data"][0]["x"]) <= MOST_POINTS
    assert len(csv_text(many).splitlines()) == 2 * MOST_POINTS + 11


def test_every_kind_of_layer_is_drawn(tmp_path):
    x = np.array([1.0, 10.0])
    layers = (
        points(symbol="diamond", open=True), Line("l", "#D55E00", x, x, dash="dashed"),
        Band("b", "#D55E00", x, 0.5 * x, 2.0 * x), Rule("x", x=2.0), Rule("y", y=3.0),
        Rule("d", diagonal=1.5),
    )  # fmt: skip
    for log in (False, True):
        drawn = chart(*layers, log_x=log, log_y=log, y_ticks=((1.0, NASTY),))
        path = write_png(drawn, tmp_path / "chart.png")
        assert path.read_bytes().startswith(b"\x89PNG")
        (figure,) = figures_of(drawn)
        assert len(figure["data"]) == 3
        assert len(figure["layout"]["shapes"]) == len(figure["layout"]["annotations"]) == 3
