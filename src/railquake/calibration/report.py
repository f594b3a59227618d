"""What a calibration leaves: preset, numbers, the two halves of Figure 6, a summary."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Any

from railquake.calibration.calibrate import Calibration, LoopFacts, loop_facts
from railquake.calibration.dynamic import Check
from railquake.calibration.fit import FittedParameter
from railquake.calibration.preset import preset_text
from railquake.errors import InputError
from railquake.files import whole_folder
from railquake.measures import STANDARD_GRAVITY
from railquake.messages import reason
from railquake.plots.calibration import (
    HistoryPair,
    ParameterMark,
    write_check_picture,
    write_loop_picture,
    write_parameter_picture,
)
from railquake.report.run_folder import json_text
from railquake.run.assess import versions

__all__ = ["as_dict", "draw_histories", "draw_loops", "summary_lines", "write_calibration"]

GOOD_MISFIT, GOOD_PEAK = 0.10, 0.10  # loop misfit over the peak, and peak displacement
TOLD = 0.01  # of the largest cycle's energy: smaller ones are not told
SUMMARY = "fit.json"
HISTORIES = "histories.png"  # only where there are checks


def as_dict(calibration: Calibration) -> dict[str, Any]:
    """All numbers, flat enough for JSON; units in the names."""
    fit, pier = calibration.fit, calibration.pier
    return {
        "name": calibration.name,
        "reference": calibration.reference,
        "source": calibration.source,
        "misfit": {
            "over_peak": fit.misfit.over_peak,
            "over_rms": fit.misfit.over_rms,
            "largest_over_peak": fit.misfit.largest,
            "energy": fit.misfit.energy,
        },
        "hinge": fit.hinge.model_dump(),
        "parameters": [_parameter(p) for p in fit.parameters],
        "bounds_touched": [p.name for p in fit.parameters if p.at_bound],
        "undetermined": [p.name for p in fit.parameters if not p.determined],
        "correlated": [list(pair) for pair in fit.correlated],
        "misfit_of_starts": list(fit.starts),
        "evaluations": fit.evaluations,
        "elastic_column": {
            "length_m": pier.length,
            "flexural_stiffness_n_m2": pier.youngs_modulus * pier.second_moment_of_area,
            "chord_flexibility_rad_per_n_m": calibration.loop.flexibility,
        },
        "loop": _loops(calibration),
        "checks": [_check(calibration, check) for check in calibration.checks],
        "fibre_column": None if calibration.column is None else _column(calibration),
        "versions": versions(),
    }


def _parameter(p: FittedParameter) -> dict[str, Any]:
    return {
        "name": p.name,
        "unit": p.unit,
        "value": p.value,
        "interval": list(p.interval),
        "bounds": [p.low, p.high],
        "scaled": p.scaled,
        "scaled_standard_error": p.scaled_error,
        "at_bound": p.at_bound or None,
        "determined": p.determined,
    }


def _loops(calibration: Calibration) -> dict[str, Any]:
    """Reference, fitted and former hinge along the same path."""
    chord = calibration.loop.chord
    return {
        "reference": _facts(loop_facts(chord, calibration.loop.moment)),
        "fitted": _facts(loop_facts(chord, calibration.fit.moment)),
        "former": {
            "name": calibration.former.name,
            **_facts(loop_facts(chord, calibration.former_moment)),
        },
    }


def _check(calibration: Calibration, check: Check) -> dict[str, Any]:
    drift = check.peak_reference / check.length
    return {
        "motion": check.name,
        "pga_m_s2": check.pga,
        "peak_reference_m": check.peak_reference,
        "peak_m": check.peak_ours,
        "peak_error": check.peak_error,
        "history_rms_over_peak": check.history_error,
        "left_at_end_over_peak": check.residual_error,
        "peak_drift": drift,
        "beyond_protocol": is_beyond(calibration, drift),
    }


def is_beyond(calibration: Calibration, drift: float) -> bool:
    """Whether a drift is larger than any of the loop that was fitted."""
    return drift > float(abs(calibration.loop.chord).max())


def summary_lines(calibration: Calibration) -> list[str]:
    """What is printed."""
    fit = calibration.fit
    lines = [
        f"fitted to                {calibration.reference}: {calibration.name}",
        f"loop misfit              {fit.misfit.over_peak:.2%} of the peak moment"
        + _verdict(fit.misfit.over_peak < GOOD_MISFIT, GOOD_MISFIT)
        + f"; {fit.misfit.over_rms:.2%} of its RMS; largest {fit.misfit.largest:.1%}",
        f"dissipated energy        {_percent(fit.misfit.energy)} of the reference's",
        f"starts                   {len(fit.starts)}, misfits "
        f"{fit.starts[0]:.2%} to {fit.starts[-1]:.2%}",
        "",
        "parameter           value    one standard error         bounds of the fit",
    ]
    for p in fit.parameters:
        remark = f"at its {p.at_bound}er bound" if p.at_bound else ""
        if not p.determined:
            remark = "; ".join(filter(None, (remark, "not determined by this loop")))
        between = f"{p.interval[0]:.3g} to {p.interval[1]:.3g}"
        bounds = f"{p.low:.3g} to {p.high:.3g} {p.unit}"
        lines.append(f"{p.name:14} {p.value:10.4g}    {between:24} {bounds:28} {remark}".rstrip())
    for a, b, r in fit.correlated:
        lines.append(f"{a} and {b} stand for each other: correlation {r:+.2f}")
    lines += ["", *_comparison(calibration)]
    if calibration.checks:
        lines += ["", "motion                     PGA, g    fibre, mm     ours, mm   peak"]
        for check in calibration.checks:
            good = abs(check.peak_error) < GOOD_PEAK
            drift = check.peak_reference / check.length
            beyond = "; beyond the protocol's drifts" if is_beyond(calibration, drift) else ""
            remark = f"{_percent(check.peak_error)}{_verdict(good, GOOD_PEAK)}{beyond}"
            lines.append(
                f"{check.name[:26]:26} {check.pga / STANDARD_GRAVITY:6.3f} "
                f"{1e3 * check.peak_reference:12.2f} {1e3 * check.peak_ours:12.2f}   {remark}"
            )
    return lines


def _percent(share: float) -> str:
    """Signed, and never a negative zero."""
    return f"{round(100.0 * share, 1) + 0.0:+.1f} %"


def _verdict(good: bool, bound: float) -> str:
    return "" if good else f" (MORE THAN {bound:.0%})"


def _comparison(calibration: Calibration) -> list[str]:
    """Reference, fitted and former hinge in the same column along the same path."""
    reference = loop_facts(calibration.loop.chord, calibration.loop.moment)
    fitted = loop_facts(calibration.loop.chord, calibration.fit.moment)
    former = loop_facts(calibration.loop.chord, calibration.former_moment)
    title = calibration.former.name[:16]
    stiffness = [
        1e-6 * pier.youngs_modulus * pier.second_moment_of_area
        for pier in (calibration.pier, calibration.former)
    ]
    lines = [f"{'':34}{'reference':>12}{'fitted':>12}{title:>18}"]

    lines.append(f"{'elastic column E I, MN m2':34}{'':12}{stiffness[0]:12.4g}{stiffness[1]:18.4g}")

    def row(text: str, factor: float, values: tuple[float, float, float]) -> None:
        a, b, c = (factor * value for value in values)
        lines.append(f"{text:34}{a:12.4g}{b:12.4g}{c:18.4g}")

    for text, factor, key in (
        ("largest moment, MN m", 1e-6, "largest_moment"),
        ("initial stiffness, MN m/rad", 1e-6, "initial_stiffness"),
        ("effective stiffness, MN m/rad", 1e-6, "effective_stiffness"),
    ):
        row(text, factor, tuple(getattr(f, key) for f in (reference, fitted, former)))
    # the last cycle at each amplitude, while these grow
    last: dict[float, tuple[float, float, float]] = {}
    for one, two, three in zip(reference.energy, fitted.energy, former.energy, strict=True):
        amplitude = float(f"{one[0]:.3g}")
        if amplitude >= max(last, default=0.0):
            last[amplitude] = (one[1], two[1], three[1])
    most = max((energies[0] for energies in last.values()), default=0.0)
    for amplitude, energies in last.items():
        if energies[0] < TOLD * most:
            continue
        row(f"energy of a cycle to {amplitude:.2%}, kJ", 1e-3, energies)
    return lines


def write_calibration(calibration: Calibration, folder: Path) -> dict[str, Any]:
    """Write preset, numbers and pictures; whole or not at all.

    Parameters
    ----------
    calibration : Calibration
    folder : Path
        Made if it is not there; files of a former calibration in it are replaced.

    Returns
    -------
    dict
        What fit.json holds.

    Raises
    ------
    InputError
        If the files cannot be written.
    """
    row = as_dict(calibration)
    try:
        with whole_folder(folder, ours=(HISTORIES,), last=SUMMARY) as part:
            (part / "hinge.toml").write_text(preset_text(calibration), encoding="utf-8")
            draw_loops(calibration, part / "loops.png")
            draw_parameters(calibration, part / "parameters.png")
            if calibration.checks:
                draw_histories(calibration, part / HISTORIES)
            (part / SUMMARY).write_text(json_text(row) + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {reason(error)}") from None
    return row


def draw_loops(calibration: Calibration, path: Path) -> Path:
    """Reference and fitted loop, one over the other: the first half of Figure 6."""
    misfit = calibration.fit.misfit
    return write_loop_picture(
        calibration.loop.chord,
        calibration.loop.moment,
        calibration.fit.moment,
        path,
        title=f"Hinge fitted to {calibration.reference}",
        name=calibration.name,
        drift=calibration.loop.flexibility > 0.0,
        facts=f"RMS difference {misfit.over_peak:.1%} of the peak moment, {misfit.over_rms:.1%} of "
        f"its RMS; dissipated energy {_percent(misfit.energy)}",
    )


def draw_histories(calibration: Calibration, path: Path) -> Path:
    """Displacements under the motions, one over the other: the second half of Figure 6."""
    return write_check_picture(
        [
            HistoryPair(
                check.name,
                check.time,
                check.reference,
                check.ours,
                f"PGA {check.pga / STANDARD_GRAVITY:.2f} g; "
                f"peak {1e3 * check.peak_reference:.0f} mm and "
                f"{1e3 * check.peak_ours:.0f} mm, {_percent(check.peak_error)}",
            )
            for check in calibration.checks
        ],
        path,
        name=calibration.name,
    )


def draw_parameters(calibration: Calibration, path: Path) -> Path:
    """How well each parameter is known."""
    return write_parameter_picture(
        [
            ParameterMark(
                p.name, p.scaled, p.scaled_error, f"{p.value:.3g} {p.unit}".strip(), p.determined
            )
            for p in calibration.fit.parameters
        ],
        path,
        name=calibration.name,
    )


def _facts(facts: LoopFacts) -> dict[str, Any]:
    return {
        "initial_stiffness_n_m_per_rad": facts.initial_stiffness,
        "effective_stiffness_n_m_per_rad": facts.effective_stiffness,
        "largest_moment_n_m": facts.largest_moment,
        "cycles": [{"drift": drift, "energy_j": energy} for drift, energy in facts.energy],
    }


def _column(calibration: Calibration) -> dict[str, Any]:
    column = calibration.column
    assert column is not None
    return {
        "axial_load_n": column.axial_load,
        "plastic_length_m": column.plastic_length,
        "unconfined": asdict(column.unconfined),
        "confined": asdict(column.confined),
        "steel": asdict(column.steel),
    }
