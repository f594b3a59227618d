"""The command ``railquake``: thin, every command calls what a Python user would call."""

from __future__ import annotations

import gc
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer

from railquake import __version__
from railquake.errors import InputError

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario
    from railquake.response import Response

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # plain help is quicker, and its paragraphs are filled
    help="How safely a train runs over a bridge in an earthquake.",
)
probe_app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="One component of the model by itself.",
)
app.add_typer(probe_app, name="probe")

# The built-in run: a synthetic motion, so that no file is needed.
DEMO = {"seed": 18, "duration": "20 s", "pga": "1.0 g", "ground_frequency": "1.8 Hz"}

# Base of all errors in the use of a command, from the click that typer itself uses.
USAGE_ERROR: type[Exception] = next(
    kind for kind in typer.BadParameter.__mro__ if kind.__name__ == "ClickException"
)

STOPPED = 130  # exit status after Ctrl-C

Case = Annotated[Path, typer.Argument(metavar="CASE.toml", help="Case file.", show_default=False)]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change a value, with its unit: --set motion.scale=1.5 --set vehicle.speed='80 km/h'; "
        "files start from the case file's folder.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, for programs.")]
Out = Annotated[Path, typer.Option("--out", help="Folder for the results.")]


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"railquake {__version__}")
        raise typer.Exit


@app.callback(
    epilog="Exit status: 0 when the command did its work (a derailment is a result), 2 after a "
    "wrong input, 130 when stopped."
)
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """How safely a train runs over a bridge in an earthquake."""


@app.command()
def demo(out: Out = Path("demo-out"), as_json: Json = False) -> None:
    """Run a built-in case: car, pier and synthetic earthquake.

    A BART car at 80 km/h on a Berkeley pier; needs no file.  Wheels touch with their flanges and
    lift off; see the pictures.

    Example: railquake demo --out demo-out
    """
    from railquake.inputs.scenario import scenario

    _run(scenario(synthetic=DEMO), out, as_json)


@app.command()
def run(case: Case, out: Out, changes: Changes = None, as_json: Json = False) -> None:
    """Run a case; write its numbers, histories and pictures.

    The folder gets summary.json, history.nc, events.csv, case.toml and pictures.  Files of a
    former run in it are replaced, other files left alone.  All are written under a temporary
    name and moved when the run is complete.  A derailment, and a run that diverged, is a
    result and not an error: the status says so.

    Example: railquake run case.toml --out result --set motion.scale=1.5
    """
    from railquake.inputs.scenario import load_scenario

    _run(load_scenario(case, changes or ()), out, as_json)


def _run(scenario: Scenario, out: Path, as_json: bool) -> None:
    from railquake.output import prepare_folder, write_run

    prepare_folder(out)
    row = write_run(_simulate(scenario), out)
    if as_json:
        _print_json(row)
        return
    _print_row(row)
    typer.echo(f"numbers and pictures     {out.resolve()}")


def _simulate(scenario: Scenario) -> Response:
    from railquake.simulation import simulate

    with _progress() as (progress, notify):
        return simulate(scenario, progress=progress, notify=notify)


@contextmanager
def _progress() -> Iterator[tuple[Callable[[int, int], None] | None, Callable[[str], None]]]:
    """A progress bar on a terminal's standard error, and a way to say something there."""

    def say(text: str) -> None:
        typer.echo(f"railquake: {text}", err=True)

    if not sys.stderr.isatty():
        yield None, say
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    with Progress(
        TextColumn("{task.percentage:3.0f} %"),
        BarColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
    ) as bar:
        task = bar.add_task("run", total=None)
        yield (
            lambda done, total: bar.update(task, completed=done, total=total),
            lambda text: bar.console.print(f"railquake: {text}"),
        )


