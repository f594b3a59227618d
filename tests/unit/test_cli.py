"""The command line: what it prints and writes, and what it refuses in one line."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from railquake.cli import main

CASE = """
[vehicle]
preset = "bart"
speed = "80 km/h"
[support]
preset = "bart-berkeley"
[wheelrail]
preset = "bart"
[motion]
synthetic = { seed = 3, duration = "2 s", pga = "0.6 g", highpass_frequency = "0.6 Hz" }
"""

SUMMARY_KEYS = [
    "status",
    "derailed",
    "derailment_mode",
    "pga_m_s2",
    "pgv_m_s",
    "pbd_m",
    "pbv_m_s",
    "pba_m_s2",
    "hinge_rotation_peak_rad",
    "base_moment_peak_n_m",
    "top_rotation_peak_rad",
    "relative_roll_peak_rad",
    "uplift_ratio",
    "lateral_shift_peak_m",
    "wheel_load_peak_n",
    "lateral_force_peak_n",
    "lateral_force_filtered_peak_n",
    "off_rail_time_s",
    "energy_residual",
    "steps",
    "steps_per_s",
    "wall_s",
    "dt_s",
    "contact",
    "versions",
]


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path


def refused(capsys, *arguments):
    """The single line with which a command is refused."""
    assert main([str(a) for a in arguments]) == 2
    printed = capsys.readouterr()
    lines = [line for line in printed.err.splitlines() if "compiling" not in line]
    assert len(lines) == 1, printed.err
    assert "Traceback" not in printed.err
    return lines[0]


def test_run_writes_numbers_histories_and_pictures(case, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["run", str(case), "--out", str(out), "--set", "motion.scale=1.1"]) == 0
    row = json.loads((out / "summary.json").read_text())
    assert set(SUMMARY_KEYS) <= set(row)
    assert row["pga_m_s2"] == pytest.approx(1.1 * 0.6 * 9.80665)
    names = {path.name for path in out.iterdir()}
    assert {"history.nc", "events.csv", "case.toml", "section.png", "hinge-loop.png"} <= names
    assert not [path for path in tmp_path.iterdir() if path.name.startswith(".")]
    import xarray

    with xarray.open_dataset(out / "history.nc", engine="h5netcdf") as history:
        assert "bridge_displacement_m" in history
    # the case it wrote gives the same run again
    assert main(["run", str(out / "case.toml"), "--out", str(tmp_path / "again"), "--json"]) == 0
    again = json.loads((tmp_path / "again" / "summary.json").read_text())
    assert again["pbd_m"] == row["pbd_m"]


def test_a_folder_in_use_keeps_what_is_not_ours(case, tmp_path, capsys):
    out = tmp_path / "out"
    out.mkdir()
    (out / "notes.txt").write_text("mine")
    (out / "hinge-loop.png").write_text("of a former run")
    at_grade = ["--set", "support.kind=at-grade"]
    assert main(["run", str(case), "--out", str(out), *at_grade]) == 0
    assert (out / "notes.txt").read_text() == "mine"
    assert not (out / "hinge-loop.png").exists()


def test_modes_as_json(capsys):
    assert main(["modes", "bart", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["frequencies_hz"][:3] == pytest.approx([0.292, 1.009, 1.034], rel=2e-3)
    assert found["labels"][:3] == [
        "Carbody lower sway",
        "Carbody upper sway",
        "Carbody bounce",
    ]


def test_presets_are_listed_and_printed(capsys):
    assert main(["presets"]) == 0
    assert "bart-berkeley" in capsys.readouterr().out
    assert main(["presets", "bart-berkeley"]) == 0
    assert "beta0" in capsys.readouterr().out
    assert main(["presets", "--json"]) == 0
    assert {"vehicle", "support", "wheelrail"} == {
        preset["kind"] for preset in json.loads(capsys.readouterr().out)
    }


def test_check_says_what_would_be_run(case, capsys):
    assert main(["check", str(case), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["ok"]
    assert facts["dt_s"] < facts["dt_critical_s"]


def test_probe_motion_measures_a_record(shared, capsys):
    """Peaks from the suite's manifest."""
    file = shared / "records" / "paper_suite" / "RSN006_IMPVALLH2.AT2"
    assert main(["probe", "motion", str(file), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["dt_s"] == 0.01
    assert found["npts"] == 5330
    assert found["pga_m_s2"] == pytest.approx(0.210743 * 9.80665, rel=1e-4)
    assert found["pgv_m_s"] == pytest.approx(0.3136, rel=1e-3)


def test_probe_hinge_writes_the_columns_of_the_contract(tmp_path, capsys):
    path, out = tmp_path / "x.csv", tmp_path / "m.csv"
    path.write_text("x\n0\n1e-3\n-1e-3\n")
    arguments = ["--preset", "bart-berkeley", "--path", str(path), "--out", str(out)]
    assert main(["probe", "hinge", *arguments, "--set", "n=1.2", "--set", "m=1.0"]) == 0
    lines = out.read_text().splitlines()
    assert lines[0] == "x,moment,z,damage"
    assert len(lines) == 4


def test_probe_car_leans_a_car(capsys):
    assert main(["probe", "car", "--vehicle", "manchester", "--lean", "2.0", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    # oracles/car_static_manchester.csv
    assert found["car_y_m"] == pytest.approx(0.10189216, rel=1e-5)
    assert found["bogie_roll_rad"] == pytest.approx(0.0121815729, rel=1e-5)
    assert found["flexibility_coefficient"] == pytest.approx(0.1805, abs=1e-4)


def test_probe_car_writes_a_history(tmp_path, capsys):
    record = tmp_path / "a.csv"
    rows = "\n".join(f"{0.01 * k:.2f},{0.5 if k % 40 < 20 else -0.5}" for k in range(101))
    record.write_text("time [s],acceleration [m/s2]\n" + rows + "\n")
    out = tmp_path / "h.csv"
    arguments = ["--vehicle", "bart", "--motion", str(record), "--out", str(out)]
    assert main(["probe", "car", *arguments]) == 0
    header, *lines = out.read_text().splitlines()
    assert header == ("t_s,car_y_m,car_z_m,car_roll_rad,bogie_y_m,bogie_z_m,bogie_roll_rad")
    assert len(lines) == 1001 and lines[0] == "0.000" + ",0" * 6
    # thrown back at first: 0.5 m/s2 for 0.1 s
    assert float(lines[100].split(",")[1]) == pytest.approx(-0.5 * 0.5 * 0.1**2, rel=0.1)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "give either --lean, m/s2, or --motion"),
        (["--lean", "1", "--motion", "a.csv"], "give either --lean, m/s2, or --motion"),
        (["--vehicle", "manchester", "--lean", "300"], "the car falls over; take less"),
        (["--lean", "nan"], "--lean: must be a finite number of m/s2"),
        (["--vehicle", "barth", "--lean", "1"], 'did you mean "bart"'),
    ],
)
def test_probe_car_refuses_in_one_line(capsys, arguments, said):
    assert said in refused(capsys, "probe", "car", *arguments)


def test_probe_contact_gives_a_row_a_patch(capsys):
    arguments = ["--preset", "s1002-60e1", "--shift", "0.0", "--load", "50e3", "--json"]
    assert main(["probe", "contact", *arguments]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["side"] for row in rows] == ["left", "right"]
    assert set(rows[0]) == {
        "side", "y_m", "z_m", "angle_rad", "approach_m", "normal_n", "a_m", "b_m",
    }  # fmt: skip
    assert rows[0]["y_m"] == pytest.approx(-rows[1]["y_m"], abs=1e-9)


def test_probe_creep_opposes_the_creepage(capsys):
    arguments = "--semi-axes 6e-3,5e-3 --load 50e3 --creepage 1e-3 --spin 0 --mu 0.3 --json"
    assert main(["probe", "creep", *arguments.split(), "--law", "coulomb"]) == 0
    assert json.loads(capsys.readouterr().out)["lateral_force_n"] < 0.0
    assert (
        main(["probe", "creep", *arguments.split(), "--longitudinal", "0.01", "--law=fastsim"]) == 0
    )
    found = json.loads(capsys.readouterr().out)
    assert found["lateral_force_n"] < 0.0
    # all slides: the force opposes the slip, ten times as much along as across
    ratio = found["longitudinal_force_n"] / found["lateral_force_n"]
    assert ratio == pytest.approx(10.0, rel=0.05)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--set", "vehicle.sped=3"], "vehicle.sped"),
        (["--set", "vehicle.preset=brat"], "brat"),
        (["--set", "vehicle.speed=80 km"], "vehicle.speed"),
        (["--set", "support.mass=3 m"], "support.mass"),
        (["--set", "support.mass=-1"], "support.mass"),
        (["--set", "support.mass=nan"], "support.mass"),
        (["--set", "support.bouc_wen.alpha=1.5"], "alpha"),
        (["--set", "solver.dt=4e-4 s", "--set", "vehicle.speed=0.1 km/h"], "solver.dt"),
        (["--set", "motion.record=nothing.AT2"], "nothing.AT2"),
        (["--set", "motion.synthetic.pga=0.6 km"], "pga"),
        (["--set", "wheelrail.preset=s1002-60e2"], "s1002-60e1"),
        (["--set", "wheelrail.gauge=3 m"], "never touch"),
        (["--set", "wheelrail.wheel=nothing.prw"], "nothing.prw"),
        (["--set", "support.kind=elevated"], "elevated"),
        (["--set", "nonsense"], "nonsense"),
    ],
)
def test_wrong_values_are_refused_by_name(case, tmp_path, capsys, arguments, words):
    line = refused(capsys, "run", case, "--out", tmp_path / "out", *arguments)
    assert words in line
    assert not (tmp_path / "out").exists()


