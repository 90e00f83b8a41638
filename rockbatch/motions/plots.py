"""The figure of a motion. Loads matplotlib: imported where it is drawn."""

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

from rockbatch.common.figures import figure, styled
from rockbatch.common.units import GRAVITY


@styled
def plot(components: Mapping[str, npt.NDArray[np.float64]], dt: float, title: str, width_mm: float) -> Figure:
    """See :meth:`rockbatch.Motion.plot`, which hands over its components."""
    drawn = figure(width_mm, 14.0 + 32.0 * len(components))
    for axes, (name, samples) in zip(
        drawn.subplots(len(components), sharex=True, sharey=True, squeeze=False)[:, 0], components.items(), strict=True
    ):
        axes.plot(np.arange(len(samples)) * dt, samples / GRAVITY, color="black", linewidth=0.6)
        axes.set(ylabel=f"{name} [g]", xlim=(0.0, (len(samples) - 1) * dt))
    axes.set_xlabel("time [s]")
    drawn.suptitle(title)
    return drawn
