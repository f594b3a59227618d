"""The documentation's picture of the benchmark.

railquake bench --json > bench.json
python benchmarks/figure.py bench.json docs/images/benchmarks.png
"""

import json
import sys
from pathlib import Path

import matplotlib.pyplot as plt

BARS = (
    ("opensees_pier_steps_per_s", "OpenSees, the pier alone"),
    ("grid_steps_per_s", "one run, grid contact"),
    ("scalar_steps_per_s", "one run"),
    ("lockstep_one_step_for_all_steps_per_s", "many abreast, all in every step"),
    ("lockstep_steps_per_s", "many abreast, one core"),
    ("lockstep_two_threads_steps_per_s", "many abreast, two threads"),
    ("gpu_steps_per_s", "many on a GPU"),
)


def main():
    row = json.loads(Path(sys.argv[1]).read_text())
    bars = [(text, 1e-6 * row[key]) for key, text in BARS if row.get(key)]
    figure, axes = plt.subplots(figsize=(7.0, 0.45 * len(bars) + 0.9), layout="constrained")
    drawn = axes.barh([text for text, _ in bars], [rate for _, rate in bars], color="#4477aa")
    axes.bar_label(drawn, fmt=lambda rate: f"{rate:.3g}", padding=4)
    axes.set_xscale("log")
    axes.set_xlim(0.01, 4.0 * max(rate for _, rate in bars))
    axes.set_xlabel(f"million steps a second ({row['processor']})")
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(sys.argv[2], dpi=150)


if __name__ == "__main__":
    main()
