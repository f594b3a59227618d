"""Runs whose numbers are pinned, how they are made, and how two such sets of numbers compare.

``tests/pins`` holds what `railquake` gave before it was restructured; ``tools/pins.py`` makes the
numbers anew and compares them, ``verification/test_pins.py`` does so with some of them.  Four
groups:

suite
    the paper's twenty records at four levels, elastic and Bouc-Wen: by themselves, abreast, and
    abreast with the longer step of structure and sprung bodies; needs the records;
mixed
    short synthetic motions, every kind of car, support, law and option; by themselves and abreast;
demo
    the table of ``railquake demo``;
plain
    some milliseconds each of the uncompiled physics, with all histories.

Only names that last are used here: the package's own, the command line and files.
"""

import csv
import itertools
import json
import math
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import railquake as rq

FOLDER = Path(__file__).with_name("pins")
GROUPS = ("suite", "mixed", "demo", "plain")
LEFT_OUT = (
    "wall_s", "steps_per_s", "versions", "sequence", "warnings",  # sentences round their numbers
)  # fmt: skip


def uncompiled():
    """The target that leaves the physics to the interpreter: the one name here that may move."""
    from railquake.march.compiler import PYTHON

    return PYTHON


# --- the paper's suite ---------------------------------------------------------------------------

LEVELS = (0.21, 0.74, 1.0, 1.38)
HINGES = ("elastic", "bouc-wen")
# solver.substeps of each engine; None: a run by itself
SUITE_ENGINES = {"single": None, "abreast, all alike": 1, "abreast": 10}


def suite_inputs(records, engine):
    """All 160 by name, as arguments of `railquake.scenario`; from the records' folder."""
    substeps = SUITE_ENGINES[engine]
    solver = {} if substeps is None else {"substeps": substeps}
    with open(records / "manifest.csv", newline="", encoding="utf-8") as file:
        factors = {row["file"]: float(row["scale_factor"]) for row in csv.DictReader(file)}
    return {
        f"{engine}: {Path(record).stem} x {level}, {hinge}": {
            "record": records / record, "scale": level * factor, "hinge": hinge, **solver,
        }
        for (record, factor), level, hinge in itertools.product(factors.items(), LEVELS, HINGES)
    }  # fmt: skip


# --- all kinds, mixed ----------------------------------------------------------------------------

MIXED_ENGINES = ("single", "abreast")
GRAVITY = 9.80665


def shaking(seed, pga, seconds=3, **more):
    """Parameters of a synthetic motion; ``pga`` in g."""
    rest = {"duration": f"{seconds} s", "highpass_frequency": "0.6 Hz", **more}
    return {"synthetic": {"seed": seed, "pga": f"{pga} g", **rest}}


def waves(amplitude, seconds, dt, *frequencies):
    """Swelling and fading sines with that peak together, rounded: the same on every machine."""
    count = round(seconds / dt)
    values = [
        math.sin(math.pi * k / count)
        * sum(math.sin(2.0 * math.pi * f * k * dt) for f in frequencies)
        / len(frequencies)
        for k in range(count + 1)
    ]
    return [round(amplitude * value, 9) for value in values]


BODIES = {
    "box": {"mass": "30 t", "roll_inertia": "30 t m2", "height": "1.9 m"},
    "cradle": {"mass": "3 t", "roll_inertia": "2 t m2", "height": "1.0 m"},
    "frame": {"mass": "5 t", "roll_inertia": "3 t m2", "height": "0.6 m"},
    "wheelset": {"mass": "2600 kg", "roll_inertia": "1400 kg m2", "height": "0.392 m"},
}


def car(*names, lopsided=False):
    """A car of some of the bodies above, each sprung on the next lower one."""
    springs, dashpots = {}, {}
    for upper, lower in itertools.pairwise(names):
        for direction, stiffness in (("lateral", "0.5 MN/m"), ("vertical", "1.5 MN/m")):
            common = {
                "bodies": [upper, lower],
                "direction": direction,
                "lateral": "0.6 m",
                "height": BODIES[lower]["height"],
            }
            springs[f"{upper} {direction}"] = {**common, "stiffness": stiffness}
            dashpots[f"{upper} {direction}"] = {**common, "damping": "60 kN s/m"}
    if lopsided:  # stiffer on the right: bounce and roll hang together
        springs["extra"] = {
            **springs[f"{names[0]} vertical"], "stiffness": "0.2 MN/m", "pair": False,
        }  # fmt: skip
    return {
        "name": "car of " + ", ".join(names),
        "bodies": {name: BODIES[name] for name in names},
        "springs": springs,
        "dashpots": dashpots,
        "axles": 4,
        "speed": "80 km/h",
        "kinematics": "linear",
    }


