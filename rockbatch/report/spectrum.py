"""Pictures of ``rockbatch spectrum``: rocking spectra as curves, overturning maps as regions."""

import math
from collections.abc import Hashable
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rockbatch.report.analysis import Found, named, read
from rockbatch.report.axes import Axes, Scale
from rockbatch.report.document import figure
from rockbatch.report.labels import quantity, symbol
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.svg import COLOURS, curve, key, line, lowered, marker, rectangle, svg, text
from rockbatch.report.table import sub

if TYPE_CHECKING:
    import pandas as pd

WIDTH, HEIGHT = 616, 268
ACROSS = {"two_pi_over_p_s": "2π/p [s]"}
QUANTILES = {"median": "", "p16": " d2", "p84": " d1"}
REGIONS = {
    "safe": ("", "stands"),
    "overturned with impact": ("s2", "overturns after an impact or more (mode 1)"),
    "overturned without impact": ("s1", "overturns without impact (mode 2)"),
    "flight": ("s3", "leaves the ground with both pivots: the run ends"),
    "undecided": ("s4", "not decided: the run did not settle"),
}
"""Colour and words of each region of a map."""


def section(directory: Path, sha256: str | None) -> Markup:
    """Spectra and maps in a folder, if they are of the study with that digest; empty where there are none."""
    found = read(directory, "spectrum", sha256)
    if found is None:
        return Markup("")
    parts = []
    suite = found.table("spectrum_suite.csv", ("case", "scale", "alpha", "count", *QUANTILES))
    if suite is not None:
        parts += _spectra(found, suite)
    regions = found.table("overturning_map.csv", ("map", "case", "omega_p_over_p", "outcome", "low", "high"))
    if regions is not None:
        parts += _maps(found, regions)
    return join(*parts)


# Rocking spectra


def _spectra(found: Found, suite: "pd.DataFrame") -> list[Markup]:
    axis = found.info["axis"]
    apart = [name for name in ("case", "scale", *found.info["varied"]) if name not in ("alpha", axis)]
    told = [name for name in apart if name in ("case",) or suite[name].nunique(dropna=False) > 1]
    many = bool((suite["count"] > 1).any())
    lead = "Largest rotation over slenderness against the size of the pier, a curve for each slenderness. "
    if many:
        lead += "Solid: median of the suite; dashed and dotted: 84 % and 16 % quantiles. "
    lead += "Above the frame: overturned or ended by flight (∞), which counts as larger than any rotation."
    return [
        tag("p", lead),
        *(figure(_curves(runs, axis, many), named(dict(zip(apart, names, strict=True)), told)) for names, runs in
          suite.groupby(apart, sort=False, dropna=False)),
    ]  # fmt: skip


def _curves(points: "pd.DataFrame", axis: str, many: bool) -> Markup:
    names = list(QUANTILES) if many else ["median"]
    finite = points[names].to_numpy(float)
    top = 1.08 * max(float(finite[np.isfinite(finite)].max(initial=0.0)), 1e-6)
    x = points[axis].to_numpy(float)
    axes = Axes(44, 28, WIDTH - 56, HEIGHT - 62, Scale(x.min(), x.max()), Scale(0.0, top))
    drawn = [
        rectangle(axes.left, axes.top - 16, axes.width, 16, "band"),
        axes.frame(axes.x.ticks(10), axes.y.ticks(6)),
        text(axes.left + axes.width / 2, HEIGHT - 6, ACROSS.get(axis, symbol(axis)), class_="m q"),
        text(axes.left - 2, 9, lowered("θ", "max", "/α"), class_="q"),
    ]
    entries = []
    for place, (alpha, own) in enumerate(points.groupby("alpha", sort=False)):
        colour = f"s{place % COLOURS + 1}"
        across = axes.across(own[axis].to_numpy(float))
        for name in names:
            y = own[name].to_numpy(float)
            drawn.append(
                curve(across, axes.down(np.where(np.isfinite(y), y, np.nan)), f"level {colour}{QUANTILES[name]}")
            )
        fell = np.isinf(own["median"].to_numpy(float))
        high = axes.top - 8 + 3 * (place % 3 - 1)
        drawn += [
            marker("overturned", at, high, colour=colour, title=f"{quantity('alpha', float(str(alpha)))}: ∞")
            for at in across[fell]
        ]
        entries.append((line(0, 7, 22, 7, f"level {colour}"), quantity("alpha", float(str(alpha)))))
    if np.isinf(points["median"].to_numpy(float)).any():
        entries.append((marker("overturned", 11, 7, colour="ink"), "overturned or ended by flight" + ", median" * many))
    return join(svg(WIDTH, HEIGHT, *drawn, description="Rocking spectrum", class_="plot marks"), key(entries))


# Overturning maps


