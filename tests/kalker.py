"""Kalker's table for the model that is written a second time."""

import csv

import numpy as np


def kalker_table(shared):
    """Coefficients at Poisson's ratio 0, 0.25, 0.5, along a coordinate that is 2 - b/a beyond 1."""
    with open(shared / "oracles" / "kalker_table.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    ratio = np.array([float(row["ratio"]) for row in rows])
    place = np.where([row["part"] == "a/b<=1" for row in rows], ratio, 2.0 - ratio)
    order = np.argsort(place, kind="stable")
    table = {"place": place[order]}
    for name in ("C22", "C23"):
        columns = [[float(row[f"{name}_nu{nu}"]) for row in rows] for nu in ("0", "0.25", "0.5")]
        table[name] = np.array(columns).T[order]
    return table
