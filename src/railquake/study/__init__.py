"""Studies: a base case, a suite of motions and axes, run as one and never half lost.

Data, from below:

`distributions`  families, and how they are sampled
`axes`           lists, named variants and distributions
`parsing`        axes as a study file has them
`file`           all that a study is given
`design`         which run is which
`table`          the table's columns
`folder`         parts, resuming

Work above it:

`plan`           what is left to do, in batches
`batches`        what one task does
`cluster`        Dask's workers behind an executor
`engine`         batches on an executor, finished rows to parts
`study`          what is given and its run in one, `Study`
`results`        reading a folder, merging shards
"""

from pathlib import Path

from railquake.study.engine import StudyProgress
from railquake.study.results import StudyResults, merge_results, open_results
from railquake.study.study import Study, load_study

__all__ = [
    "DEMO_FILE",
    "Study",
    "StudyProgress",
    "StudyResults",
    "load_study",
    "merge_results",
    "open_results",
]

DEMO_FILE = Path(__file__).with_name("demo.toml")
"""The built-in study: the paper's, with synthetic motions."""
