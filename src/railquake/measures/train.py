"""Measures of the train, until it leaves the track."""

from railquake.measures.declaration import AttributeOf, Kind, Measure, StateRow, WorkedOut

__all__ = ["TRAIN"]

TRAIN: tuple[Measure, ...] = (
    Measure(
        "relative_roll_peak_rad", Kind.TRAIN, "rad", "relative roll", "peak relative roll",
        factor=1e3, shown_unit="mrad", meaning="roll of the wheelset against the track",
        place=StateRow("PEAK_ROLL"),
    ),
    Measure(
        "body_roll_peak_rad", Kind.TRAIN, "rad", "body roll", "peak roll of the car body",
        factor=1e3, shown_unit="mrad",
        meaning="roll of the heaviest body above the wheelset, against the track. Once a frame",
        place=StateRow("PEAK_BODY_ROLL"),
    ),
    Measure(
        "body_acceleration_peak_m_s2", Kind.TRAIN, "m/s2", "body acceleration",
        "peak acceleration of the car body",
        meaning="lateral, absolute, of that body's centre of gravity. Once a frame",
        place=StateRow("PEAK_BODY_A"),
    ),
    Measure(
        "suspension_travel_peak_m", Kind.TRAIN, "m", "suspension travel",
        "peak travel of the suspension",
        factor=1e3, shown_unit="mm", optional=True,
        meaning="the larger of the two below; None for a wheelset by itself",
        place=WorkedOut("suspension_travel"),
    ),
    Measure(
        "primary_travel_peak_m", Kind.TRAIN, "m", "primary travel",
        "peak travel of the primary suspension",
        factor=1e3, shown_unit="mm", optional=True,
        meaning="lateral, between wheelset and the body on it, at the level of the lateral "
        "springs. Once a frame",
        place=WorkedOut("primary_travel"),
    ),
    Measure(
        "secondary_travel_peak_m", Kind.TRAIN, "m", "secondary travel",
        "peak travel of the secondary suspension",
        factor=1e3, shown_unit="mm", optional=True,
        meaning="the same between that body and the one above it",
        place=WorkedOut("secondary_travel"),
    ),
    Measure(
        "uplift_ratio", Kind.TRAIN, "1", "uplift ratio", "normalised uplift",
        meaning="the relative roll over the reference roll of the wheel-rail pair (0.836° for "
        "`bart`); 1 is the onset of slide-off",
        place=WorkedOut("uplift_ratio"), step_floor=0.05, paired=True,
    ),
    Measure(
        "lateral_shift_peak_m", Kind.TRAIN, "m", "lateral shift", "peak lateral shift",
        factor=1e3, shown_unit="mm", meaning="of the wheelset's centre, in the track's axes",
        place=StateRow("PEAK_SHIFT"),
    ),
    Measure(
        "wheel_load_static_n", Kind.TRAIN, "N", "static load", "static load of one side",
        factor=1e-3, shown_unit="kN",
        meaning="half the car's weight: what one side bears at rest on a level track",
        place=AttributeOf("system.static_wheel_load"),
    ),
    Measure(
        "wheel_load_peak_n", Kind.TRAIN, "N", "wheel load", "peak load of one side",
        factor=1e-3, shown_unit="kN",
        meaning="of all wheels of one side together, normal to the plane of the track, raw",
        place=StateRow("PEAK_LOAD"),
    ),
    Measure(
        "stop_use_peak", Kind.TRAIN, "1", "use of stops", "largest use of a bump stop",
        optional=True,
        meaning="largest travel of a stop over that at which its table ends; beyond 1 its last "
        "slope has gone on. None for a car without such stops",
        place=WorkedOut("stop_use"),
    ),
    Measure(
        "wheel_unloading_peak", Kind.TRAIN, "1", "unloading", "peak unloading of one side",
        meaning="1 minus the lowest low-passed load of a side over the static one; 1: unloaded",
        place=WorkedOut("wheel_unloading"),
    ),
    Measure(
        "load_ratio_left_least", Kind.TRAIN, "1", "Q/P left", "least load ratio, left",
        meaning="lowest low-passed load of the left wheels over the static one, Q/P",
        place=WorkedOut("load_ratio_left"),
    ),
    Measure(
        "load_ratio_right_least", Kind.TRAIN, "1", "Q/P right", "least load ratio, right",
        meaning="of the right wheels", place=WorkedOut("load_ratio_right"),
    ),
    Measure(
        "lateral_force_peak_n", Kind.TRAIN, "N", "raw lateral force", "peak lateral force, raw",
        factor=1e-3, shown_unit="kN", meaning="of the train on the track, both sides together, raw",
        place=StateRow("PEAK_LATERAL"),
    ),
    Measure(
        "lateral_force_filtered_peak_n", Kind.TRAIN, "N", "lateral force",
        "peak lateral force, impacts filtered",
        factor=1e-3, shown_unit="kN",
        meaning="the same through a second-order Butterworth low-pass "
        "(`solver.lateral_force_filter`, 20 Hz) of the means over frames: short impacts out, the "
        "paper's Figure 10",
        place=StateRow("PEAK_LATERAL_FILTERED"), paired=True,
    ),
    Measure(
        "lateral_force_tread_peak_n", Kind.TRAIN, "N", "lateral force of treads",
        "peak lateral force while no flange bears",
        factor=1e-3, shown_unit="kN",
        meaning="the same while no flange bears: of frames in which one did, nothing reaches the "
        "low-pass. Friction times weight is the most that treads bear for long",
        place=StateRow("PEAK_LATERAL_TREADS"),
    ),
    Measure(
        "lateral_force_sustained_peak_n", Kind.TRAIN, "N", "sustained lateral force",
        "peak mean of the lateral force while no flange bears",
        factor=1e-3, shown_unit="kN",
        meaning="largest mean over 0.3 s in which no flange bore, each 30 ms; zero if there were "
        "none",
        place=StateRow("PEAK_LATERAL_SUSTAINED"),
    ),
    Measure(
        "derailment_coefficient_peak", Kind.TRAIN, "1", "Y/Q", "peak derailment coefficient",
        meaning="low-passed Y/Q of a side, where the low-passed load is above a tenth of the "
        "static one",
        place=StateRow("PEAK_DERAILMENT_COEFFICIENT"),
    ),
    Measure(
        "flange_climb_peak", Kind.TRAIN, "1", "flange climb", "peak Y/Q over 2 m",
        meaning="the larger of the two below; EN 14363's limit is 0.8",
        place=WorkedOut("flange_climb"),
    ),
    Measure(
        "flange_climb_left_peak", Kind.TRAIN, "1", "flange climb left", "peak Y/Q over 2 m, left",
        meaning="largest mean over 2 m of the way of low-passed Y/Q of the left wheels towards "
        "their flange, each 0.2 m; of a train slower than `wheelrail.speed_bound` of each frame",
        place=StateRow("PEAK_CLIMB_LEFT"),
    ),
    Measure(
        "flange_climb_right_peak", Kind.TRAIN, "1", "flange climb right",
        "peak Y/Q over 2 m, right",
        meaning="of the right wheels", place=StateRow("PEAK_CLIMB_RIGHT"),
    ),
    Measure(
        "flange_climb_time_left_s", Kind.TRAIN, "s", "time of climb left",
        "longest time of flange climb, left",
        factor=1e3, shown_unit="ms",
        meaning="longest time without interruption for which raw Y/Q of the left wheels towards "
        "their flange is above 0.8, of all time steps; Japanese practice allows 15 ms",
        place=StateRow("LONGEST_CLIMB_LEFT"),
    ),
    Measure(
        "flange_climb_time_right_s", Kind.TRAIN, "s", "time of climb right",
        "longest time of flange climb, right",
        factor=1e3, shown_unit="ms",
        meaning="of the right wheels", place=StateRow("LONGEST_CLIMB_RIGHT"),
    ),
    Measure(
        "flange_clearance_peak_m", Kind.TRAIN, "m", "flange clearance", "highest flange clearance",
        factor=1e3, shown_unit="mm",
        meaning="highest place of a flange tip above its rail's crown, from the profiles; "
        "negative: it stayed below. Once a frame",
        place=StateRow("PEAK_CLEARANCE"),
    ),
    Measure(
        "off_rail_time_s", Kind.TRAIN, "s", "off rail", "time off the rail",
        meaning="total time with at least one side off its rail", place=StateRow("TIME_ONE_WHEEL"),
    ),
    Measure(
        "detached_time_s", Kind.TRAIN, "s", "detached", "time off both rails",
        meaning="total time with both sides off", place=StateRow("TIME_DETACHED"),
    ),
    Measure(
        "uplifts", Kind.TRAIN, "1", "uplifts", "number of uplifts",
        value=int, meaning="number of times that uplift began, not counted again within 50 ms of "
        "its last end",
        place=StateRow("UPLIFTS"),
    ),
)  # fmt: skip
"""In the order of a table's columns."""