def pier(**changes):
    return {"preset": "bart-berkeley", **changes}


def wheels(preset="bart", **changes):
    return {"preset": preset, **changes}


WEARING = {"rho_eps": 0.5, "eta0": 0.2, "rho_p": 0.4, "eps_p": 2e-4, "sigma": 4e-4, "u": 2.5}
LIGHT = {"mass": "20 t", "rotational_inertia": "1e5 kg*m^2"}
OF_2023 = {
    "vehicle": "bart-2023-runs",
    "support": "bart-berkeley-2023-runs",
    "wheelrail": "bart-2023-runs",
}
AT_GRADE = {"support": "at-grade"}
SHORT = shaking(3, 0.6, 2)
STRONG = shaking(3, 1.5, dt="0.004 s")
STRONGER = shaking(8, 2.5, ground_frequency="1.8 Hz")
VIOLENT = {
    **shaking(8, 5.0, 6, ground_frequency="1.2 Hz", highpass_frequency="0.3 Hz"),
    "allow_high_pga": True,
}
VERTICAL_DT = 0.005


def upwards(peak, seconds):
    """Vertical motion beside a synthetic one; ``peak`` in g."""
    samples = waves(peak * GRAVITY, seconds, VERTICAL_DT, 7.0, 3.1)
    return {"vertical": rq.GroundMotion("waves", VERTICAL_DT, samples)}


def track_file(folder, name, amplitude, roll):
    """File of a prescribed track's motion: 3 s, amplitude in m, roll in rad."""
    dt, seconds = 0.005, 3.0
    columns = (
        waves(amplitude, seconds, dt, 1.1, 1.7),
        waves(0.1 * amplitude, seconds, dt, 4.0),
        waves(roll, seconds, dt, 2.3),
    )
    path = Path(folder) / f"{name}.csv"
    lines = [f"{k * dt:.3f},{y},{z},{r}" for k, (y, z, r) in enumerate(zip(*columns, strict=True))]
    path.write_text("t_s,y_m,z_m,roll_rad\n" + "\n".join(lines) + "\n", encoding="utf-8")
    return {"support": {"kind": "prescribed", "file": str(path)}}


