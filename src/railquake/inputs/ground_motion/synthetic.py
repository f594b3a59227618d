r"""Synthetic ground motions: enveloped, filtered white noise from a seed.

The model, with its sources:

1. Gaussian white noise :math:`w_i`, from the raw 64-bit output of PCG64 through the Box-Muller
   transform (Box & Muller 1958).  NumPy promises the raw stream of a bit generator for ever, but
   not that of `Generator.normal`: so the same seed gives the same motion with any version.
2. The envelope of Saragoni & Hart (1974), in the form of Boore (2003, eqs. 8-11),

   .. math:: e(t) = a\,(t/t_\eta)^b\,\exp(-c\,t/t_\eta), \qquad
             b = -\frac{\varepsilon\ln\eta}{1 + \varepsilon(\ln\varepsilon - 1)},\quad
             c = b/\varepsilon,\quad a = (e/\varepsilon)^b,

   which is 1 at :math:`\varepsilon t_\eta` and :math:`\eta = 0.05` at :math:`t_\eta`, the
   `strong_duration`.
3. The soil filter of Kanai (1957) and Tajimi (1960) with the high-pass filter of Clough & Penzien
   (1975) behind it, so that the power spectral density is

   .. math:: S(\omega) = S_0
             \frac{\omega_g^4 + 4\zeta_g^2\omega_g^2\omega^2}
                  {(\omega_g^2-\omega^2)^2 + 4\zeta_g^2\omega_g^2\omega^2}\cdot
             \frac{\omega^4}{(\omega_f^2-\omega^2)^2 + 4\zeta_f^2\omega_f^2\omega^2} .

   The filters are applied as causal oscillators in the frequency domain, over a zero-padded
   length that leaves no room for wrap-around.
4. Tapered ends (half cosine over `TAPER` of the duration), and a smooth correction, two humps as
   long as the record, that makes velocity and displacement (trapezoid rule) end at zero.
5. Scaling to the PGA or to the Arias intensity that was asked for.

It has the spectrum of a firm site and no more: no phase structure, no pulse, no match to a
hazard.  It serves demonstrations and tests.

Boore (2003), Pure Appl. Geophys. 160, 635-676; Clough & Penzien (1975), Dynamics of Structures,
McGraw-Hill; Kanai (1957), Bull. Earthq. Res. Inst. 35, 309-325; Saragoni & Hart (1974), Earthq.
Eng. Struct. Dyn. 2, 249-267; Tajimi (1960), Proc. 2nd WCEE, Tokyo, 781-797.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railquake.errors import InputError
from railquake.inputs.ground_motion.motion import (
    STANDARD_GRAVITY,
    GroundMotion,
    cumulative_trapezoid,
)

ENVELOPE_END = 0.05
"""Height of the envelope at `strong_duration` (eta)."""
TAPER = 0.02
"""Part of the duration that is tapered at each end."""
MAX_SAMPLES = 2_000_000
"""More samples than this are refused."""
MAX_SEED = 2**63 - 1
"""Largest seed (the largest whole number of TOML)."""


@dataclass(frozen=True)
class SyntheticParameters:
    """What a synthetic motion is made from; see the module's text for the model.

    Parameters
    ----------
    seed : int
        0 or more; the same seed gives the same motion.
    duration : float
        Whole length, s.
    dt : float
        Time step, s.  Another step makes another motion, not the same one resampled.
    pga : float or None
        Peak ground acceleration to scale to, m/s2; 0.4 g unless `arias_intensity` is given.
    arias_intensity : float or None
        Arias intensity to scale to, m/s, instead of `pga`.
    ground_frequency, ground_damping : float
        Frequency, Hz, and damping ratio of the Kanai-Tajimi filter; 2.5 Hz and 0.6 stand for
        firm ground.
    highpass_frequency, highpass_damping : float
        The same of the Clough-Penzien high-pass filter.
    strong_duration : float or None
        Time at which the envelope is down to 5 %, s; 0.7 of the duration if None.
    rise : float
        Time of the envelope's peak as a fraction of `strong_duration`.
    """

    seed: int = 1
    duration: float = 30.0
    dt: float = 0.005
    pga: float | None = None
    arias_intensity: float | None = None
    ground_frequency: float = 2.5
    ground_damping: float = 0.6
    highpass_frequency: float = 0.2
    highpass_damping: float = 0.7
    strong_duration: float | None = None
    rise: float = 0.2

    def __post_init__(self) -> None:
        where = "synthetic motion"
        if isinstance(self.seed, bool) or not isinstance(self.seed, (int, np.integer)):
            raise InputError(f"{where}: seed must be a whole number, found {self.seed!r}")
        if not 0 <= self.seed <= MAX_SEED:
            raise InputError(f"{where}: seed must be from 0 to {MAX_SEED}, found {self.seed}")
        object.__setattr__(self, "seed", int(self.seed))
        for name in _NUMBERS:
            value = getattr(self, name)
            if value is None and name in _OPTIONAL:
                continue
            if isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
                raise InputError(f"{where}: {name} must be a number, found {value!r}")
            if not (np.isfinite(value) and value > 0.0):
                raise InputError(f"{where}: {name} must be finite and over zero, found {value:g}")
            object.__setattr__(self, name, float(value))
        if self.pga is not None and self.arias_intensity is not None:
            raise InputError(f"{where}: give pga or arias_intensity, not both")
        if self.pga is None and self.arias_intensity is None:
            object.__setattr__(self, "pga", 0.4 * STANDARD_GRAVITY)
        if self.strong_duration is None:
            object.__setattr__(self, "strong_duration", 0.7 * self.duration)
        self._check_ranges(where)

    def _check_ranges(self, where: str) -> None:
        samples = self.duration / self.dt
        if not 100 <= samples <= MAX_SAMPLES:
            raise InputError(
                f"{where}: duration / dt = {samples:.4g} samples; 100 to {MAX_SAMPLES} are possible"
            )
        assert self.strong_duration is not None, "set just before"
        if self.strong_duration > self.duration:
            raise InputError(
                f"{where}: strong_duration ({self.strong_duration:g} s) is longer than duration "
                f"({self.duration:g} s)"
            )
        if not 0.01 <= self.rise <= 0.9:
            raise InputError(f"{where}: rise must be from 0.01 to 0.9, found {self.rise:g}")
        for name in ("ground_damping", "highpass_damping"):
            if not 0.01 <= getattr(self, name) <= 2.0:
                raise InputError(
                    f"{where}: {name} must be from 0.01 to 2, found {getattr(self, name):g}"
                )
        nyquist = 0.5 / self.dt
        if self.ground_frequency > 0.5 * nyquist:
            raise InputError(
                f"{where}: ground_frequency {self.ground_frequency:g} Hz needs a dt below "
                f"{0.25 / self.ground_frequency:.3g} s, found {self.dt:g} s"
            )
        if not 1.0 / self.duration <= self.highpass_frequency < self.ground_frequency:
            raise InputError(
                f"{where}: highpass_frequency must be from 1 / duration "
                f"({1.0 / self.duration:.3g} Hz) to below ground_frequency "
                f"({self.ground_frequency:g} Hz), found {self.highpass_frequency:g}"
            )


DIMENSIONS: dict[str, str | None] = {
    "duration": "time",
    "dt": "time",
    "pga": "acceleration",
    "arias_intensity": "speed",
    "ground_frequency": "frequency",
    "ground_damping": None,
    "highpass_frequency": "frequency",
    "highpass_damping": None,
    "strong_duration": "time",
    "rise": None,
}
_NUMBERS = tuple(DIMENSIONS)
_OPTIONAL = ("pga", "arias_intensity", "strong_duration")


def synthetic_from_mapping(
    table: Mapping[str, Any], where: str = "motion.synthetic"
) -> SyntheticParameters:
    """Parameters from a table of a case file, such as ``{seed = 1, pga = "0.4 g"}``.

    Parameters
    ----------
    table : mapping
        Names of `SyntheticParameters`; values are numbers in SI units or texts with a unit.
    where : str
        Path of the table in the case file, for messages.

    Raises
    ------
    InputError
        If a name is unknown, or a value has no, a wrong or an impossible quantity.
    """
    if not isinstance(table, Mapping):
        raise InputError(f"{where}: a table such as {{seed = 1}} is needed, found {table!r}")
    known = [field.name for field in fields(SyntheticParameters)]
    values: dict[str, Any] = {}
    for name, value in table.items():
        if name not in known:
            near = difflib.get_close_matches(str(name), known, 1)
            hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
            raise InputError(f"{where}: '{name}' is not known; {hint}")
        values[name] = _si(value, name, where)
    try:
        return SyntheticParameters(**values)
    except InputError as error:
        raise InputError(str(error).replace("synthetic motion", where, 1)) from None


def _si(value: Any, name: str, where: str) -> Any:
    """A text with a unit as a number in SI units; anything else as it is."""
    if not isinstance(value, str):
        return value
    dimension = DIMENSIONS.get(name)
    if dimension is None:
        raise InputError(f"{where}.{name}: a plain number is needed, found '{value}'")
    from railquake.inputs.units import to_si  # imported late: it brings the unit registry

    return to_si(value, dimension, f"{where}.{name}")


def synthetic_motion(
    parameters: SyntheticParameters | Mapping[str, Any] | None = None, name: str = ""
) -> GroundMotion:
    """Make a synthetic motion.

    Parameters
    ----------
    parameters : SyntheticParameters or mapping, optional
        A mapping goes through `synthetic_from_mapping`; None takes the defaults.
    name : str
        Name of the motion; "synthetic-SEED" if empty.

    Returns
    -------
    GroundMotion
        Starts and ends at zero acceleration; its velocity and displacement end at zero.
    """
    if parameters is None:
        parameters = SyntheticParameters()
    elif not isinstance(parameters, SyntheticParameters):
        parameters = synthetic_from_mapping(parameters)
    p = parameters
    count = round(p.duration / p.dt) + 1
    time = np.arange(count, dtype=np.float64) * p.dt
    assert p.strong_duration is not None, "set by the dataclass"
    noise = white_noise(p.seed, count)
    noise *= envelope(time, p.strong_duration, p.rise)
    filtered = _filtered(noise, p)
    corrected = _end_at_rest(filtered * _taper(count), p.dt)
    motion = GroundMotion(name or f"synthetic-{p.seed}", p.dt, corrected)
    if p.arias_intensity is not None:
        factor = float(np.sqrt(p.arias_intensity / motion.arias_intensity))
    else:
        assert p.pga is not None, "set by the dataclass"
        factor = p.pga / motion.pga
    source = "synthetic: " + ", ".join(
        f"{field.name} = {getattr(p, field.name)!r}"
        for field in fields(p)
        if getattr(p, field.name) is not None
    )
    notes = ("enveloped, filtered white noise (Kanai-Tajimi, Clough-Penzien, Saragoni-Hart)",)
    return GroundMotion(motion.name, p.dt, corrected * factor, source, notes)


def white_noise(seed: int, count: int) -> NDArray[np.float64]:
    """Standard normal numbers, shape (count,), the same with every version of NumPy."""
    half = (count + 1) // 2
    raw = np.random.PCG64(seed).random_raw(2 * half)
    # 53 bits, moved half a step off zero so that the logarithm is finite.
    uniform = ((raw >> np.uint64(11)).astype(np.float64) + 0.5) * 2.0**-53
    radius = np.sqrt(-2.0 * np.log(uniform[:half]))
    angle = 2.0 * np.pi * uniform[half:]
    return np.concatenate((radius * np.cos(angle), radius * np.sin(angle)))[:count]


def envelope(time: NDArray[np.float64], strong_duration: float, rise: float) -> NDArray[np.float64]:
    """Saragoni-Hart envelope: 1 at `rise` x `strong_duration`, 0.05 at `strong_duration`."""
    power = -rise * np.log(ENVELOPE_END) / (1.0 + rise * (np.log(rise) - 1.0))
    x = time / (rise * strong_duration)
    # a x^b e^(-c x) with its constants gathered: (x e^(1 - x))^b.
    return np.asarray((x * np.exp(1.0 - x)) ** power)


def filter_gain(frequency: NDArray[np.float64], p: SyntheticParameters) -> NDArray[np.complex128]:
    """Transfer function of the two filters at frequencies in Hz; its square is S / S0."""
    w = 2.0 * np.pi * frequency
    wg, wf = 2.0 * np.pi * p.ground_frequency, 2.0 * np.pi * p.highpass_frequency
    soil = (wg**2 + 2j * p.ground_damping * wg * w) / (
        wg**2 - w**2 + 2j * p.ground_damping * wg * w
    )
    highpass = -(w**2) / (wf**2 - w**2 + 2j * p.highpass_damping * wf * w)
    return np.asarray(soil * highpass)


def _filtered(noise: NDArray[np.float64], p: SyntheticParameters) -> NDArray[np.float64]:
    # The slower pole of each filter rings for 1 / decay; 20 of those leave 2e-9.
    decays = [
        2.0 * np.pi * f * (z if z <= 1.0 else z - np.sqrt(z * z - 1.0))
        for f, z in (
            (p.ground_frequency, p.ground_damping),
            (p.highpass_frequency, p.highpass_damping),
        )
    ]
    padding = min(int(np.ceil(20.0 / min(decays) / p.dt)), 4 * noise.size)
    length = 1 << int(np.ceil(np.log2(noise.size + padding)))
    frequency = np.asarray(np.fft.rfftfreq(length, p.dt), dtype=np.float64)
    gain = filter_gain(frequency, p)
    return np.asarray(np.fft.irfft(np.fft.rfft(noise, length) * gain, length)[: noise.size])


def _taper(count: int) -> NDArray[np.float64]:
    """1 with half cosines down to 0 at both ends."""
    width = max(2, round(TAPER * count))
    ramp = 0.5 * (1.0 - np.cos(np.pi * np.arange(width) / width))
    taper = np.ones(count)
    taper[:width] = ramp
    taper[-width:] = ramp[::-1]
    return taper


def _end_at_rest(acceleration: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    """Add two smooth humps so that velocity and displacement (trapezoid) end at zero."""
    place = np.linspace(-1.0, 1.0, acceleration.size)
    hump = (1.0 - place**2) ** 2
    shapes = (hump, hump * place)

    def ends(values: NDArray[np.float64]) -> tuple[float, float]:
        velocity = cumulative_trapezoid(values, dt)
        return float(velocity[-1]), float(cumulative_trapezoid(velocity, dt)[-1])

    matrix = np.array([ends(shape) for shape in shapes]).T
    weights = np.linalg.solve(matrix, -np.array(ends(acceleration)))
    return np.asarray(acceleration + weights[0] * shapes[0] + weights[1] * shapes[1])
