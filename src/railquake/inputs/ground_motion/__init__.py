"""Ground motions: records of many formats, synthetic motions, spectra and intensities."""

from railquake.inputs.ground_motion.jma import jma_intensity
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
    spectral_intensity,
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
    "jma_intensity",
    "oscillator_response",
    "read_motion",
    "record_contents",
    "response_spectrum",
    "spectral_intensity",
    "synthetic_from_mapping",
    "synthetic_motion",
]