def _maps(found: Found, regions: "pd.DataFrame") -> list[Markup]:
    apart = ["map", "case", *found.info["varied_map"]]
    drawn = [
        tag(
            "p",
            "Which amplitudes of a pulse overturn the pier, over the pulse's frequency: ", sub("ω", "p"),
            " = 2π over its period, ", sub("a", "p"), " its peak acceleration.",
        )
    ]  # fmt: skip
    asked = {each["name"]: each for each in found.info["maps"]}
    for names, own in regions.groupby(apart, sort=False, dropna=False):
        values = dict(zip(apart, names, strict=True))
        spec = asked[values["map"]]
        words = f"{values['map']} ({spec['shape']}), {named(values, apart[1:])}"
        n = own["omega_p_over_p"].nunique()
        caption = (
            f"{words}. Boundaries are located within {spec['tolerance']:g} along the ordinate, at {n} frequencies."
        )
        drawn.append(figure(_regions(own), caption))
    return drawn


Intervals = dict[tuple[str, int], tuple[float, float]]


def _regions(own: "pd.DataFrame") -> Markup:
    columns = {float(str(frequency)): column for frequency, column in own.groupby("omega_p_over_p")}
    frequencies = np.array(list(columns))
    axes = Axes(
        36,
        16,
        WIDTH - 48,
        300,
        Scale(*frequencies[[0, -1]].tolist()),
        Scale(float(own["low"].min()), float(own["high"].max())),
    )
    drawn = [_between(axes, *pair) for pair in pairwise(columns.items())]
    drawn.append(axes.frame(axes.x.ticks(10), axes.y.ticks(8)))
    drawn += [
        curve(axes.across(frequencies), axes.down(np.array([heights.get(f, math.nan) for f in frequencies])), "level")
        for heights in boundaries(own).values()
    ]
    drawn.append(text(axes.left + axes.width / 2, 346, lowered("ω", "p", "/p"), class_="m q"))
    drawn.append(text(axes.left - 2, 10, lowered("a", "p", "/(g tan α)"), class_="q"))
    present = [name for name in REGIONS if name in set(own["outcome"]) and REGIONS[name][0]]
    entries = [(rectangle(1, 1, 20, 12, f"filled {REGIONS[name][0]}"), REGIONS[name][1]) for name in present]
    entries.append((line(0, 7, 22, 7, "level"), "boundary; outside all colours it stands"))
    return join(svg(WIDTH, 350, *drawn, description="Overturning map", class_="plot marks"), key(entries))


def _between(axes: Axes, left: "tuple[float, pd.DataFrame]", right: "tuple[float, pd.DataFrame]") -> Markup:
    """The regions from one frequency to the next; one that is not there at the other closes on its way."""
    (start, before), (end, after) = left, right
    here, there = _intervals(before), _intervals(after)
    x1, x2 = float(axes.across(start)), float(axes.across(end))
    drawn = []
    for region in dict.fromkeys([*here, *there]):
        colour = REGIONS[region[0]][0]
        if colour:
            ends = (*_interval(axes, region, here, there), *_interval(axes, region, there, here))
            foot1, top1, foot2, top2 = axes.down(np.array(ends))
            d = f"M{x1:.1f} {foot1:.1f}V{top1:.1f}L{x2:.1f} {top2:.1f}V{foot2:.1f}z"
            drawn.append(tag("path", d=d, class_=f"filled {colour}"))
    return join(*drawn)


def _intervals(column: "pd.DataFrame") -> Intervals:
    """Amplitudes of the regions at a frequency, from below, by outcome and how often it was there already."""
    outcomes = column["outcome"].tolist()
    names = [(outcome, outcomes[:i].count(outcome)) for i, outcome in enumerate(outcomes)]
    return dict(zip(names, column[["low", "high"]].itertuples(index=False, name=None), strict=True))


def _interval(axes: Axes, region: tuple[str, int], own: Intervals, other: Intervals) -> tuple[float, float]:
    """Where a region is, or closes: at an end of the range, or on top of what is below it at the other frequency."""
    if region in own:
        return own[region]
    names = list(other)
    low, high = other[region]
    place = names.index(region)
    if place == len(names) - 1:
        height = axes.y.high
    else:
        height = own.get(names[place - 1], (axes.y.low, axes.y.low))[1] if place else axes.y.low
    height = min(max(height, low), high)  # as it was: what is below may have become something else
    return height, height


def boundaries(own: "pd.DataFrame") -> dict[Hashable, dict[float, float]]:
    """Amplitudes of each boundary by frequency; boundaries are told by the outcomes on both sides, and their order."""
    found: dict[Hashable, dict[float, float]] = {}
    for frequency, column in own.groupby("omega_p_over_p"):
        outcomes, highs = column["outcome"].tolist(), column["high"].tolist()
        seen: dict[Hashable, int] = {}
        for below, above, height in zip(outcomes, outcomes[1:], highs, strict=False):
            count = seen[below, above] = seen.get((below, above), 0) + 1
            found.setdefault((below, above, count), {})[float(str(frequency))] = height
    return found
