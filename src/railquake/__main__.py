"""``python -m railquake`` is the command ``railquake``."""

from railquake.cli import main

if __name__ == "__main__":
    raise SystemExit(main())
