"""Rows of the state ``S[row, lane]``: everything of a run that changes with time.

The vehicle's rows stand last, because their number follows from its bodies: five blocks of
``DOF_COUNT`` rows hold displacement, velocity, acceleration, the last acceleration and the last
increment of displacement, in the order of `vehicle.kernel_order`.
"""

# ruff: noqa: E501

# --- ground: acceleration and its change per step of the structure, m/s2; z is positive down
(GROUND, GROUND_SLOPE, GROUND_Z, GROUND_Z_SLOPE) = range(4)

# --- pier (Eqs. 9, 10): u, theta_1 (base), theta_2 (top); velocities; accelerations
(U, THETA1, THETA2, U_V, THETA1_V, THETA2_V, U_A, THETA1_A, THETA2_A) = range(4, 13)

# --- hinge (Eqs. 11, 12): hysteretic rotation, its last increment, energy, largest rotation,
# moment; damage and the degradation that is known for it; stiffness after pinching
(Z, Z_STEP, EPS, X_MAX, MOMENT) = range(13, 18)
(DAMAGE, DEGRADED_A, DEGRADED_BETA, DEGRADED_LOG, PINCHED) = range(18, 23)

# --- track's origin: position, velocity, acceleration within the structure's step; sine and cosine
# of its roll
(TRACK_Y, TRACK_Z, TRACK_PHI, TRACK_VY, TRACK_VZ, TRACK_VPHI) = range(23, 29)
(TRACK_AY, TRACK_AZ, TRACK_APHI, TRACK_SIN, TRACK_COS) = range(29, 34)

# --- wheelset from the track's origin in ground axes; in track axes: Y, Z (negative: above the
# rails), psi; rates; sine and cosine of psi
(ARM_Y, ARM_Z) = range(34, 36)
(SHIFT, HEIGHT, ROLL, SHIFT_V, HEIGHT_V, ROLL_V, ROLL_SIN, ROLL_COS) = range(36, 44)

# --- table cell of each side (left, right): first number in the table, place within the cell;
# for both sides: cells per metre and per radian; the cell whose values are at hand
CELL = 44
CELL_ROWS = 6
(CELL_BASE, CELL_SHIFT, CELL_SHIFT_RATE, CELL_ROLL, CELL_ROLL_RATE, CELL_HELD) = range(CELL_ROWS)
CELL_END = CELL + 2 * CELL_ROWS

# --- for each patch the polynomials of its cell: gap, coefficients of w^i for the powers 0 (4), 1
# (2), 2 (4) and 3 (4) of the place in roll; then bilinear (1, w, w_roll, w w_roll) for height of the
# contact point in track axes (m), Hertz K (N/m^1.5), f22/delta and f23/(delta^1.5 r)
POLYNOMIAL = CELL_END
POLYNOMIAL_ROWS = 30
POLYNOMIALS_END = POLYNOMIAL + 4 * POLYNOMIAL_ROWS

# --- patches: left tread, left flange, right tread, right flange, in the axes of a right-hand wheel
PATCH = POLYNOMIALS_END
PATCH_ROWS = 2
(
    PATCH_HYSTERESIS,  # chi/K, frozen at the onset of this contact, s/m; 0 while open
    PATCH_PENETRATION,  # vertical, m; negative: gap
) = range(PATCH_ROWS)
# for the flange of each side (left, right) 1, or 0 where it cannot touch its rail for some steps
NEAR = PATCH + 4 * PATCH_ROWS
PATCHES_END = NEAR + 2

