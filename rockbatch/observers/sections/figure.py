"""Envelopes of forces over the height of the shaft."""

from collections.abc import Iterable, Sequence

import numpy as np

from rockbatch.common.figures.description import DASHES, Figure, Look, Panel, Polyline, line_of, spanning
from rockbatch.common.lazy import pd
from rockbatch.results.labels import Series
from rockbatch.results.sections import columns_in


def over_height(groups: "Iterable[tuple[str, pd.DataFrame]]", series: Sequence[Series]) -> Figure:
    """Return the envelopes of forces over the height of the shaft: for each group, panels of shear, moment and axial force.

    ``groups`` are runs of a pier at a scale with their rows of sections.csv, and words for them.
    """
    panels = []
    for words, runs in groups:
        heads, columns = columns_in(runs)
        height = spanning("height [m]", runs["height_m"].to_numpy())
        for caption, names in _OVER_HEIGHT.items():
            marks = [
                _envelope(runs[runs["series"] == place], columns[name], series[place])
                for place in runs["series"].unique()
                for name in names
            ]
            forces = spanning(heads[names[0]], *(mark.x for mark in marks))
            panels.append(Panel(forces, height, marks, caption, words, 240.0, 200.0))
    return Figure(panels, "Envelopes of shear, moment and axial force over the height of the shaft")


_OVER_HEIGHT = {
    "greatest shear": ("shear",),
    "greatest moment": ("moment",),
    "least and greatest axial force": ("axial_least", "axial_greatest"),
}


def _envelope(runs: "pd.DataFrame", column: str, foundation: Series) -> Polyline:
    """Return the line of a column of sections.csv over height: the greatest of a foundation's runs, or least of the least N."""
    of_heights = runs.groupby("height_m")[column]
    values = of_heights.min() if "least" in column else of_heights.max()
    look = Look("level", dash=foundation.index % DASHES) if foundation.rigid else line_of(foundation.index)
    x, y = values.to_numpy(np.float64), values.index.to_numpy(np.float64)
    return Polyline(x, y, look=look, label=foundation.label, title=foundation.label)
