"""Tables of a case file as text: reading, overrides of the command line, writing."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from railquake.errors import InputError
from railquake.files import read_file
from railquake.messages import unreadable

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def is_path(text: str) -> bool:
    """Say whether a text is a path rather than a built-in name: it has a folder or an ending."""
    return "/" in text or "\\" in text or "." in text


def read_toml(path: str | Path) -> dict[str, Any]:
    """Read a TOML file.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    dict

    Raises
    ------
    InputError
        Naming the file, and the line where it is not TOML.
    """
    try:
        return tomllib.loads(read_file(path).decode("utf-8-sig"))
    except OSError as error:
        raise unreadable(path, error) from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not a UTF-8 text file: {error.reason}") from error
    except (ValueError, RecursionError) as error:
        # ValueError: also numbers of thousands of digits, which tomllib lets through to int().
        message = " ".join(str(error).split())
        at = re.search(r"\s*\(at line (\d+), column (\d+)\)$", message)
        if at:
            message = f"line {at[1]}: not valid TOML: {message[: at.start()]} (column {at[2]})"
            raise InputError(f"{path}, {message}") from None
        raise InputError(f"{path}: not valid TOML: {message}") from None


def split_override(text: str) -> tuple[str, Any]:
    """Split ``path=value`` into path and value.

    Parameters
    ----------
    text : str
        As given to ``--set``.

    Raises
    ------
    InputError
        If there is no equals sign.
    """
    path, equals, value = text.partition("=")
    if not equals or not path.strip():
        raise InputError(f'--set: "{text}" is not path=value; write e.g. motion.scale=1.5')
    value = value.strip()
    try:
        table = tomllib.loads(f"value = {value}")
    except (ValueError, RecursionError):
        return path.strip(), value
    return path.strip(), table["value"] if set(table) == {"value"} else value


def dumps(tables: Mapping[str, Any]) -> str:
    """Write tables as TOML; None is left out.

    Parameters
    ----------
    tables : mapping
        Of texts, numbers, booleans, lists and tables.
    """
    lines: list[str] = []
    _write_table(lines, (), tables)
    return "\n".join(lines).strip() + "\n"


def _write_table(lines: list[str], path: tuple[str, ...], table: Mapping[str, Any]) -> None:
    present = {key: value for key, value in table.items() if value is not None}
    values = {key: value for key, value in present.items() if not isinstance(value, Mapping)}
    if path and (values or not present):
        lines += ["", f"[{'.'.join(_key(step) for step in path)}]"]
    lines += [f"{_key(key)} = {_value(value)}" for key, value in values.items()]
    for key, value in present.items():
        if isinstance(value, Mapping):
            _write_table(lines, (*path, key), value)


def _key(key: str) -> str:
    return key if _BARE_KEY.fullmatch(key) else _text(key)


def _text(text: str) -> str:
    # JSON's escapes are TOML's; only DEL must be escaped too.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, Mapping):
        pairs = (f"{_key(k)} = {_value(v)}" for k, v in value.items() if v is not None)
        return "{" + ", ".join(pairs) + "}"
    if isinstance(value, list | tuple):
        items = [_value(item) for item in value]
        if any(isinstance(item, Mapping) for item in value) or len(items) > 8:
            rows = [", ".join(items[i : i + 8]) for i in range(0, len(items), 8)]
            if any(isinstance(item, Mapping) for item in value):
                rows = items
            return "[\n    " + ",\n    ".join(rows) + ",\n]"
        return "[" + ", ".join(items) + "]"
    raise TypeError(f"{type(value).__name__} has no place in a case file")
