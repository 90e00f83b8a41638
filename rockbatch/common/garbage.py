"""Collection of garbage."""

import gc


def collect_rarely() -> None:
    """Have Python look for garbage less often, for the life of the process.

    Most of what is loaded and compiled lives on: with Python's own thresholds a twentieth of a command's time, and more of
    a compilation's, goes into looking through it again.
    """
    gc.set_threshold(50_000, 20, 100)
