"""The picture of the paper's Fig. 5: a column of histories per run, loops at its foot."""

import shlex
from collections.abc import Sequence
from operator import itemgetter
from typing import Any

import numpy as np

from rockbatch.common.grouping import grouped
from rockbatch.report.drawing.axes import Axes, Scale, spanning
from rockbatch.report.drawing.history import LOOPS_HEIGHT, QUANTITIES, History, reduced
from rockbatch.report.drawing.svg import Array, curve, line, lowered, marker, rectangle, svg, text
from rockbatch.report.finished import Finished, as_dicts, worst_first
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.templates import render
from rockbatch.results.histories_file import Responses
from rockbatch.results.run_json import FROM_PYTHON
from rockbatch.simulation.response import Response

MOST_COLUMNS = 40
LEFT, WIDTH = 42.0, 176.0  # px
TOPS, HEIGHTS = (17.0, 134.0, 218.0, 302.0), (94.0, 60.0, 60.0, 60.0)
FOOT = 398.0
OVER = 1.5
"""Rotation over α beyond which the picture of a pier that overturns ends."""
LABELS = (QUANTITIES[0], QUANTITIES[1], QUANTITIES[2], lowered("ü", "g", "/g"))

Row = dict[str, Any]


def section(finished: Finished) -> Markup:
    """Draw the stored histories; empty if there are none."""
    if not len(finished.responses):
        return Markup("")
    words = list(map(str, finished.info["command"]))
    from_command = not any(word.endswith(FROM_PYTHON) for word in words)
    command = shlex.join([*words, "--history", "RECORD"]) if from_command else ""
    return render("report/sections/histories.html", pictures=_pictures(finished, finished.responses), command=command)


def _pictures(finished: Finished, responses: Sequence[Response]) -> list[dict[str, Any]]:
    """Draw a picture for each pier: a column for every response, or for the worst of many; with what its caption depends on."""
    rows = _rows_of(finished, responses)
    numbers = _chosen(finished, rows)
    same_motion = itemgetter("record", "polarity", "scale", "pier")
    rigid = {same_motion(run): number for number, run in reversed([*enumerate(rows)]) if run["rigid"]}
    behind = {number: None if rows[number]["rigid"] else rigid.get(same_motion(rows[number])) for number in numbers}
    # A rigid base drawn behind another column needs none of its own
    columns = [number for number in numbers if number not in behind.values()]
    needed = sorted({number for number in (*columns, *behind.values()) if number is not None})
    chosen = responses.without_rows(needed) if isinstance(responses, Responses) else map(responses.__getitem__, needed)
    drawn = {number: reduced(response, LEFT, WIDTH) for number, response in zip(needed, chosen, strict=True)}
    pictures = []
    for pier, of_pier in grouped(columns, lambda number: rows[number]["pier"]).items():
        of_pier.sort(key=lambda number: (not rows[number]["rigid"], rows[number]["index"]))
        histories = [drawn[number] for column in of_pier for number in (column, behind[column]) if number is not None]
        scales = [_scale(histories, row) for row in range(len(QUANTITIES))]
        # As many loops below each column, so that columns beside each other line up
        shown = [drawn[number] for number in of_pier]
        devices = max(len(history.devices) for history in shown)
        loops = any(history.loops for history in shown)
        feet = [*([0] if loops else []), *range(1, 1 + devices)]
        cells = []
        for number in of_pier:
            back, record = behind[number], finished.label(rows[number]["record"])
            drawing = picture(drawn[number], None if back is None else drawn[back], scales, record, feet)
            cells.append(tag("figure", tag("figcaption", _title(finished, rows[number])), drawing))
        grid = tag("div", *cells, class_="histories", style=f"--w:{LEFT + WIDTH + 6:.0f}px")
        pictures.append({
            "pier": finished.piers[pier], "grid": grid, "loops": loops, "devices": devices,
            "flights": any(len(history.flights) for history in shown), "bands": any(history.band for history in shown),
            "lines": any(behind[number] is not None for number in of_pier),
        })  # fmt: skip
    return pictures


def _rows_of(finished: Finished, responses: Sequence[Response]) -> list[Row]:
    """Return the runs that have histories, without reading these."""
    if isinstance(responses, Responses):
        runs = as_dicts(responses.runs)
    else:
        names = ("record", "case", "polarity", "scale", "status")
        runs = [{name: getattr(response, name) for name in names} | response.columns for response in responses]
    rows = []
    for run in runs:
        series, pier = finished.place(run["case"], run)
        foundation = finished.series[series]
        rows.append(run | {"series": series, "pier": pier, "rigid": foundation.rigid, "index": foundation.index})
    return rows


def _chosen(finished: Finished, rows: Sequence[Row]) -> list[int]:
    """Return the numbers of the runs to show: all, or of many the worst of each case, and of many cases the worst."""
    if len(rows) <= MOST_COLUMNS:
        return list(range(len(rows)))
    names = ["record", "polarity", "scale", "series", "pier"]
    number_of = {tuple(run[name] for name in names): number for number, run in enumerate(rows)}
    ordered = worst_first(finished.runs, len(finished.runs)).drop_duplicates(names)[names].itertuples(index=False)
    pairs, numbers = set(), []
    for key in map(tuple, ordered):
        if key in number_of and key[3:] not in pairs:
            pairs.add(key[3:])
            numbers.append(number_of[key])
    return numbers[:MOST_COLUMNS]


