"""Picture of a wheelset that stands still on two rails."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from railquake.plots.style import BLUE, RED, figure, label, plain, save

if TYPE_CHECKING:
    from railquake.inputs.wheelrail import WheelRail
    from railquake.probe import StandingWheelset

__all__ = ["write_contact_picture"]


def write_contact_picture(wheelrail: WheelRail, standing: StandingWheelset, path: Path) -> Path:
    """Draw both wheels on their rails, each patch with its normal and its load.

    Parameters
    ----------
    wheelrail : WheelRail
    standing : StandingWheelset
    path : Path
        PNG to write.
    """
    wheel = wheelrail.wheel_profile()
    rail = wheelrail.rail_profile()
    crown = float(rail.z.min())
    sine, cosine = np.sin(standing.roll), np.cos(standing.roll)
    made, axes = figure(10.0, 3.3, 1, 2)
    for ax, side, sign in ((axes[0], "left", -1.0), (axes[1], "right", 1.0)):
        centre = sign * wheelrail.rail_half_distance(rail)
        ax.fill(1e3 * (centre + sign * rail.y), 1e3 * (rail.z - crown), color="#d9d9d9")
        y = sign * (wheelrail.running_circle + wheel.y)
        z = wheelrail.rolling_radius + wheel.z
        place_y = standing.shift + y * cosine - z * sine
        place_z = standing.height + y * sine + z * cosine
        ax.plot(1e3 * place_y, 1e3 * place_z, color=BLUE, linewidth=1.5)
        loads = []
        for patch in standing.patches:
            if patch.side != side:
                continue
            # the rail's normal: up, and on the gauge corner towards the middle of the track
            tip_y = patch.y_m - sign * 0.02 * np.sin(patch.angle_rad)
            tip_z = patch.z_m - 0.02 * np.cos(patch.angle_rad)
            ax.annotate(
                "",
                xy=(1e3 * tip_y, 1e3 * tip_z),
                xytext=(1e3 * patch.y_m, 1e3 * patch.z_m),
                arrowprops={"arrowstyle": "->", "color": RED, "linewidth": 1.2},
            )
            ax.plot(1e3 * patch.y_m, 1e3 * patch.z_m, "o", color=RED, markersize=3)
            loads.append(
                f"{1e-3 * patch.normal_n:.1f} kN at {np.degrees(patch.angle_rad):.1f}°, "
                f"{1e3 * patch.a_m:.1f} x {1e3 * patch.b_m:.1f} mm"
            )
        ax.set_xlim(1e3 * centre - 85.0, 1e3 * centre + 85.0)
        ax.set_ylim(45.0, -35.0)
        ax.set_aspect("equal")
        label(ax, "y in the track, mm", "z, mm", f"{side.capitalize()}: " + "; ".join(loads))
    towards = "left" if standing.shift < 0.0 else "right"
    made.suptitle(
        f"{plain(wheelrail.name)}: wheelset {1e3 * abs(standing.shift):.1f} mm to the {towards}, "
        f"roll {np.degrees(standing.roll):+.3f}° (normal force, angle, semi-axes a x b)",
        fontsize=10,
        x=0.01,
        ha="left",
    )
    return save(made, path)
