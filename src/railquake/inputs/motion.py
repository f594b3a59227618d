"""Where the ground's motion comes from: the case file's section ``[motion]``.

The motions themselves, and the readers of records, are in `railquake.inputs.ground_motion`.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import asdict
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import BeforeValidator, Field, WithJsonSchema, model_validator

from railquake.errors import InputError
from railquake.inputs.marks import File, Label, OneOf, Samples, alternatives
from railquake.inputs.model import Flag, InputModel, Integer, Name, Text, inconsistent
from railquake.inputs.units import Acceleration, Number, PositiveTime

if TYPE_CHECKING:
    from railquake.inputs.ground_motion import GroundMotion


def _synthetic_in_si(table: Any) -> dict[str, Any] | None:
    """All parameters of a synthetic motion, defaults included, in SI units."""
    if table is None:
        return None
    from railquake.inputs.ground_motion import synthetic_from_mapping

    try:
        parameters = asdict(synthetic_from_mapping(table, "synthetic"))
    except InputError as error:
        # Pydantic puts the path of the field in front again.
        where, _, reason = str(error).partition(": ")
        raise inconsistent(reason, where.partition(".")[2] or None) from None
    return {key: value for key, value in parameters.items() if value is not None}


SCALED_BY_ZERO = "must not be 0, which leaves no motion; write the factor that is meant"


class Motion(InputModel):
    """The ground's motion: a record's file, a synthetic motion, or the samples themselves.

    The file is not read before :meth:`Scenario.ground_motion` asks for it.
    """

    record: Annotated[
        Name | None, File(), OneOf("origin"), Field(description="File of the lateral component")
    ] = None
    synthetic: Annotated[
        dict[str, int | float] | None,
        OneOf("origin"),
        BeforeValidator(_synthetic_in_si),
        WithJsonSchema({"type": "object"}),
        Field(description='Parameters of a synthetic motion, e.g. { seed = 1, pga = "0.4 g" }'),
    ] = None
    acceleration: Annotated[
        tuple[Acceleration, ...] | None,
        OneOf("origin"),
        Samples(),
        Field(min_length=2, description="Lateral samples at steps of dt [m/s2]"),
    ] = None
    name: Annotated[
        Text, Label(), Field(description="What to call a motion given by its samples")
    ] = ""
    vertical: Annotated[
        Name | None, File(), Field(description="File of the vertical component, positive up")
    ] = None
    vertical_acceleration: Annotated[
        tuple[Acceleration, ...] | None,
        Samples(),
        Field(min_length=2, description="Vertical samples at steps of dt, positive up [m/s2]"),
    ] = None
    scale: Annotated[
        Number, Field(description="Factor on both components; negative mirrors the lateral one")
    ] = 1.0
    channel: Annotated[
        Integer | Text | None, Field(description="Which channel of the record's file")
    ] = None
    vertical_channel: Annotated[
        Integer | Text | None, Field(description="Which channel of the vertical component's file")
    ] = None
    units: Annotated[
        Text | None, Field(description="Units of the files' values, where they do not say")
    ] = None
    dt: Annotated[
        PositiveTime | None, Field(description="Time step, where the file does not say [s]")
    ] = None
    allow_high_pga: Annotated[
        Flag, Field(description="Whether a peak above 3 g is meant, in the file and after scale")
    ] = False

    @model_validator(mode="after")
    def _has_one_origin(self) -> Motion:
        (origins,) = alternatives(type(self))
        given = [key for key in origins if getattr(self, key) is not None]
        if len(given) != 1:
            found = " and ".join(given) or "none of them"
            raise inconsistent(
                f"give one of {', '.join(origins[:-1])} and {origins[-1]}, found {found}"
            )
        if self.vertical is not None and self.vertical_acceleration is not None:
            raise inconsistent("give either vertical or vertical_acceleration, found both")
        samples = (self.acceleration, self.vertical_acceleration)
        if self.dt is None and any(values is not None for values in samples):
            raise inconsistent('is needed with samples; write e.g. dt = "0.01 s"', "dt")
        if self.scale == 0.0:
            raise inconsistent(SCALED_BY_ZERO, "scale")
        return self

    def lateral_motion(self) -> GroundMotion:
        """Read or make the lateral component and scale it.

        Returns
        -------
        GroundMotion
            Positive to the right.

        Raises
        ------
        InputError
            If the record's file cannot be used, or what `scale` makes of it is no motion of the
            ground: see `scaled_motion`.
        """
        if self.record is not None:
            made = self._read(self.record, self.channel)
        elif self.synthetic is not None:
            made = _synthetic(tuple(self.synthetic.items()))
        else:
            assert self.acceleration is not None  # by the validator above
            made = motion_of_samples(self.name or "samples", self.dt, self.acceleration)
        return scaled_motion(made, self.scale, self.allow_high_pga)

    def vertical_motion(self) -> GroundMotion | None:
        """Read the vertical component and scale it.

        Returns
        -------
        GroundMotion or None
            Positive UP, as recorded; None if there is none.

        Raises
        ------
        InputError
            If its file cannot be used; see `lateral_motion`.
        """
        if self.vertical_acceleration is not None:
            name = f"{self.name or 'samples'} vertical"
            made = motion_of_samples(name, self.dt, self.vertical_acceleration)
        elif self.vertical is not None:
            made = self._read(self.vertical, self.vertical_channel)
        else:
            return None
        return scaled_motion(made, abs(self.scale), self.allow_high_pga)

    def _read(self, path: str, channel: int | str | None) -> GroundMotion:
        try:
            found = os.stat(path)
            stamp = (found.st_mtime_ns, found.st_size)
        except OSError:
            stamp = (0, 0)  # reading it says what is wrong
        return _record(path, stamp, channel, self.units, self.dt, self.allow_high_pga)


@lru_cache(maxsize=64)
def _record(
    path: str,
    stamp: tuple[int, int],
    channel: int | str | None,
    units: str | None,
    dt: float | None,
    allow_high_pga: bool,
) -> GroundMotion:
    """Read a record once for the many runs of a study, again when the file has changed."""
    from railquake.inputs.ground_motion import read_motion

    return read_motion(path, channel=channel, units=units, dt=dt, allow_high_pga=allow_high_pga)


@lru_cache(maxsize=64)
def _synthetic(parameters: tuple[tuple[str, int | float], ...]) -> GroundMotion:
    """Make a synthetic motion once for the many runs of a study."""
    from railquake.inputs.ground_motion import synthetic_motion

    return synthetic_motion(dict(parameters))


def motion_of_samples(name: str, dt: float | None, samples: Sequence[float]) -> GroundMotion:
    """Make a ground motion of plain numbers.

    Parameters
    ----------
    name : str
        What to call it.
    dt : float
        Time step [s].
    samples : sequence of float
        Ground acceleration [m/s2].
    """
    import numpy as np

    from railquake.inputs.ground_motion import GroundMotion

    assert dt is not None  # checked where samples are taken in
    return GroundMotion(name, dt, np.array(samples, dtype=np.float64))


def scaled_motion(motion: GroundMotion, factor: float, allow_high_pga: bool) -> GroundMotion:
    """A motion times a factor, if that is still a motion of the ground.

    Parameters
    ----------
    motion : GroundMotion
    factor : float
        Negative mirrors it.
    allow_high_pga : bool
        Whether a peak above 3 g is meant.

    Raises
    ------
    InputError
        If the factor is zero, or the peak is above 3 g without consent, or above 100 g.
    """
    from railquake.inputs.ground_motion.read import PLAUSIBLE_PGA, POSSIBLE_PGA
    from railquake.measures import STANDARD_GRAVITY

    if factor == 0.0:
        raise InputError(f"motion '{motion.name}': scale {SCALED_BY_ZERO}")
    limit = POSSIBLE_PGA if allow_high_pga else PLAUSIBLE_PGA
    peak = abs(factor) * motion.pga
    if not peak <= limit * (1.0 + 1e-12):
        if allow_high_pga or peak > POSSIBLE_PGA:
            limit, remedy = POSSIBLE_PGA, "lower it"
        else:
            remedy = "lower it, or say motion.allow_high_pga = true if it is meant"
        raise InputError(
            f"motion '{motion.name}': PGA is {peak / STANDARD_GRAVITY:.4g} g with scale = "
            f"{factor:g}, over {limit / STANDARD_GRAVITY:g} g; {remedy}"
        )
    scaled = motion.scaled(abs(factor))
    return scaled if factor > 0.0 else scaled.mirrored()
