"""One component of the model by itself: hinge, car, motion, contact, creep."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

import typer

from railquake.cli.application import probe_app
from railquake.cli.shared import (
    Json,
    Picture,
    echo,
    print_facts,
    print_json,
    read_column,
    write_file,
    write_text,
)
from railquake.errors import InputError
from railquake.messages import csv_cell


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

    from railquake.inputs.model import validated
    from railquake.inputs.presets import resolved_section
    from railquake.inputs.support import Pier
    from railquake.inputs.toml import split_override
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
        x = read_column(path, "x")
    rows = run_hinge(pier.bouc_wen, x, elastic=hinge == "elastic")
    if picture is not None:
        from railquake.plots import write_hinge_picture

        write_file(picture, lambda at: write_hinge_picture(x, rows[:, 0], at))
    if as_json:
        print_json(
            {"x": x.tolist(), "moment": rows[:, 0].tolist(), "z": rows[:, 1].tolist(),
             "damage": rows[:, 2].tolist()}
        )  # fmt: skip
        return
    lines = ["x,moment,z,damage"]
    lines += [",".join(repr(float(v)) for v in (a, *row)) for a, row in zip(x, rows, strict=True)]
    if out is None:
        echo("\n".join(lines))
    else:
        write_text(out, "\n".join(lines) + "\n")
        echo(f"{len(x)} rows: {out}")


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

    PGA, PGV, intensities, duration, and a check of the baseline.  Where a file holds several
    channels, the message lists them.

    Example: railquake probe motion RSN181.AT2 --picture motion.png
    """
    from railquake.inputs.ground_motion import jma_intensity, read_motion, spectral_intensity

    chosen = int(channel) if channel is not None and channel.isdigit() else channel
    motion = read_motion(file, channel=chosen, units=units, dt=dt, allow_high_pga=allow_high_pga)
    motion = motion.scaled(abs(scale))
    if scale < 0.0:
        motion = motion.mirrored()
    warnings = [*motion.doubts(), *motion.baseline_check()]
    if picture is not None:
        from railquake.plots import write_motion_picture

        write_file(picture, lambda path: write_motion_picture(motion, path))
    facts = {
        "name": motion.name,
        "dt_s": motion.dt,
        "npts": motion.npts,
        "duration_s": motion.duration,
        "pga_m_s2": motion.pga,
        "pgv_m_s": motion.pgv,
        "arias_intensity_m_s": motion.arias_intensity,
        "si_m_s": spectral_intensity(motion),
        "jma_intensity": jma_intensity(motion),
        "significant_duration_s": motion.significant_duration(),
        "notes": list(motion.notes),
        "warnings": warnings,
    }
    if as_json:
        print_json(facts)
        return
    print_facts(facts)


@probe_app.command("car")
def probe_car(
    vehicle: Annotated[str, typer.Option(help="Vehicle preset or file.")] = "bart-under-gravity",
    lean: Annotated[
        float | None, typer.Option(help="Steady lateral inertia force per mass, m/s2.")
    ] = None,
    motion: Annotated[
        Path | None, typer.Option(help="Record of the ground's lateral acceleration.")
    ] = None,
    scale: Annotated[float, typer.Option(help="Factor of the record.")] = 1.0,
    allow_high_pga: Annotated[bool, typer.Option(help="Take a peak above 3 g as it is.")] = False,
    out: Annotated[Path | None, typer.Option(help="CSV of the history to write.")] = None,
    as_json: Json = False,
) -> None:
    """Try a car by itself, its wheelset held.

    With --lean: where its bodies stand under a steady force, and its flexibility coefficient, roll
    over a/g.  With --motion: the history of its bodies, columns t_s, then y, z (m) and roll (rad)
    of each body from where it stands at rest, y to the right, z down, roll right side down.

    Example: railquake probe car --vehicle manchester --lean 2.0
    """
    from railquake.inputs.vehicle import Vehicle

    if (lean is None) == (motion is None):
        raise InputError("give either --lean, m/s2, or --motion, a record of the ground")
    car = Vehicle.from_preset(vehicle)
    if lean is not None:
        _lean_car(car, lean, as_json)
        return
    assert motion is not None
    _shake_car(car, motion, scale, allow_high_pga, out, as_json)


def _lean_car(car: Any, acceleration: float, as_json: bool) -> None:
    """Print where a car stands under a steady force."""
    from math import isfinite

    from railquake.probe import lean

    if not isfinite(acceleration):
        raise InputError(f"--lean: must be a finite number of m/s2, found {acceleration:g}")
    found = lean(car, acceleration)
    facts: dict[str, Any] = {"a_m_s2": acceleration}
    facts.update(zip(_columns(found.bodies), found.displacements.ravel().tolist(), strict=True))
    coefficient = found.flexibility_coefficient
    facts["flexibility_coefficient"] = coefficient if isfinite(coefficient) else None
    if as_json:
        print_json(facts)
        return
    print_facts(facts)


