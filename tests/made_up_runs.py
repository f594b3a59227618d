"""Made-up tables of runs with known properties, for the tests of findings."""

import numpy as np
import pandas as pd

LEVELS = {"50%": 0.21, "10%": 0.74, "5%": 1.0, "2%": 1.38}
MODELS = (
    "coupled-elastic", "coupled-nonlinear", "decoupled-elastic", "decoupled-nonlinear", "at-grade",
)  # fmt: skip


def table(seed=0, records=20, speeds=(0.0028, 22.2, 66.7), models=MODELS, ratios=None):
    """A study's table: uplift follows PBV closely, and PGA loosely.

    ``ratios`` multiply quantities of a model: ``{("decoupled-elastic", "pbd_m"): 1.1}``; all other
    pairs agree but for a scatter of 1 %.
    """
    rng = np.random.default_rng(seed)
    ratios = ratios or {}
    rows = []
    strength = 0.8 * np.exp(0.35 * rng.standard_normal(records))
    noise = np.exp(0.5 * rng.standard_normal(records))
    for speed in speeds:
        for k in range(records):
            for level, scale in LEVELS.items():
                base = strength[k] * scale * np.exp(0.02 * rng.standard_normal())
                for model in models:
                    grade = model == "at-grade"
                    values = {
                        "pga_m_s2": 8.0 * noise[k] * scale,
                        "pgv_m_s": 0.9 * noise[k] ** 0.8 * scale,
                        "pbd_m": 0.0 if grade else 0.06 * base,
                        "pbv_m_s": 0.0 if grade else 0.7 * base,
                        "pba_m_s2": 8.0 * noise[k] * scale if grade else 12.0 * base,
                        "top_rotation_peak_rad": 0.0 if grade else 0.01 * base,
                        "uplift_ratio": 0.05 * base**2.5,
                        "lateral_force_filtered_peak_n": 1.2e5 * min(base, 1.0),
                    }
                    for name in values:
                        values[name] *= np.exp(0.01 * rng.standard_normal())
                        values[name] *= ratios.get((model, name), 1.0)
                    rows.append(
                        {"record": f"R{k:02}", "level": level, "scale": scale,
                         "vehicle.speed": speed, "model": model, **values}
                    )  # fmt: skip
    made = pd.DataFrame(rows)
    made.insert(0, "row", np.arange(len(made)))
    made.insert(6, "scenario_hash", [f"{k:064x}" for k in range(len(made))])
    made["status"] = "safe"
    made["derailment_mode"] = None
    made["onset_first_s"] = np.nan
    made["flange_contact_first_s"] = np.nan
    made["off_rail_time_s"] = 0.0
    made["wheel_load_static_n"] = 2.0e5
    return made
