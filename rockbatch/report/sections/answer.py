"""The answer in sentences: the worst result, whether the pier passes, and how far to trust that."""

import math
from typing import TYPE_CHECKING, Any

from rockbatch.checks.demands import DEMANDS
from rockbatch.report.contents import Contents
from rockbatch.report.document import Section
from rockbatch.report.finished import Finished, worst_first
from rockbatch.report.labels import counted
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.sections import verdicts

if TYPE_CHECKING:
    import pandas as pd


def section(contents: Contents) -> Section | None:
    """What the first screen says; every check and every run follow further down."""
    finished = contents.finished
    if finished is None:
        return None
    passes = tag("div", verdicts.answer(contents.verdicts), class_="lead")
    return Section("The answer", "answer", join(passes, tag("p", worst(finished), class_="lead"), quality(finished)))


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
    guided = int((runs["flight_s"].notna() & (runs["status"] == "ok")).sum())
    if guided:
        sentences.append(f" In {counted(guided, 'run')} both pivots left the ground, and the pier was guided down.")
    return join(*sentences)


def _largest(finished: Finished, run: "pd.Series[Any]", among: bool) -> list[object]:
    theta, alpha = float(run["theta_max_over_alpha"]), float(run["alpha"])
    when = f", at t = {number(float(run['t_max_s']))} s" if run["t_max_s"] == run["t_max_s"] else ""
    return [
        f"The largest rotation{' of the runs that end standing' if among else ''} is ",
        tag("strong", "θ", tag("sub", "max"), f" = {number(theta)} α"),
        f" ({number(theta * alpha, '.3g')} rad, {number(math.degrees(theta * alpha), '.3g')}°), "
        f"and the heel rises by {number(1000 * _uplift(finished, run), '.3g')}\u00a0mm: {finished.where(run)}{when}.",
    ]


def _uplift(finished: Finished, run: "pd.Series[Any]") -> float:
    """Greatest rise of the heel above the toe [m], as the checks have it."""
    case = finished.cases[run["series"], run["pier"]]
    return float(DEMANDS["heel_uplift_m"].of(run.to_frame().T, case).value[0])


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
