"""The one error that a user can cause, and all others on one line."""


class InputError(ValueError):
    """An input cannot be used as it stands.

    The message is a single line for the person who reads it: which file, which field or line,
    what was found there and what to do about it.  The command line prints it and exits with
    status 2.
    """


def on_one_line(error: Exception) -> str:
    """Kind and message of an error that nobody foresaw, on one line."""
    return " ".join(f"{type(error).__name__}: {error}".split())
