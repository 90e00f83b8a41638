"""What holds for every figure that the product makes in a test: its marks are on its axes, and reach along them."""

import sys

import numpy as np
import pytest

from rockbatch.common.figures.description import Area, Figure, Points, Polyline, Rule, Span, Words

CUT = {"rockbatch.outcome.figures", "rockbatch.reporting.sections.histories"}
"""Modules whose figures show a stretch of runs, and of a pier that overturns its curve up to a rotation."""
LEAST_REACH = 0.25
"""Share of the abscissa that the marks of a panel reach at least."""


def places_on(panel, mark, axis):
    """Return the finite places of a mark along the axis "x" or "y" of its panel: 0 at its beginning, 1 at its end."""
    if isinstance(mark, Points | Polyline | Area | Words):
        values = getattr(mark, axis)
    elif mark.axis == axis:
        values = mark.at if isinstance(mark, Rule) else [mark.low, mark.high]
    else:
        values = []
    with np.errstate(divide="ignore", invalid="ignore"):
        places = getattr(panel, axis).fraction(np.atleast_1d(values))
    return places[np.isfinite(places)]


def off_its_axes(figure):
    """Return which marks of a figure are not on its axes; lines may leave them with less than half of their points."""
    wrong = []
    for panel in figure.panels:
        for axis in "xy":
            reach = [0.0]
            for mark in panel.marks:
                places = places_on(panel, mark, axis)
                outside = np.mean(np.abs(places - 0.5) > 0.5 + 1e-6) if len(places) else 0.0
                if outside > (0.5 if isinstance(mark, Polyline) else 0.0):
                    wrong.append(f"{panel.caption}: {type(mark).__name__} beyond the {axis} axis")
                reach += [1.0] if isinstance(mark, Span) else places.tolist()
            if axis == "x" and 0.0 < max(reach) < LEAST_REACH:
                wrong.append(f"{panel.caption}: only {max(reach):.2g} of the {axis} axis")
    return wrong


def check_every_figure():
    """Have every figure checked that a function of the product describes from now on."""
    describe = Figure.__init__

    def checked(self, *args, **more):
        describe(self, *args, **more)
        maker = sys._getframe(1).f_globals["__name__"]
        if maker.startswith("rockbatch.") and maker not in CUT and (wrong := off_its_axes(self)):
            pytest.fail(f"{maker}: {'; '.join(wrong)}")

    Figure.__init__ = checked
