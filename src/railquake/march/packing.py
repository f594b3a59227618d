"""Between rows and the named tuples that laws see.

A block of rows is read as a named tuple, or written from one, field by field.  The functions are
made from the fields' names, since compiled code can neither loop over fields nor take their number
as it runs.
"""

from collections.abc import Callable
from typing import Any

__all__ = ["reader", "writer"]


def reader(kind: type) -> Callable[..., Any]:
    """Function ``(rows, first, lane) -> kind`` that reads a block of rows.

    Parameters
    ----------
    kind : type
        A named tuple class; its fields stand in the block in their order.
    """
    fields = kind._fields  # type: ignore[attr-defined]
    values = ", ".join(f"rows[first + {k}, lane]" for k in range(len(fields)))
    return _made("read", "rows, first, lane", f"return kind({values})", kind)


def writer(kind: type) -> Callable[..., None]:
    """Function ``(rows, first, value, lane)`` that writes a block of rows; see `reader`."""
    fields = kind._fields  # type: ignore[attr-defined]
    lines = [f"rows[first + {k}, lane] = value.{field}" for k, field in enumerate(fields)]
    return _made("write", "rows, first, value, lane", "\n    ".join(lines), kind)


def _made(verb: str, arguments: str, body: str, kind: type) -> Callable[..., Any]:
    key = (verb, kind)
    if key not in _KNOWN:
        _KNOWN[key] = _compiled(f"{verb}_{kind.__name__.lower()}", arguments, body, kind)
    return _KNOWN[key]


_KNOWN: dict[tuple[str, type], Callable[..., Any]] = {}  # one function a kind, however often asked


def _compiled(name: str, arguments: str, body: str, kind: type) -> Callable[..., Any]:
    scope: dict[str, Any] = {"kind": kind, "__name__": __name__}
    exec(f"def {name}({arguments}):\n    {body}\n", scope)
    made: Callable[..., Any] = scope[name]
    made.__qualname__ = f"{name} of {kind.__module__}"
    return made
