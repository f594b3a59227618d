"""The low-pass filter of forces."""

import pytest
from scipy.signal import butter

from railquake.physics.low_pass import low_pass_coefficients


def test_low_pass_is_scipys_butterworth():
    b, a = butter(2, 20.0, fs=1000.0)
    assert low_pass_coefficients(20.0, 1e-3) == pytest.approx((*b, a[1], a[2]), rel=1e-9)
