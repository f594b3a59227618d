"""Ground motions: records of many formats, synthetic motions, response spectra."""

from railquake.inputs.motion.motion import STANDARD_GRAVITY, GroundMotion
from railquake.inputs.motion.read import FORMATS, read_motion
from railquake.inputs.motion.spectrum import (
    ResponseSpectrum,
    oscillator_response,
    response_spectrum,
)
from railquake.inputs.motion.synthetic import (
    SyntheticParameters,
    synthetic_from_mapping,
    synthetic_motion,
)

__all__ = [
    "FORMATS",
    "STANDARD_GRAVITY",
    "GroundMotion",
    "ResponseSpectrum",
    "SyntheticParameters",
    "oscillator_response",
    "read_motion",
    "response_spectrum",
    "synthetic_from_mapping",
    "synthetic_motion",
]
