"""The one error that a user can cause."""

__all__ = ["InputError", "printable"]


class InputError(ValueError):
    """An input cannot be used as it stands.

    The message is a single line for the person who reads it: which file, which field or line,
    what was found there and what to do about it.  The command line prints it and exits with
    status 2.
    """

    def __str__(self) -> str:
        """The message; what a file brought in and a terminal would obey is spelled out."""
        return printable(super().__str__())


def printable(text: str) -> str:
    """A text in which every character can be seen: others, such as escapes, are spelled out.

    Parameters
    ----------
    text : str
        On one line afterwards, whatever it was.
    """
    if text.isprintable():
        return text
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
