"""The report of a study: one self-contained HTML page, and its figures as PNG and CSV.

`context`      what all sections share: the table, its statistics, words for its runs
`chart`        charts described once; `interactive` and `pictures` draw them
`page`         HTML
and a module a section: `summary`, `vehicle`, `spectra`, `hinges`, `uplift`, `decoupled`, `lateral`,
`curves`, `failures`, `trust`.
"""

from railquake.report.write import write_report

__all__ = ["write_report"]
