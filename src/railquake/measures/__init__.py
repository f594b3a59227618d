r"""Every measure of a run, declared once: key, unit, names, meaning, and where it is read.

A row (`run.assess.assess`), the columns of a study's table, the axes of reports and pictures, what
uplift and outcomes are held against, pelicun's names and the tables of docs/measures.md all follow
from `MEASURES`.  A new measure of the march takes two files: its declaration, here or in
`measures.train`, which makes its `StateRow`, too, and `march.peaks`, where that is accumulated.
"""

from __future__ import annotations

from railquake.measures.declaration import (
    AttributeOf,
    EventTime,
    Intensity,
    Kind,
    Measure,
    Place,
    StateRow,
    StateTime,
    WorkedOut,
    printed,
)
from railquake.measures.train import TRAIN

__all__ = [
    "MEASURES", "STANDARD_GRAVITY", "AttributeOf", "EventTime", "Intensity", "Kind", "Measure",
    "Place", "StateRow", "StateTime", "WorkedOut", "all_keys", "correlated",
    "intensities", "named", "of_kind", "paired", "printed", "short_name", "telling_of_the_step",
]  # fmt: skip

STANDARD_GRAVITY = 9.80665  # m/s2


MEASURES: tuple[Measure, ...] = (
    # --- how it ended
    Measure(
        "status", Kind.OUTCOME, "", "status", "status",
        value=str,
        meaning="`safe`; `onset`: a lifted flange came above its rail, the train stayed; "
        "`derailed`; `diverged`: a state left every plausible bound, the run was stopped; `not "
        "converged`: the hinge's iteration failed in some step",
        place=AttributeOf("status"),
    ),
    Measure(
        "derailed", Kind.OUTCOME, "", "derailed", "whether the train derailed",
        value=bool, meaning="`true` if the train left its rails, by whatever mode",
        place=WorkedOut("derailed"),
    ),
    Measure(
        "derailment_mode", Kind.OUTCOME, "", "mode", "how the train derailed",
        value=str, optional=True,
        meaning="`slide-off`, `climb`, `overturned` or `combined`, `left` or `right`; see below",
        place=AttributeOf("derailment_mode"),
    ),
    Measure(
        "beyond_model", Kind.OUTCOME, "", "beyond the model", "why the car’s model ends",
        value=str, optional=True,
        meaning="the first reason: a linear car whose centre of gravity is beyond the rail, or a "
        "bump stop past the end of its table; what follows is not to be believed, and it is no "
        "derailment",
        place=AttributeOf("beyond_model"),
    ),
    Measure(
        "sequence", Kind.OUTCOME, "", "sequence", "what happened to the train",
        value=str, meaning="in sentences, as `response.explain()`", place=WorkedOut("sequence"),
    ),
    # --- the ground
    Measure(
        "pga_m_s2", Kind.GROUND, "m/s2", "PGA", "peak ground acceleration",
        factor=1.0 / STANDARD_GRAVITY, shown_unit="g", meaning="of the lateral motion, scaled",
        place=AttributeOf("system.ground.pga"),
        intensity=Intensity(5, "pga", "Peak Ground Acceleration", "mps2"),
    ),
    Measure(
        "pgv_m_s", Kind.GROUND, "m/s", "PGV", "peak ground velocity",
        meaning="trapezoid rule, least-squares line removed",
        place=AttributeOf("system.ground.pgv"),
        intensity=Intensity(4, "pgv", "Peak Ground Velocity", "mps"),
    ),
    Measure(
        "arias_intensity_m_s", Kind.GROUND, "m/s", "Arias intensity", "Arias intensity",
        meaning=r"$\frac{\pi}{2g}\int a^2 dt$", place=AttributeOf("system.ground.arias_intensity"),
    ),
    Measure(
        "si_ground_m_s", Kind.GROUND, "m/s", "SI", "spectral intensity of the ground",
        meaning="Housner's: mean of the pseudo-velocity spectrum of the lateral motion from 0.1 to "
        "2.5 s, 20 % damping; 1 m/s is 100 kine",
        place=WorkedOut("spectral_intensity"),
    ),
    Measure(
        "jma_intensity", Kind.GROUND, "1", "JMA intensity", "JMA instrumental intensity",
        optional=True,
        meaning="of the lateral motion, and of the vertical one where there is one; JMA's own "
        "takes three components; none for a ground at rest",
        place=WorkedOut("jma_intensity"),
    ),
    Measure(
        "sa_t1_m_s2", Kind.GROUND, "m/s2", "Sa(T₁)", "spectral acceleration at T₁",
        optional=True,
        meaning="pseudo-spectral acceleration of the lateral motion, 5 % damping, at the "
        "structure's first period `t1_s`; none without a pier",
        place=WorkedOut("spectral_acceleration"),
        intensity=Intensity(6, "sa_t1", "Peak Spectral Acceleration", "mps2", has_period=True),
    ),
    # --- the structure
    Measure(
        "pbd_m", Kind.STRUCTURE, "m", "PBD", "peak bridge displacement",
        factor=1e3, shown_unit="mm",
        meaning="of the pier's top relative to the ground; holds the static displacement under the "
        "standing train",
        place=StateRow("PEAK_U"), step_floor=0.0, paired=True,
        intensity=Intensity(3, "pbd", "Peak Floor Displacement", "m", with_uplift=False),
    ),
    Measure(
        "pbv_m_s", Kind.STRUCTURE, "m/s", "PBV", "peak bridge velocity",
        meaning="of the pier's top relative to the ground", place=StateRow("PEAK_U_V"),
        step_floor=0.0, paired=True, intensity=Intensity(1, "pbv", "Peak Floor Velocity", "mps"),
    ),
    Measure(
        "pba_m_s2", Kind.STRUCTURE, "m/s2", "PBA", "peak bridge acceleration",
        meaning="of the pier's top, absolute; at grade the ground's", place=StateRow("PEAK_U_A"),
        paired=True, intensity=Intensity(2, "pba", "Peak Floor Acceleration", "mps2"),
    ),
    Measure(
        "track_velocity_peak_m_s", Kind.STRUCTURE, "m/s", "track velocity",
        "peak velocity of the track",
        meaning="lateral, absolute: the ground's as in `pgv_m_s` and the track's relative to it; "
        "one axis for piers and at grade, where it is the ground's",
        place=StateRow("PEAK_TRACK_V"),
        intensity=Intensity(
            7, "track_velocity", "Peak Floor Velocity", "mps", with_uplift=False
        ),
    ),
    Measure(
        "si_track_m_s", Kind.STRUCTURE, "m/s", "SI of the track",
        "spectral intensity of the track",
        meaning="as `si_ground_m_s`, of the track's absolute lateral motion, seen once a frame",
        place=WorkedOut("track_intensity"),
    ),
    Measure(
        "hinge_rotation_peak_rad", Kind.STRUCTURE, "rad", "hinge rotation", "peak hinge rotation",
        factor=1e3, shown_unit="mrad", meaning=r"$\theta_1$", place=StateRow("PEAK_THETA1"),
    ),
    Measure(
        "base_moment_peak_n_m", Kind.STRUCTURE, "N m", "base moment", "peak base moment",
        factor=1e-6, shown_unit="MN m", meaning="of the hinge", place=StateRow("PEAK_MOMENT"),
    ),
    Measure(
        "damping_moment_peak_n_m", Kind.STRUCTURE, "N m", "damping moment",
        "peak damping moment at the hinge",
        factor=1e-6, shown_unit="MN m",
        meaning="of the damping beside the hinge, which the pier's foot bears over its "
        "`base_moment_peak_n_m`; zero with `damping_of = \"column\"`",
        place=StateRow("PEAK_DAMPING_MOMENT"),
    ),
    Measure(
        "top_rotation_peak_rad", Kind.STRUCTURE, "rad", "top rotation", "peak rotation of the top",
        factor=1e3, shown_unit="mrad", meaning=r"$\theta_2$", place=StateRow("PEAK_THETA2"),
        paired=True,
    ),
    Measure(
        "t1_s", Kind.STRUCTURE, "s", "T₁", "first period of the structure",
        optional=True,
        meaning="of the pier by itself, without the train, with its initial hinge stiffness (Eq. "
        "10); none without a pier",
        place=WorkedOut("period"),
    ),
    # --- the train, until it leaves the track
    *TRAIN,
    # --- when
    Measure(
        "flange_contact_first_s", Kind.TIME, "s", "flange contact", "first flange contact",
        optional=True, meaning="a flange zone touched its rail", place=EventTime("FLANGE_CONTACT"),
    ),
    Measure(
        "uplift_first_s", Kind.TIME, "s", "uplift", "first uplift",
        optional=True, meaning="uplift began", place=EventTime("UPLIFT"),
    ),
    Measure(
        "uplift_last_end_s", Kind.TIME, "s", "uplift's end", "end of the last uplift",
        optional=True, meaning="uplift ended, the last time",
        place=StateTime("UPLIFT_END"),
    ),
    Measure(
        "onset_first_s", Kind.TIME, "s", "onset", "first onset of slide-off",
        optional=True, meaning="the flange's tip of a lifted wheel was above its rail's crown",
        place=EventTime("ONSET"),
    ),
    Measure(
        "flange_over_first_s", Kind.TIME, "s", "flange over", "first flange over its rail",
        optional=True, meaning="a flange tip was above its rail's crown, lifted or loaded",
        place=EventTime("FLANGE_OVER"),
    ),
    Measure(
        "derailed_s", Kind.TIME, "s", "derailment", "derailment",
        optional=True, meaning="derailment by whatever mode", place=StateTime("DERAILED_TIME"),
    ),
    Measure(
        "slide_off_s", Kind.TIME, "s", "slide-off", "slide-off",
        optional=True, meaning="`slide-off`, see below", place=EventTime("SLIDE_OFF"),
    ),
    Measure(
        "climb_s", Kind.TIME, "s", "climb", "climb",
        optional=True, meaning="`climb`, see below", place=EventTime("CLIMB"),
    ),
    Measure(
        "overturned_s", Kind.TIME, "s", "overturning", "overturning",
        optional=True, meaning="`overturned`, see below", place=EventTime("OVERTURNED"),
    ),
    Measure(
        "beyond_model_s", Kind.TIME, "s", "model’s end", "first time beyond the model",
        optional=True, meaning="`beyond_model`", place=StateTime("BEYOND_TIME"),
    ),
    # --- how it was computed
    Measure(
        "energy_residual", Kind.RUN, "1", "energy residual", "energy residual",
        meaning="of the whole balance, over what is dissipated; see [energy](theory/energy.md)",
        place=AttributeOf("audit.whole_relative"),
    ),
    Measure(
        "contact_energy_residual", Kind.RUN, "1", "contact’s residual",
        "energy residual of the contact",
        meaning="of the contact's balance, over what impact and creep lose; positive is loss, "
        "negative gain",
        place=AttributeOf("audit.contact_relative"),
    ),
    Measure(
        "contact_gain", Kind.RUN, "1", "contact’s gain", "energy gained by the contact",
        meaning="what the contact's balance gains, over all that is dissipated; 0 where it loses",
        place=AttributeOf("audit.contact_gain"),
    ),
    Measure(
        "energy_dissipated_j", Kind.RUN, "J", "dissipated", "energy dissipated",
        factor=1e-3, shown_unit="kJ", meaning="dashpots, Rayleigh damping, hinge, impact, creep",
        place=AttributeOf("audit.dissipated"),
    ),
    Measure(
        "gravity_work_residual", Kind.RUN, "1", "gravity’s residual", "residual of gravity's work",
        meaning="gravity's work less that from the bodies' heights, over what is dissipated",
        place=AttributeOf("audit.gravity_relative"),
    ),
    Measure(
        "linear_momentum_residual", Kind.RUN, "1", "momentum’s residual", "residual of momentum",
        meaning="what rails, ground and gravity do not explain of the car's momentum, sideways or "
        "upright, at its largest, over the largest impulse",
        place=AttributeOf("momentum.linear_relative"),
    ),
    Measure(
        "angular_momentum_residual", Kind.RUN, "1", "angular residual",
        "residual of angular momentum",
        meaning="the same of its angular momentum about the track's origin at rest, over the "
        "largest impulse of a moment; of a linear car by its own equations",
        place=AttributeOf("momentum.angular_relative"),
    ),
    Measure(
        "omitted_gravity_moment", Kind.RUN, "1", "omitted moment", "gravity's moment left out",
        meaning="impulse of the moment of gravity that a linear car's equations leave out, at its "
        "largest, over the largest that they have; 0 with `kinematics = \"finite\"`",
        place=AttributeOf("momentum.omitted_relative"),
    ),
    Measure(
        "forward_input_share", Kind.RUN, "1", "forward input", "what forward motion pays",
        meaning="work by spin and against longitudinal creepage that the train's forward motion "
        "pays, over what creep loses",
        place=AttributeOf("audit.forward_share"),
    ),
    Measure(
        "warnings", Kind.RUN, "", "warnings", "warnings",
        value=str, optional=True,
        meaning="a sentence for each bar that the audits cross, with semicolons between; see "
        "[energy](theory/energy.md)",
        place=WorkedOut("warnings"),
    ),
    Measure(
        "steps", Kind.RUN, "1", "steps", "time steps marched",
        value=int, meaning="time steps marched", place=AttributeOf("steps"),
    ),
    Measure(
        "steps_per_s", Kind.RUN, "1/s", "steps/s", "speed of the march",
        meaning="of the march alone", place=WorkedOut("speed"), repeats=False,
    ),
    Measure(
        "wall_s", Kind.RUN, "s", "time taken", "time that the run took",
        meaning="of the whole run, pictures and files apart", place=AttributeOf("wall_s"),
        repeats=False,
    ),
    Measure(
        "dt_s", Kind.RUN, "s", "Δt", "time step",
        meaning="time step", place=AttributeOf("system.dt"),
    ),
    Measure(
        "dt_error", Kind.RUN, "1", "step's error", "estimated error of the time step",
        optional=True,
        meaning="where the time step was chosen: its estimated error in PBD, PBV and uplift",
        place=WorkedOut("time_step_error"),
    ),
    Measure(
        "dt_critical_s", Kind.RUN, "s", "critical Δt", "critical time step",
        meaning="longest stable step, see [Zhai](theory/zhai.md)",
        place=AttributeOf("system.critical_dt"),
    ),
    Measure(
        "substeps", Kind.RUN, "1", "substeps", "time steps in one of the structure",
        value=int, meaning="of the wheelset, in one of the structure and of the sprung bodies",
        place=AttributeOf("system.substeps"),
    ),
    Measure(
        "contact", Kind.RUN, "", "contact", "method of contact",
        value=str, meaning="`table` or `grid`", place=AttributeOf("system.scenario.solver.contact"),
    ),
    Measure(
        "friction", Kind.RUN, "1", "μ", "friction of wheel on rail",
        meaning="coefficient of friction, `wheelrail.friction`",
        place=AttributeOf("system.scenario.wheelrail.friction"),
    ),
    Measure(
        "hinge_law", Kind.RUN, "", "hinge", "law of the hinge",
        value=str, optional=True, meaning="`bouc-wen` or `elastic`; none without a pier",
        place=WorkedOut("hinge_law"),
    ),
    Measure(
        "lateral_force_filter_hz", Kind.RUN, "Hz", "filter", "corner of the low-pass",
        meaning="of forces, `solver.lateral_force_filter`",
        place=AttributeOf("system.scenario.solver.lateral_force_filter"),
    ),
    Measure(
        "versions", Kind.RUN, "", "versions", "versions",
        value=str,
        meaning="of railquake, Python, NumPy, SciPy, Numba, llvmlite; a hash of the physics",
        place=WorkedOut("versions"),
    ),
)  # fmt: skip
"""All measures, in the order of a table's columns."""


