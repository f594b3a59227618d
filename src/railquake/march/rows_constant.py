"""The rows of the constants ``Q[row, lane]``: everything of a run that stays fixed."""

from railquake.march.declaration import Row, block, row
from railquake.measures.housner import PERIODS

__all__ = ["CONSTANT_GROUPS", "CONSTANT_ROWS", "STAGES"]

STAGES = ("primary", "secondary")  # of the suspension, from the wheelset upwards

_AXIS = (
    ("FINE", "fine within +- this"),
    ("END", "and ends at +- this"),
    ("FINE_RATE", "fine cells per unit"),
    ("COARSE_RATE", "coarse cells per unit"),
    ("COARSE_CELLS", "coarse cells on each side"),
    ("INNER_CELLS", "fine cells"),
)

_TIME = (
    row("DT", "s", "time step of the wheelset on its rails"),
    row("FRAME_STEPS", "1", "time steps in a frame"),
    row("SUBSTEPS", "1", "time steps in one of structure and sprung bodies"),
    row("RATE", "1/s", "1/(SUBSTEPS dt)"),
)

# symmetric matrices as the rows of their upper triangles (`packed`)
_STRUCTURE = (
    row("GROUND_LOAD", "kg", "what the ground's acceleration acts on", rows="STRUCTURE"),
    row("MASS", "kg or kg m2", "masses and inertias (Eq. 9)", rows="STRUCTURE"),
    row("K", "N/m, N or N m", "stiffness, hinge apart (Eq. 10)", rows="STRUCTURE_ENTRIES"),
    row("C", "N s/m, N s or N m s", "damping, hinge apart", rows="STRUCTURE_ENTRIES"),
    block(
        "HINGE_DAMPING",
        "of the hinge itself (`pier.HingeDamping`)",
        (
            ("DAMPING_CONSTANT", "N m s", "whatever the hinge does"),
            ("DAMPING_PER_TANGENT", "s", "times the hinge's tangent"),
        ),
    ),
    row("FLEX", "m/N, 1/N or 1/(N m)", "inverse of Newmark's matrix", rows="STRUCTURE_ENTRIES"),
    block(
        "OFFSET",
        "of the track from the node that carries it (`track.Offset`)",
        (
            ("MAP_U", "1", "Y_t = MAP_U u + MAP_H phi"),
            ("MAP_H", "m", "height"),
            ("MAP_E", "m", "Z_t = MAP_E phi"),
            ("MAP_PHI", "1", "phi_t = MAP_PHI phi, phi = -theta_2"),
        ),
    ),
    row("REACTION", "1", "1: the contact forces act on the pier; 0: they do not"),
)

_CONTACT = (
    row("ZHAI_PSI", "1", "psi of Eq. 2"),
    row("ZHAI_PHI", "1", "phi of Eq. 3"),
    row("GRAVITY", "m/s2", "standard gravity"),
    row("WHEELSET_HEIGHT", "m", "wheelset's centre of gravity above the rail crowns"),
    row("AXLES", "1", "wheels a side that the section stands for"),
    row("AXLE_INERTIA", "kg m2", "of one wheelset about its axle, J_y"),
    block(
        "CONTACT",
        "material and speed (`patch.Contact`)",
        (
            ("ALPHA_R", "1", "of the restitution law"),
            ("ONSET_BOUND", "m/s", "least rate at the onset of a contact"),
            ("FRICTION", "1", "mu"),
            ("INVERSE_SPEED", "s/m", "1/max(V, bound)"),
            ("SPEED", "m/s", "V"),
        ),
    ),
    block(
        "RUNNING_CIRCLE",
        "of the contact table (`contact_table.RunningCircle`)",
        (
            ("HALF_SPACING", "m", "half the contact spacing as drawn"),
            ("NOMINAL_RADIUS", "m", "of the wheels"),
        ),
    ),
    block(
        "DISPLACEMENT_AXIS",
        "of the contact table (`contact_table.AxisCells`)",
        [(f"DISPLACEMENT_{name}", "m or 1/m", meaning) for name, meaning in _AXIS],
    ),
    block(
        "ROLL_AXIS",
        "of the contact table (`contact_table.AxisCells`)",
        [(f"ROLL_{name}", "rad or 1/rad", meaning) for name, meaning in _AXIS],
    ),
)

