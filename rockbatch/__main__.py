"""``python -m rockbatch``, and the command ``rockbatch``."""

import sys


def main() -> int:
    """Run the command line and return its exit code; Ctrl-C while modules are still imported ends with its message and 130."""
    try:
        import os

        from rockbatch.common.garbage import collect_rarely

        # Threads of OpenBLAS and numexpr would gain nothing here, and if they cannot start, these end the process when loaded.
        os.environ.setdefault("OMP_NUM_THREADS", "1")
        collect_rarely()
        from rockbatch.commands.cli import main as command_line

        return command_line()
    except KeyboardInterrupt:
        import signal

        signal.signal(signal.SIGINT, signal.SIG_IGN)  # a second one would interrupt the message and the end
        print("rockbatch: interrupted", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
