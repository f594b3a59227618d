"""Kalker's table for the model that is written a second time."""

import csv

import numpy as np

NAMES = ("C11", "C22", "C23")


def _rows(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def kalker_table(shared):
    """Coefficients at Poisson's ratio 0, 0.25, 0.5, along log(a/b); CONTACT's beyond a/b 10.

    These are for 0.28, and keep there the table's proportions between Poisson's ratios at 10.
    """
    rows = _rows(shared / "oracles" / "kalker_table.csv")
    ratio = np.array([float(row["ratio"]) for row in rows])
    ratio = np.where([row["part"] == "a/b<=1" for row in rows], ratio, 1.0 / ratio)
    order = np.argsort(ratio, kind="stable")
    flange = _rows(shared / "oracles" / "contact_linear_coefficients_flange.csv")
    flange = [row for row in flange if float(row["a_over_b"]) > 10.5]
    longer = np.array([float(row["a_over_b"]) for row in flange])
    end = 40.0
    table = {"place": np.log([*ratio[order], *longer, end])}
    by_poisson = np.vander([0.0, 0.25, 0.5], increasing=True)
    for name in NAMES:
        columns = [[float(row[f"{name}_nu{nu}"]) for row in rows] for nu in ("0", "0.25", "0.5")]
        known = np.array(columns).T[order]
        last = np.linalg.solve(by_poisson, known[-1]) @ (1.0, 0.28, 0.28**2)
        beyond = np.array([float(row[name]) for row in flange])
        power = np.log(beyond[-1] / beyond[-2]) / np.log(longer[-1] / longer[-2])
        beyond = np.append(beyond, beyond[-1] * (end / longer[-1]) ** power)
        table[name] = np.vstack([known, np.outer(beyond, known[-1] / last)])
    return table
