"""Trust: energy residuals, the time step and its error, versions, fingerprints."""

from __future__ import annotations

import hashlib
import json
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.errors import InputError
from railquake.measures import telling_of_the_step
from railquake.report.chart import Chart, Panel, Points, Rule
from railquake.report.context import ReportSection, Table, Text
from railquake.run.doubts import BARS, FORWARD_SHARE, GAIN

if TYPE_CHECKING:
    from railquake.report.context import Context

__all__ = ["section"]

TITLE = "Can these numbers be trusted?"
FLOOR = 1e-8


def section(context: Context) -> ReportSection:
    """Energy residuals of all runs, the time step's error, versions and hashes."""
    blocks: list[Any] = []
    chart = _residuals(context)
    if chart is not None:
        blocks.append(chart)
    blocks += _time_step(context)
    blocks.append(_provenance(context))
    return ReportSection("trust", TITLE, tuple(blocks))


def _residuals(context: Context) -> Chart | None:
    panels = []
    for column, title in (
        ("energy_residual", "Whole balance"),
        ("contact_energy_residual", "Contact’s balance"),
    ):
        layers = []
        for model in context.models:
            rows = context.of(model)
            values = np.abs(rows[column].to_numpy(dtype=float))
            kept = np.isfinite(values)
            rows, values = rows[kept], np.maximum(values[kept], FLOOR)
            if not len(values):
                continue
            order = np.argsort(values, kind="stable")
            look = context.look(model)
            share = (np.arange(len(values)) + 1.0) / len(values)
            chosen = rows.iloc[order]
            layers.append(
                Points(look.label, look.colour, values[order], 100.0 * share,
                       chosen["row"].to_numpy(), context.words(chosen), look.symbol, look.open, 4.0)
            )  # fmt: skip
        if layers:
            bar = Rule(f"bar of the tests, {100 * BARS[column]:g} %", x=BARS[column])
            panels.append(
                Panel(title, "residual (absolute), as a fraction", "runs with no more than that, %",
                      (bar, *layers), log_x=True, y_range=(0.0, 103.0))
            )  # fmt: skip
    if not panels:
        return None
    return Chart("energy-residuals", "Energy residuals of all runs", _said(context), tuple(panels))


def _said(context: Context) -> str:
    """What the audits say of all runs, in words."""
    done = context.done
    over = {
        column: np.abs(done[column].to_numpy(dtype=float)) > bar for column, bar in BARS.items()
    }
    shares = done["forward_input_share"].to_numpy(dtype=float)
    paid = int((shares > FORWARD_SHARE).sum())
    contact = over["contact_energy_residual"]
    lifted = contact & (done["off_rail_time_s"].to_numpy(dtype=float) > 0.0)
    gains = int((done["contact_gain"].to_numpy(dtype=float) > GAIN).sum())
    caption = (
        "What each run’s energy balances leave over: of the whole, relative to all that is "
        "dissipated, and of the contact, relative to what impact and creep lose. The second is the "
        "one to watch: the first closes even where a contact force is wrong. Beyond the bars of "
        f"the program’s own tests lie {int(over['energy_residual'].sum())} and "
        f"{int(contact.sum())} of {len(done):,} runs; the contact gains more than "
        f"{100 * GAIN:g} % of all that is dissipated in {gains}."
    )
    if lifted.any():
        caption += (
            f" In {int(lifted.sum())} of the latter a wheel leaves its rail: do not use their peak "
            "forces without a smaller step or the grid method."
        )
    quiet = contact & ~lifted
    lost = done["energy_dissipated_j"].to_numpy(dtype=float)
    if quiet.any() and np.median(lost[quiet]) < np.median(lost):
        caption += (
            f" The {'other ' if lifted.any() else ''}{int(quiet.sum())} lift no wheel and are "
            "weakly shaken: so little is lost in the contact that the error of the step shows."
        )
    moved = [over[f"{kind}_momentum_residual"] for kind in ("linear", "angular")]
    caption += (
        f" {int((moved[0] | moved[1]).sum())} runs gain momentum or angular momentum that neither "
        f"rails nor ground nor gravity give them. In {paid} runs spin and the train’s forward "
        f"motion bring in more than {100 * FORWARD_SHARE:g} % of what creep loses, and no balance "
        "sees an error in that."
    )
    return caption


