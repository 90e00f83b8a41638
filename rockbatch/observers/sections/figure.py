"""Envelopes of forces over the height of the shaft."""

from collections.abc import Iterable, Sequence

import numpy as np

from rockbatch.common.figures.description import DASHES, Figure, Look, Panel, Polyline, line_of, spanning
from rockbatch.common.lazy import pd
from rockbatch.common.units import with_unit
from rockbatch.results.labels import Series
from rockbatch.results.sections import columns_in


def over_height(groups: "Iterable[tuple[str, pd.DataFrame]]", series: Sequence[Series]) -> Figure:
    """Return the envelopes of forces over the height of the shaft: for each group, panels of shear, moment and axial force.

    ``groups`` are runs of a pier at a scale with their rows of sections.csv, and words for them.
    """
    panels = []
    for words, runs in groups:
        columns = columns_in(runs)
        height = spanning("height [m]", runs["height_m"].to_numpy())
        for caption, forces in _OVER_HEIGHT.items():
            marks = [
                _envelope(runs[runs["series"] == place], columns[name].name, which, series[place])
                for place in runs["series"].unique()
                for name, which in forces.items()
            ]
            first = columns[next(iter(forces))]
            across = spanning(with_unit(first.symbol, first.unit), *(mark.x for mark in marks))
            panels.append(Panel(across, height, marks, caption, words, 240.0, 200.0))
    return Figure(panels, "Envelopes of shear, moment and axial force over the height of the shaft")


_OVER_HEIGHT = {
    "greatest shear": {"shear": "max"},
    "greatest moment": {"moment": "max"},
    "least and greatest axial force": {"axial_least": "min", "axial_greatest": "max"},
}
"""Captions of panels, with their forces and which of the values of a foundation's runs each line shows."""


def _envelope(runs: "pd.DataFrame", column: str, which: str, foundation: Series) -> Polyline:
    """Return the line of a column of sections.csv over height: the greatest or least, "max" or "min", of a foundation's runs."""
    values = runs.groupby("height_m")[column].agg(which)
    look = Look("level", dash=foundation.index % DASHES) if foundation.rigid else line_of(foundation.index)
    x, y = values.to_numpy(np.float64), values.index.to_numpy(np.float64)
    return Polyline(x, y, look=look, label=foundation.label, title=foundation.label)