def test_bare_number_is_in_si_units(case, capsys):
    assert main(["check", str(case), "--json", "--set", "vehicle.speed=80"]) == 0
    assert json.loads(capsys.readouterr().out)["speed_m_s"] == 80.0
    assert main(["check", str(case), "--json", "--set", "vehicle.speed=80 km/h"]) == 0
    assert json.loads(capsys.readouterr().out)["speed_m_s"] == pytest.approx(80.0 / 3.6)


@pytest.mark.parametrize(
    "name",
    ["asterisks", "dt_zero", "empty", "nan", "npts_too_large", "truncated"],
)
def test_bad_records_are_refused_before_anything_is_written(shared, case, tmp_path, capsys, name):
    file = shared / "records" / "formats" / "bad" / f"{name}.AT2"
    assert name in refused(capsys, "probe", "motion", file)
    text = CASE.split("[motion]")[0] + f'[motion]\nrecord = "{file}"\n'
    case.write_text(text)
    assert name in refused(capsys, "run", case, "--out", tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "nothere.toml", "--out", "x"],
        ["run", "--no-such-option"],
        ["nosuchcommand"],
        ["modes", "brat"],
        ["presets", "brat"],
        ["run", "case.toml"],
        ["run", "."],
        ["check"],
        ["modes", "bart", "--out", "no/such/folder/modes.png"],
        ["probe", "hinge", "--set", "bogus=1"],
        ["probe", "hinge", "--set", "n=0.5"],
        ["probe", "hinge", "--set", "n"],
        ["probe", "hinge", "--hinge", "plastic"],
        ["probe", "hinge", "--preset", "bart"],
        ["probe", "hinge", "--path", "nothere.csv"],
        ["probe", "hinge", "--path", "."],
        ["probe", "hinge", "--out", "no/such/folder/m.csv"],
        ["probe", "contact", "--load", "-5"],
        ["probe", "contact", "--load", "nan"],
        ["probe", "contact", "--shift", "50"],
        ["probe", "contact", "--shift", "nan"],
        ["probe", "contact", "--shift", "5 mm"],
        ["probe", "contact", "--young", "-1"],
        ["probe", "contact", "--poisson", "0.5"],
        ["probe", "contact", "--wheel", "nothere.prw"],
        ["probe", "creep", "--semi-axes", "6e-3", "--load", "50e3"],
        ["probe", "creep", "--semi-axes", "6e-3,5e-3", "--load", "50e3", "--law", "hertz"],
        ["probe", "creep", "--semi-axes", "6e-3,-5e-3", "--load", "50e3"],
        ["probe", "creep", "--semi-axes", "6e-3,5e-3", "--load", "50e3", "--mu", "inf"],
        ["probe", "creep", "--semi-axes", "6e-3,5e-3", "--load", "50e3", "--creepage", "nan"],
        ["probe", "motion", "."],
        ["probe", "motion", "nothere.AT2"],
    ],
)
def test_wrong_use_is_one_line(capsys, arguments):
    assert refused(capsys, *arguments).startswith("railquake: ")


