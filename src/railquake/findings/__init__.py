"""What the runs of a study say together: correlations, paired comparisons, answers in sentences.

`resampling`   the bootstrap that draws records, and quantities with intervals
`correlation`  which measure goes with uplift
`comparison`   the same record, level and speed under two models
`lateral`      where the lateral force levels off
`spectral`     spectral acceleration at the pier's first period
`models`       the models that the paper compares
`evidence`     all these statistics put together; `gathering` works them out
`words`        numbers as they stand in sentences
`claim`        what a claim of the paper is; `claims` holds them, a file each
`questions`    the three questions and the findings of the paper, as sentences

The methods: docs/theory/findings.md.
"""

from railquake.findings.claim import Finding
from railquake.findings.comparison import PairedComparison, compare_models
from railquake.findings.correlation import Correlation, Correlations, Difference, correlate
from railquake.findings.evidence import Evidence
from railquake.findings.gathering import gather
from railquake.findings.lateral import LevelOff, force_ratio, level_off
from railquake.findings.questions import Answer, answer_questions
from railquake.findings.resampling import Estimate, finished
from railquake.findings.spectral import first_period, with_spectral_acceleration

__all__ = [
    "Answer",
    "Correlation",
    "Correlations",
    "Difference",
    "Estimate",
    "Evidence",
    "Finding",
    "LevelOff",
    "PairedComparison",
    "answer_questions",
    "compare_models",
    "correlate",
    "finished",
    "first_period",
    "force_ratio",
    "gather",
    "level_off",
    "with_spectral_acceleration",
]
