"""Laws that may stand in one place, by name: a family is filled by lying in its folder.

A law is a record with a ``name``, as a case file has it; all else in it is a matter of those who
use the family.  A law from outside the package joins its family by `Family.add`, and may then be
named like one of the package's own.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from threading import RLock
from typing import Any, Generic, Protocol, TypeVar

from railquake.errors import InputError
from railquake.messages import shown

__all__ = ["CREEP_LAWS", "HINGE_LAWS", "RESTITUTION_LAWS", "Family"]


class Named(Protocol):
    """What has a name."""

    @property
    def name(self) -> str:
        """As a case file has it."""


Law = TypeVar("Law", bound=Named)


class Family(Generic[Law]):
    """Laws by name, in the order in which they were found: those of the package first.

    Parameters
    ----------
    kind : str
        What its members are, ``"creep law"``.
    package : str, optional
        Where the package's own laws are: each module in it that has a ``LAW`` adds that one.  They
        are imported when a law is first asked for, and not with the family.

    Examples
    --------
    >>> family = Family("greeting law")
    >>> law = family.add(SimpleNamespace(name="wave"))
    >>> family["wave"] is law
    True
    """

    def __init__(self, kind: str, package: str | None = None) -> None:
        self.kind = kind
        self.package = package
        self._laws: dict[str, Law] = {}
        self._built_in: tuple[str, ...] = ()
        self._looked = package is None
        self._looking = False
        self._lock = RLock()

    def add(self, law: Law) -> Law:
        """Let a law join.

        Parameters
        ----------
        law : object
            With a ``name``.

        Returns
        -------
        object
            The law.

        Raises
        ------
        InputError
            If another one has its name.
        """
        self._look()
        with self._lock:
            return self._join(law)

    def built_in(self) -> tuple[str, ...]:
        """Names of the package's own laws."""
        self._look()
        return self._built_in

    def names(self) -> tuple[str, ...]:
        """Names of all laws."""
        self._look()
        return tuple(self._laws)

    def listed(self) -> str:
        """All names, as a message has them: ``"she", "carter" or "polach"``."""
        *most, last = [shown(name) for name in self.names()] or ["none"]
        return f"{', '.join(most)} or {last}" if most else last

    def __getitem__(self, name: str) -> Law:
        self._look()
        if name not in self._laws:
            raise InputError(f"there is no {self.kind} {shown(name)}; known: {self.listed()}")
        return self._laws[name]

    def __contains__(self, name: object) -> bool:
        self._look()
        return isinstance(name, str) and name in self._laws

    def __iter__(self) -> Iterator[str]:
        return iter(self.names())

    def __len__(self) -> int:
        return len(self.names())

    def _join(self, law: Law) -> Law:
        known = self._laws.get(law.name)
        if known is not None and known is not law:
            raise InputError(
                f"there is a {self.kind} {shown(law.name)} already; give the new one another name"
            )
        self._laws[law.name] = law
        return law

    def _look(self) -> None:
        """Import the package's own laws, once."""
        if self._looked:
            return
        with self._lock:  # another thread that looks meanwhile waits until all are there
            if self._looked or self._looking or self.package is None:
                return
            self._looking = True  # a law that asks for others while it is imported gets those there
            try:
                folder = import_module(self.package)
                for module in pkgutil.iter_modules(folder.__path__):
                    law = getattr(import_module(f"{self.package}.{module.name}"), "LAW", None)
                    if law is not None:
                        self._join(law)
            finally:
                self._looking = False
            self._built_in = tuple(self._laws)
            self._looked = True


CREEP_LAWS: Family[Any] = Family("creep law", "railquake.physics.creep")
"""How Kalker's linear forces saturate: `physics.creep.CreepLaw`."""
RESTITUTION_LAWS: Family[Any] = Family("restitution law", "railquake.physics.impact")
"""How much of an impact is lost: `physics.impact.RestitutionLaw`."""
HINGE_LAWS: Family[Any] = Family("hinge law", "railquake.physics.hinge")
"""The hinge at the column's base: `physics.hinge.HingeLaw`."""
