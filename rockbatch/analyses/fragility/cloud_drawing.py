"""Pictures of a cloud analysis: the demand of every record over its intensity, and the line through them."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import curve, line, marker, svg, text
from rockbatch.report.markup import Markup

WIDTH, HEIGHT = 300.0, 190.0
ROOM = 12.0
"""Height above the axes of the row of records that overturned [px]."""


def panel(info: Mapping[str, Any], entry: Mapping[str, Any], shape: str, colour: int) -> Markup:
    """Draw the cloud of one of ``curves`` of fragility.json, with its limit; what overturned above the frame."""
    cloud, runs = entry["cloud"], entry["cloud"]["runs"]
    valued = [run for run in runs if run["counts"] == "line"]
    demands = [run["demand"] for run in valued] + [cloud["limit"], cloud["floor"]]
    intensities = [run["x"] for run in runs]
    axes = Axes(
        44, 20 + ROOM, WIDTH - 54, HEIGHT - 58 - ROOM,
        Scale(min(intensities) / 1.1, max(intensities) * 1.1, log=True), Scale(min(demands) / 1.2, max(demands) * 1.5, log=True),
    )  # fmt: skip
    drawn = [axes.frame(axes.x.round_ticks(), axes.y.ticks(5))]
    height = float(axes.down(cloud["limit"]))
    drawn.append(line(axes.left, height, axes.left + axes.width, height, "limit", f"limit {cloud['limit']:g}"))
    if cloud["line"]:
        x = np.geomspace(axes.x.low, axes.x.high, 40)
        middle, sigma = cloud["line"]["ln_a"] + cloud["line"]["b"] * np.log(x), cloud["line"]["sigma"]
        for shift, class_ in ((0.0, "level"), (-sigma, "level d2"), (sigma, "level d2")):
            y = np.exp(middle + shift)
            inside = (y >= axes.y.low) & (y <= axes.y.high)
            drawn.append(curve(axes.across(x[inside]), axes.down(y[inside]), f"{class_} s{colour}"))
    for run in runs:
        across, label = float(axes.across(run["x"])), f"{run['x']:.3g} {info['unit']}, {run['counts']}"
        if run["counts"] == "line":
            y_of_run = float(axes.down(run["demand"]))
            drawn.append(marker(shape, across, y_of_run, colour=f"s{colour}", title=f"{label}: {run['demand']:.3g}"))
        elif run["counts"] == "below":
            drawn.append(
                marker("down", across, float(axes.down(cloud["floor"])), colour=f"open s{colour}", title=label)
            )
        elif run["counts"] == "overturned":
            drawn.append(marker("overturned", across, axes.top - 0.6 * ROOM, colour="alarm", title=label))
    drawn.append(text(axes.left + axes.width / 2, HEIGHT - 6, f"{info['measure']} [{info['unit']}]", class_="m q"))
    drawn.append(text(axes.left - 38, 11, str(entry["words"]).split(" > ")[0], class_="q"))
    return svg(WIDTH, HEIGHT, *drawn, description=f"Demands of {entry['limit_state']}", class_="plot marks")


def is_drawn(entry: Mapping[str, Any]) -> bool:
    """Return whether a curve has a cloud with demands, not that of an event."""
    cloud = entry.get("cloud") or {"floor": None}
    return cloud["floor"] is not None and 0 < cloud["limit"] < math.inf
