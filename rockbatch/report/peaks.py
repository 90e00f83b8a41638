"""The picture of the paper's Fig. 7: a panel per record, a marker per foundation, the rigid base as a line."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rockbatch.report.finished import Finished, Run, Series
from rockbatch.report.markup import Markup
from rockbatch.report.svg import ALARM, BAND, INK, MUTED, PAPER, arrow, drawing, inline, style_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH = 10.0  # inch
RIGID_LINES = ("-", "--", ":", "-.")
HAPPENED = {"overturned": "overturned", "flight": "flight: both pivots off the ground"}


def ceiling(runs: Sequence[Run]) -> float:
    """Top of the axis [θ_max/α] that holds all of ``runs`` that stood."""
    highest = max((run.theta + (run.error or 0) for run in runs if run.status == "ok" and run.theta), default=0.0)
    return 1.1 * highest if highest > 0 else 1.0


def draw(finished: Finished, runs: Sequence[Run], top: float, name: str) -> Markup:
    """Peaks of one pier as SVG; ``top`` is the end of the common axis, θ_max/α."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    records = finished.by_pga(runs)
    columns = _columns(len(records))
    rows = math.ceil(len(records) / columns)
    panel = 1.75 if columns <= 4 else 1.3
    width = WIDTH if columns > 2 else 3.6 * columns + 0.6
    entries = _entries(runs)
    across = max(1, int(width / (0.6 + 0.07 * max(len(label) for _, label in entries))))
    legend = 0.1 + 0.175 * math.ceil(len(entries) / across)
    height = rows * (panel + 0.42) + 0.28 + legend

    with drawing(name):
        figure = Figure(figsize=(width, height))
        # Limits are set panel by panel: Matplotlib's shared axes cost time with the square of their number
        panels = figure.subplots(rows, columns, squeeze=False)
        figure.subplots_adjust(
            left=0.68 / width, right=1 - 0.08 / width, top=1 - 0.4 / height, bottom=(0.28 + legend) / height,
            wspace=0.12, hspace=0.5 / panel,
        )  # fmt: skip
        eventful = any(run.status in HAPPENED for run in runs)
        ticks = {run.series.index + 1: run.series.tick for run in runs if not run.series.rigid}
        for place, axes in enumerate(panels.flat):
            if place >= len(records):
                axes.remove()
                continue
            scale = runs[0].scale
            axes.set_title(_title(finished.record(records[place]), records[place], scale, columns), fontsize=7.5)
            axes.grid(axis="y")
            axes.tick_params(labelbottom=place + columns >= len(records), labelleft=place % columns == 0, length=2.5)
            _panel(axes, [run for run in runs if run.record == records[place]], top, eventful, max(ticks, default=1))
            axes.set_yticks([tick for tick in MaxNLocator(4).tick_values(0, top) if tick <= top])
            axes.set_xticks(sorted(ticks), [ticks[slot] for slot in sorted(ticks)])
            if place % columns == 0:
                axes.set_ylabel("θmax/α")
        _legend(figure, entries, across)
        return inline(figure, f"θmax/α of every foundation, one panel for each of {len(records)} records")


def _columns(panels: int) -> int:
    for columns, most in ((1, 1), (2, 4), (3, 9), (4, 16)):
        if panels <= most:
            return columns
    return 6


def _title(record: dict[str, Any], name: str, scale: float, columns: int) -> str:
    room = int(120 / max(columns, 3))
    short = name if len(name) <= room else f"{name[: room // 2]}…{name[-(room // 2 - 1) :]}"
    return f"{short}\nPGA = {record['pga_g'] * scale:.3f} g" if record else short


def _panel(axes: "Axes", runs: Sequence[Run], top: float, eventful: bool, slots: int) -> None:
    edge = 1.16 * top if eventful else top
    level = 1.08 * top
    axes.set_ylim(0, edge)
    axes.set_xlim(0.3, slots + 0.7)
    if eventful:
        axes.axhspan(top, edge, color=BAND, linewidth=0)
    directions = sorted({run.polarity for run in runs})
    for run in runs:
        beside = 0.0 if len(directions) == 1 else (-0.15, 0.15)[directions.index(run.polarity)]
        x = 0.5 if run.series.rigid else run.series.index + 1 + beside
        if run.series.rigid:
            height = level if run.status in HAPPENED else run.theta
            if height is not None and run.status != "failed":
                style = RIGID_LINES[run.series.index % len(RIGID_LINES)]
                axes.axhline(height, color=INK, linewidth=1.1, linestyle=style, alpha=_opacity(run))
        if run.status in HAPPENED:
            axes.plot([x], [level], **_event(run.status))
        elif run.status == "failed" or run.theta is None:
            axes.text(x, 0.02 * top, "no result", rotation=90, fontsize=6.5, color=MUTED, ha="center", va="bottom")
        elif not run.series.rigid:
            if run.error and run.error > 0.004 * top:
                axes.errorbar([x], [run.theta], [run.error], color=INK, capsize=2, linewidth=0.8)
            axes.plot([x], [run.theta], **_marker(run.series, run.polarity))
        elif run.error and run.error > 0.004 * top:
            axes.errorbar([x], [run.theta], [run.error], color=INK, capsize=2, linewidth=0.8)


def _opacity(run: Run) -> float:
    return 0.55 if run.polarity == "-" else 1.0


def _marker(series: Series, polarity: str) -> dict[str, Any]:
    """Reversed motions have open markers."""
    marker, colour = style_of(series.index)
    face = PAPER if polarity == "-" else colour
    size = 8.0 if marker == "*" else 5.5
    return {"marker": marker, "color": colour, "markerfacecolor": face, "markersize": size, "linestyle": "none"}


def _event(status: str) -> dict[str, Any]:
    marker: Any = "X" if status == "overturned" else arrow()
    return {
        "marker": marker, "color": ALARM, "markersize": 9, "markeredgecolor": PAPER, "markeredgewidth": 0.5,
        "linestyle": "none",
    }  # fmt: skip


def _entries(runs: Sequence[Run]) -> list[tuple[dict[str, Any], str]]:
    """The legend: how each series is drawn, and its name."""
    entries: dict[str, dict[str, Any]] = {}
    both = len({run.polarity for run in runs}) > 1
    for run in sorted(runs, key=lambda run: (not run.series.rigid, run.series.index, run.polarity)):
        series = run.series
        named = series.rigid or series.label.split(":")[0] == series.tick
        label = (series.label if named else f"{series.tick} – {series.label}") + (f" ({run.polarity})" if both else "")
        if series.rigid:
            style = RIGID_LINES[series.index % len(RIGID_LINES)]
            entries[label] = {"color": INK, "linewidth": 1.1, "linestyle": style, "alpha": _opacity(run)}
        else:
            entries[label] = _marker(series, run.polarity)
    for status, words in HAPPENED.items():
        if any(run.status == status for run in runs):
            entries[words] = _event(status)
    return [(style, label) for label, style in entries.items()]


def _legend(figure: "Figure", entries: Sequence[tuple[dict[str, Any], str]], across: int) -> None:
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], **style) for style, _ in entries]
    labels = [label for _, label in entries]
    figure.legend(handles, labels, loc="lower center", ncols=across, fontsize=8, borderpad=0, columnspacing=1.5)
