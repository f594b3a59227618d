"""Quantities with units, turned into SI numbers at the edge of the program and nowhere else.

A value in a case file is either a bare number, which is SI, or a text such as ``"6.0 m"``,
``"80 km/h"`` or ``"1.3312 MN/m"``.  :func:`to_si` turns both into a finite ``float`` in SI units
and refuses everything else.  The annotated types (``Length``, ``PositiveMass``, ...) do the same
for the fields of the input models.

Units are parsed by pint, with the short list of definitions below instead of pint's own:
it loads in milliseconds instead of a third of a second, and a name that could mean two things
(``h``, ``gal``) can only mean the one listed here.  Pint is imported when the first text with a
unit arrives.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from numbers import Real
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic_core import PydanticCustomError, core_schema

from railquake.errors import InputError
from railquake.messages import shown

if TYPE_CHECKING:
    from collections.abc import Callable

    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic.json_schema import JsonSchemaValue

Sign = Literal["any", "non-negative", "positive"]

UNIT_DEFINITIONS = """
giga- = 1e9 = G-
mega- = 1e6 = M-
kilo- = 1e3 = k-
centi- = 1e-2 = c-
milli- = 1e-3 = m-
micro- = 1e-6 = µ- = μ- = u-
meter = [length] = m = metre
second = [time] = s = sec
kilogram = [mass] = kg
radian = [angle] = rad
minute = 60 * second = min
hour = 3600 * second = h = hr
gram = 1e-3 * kilogram = g
tonne = 1000 * kilogram = t = metric_ton
pound = 0.45359237 * kilogram = lb = lbm
inch = 0.0254 * meter = in = inches
foot = 0.3048 * meter = ft = feet
yard = 0.9144 * meter = yd
mile = 1609.344 * meter = mi = miles
mile_per_hour = mile / hour = mph
degree = 0.017453292519943295 * radian = deg = °
standard_gravity = 9.80665 * meter / second ** 2 = g0 = g_0 = g_n
galileo = 0.01 * meter / second ** 2 = Gal = gal
hertz = 1 / second = Hz
newton = kilogram * meter / second ** 2 = N
newton_meter = newton * meter = Nm
kilogram_force = 9.80665 * newton = kgf
tonne_force = 9806.65 * newton = tf
pound_force = 4.4482216152605 * newton = lbf
kip = 4448.2216152605 * newton = kips
slug = 14.593902937206364 * kilogram
pascal = newton / meter ** 2 = Pa
psi = 6894.757293168361 * pascal
ksi = 6894757.293168361 * pascal
joule = newton * meter = J
percent = 0.01 = %
"""


@dataclass(frozen=True)
class Dimension:
    """What kind of quantity a field takes.

    Attributes
    ----------
    name : str
        As said to a person, with its article: "a length".
    si_unit : str
        The unit that a bare number is taken to have.
    example : str
        A value as it may be written.
    units : tuple of str
        Units of all accepted dimensions; moments per angle, for example, are accepted with and
        without the radian.
    """

    name: str
    si_unit: str
    example: str
    units: tuple[str, ...]


DIMENSIONS: Mapping[str, Dimension] = {
    "length": Dimension("a length", "m", "6.0 m", ("m",)),
    "mass": Dimension("a mass", "kg", "29600 kg", ("kg",)),
    "time": Dimension("a time", "s", "1 ms", ("s",)),
    "speed": Dimension("a speed", "m/s", "80 km/h", ("m/s",)),
    "acceleration": Dimension("an acceleration", "m/s2", "0.3 g", ("m/s2",)),
    "frequency": Dimension("a frequency", "Hz", "20 Hz", ("1/s",)),
    "angle": Dimension("an angle", "rad", "0.836 deg", ("rad",)),
    "force": Dimension("a force", "N", "50 kN", ("N",)),
    "stiffness": Dimension("a stiffness", "N/m", "1.3312 MN/m", ("N/m",)),
    "damping": Dimension("a damping", "N s/m", "68.272 kN s/m", ("N s/m",)),
    "pressure": Dimension("a pressure", "Pa", "44.8 GPa", ("Pa",)),
    "moment": Dimension("a moment", "N m", "38.432 MN m", ("N m",)),
    "rotational stiffness": Dimension(
        "a rotational stiffness", "N m/rad", "38.432 GN m/rad", ("N m/rad", "N m")
    ),
    "roll inertia": Dimension("a roll inertia", "kg m2", "32000 kg m2", ("kg m2",)),
    "second moment of area": Dimension("a second moment of area", "m4", "0.164 m4", ("m4",)),
    "specific energy": Dimension(
        "an energy per mass", "J/kg", "0.001 J/kg", ("J/kg", "N m rad/kg")
    ),
    "number": Dimension("a plain number", "", "0.3", ("",)),
}

# Signs, digits, a decimal point and an exponent; what follows is the unit.
_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?)\s*(\S.*?)?\s*", re.DOTALL)
_UNIT_TEXT = re.compile(r"[A-Za-zµμ°%_0 1-9*/^.()·²³⁴-]{1,60}")
_SUPERSCRIPTS = str.maketrans({"²": "^2", "³": "^3", "⁴": "^4", "·": " "})


_PLAIN_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?", re.ASCII)
_NOT_FINITE = ("nan", "inf", "infinity")


def number_of(text: str) -> float | None:
    """The number that a cell of a file holds; None where it holds none.

    Parameters
    ----------
    text : str
        Also with Fortran's exponent, ``1.5D-03``; ``nan`` and ``inf`` are numbers for the caller
        to refuse.  What Python alone reads (``1_0``, digits of other scripts) is none.
    """
    plain = text.strip()
    if plain.lower().lstrip("+-") in _NOT_FINITE:
        return float(plain)
    return float(_with_e(plain)) if _PLAIN_NUMBER.fullmatch(plain) else None


def _with_e(number: str) -> str:
    return number.replace("d", "e").replace("D", "e")


class _QuantityError(ValueError):
    """The value is not a quantity of the wanted kind; the text says why, without the field."""


@lru_cache(maxsize=1)
def _unit_registry() -> Any:
    import pint

    registry: Any = pint.UnitRegistry(None)
    registry.load_definitions(UNIT_DEFINITIONS.strip().splitlines())
    return registry


def _spelled_for_pint(unit: str) -> str:
    """Rewrite the ways people write units ("kg m2", "s-1", "kip-in") as products and powers."""
    text = unit.translate(_SUPERSCRIPTS).replace("**", "^")
    text = re.sub(r"([A-Za-z°])\^?(-?\d)(?!\d)", r"\1 ** \2", text)
    text = re.sub(r"(?<=[A-Za-z])-(?=[A-Za-z])", " ", text)
    return text.replace("^", "**")


@lru_cache(maxsize=512)
def _unit_factor(unit: str) -> tuple[float, tuple[tuple[str, float], ...]]:
    """SI value and dimensionality of one of a unit.

    Raises
    ------
    _QuantityError
        If the text is no unit.
    """
    if not unit:
        return 1.0, ()
    if not _UNIT_TEXT.fullmatch(unit) or re.search(r"\d{2}|\d\.|\.\d", unit):
        raise _QuantityError(f"unknown unit {shown(unit)}")
    try:
        registry = _unit_registry()
        quantity = (1.0 * registry.parse_units(_spelled_for_pint(unit))).to_base_units()
        factor = float(quantity.magnitude)
        dimensionality = tuple(sorted((k, float(v)) for k, v in quantity.dimensionality.items()))
    except ImportError:
        raise
    except Exception as error:  # pint answers nonsense with a dozen kinds of exception
        raise _QuantityError(f"unknown unit {shown(unit)}") from error
    if not math.isfinite(factor) or factor <= 0.0:
        raise _QuantityError(f"unknown unit {shown(unit)}")
    return factor, dimensionality


def _named(dimensionality: tuple[tuple[str, float], ...]) -> str | None:
    for dimension in DIMENSIONS.values():
        if any(_unit_factor(unit)[1] == dimensionality for unit in dimension.units):
            return dimension.name
    return None


def _from_text(text: str, dimension: Dimension) -> float:
    wanted = f"must be {dimension.name}"
    found = shown(text)
    remedy = f"write e.g. {_written(dimension)}"
    match = _QUANTITY.fullmatch(text)
    if match is None:
        raise _QuantityError(f"{wanted}, found {found}; {remedy}")
    number, unit = float(_with_e(match[1])), match[2] or ""
    if not unit and dimension.si_unit:
        raise _QuantityError(
            f"{wanted}, found {found}, a text without a unit; {remedy},"
            f" or a bare number for {dimension.si_unit}"
        )
    if unit == "g" and dimension is DIMENSIONS["acceleration"]:
        unit = "standard_gravity"  # a gram is no acceleration, so here g can only be gravity's
    try:
        factor, dimensionality = _unit_factor(unit)
    except _QuantityError as error:
        raise _QuantityError(f"{wanted}, found {found}: {error}; {remedy}") from error
    if all(_unit_factor(accepted)[1] != dimensionality for accepted in dimension.units):
        name = _named(dimensionality)
        found = f"{found} ({name})" if name else found
        raise _QuantityError(f"{wanted}, found {found}; {remedy}")
    return number * factor


def _written(dimension: Dimension) -> str:
    return f'"{dimension.example}"' if dimension.si_unit else dimension.example


def _parsed(value: object, dimension: Dimension, sign: Sign) -> float:
    """Return the SI value, or raise :class:`_QuantityError` with the reason."""
    if isinstance(value, str):
        number = _from_text(value, dimension)
    elif isinstance(value, Real) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
    else:
        raise _QuantityError(
            f"must be {dimension.name}, found {shown(value)}; write e.g. {_written(dimension)}"
        )
    if not math.isfinite(number):
        raise _QuantityError(f"must be a finite number, found {shown(value)}")
    if (sign == "positive" and number <= 0.0) or (sign == "non-negative" and number < 0.0):
        required = "positive" if sign == "positive" else "zero or positive"
        raise _QuantityError(f"must be {required}, found {shown(value)}")
    return number


def to_si(value: object, dimension: str, where: str, *, sign: Sign = "any") -> float:
    """Turn a quantity into a number in SI units.

    Parameters
    ----------
    value : str or number
        ``"6.0 m"``, or a bare number, which is SI already.
    dimension : str
        A key of :data:`DIMENSIONS`: ``"length"``, ``"speed"``, ``"roll inertia"``, ...
    where : str
        The field (and file), for the message: ``"case.toml: support.length"``.
    sign : {"any", "non-negative", "positive"}
        What the value may be.

    Returns
    -------
    float
        Finite, in SI units.

    Raises
    ------
    InputError
        If the value has another dimension or no unit, is not finite, or has the wrong sign.
    """
    try:
        return _parsed(value, DIMENSIONS[dimension], sign)
    except _QuantityError as error:
        raise InputError(f"{where}: {error}") from error


@dataclass(frozen=True)
class Quantity:
    """Marks a model field as a quantity: ``Annotated[float, Quantity("length", "positive")]``.

    The field holds a ``float`` in SI units and accepts what :func:`to_si` accepts.

    Parameters
    ----------
    dimension : str
        A key of :data:`DIMENSIONS`.
    sign : {"any", "non-negative", "positive"}
        What the value may be.
    word : str, optional
        A word that may stand in its place, such as ``"auto"``; the field then holds it.
    """

    dimension: str
    sign: Sign = "any"
    word: str | None = None

    @property
    def example(self) -> str:
        """A value as it may be written in a case file."""
        return _written(DIMENSIONS[self.dimension])

    def __get_pydantic_core_schema__(
        self, _source: Any, _handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Validate by this module's parser alone."""
        dimension, sign, word = DIMENSIONS[self.dimension], self.sign, self.word

        def validate(value: Any) -> float | str:
            if word is not None and value == word:
                return word
            try:
                return _parsed(value, dimension, sign)
            except _QuantityError as error:
                raise PydanticCustomError("quantity", "{reason}", {"reason": str(error)}) from error

        validator: Callable[[Any], float | str] = validate
        plain: Callable[[Any], Any] = float if word is None else lambda held: held
        return core_schema.no_info_plain_validator_function(
            validator, serialization=core_schema.plain_serializer_function_ser_schema(plain)
        )

    def __get_pydantic_json_schema__(
        self, _schema: core_schema.CoreSchema, _handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        """Describe the field to editors: a number in SI, or a text with a unit."""
        dimension = DIMENSIONS[self.dimension]
        number: dict[str, Any] = {"type": "number"}
        if self.sign == "positive":
            number["exclusiveMinimum"] = 0
        elif self.sign == "non-negative":
            number["minimum"] = 0
        words = [] if self.word is None else [self.word]
        if not dimension.si_unit:
            return number
        return {"anyOf": [number, {"type": "string", "examples": [dimension.example, *words]}]}


Number = Annotated[float, Quantity("number")]
PositiveNumber = Annotated[float, Quantity("number", "positive")]
NonNegativeNumber = Annotated[float, Quantity("number", "non-negative")]
Length = Annotated[float, Quantity("length")]
PositiveLength = Annotated[float, Quantity("length", "positive")]
NonNegativeLength = Annotated[float, Quantity("length", "non-negative")]
PositiveMass = Annotated[float, Quantity("mass", "positive")]
PositiveTime = Annotated[float, Quantity("time", "positive")]
PositiveSpeed = Annotated[float, Quantity("speed", "positive")]
NonNegativeSpeed = Annotated[float, Quantity("speed", "non-negative")]
Acceleration = Annotated[float, Quantity("acceleration")]
PositiveFrequency = Annotated[float, Quantity("frequency", "positive")]
Angle = Annotated[float, Quantity("angle")]
PositiveAngle = Annotated[float, Quantity("angle", "positive")]
NonNegativeForce = Annotated[float, Quantity("force", "non-negative")]
PositiveForce = Annotated[float, Quantity("force", "positive")]
PositiveStiffness = Annotated[float, Quantity("stiffness", "positive")]
NonNegativeDamping = Annotated[float, Quantity("damping", "non-negative")]
PositivePressure = Annotated[float, Quantity("pressure", "positive")]
PositiveMoment = Annotated[float, Quantity("moment", "positive")]
PositiveRotationalStiffness = Annotated[float, Quantity("rotational stiffness", "positive")]
PositiveRollInertia = Annotated[float, Quantity("roll inertia", "positive")]
PositiveSecondMomentOfArea = Annotated[float, Quantity("second moment of area", "positive")]
PositiveSpecificEnergy = Annotated[float, Quantity("specific energy", "positive")]
