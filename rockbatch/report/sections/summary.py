"""What was studied, what came out and how far to trust it, in sentences."""

import math
from typing import TYPE_CHECKING, Any

from rockbatch.report.finished import Finished, worst_first
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.sections.inputs import foundations

if TYPE_CHECKING:
    import pandas as pd


def counted(count: int, word: str) -> str:
    """A number of things: "one run", "30 runs"."""
    return f"{count:,} {word}s" if count != 1 else f"one {word}"


def studied(finished: Finished, level: str = "h3") -> Markup:
    """The pier, the foundations and the records, in words and units; ``level`` is that of the heading within."""
    info, runs = finished.info, finished.runs
    piers: dict[tuple[float, ...], dict[str, float]] = {}
    for case in info["cases"]:
        pier = case["pier"]
        piers.setdefault(tuple(pier[key] for key in ("alpha", "p", "mu", "gravity")), pier)
    scales = sorted(runs["scale"].unique()) if len(runs) else []
    extent = (
        f"{counted(len(piers), 'pier')} on {counted(len(finished.series), 'foundation')} under "
        f"{counted(len(info['records']), 'ground motion')} ({_vertical(finished)})"
        + (", as recorded and reversed" if finished.both_directions else "")
        + (f", scaled by {', '.join(number(float(scale)) for scale in scales)}" if scales not in ([], [1.0]) else "")
        + f": {counted(len(runs), 'run')}."
        + (" Polarity: mirror images, counted once." if finished.mirrored else "")
    )
    described = tag("ul", *(tag("li", _pier(pier)) for pier in piers.values()))
    return join(
        tag("p", extent[0].upper() + extent[1:]), described, tag("p", _motions(finished)), tag(level, "Foundations"),
        foundations(finished),
    )  # fmt: skip


def _vertical(finished: Finished) -> str:
    records, runs = finished.info["records"], finished.runs
    if runs["with_vertical"].nunique() > 1:
        return "with and without the vertical component"
    vertical = sum(record["pga_v_g"] is not None for record in records)
    if vertical in (0, len(records)):
        return "with the vertical component" if vertical else "horizontal component only"
    return f"{vertical} with the vertical component"


def _pier(pier: dict[str, float]) -> str:
    return (
        f"Pier of slenderness α = {number(pier['alpha'])} rad ({math.degrees(pier['alpha']):.1f}°), "
        f"frequency parameter p = {number(pier['p'])} rad/s, shape factor μ = {number(pier['mu'])}; "
        f"size R0 = {number(pier['size_m'], '.3g')} m, half-width {number(pier['half_width_m'], '.3g')} m, "
        f"centre of mass {number(pier['height_m'], '.3g')} m above the base; "
        f"g = {number(pier['gravity'])} m/s²."
    )


def _motions(finished: Finished) -> str:
    records = finished.info["records"]
    if not records:
        return ""

    def span(key: str, form: str, unit: str) -> str:
        values = [record[key] for record in records if record[key] is not None]
        if not values:
            return "unknown"
        first, last = format(min(values), form), format(max(values), form)
        return f"{first} {unit}" if first == last else f"{first} to {last} {unit}"

    return (
        f"Peak ground acceleration {span('pga_g', '.3f', 'g')}, velocity {span('pgv_m_s', '.2f', 'm/s')}, displacement "
        f"{span('pgd_m', '.2f', 'm')}, as recorded; length {span('duration_s', '.3g', 's')}."
    )


def worst(finished: Finished) -> Markup:
    """The worst result in a sentence; an overturned pier comes before any rotation."""
    runs = finished.runs
    if runs.empty:
        return join("No ground motion could be used: there are no results.")
    sentences: list[object] = []
    over, flown = (runs[runs["status"] == status] for status in ("overturned", "flight"))
    stood = runs[(runs["status"] == "ok") & runs["theta_max_over_alpha"].notna()]
    if len(over):
        sentences.append(tag("strong", f"The pier overturns in {len(over):,} of {counted(len(runs), 'run')}"))
        sentences.append(f"{': ' if len(over) == 1 else ', among them '}{finished.where(over.iloc[0])}. ")
    if len(stood):
        sentences += _largest(finished, worst_first(stood, 1).iloc[0], bool(len(over) or len(flown)))
    if len(flown):
        sentences.append(
            f" In {counted(len(flown), 'run')} both pivots leave the ground, and the analysis stops there"
            f"{': ' if len(flown) == 1 else ', soonest in '}"
            f"{finished.where(flown.sort_values('flight_s', kind='stable').iloc[0])}."
        )
    return join(*sentences)


def _largest(finished: Finished, run: "pd.Series[Any]", among: bool) -> list[object]:
    theta, alpha = float(run["theta_max_over_alpha"]), float(run["alpha"])
    when = f", at t = {number(float(run['t_max_s']))} s" if run["t_max_s"] == run["t_max_s"] else ""
    return [
        f"The largest rotation{' of the runs that end standing' if among else ''} is ",
        tag("strong", "θ", tag("sub", "max"), f" = {number(theta)} α"),
        f" ({number(theta * alpha, '.3g')} rad, {number(math.degrees(theta * alpha), '.3g')}°): "
        f"{finished.where(run)}{when}.",
    ]


def quality(finished: Finished) -> Markup:
    """How far to trust the results, and what is missing."""
    numerics = finished.info["numerics"]
    largest = finished.runs["theta_max_error"].max() if len(finished.runs) else math.nan
    failed = int((finished.runs["status"] == "failed").sum())
    unread = len(finished.info["unusable"])
    accuracy = ""
    if largest == largest:
        told = number(float(largest), ".1g")
        accuracy = (
            f"The largest estimated error of a peak, in θ/α, is {told}; {number(numerics['tolerance'])} was asked."
        )
    elif numerics.get("substeps"):
        steps = counted(numerics["substeps"], "step")
        accuracy = f"Every sampling interval was integrated in {steps}; the error was not estimated."
    missing = ""
    if failed or unread:
        lost = [f"{counted(unread, 'file')} could not be used"] if unread else []
        lost += [f"{counted(failed, 'run')} failed"] if failed else []
        missing = join(
            tag("span", " and ".join(lost).capitalize(), class_="alarm"),
            "; see ", tag("a", "Not used", href="#unusable"), ".",
        )  # fmt: skip
    return join(*(tag("p", sentence) for sentence in (accuracy, missing) if sentence))
