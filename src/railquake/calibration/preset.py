"""The calibrated pier as a preset file, with its provenance."""

from __future__ import annotations

from railquake.calibration.calibrate import Calibration
from railquake.inputs.toml import dumps
from railquake.version import __version__

__all__ = ["preset_text"]


def preset_text(calibration: Calibration) -> str:
    """A file that ``support.preset = "hinge.toml"`` takes.

    Parameters
    ----------
    calibration : Calibration

    Returns
    -------
    str
        TOML; all values in SI units.
    """
    table = calibration.pier.model_dump(exclude_none=True)
    misfit = calibration.fit.misfit
    table.update(
        name=calibration.name,
        summary=f"{calibration.former.name} with a hinge calibrated to {calibration.reference}",
        source=(
            f"Hinge: least squares by railquake {__version__} to {calibration.reference} "
            f'("{calibration.name}"), loop misfit {misfit.over_peak:.1%} of the peak moment '
            f"({misfit.over_rms:.1%} of its root mean square)."
            + (f" {' '.join(calibration.source.split())}" if calibration.source else "")
            + f' Everything else: "{calibration.former.name}".'
        ),
        note=_note(calibration),
    )
    bouc_wen = table.pop("bouc_wen")
    return dumps({**table, "bouc_wen": bouc_wen})


def _note(calibration: Calibration) -> str:
    fit = calibration.fit
    parts = [
        f"Holds for hinge rotations up to {1e3 * fit.hinge.xu:.3g} mrad, the largest of the loop, "
        f"together with this file's column, E I = "
        f"{calibration.pier.youngs_modulus * calibration.pier.second_moment_of_area:.4g} N m2: the "
        "hinge carries what that column lacks in flexibility."
    ]
    unknown = [p.name for p in fit.parameters if not p.determined]
    if unknown:
        parts.append(f"The loop does not determine {', '.join(unknown)}.")
    bound = [p.name for p in fit.parameters if p.at_bound]
    if bound:
        parts.append(f"At a bound of the fit: {', '.join(bound)}.")
    if calibration.checks:
        errors = ", ".join(f"{100.0 * check.peak_error:+.1f} %" for check in calibration.checks)
        parts.append(f"Peak displacement under motions not in the fit: {errors}.")
    return " ".join(parts)
