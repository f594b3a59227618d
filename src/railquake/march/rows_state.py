"""The rows of the state ``S[row, lane]``: everything of a run that changes with time."""

from railquake.march.declaration import Row, block, row
from railquake.measures import MEASURES, StateRow
from railquake.measures.housner import PERIODS
from railquake.physics.derailment import EVENTS
from railquake.physics.sliding_mean import BLOCKS

__all__ = ["FILTERED", "PATCHES", "POWERS", "SLIDING", "STATE_GROUPS", "STATE_ROWS"]

PATCHES = ("left tread", "left flange", "right tread", "right flange")
POWERS = ("impact", "creep", "spin", "forward")
FILTERED = (
    "lateral force", "load left", "load right", "lateral left", "lateral right",
    "lateral force of treads",
)  # fmt: skip
SLIDING = ("Y/Q left", "Y/Q right", "lateral force of treads")

_GROUND = (
    row("GROUND", "m/s2", "ground acceleration, lateral", "ground_acceleration_m_s2"),
    row("GROUND_SLOPE", "m/s2", "its change per step of the structure"),
    row("GROUND_Z", "m/s2", "ground acceleration, down", "ground_acceleration_down_m_s2"),
    row("GROUND_Z_SLOPE", "m/s2", "its change per step of the structure"),
    row("GROUND_V", "m/s", "ground velocity, lateral, its least-squares line removed"),
)

# Eqs. 9, 10: of the pier u, theta_1 at the base and theta_2 at the top; of any structure the
# displacement and the rotation of the node that carries the track, and the hinge's rotation
_STRUCTURE = (
    block(
        "STRUCTURE_X",
        "displacements",
        (
            ("U", "m", "pier top relative to the ground", "bridge_displacement_m", "TOP"),
            (
                "THETA1", "rad", "rotation of the plastic hinge, theta_1", "hinge_rotation_rad",
                "HINGE",
            ),
            (
                "THETA2", "rad", "rotation of the pier's top, theta_2", "top_rotation_rad",
                "TOP_ROLL",
            ),
        ),
        rows="STRUCTURE",
    ),
    block(
        "STRUCTURE_V",
        "velocities",
        (
            ("U_V", "m/s", "pier top relative to the ground", "bridge_velocity_m_s", "TOP"),
            ("THETA1_V", "rad/s", "rate of theta_1", None, "HINGE"),
            ("THETA2_V", "rad/s", "rate of theta_2", None, "TOP_ROLL"),
        ),
        rows="STRUCTURE",
    ),
    block(
        "STRUCTURE_A",
        "accelerations, relative to the ground",
        (
            ("U_A", "m/s2", "pier top, absolute", "bridge_acceleration_m_s2", "TOP"),
            ("THETA1_A", "rad/s2", "of theta_1", None, "HINGE"),
            ("THETA2_A", "rad/s2", "of theta_2", None, "TOP_ROLL"),
        ),
        rows="STRUCTURE",
    ),
    row("UNBALANCED", "N or N m", "what a step's increments must balance", rows="STRUCTURE"),
    row("STRUCTURE_STEP", "m or rad", "increments of the last step", rows="STRUCTURE"),
    row("MOMENT", "N m", "moment of the hinge", "base_moment_n_m"),
    row("TANGENT", "N m/rad", "tangent of the hinge"),
    row("DAMPING_MOMENT", "N m", "of the hinge's damping, beside its own", "damping_moment_n_m"),
)  # fmt: skip

_TRACK = (
    block(
        "TRACK",
        "track's origin within the structure's step",
        (
            ("TRACK_Y", "m", "track's origin, right", "track_lateral_m"),
            ("TRACK_Z", "m", "track's origin, down", "track_vertical_m"),
            ("TRACK_PHI", "rad", "track's roll, right side down", "track_roll_rad"),
        ),
    ),
    block(
        "TRACK_V",
        "its velocity",
        (
            ("TRACK_VY", "m/s", "right"),
            ("TRACK_VZ", "m/s", "down"),
            ("TRACK_VPHI", "rad/s", "roll"),
        ),
    ),
    row("TRACK_A", "m/s2 or rad/s2", "its acceleration during the structure's step", rows=3),
    row("TRACK_V_BEGUN", "m/s", "its lateral velocity at the frame's begin, the ground's added"),
    row("SWING_RE", "m/s", "oscillators on the track, one a period: real part", rows=len(PERIODS)),
    row("SWING_IM", "m/s", "imaginary part", rows=len(PERIODS)),
    row("PEAK_SWING", "m/s", "largest imaginary part", rows=len(PERIODS)),
    row("TRACK_SIN", "1", "sine of its roll"),
    row("TRACK_COS", "1", "cosine of its roll"),
)

