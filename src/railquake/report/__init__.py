"""What people read: the folder of a run, and the report of a study (one page, figures, tables).

`run_folder`   numbers, histories and pictures of one run
`context`      what all sections of a report share: the table, its statistics, words for its runs
`chart`        charts described once; `interactive` and `pictures` draw them
`page`         HTML
`write`        page, figures and tables to a folder
and a module a section: `summary`, `vehicle`, `spectra`, `hinges`, `uplift`, `decoupled`, `lateral`,
`curves`, `failures`, `trust`.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from railquake.report.write import write_report as write_report

__all__ = ["write_report"]


def __getattr__(name: str) -> Any:
    if name == "write_report":  # not for those who only write a run: it loads what draws charts
        from railquake.report.write import write_report

        return write_report
    raise AttributeError(f"module 'railquake.report' has no attribute {name!r}")
