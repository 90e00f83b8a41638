"""The statics of all cases in two pictures: acceleration that holds the pier over rotation, period over amplitude."""

from collections.abc import Callable, Sequence

import numpy as np

from rockbatch.pier.statics import Statics
from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import COLOURS, Array, Entry, curve, line, side_by_side, svg, text
from rockbatch.report.markup import Markup

WIDTH, HEIGHT = 420.0, 230.0
MOST = 3 * COLOURS
"""Most cases that are drawn: colours times dashes."""

Line = Callable[[Statics], tuple[Array, Array]]


def draw(sheets: Sequence[tuple[str, Statics]]) -> Markup:
    """Draw both pictures, a line for each case."""
    drawn = sheets[:MOST]
    return side_by_side(
        [
            ("Steady horizontal ground acceleration that holds the pier [g]", *_picture(drawn, _quasi_static, "θ/α")),
            ("Period of free rocking [s]", *_picture(drawn, _period, "amplitude/α")),
        ],
        WIDTH,
    )


def _quasi_static(sheet: Statics) -> tuple[Array, Array]:
    equilibria = sheet.equilibria
    return equilibria.theta / sheet.pier.alpha, equilibria.acceleration


def _period(sheet: Statics) -> tuple[Array, Array]:
    swings = sheet.swings_at
    return swings.amplitude / sheet.pier.alpha, swings.period


def _picture(sheets: Sequence[tuple[str, Statics]], line_of: Line, across: str) -> tuple[Markup, list[Entry]]:
    lines = [line_of(sheet) for _, sheet in sheets]
    right = max((float(x.max()) for x, _ in lines if len(x)), default=1.0)
    top = max((float(np.nanmax(y, initial=0.0)) for _, y in lines), default=1.0)
    axes = Axes(36, 10, WIDTH - 48, HEIGHT - 48, Scale(0.0, right or 1.0), Scale(0.0, 1.06 * top or 1.0))
    drawn = [axes.frame(axes.x.ticks(8), axes.y.ticks(6))]
    entries: list[Entry] = []
    for place, ((name, _), (x, y)) in enumerate(zip(sheets, lines, strict=True)):
        style = f"level s{place % COLOURS + 1}" + f" d{place // COLOURS}" * (place >= COLOURS)
        drawn.append(curve(axes.across(x), axes.down(y), style, name))
        entries.append((line(0, 7, 22, 7, style), name))
    drawn.append(text(axes.left + axes.width / 2, HEIGHT - 6, across, class_="m q"))
    return svg(WIDTH, HEIGHT, *drawn, description=f"Statics over {across}"), entries