_WHEELSET = (
    block(
        "ARM",
        "wheelset's centre from the track's origin in ground axes",
        (("ARM_Y", "m", "right"), ("ARM_Z", "m", "down")),
    ),
    row(
        "SHIFT", "m", "wheelset relative to the track, right; NaN once it has left the track",
        "lateral_shift_m", train=True,
    ),
    row("HEIGHT", "m", "wheelset's centre in track axes, down", "wheelset_height_m", train=True),
    row("ROLL", "rad", "wheelset relative to the track", "relative_roll_rad", train=True),
    row("SHIFT_V", "m/s", "rate of the shift"),
    row("HEIGHT_V", "m/s", "rate of the height"),
    row("ROLL_V", "rad/s", "rate of the roll"),
    row("ROLL_SIN", "1", "sine of the relative roll"),
    row("ROLL_COS", "1", "cosine of the relative roll"),
    row("AXLE_RATE", "rad/s", "of each wheelset about its axle", "axle_rate_rad_s", train=True),
    row("AXLE_MOMENT", "N m", "of the contact forces on a wheelset about its axle"),
    row("AXLE_DAMPING", "N m s", "how much that moment falls per axle's rate"),
)  # fmt: skip

# the contact table's cell of each side (left, right); the axis of the roll is symmetric
_CELLS = (
    row("CELL_BASE", "1", "first number of the cell in the table", rows=2),
    row("CELL_DISPLACEMENT", "1", "place within the cell along the displacement", rows=2),
    row("CELL_DISPLACEMENT_RATE", "1/m", "cells per metre", rows=2),
    row("CELL_ROLL", "1", "place within the cell along the roll", rows=2),
    row("CELL_ROLL_RATE", "1/rad", "cells per radian", rows=2),
    row("CELL_HELD", "1", "the cell whose polynomials are at hand; -1: none", rows=2),
    row("POLYNOMIALS", "SI", "`contact_table.Polynomials` of each patch", rows="POLYNOMIAL_ROWS"),
)

_PATCHES = (
    row("PATCH_HYSTERESIS", "s/m", "chi/K of each patch; 0 while open", rows=len(PATCHES)),
    block(
        "PATCH_PENETRATION",
        "vertical penetration of each patch",
        tuple(
            (
                f"PENETRATION_{patch.replace(' ', '_').upper()}",
                "m",
                f"vertical, {patch}" + ("; negative: gap" if patch == PATCHES[0] else ""),
                f"penetration_{patch.replace(' ', '_')}_m",
            )
            for patch in PATCHES
        ),
        train=True,
    ),
    row("NEAR", "1", "1 for each side whose flange may touch before the next look", rows=2),
)

_FORCES = tuple(
    one._replace(released=True)
    for one in (
        # all wheels of the section: on the wheelset, in track axes
        row("FORCE_Y", "N", "of the train on the track", "lateral_force_n"),
        row("FORCE_Z", "N", "contact force on the wheelset, down"),
        row("FORCE_PSI", "N m", "its moment about the wheelset's centre"),
        row("HERTZ_ENERGY", "J", "elastic energy of the contacts"),
        block(
            "CONTACT_POWER",
            "powers of the contact",
            (
                ("IMPACT_POWER", "W", "lost to the normal force's hysteresis"),
                ("CREEP_POWER", "W", "lost to creepage"),
                ("SPIN_POWER", "W", "brought in by spin"),
                ("FORWARD_POWER", "W", "brought in against longitudinal creepage"),
            ),
        ),
        row("CONTACT_POWER_OLD", "W", "the same, one time step before", rows=len(POWERS)),
        block(
            "LOAD",
            "vertical load of the wheels of each side on their rail",
            (
                ("LOAD_LEFT", "N", "vertical load of the left wheels", "wheel_load_left_n"),
                ("LOAD_RIGHT", "N", "vertical load of the right wheels", "wheel_load_right_n"),
            ),
        ),
        block(
            "LATERAL",
            "lateral force of the wheels of each side on their rail",
            (("LATERAL_LEFT", "N", "left wheels"), ("LATERAL_RIGHT", "N", "right wheels")),
        ),
        block(
            "WHEELSET_FORCE",
            "contact force on the wheelset in ground axes",
            (
                ("WHEELSET_Y", "N", "right"),
                ("WHEELSET_Z", "N", "down"),
                ("WHEELSET_PHI", "N m", "roll"),
            ),
        ),
        row("WHEELSET_FORCE_OLD", "N or N m", "the same, one time step before", rows=3),
        block(
            "TRACK_FORCE",
            "what acts on the track's origin during a step of the structure",
            (("TRACK_FY", "N", "right"), ("TRACK_FZ", "N", "down"), ("TRACK_MX", "N m", "roll")),
        ),
        row("TRACK_FORCE_OLD", "N or N m", "the same during the step before", rows=3),
        row("TRACK_CONTACT", "N or N m", "contact force on it at that step's begin", rows=3),
        block(
            "NODE",
            "the train's force on the structure",
            (
                ("NODE_U", "N", "on the top, right", None, "TOP"),
                ("NODE_THETA2", "N m", "on the top's rotation", None, "TOP_ROLL"),
            ),
            rows="STRUCTURE",
        ),
    )
)

