"""From a scenario to the constants, arrays and the start that the kernel marches from."""

from railquake.assembly.car import HeldCar, held_car
from railquake.assembly.rest import newton_root
from railquake.assembly.system import System, assemble, critical_time_step
from railquake.assembly.vehicle import VehicleMatrices, refuse_unstable, vehicle_matrices

__all__ = [
    "HeldCar",
    "System",
    "VehicleMatrices",
    "assemble",
    "critical_time_step",
    "held_car",
    "newton_root",
    "refuse_unstable",
    "vehicle_matrices",
]