def mixed_inputs(folder, engine):
    """All of them by name, as arguments of `railquake.scenario`.

    ``folder`` takes files that some need.
    """
    inputs = {
        "as it comes": SHORT,
        "elastic": {**SHORT, "hinge": "elastic"},
        "strong": STRONG,
        "strong, elastic": {**STRONG, "hinge": "elastic"},
        "stronger": STRONGER,
        "stronger, elastic": {**STRONGER, "hinge": "elastic"},
        "violent": VIOLENT,
        "violent, elastic": {**VIOLENT, "hinge": "elastic"},
        "violent, at grade": {**VIOLENT, **AT_GRADE},
        "violent, decoupled, vertical, mirrored": {
            **VIOLENT, **upwards(0.5, 6.0), "scale": -0.9, "coupled": False, "hinge": "elastic",
        },
        "mirrored": {**SHORT, "scale": -1.0, "hinge": "elastic"},
        "at grade": {**SHORT, **AT_GRADE},
        "at grade, strong": {**STRONG, **AT_GRADE},
        "at grade, stronger": {**STRONGER, **AT_GRADE, "speed": "0.01 km/h"},
        "decoupled": {**SHORT, "coupled": False},
        "decoupled, strong, elastic": {**STRONG, "coupled": False, "hinge": "elastic"},
        "prescribed track": track_file(folder, "gentle", 0.02, 0.002),
        "prescribed track, strong": track_file(folder, "strong", 0.15, 0.02),
        "prescribed track, and the ground": {**SHORT, **track_file(folder, "both", 0.02, 0.004)},
        "vertical": {**SHORT, **upwards(0.3, 2.0)},
        "vertical, strong, elastic": {
            **shaking(5, 1.4), **upwards(0.9, 3.0), "hinge": "elastic",
        },
        "standing": {**STRONG, "speed": "0.01 km/h"},
        "standing, elastic": {**SHORT, "speed": "0.01 km/h", "hinge": "elastic"},
        "slow": {**SHORT, "speed": "10 km/h"},
        "fast": {**SHORT, "speed": "240 km/h"},
        "faster, strong, elastic": {**STRONG, "speed": "360 km/h", "hinge": "elastic"},
        "coulomb": {**SHORT, "wheelrail": wheels(creep_law="coulomb"), "hinge": "elastic"},
        "coulomb, strong": {**STRONG, "wheelrail": wheels(creep_law="coulomb"), "hinge": "elastic"},
        "carter, 2023": {**SHORT, **OF_2023},
        "carter, 2023, strong": {**STRONG, **OF_2023},
        "polach": {**SHORT, "wheelrail": wheels(creep_law="polach"), **AT_GRADE},
        "polach, strong": {**STRONG, "wheelrail": wheels(creep_law="polach"), "hinge": "elastic"},
        "calibrated restitution": {
            **STRONG, "wheelrail": wheels(restitution_law="calibrated", restitution=0.5),
        },
        "calibrated restitution, elastic": {
            **shaking(6, 1.8), "wheelrail": wheels(restitution_law="calibrated"),
            "hinge": "elastic",
        },
        "no restitution": {**STRONGER, "wheelrail": wheels(restitution=0.0), "hinge": "elastic"},
        "little friction": {**SHORT, **AT_GRADE, "wheelrail": wheels(friction=0.05)},
        "other bounds of speed": {
            **STRONG, "wheelrail": wheels(onset_rate_bound="0.02 m/s", speed_bound="30 m/s"),
        },
        "P-delta": {**SHORT, "support": pier(p_delta=True)},
        "P-delta, strong, elastic": {**STRONG, "support": pier(p_delta=True, hinge="elastic")},
        "wearing hinge": {**SHORT, "support": pier(bouc_wen=WEARING)},
        "wearing hinge, stronger": {**STRONGER, "support": pier(bouc_wen=WEARING)},
        "hinge solved once": {**SHORT, "hinge_solve": "linearised"},
        "wearing hinge solved once, stronger": {
            **STRONGER, "support": pier(bouc_wen=WEARING), "hinge_solve": "linearised",
        },
        "long pier": {**SHORT, "support": pier(length="8 m", damping_ratio=0.05, track_offset=0.0)},
        "light pier": {**SHORT, "support": pier(**LIGHT)},
        "light pier, standing, elastic": {
            **STRONG, "support": pier(**LIGHT, hinge="elastic"), "speed": "0.01 km/h",
        },
        "grid": {**shaking(3, 0.6, 1.7), "contact": "grid", "hinge": "elastic", "dt": "5e-5 s"},
        "grid, strong": {**STRONG, "contact": "grid", "hinge": "elastic", "dt": "5e-5 s"},
        "european": {**SHORT, "wheelrail": "s1002-60e1"},
        "european, stronger, elastic": {
            **STRONGER, "wheelrail": wheels("s1002-60e1", gauge="1440 mm"), "hinge": "elastic",
        },
        "wide rails": {
            **STRONG, "wheelrail": wheels(rail_centre="34.5 in", gauge_height="16 mm"),
        },
        "2e-5 s": {**STRONG, "dt": "2e-5 s"},
        "5e-5 s, elastic": {**STRONG, "dt": "5e-5 s", "hinge": "elastic"},
        "1e-4 s": {**STRONG, "dt": "1e-4 s"},
        "chosen step": {**SHORT, "dt": "auto", "hinge": "elastic"},
        "other parameters of Zhai": {**SHORT, "phi": 0.6, "psi": 0.4, "hinge": "elastic"},
        "short frames": {
            **STRONG, "history_step": "1.4e-4 s", "lateral_force_filter": "10 Hz",
            "hinge": "elastic",
        },
        "four substeps": {**STRONG, "substeps": 4},
        "finer Newton": {**STRONGER, "newton_tolerance": 1e-8, "newton_max_iterations": 50},
        "two bodies": {**SHORT, "vehicle": car("box", "wheelset"), "hinge": "elastic"},
        "four bodies": {
            **SHORT, "vehicle": car("box", "cradle", "frame", "wheelset"), "hinge": "elastic",
        },
        "four bodies, strong": {
            **STRONG, "vehicle": car("box", "cradle", "frame", "wheelset"), "hinge": "elastic",
        },
        "lopsided": {
            **SHORT, "vehicle": car("box", "wheelset", lopsided=True), "hinge": "elastic",
        },
        "lopsided, strong": {
            **STRONG, "vehicle": car("box", "wheelset", lopsided=True), "hinge": "elastic",
        },
        "tall car on one axle": {
            **STRONG,
            "vehicle": {"preset": "bart", "axles": 1, "bodies": {"car": {"height": "2.6 m"}}},
        },
        "hopeless": {**SHORT, "scale": 100.0},
    }  # fmt: skip
    return {f"{engine}: {name}": given for name, given in inputs.items()}


