"""Titles and samples of recordings of which copies are made."""

import numpy as np
from motion_files import wiggle


def title(component: str, station: str = "STA", event: str = "Somewhere, 1/17/1994") -> str:
    return f"{event}, {station}, {component}"


def shaken(seed: int, n: int = 1500):
    """Two horizontal components and a vertical one, the second horizontal one half as strong."""
    return [scale * wiggle(n, seed + k) * np.hanning(n) for k, scale in enumerate((1.0, 0.5, 0.4))]
