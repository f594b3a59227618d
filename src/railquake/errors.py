"""The one error that a user can cause."""


class InputError(ValueError):
    """An input cannot be used as it stands.

    The message is a single line for the person who reads it: which file, which field or line,
    what was found there and what to do about it.  The command line prints it and exits with
    status 2.
    """