# --- uncompiled ----------------------------------------------------------------------------------

SIDEWAYS = [0.0, 500.0, 900.0, 900.0, 400.0, -600.0, -200.0]  # m/s2, each millisecond
UPWARDS = [0.0, 20.0, -60.0, -60.0, 30.0, 50.0, 0.0]
JOLT = {
    "motion": rq.GroundMotion("jolt", 1e-3, SIDEWAYS),
    "allow_high_pga": True,
    "vertical": rq.GroundMotion("jolt", 1e-3, UPWARDS),
    "dt": "2e-5 s",
    "history_step": "1e-4 s",
}
BLOW = {
    "motion": rq.GroundMotion(
        "blow", 2e-3, [0.0, 300.0, 300.0, 200.0, 0.0, -200.0, -200.0, *4 * [0.0]]
    ),
    "allow_high_pga": True,
    "dt": "2e-5 s",
}
PUSH = {
    "motion": rq.GroundMotion("push", 5e-3, [9.0, 28.0, 28.0, 28.0, 0.0]),
    "dt": "4e-5 s",
}
# a foot that Newmark's method follows at such steps; the preset's is next to nothing
JOLTED_PIER = pier(base_rotational_inertia=1e5, bouc_wen=WEARING)
STUBBY = {**JOLTED_PIER, **LIGHT, "length": "2 m"}
PLAIN = {
    "jolt": {**JOLT, "support": JOLTED_PIER},
    "jolt, elastic, mirrored": {
        **JOLT, "support": {**JOLTED_PIER, "hinge": "elastic"}, "scale": -1.0,
    },
    "jolt, hinge solved once, P-delta": {
        **JOLT, "support": {**JOLTED_PIER, "p_delta": True}, "hinge_solve": "linearised",
    },
    "jolt, decoupled, standing": {
        **JOLT, "support": {**JOLTED_PIER, "coupled": False}, "speed": "0.01 km/h", "scale": 0.8,
    },
    "jolt at grade, carter, four bodies": {
        **JOLT, **AT_GRADE, "wheelrail": wheels(creep_law="carter", restitution=0.0),
        "vehicle": car("box", "cradle", "frame", "wheelset"),
    },
    "jolt at grade, coulomb, lopsided": {
        **JOLT, **AT_GRADE, "wheelrail": wheels(creep_law="coulomb"), "speed": "240 km/h",
        "vehicle": car("box", "wheelset", lopsided=True),
    },
    "blow, stubby pier": {**BLOW, "support": STUBBY},
    "blow at grade": {**BLOW, **AT_GRADE, "speed": "240 km/h"},
    "blow at grade, european, mirrored": {
        **BLOW, **AT_GRADE, "wheelrail": "s1002-60e1", "scale": -1.5,
    },
    "push, longer steps of what is slow": {**PUSH, "substeps": 5},
    "push, polach, calibrated": {
        **PUSH, "support": "at-grade",
        "wheelrail": wheels("s1002-60e1", creep_law="polach", restitution_law="calibrated"),
    },
    "push, other parameters of Zhai": {**PUSH, "hinge": "elastic", "phi": 0.6, "psi": 0.4},
    "push, grid": {
        **PUSH, **AT_GRADE, "contact": "grid",
        "motion": rq.GroundMotion("push", 4e-4, [9.0, 28.0, 28.0]),
    },
}  # fmt: skip


def plain_row(name):
    """Measures of an uncompiled run; of every history the last value and the largest."""
    response = rq.simulate(rq.scenario(**PLAIN[name]), target=uncompiled())
    row = kept(rq.assess(response))
    for channel, values in response.history.data_vars.items():
        row[f"last {channel}"] = float(values[-1])
        row[f"peak {channel}"] = float(abs(values).max())
    return row