_SUSPENSION = (
    row("WHEELSET_FREE", "m/s2 or rad/s2", "wheelset's acceleration but for the contact", rows=3),
    row("WHEELSET_FREE_KNOWN", "m/s2 or rad/s2", "the same as last evaluated", rows=3),
    row("WHEELSET_FREE_SLOPE", "m/s2 or rad/s2", "its change per time step", rows=3),
    block(
        "WHEELSET_FROM",
        "where the wheelset was before the structure's step",
        (("WHEELSET_FROM_Y", "m", "right"), ("WHEELSET_FROM_Z", "m", "down")),
    ),
)

_ENERGY = (
    row("WORK_GROUND", "J", "work of the effective ground forces"),
    row("WORK_GRAVITY", "J", "work of gravity"),
    row("WORK_VEHICLE", "J", "work of the contact forces on the vehicle"),
    row("WORK_TRACK", "J", "work of the contact forces on the track"),
    row("LOST_RAYLEIGH", "J", "lost to structural damping"),
    row("LOST_DASHPOTS", "J", "lost to the dashpots"),
    row("HINGE_ENERGY", "J", "integral of the hinge's moment over its rotation"),
    block(
        "CONTACT_LOST",
        "integrals of the contact's powers",
        (
            ("LOST_IMPACT", "J", "lost to the normal force's hysteresis"),
            ("LOST_CREEP", "J", "lost to creepage"),
            ("SPIN_INPUT", "J", "brought in by the train's forward motion, by spin"),
            ("FORWARD_INPUT", "J", "the same, against longitudinal creepage"),
        ),
    ),
    row("DASHPOT_POWER", "W", "of the dashpots", released=True),
    row("DASHPOT_POWER_OLD", "W", "the same, one step before"),
    row("VEHICLE_ENERGY", "J", "kinetic and elastic, kept when the vehicle leaves the model"),
    row("HERTZ_LEFT", "J", "Hertz energy that goes with it"),
)

# of the whole car, in ground axes and about the place of the track's origin at rest (`momentum`)
_MOMENTUM = (
    row("PATCH_MOMENTS", "N m", "of the rails on one wheelset, about the track's origin"),
    block(
        "RAILS",
        "force of the rails on the car, as its patches give it",
        (("RAILS_Y", "N", "right"), ("RAILS_Z", "N", "down"), ("RAILS_PHI", "N m", "roll")),
        released=True,
    ),
    block(
        "RAILS_IMPULSE",
        "impulse of the rails, the last force counted whole",
        (
            ("PUSHED_Y", "N s", "right"),
            ("PUSHED_Z", "N s", "down"),
            ("PUSHED_PHI", "N m s", "roll"),
        ),
    ),
    block(
        "SHAKEN",
        "impulse of the effective forces of the ground",
        (
            ("SHAKEN_Y", "N s", "right"),
            ("SHAKEN_Z", "N s", "down"),
            ("SHAKEN_PHI", "N m s", "roll"),
        ),
    ),
    block(
        "WEIGHED",
        "impulse of gravity",
        (("WEIGHED_Z", "N s", "down"), ("WEIGHED_PHI", "N m s", "roll")),
    ),
    row("OMITTED", "N m s", "impulse of gravity's moment that the car's equations leave out"),
    row("COUPLED_PHI", "N m s", "impulse of springs with ends at two heights; of a linear car"),
    block(
        "UNEXPLAINED",
        "momentum less impulses at the frame's begin",
        (
            ("UNEXPLAINED_Y", "N s", "right"),
            ("UNEXPLAINED_Z", "N s", "down"),
            ("UNEXPLAINED_PHI", "N m s", "roll"),
        ),
    ),
    block(
        "MOMENTUM_LEFT",
        "what the impulses do not explain, added up over the frames",
        (("LEFT_Y", "N s", "right"), ("LEFT_Z", "N s", "down"), ("LEFT_PHI", "N m s", "roll")),
    ),
    row("PEAK_LINEAR_LEFT", "N s", "the largest of that along y or z"),
    row("PEAK_ANGULAR_LEFT", "N m s", "the largest of that in roll"),
    row("PEAK_IMPULSE", "N s", "largest impulse, the rails' without the weight"),
    row("PEAK_TURNING", "N m s", "largest impulse of a moment"),
    row("PEAK_OMITTED", "N m s", "largest impulse of the moment that is left out"),
)

