"""Studies: a base case, a suite of motions and axes, run as one and never half lost.

`file`           the study file, `Study`
`axes`           lists, named variants and distributions
`distributions`  their families, and how they are sampled
`parsing`        axes as a study file has them
`design`         which run is which
`plan`           what is left to do, in batches
`batches`        what one task does
`engine`         batches on an executor, finished rows to parts
`cluster`        Dask's workers behind that executor
`table`          the table's columns
`folder`         parts, resuming
`results`        reading them, merging shards
"""

from pathlib import Path

from railquake.study.engine import StudyProgress
from railquake.study.file import Study, load_study
from railquake.study.results import StudyResults, merge_results, open_results

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
