"""The paper's claims, a file each.

Gomez & DeJong (2023), "Analytical parametric investigation of nonlinear train-structure
interaction under earthquake excitation".  Each file quotes the sentence or figure that it tests.
Another claim is another file here and nothing else; docs/theory/findings.md shows one.
"""

from __future__ import annotations

import pkgutil
from importlib import import_module

from railquake.findings.claim import Claim

__all__ = ["every_claim"]


def every_claim() -> tuple[Claim, ...]:
    """The claims of all files of this folder, in the order that they state."""
    found = []
    for item in sorted(pkgutil.iter_modules(__path__), key=lambda item: item.name):
        module = import_module(f"{__name__}.{item.name}")
        found += [value for value in vars(module).values() if isinstance(value, Claim)]
    return tuple(sorted(found, key=lambda claim: claim.order))