_MEASURES = (
    block(
        "LIMITS",
        "thresholds of events (`derailment.Limits`)",
        (
            ("RAIL_CENTRE", "m", "half the distance between the rails' centre lines"),
            ("SLIDE_LIMIT", "m", "displacement of a bearing wheel that counts as derailed"),
            ("BODY_LIMIT", "m", "centre of gravity's, where a linear car's model ends"),
        ),
    ),
    row("REFERENCE_ROLL", "rad", "relative roll at the paper's onset of slide-off"),
    row("TIP_Y", "m", "flange tip in wheelset axes of the right-hand wheel, right"),
    row("TIP_Z", "m", "flange tip in wheelset axes of the right-hand wheel, down"),
    row("STATIC_WHEEL_LOAD", "N", "of one side of the section"),
    row("VEHICLE_MASS", "kg", "of all bodies"),
    block(
        "FILTER_BY",
        "low-pass of the frame means (`low_pass.Coefficients`)",
        [(f"FILTER_{name}", "1", f"{name.lower()}") for name in ("B0", "B1", "B2", "A1", "A2")],
    ),
    row("CLIMB_WINDOW", "1", "of the mean of Y/Q (`sliding_mean.Window`)", rows=2),
    row("SUSTAINED_WINDOW", "1", "of the mean of the lateral force", rows=2),
    row(
        "SWING_BY",
        "1",
        "a frame's step of each oscillator on the track (`oscillator.Step`)",
        rows=4 * len(PERIODS),
    ),
)

# in the order of `march.order`
_VEHICLE = (
    row("BODY_MASS", "kg", "of each body", rows="BODIES"),
    row("INVERSE_MASS", "1/kg or 1/(kg m2)", "of each degree of freedom", rows="DOFS"),
    row("STIFFNESS", "N/m, N or N m", "K_v", rows="VEHICLE_ENTRIES"),
    row("DAMPING", "N s/m, N s or N m s", "C_v", rows="VEHICLE_ENTRIES"),
    row("MEASURED_BODY", "1", "number of the heaviest body on the wheelset"),
    # both bodies are the first where there is no such stage
    row(
        "STAGE_UPPER",
        "1",
        "of each stage of the suspension: number of its upper body",
        rows=len(STAGES),
    ),
    row("STAGE_LOWER", "1", "number of its lower body", rows=len(STAGES)),
    row("STAGE_TIES", "m", "points at its springs' level (`joint.Tie`)", rows=4 * len(STAGES)),
    row("STAGE_GAPS", "m", "d_0 of each stage, y and z", rows=2 * len(STAGES)),
)

# from the inputs by themselves: nothing that moves a body reads them (`momentum`)
_MOMENTUM = (
    row("AUDIT_AXLES", "1", "wheels a side that the section stands for"),
    row("AUDIT_MASS", "kg", "of each body", rows="BODIES"),
    row("AUDIT_INERTIA", "kg m2", "of each body", rows="BODIES"),
    row("AUDIT_HEIGHT", "m", "of each body above the track's origin at rest", rows="BODIES"),
    row("COUPLE_STIFFNESS", "N or N m", "of a linear car's springs with ends apart", rows="DOFS"),
    row("COUPLE_DAMPING", "N s or N m s", "of its dashpots with ends apart", rows="DOFS"),
)

# of a car with finite rotations (`joints`), one after the other
_JOINTS = (
    row("TIES", "m", "points of each element (`joint.Tie`)", rows="TIE_ROWS"),
    row("GAPS", "m", "d_0 of each element, y and z", rows="GAP_ROWS"),
    row("SPRINGS", "SI", "springs and dashpots (`joint.JointSpring`)", rows="SPRING_ROWS"),
    row("STOP_SIDES", "1, 1 and N s/m", "of each stop (`joint.Sides`)", rows="SIDES_ROWS"),
    row("STOP_END", "m", "travel at which each stop's table ends", rows="STOPS"),
    row("RAMP_TRAVEL", "m", "where each stop's stiffness changes", rows="RAMP_ROWS"),
    row("RAMP_SLOPE", "N/m", "and by how much", rows="RAMP_ROWS"),
    row("KNEES", "m/s and N s/m", "knee, damping below and beyond it", rows="KNEE_ROWS"),
)

CONSTANT_GROUPS: dict[str, tuple[Row, ...]] = {
    "time steps": _TIME,
    "structure": _STRUCTURE,
    "contact": _CONTACT,
    "measures": _MEASURES,
    "vehicle": _VEHICLE,
    "momentum": _MOMENTUM,
    "joints": _JOINTS,
}
CONSTANT_ROWS: tuple[Row, ...] = tuple(row for group in CONSTANT_GROUPS.values() for row in group)
# the hinge's own rows follow: `rows.hinge_parts`
