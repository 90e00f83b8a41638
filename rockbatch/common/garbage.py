"""Collection of garbage."""

import atexit
import gc


def collect_rarely() -> None:
    """Let Python collect garbage less often for the life of the process, and not at its end.

    Most of what is loaded and compiled lives on: with Python's own thresholds a twentieth of a command's time, and more of
    a compilation's, goes into looking through it again. Its end takes as long where Python looks for what is freed anyway.
    """
    gc.set_threshold(50_000, 20, 100)
    atexit.register(gc.freeze)
