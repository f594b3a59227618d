"""Cross-sections of wheels and rails.

`shape`      the `Profile` itself and questions asked of one (flange tip, gauge face)
`segments`   profiles drawn from straight lines, arcs and polynomials
`standards`  S1002 and 60E1 from the standards' own definitions
`reader`     measured or exported profiles: ``.prw``, ``.prr``, CSV

Axes everywhere: the right-hand wheel and rail, ``y`` positive outward (away from the track's
centre; flange and gauge face lie at negative ``y``), ``z`` positive down, metres.
"""

from railquake.inputs.profile.reader import read_profile
from railquake.inputs.profile.segments import (
    Arc,
    Line,
    Polynomial,
    Segment,
    profile_from_segments,
    segments_from_table,
)
from railquake.inputs.profile.shape import (
    Profile,
    ProfileKind,
    face_offset,
    flange_tip,
    outward_lean,
    point_at_height,
)
from railquake.inputs.profile.standards import BUILTIN_PROFILES, builtin_profile

__all__ = [
    "BUILTIN_PROFILES",
    "Arc",
    "Line",
    "Polynomial",
    "Profile",
    "ProfileKind",
    "Segment",
    "builtin_profile",
    "face_offset",
    "flange_tip",
    "outward_lean",
    "point_at_height",
    "profile_from_segments",
    "read_profile",
    "segments_from_table",
]
