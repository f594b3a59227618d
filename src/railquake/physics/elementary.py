"""Elementary functions written out, so that a compiler may vectorise them."""

__all__ = ["sin_cos"]


def sin_cos(x: float) -> tuple[float, float]:
    """sin(x) and cos(x) for abs(x) <= 1 by their Taylor series; error below 2e-15 there.

    The rolls of a wheelset that has not yet overturned stay below pi/4.
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