# --- asking the list; always the list as it stands, so that nobody keeps a copy -------------------


def all_keys() -> tuple[str, ...]:
    """Keys of a row, columns of a table."""
    return tuple(measure.key for measure in MEASURES)


def named(key: str) -> Measure:
    """The measure of a key.

    Raises
    ------
    KeyError
        If it is not declared.
    """
    for measure in MEASURES:
        if measure.key == key:
            return measure
    raise KeyError(key)


def short_name(key: str) -> str:
    """Short name of a measure; of another column its key."""
    return next((measure.short for measure in MEASURES if measure.key == key), key)


def of_kind(kind: Kind) -> tuple[Measure, ...]:
    """Measures of a kind."""
    return tuple(measure for measure in MEASURES if measure.kind is kind)


def intensities() -> dict[str, Measure]:
    """Measures that outcomes are held against, by the names of `Intensity`, in its order."""
    found = [(m.intensity, m) for m in MEASURES if m.intensity is not None]
    return {of.name: measure for of, measure in sorted(found, key=lambda pair: pair[0].rank)}


def correlated() -> tuple[str, ...]:
    """Keys of the measures that uplift is held against; the first is the paper's choice."""
    found = intensities().values()
    return tuple(m.key for m in found if m.intensity is not None and m.intensity.with_uplift)


def telling_of_the_step() -> tuple[Measure, ...]:
    """Measures by which the error of a time step is told."""
    return tuple(measure for measure in MEASURES if measure.step_floor is not None)


def paired() -> tuple[str, ...]:
    """Keys of the measures by which models are compared, run by run."""
    return tuple(measure.key for measure in MEASURES if measure.paired)