def _scale(shown: Sequence[History], row: int) -> Scale:
    """Return one scale for all columns, not stretched by piers that overturned."""
    stood = [history for history in shown if history.status == "ok"] or shown
    bands = [np.array([-history.band, history.band]) for history in stood] if row == 0 else []
    return spanning(*(history.curves[row][1] for history in stood), *bands)


def _standing(history: History, row: int) -> Array:
    """Return a quantity until the pier overturns, since later values would hide how it rocked."""
    t, theta = history.curves[0]
    beyond = np.flatnonzero(np.abs(theta) > OVER)
    times, values = history.curves[row]
    return values[times <= t[beyond[0]]] if len(beyond) else values


def _title(finished: Finished, run: Row) -> Markup:
    also = [f"scaled by {run['scale']:g}" if run["scale"] != 1 else "", "reversed" if run["polarity"] == "-" else ""]
    details = ", ".join(filter(None, also))
    record = tag("span", finished.named(run["record"]) + (f", {details}" if details else ""), class_="muted")
    return join(tag("span", finished.series[run["series"]].label), " ", record)


def picture(
    history: History, behind: History | None, scales: Sequence[Scale], record: str, feet: Sequence[int] = ()
) -> Markup:
    """Draw a column of histories; ``feet`` are the loops below it: 0 for those of springs, from 1 on for devices."""
    end = max(history.end[0], behind.end[0] if behind else 0.0) or 1.0
    drawn: list[Markup] = []
    for row, (top, height) in enumerate(zip(TOPS, HEIGHTS, strict=True)):
        scale = scales[row] if history.status == "ok" else spanning(_standing(history, row))
        axes = Axes(LEFT, top, WIDTH, height, Scale(0, end), scale)
        if row == 0 and history.band:
            y = np.clip(axes.down(np.array([history.band, -history.band])), top, top + height)
            drawn.append(rectangle(LEFT, y[0], WIDTH, y[1] - y[0], "band"))
        drawn.append(axes.frame(axes.x.ticks(4), scale.ticks(5 if row == 0 else 4), x_numbers=row == len(TOPS) - 1))
        curves = [_curve(axes, *history.curves[row], "curve rigid" if history.rigid else "curve", QUANTITIES[row])]
        if behind is not None and row < 3:
            curves.insert(0, _curve(axes, *behind.curves[row], "curve behind", f"{QUANTITIES[row]}, rigid base"))
        drawn.append(axes.readable("time", *curves))
        if row == 0:
            drawn.append(_events(axes, history))
        drawn.append(text(LEFT - 2, top - 5, LABELS[row], class_="q"))
    drawn.append(text(LEFT + WIDTH / 2, FOOT - 4, "t [s]", class_="m q"))
    height = FOOT
    for row in feet:
        if row < len(history.devices) + 1:
            drawn.append(tag("g", (history.loops, *history.devices)[row], transform=f"translate(0 {height:g})"))
        height += LOOPS_HEIGHT
    description = f"Rotation, velocity, energy and ground acceleration against time under {record}"
    return svg(LEFT + WIDTH + 6, height, *drawn, description=description, class_="plot readings")


def _curve(axes: Axes, t: Array, y: Array, class_: str, name: str) -> Markup:
    inside = np.where((y >= axes.y.low) & (y <= axes.y.high), y, np.nan)  # a pier that fell leaves the picture
    return curve(axes.across(t), axes.down(inside), class_, name)


def _events(axes: Axes, h: History) -> Markup:
    """Draw impacts at the foot, separations at the top, flights across, the peak with its value, and the end of the run."""
    foot, marks = axes.top + axes.height, []
    for times, start, length in ((h.impacts, foot, -5), (h.separations, axes.top, 5)):
        strokes = "".join(f"M{x:.1f} {start:.1f}v{length}" for x in axes.across(times))
        marks.append(tag("path", d=strokes, class_="event") if strokes else Markup(""))
    marks += [line(float(x), axes.top, float(x), foot, "flown") for x in axes.across(h.flights)]
    x, y = float(axes.across(h.peak[0])), float(axes.down(np.clip(h.peak[1], axes.y.low, axes.y.high)))
    if h.status == "ok" and h.peak[1] != 0:
        to_the_left = x > LEFT + 0.75 * WIDTH
        value = text(
            x + (-4 if to_the_left else 4), y + 3, f"{abs(h.peak[1]):.4f}", class_="e peak" if to_the_left else "peak"
        )
        marks += [tag("circle", cx=f"{x:.1f}", cy=f"{y:.1f}", r="2.2", class_="peak"), value]
    if h.status in ("overturned", "flight"):
        end = float(axes.across(h.end[0])), float(axes.down(np.clip(h.end[1], axes.y.low, axes.y.high)))
        marks.append(marker(h.status, *end, colour="alarm"))
    return join(*marks)
