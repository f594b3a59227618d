"""Pictures: of a run, of a vehicle's modes, of a ground motion, of one component by itself.

Drawn with matplotlib's figures alone (no global state), so that they can be made in any thread.
"""

from railquake.plots.creep import write_creep_picture
from railquake.plots.hinge import write_hinge_picture
from railquake.plots.modes import write_modes_picture
from railquake.plots.motion import write_motion_picture
from railquake.plots.run import write_pictures

__all__ = [
    "write_creep_picture",
    "write_hinge_picture",
    "write_modes_picture",
    "write_motion_picture",
    "write_pictures",
]
