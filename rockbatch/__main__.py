"""``python -m rockbatch``, and the command ``rockbatch``."""

import os
import sys

from rockbatch.common.garbage import collect_rarely


def main() -> int:
    """Run the command line; an interrupt while it is being loaded is reported as any other."""
    # Threads of OpenBLAS and numexpr would gain nothing here, and if they cannot start, these end the process when loaded.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    collect_rarely()
    try:
        from rockbatch.commands.cli import main as command_line

        return command_line()
    except KeyboardInterrupt:
        print("rockbatch: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
