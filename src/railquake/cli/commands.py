"""All commands: each module registers its own with `application.app` when it is imported here."""

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
