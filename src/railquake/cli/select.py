"""Suites of ground motions: records chosen and scaled to a target spectrum."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from railquake.cli.application import app
from railquake.cli.shared import Json, echo, print_json, progress_bar, write_file, write_text
from railquake.errors import InputError
from railquake.messages import reason, shell_word

if TYPE_CHECKING:
    from railquake.suite import Selection

MOST_NAMED = 3  # damaged files that are named one by one


@app.command()
def select(
    records: Annotated[Path, typer.Option(help="Folder of records, formats mixed or not.")],
    hazard: Annotated[
        str, typer.Option(help="Target: berkeley, berkeley-rock, or a CSV file.")
    ] = "berkeley",
    poe: Annotated[float, typer.Option(help="Probability of exceedance in 50 years.")] = 0.05,
    count: Annotated[int, typer.Option(help="How many records.")] = 20,
    period_range: Annotated[
        str, typer.Option(metavar="SHORTEST,LONGEST", help="Where to match, s.")
    ] = "0.05,2.0",
    largest_scale: Annotated[float, typer.Option(help="Bound on the scale factors.")] = 5.0,
    scatter: Annotated[
        float | None,
        typer.Option(help="Standard deviation of ln Sa to aim at, too; left alone by default."),
    ] = None,
    out: Annotated[Path, typer.Option("--out", help="Folder for the results.")] = Path("suite"),
    as_json: Json = False,
) -> None:
    """Choose and scale records so that their mean meets a target spectrum.

    Writes manifest.csv, which a study takes as [suite] manifest, and suite.png. Files that are no
    records, vertical components and copies are skipped and counted.

    Example: railquake select --records my-records --hazard berkeley --poe 0.05 --count 20
    """
    import numpy as np

    from railquake.files import prepare_folder
    from railquake.suite import load_hazard, manifest_text, select_records, suite_spectra

    target = load_hazard(hazard, poe)
    periods = _periods(period_range)
    prepare_folder(out)
    with progress_bar() as (progress, _):
        chosen = select_records(
            records,
            target,
            count,
            period_range=periods,
            largest_scale=largest_scale,
            scatter=scatter,
            name=out.name or "suite",
            progress=progress,
        )
        shown = np.geomspace(min(0.02, periods[0]), max(5.0, periods[1]), 60)
        spectra = suite_spectra(chosen.suite, shown)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{out}: cannot be made: {reason(error)}") from None
    manifest, picture = out / "manifest.csv", out / "suite.png"
    write_text(manifest, manifest_text(chosen))

    def draw(path: Path) -> None:
        from railquake.plots.suite import write_suite_picture

        write_suite_picture(spectra, path, target, periods, chosen.suite.name)

    write_file(picture, draw)
    if as_json:
        print_json(_facts(chosen, manifest, picture))
        return
    _print(chosen, manifest, picture, records)


def _periods(text: str) -> tuple[float, float]:
    try:
        shortest, longest = (float(part) for part in text.split(","))
    except ValueError:
        raise InputError(
            f'--period-range: two periods in s are needed, such as 0.05,2.0; found "{text}"'
        ) from None
    return shortest, longest


def _facts(chosen: Selection, manifest: Path, picture: Path) -> dict[str, object]:
    return {
        "manifest": str(manifest),
        "picture": str(picture),
        "considered": chosen.considered,
        "skipped": dict(Counter(one.kind for one in chosen.skipped)),
        "misfit_before": chosen.misfit_before,
        "misfit_greedy": chosen.misfit_greedy,
        "misfit": chosen.misfit,
        "largest_deviation": float(abs(chosen.deviation).max()),
        "exchanges": chosen.exchanges,
        "members": [
            {"name": member.name, "scale_factor": member.scale_factor}
            for member in chosen.suite.members
        ],
    }


def _print(chosen: Selection, manifest: Path, picture: Path, records: Path) -> None:
    kinds = Counter(one.kind for one in chosen.skipped)
    if kinds:
        counts = ", ".join(f"{number} x {kind}" for kind, number in kinds.items())
        echo(f"skipped                  {sum(kinds.values())}: {counts}")
        damaged = [one for one in chosen.skipped if one.kind.startswith("damaged")]
        for one in damaged[:MOST_NAMED]:
            echo(f"  {one.reason}")
        if len(damaged) > MOST_NAMED:
            echo(f"  and {len(damaged) - MOST_NAMED} more")
    worst = int(abs(chosen.deviation).argmax())
    factors = [member.scale_factor for member in chosen.suite.members]
    for label, text in (
        ("components", f"{len(factors)} of {chosen.considered} chosen"),
        ("misfit as recorded", f"{chosen.misfit_before:.3f} (rms of ln mean over target)"),
        ("misfit, greedy start", f"{chosen.misfit_greedy:.3f}"),
        ("misfit", f"{chosen.misfit:.3f} after {chosen.exchanges} exchanges"),
        (
            "largest deviation",
            f"{100.0 * chosen.deviation[worst]:+.1f} % at {chosen.periods[worst]:.3g} s",
        ),
        ("scale factors", f"{min(factors):g} to {max(factors):g}"),
    ):
        echo(f"{label:24} {text}")
    echo(f"{manifest}, {picture}")
    echo(
        f"in a study: [suite] manifest = {json.dumps(str(manifest), ensure_ascii=False)}, "
        f"run with --records {shell_word(records)}"
    )