_FRAME = (
    block(
        "SUM",
        "sums over the frame of what is low-passed, in the order of `FILTERED`",
        (
            ("SUM_LATERAL", "N", "lateral force on the track"),
            ("SUM_LOAD_LEFT", "N", "load of the left wheels"),
            ("SUM_LOAD_RIGHT", "N", "load of the right wheels"),
            ("SUM_LATERAL_LEFT", "N", "lateral force of the left wheels"),
            ("SUM_LATERAL_RIGHT", "N", "lateral force of the right wheels"),
            ("SUM_TREADS", "N", "lateral force on the track if no flange bears, else 0"),
        ),
    ),
    block(
        "FILTER_X1",
        "low-pass filters: last input, means over the frame",
        (("MEAN_TREADS", "N", "of `SUM_TREADS`", None, len(FILTERED) - 1),),
        rows=len(FILTERED),
    ),
    row("FILTER_X2", "N", "input before", rows=len(FILTERED)),
    block(
        "FILTER_Y1",
        "last output",
        (
            ("LATERAL_FILTERED", "N", "the same, low-passed", "lateral_force_filtered_n"),
            ("LOAD_LEFT_FILTERED", "N", "low-passed", "wheel_load_left_filtered_n"),
            ("LOAD_RIGHT_FILTERED", "N", "low-passed", "wheel_load_right_filtered_n"),
            ("LATERAL_LEFT_FILTERED", "N", "low-passed"),
            ("LATERAL_RIGHT_FILTERED", "N", "low-passed"),
            ("TREADS_FILTERED", "N", "low-passed"),
        ),
        rows=len(FILTERED),
    ),
    row("FILTER_Y2", "N", "output before", rows=len(FILTERED)),
    row("PEAK_LATERAL_FILTERED", "N", "largest low-passed lateral force"),
    row("FLANGE_BORE", "m", "largest penetration of a flange in this frame; 0: none bore"),
    row("CLIMB_TIME_LEFT", "s", "for how long Y/Q of the left wheels has been above its limit"),
    row("CLIMB_TIME_RIGHT", "s", "of the right wheels"),
    # sliding means, in the order of `SLIDING` (`sliding_mean.Filling`)
    row("BLOCK_SHARE", "1", "how full the block is that is being filled", rows=len(SLIDING)),
    row("BLOCK_PART", "1 or N", "its mean times that", rows=len(SLIDING)),
    row("BLOCKS_BEFORE", "1", "blocks filled before it", rows=len(SLIDING)),
    row("BLOCK_MEAN", "1 or N", "means of a window's blocks", rows=BLOCKS * len(SLIDING)),
    row("PEAK_PRIMARY_TRAVEL", "m", "largest lateral travel of the primary suspension"),
    row("PEAK_SECONDARY_TRAVEL", "m", "of the secondary suspension"),
    row("LOWEST_LOAD_LEFT", "N", "least low-passed load of the left wheels"),
    row("LOWEST_LOAD_RIGHT", "N", "least low-passed load of the right wheels"),
    row("PEAK_DERAILMENT_COEFFICIENT", "1", "largest low-passed Y/Q"),
    row("PEAK_CLEARANCE", "m", "flange tip above the rail's crown at its highest"),
    row("ON_TRACK", "1", "1, or 0 once the vehicle has derailed and left the model"),
    row("FRAMES", "1", "frames marched"),
    row("TIME", "s", "at the frame's end"),
    row("UNCONVERGED", "1", "steps in which the hinge's equation was not solved"),
    row("DIVERGED", "1", "1 once a state has left every plausible bound"),
    row("FLAGS", "1", "sum of 2^k over the events k that hold", "events"),
    row("UPLIFTS", "1", "number of times that uplift began"),
    row("UPLIFT_END", "s", "when uplift last ended; negative: never"),
    row("LEAVING", "1", "1 at the frame at which the vehicle leaves the model"),
    row("LEFT_TIME", "s", "when it left the model; negative: it did not"),
    row("FIRST_TIME", "s", "when each event first held; negative: never", rows=len(EVENTS)),
    row("FIRST_SIDE", "1", "to which side it did; -1 left, 1 right", rows=len(EVENTS)),
    row("FIRST_DISPLACEMENT", "m", "where the bearing wheel was, right", rows=len(EVENTS)),
    row("FIRST_ROLL", "rad", "the relative roll at that time", rows=len(EVENTS)),
    row("DERAILED_TIME", "s", "when it derailed, however; negative: it did not"),
    row("PASSED_CROWN", "1", "how each side's flange came over (`passed_crown`)", rows=2),
    row("BEYOND_TIME", "s", "when it came to where the model ends; negative: never"),
    row("BEYOND_REASON", "1", "why, `derailment.BEYOND` from 1"),
)

