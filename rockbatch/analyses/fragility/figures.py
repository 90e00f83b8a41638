"""Figures of fragility, from the content of fragility.json: curves, clouds, and what annual rates come from."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

import numpy as np

from rockbatch.common.analyses import Entry
from rockbatch.common.figures.description import (
    Area,
    Array,
    Axis,
    Figure,
    Look,
    Mark,
    Panel,
    Points,
    Polyline,
    Rule,
    decades,
    log_spanning,
    marks_of,
    sign_of,
)
from rockbatch.common.grouping import grouped
from rockbatch.common.units import with_unit
from rockbatch.reporting.finished_analysis import named

STRIP = 0.03
"""Height of a strip above the axes, in probability."""
CASES_OF_A_PANEL = 4
"""Most curves of a panel, since more bands would hide each other."""

Curve = Entry
"""One of ``curves`` of fragility.json."""


def label(info: Entry, entry: Curve) -> str:
    """Return the name of a curve's case with its varied values: "pads: β = 40"."""
    return named(info, {"case": entry["case"], **entry["columns"]}, list(entry["columns"]))


def remarks(info: Entry, curves: Iterable[Curve], note: Callable[[Curve], str]) -> list[str]:
    """Return each ``note`` on ``curves`` once, behind the limits and cases that have it: "tilt, rock, pads; heel, pads: …"."""
    lines = []
    for words, alike in grouped(curves, note).items():
        cases = grouped(alike, lambda curve: curve["limit_state"])
        names = (", ".join([limit, *(label(info, curve) for curve in of_limit)]) for limit, of_limit in cases.items())
        lines += [f"{'; '.join(names)}: {words}"] if words else []
    return lines


def _looks(info: Entry) -> dict[str, Look]:
    """Return the marks of each case by its label, the same in every figure."""
    return {name: marks_of(i) for i, name in enumerate(dict.fromkeys(label(info, entry) for entry in info["curves"]))}


def intensity(info: Entry) -> str:
    """Return the intensity measure with its unit, "PGV [m/s]"."""
    return with_unit(info["measure"], info["unit"])


def curves(info: Entry) -> Figure:
    """Return a figure of the shares of records beyond each limit, the fitted curves and their bands, four cases a panel."""
    looks, panels = _looks(info), []
    for name, of_limit in grouped(info["curves"], lambda entry: entry["limit_state"]).items():
        for first in range(0, len(of_limit), CASES_OF_A_PANEL):
            group = [(label(info, entry), entry) for entry in of_limit[first : first + CASES_OF_A_PANEL]]
            looked = [(case, entry) for case, entry in group if entry.get("looked")]
            x = Axis(intensity(info), 0.0, 1.1 * info["levels"][-1], about=6)
            y = Axis("probability", 0.0, 1.0 + STRIP * (len(looked) + 0.5 * bool(looked)), last=1.0)
            strips = [
                _line([low, high], [1.0 + STRIP * (place + 1)] * 2, looks[case])
                for place, (case, entry) in enumerate(looked)
                for low, high in entry["looked"]
            ]
            bands = [mark for case, entry in group for mark in _bands(entry, looks[case])]
            marks = [mark for case, entry in group for mark in _marks(case, entry, x.high, looks[case])]
            panels.append(Panel(x, y, [*bands, *strips, *marks], name, of_limit[first]["words"]))
    return Figure(panels, f"Fragility curves over {info['measure']}")


def _line(
    x: Sequence[float] | Array, y: Sequence[float] | Array, look: Look, dash: int = 0, label: str = ""
) -> Polyline:
    """Return a curve in the colour of a case."""
    return Polyline(np.array(x), np.array(y), look=Look("level", look.colour, dash), label=label)


def _bands(entry: Curve, look: Look) -> Iterator[Mark]:
    for name, kind in (("open", "unsure"), ("curve", "area")):
        if "low" in entry.get(name, ()):
            x, low, high = (np.array(entry[name][side]) for side in ("x", "low", "high"))
            around = np.concatenate((low, high[::-1]))
            yield Area(np.concatenate((x, x[::-1])), around, look=Look(kind, look.colour))


