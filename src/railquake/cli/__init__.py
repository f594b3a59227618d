"""The command ``railquake``: thin, every command calls what a Python user would call.

`stopping`     Ctrl-C, heard before anything else is imported
`commands`     all commands; a module a group of them
`application`  what they register with
`status`       from the arguments to an exit status
`shared`       what several commands need
"""

from collections.abc import Sequence

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; its exit status.

    Parameters
    ----------
    arguments : sequence of str, optional
        Instead of the command line's.

    Returns
    -------
    int
        See `status.main`.
    """
    from railquake.cli.commands import main as run  # not with this package: `stopping` is quick

    return run(arguments)
