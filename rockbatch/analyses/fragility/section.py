"""Results of ``rockbatch fragility``: for each limit points, curves and bands, and a table of medians."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from rockbatch.analyses.fragility import cloud_drawing as cloud
from rockbatch.common.grouping import grouped
from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import curve, key, line, marker, style_of, svg, text
from rockbatch.report.finished_analysis import Contents, FinishedAnalysis, of_files
from rockbatch.report.markup import Markup, interval, join, tag
from rockbatch.report.table import Head, listed, table
from rockbatch.report.templates import render
from rockbatch.results.labels import quantity

WIDTH, HEIGHT = 300.0, 190.0
STRIP = 4.0
CAPACITIES = ("record", "case", "limit_state", "at_most", "scale_at_most", "widest_step")
CASES_OF_A_PANEL = 4
"""Most curves of a panel, since more bands would hide each other."""

Curve = Mapping[str, Any]
"""One of ``curves`` of fragility.json."""


@of_files("fragility")
def section(contents: Contents) -> Markup:
    """Draw the fragility curves; empty if there are none."""
    analysis = contents.analysis("fragility")
    if analysis is None or not analysis.info["curves"]:
        return Markup("")
    info = analysis.info
    share, curves = f"{100 * info['confidence']:g} %", info["curves"]
    return render(
        "analyses/fragility/section.html", info=info, share=share, panels=_panels(info), table=_table(info, share),
        little=[f"{entry['limit_state']}, {label(entry)}" for entry in curves if entry["says_little"]],
        open=any("open" in entry for entry in curves), looked=any(entry.get("looked") for entry in curves),
        clouds=_clouds(info), factors=_factors(info), own=any(None in row for row in info.get("scales", {}).get("factors", ())),
        capacities=_capacities(analysis), provenance=analysis.provenance(),
    )  # fmt: skip


def label(entry: Curve) -> str:
    words = [quantity(name, value) for name, value in entry["columns"].items()]
    return f"{entry['case']}: {', '.join(words)}" if words else entry["case"]


def _panels(info: Mapping[str, Any]) -> Markup:
    styles = _styles(info)
    drawn = []
    for name, curves in grouped(info["curves"], lambda entry: entry["limit_state"]).items():
        for first in range(0, len(curves), CASES_OF_A_PANEL):
            group = curves[first : first + CASES_OF_A_PANEL]
            title = tag("figcaption", tag("span", name), " ", tag("span", group[0]["words"], class_="muted"))
            drawn.append(tag("figure", title, _panel(info, group, styles)))
    shown = [(join(_stroke(colour), marker(shape, 11, 7, colour=f"s{colour}")), name)
             for name, (shape, colour) in styles.items()]  # fmt: skip
    grid = tag("div", *drawn, class_="panels", style=f"--w:{WIDTH:.0f}px", role="group", aria_label="Fragility curves")
    return join(grid, key(shown))


def _clouds(info: Mapping[str, Any]) -> Markup:
    styles = _styles(info)
    shown = [entry for entry in info["curves"] if cloud.is_drawn(entry)]
    drawn = [
        tag(
            "figure",
            tag("figcaption", f"{entry['limit_state']}, {label(entry)}"),
            cloud.panel(info, entry, *styles[label(entry)]),
        )
        for entry in shown
    ]
    return tag("div", *drawn, class_="panels", style=f"--w:{WIDTH:.0f}px") if drawn else Markup("")


def _styles(info: Mapping[str, Any]) -> dict[str, tuple[str, int]]:
    return {name: style_of(i) for i, name in enumerate(dict.fromkeys(map(label, info["curves"])))}


def _stroke(colour: int) -> Markup:
    return line(0, 7, 22, 7, f"level s{colour}")


def _panel(info: Mapping[str, Any], curves: Sequence[Curve], styles: Mapping[str, tuple[str, int]]) -> Markup:
    strips = STRIP * sum(bool(entry.get("looked")) for entry in curves)
    axes = Axes(
        32, 20 + strips, WIDTH - 42, HEIGHT - 58 - strips, Scale(0.0, 1.1 * info["levels"][-1]), Scale(0.0, 1.0)
    )
    drawn = [axes.frame(axes.x.ticks(6), axes.y.ticks(5)), *_strips(axes, curves, styles)]
    for entry in curves:
        drawn += _band(axes, entry, styles[label(entry)][1])
    for entry in curves:
        drawn += _drawn(axes, entry, *styles[label(entry)])
    drawn.append(text(axes.left + axes.width / 2, HEIGHT - 6, f"{info['measure']} [{info['unit']}]", class_="m q"))
    drawn.append(text(axes.left - 26, 11, "probability", class_="q"))
    description = f"Probability of {curves[0]['limit_state']} over {info['measure']}"
    return svg(WIDTH, HEIGHT, *drawn, description=description, class_="plot marks")


def _strips(axes: Axes, curves: Sequence[Curve], styles: Mapping[str, tuple[str, int]]) -> Iterator[Markup]:
    """Yield a strip for each curve above the axes: the levels searched for first exceedances, each a dash of 2 px."""
    looked = [entry for entry in curves if entry.get("looked")]
    for place, entry in enumerate(looked):
        y = axes.top - STRIP * (len(looked) - place)
        for low, high in entry["looked"]:
            first, last = float(axes.across(low)), float(axes.across(high))
            yield line(first - 1, y, last + 1, y, f"level s{styles[label(entry)][1]}")


def _band(axes: Axes, entry: Curve, colour: int) -> Iterator[Markup]:
    for name, class_ in (("open", "open"), ("curve", "area")):
        if name in entry:
            x, low, high = (np.array(entry[name][side]) for side in ("x", "low", "high"))
            around = np.concatenate((low, high[::-1]))
            yield curve(axes.across(np.concatenate((x, x[::-1]))), axes.down(around), f"{class_} s{colour}")


def _drawn(axes: Axes, entry: Curve, shape: str, colour: int) -> Iterator[Markup]:
    class_ = f"s{colour}"
    if "curve" in entry:
        x, p = (np.array(entry["curve"][name]) for name in ("x", "p"))
        yield curve(axes.across(x), axes.down(p), f"level {class_}")
    if "total" in entry:
        x, p = (np.array(entry["total"][name]) for name in ("x", "p"))
        yield curve(axes.across(x), axes.down(p), f"level total {class_}")
    if "windows" in entry:
        yield from _of_shares(axes, entry, shape, class_)
    if entry["capacities"] and "open" not in entry:  # a share of the records needs all of them
        yield curve(*_steps(axes, [high for _, high in entry["capacities"]]), f"level {class_} d2")
    for point in entry["points"]:
        if not point["records"]:
            continue
        across = float(axes.across(point["level"]))
        exceeded, undecided, records = point["exceeded"], point["undecided"], point["records"]
        if undecided:
            least, most = (float(axes.down(k / records)) for k in (exceeded, exceeded + undecided))
            yield line(across, least, across, most, class_, _label_of_point(entry, point))
        if records > undecided:
            share = float(axes.down(exceeded / (records - undecided)))
            yield marker(shape, across, share, colour=class_, title=_label_of_point(entry, point))


def _of_shares(axes: Axes, entry: Curve, shape: str, class_: str) -> Iterator[Markup]:
    """Yield the curve by shares, and the shares as open markers."""
    windows = entry["windows"]
    if "curve" in windows:
        x, p = (np.array(windows["curve"][name]) for name in ("x", "p"))
        yield curve(axes.across(x), axes.down(p), f"level {class_} d3")
    for point, share in zip(entry["points"], windows["shares"], strict=True):
        if share is not None:
            across, down = float(axes.across(point["level"])), float(axes.down(share))
            words = f"{share:.0%} of the scales within ±{100 * windows['width']:g} % exceed the limit"
            yield marker(
                shape, across, down, colour=f"{class_} open", title=f"{label(entry)}, {point['level']:g}: {words}"
            )


def _label_of_point(entry: Curve, point: Mapping[str, Any]) -> str:
    ends = [f"{point[name]} {words}" for name, words in (("collapsed", "overturned"), ("flight", "flew"), ("failed", "failed"))
            if point[name]]  # fmt: skip
    counts = f"{label(entry)}, {point['level']:g}: {point['exceeded']} of {point['records']} records exceed the limit"
    undecided = [f"{point['undecided']} undecided"] if point["undecided"] else []
    return "; ".join([counts, *undecided, *ends])


def _steps(axes: Axes, capacities: Sequence[float | None]) -> tuple[np.ndarray, np.ndarray]:
    """Return the share of the records whose capacity is at most x, as a staircase [px]."""
    finite = np.sort([x for x in capacities if x is not None])
    finite = np.minimum(finite, axes.x.high)
    shares = np.arange(len(finite) + 1) / len(capacities)
    x = np.concatenate(([0.0], np.repeat(finite, 2), [axes.x.high]))
    return axes.across(x), axes.down(np.repeat(shares, 2))


def _table(info: Mapping[str, Any], share: str) -> Markup:
    heads = [
        Head("limit", value="limit_state"),
        Head("case", value=label),
        Head(f"median [{info['unit']}]", ".3g", f"θ: the {info['measure']} that half of the motions need", value="median"),
        Head(share, note="profile-likelihood interval of the median", value=_interval("median_interval")),
        Head(
            "undecided", note="the median with all undecided runs beyond the limit, and with all within it",
            value=_interval("median_undecided"),
        ),
        Head("dispersion", ".2f", "β: standard deviation of the logarithm", value="dispersion"),
        Head(share, note="profile-likelihood interval of the dispersion", value=_interval("dispersion_interval")),
        Head("with added", ".2f", "β with the dispersions that the study adds, by the root of the squares",
             value="dispersion_total"),
        Head("by shares", ".3g", info.get("by_shares"), value=_of_windows("median")),
        Head("apart [%]", "+.1f", "by shares, above that of the first exceedances [%]", value=_apart),
        Head("records", ".0f", "that count", value=_greatest("records")),
        Head("overturned", ".0f", "largest number of records that overturn at one level", value=_greatest("collapsed")),
        Head("note", value="note"),
    ]  # fmt: skip
    return listed(heads, info["curves"], prose=True, name="Medians and dispersions")


def _factors(info: Mapping[str, Any]) -> Markup:
    """Return a folded table of the factors on every record at every level; those that are not used in brackets."""
    scales = info.get("scales")
    if not scales or not scales["records"]:
        return Markup("")
    heads = [
        Head("record"),
        *(Head(f"{level:g}", group=f"{info['measure']} [{info['unit']}]") for level in info["levels"]),
    ]
    rows = [
        [name, *(_factor(factor, use) for factor, use in zip(factors, used, strict=True))]
        for name, factors, used in zip(scales["records"], scales["factors"], scales["used"], strict=True)
    ]
    words = "Factors on the records as they were recorded; in brackets: beyond the limits, not used"
    return tag("details", tag("summary", words), table(heads, rows, name="Factors on the records"))


def _capacities(analysis: FinishedAnalysis) -> Markup:
    """Return a folded table of the capacity of every record; empty for another method."""
    capacities = analysis.table("fragility_capacities.csv", CAPACITIES)
    if capacities is None:
        return Markup("")
    varied = {name for entry in analysis.info["curves"] for name in entry["columns"]}

    def case(row: Mapping[str, Any]) -> str:
        return label(
            {**row, "columns": {name: value for name, value in row.items() if name in varied and value == value}}
        )

    heads = [
        Head("record", value="record"),
        Head("limit", value="limit_state"),
        Head("case", value=case),
        Head(f"exceeded from [{analysis.info['unit']}]", ".4g", "empty: not up to the highest level", value="at_most"),
        Head("as scale", ".4g", value="scale_at_most"),
        Head("widest step below [%]", ".3g", "an island of exceedance that is narrower may lie below", value=_step_below),
    ]  # fmt: skip
    rows = ({str(name): value for name, value in row.items()} for row in capacities.to_dict("records"))
    return tag("details", tag("summary", "Capacities of the records"), listed(heads, rows, name="Capacities"))


def _step_below(row: Mapping[str, Any]) -> float:
    return 100.0 * float(row["widest_step"])


def _factor(factor: float | None, used: bool) -> str:
    if factor is None:
        return ""
    return f"{factor:.2f}" if used else f"({factor:.2f})"


def _greatest(name: str) -> Callable[[Curve], object]:
    """Return a function to the largest number of records at a level; of a cloud to their sum."""
    return lambda entry: (sum if "cloud" in entry else max)([point[name] for point in entry["points"]])


def _of_windows(name: str) -> Callable[[Curve], Any]:
    return lambda entry: entry.get("windows", {}).get(name)


def _apart(entry: Curve) -> float | None:
    above = entry.get("windows", {}).get("above")
    return None if above is None else 100.0 * above


def _interval(name: str) -> Callable[[Curve], object]:
    def written(entry: Curve) -> Markup:
        if entry.get(name) is None:
            return Markup("")
        low, high = ("∞" if bound in (None, math.inf) else f"{bound:.3g}" for bound in entry[name])
        return interval(low, high)

    return written
