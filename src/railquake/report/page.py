"""The page: sections as HTML, with all that it needs inside.

Nothing is fetched from anywhere: the page's own policy forbids it.  All texts are escaped here and
nowhere else, but for labels inside Plotly's figures (`interactive`).
"""

from __future__ import annotations

import html
import json
from collections.abc import Sequence
from importlib import resources
from string import Template
from typing import Any

from railquake.report.chart import MOST_POINTS, Chart, Line, Points
from railquake.report.context import ReportSection, Table, Text
from railquake.report.interactive import figures_of
from railquake.report.summary import Answers, Findings

__all__ = ["charts_of", "page_html"]

# Plotly's marks as text, for the legend
GLYPHS = {"circle": "●", "square": "■", "diamond": "◆", "cross": "✖", "triangle-up": "▲"}
OPEN_GLYPHS = {"circle": "○", "square": "□", "diamond": "◇", "cross": "✕", "triangle-up": "△"}
STROKES = {"solid": "━", "dashed": "╍", "dotted": "┈"}


def charts_of(sections: Sequence[ReportSection]) -> list[Chart]:
    """All charts in their order."""
    return [block for section in sections for block in section.blocks if isinstance(block, Chart)]


def page_html(
    sections: Sequence[ReportSection],
    *,
    title: str,
    subtitle: str,
    footer: str,
    command: tuple[str, str],
) -> str:
    """The whole page.

    Parameters
    ----------
    sections : sequence of ReportSection
    title, subtitle, footer : str
        Plain text.
    command : (str, str)
        What stands before and after a row's number in the command that reruns it.

    Returns
    -------
    str
    """
    from plotly.offline import get_plotlyjs

    charts = {
        "command": command,
        "escaped": [html.escape(part, quote=False) for part in command],
        "charts": [
            {"name": chart.name, "panels": figures_of(chart)} for chart in charts_of(sections)
        ],
    }
    contents = "\n".join(
        f'<li><a href="#{section.key}">{_escape(_short(section.title))}</a></li>'
        for section in sections
    )
    template = Template(_file("page.html"))
    return template.substitute(
        title=_escape(title),
        subtitle=_escape(subtitle),
        footer=_escape(footer),
        style=_file("style.css"),
        contents=contents,
        sections="\n".join(_section(section) for section in sections),
        charts=_json(charts),
        plotly=get_plotlyjs(),
        script=_file("script.js"),
    )


def _file(name: str) -> str:
    return (resources.files(__package__) / "templates" / name).read_text(encoding="utf-8")


def _short(title: str) -> str:
    return title.split(":")[0].split(" (")[0]


def _escape(text: str) -> str:
    """Text for HTML; a number and its per cent sign stay together."""
    return html.escape(text, quote=True).replace(" %", "&nbsp;%")


def _json(value: Any) -> str:
    """JSON that no browser takes for the end of its element."""
    text = json.dumps(value, ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    return text.replace("&", "\\u0026").replace("<", "\\u003c").replace(">", "\\u003e")


def _section(section: ReportSection) -> str:
    blocks = "\n".join(_block(block) for block in section.blocks)
    return f'<section id="{section.key}">\n<h2>{_escape(section.title)}</h2>\n{blocks}\n</section>'


def _block(block: Any) -> str:
    if isinstance(block, Text):
        if block.kind == "heading":
            return f"<h3>{_escape(block.text)}</h3>"
        attribute = f' class="{block.kind}"' if block.kind else ""
        return f"<p{attribute}>{_escape(block.text)}</p>"
    if isinstance(block, Table):
        return _table(block)
    if isinstance(block, Chart):
        return _chart(block)
    if isinstance(block, Answers):
        return _answers(block)
    assert isinstance(block, Findings)
    return _findings(block)


def _table(table: Table) -> str:
    head = "".join(f"<th>{_escape(cell)}</th>" for cell in table.head)
    rows = "\n".join(
        "<tr>" + "".join(f"<td>{_escape(cell)}</td>" for cell in row) + "</tr>"
        for row in table.rows
    )
    caption = f'<p class="caption">{_escape(table.caption)}</p>' if table.caption else ""
    return (
        f'<div class="scroll"><table><thead><tr>{head}</tr></thead>\n<tbody>\n{rows}\n'
        f"</tbody></table></div>{caption}"
    )


def _chart(chart: Chart) -> str:
    panels = '<div class="panel"></div>' * len(chart.panels)
    narrow = " three" if chart.columns == 3 else ""
    caption = chart.caption
    if chart.points > MOST_POINTS:
        caption += (
            f" Of {chart.points:,} points every {-(-chart.points // MOST_POINTS)}th is drawn."
        )
    files = (
        f'<span class="files">(<a href="figures/{chart.name}.png">PNG</a>, '
        f'<a href="figures/{chart.name}.csv">CSV</a>)</span>'
    )
    return (
        f'<figure id="{chart.name}">\n{_legend(chart)}\n'
        f'<div class="panels{narrow}">{panels}</div>\n'
        f"<figcaption><b>{_escape(chart.title)}.</b> {_escape(caption)} {files}</figcaption>\n"
        "</figure>"
    )


def _legend(chart: Chart) -> str:
    entries: dict[str, tuple[str, str]] = {}
    for panel in chart.panels:
        for layer in panel.layers:
            if isinstance(layer, Points):
                glyphs = OPEN_GLYPHS if layer.open else GLYPHS
                entries.setdefault(layer.label, (glyphs[layer.symbol], layer.colour))
            elif isinstance(layer, Line) and layer.in_legend:
                entries.setdefault(layer.label, (STROKES[layer.dash], layer.colour))
    buttons = "".join(
        f'<button type="button" aria-pressed="true" data-name="{_escape(_plotly_name(label))}">'
        f'<span style="color:{colour}">{glyph}</span>{_escape(label)}</button>'
        for label, (glyph, colour) in entries.items()
    )
    return f'<div class="legend">{buttons}</div>'


def _plotly_name(label: str) -> str:
    """As `interactive` writes it."""
    return html.escape(label, quote=False)


def _answers(block: Answers) -> str:
    items = "\n".join(
        f'<div class="answer"><p class="question">{_escape(item.question)}</p>'
        f'<p class="short">{_escape(item.short)}.</p>'
        f'<p class="sentence">{_escape(item.sentence)}</p></div>'
        for item in block.items
    )
    return f'<div class="answers">\n{items}\n</div>'


def _findings(block: Findings) -> str:
    items = "\n".join(
        f'<li><span class="verdict {item.verdict.replace(" ", "-")}">{_escape(item.verdict)}</span>'
        f'<div><p>{_escape(item.claim)}</p><p class="evidence">{_escape(item.evidence)}'
        + (f" <i>Why: {_escape(item.why)}</i>" if item.why else "")
        + "</p></div></li>"
        for item in block.items
    )
    return f'<ul class="findings">\n{items}\n</ul>'
