"""What a run's audits make one doubt: the bars, and a line for each that is crossed."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from railquake.run.response import Response

__all__ = ["BARS", "FORWARD_SHARE", "GAIN", "doubts"]

BARS = {
    "energy_residual": 1e-3,
    "contact_energy_residual": 0.03,
    "gravity_work_residual": 1e-3,
    "linear_momentum_residual": 1e-4,
    "angular_momentum_residual": 1e-4,
}
"""Of the residuals' magnitudes, by the keys of their measures."""

GAIN = 0.01  # of the contact, over all that is dissipated: it makes energy
FORWARD_SHARE = 0.05


def doubts(response: Response) -> tuple[str, ...]:
    """A line for each bar that a run crosses; its ``warnings``.

    Parameters
    ----------
    response : Response
    """
    audit, momentum = response.audit, response.momentum
    found = {
        "energy_residual": (audit.whole_relative, "of what is dissipated"),
        "contact_energy_residual": (audit.contact_relative, "of what impact and creep lose"),
        "gravity_work_residual": (audit.gravity_relative, "of what is dissipated"),
        "linear_momentum_residual": (momentum.linear_relative, "of the largest impulse"),
        "angular_momentum_residual": (momentum.angular_relative, "of the largest impulse"),
    }
    said = []
    for key, (value, of) in found.items():
        if not abs(value) <= BARS[key]:  # NaN, too
            said.append(f"{key} is {100.0 * value:.3g} % {of}, beyond {100.0 * BARS[key]:g} %")
    if audit.contact_gain > GAIN:
        said.append(
            f"the contact gains {100.0 * audit.contact_gain:.3g} % of what is dissipated, beyond "
            f"{100.0 * GAIN:g} %"
        )
    share = audit.forward_share
    if share > FORWARD_SHARE:
        said.append(
            f"spin and the train's forward motion bring in {100.0 * share:.3g} % of what creep "
            f"loses, beyond {100.0 * FORWARD_SHARE:g} %: no balance sees an error in them"
        )
    return tuple(said)
