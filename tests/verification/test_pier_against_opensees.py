"""The pier alone against OpenSees' histories under a real record."""

import csv

import numpy as np
import pytest

import railquake as rq
from suite_files import record_path

# OpenSees' own g in those files; peaks from the files' first lines.
G = 9.81 / 9.80665
PEAKS = {
    "elastic": (0.0162544026, 0.000222437098, 0.00445854795, 8548702.53),
    "bouc-wen": (0.0163325802, 0.000311941668, 0.00419818716, 8483186.25),
}
CHANNELS = ("bridge_displacement_m", "hinge_rotation_rad", "top_rotation_rad", "base_moment_n_m")


def run(shared, hinge, dt):
    pier = {
        "preset": "bart-berkeley",
        "hinge": hinge,
        "coupled": False,
        "base_rotational_inertia": 1.0,
        "damping_ratio": 0.02,
        "bouc_wen": {"m": 1.0},
    }
    record = record_path(shared, "RSN181_IMPVALLH1")
    return rq.simulate(rq.scenario(support=pier, record=record, scale=G, dt=dt))


@pytest.mark.parametrize("hinge", ["elastic", "bouc-wen"])
def test_peaks_and_history(shared, hinge):
    response = run(shared, hinge, "1e-4 s")
    row = rq.assess(response)
    found = (
        row["pbd_m"],
        row["hinge_rotation_peak_rad"],
        row["top_rotation_peak_rad"],
        row["base_moment_peak_n_m"],
    )
    assert found == pytest.approx(PEAKS[hinge], rel=1e-3)
    name = "dyn_elastic.csv" if hinge == "elastic" else "dyn_hinge.csv"
    with open(shared / "oracles" / name) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    time = np.array([float(row["t"]) for row in rows])
    for channel, column in zip(CHANNELS, ("u", "theta1", "theta2", "M_base"), strict=True):
        expected = np.array([float(row[column]) for row in rows])
        ours = np.interp(time, response.times, response.channel(channel))
        assert np.abs(ours - expected).max() < 2e-3 * np.abs(expected).max(), channel


def test_elastic_pier_converges_with_second_order(shared):
    histories = [
        run(shared, "elastic", dt).channel("bridge_displacement_m")
        for dt in ("2e-4 s", "1e-4 s", "5e-5 s")
    ]
    coarse = np.abs(histories[0] - histories[1]).max()
    fine = np.abs(histories[1] - histories[2]).max()
    assert coarse / fine == pytest.approx(4.0, rel=0.1)
