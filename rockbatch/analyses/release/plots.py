"""Figures of release, for notebooks and papers; the report draws its own. Loads matplotlib: imported where one is drawn."""

import numpy as np
from matplotlib.figure import Figure

from rockbatch.common.figures.style import line, marks, panels, styled, with_legend
from rockbatch.common.lazy import pd


@styled
def release(fits: "pd.DataFrame", impacts: "pd.DataFrame", history: "pd.DataFrame", width_mm: float) -> Figure:
    """See :meth:`rockbatch.analyses.release.analysis.Release.plot`."""
    keys = list(fits.columns[: list(fits.columns).index("parameter")])
    cases = [list(table.groupby(keys, sort=False, dropna=False)) for table in (impacts, history)]
    drawn, grid = panels(len(fits), width_mm)
    for axes, (_, measured), (names, computed), fit in zip(grid, *cases, fits.to_dict("records"), strict=True):
        axes.plot(computed["t_s"], computed["theta_rad"], label="computed", **line(0))
        axes.plot(measured["t_measured_s"], 0.0 * measured["t_measured_s"], label="measured impacts", **marks(1))
        t_computed, amplitude = measured["t_amplitude_computed_s"], measured["amplitude_measured_rad"]
        side = np.sign(np.interp(t_computed, computed["t_s"], computed["theta_rad"]))
        axes.plot(t_computed, side * amplitude, label="measured amplitudes", **marks(2))
        axes.set(xlabel="t [s]", title=f"{', '.join(map(str, names))}: {fit['parameter']} = {fit['value']:.4g}")
    grid[0].set_ylabel(r"$\theta$ [rad]")
    return with_legend(drawn, grid)
