"""Reading of the reference numbers beside the validation tests."""

import csv
import tomllib
from pathlib import Path

import numpy as np


def columns(path: Path) -> dict[str, np.ndarray]:
    """Columns of a CSV file by name; lines that begin with # are its provenance."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    table = {}
    for name in rows[0]:
        cells = [row[name] for row in rows]
        try:
            table[name] = np.array(cells, dtype=float)
        except ValueError:
            table[name] = np.array(cells)
    return table


def reference(test_file: str) -> dict:
    """``reference.toml`` beside a test: numbers, their source and the tolerance."""
    return tomllib.loads(Path(test_file).with_name("reference.toml").read_text(encoding="utf-8"))
