"""``python -m rockbatch``, and the command ``rockbatch``."""

import gc
import os
import sys


def main() -> int:
    """Run the command line; an interrupt while it is being loaded is reported as any other."""
    # Threads of OpenBLAS and numexpr would gain nothing here, and if they cannot start, these end the process when loaded.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    # Most of what is loaded lives on: with Python's own thresholds a twentieth of the time goes into looking through it again
    gc.set_threshold(50_000, 20, 100)
    try:
        from rockbatch.cli import main as command_line

        return command_line()
    except KeyboardInterrupt:
        print("rockbatch: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