def _print_row(row: dict[str, Any]) -> None:
    """The few numbers that matter."""
    how = f" ({row['derailment_mode']})" if row["derailed"] else ""
    if row["status"] in ("diverged", "not converged"):
        how = ": DO NOT USE THESE NUMBERS; take a smaller solver.dt"
    typer.echo(f"status                   {row['status']}{how}")
    for name, key, factor, unit in (
        ("peak ground acceleration", "pga_m_s2", 1.0 / 9.80665, "g"),
        ("peak bridge displacement", "pbd_m", 1e3, "mm"),
        ("peak bridge velocity", "pbv_m_s", 1.0, "m/s"),
        ("peak bridge acceleration", "pba_m_s2", 1.0, "m/s2"),
        ("peak hinge rotation", "hinge_rotation_peak_rad", 1e3, "mrad"),
        ("normalised uplift", "uplift_ratio", 1.0, "(1: onset of slide-off)"),
        ("peak lateral force", "lateral_force_filtered_peak_n", 1e-3, "kN, impacts filtered"),
        ("time off the rail", "off_rail_time_s", 1.0, "s"),
        ("energy residual", "energy_residual", 1.0, "of what is dissipated"),
    ):
        value = row[key]
        typer.echo(f"{name:24} {'-' if value is None else f'{factor * value:.4g} {unit}'}")
    rate = 1e-6 * row["steps_per_s"]
    typer.echo(f"{'steps':24} {row['steps']} at {rate:.2f} million a second")


@app.command()
def presets(
    name: Annotated[str | None, typer.Argument(help="Preset to print.")] = None,
    as_json: Json = False,
) -> None:
    """List the built-in parameter sets, or print one.

    Each is printed as its TOML file, with its source and how far it can be trusted.

    Example: railquake presets bart-berkeley
    """
    from railquake.inputs._model import did_you_mean
    from railquake.inputs.presets import list_presets

    known = list_presets()
    if name is None:
        if as_json:
            _print_json(
                [
                    {"kind": p.kind, "name": p.name, "summary": p.summary, "source": p.source}
                    for p in known
                ]
            )
            return
        for preset in known:
            typer.echo(f"{preset.kind:10} {preset.name:26} {preset.summary}")
        return
    found = [preset for preset in known if preset.name == name]
    if not found:
        names = sorted({preset.name for preset in known})
        raise InputError(f'no preset is called "{name}"; {did_you_mean(name, names)}')
    if as_json:
        facts = ("kind", "name", "summary", "source", "note")
        _print_json(
            [{**{k: getattr(p, k) for k in facts}, "toml": _preset_text(p.path)} for p in found]
        )
        return
    for preset in found:
        typer.echo(f'# [{preset.kind}] preset = "{preset.name}"\n{_preset_text(preset.path)}')


def _preset_text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


@app.command()
def check(case: Case, changes: Changes = None, as_json: Json = False) -> None:
    """Check a case and all its files without running it.

    Example: railquake check case.toml
    """
    from railquake.assembly import assemble
    from railquake.inputs.scenario import load_scenario

    scenario = load_scenario(case, changes or ())
    system = assemble(scenario)
    warnings = list(system.ground.baseline_check())
    vertical = scenario.vertical_motion()
    if vertical is not None:
        warnings += [f"vertical: {text}" for text in vertical.baseline_check()]
    support = scenario.support
    facts = {
        "ok": True,
        "vehicle": scenario.vehicle.name,
        "speed_m_s": scenario.vehicle.speed,
        "support": getattr(support, "name", None),
        "kind": support.kind,
        "hinge": getattr(support, "hinge", None),
        "coupled": getattr(support, "coupled", None),
        "wheelrail": scenario.wheelrail.name,
        "contact": scenario.solver.contact,
        "motion": system.ground.name,
        "pga_m_s2": system.ground.pga,
        "pgv_m_s": system.ground.pgv,
        "duration_s": system.ground.duration,
        "dt_s": system.dt,
        "dt_critical_s": system.critical_dt,
        "steps": system.frames * system.frame_steps,
        "content_hash": scenario.content_hash(),
        "warnings": warnings,
    }
    if as_json:
        _print_json(facts)
        return
    _print_facts({key: value for key, value in facts.items() if key != "ok"})
    typer.echo("the case can be run")