# --- contact, all wheels of the section: forces on the wheelset in track axes, moment about its centre
(FORCE_Y, FORCE_Z, FORCE_PSI) = range(PATCHES_END, PATCHES_END + 3)
(HERTZ_ENERGY, IMPACT_POWER, CREEP_POWER, SPIN_POWER) = range(PATCHES_END + 3, PATCHES_END + 7)
(IMPACT_POWER_OLD, CREEP_POWER_OLD, SPIN_POWER_OLD) = range(PATCHES_END + 7, PATCHES_END + 10)
# vertical load and lateral force of the wheels of each side on their rail
(LOAD_LEFT, LOAD_RIGHT, LATERAL_LEFT, LATERAL_RIGHT) = range(PATCHES_END + 10, PATCHES_END + 14)
# the same forces in ground axes on the wheelset, now and in the step before
(WHEELSET_Y, WHEELSET_Z, WHEELSET_PHI) = range(PATCHES_END + 14, PATCHES_END + 17)
WHEELSET_OLD = PATCHES_END + 17
# what acts on the track's origin during a step of the structure, and did during the one before; the
# contact force on it at the begin of each; the same on the pier's top node
(TRACK_FY, TRACK_FZ, TRACK_MX) = range(PATCHES_END + 20, PATCHES_END + 23)
TRACK_OLD = PATCHES_END + 23
TRACK_CONTACT = PATCHES_END + 26
(NODE_U, NODE_THETA2) = range(PATCHES_END + 29, PATCHES_END + 31)
FORCES_END = PATCHES_END + 31
# acceleration of the wheelset (y, z, phi) but for the contact: from suspension, ground and gravity;
# as last evaluated; its change per step
WHEELSET_FREE = FORCES_END
WHEELSET_FREE_KNOWN = FORCES_END + 3
WHEELSET_FREE_SLOPE = FORCES_END + 6
# where the wheelset was before the structure's step (y, z)
WHEELSET_FROM = FORCES_END + 9
MOTION_END = FORCES_END + 11

# --- energy audit, J
(
    WORK_GROUND,
    WORK_GRAVITY,
    WORK_VEHICLE,  # by the contact forces on the vehicle
    WORK_TRACK,  # by the contact forces on the track
    LOST_RAYLEIGH,
    LOST_DASHPOTS,
    HINGE_ENERGY,  # integral of M d(theta_1)
    LOST_IMPACT,
    LOST_CREEP,
    SPIN_INPUT,  # brought in by the train's forward motion
    DASHPOT_POWER,
    DASHPOT_POWER_OLD,
    VEHICLE_ENERGY,  # kinetic and elastic, kept when the vehicle leaves the model
    HERTZ_LEFT,  # Hertz energy that goes with it
) = range(MOTION_END, MOTION_END + 14)
AUDIT_END = MOTION_END + 14

# --- peaks of absolute values, from every step
(
    PEAK_U,
    PEAK_U_V,
    PEAK_U_A,
    PEAK_THETA1,
    PEAK_MOMENT,
    PEAK_THETA2,
    PEAK_ROLL,
    PEAK_SHIFT,
    PEAK_LOAD,
    PEAK_LATERAL,
    TIME_ONE_WHEEL,  # s with at least one wheel off its rail
    TIME_DETACHED,  # s with both wheels off
) = range(AUDIT_END, AUDIT_END + 12)
# sums over the frame, for its means: lateral force on the track; loads, lateral forces left, right
(SUM_LATERAL, SUM_LOAD_LEFT, SUM_LOAD_RIGHT, SUM_LATERAL_LEFT, SUM_LATERAL_RIGHT) = range(
    AUDIT_END + 12, AUDIT_END + 17
)

# --- per frame: low-pass filters of those means (two past inputs, two past outputs each)
FILTER = AUDIT_END + 17
FILTER_ROWS = 4
FILTERS = 5
FILTERS_END = FILTER + FILTERS * FILTER_ROWS
(
    PEAK_LATERAL_FILTERED,
    LOWEST_LOAD,  # low-passed load of one side
    PEAK_DERAILMENT_COEFFICIENT,  # low-passed Y/Q
    PEAK_CLEARANCE,  # flange tip above the rail's crown, m
    ON_TRACK,  # 1, or 0 once the vehicle has derailed and left the model
    TIME,
    UNCONVERGED,  # steps in which the hinge's iteration did not converge
    DIVERGED,  # 1 once a state has left every plausible bound
    FLAGS,  # sum of 2^k over the events that hold at this frame
    UPLIFTS,  # number of times that uplift began
    UPLIFT_END,  # when it last ended, s
    LEAVING,  # 1 at the frame at which the vehicle leaves the model
) = range(FILTERS_END, FILTERS_END + 12)
# when each event first held, s; negative: never
FIRST_TIME = FILTERS_END + 12
EVENTS = 6
(FLANGE_CONTACT, UPLIFT, ONSET, FLANGE_OVER, DERAILED, OVERTURNED) = range(EVENTS)

# --- prescribed track: cubics of the place within the frame for y, z, phi; that place, its step
TRACK_CUBIC = FIRST_TIME + EVENTS
(TRACK_PLACE, TRACK_RATE) = range(TRACK_CUBIC + 12, TRACK_CUBIC + 14)

VEHICLE = TRACK_CUBIC + 14
VEHICLE_BLOCKS = 5
