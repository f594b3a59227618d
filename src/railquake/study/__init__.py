"""Studies: a base case, a suite of motions and axes, run as one and never half lost.

`file`      the study file, `Study`
`axes`      lists, named variants and distributions
`design`    which run is which
`engine`    batches on an executor
`cluster`   Dask's workers behind that executor
`results`   the folder: parts, table, resuming, merging
"""

from railquake.study.engine import StudyProgress
from railquake.study.file import Study, load_study
from railquake.study.results import StudyResults, merge_results, open_results

__all__ = [
    "Study",
    "StudyProgress",
    "StudyResults",
    "load_study",
    "merge_results",
    "open_results",
]
