"""The figure of a motion. Loads matplotlib: imported where it is drawn."""

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from rockbatch.figures import figure, styled
from rockbatch.units import GRAVITY

if TYPE_CHECKING:
    from rockbatch.motions.motion import Motion


@styled
def plot(motion: "Motion", width_mm: float) -> Figure:
    """See :meth:`rockbatch.Motion.plot`."""
    components = {"horizontal": motion.horizontal} | ({} if motion.vertical is None else {"vertical": motion.vertical})
    drawn = figure(width_mm, 14.0 + 32.0 * len(components))
    for axes, (what, samples) in zip(
        drawn.subplots(len(components), sharex=True, sharey=True, squeeze=False)[:, 0], components.items(), strict=True
    ):
        axes.plot(np.arange(motion.npts) * motion.dt, samples / GRAVITY, color="black", linewidth=0.6)
        axes.set(ylabel=f"{what} [g]", xlim=(0.0, motion.duration))
    axes.set_xlabel("time [s]")
    drawn.suptitle(motion.label)
    return drawn
