"""Commands for one run: run, presets, check, modes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railquake.cli.application import app
from railquake.cli.shared import (
    Case,
    Changes,
    Json,
    Out,
    echo,
    print_facts,
    print_json,
    progress_bar,
    write_file,
)
from railquake.errors import InputError
from railquake.measures import Measure, named
from railquake.messages import did_you_mean

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario
    from railquake.run.response import Response


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

    run_scenario(load_scenario(case, changes or ()), out, as_json)


def run_scenario(scenario: Scenario, out: Path, as_json: bool) -> None:
    """Run a scenario, write its folder and print what matters."""
    from railquake.files import prepare_folder
    from railquake.report.run_folder import write_run

    prepare_folder(out)
    row = write_run(_simulate(scenario), out)
    if as_json:
        print_json(row)
        return
    _print_row(row)
    echo(f"numbers and pictures     {out.resolve()}")


def _simulate(scenario: Scenario) -> Response:
    from railquake.run.simulate import simulate

    with progress_bar() as (progress, notify):
        return simulate(scenario, progress=progress, notify=notify)


def _print_row(row: dict[str, Any]) -> None:
    """The few numbers that matter."""
    how = f" ({row['derailment_mode']})" if row["derailed"] else ""
    if row["status"] in ("diverged", "not converged"):
        how = ": DO NOT USE THESE NUMBERS; take a smaller solver.dt"
    echo(f"status                   {row['status']}{how}")
    for key, remark in (
        ("pga_m_s2", ""),
        ("pbd_m", ""),
        ("pbv_m_s", ""),
        ("pba_m_s2", ""),
        ("hinge_rotation_peak_rad", ""),
        ("uplift_ratio", "(1: onset of slide-off)"),
        ("lateral_force_filtered_peak_n", ""),
        ("off_rail_time_s", ""),
        ("energy_residual", "of what is dissipated"),
    ):
        echo(_line(named(key), row[key], remark))
    if row["warnings"] is not None:
        echo("\n".join(f"{'warning':24} {text}" for text in row["warnings"].split("; ")))
    rate = 1e-6 * row["steps_per_s"]
    echo(f"{'steps':24} {row['steps']} at {rate:.2f} million a second")


def _line(measure: Measure, value: float | None, remark: str) -> str:
    """A measure in the unit in which people read it; what its caption adds follows that."""
    name, comma, more = measure.caption.partition(",")
    unit = "" if measure.unit == "1" else measure.shown_unit or measure.unit
    said = "-" if value is None else f"{measure.factor * value:.4g} {unit}{comma}{more}{remark}"
    return f"{name:24} {said}"


@app.command()
def presets(
    name: Annotated[str | None, typer.Argument(help="Preset to print.")] = None,
    as_json: Json = False,
) -> None:
    """List the built-in parameter sets, or print one.

    Each is printed as its TOML file, with its source and how far it can be trusted.

    Example: railquake presets bart-berkeley
    """
    from railquake.inputs.presets import list_presets

    known = list_presets()
    if name is None:
        if as_json:
            print_json(
                [
                    {"kind": p.kind, "name": p.name, "summary": p.summary, "source": p.source}
                    for p in known
                ]
            )
            return
        for preset in known:
            echo(f"{preset.kind:10} {preset.name:26} {preset.summary}")
        return
    found = [preset for preset in known if preset.name == name]
    if not found:
        names = sorted({preset.name for preset in known})
        raise InputError(f'no preset is called "{name}"; {did_you_mean(name, names)}')
    if as_json:
        facts = ("kind", "name", "summary", "source", "note")
        print_json(
            [{**{k: getattr(p, k) for k in facts}, "toml": _preset_text(p.path)} for p in found]
        )
        return
    for preset in found:
        echo(f'# [{preset.kind}] preset = "{preset.name}"\n{_preset_text(preset.path)}')


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
    warnings = [*system.ground.doubts(), *system.ground.baseline_check()]
    warnings += scenario.wheelrail.doubts()
    vertical = scenario.vertical_motion()
    if vertical is not None:
        found = (*vertical.doubts(), *vertical.baseline_check())
        warnings += [f"vertical: {text}" for text in found]
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
        print_json(facts)
        return
    print_facts({key: value for key, value in facts.items() if key != "ok"})
    echo("the case can be run")


@app.command()
def modes(
    vehicle: Annotated[str, typer.Argument(help="Vehicle preset or file.")],
    as_json: Json = False,
    out: Annotated[
        Path | None, typer.Option("--out", "--picture", help="Picture (PNG) of the shapes.")
    ] = None,
) -> None:
    """Natural modes of a vehicle with its wheelset fixed.

    Frequencies, names and shapes; for bart they are the paper's Table 1 and Figure 6.  Of a car
    with finite rotations with gravity's moments, and without them beside.

    Example: railquake modes bart --out modes.png
    """
    from railquake.assembly import vehicle_matrices
    from railquake.inputs.vehicle import Vehicle
    from railquake.physics.vehicle import fixed_wheelset_modes
    from railquake.probe import mode_labels

    car = Vehicle.from_preset(vehicle)
    matrices = vehicle_matrices(car)
    frequencies, _ = fixed_wheelset_modes(matrices.mass, matrices.stiffness)
    without, _ = fixed_wheelset_modes(matrices.mass, matrices.without_gravity)
    labels = mode_labels(car, matrices)
    if out is not None:
        from railquake.plots import write_modes_picture

        write_file(out, lambda path: write_modes_picture(car, labels, path))
    if as_json:
        print_json(
            {
                "frequencies_hz": frequencies.tolist(),
                "labels": labels,
                "without_gravity_hz": without.tolist(),
            }
        )
        return
    for k, (frequency, label) in enumerate(zip(frequencies, labels, strict=True), 1):
        light = f"  ({without[k - 1]:.4f} Hz without gravity)" if matrices.is_finite else ""
        falls = "  unstable: it falls over by its own weight" if frequency < 0.0 else ""
        echo(f"{k:2}  {frequency:8.4f} Hz  {label}{light}{falls}")
