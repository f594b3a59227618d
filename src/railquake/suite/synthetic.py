r"""How the built-in suite of synthetic motions was made; its table is data beside this module.

The stochastic model of `railquake.inputs.ground_motion.synthetic` gives motions of one spectral
shape with little scatter.  Real records of one hazard differ in frequency content and duration as
well: here the model's parameters differ from motion to motion.

1. `POOL` candidates: parameters from `SMALLEST` to `LARGEST`, spread evenly in their logarithms
   by a Halton sequence (no random numbers), the place in the sequence being the seed of the noise.
2. Of these `COUNT` are chosen, and scaled through their PGA, by the method of
   `railquake.suite.selection`: geometric mean to the target, and the standard deviation of ln Sa
   to `SCATTER`, over `PERIOD_RANGE`.

Each motion is then a table of numbers and a seed, which gives the same motion bit for bit.  They
share spectrum and scatter with records, but have neither their pulses nor their phases: they
serve demonstrations and tests, and say nothing about a site.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from railquake.inputs.ground_motion import STANDARD_GRAVITY, response_spectrum, synthetic_motion
from railquake.suite.hazard import load_hazard
from railquake.suite.selection import POINTS, choose, scale_factors

__all__ = ["candidates", "synthetic_table"]

POOL = 600
"""How many candidates there are."""
COUNT = 20
"""How many motions are chosen."""
HAZARD, POE = "berkeley", 0.05
"""The target: 5 % in 50 years on the soil of the paper's suite."""
PERIOD_RANGE = (0.05, 5.0)
"""Shortest and longest period that are matched, s: from the pier's second to the car's first."""
SCATTER = 0.35
"""Standard deviation of ln Sa to aim at: that of the paper's suite, mean over `PERIOD_RANGE`."""
DURATION, DT = 22.0, 0.01
"""Length and time step of all motions, s."""
NAMES = ("ground_frequency", "ground_damping", "highpass_frequency", "strong_duration", "rise")
"""Parameters that differ from motion to motion, besides seed and PGA."""
SMALLEST = (0.4, 0.12, 0.05, 12.0, 0.1)
"""Their smallest values: Hz, 1, Hz, s, 1."""
LARGEST = (5.0, 1.0, 0.4, 22.0, 0.5)
"""Their largest values; the high-pass frequency is below 0.8 of the ground's, too."""
DIGITS = (2, 2, 3, 1, 2)
"""Decimals to which they are rounded."""


def candidates(count: int = POOL) -> list[dict[str, Any]]:
    """Parameter tables of the candidates, scaled to a PGA of 1 g, all values in SI units."""
    from scipy.stats import qmc

    places = qmc.Halton(len(NAMES), scramble=False).random(count + 1)[1:]  # the first is zero
    smallest, largest = np.array(SMALLEST), np.array(LARGEST)
    tables = []
    for seed, place in enumerate(places, 1):
        values = smallest * (largest / smallest) ** place
        values[2] = min(values[2], 0.8 * values[0])
        rounded = [round(float(v), digits) for v, digits in zip(values, DIGITS, strict=True)]
        tables.append(
            {"seed": seed, "duration": DURATION, "dt": DT, "pga": STANDARD_GRAVITY}
            | dict(zip(NAMES, rounded, strict=True))
        )
    return tables


def synthetic_table() -> str:
    """Make the table of the built-in suite anew (some seconds).

    Returns
    -------
    str
        CSV: a row of parameters of `SyntheticParameters`, SI, for each motion.
    """
    tables = candidates()
    target = load_hazard(HAZARD, POE)
    periods = np.geomspace(*PERIOD_RANGE, POINTS)
    wanted = np.log(target.at(periods))
    logs = np.log([response_spectrum(synthetic_motion(table), periods).psa for table in tables])
    factors = scale_factors(logs, wanted, 10.0)
    choice = choose(logs + np.log(factors)[:, None] - wanted, COUNT, SCATTER)
    lines = [",".join(tables[0])]
    for row in choice.chosen:
        pga = float(f"{factors[row] * STANDARD_GRAVITY:.4g}")
        lines.append(",".join(repr(value) for value in (tables[row] | {"pga": pga}).values()))
    return "\n".join(lines) + "\n"
