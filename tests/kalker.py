"""Kalker's table for the model that is written a second time."""

import csv

import numpy as np

NAMES = ("C11", "C22", "C23")


def _rows(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def kalker_table(shared):
    """Coefficients at Poisson's ratio 0, 0.25, 0.5, along log(a/b).

    Kalker's own to a/b 5.  From 6 on CONTACT's, which are for 0.28, and keep the proportions
    between Poisson's ratios that his table has at 5 and 10, and between; the mean of both at 10.
    """
    rows = _rows(shared / "oracles" / "kalker_table.csv")
    ratio = np.array([float(row["ratio"]) for row in rows])
    ratio = np.where([row["part"] == "a/b<=1" for row in rows], ratio, 1.0 / ratio)
    order = np.argsort(ratio, kind="stable")
    flange = _rows(shared / "oracles" / "contact_linear_coefficients_flange.csv")
    flange = [row for row in flange if float(row["a_over_b"]) > 5.5]
    longer = np.array([float(row["a_over_b"]) for row in flange])
    end = 40.0
    table = {"place": np.log([*ratio[order][:-1], *longer, end])}
    by_poisson = np.vander([0.0, 0.25, 0.5], increasing=True)
    between = np.clip(np.log(longer / 5.0) / np.log(2.0), 0.0, 1.0)[:, None]
    for name in NAMES:
        columns = [[float(row[f"{name}_nu{nu}"]) for row in rows] for nu in ("0", "0.25", "0.5")]
        known = np.array(columns).T[order]
        at_five, at_ten = (
            np.log(entry / (np.linalg.solve(by_poisson, entry) @ (1.0, 0.28, 0.28**2)))
            for entry in known[-2:]
        )
        proportions = np.exp((1.0 - between) * at_five + between * at_ten)
        theirs = np.array([float(row[name]) for row in flange])
        beyond = theirs[:, None] * proportions
        both = int(np.flatnonzero(longer == 10.0)[0])
        beyond[both] = np.sqrt(beyond[both] * known[-1])
        power = np.log(theirs[-1] / theirs[-2]) / np.log(longer[-1] / longer[-2])
        last = beyond[-1] * (end / longer[-1]) ** power
        table[name] = np.vstack([known[:-1], beyond, last])
    return table
