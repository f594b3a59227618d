"""The command ``railquake``: thin, every command calls what a Python user would call.

A module a group of commands; each registers with `application.app` when it is imported here.
"""

from railquake.cli import bench, calibrate, probe, report, select, single, study, validate
from railquake.cli.application import app
from railquake.cli.status import main

__all__ = [
    "app",
    "bench",
    "calibrate",
    "main",
    "probe",
    "report",
    "select",
    "single",
    "study",
    "validate",
]
