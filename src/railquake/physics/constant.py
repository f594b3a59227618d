"""Rows of the constants ``Q[row, lane]``: everything of a run that stays fixed.

The vehicle's rows stand last: the bodies' masses; then, in the order of `vehicle.kernel_order`,
inverse masses and the upper triangles of K_v and of C_v (see `vehicle.packed`).
"""

from typing import Final

DT: Final = 0  # time step, s; of the wheelset on its rails
FRAME_STEPS: Final = 1  # time steps in a frame

# --- pier (Eqs. 9, 10) --------------------------------------------------------------------------
PIER_LOAD: Final = 2  # mass that the ground's acceleration acts on, kg; 0 at grade
M_U: Final = 3
M_1: Final = 4
M_2: Final = 5
K: Final = 6  # column stiffness: uu, u1, u2, 11, 12, 22 (hinge apart)
C: Final = 12  # Rayleigh damping, same order
FLEX: Final = 18  # inverse of Newmark's effective matrix (hinge apart), same order

# --- hinge (Eqs. 11, 12) ------------------------------------------------------------------------
K0: Final = 24
ALPHA: Final = 25
N: Final = 26
ETA0: Final = 27
BETA0: Final = 28
RHO_EPS_M: Final = 29  # rho_eps m / (Fy xu)
RHO_X: Final = 30  # rho_x / xu
PHI: Final = 31
DELTA_K: Final = 32
DELTA_F: Final = 33
PER_SIGMA: Final = 34  # 1/sigma
PINCH_U: Final = 35
PER_EPS_P: Final = 36  # 1/eps_p
RHO_P: Final = 37
PER_HINGE_MASS: Final = 38  # 1/m
TOLERANCE: Final = 39  # of z, rad
MAX_ITERATIONS: Final = 40

# --- track: displacement of its origin = MAP x displacement of the pier's top -------------------
MAP_U: Final = 41  # Y_t = MAP_U u + MAP_H phi
MAP_H: Final = 42
MAP_E: Final = 43  # Z_t = MAP_E phi
MAP_PHI: Final = 44  # phi_t = MAP_PHI phi, phi = -theta_2
REACTION: Final = 45  # 1: the contact forces act on the pier; 0: decoupled, at grade, prescribed

# --- vehicle and contact ------------------------------------------------------------------------
ZHAI_PSI: Final = 46
ZHAI_PHI: Final = 47
GRAVITY: Final = 48
WHEELSET_HEIGHT: Final = 49  # wheelset's centre of gravity above the rail crowns, m
AXLES: Final = 50
FRICTION: Final = 51
INVERSE_SPEED: Final = 52  # 1/max(V, bound), s/m
ALPHA_R: Final = 53  # hysteresis of Eq. 7 or calibrated
ONSET_BOUND: Final = 54  # m/s

# --- table axes, see `profiles.axis_cell`: fine, end, fine rate, coarse rate, coarse, inner cells
SHIFT_AXIS: Final = 55
ROLL_AXIS: Final = 61

# --- thresholds ---------------------------------------------------------------------------------
REFERENCE_ROLL: Final = 67
TIP_Y: Final = 68  # flange tip in wheelset axes of the right-hand wheel, m
TIP_Z: Final = 69
RAIL_CENTRE: Final = 70  # half the distance between the rails' centre lines, m
SHIFT_LIMIT: Final = 71
ROLL_LIMIT: Final = 72
STATIC_WHEEL_LOAD: Final = 73  # of one side of the section, N
VEHICLE_MASS: Final = 74
FILTER_B0: Final = 75  # low-pass of the frame means: b0, b1, b2, a1, a2
FILTER_B1: Final = 76
FILTER_B2: Final = 77
FILTER_A1: Final = 78
FILTER_A2: Final = 79
RATE: Final = 80  # 1/(SUBSTEPS dt), 1/s
SUBSTEPS: Final = 81  # time steps in one of structure and sprung bodies, see `march.step`
VEHICLE: Final = 82
