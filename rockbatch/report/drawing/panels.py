"""The picture of the paper's Fig. 7: a panel per record, a marker per foundation, the rigid base as a line."""

import math
from collections.abc import Sequence
from typing import Any

from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import ends, key, line, lowered, marker, rectangle, sign_of, style_of, svg, text
from rockbatch.report.finished import Finished, as_dicts
from rockbatch.report.labels import Series
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.table import THETA_FORMAT
from rockbatch.results.suite_statistics import NO_PEAK

HEIGHT = 146.0  # px
VISIBLE = 0.015  # share of the axis: shorter error bars hide behind their marker
RIGID_LINES = 4
DRAWN = ["record", "series", "polarity", "status", "theta_max_over_alpha", "theta_max_error", "pga"]
"""Columns that a panel is made of."""

Run = dict[str, Any]


def draw(
    finished: Finished, runs: "pd.DataFrame", records: Sequence[str], top: float, side: str = "polarity"
) -> Markup:
    """Draw panels of ``records``; ``top`` is the end of the common axis, θ_max/α."""
    runs = runs.assign(side=runs[side])
    present = sorted(
        (finished.series[place] for place in runs["series"].unique()),
        key=lambda series: (not series.rigid, series.index),
    )
    ticks = {series.index: series.tick for series in present if not series.rigid}
    width = min(max(166.0, 56 + 13.0 * (max(ticks, default=0) + 1)), 900.0)
    sides = sorted(runs["side"].unique())
    panel = _Panel(finished.series, top, bool(runs["status"].isin(NO_PEAK).any()), ticks, width, sides)
    by_record = grouped(as_dicts(runs[[*DRAWN, "side"]]), lambda run: run["record"])
    drawn = []
    for name in records:
        pga = by_record[name][0]["pga"]
        peak = f"PGA = {pga:.3f} g" if math.isfinite(pga) else ""
        title = tag("figcaption", tag("span", finished.shown(name)), " ", tag("span", peak, class_="muted"))
        drawn.append(tag("figure", title, panel.draw(finished.label(name), by_record[name])))
    grid = tag("div", *drawn, class_="panels", style=f"--w:{width:.0f}px", tabindex="0", role="group",
               aria_label="Panels; arrow keys go through the values")  # fmt: skip
    entries = [
        (_key(series, side in sides[1:]), series.keyed + (f" ({side})" if len(sides) > 1 else ""))
        for series in present
        for side in sides
    ]
    return join(grid, key([*entries, *ends(set(runs["status"]))]))


def _key(series: Series, second: bool) -> Markup:
    if series.rigid:
        return line(0, 7, 22, 7, _rigid(series, second))
    return _foundation(series, second, 11, 7)


def _foundation(series: Series, second: bool, x: float, y: float, title: str | None = None) -> Markup:
    shape, colour = style_of(series.index)
    return marker(shape, x, y, colour=f"s{colour}" + (" open" if second else ""), title=title)


class _Panel:
    """Axes and styles that the panels of a figure have in common."""

    def __init__(
        self, series: list[Series], top: float, eventful: bool, ticks: dict[int, str], width: float, sides: list[str]
    ) -> None:
        self.series, self.top, self.eventful, self.ticks, self.sides = series, top, eventful, ticks, sides
        self.size = width, HEIGHT
        across, down = Scale(0.2, max(ticks, default=0) + 1.8), Scale(0, 1.18 * top if eventful else top)
        self.axes = Axes(36, 17, width - 40, HEIGHT - 36, across, down)

    def draw(self, name: str, runs: list[Run]) -> Markup:
        axes = self.axes
        drawn = []
        if self.eventful:
            drawn.append(rectangle(axes.left, axes.top, axes.width, float(axes.down(self.top)) - axes.top, "band"))
        drawn.append(axes.frame(None, [tick for tick in Scale(0, self.top).ticks(4) if tick <= self.top]))
        foot = axes.top + axes.height + 13
        every = math.ceil(20 * len(self.ticks) / axes.width)  # or names would overlap
        names = [(slot, tick) for slot, tick in self.ticks.items() if slot % every == 0]
        drawn += [text(float(axes.across(slot + 1)), foot, tick, class_="m") for slot, tick in names]
        drawn.append(text(axes.left - 2, axes.top - 4, lowered("θ", "max", "/α"), class_="q"))
        drawn += map(self._run, sorted(runs, key=lambda run: not self.series[run["series"]].rigid))
        return svg(*self.size, *drawn, description=f"θmax/α of every foundation under {name}", class_="plot marks")

    def _run(self, run: Run) -> Markup:
        axes, series = self.axes, self.series[run["series"]]
        two_sides, right = len(self.sides) > 1, self.axes.left + self.axes.width
        second = two_sides and run["side"] == self.sides[1]
        x = float(axes.across(0.42 if series.rigid else series.index + 1 + (0.32 * second - 0.16) * two_sides))
        status, theta, error = run["status"], run["theta_max_over_alpha"], run["theta_max_error"]
        words = said_of(series, run, two_sides)
        if status in NO_PEAK:
            level = float(axes.down(1.09 * self.top))
            level_line = line(axes.left, level, right, level, _rigid(series, second)) if series.rigid else ""
            return join(level_line, sign_of(status, x, level, words))
        if status == "failed" or math.isnan(theta):
            return sign_of("failed", x, axes.top + axes.height - 8, words)
        y = float(axes.down(theta))
        bar = Markup("")
        if error > VISIBLE * self.top:
            ends = float(axes.down(min(theta + error, axes.y.high))), float(axes.down(max(theta - error, 0)))
            bar = tag("path", d=f"M{x - 2.5:.1f} {ends[0]:.1f}h5m-2.5 0V{ends[1]:.1f}m-2.5 0h5", class_="bar")
        if series.rigid:
            return join(line(axes.left, y, right, y, _rigid(series, second), words), bar)
        return join(bar, _foundation(series, second, x, y, words))


def said_of(series: Series, run: Run, two_sides: bool) -> str:
    """Return the tooltip of a marker: "2: η = 3.5: 0.0617 ± 3e-07"."""
    name = series.label + (f" ({run['polarity']})" if two_sides else "")
    if run["status"] != "ok":
        return f"{name}: {run['status']}"
    error = run["theta_max_error"]
    return f"{name}: {number(run['theta_max_over_alpha'], THETA_FORMAT)}" + (
        f" ± {error:.0e}" if error == error else ""
    )


def _rigid(series: Series, second: bool) -> str:
    return f"rigid d{series.index % RIGID_LINES}" + (" reversed" if second else "")