def _marks(name: str, entry: Curve, right: float, look: Look) -> Iterator[Mark]:
    """Yield the curves of a case, and the shares at the levels, each from the decided records, with bars for the others."""
    if "curve" in entry:
        yield _line(entry["curve"]["x"], entry["curve"]["p"], look, label=name)
    if "total" in entry:
        yield _line(entry["total"]["x"], entry["total"]["p"], look, 1)
    if "windows" in entry:
        yield from _of_shares(name, entry, look)
    if entry["capacities"] and "open" not in entry:  # a share of the records needs all of them
        yield _line(*_steps([high for _, high in entry["capacities"]], right), look, 2)
    points = [point for point in entry["points"] if point["records"]]
    for point in points:
        if point["undecided"]:
            ends = [k / point["records"] for k in (point["exceeded"], point["exceeded"] + point["undecided"])]
            yield Polyline(
                np.full(2, point["level"]),
                np.array(ends),
                look=Look("level", look.colour),
                title=_said(name, point),
            )
    decided = [point for point in points if point["records"] > point["undecided"]]
    shares = np.array([point["exceeded"] / (point["records"] - point["undecided"]) for point in decided])
    levels = np.array([point["level"] for point in decided], dtype=float)
    yield Points(levels, shares, None, [_said(name, point) for point in decided], look=look, label=name)


def _of_shares(name: str, entry: Curve, look: Look) -> Iterator[Mark]:
    """Yield the curve by shares, and the shares as open markers."""
    windows, by_shares = entry["windows"], f"{name}, by shares"
    if "curve" in windows:
        yield _line(windows["curve"]["x"], windows["curve"]["p"], look, 3, by_shares)
    shown = [
        (p["level"], share) for p, share in zip(entry["points"], windows["shares"], strict=True) if share is not None
    ]
    words = f"of the scales within ±{100 * windows['width']:g} % exceed the limit"
    titles = [f"{name}, {level:g}: {share:.0%} {words}" for level, share in shown]
    levels, shares = np.array(shown, dtype=float).reshape(-1, 2).T
    yield Points(levels, shares, None, titles, look=Look("", look.colour, shape=look.shape, open=True), label=by_shares)


def _said(name: str, point: Entry) -> str:
    ends = [
        f"{point[kind]} {words}"
        for kind, words in (("collapsed", "overturned"), ("flight", "flew"), ("failed", "failed"))
        if point[kind]
    ]
    counts = f"{name}, {point['level']:g}: {point['exceeded']} of {point['records']} records exceed the limit"
    undecided = [f"{point['undecided']} undecided"] if point["undecided"] else []
    return "; ".join([counts, *undecided, *ends])


def _steps(capacities: Sequence[float | None], right: float) -> tuple[Array, Array]:
    """Return x from 0 to ``right`` and the share of the records whose capacity is at most x, a staircase; None is above all x."""
    finite = np.minimum(np.sort([x for x in capacities if x is not None]), right)
    shares = np.arange(len(finite) + 1) / len(capacities)
    return np.concatenate(([0.0], np.repeat(finite, 2), [right])), np.repeat(shares, 2)


def clouds(info: Entry) -> Figure:
    """Return a figure of demands over intensity, the line through them, its standard deviation and the limit, a panel a curve.

    Curves of events, or without a finite limit above 0, have none.
    """
    looks = _looks(info)
    shown = [entry for entry in info["curves"] if _has_demands(entry)]
    return Figure([_cloud(info, entry, looks[label(info, entry)]) for entry in shown], "Demands of the records")


def _has_demands(entry: Curve) -> bool:
    """Return whether a curve has a cloud of demands, not of an event, with a finite limit above 0."""
    cloud = entry.get("cloud") or {"floor": None}
    return cloud["floor"] is not None and 0 < cloud["limit"] < math.inf


