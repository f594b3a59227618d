"""From a response to one flat row: what is measured on every run."""

from __future__ import annotations

import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from typing import TYPE_CHECKING, Any

from railquake.physics import derailment

if TYPE_CHECKING:
    from railquake.run.response import Response

__all__ = ["assess", "versions"]


def versions() -> dict[str, str]:
    """Versions of all that decides the numbers."""
    return dict(_versions())


@cache
def _versions() -> dict[str, str]:
    found = {"python": platform.python_version()}
    for package in ("railquake", "numpy", "scipy", "numba"):
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            found[package] = "unknown"
    return found


def assess(response: Response) -> dict[str, Any]:
    """Measures of one run, by the names of ``summary.json``.

    Parameters
    ----------
    response : Response

    Returns
    -------
    dict
        Flat but for ``versions``: numbers in the units that their names carry, None where
        something did not happen.
    """
    end = response.end[:, 0]
    q = response.system.constants[:, 0]
    state, constant = response.system.layout.state, response.system.layout.constant
    ground = response.system.ground
    audit = response.audit

    def value(row: int) -> float:
        return float(end[row])

    def when(event: int) -> float | None:
        at = float(end[state.FIRST_TIME + event])
        return at if at >= 0.0 else None

    static = response.system.static_wheel_load
    mode = response.derailment_mode
    uplift_end = value(state.UPLIFT_END)
    return {
        "status": response.status,
        "derailed": mode is not None,
        "derailment_mode": mode,
        "pga_m_s2": ground.pga,
        "pgv_m_s": ground.pgv,
        "arias_intensity_m_s": ground.arias_intensity,
        "pbd_m": value(state.PEAK_U),
        "pbv_m_s": value(state.PEAK_U_V),
        "pba_m_s2": value(state.PEAK_U_A),
        "hinge_rotation_peak_rad": value(state.PEAK_THETA1),
        "base_moment_peak_n_m": value(state.PEAK_MOMENT),
        "top_rotation_peak_rad": value(state.PEAK_THETA2),
        "relative_roll_peak_rad": value(state.PEAK_ROLL),
        "uplift_ratio": value(state.PEAK_ROLL) / q[constant.REFERENCE_ROLL],
        "lateral_shift_peak_m": value(state.PEAK_SHIFT),
        "wheel_load_static_n": static,
        "wheel_load_peak_n": value(state.PEAK_LOAD),
        "wheel_unloading_peak": 1.0 - value(state.LOWEST_LOAD) / static,
        "lateral_force_peak_n": value(state.PEAK_LATERAL),
        "lateral_force_filtered_peak_n": value(state.PEAK_LATERAL_FILTERED),
        "derailment_coefficient_peak": value(state.PEAK_DERAILMENT_COEFFICIENT),
        "flange_clearance_peak_m": value(state.PEAK_CLEARANCE),
        "off_rail_time_s": value(state.TIME_ONE_WHEEL),
        "detached_time_s": value(state.TIME_DETACHED),
        "uplifts": int(value(state.UPLIFTS)),
        "flange_contact_first_s": when(derailment.FLANGE_CONTACT),
        "uplift_first_s": when(derailment.UPLIFT),
        "uplift_last_end_s": uplift_end if uplift_end >= 0.0 else None,
        "onset_first_s": when(derailment.ONSET),
        "flange_over_first_s": when(derailment.FLANGE_OVER),
        "derailed_s": when(derailment.DERAILED),
        "overturned_s": when(derailment.OVERTURNED),
        "energy_residual": audit.whole_relative,
        "contact_energy_residual": audit.contact_relative,
        "energy_dissipated_j": audit.dissipated,
        "steps": response.steps,
        "steps_per_s": response.steps / max(response.march_s, 1e-9),
        "wall_s": response.wall_s,
        "dt_s": response.system.dt,
        "dt_critical_s": response.system.critical_dt,
        "dt_error": None if response.time_step is None else response.time_step.error,
        "contact": response.system.scenario.solver.contact,
        "versions": versions(),
    }
