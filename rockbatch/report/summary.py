"""The opening of the report: what was studied and what came out, in sentences."""

import math

from rockbatch.report.finished import Finished, Run
from rockbatch.report.markup import Markup, join, number, tag


def counted(count: int, word: str) -> str:
    """A number of things: "one run", "30 runs"."""
    return f"{count if count != 1 else 'one'} {word}{'' if count == 1 else 's'}"


def summary(finished: Finished) -> Markup:
    """What was studied, the worst result, and how far to trust it, in words."""
    info = finished.info
    runs = finished.runs
    piers: dict[tuple[float, ...], dict[str, float]] = {}
    for case in info["cases"]:
        pier = case["pier"]
        piers.setdefault(tuple(pier[key] for key in ("alpha", "p", "mu", "gravity")), pier)
    polarities = {run.polarity for run in runs}
    scales = sorted({run.scale for run in runs})
    foundations = counted(len(finished.foundations), "foundation")
    motions = counted(len(info["records"]), "ground motion")
    vertical = sum(record["pga_v_g"] is not None for record in info["records"])
    with_vertical = f"{vertical} with the vertical component"
    if vertical in (0, len(info["records"])):
        with_vertical = "with the vertical component" if vertical else "horizontal component only"
    extent = (
        f"{counted(len(piers), 'pier')} on {foundations} under {motions}"
        f" ({with_vertical})"
        + (", as recorded and reversed" if len(polarities) > 1 else "")
        + (f", scaled by {', '.join(map(number, scales))}" if scales not in ([], [1.0]) else "")
        + f": {counted(len(runs), 'run')}."
    )
    described = tag("ul", *(tag("li", _pier(pier)) for pier in piers.values()))
    extent = extent[0].upper() + extent[1:]
    return join(tag("p", _worst(finished), class_="lead"), tag("p", extent), described, _quality(finished))


def _pier(pier: dict[str, float]) -> str:
    return (
        f"Pier of slenderness α = {number(pier['alpha'])} rad ({math.degrees(pier['alpha']):.1f}°), "
        f"frequency parameter p = {number(pier['p'])} rad/s, shape factor μ = {number(pier['mu'])}; "
        f"size R0 = {number(pier['size_m'], '.3g')} m, half-width {number(pier['half_width_m'], '.3g')} m, "
        f"centre of mass {number(pier['height_m'], '.3g')} m above the base; "
        f"g = {number(pier['gravity'])} m/s²."
    )


def _where(finished: Finished, run: Run) -> str:
    varied = finished.piers[run.pier]
    also = [varied] if varied else []
    also += [f"scale {number(run.scale)}"] if run.scale != 1 else []
    also += ["reversed"] if run.polarity == "-" else []
    return f"{run.record}, case {run.series.label}" + (f" ({', '.join(also)})" if also else "")


def _worst(finished: Finished) -> Markup:
    """The worst result in a sentence; an overturned pier comes before any rotation."""
    runs = finished.runs
    if not runs:
        return join("No ground motion could be used: there are no results.")
    sentences: list[object] = []
    over = [run for run in runs if run.status == "overturned"]
    flown = [run for run in runs if run.status == "flight"]
    stood = [run for run in runs if run.status == "ok" and run.theta is not None]
    if over:
        sentences.append(tag("strong", f"The pier overturns in {len(over)} of {counted(len(runs), 'run')}"))
        sentences.append(f"{': ' if len(over) == 1 else ', first '}{_where(finished, over[0])}. ")
    if stood:
        largest = max(stood, key=lambda run: run.theta or 0)
        theta = largest.theta or 0
        alpha = largest.alpha
        among = " of the runs that end standing" if over or flown else ""
        when = f", at t = {number(largest.row['t_max_s'])} s" if largest.row["t_max_s"] is not None else ""
        sentences += [
            f"The largest rotation{among} is ", tag("strong", "θ", tag("sub", "max"), f" = {number(theta)} α"),
            f" ({number(theta * alpha, '.3g')} rad, {number(math.degrees(theta * alpha), '.3g')}°): "
            f"{_where(finished, largest)}{when}.",
        ]  # fmt: skip
    if flown:
        sentences.append(
            f" In {counted(len(flown), 'run')} both pivots leave the ground, and the analysis stops there"
            f"{': ' if len(flown) == 1 else ', first '}{_where(finished, flown[0])}."
        )
    return join(*sentences)


def _quality(finished: Finished) -> Markup:
    numerics = finished.info["numerics"]
    errors = [run.error for run in finished.runs if run.error is not None]
    failed = sum(run.status == "failed" for run in finished.runs)
    unread = len(finished.info["unusable"])
    accuracy = ""
    if errors:
        largest, asked = number(max(errors), ".1g"), number(numerics["tolerance"])
        accuracy = f"The largest estimated error of a peak, in θ/α, is {largest}; {asked} was asked."
    elif numerics.get("substeps"):
        accuracy = (
            f"Every sampling interval was integrated in {counted(numerics['substeps'], 'step')}; "
            "the error was not estimated."
        )
    missing = ""
    if failed or unread:
        lost = [f"{counted(unread, 'file')} could not be used"] if unread else []
        lost += [f"{counted(failed, 'run')} failed"] if failed else []
        missing = join(
            tag("span", " and ".join(lost).capitalize(), class_="alarm"),
            "; see ", tag("a", "Not used", href="#unusable"), ".",
        )  # fmt: skip
    return join(*(tag("p", sentence) for sentence in (accuracy, missing) if sentence))
