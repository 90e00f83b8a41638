"""Figures of fragility, for notebooks and papers; the report draws its own. Loads matplotlib: imported where one is drawn."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from rockbatch.analyses.fragility.curves import Curve
from rockbatch.common.figures.style import line, marks, panels, styled, with_legend
from rockbatch.common.lazy import pd


@styled
def fragility(table: "pd.DataFrame", curves: Sequence[Curve], width_mm: float) -> Figure:
    """See :meth:`rockbatch.analyses.fragility.analysis.Fragility.plot`."""
    limits = list(dict.fromkeys(curve.limit.name for curve in curves))
    names = list(dict.fromkeys(map(_case, curves)))
    drawn, grid = panels(len(limits), width_mm)
    levels = np.linspace(0.0, table["level"].max(), 201)[1:]
    for curve in curves:
        axes, place = grid[limits.index(curve.limit.name)], names.index(_case(curve))
        chosen = {"case": curve.case.name, "limit_state": curve.limit.name} | curve.case.columns
        rows = table[(table[list(chosen)] == pd.Series(chosen)).all(axis=1)]
        share = rows["exceeded"] / (rows["n"] - rows["undecided"])
        axes.plot(rows["level"], share, **marks(place), label=f"{names[place]}, records")
        if not isinstance(curve.fitted, str):
            axes.plot(levels, curve.fitted.probability(levels), label=names[place], **line(place))
        if curve.windows and not isinstance(curve.windows.fitted, str):
            by_shares = line(place) | {"linestyle": "-."}
            axes.plot(levels, curve.windows.fitted.probability(levels), label=f"{names[place]}, by shares", **by_shares)
    for axes, limit in zip(grid, limits, strict=True):
        axes.set(xlabel=f"{table['measure'].iloc[0]} [{table['unit'].iloc[0]}]", ylim=(0, 1.01), title=limit)
    grid[0].set_ylabel("probability that it is exceeded")
    return with_legend(drawn, grid)


def _case(curve: Curve) -> str:
    return ", ".join([curve.case.name, *(f"{key} = {value}" for key, value in curve.case.columns.items())])
