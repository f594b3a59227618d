"""Ground motions: records of many formats, synthetic motions, response spectra."""

from railquake.inputs.ground_motion.motion import STANDARD_GRAVITY, GroundMotion
from railquake.inputs.ground_motion.read import (
    FORMATS,
    RecordContents,
    read_motion,
    record_contents,
)
from railquake.inputs.ground_motion.spectrum import (
    ResponseSpectrum,
    oscillator_response,
    response_spectrum,
)
from railquake.inputs.ground_motion.synthetic import (
    SyntheticParameters,
    synthetic_from_mapping,
    synthetic_motion,
)

__all__ = [
    "FORMATS",
    "STANDARD_GRAVITY",
    "GroundMotion",
    "RecordContents",
    "ResponseSpectrum",
    "SyntheticParameters",
    "oscillator_response",
    "read_motion",
    "record_contents",
    "response_spectrum",
    "synthetic_from_mapping",
    "synthetic_motion",
]
