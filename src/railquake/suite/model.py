"""A suite of ground motions: what each is made from, and by what it is scaled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from railquake.inputs.ground_motion import GroundMotion

__all__ = ["Suite", "SuiteMember"]


@dataclass(frozen=True)
class SuiteMember:
    """One motion of a suite.

    Parameters
    ----------
    name : str
        Unlike that of any other member.
    motion : mapping
        The table ``[motion]`` of a case file without its scale, paths absolute:
        ``{"record": "/records/RSN181.AT2"}`` or ``{"synthetic": {"seed": 1}}``.
    scale_factor : float
        Factor on the motion at the suite's reference level, over zero.
    """

    name: str
    motion: Mapping[str, Any]
    scale_factor: float

    def ground_motion(self) -> GroundMotion:
        """Read or make the motion, scaled by its factor.

        Returns
        -------
        GroundMotion

        Raises
        ------
        InputError
            If a record's file cannot be used.
        """
        from railquake.inputs.model import validated
        from railquake.inputs.motion import Motion

        table = {**self.motion, "scale": self.scale_factor}
        return validated(Motion, table, f"motion {self.name}").lateral_motion()


@dataclass(frozen=True)
class Suite:
    """Ground motions that are used together, each with its scale factor.

    Parameters
    ----------
    name : str
        What to call it.
    members : tuple of SuiteMember
        At least one.
    """

    name: str
    members: tuple[SuiteMember, ...]
