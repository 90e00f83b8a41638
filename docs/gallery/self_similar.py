"""Self-similar spectra: three slendernesses on one curve, at two intensities, under near-fault records."""

from pathlib import Path

from matplotlib.figure import Figure

import rockbatch as rb

STUDY = Path(__file__).parents[2] / "configs" / "self_similar.toml"


def draw() -> Figure:
    return rb.spectrum(STUDY).plot()
