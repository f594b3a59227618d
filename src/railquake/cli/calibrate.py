"""Commands that calibrate the hinge: to a fibre model of the column, or to a measured loop."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from railquake.cli.application import app
from railquake.cli.shared import Json, Out, echo, print_json, progress_bar

if TYPE_CHECKING:
    from railquake.calibration.calibrate import Calibration

calibrate_app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Fit the hinge to a fibre model of the column, or to a measured loop.",
)
app.add_typer(calibrate_app, name="calibrate")

Starts = Annotated[
    int, typer.Option(min=1, max=100, help="Searches: one from a guess, others seeded.")
]


@calibrate_app.command("column")
def calibrate_column(
    column: Annotated[
        Path,
        typer.Argument(
            metavar="COLUMN.toml", help="Column, protocol, motions.", show_default=False
        ),
    ],
    out: Out = Path("calibration-out"),
    starts: Starts = 6,
    check: Annotated[
        bool, typer.Option("--check/--no-check", help="Shake both models by the file's motions.")
    ] = True,
    as_json: Json = False,
) -> None:
    """Fit the hinge to a fibre model of a reinforced-concrete column in OpenSees.

    Builds the column of fibres, pushes it through a cyclic protocol, fits the Bouc-Wen hinge to
    its loop, and shakes both by motions that the fit has not seen.  The folder gets hinge.toml
    (a preset: support.preset = "hinge.toml"), fit.json and pictures.  Needs railquake[fem].

    Example: railquake calibrate column examples/column.toml --out fit
    """
    from railquake import calibration
    from railquake.files import prepare_folder

    described = calibration.load_column(column)
    prepare_folder(out)
    with progress_bar() as (progress, notify):
        found = calibration.calibrate_column(
            described, starts=starts, check=check, progress=progress, notify=notify
        )
    _finish(found, out, as_json)


@calibrate_app.command("hinge")
def calibrate_hinge(
    cyclic: Annotated[
        Path,
        typer.Option(
            help="CSV of a cyclic test; its first line names columns and units: "
            "displacement_mm,force_kN or rotation_rad,moment_kN_m."
        ),
    ],
    kind: Annotated[
        str, typer.Option(help="force-displacement or moment-rotation.")
    ] = "force-displacement",
    length: Annotated[
        str | None, typer.Option(help='From the base to the load, such as "2.4 m".')
    ] = None,
    support: Annotated[
        str, typer.Option(help="Pier whose column, mass and damping are kept: preset or file.")
    ] = "bart-berkeley",
    young: Annotated[
        str | None, typer.Option(help='Of the elastic column, such as "30 GPa".')
    ] = None,
    inertia: Annotated[
        str | None, typer.Option(help='Second moment of its area, such as "0.02 m4".')
    ] = None,
    rotation_unit: Annotated[
        str | None, typer.Option(help="Unit of displacement or rotation, where the file is silent.")
    ] = None,
    moment_unit: Annotated[
        str | None, typer.Option(help="Unit of force or moment, where the file is silent.")
    ] = None,
    source: Annotated[str, typer.Option(help="Where the loop comes from, for the preset.")] = "",
    out: Out = Path("calibration-out"),
    starts: Starts = 6,
    as_json: Json = False,
) -> None:
    """Fit the hinge to a measured loop.

    Of a loop of force and displacement, the elastic column's share is taken out: --young and
    --inertia, or those of the support, at the specimen's length.  A loop of moment and rotation
    is the hinge's own.  The folder gets hinge.toml (a preset), fit.json and pictures.

    Example: railquake calibrate hinge --cyclic test.csv --length "6.0 m" --out fit
    """
    from railquake import calibration
    from railquake.files import prepare_folder
    from railquake.inputs.support import Pier

    over = _elastic_column(length, young, inertia)
    pier = Pier.from_preset(support, over)
    loop = calibration.read_loop(
        cyclic,
        kind,  # type: ignore[arg-type]
        length=over.get("length"),
        flexibility=calibration.column_flexibility(
            pier.youngs_modulus, pier.second_moment_of_area, pier.length
        ),
        rotation_unit=rotation_unit,
        moment_unit=moment_unit,
    )
    prepare_folder(out)
    with progress_bar() as (progress, notify):
        found = calibration.calibrate_hinge(
            loop, pier, source=source, starts=starts, progress=progress, notify=notify
        )
    _finish(found, out, as_json)


def _elastic_column(length: str | None, young: str | None, inertia: str | None) -> dict[str, float]:
    """What the options say of the column in the place of the support's."""
    from railquake.inputs.units import to_si

    return {
        key: to_si(_number(value), dimension, option, sign="positive")
        for key, value, dimension, option in (
            ("length", length, "length", "--length"),
            ("youngs_modulus", young, "pressure", "--young"),
            ("second_moment_of_area", inertia, "second moment of area", "--inertia"),
        )
        if value is not None
    }


def _number(text: str) -> str | float:
    """A bare number is SI, as in a case file."""
    try:
        return float(text)
    except ValueError:
        return text


def _finish(found: Calibration, out: Path, as_json: bool) -> None:
    from railquake.calibration.report import summary_lines, write_calibration

    row = write_calibration(found, out)
    if as_json:
        print_json(row)
        return
    for line in summary_lines(found):
        echo(line)
    echo(f"\npreset, numbers and pictures  {out.resolve()}")