def _print_facts(facts: dict[str, Any]) -> None:
    """A line for each; lists, such as warnings, a line for each item."""
    for key, value in facts.items():
        if isinstance(value, list):
            for text in value:
                typer.echo(f"{key.removesuffix('s')}: {text}")
        elif value is not None:
            shown = f"{value:.6g}" if isinstance(value, float) else value
            typer.echo(f"{key:22} {shown}")


@app.command()
def modes(
    vehicle: Annotated[str, typer.Argument(help="Vehicle preset or file.")],
    as_json: Json = False,
    out: Annotated[
        Path | None, typer.Option("--out", "--picture", help="Picture (PNG) of the shapes.")
    ] = None,
) -> None:
    """Natural modes of a vehicle with its wheelset fixed.

    Frequencies, names and shapes; for bart they are the paper's Table 1 and Figure 6.

    Example: railquake modes bart --out modes.png
    """
    from railquake.assembly import vehicle_matrices
    from railquake.inputs.vehicle import Vehicle
    from railquake.physics.vehicle import fixed_wheelset_modes
    from railquake.probe import mode_labels

    car = Vehicle.from_preset(vehicle)
    matrices = vehicle_matrices(car)
    frequencies, _ = fixed_wheelset_modes(matrices.mass, matrices.stiffness)
    labels = mode_labels(car, matrices)
    if out is not None:
        from railquake.plots import write_modes_picture

        _picture(out, lambda path: write_modes_picture(car, labels, path))
    if as_json:
        _print_json({"frequencies_hz": frequencies.tolist(), "labels": labels})
        return
    for k, (frequency, label) in enumerate(zip(frequencies, labels, strict=True), 1):
        typer.echo(f"{k:2}  {frequency:8.4f} Hz  {label}")


@app.command()
def bench(as_json: Json = False) -> None:
    """Measure how fast it is on this machine, beside OpenSees where that is installed.

    Example: railquake bench --json
    """
    from railquake.bench import print_bench, run_bench

    row = run_bench()
    if as_json:
        _print_json(row)
    else:
        print_bench(row)


Picture = Annotated[Path | None, typer.Option("--picture", help="Picture (PNG) to write.")]


@probe_app.command("hinge")
def probe_hinge(
    preset: Annotated[str, typer.Option(help="Support preset or file.")] = "bart-berkeley",
    path: Annotated[
        Path | None, typer.Option(help="CSV with a column x of rotations, rad.")
    ] = None,
    out: Annotated[Path | None, typer.Option(help="CSV to write.")] = None,
    changes: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="KEY=VALUE", help="Change a parameter: --set n=1.2"),
    ] = None,
    hinge: Annotated[str, typer.Option(help="bouc-wen or elastic.")] = "bouc-wen",
    picture: Picture = None,
    as_json: Json = False,
) -> None:
    """Drive the hinge along a path of rotations.

    Without --path, cycles of growing amplitude.  Writes the columns x, moment, z, damage (rad, N
    m, rad, 1), to standard output without --out.

    Example: railquake probe hinge --path x.csv --out m.csv --set n=1.2
    """
    import numpy as np

    from railquake.inputs._model import validated
    from railquake.inputs._toml import split_override
    from railquake.inputs.presets import resolved_section
    from railquake.inputs.support import Pier
    from railquake.probe import run_hinge

    if hinge not in ("bouc-wen", "elastic"):
        raise InputError(f'--hinge: must be bouc-wen or elastic, found "{hinge}"')
    table: dict[str, Any] = {}
    for text in changes or ():
        key, value = split_override(text)
        table[key.removeprefix("bouc_wen.")] = value
    section = resolved_section("support", {"preset": preset, "bouc_wen": table})
    if section.get("kind", "pier") != "pier":
        raise InputError(f'--preset: "{preset}" is no pier, so it has no hinge')
    pier = validated(Pier, section, "support")
    if path is None:
        largest = pier.bouc_wen.xu
        turns = [0.0]
        for amplitude in (0.1, 0.2, 0.5, 1.0):
            turns += [amplitude * largest, -amplitude * largest]
        turns.append(0.0)
        x = np.concatenate([np.linspace(a, b, 200)[1:] for a, b in pairwise(turns)])
    else:
        x = _read_column(path, "x")
    rows = run_hinge(pier.bouc_wen, x, elastic=hinge == "elastic")
    if picture is not None:
        from railquake.plots import write_hinge_picture

        _picture(picture, lambda at: write_hinge_picture(x, rows[:, 0], at))
    if as_json:
        _print_json(
            {"x": x.tolist(), "moment": rows[:, 0].tolist(), "z": rows[:, 1].tolist(),
             "damage": rows[:, 2].tolist()}
        )  # fmt: skip
        return
    lines = ["x,moment,z,damage"]
    lines += [",".join(repr(float(v)) for v in (a, *row)) for a, row in zip(x, rows, strict=True)]
    if out is None:
        typer.echo("\n".join(lines))
    else:
        _write_text(out, "\n".join(lines) + "\n")
        typer.echo(f"{len(x)} rows: {out}")