# a cubic of the place within the frame for y, z and phi
_PRESCRIBED = (
    row("TRACK_C0", "m or rad", "prescribed track: constant", rows=3),
    row("TRACK_C1", "m or rad", "linear coefficient", rows=3),
    row("TRACK_C2", "m or rad", "quadratic coefficient", rows=3),
    row("TRACK_C3", "m or rad", "cubic coefficient", rows=3),
    row("TRACK_PLACE", "1", "place within the frame, 0 to 1"),
    row("TRACK_RATE", "1/s", "one over the frame's length"),
)

# in the order of `march.order`
_VEHICLE = (
    row("VEHICLE_X", "m or rad", "displacement of each degree of freedom", rows="DOFS", train=True),
    row("VEHICLE_V", "m/s or rad/s", "velocity", rows="DOFS", released=True),
    row("VEHICLE_A", "m/s2 or rad/s2", "acceleration", rows="DOFS", released=True),
    row("VEHICLE_A_OLD", "m/s2 or rad/s2", "acceleration before", rows="DOFS", released=True),
    row("VEHICLE_STEP", "m or rad", "last increment of the displacement", rows="DOFS"),
)
# of a car with finite rotations (`joints`)
_JOINTS = (
    row("BODY_SIN", "1", "sine of each body's roll", rows="TURNED"),
    row("BODY_COS", "1", "its cosine", rows="TURNED"),
    row("STOP_TRAVEL", "m", "largest travel of each stop", rows="STOPS"),
)

_BEFORE = {
    "ground": _GROUND,
    "structure": _STRUCTURE,
    "track": _TRACK,
    "wheelset": _WHEELSET,
    "cells of the contact table": _CELLS,
    "patches": _PATCHES,
    "forces": _FORCES,
    "suspension between its evaluations": _SUSPENSION,
    "energy": _ENERGY,
    "momentum": _MOMENTUM,
}
_AFTER = {"frame": _FRAME, "prescribed track": _PRESCRIBED, "vehicle": _VEHICLE, "joints": _JOINTS}


def _measured() -> tuple[Row, ...]:
    """One row for each measure that is the last value of a row of its own; it begins at zero.

    The measure is its declaration; `peaks` accumulates it.
    """
    declared = {row.name for group in {**_BEFORE, **_AFTER}.values() for row in group}
    return tuple(
        row(measure.place.name, measure.unit, measure.caption)
        for measure in MEASURES
        if isinstance(measure.place, StateRow) and measure.place.name not in declared
    )


STATE_GROUPS: dict[str, tuple[Row, ...]] = {**_BEFORE, "measures": _measured(), **_AFTER}
STATE_ROWS: tuple[Row, ...] = tuple(row for group in STATE_GROUPS.values() for row in group)
# the hinge's own rows follow: `rows.hinge_parts`
