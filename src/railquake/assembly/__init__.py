"""From a scenario to the constants, arrays and the start that the kernel marches from."""

from railquake.assembly.system import System, assemble, critical_time_step
from railquake.assembly.vehicle import VehicleMatrices, vehicle_matrices

__all__ = ["System", "VehicleMatrices", "assemble", "critical_time_step", "vehicle_matrices"]
