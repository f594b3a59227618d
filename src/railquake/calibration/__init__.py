"""Calibration of the plastic hinge: the paper's Figure 6 as a tool.

To a fibre model of a reinforced-concrete column in OpenSees::

    from railquake.calibration import calibrate_column, load_column, write_calibration

    found = calibrate_column(load_column("column.toml"))
    write_calibration(found, Path("fit"))

or to a measured loop (`read_loop`, `calibrate_hinge`).
"""

from railquake.calibration.calibrate import Calibration, calibrate_column, calibrate_hinge
from railquake.calibration.column import Column, load_column
from railquake.calibration.cyclic import Loop, read_loop
from railquake.calibration.fit import Fit, fit_hinge
from railquake.calibration.loop import column_flexibility, drive_hinge
from railquake.calibration.report import write_calibration

__all__ = [
    "Calibration",
    "Column",
    "Fit",
    "Loop",
    "calibrate_column",
    "calibrate_hinge",
    "column_flexibility",
    "drive_hinge",
    "fit_hinge",
    "load_column",
    "read_loop",
    "write_calibration",
]