def _shake_car(
    car: Any, record: Path, scale: float, high: bool, out: Path | None, as_json: bool
) -> None:
    """Write how a car answers a motion of the ground."""
    import numpy as np

    from railquake.inputs.ground_motion import read_motion
    from railquake.inputs.motion import scaled_motion
    from railquake.probe import shake_held

    ground = scaled_motion(read_motion(record, allow_high_pga=high), scale, high)
    lateral = ground.acceleration
    found = shake_held(car, ground.time, lateral, np.zeros(len(lateral)))
    moved = found.displacements.reshape(len(found.times), -1)
    columns = _columns(found.bodies)
    if out is not None or not as_json:
        lines = [",".join(("t_s", *columns))]
        lines += [
            f"{t:.3f}," + ",".join(f"{value:.9g}" for value in row)
            for t, row in zip(found.times, moved, strict=True)
        ]
        if out is None:
            echo("\n".join(lines))
        else:
            write_text(out, "\n".join(lines) + "\n")
    if as_json:
        peaks = dict(zip(columns, np.abs(moved).max(axis=0).tolist(), strict=True))
        print_json({"peaks": peaks, "energy_residual": found.energy_residual})


def _columns(bodies: tuple[str, ...]) -> list[str]:
    """Columns of the displacements of bodies."""
    return [csv_cell(f"{body}_{what}") for body in bodies for what in ("y_m", "z_m", "roll_rad")]


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
    for doubt in pair.doubts():
        echo(f"railquake: warning: {doubt}", err=True)
    if picture is not None:
        from railquake.plots.contact import write_contact_picture

        write_file(picture, lambda path: write_contact_picture(pair, standing, path))
    if as_json:
        print_json([vars(patch) for patch in standing.patches])
        return
    echo("side     y, mm      z, mm   angle, rad  approach, mm  normal, kN   a, mm   b, mm")
    for p in standing.patches:
        echo(
            f"{p.side:5} {1e3 * p.y_m:9.3f} {1e3 * p.z_m:10.4f} {p.angle_rad:11.5f} "
            f"{1e3 * p.approach_m:13.5f} {1e-3 * p.normal_n:11.3f} {1e3 * p.a_m:7.3f} "
            f"{1e3 * p.b_m:7.3f}"
        )


def _two_lengths(semi_axes: str) -> tuple[float, float]:
    """Semi-axes as the command line has them, m."""
    try:
        a, b = (float(part) for part in semi_axes.split(","))
    except ValueError:
        raise InputError(
            f'--semi-axes: two numbers in m are needed, such as 6e-3,5e-3; found "{semi_axes}"'
        ) from None
    return a, b


@probe_app.command("creep")
def probe_creep(
    semi_axes: Annotated[str, typer.Option(help="a,b in m; a along the rolling direction.")],
    load: Annotated[float, typer.Option(help="Normal force, N.")],
    creepage: Annotated[float, typer.Option(help="Lateral, wheel relative to rail.")] = 0.0,
    longitudinal: Annotated[float, typer.Option(help="Longitudinal creepage, likewise.")] = 0.0,
    spin: Annotated[float, typer.Option(help="1/m.")] = 0.0,
    mu: Annotated[float, typer.Option(help="Coefficient of friction.")] = 0.3,
    shear_modulus: Annotated[float, typer.Option(help="Pa.")] = 82e9,
    poisson: Annotated[float, typer.Option(help="Poisson's ratio.")] = 0.28,
    law: Annotated[str, typer.Option(help="coulomb, she, carter, polach or fastsim.")] = "she",
    picture: Annotated[
        Path | None,
        typer.Option("--picture", "--curve", help="Picture (PNG): force against creepage."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Creep force on the wheel; it opposes the creepage.

    Example: railquake probe creep --semi-axes 6e-3,5e-3 --load 50e3 --creepage 1e-3
    """
    import math

    from railquake.laws import CREEP_LAWS
    from railquake.probe import creep_force

    a, b = _two_lengths(semi_axes)
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
    creepages = (longitudinal, creepage, spin)
    if not all(map(math.isfinite, creepages)):
        raise InputError("--longitudinal, --creepage and --spin must be finite numbers")
    found = creep_force((a, b), load, creepages, mu, shear_modulus, poisson, law)
    if picture is not None:
        from railquake.plots import write_creep_picture

        write_file(
            picture,
            lambda path: write_creep_picture(
                found.f22, mu * load, path, log_ratio=math.log(a / b), poisson=poisson
            ),
        )
    if as_json:
        print_json(
            {
                "lateral_force_n": found.lateral,
                "longitudinal_force_n": found.longitudinal,
                "limit_n": mu * load,
                "f22_n": found.f22,
                "law": law,
            }
        )
        return
    for name, force in (("lateral", found.lateral), ("longitudinal", found.longitudinal)):
        if name == "lateral" or longitudinal != 0.0:
            share = abs(force) / (mu * load)
            echo(f"{name} force {force:.6g} N, {share:.4f} of friction's limit")
