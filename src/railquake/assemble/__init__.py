"""From a scenario to the constants, arrays and the start that the kernel marches from."""

from railquake.assemble.system import System, assemble
from railquake.assemble.vehicle import VehicleMatrices, vehicle_matrices

__all__ = ["System", "VehicleMatrices", "assemble", "vehicle_matrices"]
