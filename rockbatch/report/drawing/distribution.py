"""The distribution of the largest rotations over the suite: a panel for each pier and scale, a curve for each foundation."""

from collections.abc import Sequence

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import COLOURS, curve, key, line, lowered, marker, rectangle, svg, text
from rockbatch.report.labels import Series
from rockbatch.report.markup import Markup, join, tag
from rockbatch.results.rows import counts_as
from rockbatch.results.suite_statistics import distribution

WIDTH, HEIGHT = 300.0, 190.0
DASHES = 4


def draw(groups: "Sequence[tuple[str, pd.DataFrame]]", series: Sequence[Series], count: str) -> Markup:
    """Draw a panel for each of the groups of runs, with their captions; ``count`` is what counts as one record."""
    eventful = any(runs["status"].isin(["overturned", "flight"]).any() for _, runs in groups)
    panels = [
        tag("figure", tag("figcaption", words or "all runs"), _panel(words, runs, series, count, eventful))
        for words, runs in groups
    ]
    places = sorted({place for _, runs in groups for place in runs["series"].unique()})
    entries = [(line(0, 7, 22, 7, _style(series[place])), series[place].label) for place in places]
    if eventful:
        entries.append((marker("overturned", 11, 7, colour="alarm"), "overturned, or ended by flight"))
    grid = tag("div", *panels, class_="panels", style=f"--w:{WIDTH:.0f}px", role="group", aria_label="Distributions")
    return join(grid, key(entries))


def _panel(words: str, runs: "pd.DataFrame", series: Sequence[Series], count: str, eventful: bool) -> Markup:
    peaks = runs["theta_max_over_alpha"].where(runs["status"] == "ok").to_numpy(dtype=np.float64)
    top = 1.04 * float(np.nanmax(peaks, initial=0.0)) or 1.0
    right = 1.08 * top if eventful else top
    axes = Axes(32, 22, WIDTH - 44, HEIGHT - 60, Scale(0.0, right), Scale(0.0, 1.0))
    drawn: list[Markup] = []
    edge = float(axes.across(top))
    if eventful:
        drawn.append(rectangle(edge, axes.top, axes.left + axes.width - edge, axes.height, "band"))
    drawn.append(axes.frame([tick for tick in Scale(0, top).ticks(5) if tick <= top], axes.y.ticks(5)))
    for place, group in runs.groupby("series"):
        foundation = series[int(str(place))]
        theta, share = distribution(
            group["theta_max_over_alpha"].to_numpy(dtype=np.float64),
            group["status"].to_list(),
            counts_as(group, count)[0].to_list(),
        )
        reached = float(share[-1]) if len(share) else 0.0
        x = np.repeat(np.concatenate(([0.0], theta, [right])), 2)[1:-1]
        y = np.repeat(np.concatenate(([0.0], share)), 2)
        drawn.append(curve(axes.across(np.minimum(x, right)), axes.down(y), _style(foundation), foundation.label))
        if reached < 1.0 and group["status"].isin(["overturned", "flight"]).any():
            note = f"{foundation.label}: {100 * (1 - reached):.0f} % overturned, or ended by flight"
            mid = 0.5 * (edge + axes.left + axes.width)
            drawn.append(line(mid, float(axes.down(reached)), mid, float(axes.down(1.0)), _style(foundation)))
            drawn.append(marker("overturned", mid, float(axes.down(0.5 * (1.0 + reached))), colour="alarm", title=note))
    drawn.append(text(axes.left + axes.width / 2, HEIGHT - 6, lowered("θ", "max", "/α"), class_="m q"))
    drawn.append(text(axes.left - 26, 11, "share of the records", class_="q"))
    return svg(WIDTH, HEIGHT, *drawn, description=f"Distribution of θmax/α{', ' + words if words else ''}")


def _style(series: Series) -> str:
    """Return the line's classes: the rigid base in ink, others in colours; dashed where a colour repeats."""
    dash = series.index % DASHES if series.rigid else series.index // COLOURS % DASHES
    colour = "ink" if series.rigid else f"s{series.index % COLOURS + 1}"
    return f"level {colour}" + (f" d{dash}" if dash else "")
