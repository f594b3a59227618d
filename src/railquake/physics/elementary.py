"""Elementary functions written out, so that a compiler may vectorise them.

`exponential` and `power` are the library's own; engines are bound to `exponential_polynomial` and
`power_polynomial`, which a vector unit can do and which cost one scenario a tenth of its step less.
"""

import math
import struct

__all__ = [
    "bits_of",
    "exponential",
    "exponential_polynomial",
    "float_of",
    "floor_of",
    "larger_of",
    "power",
    "power_polynomial",
    "sin_cos",
]

LOG2_E = 1.4426950408889634
LN_2 = 0.6931471805599453
MANTISSA = 0x000FFFFFFFFFFFFF
EXPONENT = 0x7FF0000000000000
ONE = 0x3FF0000000000000
# Integers and doubles change places by adding numbers whose last bit is worth 1: most vector units
# have no instruction that converts 64-bit integers.
WHOLE = (
    6755399441055744.0  # 1.5 * 2^52: a whole number below 2^51 added to it sits in the last bits
)
WHOLE_BITS = 0x4330000000000000  # 2^52
WHOLE_BIAS = 4503599627371519.0  # 2^52 + 1023


def exponential(x: float) -> float:
    """exp(x)."""
    return math.exp(x)


def power(x: float, n: float) -> float:
    """x^n for x >= 0."""
    return math.pow(x, n)


def bits_of(x: float) -> int:
    """Bits of a double as an integer."""
    return int(struct.unpack("<q", struct.pack("<d", x))[0])


def float_of(bits: int) -> float:
    """Double with the given bits."""
    return float(struct.unpack("<d", struct.pack("<q", bits))[0])


def floor_of(x: float) -> float:
    """Largest whole number up to x, as a double."""
    return float(math.floor(x))


def larger_of(a: float, b: float) -> float:
    """The larger of two; b if they cannot be compared.

    Where `max` is to be stored in the place of one of the two, a compiler leaves out the store that
    changes nothing, and for many abreast that makes slow stores of single lanes.
    """
    return a if a > b else b


def exponential_2(y: float) -> float:
    """2^y, for y held within the doubles' range: a power of two times a polynomial of the rest."""
    bounded = min(max(y, -1021.0), 1023.0)
    whole = floor_of(bounded + 0.5)
    r = LN_2 * (bounded - whole)
    q = r * r
    # Taylor series, abs(r) <= 0.347: error below 3e-16
    even = 1.0 + q * (
        1.0 / 2.0
        + q
        * (
            1.0 / 24.0
            + q
            * (1.0 / 720.0 + q * (1.0 / 40320.0 + q * (1.0 / 3628800.0 + q * (1.0 / 479001600.0))))
        )
    )
    odd = 1.0 + q * (
        1.0 / 6.0
        + q * (1.0 / 120.0 + q * (1.0 / 5040.0 + q * (1.0 / 362880.0 + q * (1.0 / 39916800.0))))
    )
    power_of_2 = float_of(((bits_of(whole + WHOLE) + 1023) & 0x7FF) << 52)
    return power_of_2 * (even + r * odd)


def exponential_polynomial(x: float) -> float:
    """exp(x); 0 or infinity are never reached, 4e-308 and 1e308 stand for them."""
    return exponential_2(LOG2_E * x)


def logarithm_2(x: float) -> float:
    """log2(x) for a normal x > 0: exponent, and a series of the mantissa within sqrt(1/2, 2)."""
    bits = bits_of(x)
    mantissa = float_of((bits & MANTISSA) | ONE)
    large = mantissa > 1.4142135623730951
    m = 0.5 * mantissa if large else mantissa
    exponent = float_of(((bits & EXPONENT) >> 52) | WHOLE_BITS) - WHOLE_BIAS
    t = (m - 1.0) / (m + 1.0)
    q = t * t
    # ln m = 2 (t + t^3/3 + t^5/5 ...), abs(t) <= 0.1716: error below 2e-17
    series = 1.0 + q * (
        1.0 / 3.0
        + q
        * (
            1.0 / 5.0
            + q
            * (
                1.0 / 7.0
                + q
                * (
                    1.0 / 9.0
                    + q
                    * (
                        1.0 / 11.0
                        + q * (1.0 / 13.0 + q * (1.0 / 15.0 + q * (1.0 / 17.0 + q / 19.0)))
                    )
                )
            )
        )
    )
    return exponent + (1.0 if large else 0.0) + 2.0 * LOG2_E * t * series


def power_polynomial(x: float, n: float) -> float:
    """x^n for x >= 0 and n > 0; 0^n comes out as about 1e-300^n."""
    return exponential_2(n * logarithm_2(max(x, 1e-300)))


def sin_cos(x: float) -> tuple[float, float]:
    """sin(x) and cos(x) for abs(x) <= 1 by their Taylor series; error below 2e-15 there.

    A wheelset that has not yet overturned stays below pi/4; at pi/2, where no body comes, the error
    is 6e-12.
    """
    q = x * x
    sine = x * (
        1.0
        + q
        * (
            -1.0 / 6.0
            + q
            * (
                1.0 / 120.0
                + q
                * (
                    -1.0 / 5040.0
                    + q
                    * (
                        1.0 / 362880.0
                        + q
                        * (
                            -1.0 / 39916800.0
                            + q * (1.0 / 6227020800.0 - q * (1.0 / 1307674368000.0))
                        )
                    )
                )
            )
        )
    )
    cosine = 1.0 + q * (
        -0.5
        + q
        * (
            1.0 / 24.0
            + q
            * (
                -1.0 / 720.0
                + q
                * (
                    1.0 / 40320.0
                    + q
                    * (
                        -1.0 / 3628800.0
                        + q
                        * (
                            1.0 / 479001600.0
                            + q * (-1.0 / 87178291200.0 + q * (1.0 / 20922789888000.0))
                        )
                    )
                )
            )
        )
    )
    return sine, cosine
