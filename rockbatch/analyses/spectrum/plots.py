"""Figures of spectrum, for notebooks and papers; the report draws its own. Loads matplotlib: imported where one is drawn."""

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from rockbatch.analyses.spectrum import map_drawing as overturning_map
from rockbatch.analyses.spectrum.study import INTENSITY, SELF_SIMILAR
from rockbatch.common.figures.style import COLOURS, line, panels, styled, with_legend
from rockbatch.common.lazy import pd

_PLACES = {"overturned without impact": 0, "overturned with impact": 1, "flight": 2, "undecided": 3}
"""Places of the colours of regions of a map, as in the report."""


SYMBOLS = {
    "two_pi_over_p_s": r"$2\pi/p$ [s]", "p": "$p$ [rad/s]", "size_m": "$R_0$ [m]", "alpha": r"$\alpha$",
    SELF_SIMILAR: r"$\omega_g/p$,  $\omega_g$ = PGA/PGV", INTENSITY: r"PGA/($g\,\tan\alpha$)",
}  # fmt: skip
"""Axes and parameters of spectra as matplotlib writes them."""


@styled
def spectrum(
    spectra: "pd.DataFrame | None",
    suite: "pd.DataFrame | None",
    maps: "pd.DataFrame | None",
    axis: str,
    width_mm: float,
) -> Figure:
    """See :meth:`rockbatch.analyses.spectrum.analysis.Spectrum.plot`."""
    of_spectra: list[Any] = []
    apart = INTENSITY if axis == SELF_SIMILAR else "alpha"
    if spectra is not None and suite is not None:
        lines = dict(list(spectra.groupby(["case", apart], sort=False)))
        of_spectra = [(key, lines[key], median) for key, median in suite.groupby(["case", apart], sort=False)]
    apart_maps = [] if maps is None else list(maps.columns[: list(maps.columns).index("omega_p_over_p")])
    of_maps: list[Any] = [] if maps is None else list(maps.groupby(apart_maps, sort=False, dropna=False))
    drawn, grid = panels(len(of_spectra) + len(of_maps), width_mm)
    for axes, ((case, value), lines_of_case, median) in zip(grid, of_spectra, strict=False):
        _spectrum(axes, lines_of_case, median, axis)
        axes.set_title(rf"{case}, {SYMBOLS[apart]} = {value:g}")
    for axes, (names, regions) in zip(grid[len(of_spectra) :], of_maps, strict=True):
        _map(axes, regions)
        varied = (f"{key} = {value}" for key, value in zip(apart_maps[2:], names[2:], strict=True) if value == value)
        axes.set_title(", ".join([*names[:2], *varied]))
    return with_legend(drawn, grid)


def _spectrum(axes: Axes, spectra: "pd.DataFrame", suite: "pd.DataFrame", axis: str) -> None:
    """Draw a line for each record, which ends where the pier overturns, and the median for each slenderness, × where infinite."""
    several = suite["alpha"].nunique() > 1
    for place, (alpha, median) in enumerate(suite.groupby("alpha", sort=False)):
        of_alpha = spectra[spectra["alpha"] == alpha]
        for _, of_record in of_alpha.groupby(["record", "polarity", *_scale(axis)], sort=False):
            stood = of_record["theta_max_over_alpha"].where(of_record["status"] == "ok")
            axes.plot(of_record[axis], stood, color="0.65", linewidth=0.6, label="each record")
        name = rf"median, $\alpha$ = {alpha:g}" if several else "median"
        fell = median.loc[np.isinf(median["median"]), axis]
        if len(fell):
            height = np.full(len(fell), 0.96 - 0.05 * place)  # of the panel: one row for each slenderness
            axes.plot(
                fell, height, transform=axes.get_xaxis_transform(), color=COLOURS[place % len(COLOURS)],
                marker="x", linestyle="", label="overturned or ended by flight",
            )  # fmt: skip
        axes.plot(median[axis], median["median"].replace(math.inf, math.nan), **line(place), label=name)
    axes.set(xlabel=SYMBOLS[axis], ylabel=r"$\theta_{\max}/\alpha$", ylim=(0, 1.1))


def _scale(axis: str) -> list[str]:
    """Return the column "scale" where a curve has one scale, which in a self-similar spectrum follows from the slenderness."""
    return [] if axis == SELF_SIMILAR else ["scale"]


def _map(axes: Axes, regions: "pd.DataFrame") -> None:
    """Draw the regions of a map with their boundaries, as the report does; none where the pier stands."""
    strips = overturning_map.strips(regions)
    for outcome, place in _PLACES.items():
        outlines = [
            Path(np.transpose((np.append(x, x[0]), np.append(y, y[0]))), closed=True)
            for x, y in overturning_map.areas(strips, outcome)
        ]
        if outlines:  # as one path, or a hair of background would show where two strips meet
            together = Path.make_compound_path(*outlines)
            axes.add_patch(PathPatch(together, color=COLOURS[place], alpha=0.35, linewidth=0.0, label=outcome))
    for x, y in (*overturning_map.inside(strips), *overturning_map.between(strips)):
        axes.plot(x, y, color="black", linewidth=0.8)
    low, high = regions["low"].min(), regions["high"].max()
    edges = strips[0].frequencies[0], strips[-1].frequencies[-1]
    axes.set(xlabel=r"$\omega_p/p$", ylabel=r"$a_p/(g\,\tan\alpha)$", xlim=edges, ylim=(low, high))
    axes.grid(False)
