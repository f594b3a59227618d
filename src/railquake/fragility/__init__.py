r"""Fragility: how likely an outcome is, given a measure of the shaking or of the response.

The lognormal curve :math:`P(x) = \Phi(\ln(x / \theta) / \beta)` by maximum likelihood on runs that
either reached the outcome or did not (Baker 2015, "Efficient analytical fragility function fitting
using dynamic structural analysis", Earthquake Spectra 31(1), 579-599).  It is a probit regression
on :math:`\ln x`: :math:`\Phi(a + b \ln x)` with :math:`\beta = 1/b, \theta = e^{-a/b}`.  What
is done where the data do not determine it, and how intervals are found: docs/theory/fragility.md.

`curve`     the curve with what is known about its certainty
`probit`    the regression: likelihood, its slopes and its maximum
`fits`      fitted parameters and their intervals: profile, sandwich, bootstrap
`outcomes`  which runs reached what
`pelicun`   curves as another program reads them
"""

from railquake.fragility.curve import Fragility, compare_measures
from railquake.fragility.outcomes import OUTCOMES, outcome
from railquake.fragility.pelicun import write_csv
from railquake.fragility.probit import LARGEST_BETA

__all__ = [
    "LARGEST_BETA",
    "OUTCOMES",
    "Fragility",
    "compare_measures",
    "outcome",
    "write_csv",
]
