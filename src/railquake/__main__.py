"""``python -m railquake`` is the command ``railquake``."""

import sys

from railquake.cli.stopping import STOPPED, STOPPED_TEXT, stop_requests_heard


def main() -> int:
    """Run the command; its exit status.

    Returns
    -------
    int
        That of `railquake.cli.main`, also where Ctrl-C comes before there is a command.
    """
    try:
        with stop_requests_heard():
            from railquake.cli import main as run_command

            return run_command()
    except KeyboardInterrupt:
        print(f"railquake: {STOPPED_TEXT}", file=sys.stderr)
        return STOPPED


if __name__ == "__main__":
    raise SystemExit(main())
