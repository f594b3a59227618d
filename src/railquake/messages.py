"""Words of errors that several modules need: what was found, what is known, why a file is not."""

from __future__ import annotations

import difflib
import shlex
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from railquake.errors import InputError

__all__ = [
    "csv_cell",
    "did_you_mean",
    "first_line",
    "no_folder",
    "on_one_line",
    "reason",
    "refuse_unknown",
    "shell_word",
    "shown",
    "toml_type",
    "unreadable",
]


def on_one_line(error: Exception) -> str:
    """Kind and message of an error that nobody foresaw, on one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())


def first_line(error: BaseException) -> str:
    """What an error of another program says first; empty if it says nothing."""
    return (str(error).splitlines() or [""])[0]


def reason(error: Exception) -> str:
    """Why a file cannot be read or written, on one line."""
    if isinstance(error, UnicodeDecodeError):
        return "is not text (UTF-8)"
    return getattr(error, "strerror", None) or " ".join(str(error).split())


def unreadable(path: str | Path, error: Exception) -> InputError:
    """Make the error for a file that cannot be read.

    Parameters
    ----------
    path : str or Path
    error : Exception
        What Python raised.
    """
    return InputError(f"{path}: cannot be read: {reason(error)}")


def no_folder(folder: Path, remedy: str) -> InputError:
    """Make the error for something that should be a folder and is none.

    Parameters
    ----------
    folder : Path
    remedy : str
        What to do, ``"give the one that holds the records"``.
    """
    what = "is no folder" if folder.exists() else "there is no such folder"
    return InputError(f"{folder}: {what}; {remedy}")


def did_you_mean(word: object, known: Iterable[str]) -> str:
    """Say which of the known words is nearest, or list them all.

    Parameters
    ----------
    word : object
        What was found; nothing is near to what is no text.
    known : iterable of str
        What would have been accepted.
    """
    words = list(known)
    text = word.lower() if isinstance(word, str) else ""
    near = difflib.get_close_matches(text, [k.lower() for k in words], n=1)
    listed = ", ".join(words)
    if near:
        best = next(k for k in words if k.lower() == near[0])
        return f'did you mean "{best}"? (known: {listed})'
    return f"known: {listed}"


def refuse_unknown(keys: Iterable[object], known: Sequence[str], before: str) -> None:
    """Refuse a table with a key that has no meaning.

    Parameters
    ----------
    keys : iterable
        Of the table.
    known : sequence of str
        All keys that it may have.
    before : str
        What stands before the key in the message: ``"case.toml: "`` or ``"study.toml: suite."``.

    Raises
    ------
    InputError
        Naming the first such key, and the known one that is nearest.
    """
    for key in keys:
        if key not in known:
            raise InputError(f"{before}{key}: unknown key; {did_you_mean(key, known)}")


def csv_cell(text: str) -> str:
    """A text for a cell of a CSV file that no spreadsheet takes for a formula; numbers stay."""
    if not text.lstrip().startswith(("=", "+", "-", "@")) and text[:1] not in ("\t", "\r"):
        return text
    try:
        float(text)
    except ValueError:
        return f"'{text}"
    return text


def shell_word(path: str | Path) -> str:
    """A path as it is typed in a command: quoted, and no option though it begins with a dash."""
    text = str(path)
    return shlex.quote(f"./{text}" if text.startswith("-") else text)


def shown(value: object) -> str:
    """Show a value in a message: in one short line, whatever it is."""
    if (
        type(value).__module__ == "numpy"
        and hasattr(value, "item")
        and not getattr(value, "ndim", 1)
    ):
        value = value.item()
    if isinstance(value, str):
        return '"' + " ".join(value[:60].split()) + '"'
    if isinstance(value, int) and abs(value) >= 10**60:
        return "a number of more than 60 digits"
    text = " ".join(repr(value).split())
    return text if len(text) <= 60 else text[:57] + "..."


def toml_type(value: object) -> str:
    """Name a value's type as a case file's author knows it."""
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, list | tuple):
        return "a list"
    return shown(value)