def _time_step(context: Context) -> list[Any]:
    done = context.done
    steps = sorted({float(f"{value:.6g}") for value in done["dt_s"].dropna()})
    if not steps:
        return []
    said = ", ".join(f"{step:g} s" for step in steps[:5])
    critical = done["dt_critical_s"].min()
    text = f"Time step: {said}; the smallest critical step of all runs is {critical:.3g} s."
    facts = context.time_step_facts
    if facts.get("text"):
        text += f" It was chosen by the program for this study: {facts['text']}."
        return [Text(text)]
    return [Text(text), *_halved(context)]


def _halved(context: Context) -> list[Any]:
    """Some runs again with half the step."""
    from railquake.run.many import simulate_many

    rows = _telling(context)
    context.notify(f"running {len(rows)} rows again with half the time step ...")
    scenarios, used = [], context.table.set_index("row")
    try:
        for row in rows:
            scenario = context.results.scenario(row)
            scenarios.append(
                scenario.with_changes({"solver.dt": 0.5 * float(used.at[row, "dt_s"])})
            )
        found = dict(simulate_many(scenarios))
    except InputError as error:
        return [Text(f"Its error cannot be measured: {error}.", "note")]
    lines = []
    checked = telling_of_the_step()
    for k, row in enumerate(rows):
        if found[k].get("status") not in ("safe", "onset", "derailed"):
            continue
        (words,) = context.words(context.table[context.table["row"] == row])
        changes = []
        for measure in checked:
            fine, coarse = found[k][measure.key], float(used.at[row, measure.key])
            changes.append(_per_cent(coarse / fine - 1.0) if fine else "–")
        lines.append((words, *changes, context.command(row)))
    if not lines:
        return []
    caption = (
        "The error of the time step, measured: telling runs (the median and the strongest of each "
        "model) as they stand in the table, relative to the same with half the step. Derailed "
        "runs are left aside: their uplift grows without bound in the last moments."
    )
    head = ("run", *(measure.short for measure in checked), "command")
    return [Table(head, tuple(lines), caption)]


def _per_cent(change: float) -> str:
    return f"{100.0 * change:+.3f} %".replace("-", "−")


def _telling(context: Context) -> list[int]:
    rows: list[int] = []
    for model in context.models[:5]:
        of = context.of(model)
        alive = of[of["status"] != "derailed"]
        alive = (alive if len(alive) else of).sort_values("uplift_ratio", kind="stable")
        if len(alive):
            rows += [int(alive["row"].iloc[len(alive) // 2]), int(alive["row"].iloc[-1])]
    return list(dict.fromkeys(rows))[:8]


def _provenance(context: Context) -> Table:
    table = context.table
    rows: list[tuple[str, ...]] = []
    for text in table["versions"].dropna().unique() if "versions" in table else []:
        try:
            known = json.loads(text)
            said = ", ".join(f"{name} {number}" for name, number in known.items())
        except (ValueError, AttributeError):
            said = str(text)
        count = int((table["versions"] == text).sum())
        rows.append((f"versions ({count:,} runs)", said))
    hashes = sorted(str(value) for value in table["scenario_hash"].dropna())
    digest = hashlib.sha256("\n".join(hashes).encode()).hexdigest()
    rows.append((f"SHA-256 of the {len(hashes):,} scenario hashes, sorted", digest))
    study = context.results.folder / "study.toml"
    with suppress(OSError):
        rows.append(("SHA-256 of study.toml", hashlib.sha256(study.read_bytes()).hexdigest()))
    rows.append(("contact", ", ".join(sorted(map(str, table["contact"].dropna().unique()))) or "–"))
    wall = float(table["wall_s"].dropna().sum()) if "wall_s" in table else 0.0
    steps = float(table["steps"].dropna().sum()) if "steps" in table else 0.0
    rows.append(("time steps marched, all runs", f"{steps:.3g}"))
    rows.append(("time of all runs added up (many run abreast)", f"{wall:,.0f} s"))
    return Table(("what", "value"), tuple(rows), "Where these numbers come from.")