@probe_app.command("motion")
def probe_motion(
    file: Annotated[Path, typer.Argument(help="Record.")],
    channel: Annotated[
        str | None, typer.Option(help="Channel of a file with several, by number or name.")
    ] = None,
    units: Annotated[
        str | None, typer.Option(help="Unit, such as g, where the file does not say.")
    ] = None,
    dt: Annotated[float | None, typer.Option(help="Time step, s, where it does not say.")] = None,
    scale: Annotated[float, typer.Option(help="Factor; a negative one mirrors.")] = 1.0,
    allow_high_pga: Annotated[bool, typer.Option(help="Take a peak above 3 g as it is.")] = False,
    picture: Annotated[
        Path | None,
        typer.Option("--picture", "--out", help="Picture (PNG): histories and response spectrum."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Read a record and measure it.

    PGA, PGV, Arias intensity, duration, and a check of the baseline.  Where a file holds several
    channels, the message lists them.

    Example: railquake probe motion RSN181.AT2 --picture motion.png
    """
    from railquake.inputs.motion import read_motion

    chosen = int(channel) if channel is not None and channel.isdigit() else channel
    motion = read_motion(file, channel=chosen, units=units, dt=dt, allow_high_pga=allow_high_pga)
    motion = motion.scaled(abs(scale))
    if scale < 0.0:
        motion = motion.mirrored()
    warnings = list(motion.baseline_check())
    if picture is not None:
        from railquake.plots import write_motion_picture

        _picture(picture, lambda path: write_motion_picture(motion, path))
    facts = {
        "name": motion.name,
        "dt_s": motion.dt,
        "npts": motion.npts,
        "duration_s": motion.duration,
        "pga_m_s2": motion.pga,
        "pgv_m_s": motion.pgv,
        "arias_intensity_m_s": motion.arias_intensity,
        "significant_duration_s": motion.significant_duration(),
        "notes": list(motion.notes),
        "warnings": warnings,
    }
    if as_json:
        _print_json(facts)
        return
    _print_facts(facts)


@probe_app.command("contact")
def probe_contact(
    shift: Annotated[float, typer.Option(help="Lateral shift, m, positive right.")] = 0.0,
    load: Annotated[float, typer.Option(help="Vertical load per wheel, N.")] = 50e3,
    preset: Annotated[str, typer.Option(help="Wheel-rail preset or file.")] = "bart",
    wheel: Annotated[Path | None, typer.Option(help="Wheel profile file.")] = None,
    rail: Annotated[Path | None, typer.Option(help="Rail profile file.")] = None,
    gauge: Annotated[float | None, typer.Option(help="Gauge, m.")] = None,
    young: Annotated[float | None, typer.Option(help="Young's modulus, Pa.")] = None,
    poisson: Annotated[float | None, typer.Option(help="Poisson's ratio.")] = None,
    picture: Picture = None,
    as_json: Json = False,
) -> None:
    """Contact of one wheelset that stands still.

    A row for each touching patch: y to the right and z down from the midpoint of the rail crowns;
    the angle of the contact plane from the plane of the track, positive where it falls towards
    the middle of the track as on a flange; semi-axes a along the rolling direction, b across.

    Example: railquake probe contact --preset s1002-60e1 --shift 0.005
    """
    from railquake.inputs.wheelrail import WheelRail
    from railquake.probe import standing_wheelset

    if not load > 0.0 or load == float("inf"):
        raise InputError(f"--load: must be positive and finite, found {load:g}")
    if not abs(shift) < 1.0:
        raise InputError(f"--shift: must be within a metre, found {shift:g}; the unit is m")
    overrides: dict[str, Any] = {
        key: value
        for key, value in (
            ("gauge", gauge),
            ("youngs_modulus", young),
            ("poisson_ratio", poisson),
            ("wheel", None if wheel is None else {"file": str(wheel.absolute())}),
            ("rail", None if rail is None else {"file": str(rail.absolute())}),
        )
        if value is not None
    }
    pair = WheelRail.from_preset(preset, overrides)
    standing = standing_wheelset(pair, shift, load)
    if picture is not None:
        from railquake.plots.contact import write_contact_picture

        _picture(picture, lambda path: write_contact_picture(pair, standing, path))
    if as_json:
        _print_json([vars(patch) for patch in standing.patches])
        return
    typer.echo("side     y, mm      z, mm   angle, rad  approach, mm  normal, kN   a, mm   b, mm")
    for p in standing.patches:
        typer.echo(
            f"{p.side:5} {1e3 * p.y_m:9.3f} {1e3 * p.z_m:10.4f} {p.angle_rad:11.5f} "
            f"{1e3 * p.approach_m:13.5f} {1e-3 * p.normal_n:11.3f} {1e3 * p.a_m:7.3f} "
            f"{1e3 * p.b_m:7.3f}"
        )


@probe_app.command("creep")
def probe_creep(
    semi_axes: Annotated[str, typer.Option(help="a,b in m; a along the rolling direction.")],
    load: Annotated[float, typer.Option(help="Normal force, N.")],
    creepage: Annotated[float, typer.Option(help="Lateral, wheel relative to rail.")] = 0.0,
    spin: Annotated[float, typer.Option(help="1/m.")] = 0.0,
    mu: Annotated[float, typer.Option(help="Coefficient of friction.")] = 0.3,
    shear_modulus: Annotated[float, typer.Option(help="Pa.")] = 82e9,
    poisson: Annotated[float, typer.Option(help="Poisson's ratio.")] = 0.28,
    law: Annotated[str, typer.Option(help="coulomb, she, carter or polach.")] = "she",
    picture: Annotated[
        Path | None,
        typer.Option("--picture", "--curve", help="Picture (PNG): force against creepage."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Lateral creep force on the wheel; it opposes the creepage.

    Example: railquake probe creep --semi-axes 6e-3,5e-3 --load 50e3 --creepage 1e-3
    """
    import math

    from railquake.assembly.system import CREEP_LAWS
    from railquake.probe import creep_force

    try:
        a, b = (float(part) for part in semi_axes.split(","))
    except ValueError:
        raise InputError(
            f'--semi-axes: two numbers in m are needed, such as 6e-3,5e-3; found "{semi_axes}"'
        ) from None
    if law not in CREEP_LAWS:
        raise InputError(f'--law: no law is called "{law}"; take one of {", ".join(CREEP_LAWS)}')
    for name, value in (
        ("--semi-axes", min(a, b)),
        ("--load", load),
        ("--mu", mu),
        ("--shear-modulus", shear_modulus),
    ):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name}: must be positive and finite, found {value:g}")
    if not 0.0 <= poisson < 0.5:
        raise InputError(f"--poisson: must be from 0 to below 0.5, found {poisson:g}")
    if not (math.isfinite(creepage) and math.isfinite(spin)):
        raise InputError("--creepage and --spin must be finite numbers")
    force, slope = creep_force((a, b), load, creepage, spin, mu, shear_modulus, poisson, law)
    if picture is not None:
        from railquake.plots import write_creep_picture

        _picture(picture, lambda path: write_creep_picture(slope, mu * load, path))
    if as_json:
        _print_json({"lateral_force_n": force, "limit_n": mu * load, "f22_n": slope, "law": law})
        return
    typer.echo(f"lateral force {force:.6g} N, {abs(force) / (mu * load):.4f} of friction's limit")


def _read_column(path: Path, name: str) -> Any:
    """One column of a CSV file, by name, or the first where there is no header."""
    import numpy as np

    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "is not text"
        raise InputError(f"{path}: cannot be read: {reason}") from None
    column, values = 0, []
    started = False
    for number, line in enumerate(lines, 1):
        cells = [cell.strip() for cell in line.split(",")]
        if not line.strip() or line.startswith("#"):
            continue
        if not started and not _is_number(cells[0]):
            if name not in cells:
                raise InputError(f'{path}, line {number}: no column "{name}" among {line!r}')
            column, started = cells.index(name), True
            continue
        started = True
        text = cells[column] if column < len(cells) else ""
        if not _is_number(text) or not np.isfinite(float(text)):
            raise InputError(f'{path}, line {number}: "{text}" is no finite number')
        values.append(float(text))
    if not values:
        raise InputError(f"{path}: holds no rows; write a column {name}, one value a line")
    return np.array(values)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _picture(path: Path, write: Callable[[Path], Any]) -> None:
    """Write a picture under a temporary name and move it into its place."""
    part = path.with_name(f".{path.name}.part")
    try:
        write(part)
        part.replace(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        part.unlink(missing_ok=True)


def _write_text(path: Path, text: str) -> None:
    part = path.with_name(f".{path.name}.part")
    try:
        part.write_text(text, encoding="utf-8")
        part.replace(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        part.unlink(missing_ok=True)


def _print_json(value: Any) -> None:
    from railquake.output import json_text

    typer.echo(json_text(value))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; its exit status.

    Parameters
    ----------
    arguments : sequence of str, optional
        Instead of the command line's.

    Returns
    -------
    int
        0; 2 after a wrong input, with one line on standard error; 130 after Ctrl-C or a request
        to terminate.
    """
    complaints = sys.unraisablehook

    def stop(*_: object) -> NoReturn:
        # what the compiler leaves half done, its destructors must not report
        sys.unraisablehook = lambda _: None
        raise KeyboardInterrupt

    former = {}
    with suppress(ValueError):  # not in the main thread
        for number in (signal.SIGINT, signal.SIGTERM):
            if signal.getsignal(number) != signal.SIG_IGN:  # as nohup asks for
                former[number] = signal.signal(number, stop)
    try:
        return _status(arguments)
    finally:
        sys.unraisablehook = complaints
        for number, handler in former.items():
            signal.signal(number, handler)
        if arguments is None:
            gc.freeze()  # the process ends: looking for garbage once more takes half a second


def _status(arguments: Sequence[str] | None) -> int:
    try:
        status = app(
            args=None if arguments is None else list(arguments),
            prog_name="railquake",
            standalone_mode=False,
        )
    except InputError as error:
        return _complain(str(error), 2)
    except (KeyboardInterrupt, typer.Abort):
        status = STOPPED
    except USAGE_ERROR as error:
        if type(error).__name__ == "NoArgsIsHelpError":
            typer.echo(error.ctx.get_help())  # type: ignore[attr-defined]
            return 0
        return _complain(_usage(error), 2)
    except BrokenPipeError:
        # the reader of a pipe has left: nothing more can be said, not even at the interpreter's end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    if status == STOPPED:  # typer turns Ctrl-C into this
        return _complain("stopped; nothing is half-written", STOPPED)
    return status if isinstance(status, int) else 0


def _usage(error: Any) -> str:
    """What was wrong with the command, on one line, and where its help is."""
    message = " ".join(error.format_message().split())
    context = getattr(error, "ctx", None)
    if context is None:
        return message
    return f"{message.removesuffix('.')} (see {context.command_path} --help)"


def _complain(message: str, status: int) -> int:
    print(f"railquake: {message}", file=sys.stderr)
    return status
