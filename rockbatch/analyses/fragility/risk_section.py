"""Annual rates of ``rockbatch fragility``: the hazard, which intensities contribute, and a table of probabilities."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from rockbatch.analyses.fragility.section import label
from rockbatch.common.grouping import grouped
from rockbatch.report.drawing.axes import Axes, Scale
from rockbatch.report.drawing.svg import curve, key, line, marker, style_of, svg, text
from rockbatch.report.finished_analysis import Contents, of_files
from rockbatch.report.markup import Markup, interval, join, tag
from rockbatch.report.table import Head, listed
from rockbatch.report.templates import render

WIDTH, HEIGHT = 300.0, 190.0

Curve = Mapping[str, Any]
"""One of ``curves`` of fragility.json."""


@of_files("fragility")
def section(contents: Contents) -> Markup:
    """Draw the hazard and what the rates come from; empty if the study has no hazard."""
    analysis = contents.analysis("fragility")
    if analysis is None or not analysis.info.get("hazard"):
        return Markup("")
    info = analysis.info
    curves = [entry for entry in info["curves"] if entry["risk"]]
    if not curves:
        return tag("p", "No curve could be fitted, so that there are no rates.")
    share = f"{100 * info['confidence']:g} %"
    return render(
        "analyses/fragility/risk_section.html", info=info, hazard=info["hazard"], share=share, panels=_panels(info, curves),
        table=_table(info, curves, share), notes=_notes(curves),
    )  # fmt: skip


def _panels(info: Mapping[str, Any], curves: Sequence[Curve]) -> Markup:
    styles = {name: style_of(i)[1] for i, name in enumerate(dict.fromkeys(map(label, info["curves"])))}
    drawn = [tag("figure", tag("figcaption", "hazard of the site"), _hazard(info))]
    for name, group in grouped(curves, lambda entry: entry["limit_state"]).items():
        drawn.append(tag("figure", tag("figcaption", name), _densities(info, group, styles)))
    grid = tag("div", *drawn, class_="panels", style=f"--w:{WIDTH:.0f}px", role="group", aria_label="Annual rates")
    return join(grid, key([(line(0, 7, 22, 7, f"level s{colour}"), name) for name, colour in styles.items()]))


def _decades(values: Sequence[float]) -> Scale:
    """Return a logarithmic scale from a power of ten to another that holds the values."""
    low, high = min(values), max(values)
    return Scale(10.0 ** math.floor(math.log10(low)), 10.0 ** math.ceil(math.log10(high)), log=True)


def _hazard(info: Mapping[str, Any]) -> Markup:
    hazard = info["hazard"]
    x, rate = (np.array(hazard["drawn"][name]) for name in ("x", "rate"))
    axes = Axes(44, 20, WIDTH - 54, HEIGHT - 58, Scale(float(x[0]), float(x[-1]), log=True), _decades(rate.tolist()))
    drawn = [axes.frame(axes.x.round_ticks(), axes.y.ticks(5)), curve(axes.across(x), axes.down(rate), "level")]
    for level, often in zip(hazard["levels"], hazard["rates"], strict=True):
        title = f"{level:g} {info['unit']}: {often:.3g} per year, once in {1.0 / often:.0f} years"
        drawn.append(marker("disc", float(axes.across(level)), float(axes.down(often)), colour="", title=title))
    drawn.append(text(axes.left + axes.width / 2, HEIGHT - 6, f"{info['measure']} [{info['unit']}]", class_="m q"))
    drawn.append(text(axes.left - 38, 11, "exceedances per year", class_="q"))
    return svg(WIDTH, HEIGHT, *drawn, description=f"Annual rate over {info['measure']}", class_="plot marks")


def _densities(info: Mapping[str, Any], curves: Sequence[Curve], styles: Mapping[str, int]) -> Markup:
    shown = [entry for entry in curves if "density" in entry["risk"]]
    densities = [{name: np.array(values) for name, values in entry["risk"]["density"].items()} for entry in shown]
    ends = [float(x) for density in densities for x in (density["x"][0], density["x"][-1])] or [0.1, 10.0]
    most = max((float(density["share"].max()) for density in densities), default=1.0)
    axes = Axes(32, 20, WIDTH - 42, HEIGHT - 58, Scale(min(ends), max(ends), log=True), Scale(0.0, 1.1 * most))
    drawn = [axes.frame(axes.x.round_ticks(), axes.y.ticks(4))]
    for end in {info["hazard"]["levels"][0], info["hazard"]["levels"][-1]}:
        if axes.x.low <= end <= axes.x.high:
            x = float(axes.across(end))
            drawn.append(line(x, axes.top, x, axes.top + axes.height, "edge"))
    for entry, density in zip(shown, densities, strict=True):
        colour = styles[label(entry)]
        drawn.append(curve(axes.across(density["x"]), axes.down(density["share"]), f"level s{colour}"))
    drawn.append(text(axes.left + axes.width / 2, HEIGHT - 6, f"{info['measure']} [{info['unit']}]", class_="m q"))
    drawn.append(text(axes.left - 26, 11, "share of the rate", class_="q"))
    description = f"Intensities from which {curves[0]['limit_state']} comes"
    return svg(WIDTH, HEIGHT, *drawn, description=description, class_="plot marks")


def _table(info: Mapping[str, Any], curves: Sequence[Curve], share: str) -> Markup:
    heads = [
        Head("limit", value="limit_state"),
        Head("case", value=label),
        Head("dispersion", ".2f", "β with what the study adds", value=lambda entry: entry["risk"]["dispersion_total"]),
        Head("rate [1/year]", note="mean annual rate of exceedance", value=lambda entry: _power(entry["risk"]["rate_per_year"])),
        Head(share, note="what the fit leaves of the rate", value=_pair("rate_low", "rate_high")),
        Head("undecided", note="the rate with all undecided runs within the limit, and with all beyond it",
             value=_pair("rate_if_withstood", "rate_if_exceeded")),
        *(Head(f"in {years:g} years", note=f"probability of at least one exceedance, and what the fit leaves of it ({share})",
               value=_chance(f"p_in_{years:g}_years")) for years in info["hazard"]["years"]),
        Head(f"90 % come from [{info['unit']}]", note="intensities that contribute, but for 5 % at either end",
             value=_contributing),
    ]  # fmt: skip
    return listed(heads, curves, prose=True, name="Annual rates and probabilities")


def _notes(curves: Sequence[Curve]) -> Markup:
    """Return what the numbers do not say by themselves, a line for each curve."""
    notes = [(f"{entry['limit_state']}, {label(entry)}", entry["risk"]["note"]) for entry in curves]
    return tag("ul", *(tag("li", f"{name}: {note}.") for name, note in notes if note))


def _power(value: float) -> str:
    """Return a rate with a power of ten: "7.4·10⁻⁴"."""
    digits, exponent = f"{value:.1e}".split("e")
    return f"{digits}·10{str(int(exponent)).translate(_RAISED)}"


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def _pair(low: str, high: str) -> Callable[[Curve], object]:
    def written(entry: Curve) -> Markup:
        bounds = [entry["risk"][name] for name in (low, high)]
        if bounds == [None, None]:
            return Markup("")
        return interval(*("∞" if bound is None else _power(bound) for bound in bounds))

    return written


def _chance(name: str) -> Callable[[Curve], object]:
    def written(entry: Curve) -> Markup:
        value, low, high = (_percent(entry["risk"][key]) for key in (name, f"{name}_low", f"{name}_high"))
        return Markup(f"{value}\u00a0% ({interval(low, high)})")

    return written


def _percent(p: float) -> str:
    return "100" if p >= 0.995 else f"{100.0 * p:.2g}"


def _contributing(entry: Curve) -> Markup:
    return interval(*(f"{entry['risk'][name]:.2g}" for name in ("contributing_from", "contributing_to")))