# --- making the numbers --------------------------------------------------------------------------


def kept(row):
    """What is pinned of a row: all but times of execution and versions."""
    return {key: value for key, value in row.items() if key not in LEFT_OUT}


def rows_of(inputs, threads=1):
    """Rows of what `suite_inputs` and `mixed_inputs` give: the names begin with the engine's."""
    single = [name for name in inputs if name.startswith("single: ")]
    abreast = [name for name in inputs if name not in single]

    def alone(name):
        return kept(rq.assess(rq.simulate(rq.scenario(**inputs[name]))))

    with ThreadPoolExecutor(threads) as pool:
        rows = dict(zip(single, pool.map(alone, single), strict=True))
    cases = (rq.scenario(**inputs[name]) for name in abreast)
    many = rq.simulate_many(cases, threads=threads)
    rows.update((abreast[k], kept(row)) for k, row in many)
    return {name: rows[name] for name in inputs}


def make_suite(records, threads=1):
    inputs = {}
    for engine in SUITE_ENGINES:
        inputs.update(suite_inputs(records, engine))
    return rows_of(inputs, threads)


def make_mixed(threads=1):
    with tempfile.TemporaryDirectory() as folder:
        inputs = {}
        for engine in MIXED_ENGINES:
            inputs.update(mixed_inputs(folder, engine))
        return rows_of(inputs, threads)


def make_demo(threads=1):
    """The table that ``railquake demo`` writes."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "railquake", "demo", "--out", folder]
        subprocess.run([*command, "--jobs", str(threads)], check=True, stdout=subprocess.DEVNULL)
        return demo_rows(folder)


def demo_rows(folder):
    """Rows of the demo's folder, by names of the runs' places in the study."""
    import pandas as pd

    table = pd.read_parquet(Path(folder) / "runs.parquet").drop(columns=["row", "scale", "error"])
    table = table.astype(object).where(table.notna(), None)
    rows = {}
    for row in table.to_dict("records"):
        record, level, speed, model = (
            row.pop(key) for key in ("record", "level", "vehicle.speed", "model")
        )
        row["scenario_hash"] = row["scenario_hash"][:8]
        rows[f"{record} {level}, {3.6 * speed:g} km/h, {model}"] = kept(row)
    return rows


def make_plain(threads=1):
    return {name: plain_row(name) for name in PLAIN}


# --- the files -----------------------------------------------------------------------------------


def write(group, rows):
    """One line a run; what is alike in all of them is said once."""
    if group == "plain":
        text = json.dumps(rows, indent=1)
    else:
        first = next(iter(rows.values()))
        alike = {
            key: value
            for key, value in first.items()
            if all(row[key] == value for row in rows.values())
        }
        measures = [key for key in first if key not in alike]
        lines = ",\n".join(
            f"{json.dumps(name)}: {_compact([row[key] for key in measures])}"
            for name, row in rows.items()
        )
        text = (
            f'{{"alike": {json.dumps(alike)},\n"measures": {json.dumps(measures)},\n'
            f'"runs": {{\n{lines}\n}}}}'
        )
    FOLDER.mkdir(exist_ok=True)
    (FOLDER / f"{group}.json").write_text(text + "\n", encoding="utf-8")


def _compact(values):
    return json.dumps(values, separators=(",", ":"))


def read(group):
    """Pinned rows by the runs' names."""
    data = json.loads((FOLDER / f"{group}.json").read_text(encoding="utf-8"))
    if group == "plain":
        return data
    return {
        name: data["alike"] | dict(zip(data["measures"], values, strict=True))
        for name, values in data["runs"].items()
    }


# --- comparing -----------------------------------------------------------------------------------

