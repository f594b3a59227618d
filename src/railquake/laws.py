"""Families of laws that may stand in one place, by name."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from typing import Any, Generic, TypeVar

from railquake.errors import InputError

__all__ = ["Family"]

T = TypeVar("T")


class Family(Generic[T]):
    """Laws by name: stub."""

    def __init__(self, kind: str, package: str) -> None:
        self.kind = kind
        self.package = package
        self._laws: dict[str, Any] = {}
        self._looked = False

    def _look(self) -> None:
        if not self._looked:
            self._looked = True
            package = import_module(self.package)
            for found in pkgutil.iter_modules(package.__path__):
                law = getattr(import_module(f"{self.package}.{found.name}"), "LAW", None)
                if law is not None:
                    self.add(law)

    def add(self, law: T) -> T:
        self._laws[law.name] = law  # type: ignore[attr-defined]
        return law

    def names(self) -> tuple[str, ...]:
        self._look()
        return tuple(self._laws)

    def __iter__(self) -> Iterator[str]:
        return iter(self.names())

    def __getitem__(self, name: str) -> T:
        self._look()
        try:
            return self._laws[name]  # type: ignore[no-any-return]
        except KeyError:
            raise InputError(f'there is no {self.kind} "{name}"; known: {", ".join(self._laws)}') from None
