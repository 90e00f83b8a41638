"""The picture of the paper's Fig. 7: a panel per record, a marker per foundation, the rigid base as a line."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rockbatch.report.axes import Axes, Scale
from rockbatch.report.document import figure
from rockbatch.report.finished import Finished, as_dicts
from rockbatch.report.labels import Series
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.peaks import at_a_glance
from rockbatch.report.svg import EVENTS, key, line, lowered, marker, rectangle, style_of, svg, text
from rockbatch.report.table import THETA_FORMAT
from rockbatch.statistics import NO_PEAK

if TYPE_CHECKING:
    import pandas as pd

HEIGHT = 138.0  # px
VISIBLE = 0.015  # of the axis: error bars that are shorter hide behind their marker
RIGID_LINES = 4
MOST_RECORDS = 60
MOST_FIGURES = 12
MOST_MARKS = 12_000  # on the page: a megabyte and a half


def ceiling(runs: "pd.DataFrame") -> float:
    """Top of the axis [θ_max/α] that holds all of ``runs`` that stood."""
    stood = runs[runs["status"] == "ok"]
    highest = (stood["theta_max_over_alpha"] + stood["theta_max_error"].fillna(0)).max()
    return 1.1 * float(highest) if highest > 0 else 1.0


def chosen(finished: Finished, runs: "pd.DataFrame", figures: int = 1) -> list[str]:
    """Records that have a panel, in order of PGA: all of them, or of many those with the worst runs."""
    names = list(runs["record"].unique())
    room = max(1, min(MOST_RECORDS, MOST_MARKS * len(names) // max(1, len(runs) * figures)))
    if len(names) > room:
        badness = runs["theta_max_over_alpha"].where(~runs["status"].isin(NO_PEAK), math.inf)
        worst = badness.groupby(runs["record"]).max().sort_values(ascending=False, kind="stable")
        names = list(worst.index[:room])
    return finished.by_pga(names)


def figures(finished: Finished, caption: Sequence[object], *, side: str = "polarity") -> Markup:
    """A figure for each pier and scale, or for the first of many; ``caption`` is common to them.

    Runs whose column ``side`` has the second of two values are drawn with open markers.
    """
    groups = finished.groups()
    shown = []
    for words, runs in groups[:MOST_FIGURES]:
        # Piers are compared on one axis; larger motions have their own
        top = ceiling(finished.runs[finished.runs["scale"] == runs["scale"].iloc[0]])
        records = chosen(finished, runs, min(len(groups), MOST_FIGURES))
        every = runs["record"].nunique()
        told = [
            tag("strong", f"{words}. ") if words else "", *caption,
            " Symbols in the shaded strip are runs without a largest rotation: the pier overturned, or left the ground."
            if runs["status"].isin(NO_PEAK).any() else "",
            f" Shown are the {len(records):,} records with the worst runs of {every:,}." if len(records) < every else "",
        ]  # fmt: skip
        shown.append(figure(draw(finished, runs, records, top, side), *told))
        shown.append(at_a_glance(finished, runs, records) if side == "polarity" else Markup(""))
    if len(groups) > MOST_FIGURES:
        shown.append(tag("p", f"The first {MOST_FIGURES} of {len(groups)} combinations of pier and scale are shown."))
    return join(*shown)


def draw(
    finished: Finished, runs: "pd.DataFrame", records: Sequence[str], top: float, side: str = "polarity"
) -> Markup:
    """Panels of ``records``; ``top`` is the end of the common axis, θ_max/α."""
    runs = runs.assign(side=runs[side])
    present = [finished.series[place] for place in sorted(runs["series"].unique())]
    ticks = {series.index: series.tick for series in present if not series.rigid}
    width = min(max(170.0, 52 + 13.0 * (max(ticks, default=0) + 1)), 900.0)
    sides = sorted(runs["side"].unique())
    panel = _Panel(finished.series, top, bool(runs["status"].isin(NO_PEAK).any()), ticks, width, sides)
    drawn = []
    by_record = dict(list(runs.groupby("record", sort=False)))
    for name in records:
        pga = by_record[name]["pga_g"].iloc[0]
        peak = f"PGA = {pga:.3f} g" if math.isfinite(pga) else ""
        title = tag("figcaption", tag("span", name), " ", tag("span", peak, class_="muted"))
        drawn.append(tag("figure", title, panel.draw(name, by_record[name])))
    grid = tag("div", *drawn, class_="panels", style=f"--w:{width:.0f}px", tabindex="0", role="group",
               aria_label="Panels; arrow keys go through the values")  # fmt: skip
    return join(grid, _legend(present, sides, runs))


class _Panel:
    """How every record of a figure is drawn."""

    def __init__(
        self, series: list[Series], top: float, eventful: bool, ticks: dict[int, str], width: float, sides: list[str]
    ) -> None:
        self.series, self.top, self.eventful, self.ticks, self.sides = series, top, eventful, ticks, sides
        self.size = width, HEIGHT
        slots = max(ticks, default=0) + 1
        across, down = Scale(0.2, slots + 0.8), Scale(0, 1.18 * top if eventful else top)
        self.axes = Axes(32, 13, width - 36, HEIGHT - 31, across, down)

    def draw(self, name: str, runs: "pd.DataFrame") -> Markup:
        axes = self.axes
        drawn = []
        if self.eventful:
            y = float(axes.down(self.top))
            drawn.append(rectangle(axes.left, axes.top, axes.width, y - axes.top, "band"))
        drawn.append(axes.frame(None, [tick for tick in Scale(0, self.top).ticks(4) if tick <= self.top]))
        foot = axes.top + axes.height + 11
        every = math.ceil(14 * len(self.ticks) / axes.width)  # or names would overlap
        names = [(slot, tick) for slot, tick in self.ticks.items() if slot % every == 0]
        drawn += [text(float(axes.across(slot + 1)), foot, tick, class_="m") for slot, tick in names]
        drawn.append(text(axes.left - 2, axes.top - 4, lowered("θ", "max", "/α"), class_="q"))
        order = runs["series"].map(lambda place: not self.series[place].rigid)
        drawn += [self._run(run) for run in as_dicts(runs.assign(order=order).sort_values("order", kind="stable"))]
        return svg(*self.size, *drawn, description=f"θmax/α of every foundation under {name}", class_="plot marks")

    def _second(self, run: dict[str, Any]) -> bool:
        return len(self.sides) > 1 and bool(run["side"] == self.sides[1])

    def _run(self, run: dict[str, Any]) -> Markup:
        axes, series = self.axes, self.series[run["series"]]
        beside = 0.0 if len(self.sides) == 1 else (-0.16, 0.16)[self.sides.index(run["side"])]
        x = float(axes.across(0.42 if series.rigid else series.index + 1 + beside))
        status, theta, error = run["status"], run["theta_max_over_alpha"], run["theta_max_error"]
        said = said_of(series, run, len(self.sides) > 1)
        if status in NO_PEAK:
            level = float(axes.down(1.09 * self.top))
            over = (
                line(axes.left, level, axes.left + axes.width, level, _rigid(series, self._second(run)))
                if series.rigid
                else ""
            )
            return join(over, marker(status, x, level, colour="alarm", title=said))
        if status == "failed" or math.isnan(theta):
            low = axes.top + axes.height - 4
            return tag(
                "text",
                "no result",
                tag("title", said),
                class_="none",
                transform=f"translate({x:.1f} {low:.1f}) rotate(-90)",
            )
        y = float(axes.down(theta))
        bar = Markup("")
        if error > VISIBLE * self.top:
            ends = float(axes.down(min(theta + error, axes.y.high))), float(axes.down(max(theta - error, 0)))
            bar = tag("path", d=f"M{x - 2.5:.1f} {ends[0]:.1f}h5m-2.5 0V{ends[1]:.1f}m-2.5 0h5", class_="bar")
        if series.rigid:
            return join(line(axes.left, y, axes.left + axes.width, y, _rigid(series, self._second(run)), said), bar)
        shape, colour = style_of(series.index)
        return join(bar, marker(shape, x, y, colour=f"s{colour}" + (" open" if self._second(run) else ""), title=said))


def said_of(series: Series, run: dict[str, Any], both: bool) -> str:
    """What a marker says when pointed at: "2: η = 3.5: 0.0617 ± 3e-07"."""
    name = series.label + (f" ({run['polarity']})" if both else "")
    if run["status"] != "ok":
        return f"{name}: {run['status']}"
    error = run["theta_max_error"]
    return f"{name}: {number(run['theta_max_over_alpha'], THETA_FORMAT)}" + (
        f" ± {error:.0e}" if error == error else ""
    )


def _rigid(series: Series, second: bool) -> str:
    return f"rigid d{series.index % RIGID_LINES}" + (" reversed" if second else "")


def _legend(present: Sequence[Series], sides: Sequence[str], runs: "pd.DataFrame") -> Markup:
    """How each series is drawn, and its name."""
    entries: list[tuple[Markup, str]] = []
    for series in sorted(present, key=lambda series: (not series.rigid, series.index)):
        named = series.rigid or series.label.split(":")[0] == series.tick
        label = series.label if named else f"{series.tick} – {series.label}"
        for side in sides:
            also, second = (f" ({side})", side == sides[1]) if len(sides) > 1 else ("", False)
            shape, colour = style_of(series.index)
            if series.rigid:
                drawn = line(0, 7, 22, 7, _rigid(series, second))
            else:
                drawn = marker(shape, 11, 7, colour=f"s{colour}" + (" open" if second else ""))
            entries.append((drawn, label + also))
    for status, words in EVENTS.items():
        if (runs["status"] == status).any():
            entries.append((marker(status, 11, 7, colour="alarm"), words))
    return key(entries)
