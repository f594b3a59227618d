"""What makes two scenarios the same: all that decides the results, as a text and as a hash."""

from __future__ import annotations

import hashlib
import json
import os
from array import array
from collections.abc import Iterator, Mapping
from functools import lru_cache
from typing import Any

from railquake.files import read_file
from railquake.inputs.marks import File, Label, Samples, holds, marked
from railquake.inputs.model import InputModel
from railquake.messages import unreadable

__all__ = ["files_of", "fingerprint", "hash_of_fingerprints"]


def fingerprint(section: InputModel | None) -> str:
    """All of a scenario's section that decides the results, as a text.

    Parameters
    ----------
    section : InputModel or None
        Such as ``scenario.support``.

    Returns
    -------
    str
        Equal texts mean equal inputs; the content of files counts, not their names.

    Raises
    ------
    InputError
        If a file that the section names cannot be read.
    """
    if section is None:
        return "null"
    data = section.model_dump()
    _reduce(data, section)
    return json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)


def hash_of_fingerprints(texts: Mapping[str, str]) -> str:
    """`Scenario.content_hash` from the fingerprints of all sections by name.

    Parameters
    ----------
    texts : mapping
        For each section of a scenario what `fingerprint` gives.
    """
    canonical = ",".join(f'"{name}":{texts[name]}' for name in sorted(texts))
    return hashlib.sha256(f"{{{canonical}}}".encode()).hexdigest()


def files_of(section: InputModel) -> Iterator[str]:
    """Paths of all files that a section names.

    Parameters
    ----------
    section : InputModel
        Such as ``scenario.wheelrail``.
    """
    files = marked(type(section), File)
    for name, value in section:
        if name in files and value is not None:
            yield value
        for model in _models(value):
            yield from files_of(model)


def _reduce(data: dict[str, Any], section: InputModel) -> None:
    """Leave of a model's values what decides the results."""
    for name in section.without_effect():
        del data[name]
    files, samples = marked(type(section), File), marked(type(section), Samples)
    for name, value in section:
        if name not in data or value is None:
            continue
        if name in files:
            data[name] = _file_hash(value)
        elif name in samples:
            data[name] = hashlib.sha256(array("d", value).tobytes()).hexdigest()
        elif models := _models(value):
            tables = data[name] if isinstance(value, tuple) else [data[name]]
            for table, model in zip(tables, models, strict=True):
                if model.without_effect() or holds(type(model), File, Label, Samples):
                    _reduce(table, model)


def _models(value: Any) -> list[InputModel]:
    items = value if isinstance(value, tuple) else (value,)
    return list(items) if items and isinstance(items[0], InputModel) else []


def _file_hash(path: str) -> str:
    try:
        found = os.stat(path)
        return _hash_of(path, found.st_mtime_ns, found.st_size)
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        raise unreadable(path, error) from error


@lru_cache(maxsize=4096)
def _hash_of(path: str, changed: int, size: int) -> str:
    """Hash of a file's content, read again when its time or size has changed."""
    return hashlib.sha256(read_file(path)).hexdigest()
