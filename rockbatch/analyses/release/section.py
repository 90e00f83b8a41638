"""A release test in the report: what was fitted, and the measured impacts and amplitudes on the computed rotation."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import curve, line, marker, side_by_side, svg, text
from rockbatch.report.finished_analysis import Contents, named, of_files
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.table import Head, listed
from rockbatch.results.labelled import as_dicts

WIDTH, HEIGHT = 420.0, 230.0
FIT = ("case", "parameter", "value", "low", "high", "confidence", "scatter", "over_housner", "remark")
IMPACTS = ("case", "impact", "t_measured_s", "t_amplitude_computed_s", "amplitude_measured_rad", "restitution_measured")
HISTORY = ("case", "t_s", "theta_rad")


@of_files("release")
def section(contents: Contents) -> Markup:
    """Show the fit of each case and its picture; empty without a release test."""
    analysis = contents.analysis("release")
    if analysis is None:
        return Markup("")
    fits, impacts = analysis.table("release.csv", FIT), analysis.table("release_impacts.csv", IMPACTS)
    history = analysis.table("release_history.csv", HISTORY)
    if fits is None or impacts is None or history is None:
        return Markup("")
    keys = ["case", *analysis.info["varied"]]
    by_case = [
        {name: part for name, part in table.groupby(keys, sort=False, dropna=False)} for table in (impacts, history)
    ]
    drawn, numbers = [], []
    for names, measured in by_case[0].items():
        title = named(dict(zip(keys, names, strict=True)), keys)
        drawn.append((title, _picture(measured, by_case[1][names]), _legend()))
        numbers.append(_numbers(measured, title))
    lead = (
        "What the pier loses, fitted to the measured times and amplitudes, and the interval of the fit. In the pictures a "
        "measured amplitude stands at the time of the computed one."
    )
    pictures = tag("figure", side_by_side(drawn, WIDTH), class_="whole")
    return join(tag("p", lead), _fits(fits, keys), pictures, *numbers, analysis.provenance())


def _fits(fits: "pd.DataFrame", keys: list[str]) -> Markup:
    """Return the table of what was fitted."""
    heads = [
        Head("case", value=lambda fit: named(fit, keys)), Head("fitted", value="parameter"), Head("value", ".4g", value="value"),
        Head("interval", value=_interval),
        Head("scatter", ".2g", "standard deviation from impact to impact, beside errors of reading", value="scatter"),
        Head("of Housner's", ".3f", "over the value that keeps the angular momentum", value="over_housner"),
    ]  # fmt: skip
    notes = (f"{named(fit, keys)}: {fit['remark']}." for fit in as_dicts(fits))
    return join(listed(heads, as_dicts(fits), name="Fitted to the release test"), *(tag("p", words) for words in notes))


def _interval(fit: Mapping[str, Any]) -> str:
    return f"{number(fit['low'], '.4g')} to {number(fit['high'], '.4g')} ({float(fit['confidence']):.0%})"


def _numbers(impacts: "pd.DataFrame", title: str) -> Markup:
    """Return the table of impacts, measured and computed."""
    heads, kinds = [Head("impact", "d", value="impact")], {
        "t": ("_s", "time [s]", ".4f"), "amplitude": ("_rad", "amplitude [rad]", ".5f"), "restitution": ("", "apparent e", ".3f"),
    }  # fmt: skip
    for name, (unit, over, form) in kinds.items():
        heads += [Head(origin, form, group=over, value=f"{name}_{origin}{unit}") for origin in ("measured", "computed")]
    return listed(heads, as_dicts(impacts), name=f"Impacts of {title}, measured and computed")


def _legend() -> list[tuple[Markup, str]]:
    return [
        (line(0, 7, 22, 7, "level s1"), "computed"), (marker("diamond", 11, 7, colour="s2"), "measured impact"),
        (marker("disc", 11, 7, colour="s2"), "measured amplitude"),
    ]  # fmt: skip


def _picture(impacts: "pd.DataFrame", history: "pd.DataFrame") -> Markup:
    """Draw the rotation, with the measured values on it."""
    t, theta = history["t_s"].to_numpy(float), history["theta_rad"].to_numpy(float)
    t_amplitude, t_impact = impacts["t_amplitude_computed_s"].to_numpy(float), impacts["t_measured_s"].to_numpy(float)
    amplitude = impacts["amplitude_measured_rad"].to_numpy(float)
    most = 1.08 * max(float(np.abs(theta).max()), float(np.nan_to_num(amplitude).max()))
    axes = Axes(52, 20, WIDTH - 64, HEIGHT - 58, Scale(float(t[0]), float(t[-1])), Scale(-most, most))
    points = [("diamond", x, 0.0, f"impact at {x:.4g} s") for x in t_impact if t[0] <= x <= t[-1]]
    points += [
        ("disc", x, float(np.copysign(a, np.interp(x, t, theta))), f"amplitude {a:.4g} rad")
        for x, a in zip(t_amplitude, amplitude, strict=True)
        if x == x and a == a
    ]
    marks = [
        marker(shape, float(axes.across(x)), float(axes.down(y)), colour="s2", title=words)
        for shape, x, y, words in points
    ]
    return svg(
        WIDTH, HEIGHT, axes.frame(axes.x.ticks(8), axes.y.ticks(6)),
        text(axes.left + axes.width / 2, HEIGHT - 6, "t [s]", class_="m q"), text(8, 12, "θ [rad]", class_="q"),
        curve(axes.across(t), axes.down(theta), "level s1"), *marks,
        description="Rotation after the release, computed and measured", class_="plot marks",
    )  # fmt: skip
