"""``python -m rockbatch``, and the command ``rockbatch``."""

import sys


def main() -> int:
    """Run the command line; an interrupt while it is being loaded is told as any other."""
    try:
        from rockbatch.cli import main as command_line

        return command_line()
    except KeyboardInterrupt:
        print("rockbatch: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
