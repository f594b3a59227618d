"""Models of the structure in OpenSees, to hold ours against and to calibrate it on.

OpenSees comes with the extra ``railquake[fem]``.
"""

from __future__ import annotations

from typing import Any

from railquake.errors import InputError

__all__ = ["opensees"]


def opensees() -> Any:
    """OpenSees' Python module.

    Raises
    ------
    InputError
        If it is not installed, with the extra that brings it.
    """
    try:
        import opensees.openseespy as module
    except ImportError:
        raise InputError(
            "OpenSees is needed and not installed: pip install railquake[fem]"
        ) from None
    return module
