"""The damper that just passes: demand over limit of every check against the force of the dampers."""

from pathlib import Path

from matplotlib.figure import Figure

import rockbatch as rb

STUDY = rb.load_study(Path(__file__).parents[2] / "configs" / "damper_that_passes.toml")


def draw() -> Figure:
    return rb.design(STUDY, progress=False).plot()
