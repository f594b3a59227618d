"""All pictures of a run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from railquake.inputs.support import Pier
from railquake.plots.hinge import write_hinge_loop
from railquake.plots.histories import write_histories
from railquake.plots.loads import write_wheel_loads
from railquake.plots.roll import write_relative_roll
from railquake.plots.section import write_section

if TYPE_CHECKING:
    from railquake.run.response import Response

__all__ = ["write_pictures"]


def write_pictures(response: Response, folder: Path) -> list[Path]:
    """Write all pictures of a run as PNG.

    Parameters
    ----------
    response : Response
    folder : Path
        Must exist.

    Returns
    -------
    list of Path
        ``histories.png``, ``wheel-loads.png``, ``relative-roll.png``, ``section.png``, and for a
        pier ``hinge-loop.png``.
    """
    paths = [
        write_histories(response, folder / "histories.png"),
        write_wheel_loads(response, folder / "wheel-loads.png"),
        write_relative_roll(response, folder / "relative-roll.png"),
        write_section(response, folder / "section.png"),
    ]
    if isinstance(response.system.scenario.support, Pier):
        paths.append(write_hinge_loop(response, folder / "hinge-loop.png"))
    return paths
