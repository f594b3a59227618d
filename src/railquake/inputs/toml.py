"""Tables of a case file: reading, merging, overriding, writing."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from railquake.errors import InputError
from railquake.messages import unreadable

# Of these keys a table takes one; an override by one of them removes the others from the preset.
ALTERNATIVES = (
    ("height", "heights"),
    ("gauge", "rail_centre"),
    ("record", "synthetic", "acceleration"),
)
# An override of these replaces the preset's whole table.
WHOLE = ("wheel", "rail")
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
        return tomllib.loads(Path(path).read_bytes().decode("utf-8-sig"))
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


def merged(base: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """Lay one table over another, table by table.

    Parameters
    ----------
    base : mapping
        What is overridden.  A list of tables with names may be overridden by a table of tables.
    over : mapping
        What wins.

    Returns
    -------
    dict
        New; the arguments are left alone.
    """
    result = dict(base)
    for group in ALTERNATIVES:
        if any(key in over for key in group):
            for key in group:
                result.pop(key, None)
    for key, value in over.items():
        old = base.get(key)
        if isinstance(value, Mapping) and isinstance(old, list | tuple) and _all_named(old):
            old = {item["name"]: item for item in old}
        if isinstance(value, Mapping) and isinstance(old, Mapping) and key not in WHOLE:
            result[key] = merged(old, value)
        else:
            result[key] = value
    return result


def _all_named(items: Sequence[Any]) -> bool:
    return all(isinstance(i, Mapping) and isinstance(i.get("name"), str) for i in items)


def with_overrides(
    data: Mapping[str, Any], overrides: Iterable[str] | Mapping[str, Any], where: str = "--set"
) -> dict[str, Any]:
    """Override single values of a case by their paths.

    Parameters
    ----------
    data : mapping
        The case's tables.
    overrides : iterable of str, or mapping
        ``"motion.scale=1.5"``: the value is read as TOML, or, where it is none, as a text
        (``"support.length=7 m"``).  Or paths and values: ``{"motion.scale": 1.5}``.
    where : str
        What to call their origin in messages.

    Returns
    -------
    dict
        New; the arguments are left alone.

    Raises
    ------
    InputError
        If there is no path, or it leads through something that is not a table.
    """
    pairs = overrides.items() if isinstance(overrides, Mapping) else map(split_override, overrides)
    result = dict(data)
    # Presets first, so that the order in which values are given does not matter.
    for path, value in sorted(pairs, key=lambda pair: not pair[0].endswith(".preset")):
        steps = [step.strip() for step in path.split(".")]
        if not all(steps):
            raise InputError(
                f'{where}: "{path}" is no path of a value; write e.g. motion.scale=1.5'
            )
        if len(steps) == 2 and steps[1] == "preset" and _is_whole(result.get(steps[0])):
            result[steps[0]] = {}
        over: Any = value
        for step in reversed(steps):
            over = {step: over}
        here: Any = result
        for depth, step in enumerate(steps[:-1]):
            if not isinstance(here, Mapping):
                break
            here = here.get(step, {})
            if not isinstance(here, Mapping) and not (
                isinstance(here, list | tuple) and _all_named(here)
            ):
                raise InputError(
                    f"{where}: {path}: {'.'.join(steps[: depth + 1])} is not a table, "
                    "so nothing inside it can be set"
                )
        result = merged(result, over)
    return result


def _is_whole(section: Any) -> bool:
    """Whether a section needs no preset: its values would hide all of one set over it."""
    if not isinstance(section, Mapping) or "preset" in section:
        return False
    return "name" in section or section.get("kind", "pier") != "pier"


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