@pytest.mark.parametrize("text", ["x\n0\nabc\n", "x\n0\nnan\n", "x\n0\n,1\n", "# x\nx\n1e999\n"])
def test_path_with_a_value_that_is_no_number_names_the_line(tmp_path, capsys, text):
    path = tmp_path / "x.csv"
    path.write_text(text)
    assert "line 3" in refused(capsys, "probe", "hinge", "--path", path)


@pytest.mark.parametrize("content", [b"", b"x\n", b"y\n1\n", bytes(range(128, 256))])
def test_path_without_rotations_is_refused(tmp_path, capsys, content):
    path = tmp_path / "x.csv"
    path.write_bytes(content)
    assert "x.csv" in refused(capsys, "probe", "hinge", "--path", path)


def test_path_from_a_spreadsheet_is_read(tmp_path, capsys):
    """A byte order mark, other columns, comments and blank lines do no harm."""
    path = tmp_path / "x.csv"
    path.write_bytes(b"\xef\xbb\xbf# mine\r\nt, x\r\n0, 0\r\n\r\n1, 1e-4\r\n")
    assert main(["probe", "hinge", "--path", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["x"] == [0.0, 1e-4]


def test_results_cannot_go_where_a_file_is(case, tmp_path, capsys):
    (tmp_path / "taken").write_text("")
    assert "taken" in refused(capsys, "run", case, "--out", tmp_path / "taken")


@pytest.mark.skipif(sys.platform == "win32", reason="has no such limits")
@pytest.mark.parametrize("size", [100, 3_000, 30_000])
def test_a_run_that_finds_the_disk_full_leaves_nothing(case, tmp_path, capsys, size):
    """Wherever it gets full: in a text, in the histories (HDF5 ends the process), in a picture."""
    import resource

    assert main(["check", str(case)]) == 0  # what can be kept of it is kept
    capsys.readouterr()
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        status = main(["run", str(case), "--out", str(tmp_path / "a" / "out")])
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert status == 2
    complaint = [
        line
        for line in capsys.readouterr().err.splitlines()
        if "compiling" not in line and "in memory" not in line
    ]
    folder = tmp_path / "a" / "out"
    assert complaint == [f"railquake: {folder}: cannot be written: File too large"]
    assert [path.name for path in tmp_path.iterdir()] == ["case.toml"]


def listens(process: subprocess.Popen[str]) -> bool:
    """Whether a process has put its own answer to a request to terminate in place."""
    known = Path(f"/proc/{process.pid}/status").read_text()
    caught = next(line for line in known.splitlines() if line.startswith("SigCgt"))
    return bool(int(caught.split()[1], 16) >> (signal.SIGTERM - 1) & 1)


@pytest.mark.skipif(sys.platform != "linux", reason="reads what signals a process listens to")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("after", [0.0, 2.0])
def test_stopped_run_leaves_nothing_behind(tmp_path, number, after):
    case = tmp_path / "case.toml"
    case.write_text(CASE.replace("2 s", "600 s"))
    process = subprocess.Popen(
        [sys.executable, "-m", "railquake", "run", str(case), "--out", str(tmp_path / "a" / "out")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ,
    )
    while process.poll() is None and not listens(process):
        time.sleep(0.01)  # a busy machine takes seconds to start Python
    time.sleep(after)
    process.send_signal(number)
    printed, complaint = process.communicate(timeout=60)
    assert process.returncode == 130
    assert printed == ""
    lines = [line for line in complaint.splitlines() if "compiling" not in line]
    assert lines == ["railquake: stopped; nothing is half-written"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["case.toml"]


def test_run_that_diverged_says_so_loudly(case, tmp_path, capsys, monkeypatch):
    from railquake.report import run_folder
    from railquake.run.assess import assess as real

    def assess(response):
        return real(response) | {"status": "diverged", "pbd_m": float("nan")}

    monkeypatch.setattr(run_folder, "assess", assess)
    out = tmp_path / "out"
    at_grade = ["--set", "support.kind=at-grade"]
    assert main(["run", str(case), "--out", str(out), *at_grade]) == 0
    assert "DO NOT USE" in capsys.readouterr().out
    assert json.loads((out / "summary.json").read_text())["pbd_m"] is None
    assert main(["run", str(case), "--out", str(out), "--json", *at_grade]) == 0
    assert json.loads(capsys.readouterr().out)["status"] == "diverged"


def test_progress_is_shown_on_a_terminal_only(monkeypatch, capsys):
    from railquake.cli.shared import progress_bar

    with progress_bar() as (progress, say):
        assert progress is None
        say("compiling")
    assert capsys.readouterr().err == "railquake: compiling\n"
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    with progress_bar() as (progress, say):
        progress(1, 2)
        say("compiling")
    printed = capsys.readouterr()
    assert printed.out == "" and "railquake: compiling" in printed.err


PROBES = [
    ["modes", "bart", "--out"],
    ["probe", "hinge", "--picture"],
    ["probe", "contact", "--shift", "0.0085", "--picture"],
    ["probe", "creep", "--semi-axes", "6e-3,5e-3", "--load", "50e3", "--curve"],
]


@pytest.mark.parametrize("arguments", PROBES, ids=lambda arguments: arguments[-2])
def test_components_are_drawn(tmp_path, capsys, arguments):
    assert main([*arguments, str(tmp_path / "picture.png"), "--json"]) == 0
    json.loads(capsys.readouterr().out)  # nothing but JSON
    assert [path.name for path in tmp_path.iterdir()] == ["picture.png"]
    assert (tmp_path / "picture.png").read_bytes().startswith(b"\x89PNG")


def test_motion_is_drawn_scaled_and_mirrored(shared, tmp_path, capsys):
    file = shared / "records" / "formats" / "two_column_t_g.csv"
    picture = tmp_path / "motion.png"
    arguments = ["probe", "motion", str(file), "--scale", "-2", "--out", str(picture), "--json"]
    assert main(arguments) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["pga_m_s2"] == pytest.approx(2.0 * 2.56231, rel=1e-5)
    assert any("mirrored" in note for note in found["notes"])
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_channels_of_a_record_are_listed(shared, capsys):
    file = shared / "records" / "formats" / "csmip_ce36456p.V2"
    line = refused(capsys, "probe", "motion", file)
    assert "1: 90 DEG" in line and "2: UP" in line
    assert main(["probe", "motion", str(file), "--channel", "UP", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["npts"] == 3250


COMMANDS = [
    "demo", "run", "presets", "check", "modes", "probe hinge", "probe motion", "probe contact",
    "probe creep",
]  # fmt: skip


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_an_example(capsys, command):
    assert main([*command.split(), "--help"]) == 0
    text = capsys.readouterr().out
    assert f"Example: railquake {command}" in text


def test_without_a_command_the_commands_are_listed(capsys):
    assert main([]) == 0
    assert "presets" in capsys.readouterr().out
    assert main(["probe"]) == 0
    assert "contact" in capsys.readouterr().out
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("railquake 0.")


def test_reader_of_a_pipe_may_leave():
    """``railquake presets bart | head -1`` ends without a complaint."""
    command = f"{sys.executable} -m railquake presets bart | true"
    done = subprocess.run(command, shell=True, capture_output=True, text=True)
    assert done.stderr == ""
    assert done.returncode == 0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")
@pytest.mark.parametrize("command", ["presets", "presets bart --json", "--help", "run --help"])
def test_a_full_output_is_one_line(command):
    command = f"{sys.executable} -m railquake {command} > /dev/full"
    done = subprocess.run(command, shell=True, capture_output=True, text=True)
    assert done.returncode == 2
    text = "railquake: standard output cannot be written: No space left on device\n"
    assert done.stderr == text


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")
@pytest.mark.parametrize("where", ["2> /dev/full", "2>&-"])
def test_what_cannot_be_complained_of_is_told_by_the_status(where):
    command = f"{sys.executable} -m railquake presets nothing {where}"
    assert subprocess.run(command, shell=True).returncode == 2


def test_the_end_of_what_is_read_is_no_wish_to_stop(monkeypatch):
    """Of a damaged file, say: the framework takes it for Ctrl-C."""
    from railquake.inputs import presets

    def ends():
        raise EOFError("ran out of input")

    monkeypatch.setattr(presets, "list_presets", ends)
    with pytest.raises(EOFError, match="ran out"):
        main(["presets"])


@pytest.mark.parametrize("variable", ["NUMBA_DISABLE_JIT=1", "NUMBA_NUM_THREADS=0"])
def test_an_environment_without_a_compiler_is_one_line(case, variable, tmp_path):
    name, _, value = variable.partition("=")
    for command in (["check", str(case)], ["run", str(case), "--out", str(tmp_path / "out")]):
        done = subprocess.run(
            [sys.executable, "-m", "railquake", *command],
            capture_output=True,
            text=True,
            env={**os.environ, name: value, "RAILQUAKE_CACHE_DIR": str(tmp_path / "cache")},
        )
        assert done.returncode == 2
        assert done.stderr.count("\n") == 1
        assert done.stderr.startswith(f"railquake: {name} is ")
    assert not (tmp_path / "out").exists()


def test_help_is_quick():
    """What takes long to import is imported by the command that needs it."""
    code = (
        "import sys; from railquake.cli import main; main(['--help']);"
        "print(sorted({'numba', 'scipy', 'matplotlib', 'xarray', 'pydantic', 'pint', 'numpy'}"
        " & set(sys.modules)), file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stderr.strip() == "[]"


def test_examples_are_good_cases(capsys):
    example = Path(__file__).resolve().parents[2] / "examples" / "case.toml"
    assert main(["check", str(example)]) == 0