def _cloud(info: Entry, entry: Curve, look: Look) -> Panel:
    """Return the panel of a curve's cloud: demands, line and limit, censored demands at the floor and overturned runs above all;
    others are not drawn.
    """
    cloud, runs = entry["cloud"], entry["cloud"]["runs"]
    demands = [run["demand"] for run in runs if run["counts"] == "line"] + [cloud["limit"], cloud["floor"]]
    x = log_spanning(intensity(info), np.array([run["x"] for run in runs], dtype=float), margin=0.1)
    top = 1.5 * max(demands)
    y = Axis(cloud["demand"], min(demands) / 1.2, top * (top / min(demands)) ** 0.1, log=True, last=top)
    marks: list[Mark] = [
        Rule("y", np.array([float(cloud["limit"])]), look=Look("limit"), title=f"limit {cloud['limit']:g}")
    ]
    if cloud["line"]:
        across = np.geomspace(x.low, x.high, 40)
        middle, sigma = cloud["line"]["ln_a"] + cloud["line"]["b"] * np.log(across), cloud["line"]["sigma"]
        for shift, dash in ((0.0, 0), (-sigma, 2), (sigma, 2)):
            up = np.exp(middle + shift)
            marks.append(_line(across, np.where((up >= y.low) & (up <= top), up, np.nan), look, dash))
    kinds = {  # which runs, where they are drawn, how
        "line": (None, look, label(info, entry)),
        "below": (cloud["floor"], Look("", look.colour, shape="down", open=True), ""),
        "overturned": (math.sqrt(top * y.high), sign_of("overturned"), ""),
    }
    for counts, (height, own, name) in kinds.items():
        counted = [run for run in runs if run["counts"] == counts]
        up = np.array([run["demand"] if height is None else height for run in counted], dtype=float)
        titles = [
            f"{run['x']:.3g} {info['unit']}, {counts}" + (f": {run['demand']:.3g}" if height is None else "")
            for run in counted
        ]
        marks.append(
            Points(np.array([run["x"] for run in counted], dtype=float), up, None, titles, look=own, label=name)
        )
    return Panel(x, y, marks, f"{entry['limit_state']}, {label(info, entry)}")


def risk(info: Entry, shown: Sequence[Curve]) -> Figure:
    """Return a figure of the site's hazard and, a panel for each limit, of the intensities that the rates come from."""
    hazard, looks = info["hazard"], _looks(info)
    across, rate = (np.array(hazard["drawn"][name]) for name in ("x", "rate"))
    titles = [
        f"{level:g} {info['unit']}: {often:.3g} per year, once in {1.0 / often:.0f} years"
        for level, often in zip(hazard["levels"], hazard["rates"], strict=True)
    ]
    x = Axis(intensity(info), float(across[0]), float(across[-1]), log=True)
    points = Points(
        np.array(hazard["levels"], dtype=float), np.array(hazard["rates"], dtype=float), None, titles, look=Look()
    )
    marks = [Polyline(across, rate), points]
    panels = [Panel(x, decades("exceedances per year", rate.tolist(), about=5), marks, "hazard of the site")]
    for name, group in grouped(shown, lambda entry: entry["limit_state"]).items():
        panels.append(_densities(info, [entry for entry in group if "density" in entry["risk"]], looks, name))
    return Figure(panels, "Annual rates")


def _densities(info: Entry, shown: Sequence[Curve], looks: Mapping[str, Look], caption: str) -> Panel:
    densities = [entry["risk"]["density"] for entry in shown]
    ends = [float(x) for density in densities for x in (density["x"][0], density["x"][-1])] or [0.1, 10.0]
    most = max((max(density["share"]) for density in densities), default=1.0)
    x = Axis(intensity(info), min(ends), max(ends), log=True)
    known = sorted(end for end in {info["hazard"]["levels"][0], info["hazard"]["levels"][-1]} if x.low <= end <= x.high)
    marks: list[Mark] = [Rule("x", np.array(known, dtype=float), look=Look("edge"))]
    marks += [
        _line(density["x"], density["share"], looks[label(info, entry)], label=label(info, entry))
        for entry, density in zip(shown, densities, strict=True)
    ]
    return Panel(x, Axis("share of the rate", 0.0, 1.1 * most, about=4), marks, caption)