# the same whatever computed them
SAME = ("status", "derailed", "derailment_mode", "beyond_model", "contact", "steps")
# What a scenario says has changed since they were pinned, not what it gives: `solver.hinge_solve`
# is left open where it said "newton".
RENAMED = ("scenario_hash",)
# seen at the ends of frames
TIMES = (
    "flange_contact_first_s", "uplift_first_s", "uplift_last_end_s", "onset_first_s",
    "flange_over_first_s", "derailed_s", "slide_off_s", "climb_s", "overturned_s",
    "beyond_model_s",
)  # fmt: skip
FRAME = 1.5e-3  # s
COUNTED = (
    "off_rail_time_s", "detached_time_s", "flange_climb_time_left_s", "flange_climb_time_right_s",
)  # fmt: skip
# Of all other numbers, relative.  Measured with machine code for a processor without fused
# multiply-adds, and with NumPy and LAPACK kept from wide vectors, which change last bits of the
# motions, the contact table, the start and every step: 4e-11 where all wheels stay on their rails,
# 7e-9 where some lift.  Eight lanes instead of four change nothing.
SMOOTH = 1e-9
LIFTING = 1e-6
# Runs whose impacts amplify a last bit to more than that, with the relative bound for them: dozens
# of hard blows (87 and 35 uplifts) of a standing train on a decoupled elastic pier, whose motion no
# hinge and no train calms; 3e-5 and 3e-7 measured.  They still end the same way.
AMPLIFYING = {
    "synthetic-045 2%, 0.01 km/h, decoupled-elastic": 1e-3,
    "synthetic-355 2%, 0.01 km/h, decoupled-elastic": 1e-4,
}
# differences of nearly equal numbers: relative to this, if it is larger
SCALES = {"wheel_unloading_peak": 1.0, "flange_clearance_peak_m": 0.01}
# errors of the computation itself: absolute, where all wheels stay on their rails and elsewhere
RESIDUALS = {
    "energy_residual": (1e-9, 1e-7),
    "contact_energy_residual": (1e-8, 1e-5),
    "contact_gain": (1e-8, 1e-5),
    "gravity_work_residual": (1e-9, 1e-7),
    "linear_momentum_residual": (1e-8, 1e-6),
    "angular_momentum_residual": (1e-8, 1e-6),
    "dt_error": (1e-6, 1e-6),
}


@dataclass(frozen=True)
class Difference:
    """A measure of a run, pinned and found, and the difference in units of what is allowed."""

    run: str
    measure: str
    pinned: object
    found: object
    excess: float

    @property
    def relative(self):
        """The difference relative to the pinned number; None where these are no numbers."""
        if not are_numbers(self.pinned, self.found):
            return None
        size = abs(self.pinned)
        return abs(self.found - self.pinned) / size if size else math.inf

    def __str__(self):
        return (
            f"{self.run}: {self.measure}: pinned {self.pinned!r}, found {self.found!r} "
            f"({self.excess:.3g} times what is allowed)"
        )


def are_numbers(*values):
    return all(isinstance(value, int | float) and math.isfinite(value) for value in values)


def lifts(row):
    return (row.get("off_rail_time_s") or 0.0) > 0.0  # a run that failed has none


def compare(group, pinned, found, exact=False):
    """All differences between two sets of rows, those within the bounds too; worst first.

    ``exact`` allows none.
    """
    differences = []
    for run in pinned.keys() | found.keys():
        if run not in pinned or run not in found:
            known = ["missing" if run not in rows else "there" for rows in (pinned, found)]
            differences.append(Difference(run, "the run itself", *known, math.inf))
            continue
        differences += compare_rows(group, run, pinned[run], found[run], exact)
    return sorted(differences, key=lambda d: (-d.excess, d.run))


def compare_rows(group, run, old, new, exact=False):
    """The same of one run."""
    differences = []
    for measure in {**old, "error": None}:  # measures that have come since are no difference
        if measure in RENAMED:
            continue
        a, b = old.get(measure, "missing"), new.get(measure, "missing")
        if a == b or (a != a and b != b):  # NaN
            continue
        if exact or not are_numbers(a, b) or measure in SAME:
            excess = math.inf
        else:
            bound = allowed(group, run, measure, old, new)
            excess = abs(a - b) / bound if bound > 0.0 else math.inf
        differences.append(Difference(run, measure, a, b, excess))
    return differences


def allowed(group, run, measure, old, new):
    """How far two numbers of a run may be apart."""
    lifting = lifts(old) or lifts(new)
    if measure in TIMES:
        return FRAME
    if measure in RESIDUALS:
        return RESIDUALS[measure][lifting]
    size = max(abs(old[measure]), SCALES.get(measure, 0.0))
    if measure.startswith("last "):
        size = old[measure.replace("last ", "peak ")]
    if not lifting or group == "plain":
        return SMOOTH * size
    bound = AMPLIFYING.get(run, LIFTING) * size
    # counted in steps, of which one may fall on either side
    return max(bound, 1.5 * old["dt_s"]) if measure in COUNTED else bound
