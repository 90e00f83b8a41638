"""The answer: whether the pier passes, the worst result, what did not settle or flew, and every peak in one picture."""

import math
from typing import TYPE_CHECKING, Any

from rockbatch.checks.demands import DEMANDS
from rockbatch.report.contents import Contents
from rockbatch.report.document import Section
from rockbatch.report.finished import Finished, worst_first
from rockbatch.report.labels import counted
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.overview import by_record
from rockbatch.report.sections import verdicts
from rockbatch.report.table import alarm
from rockbatch.results.suite_statistics import NO_PEAK

if TYPE_CHECKING:
    import pandas as pd

MOST_REASONS = 2


def section(contents: Contents) -> Section | None:
    """What the first screen says; every check and every run follow further down."""
    finished = contents.finished
    if finished is None:
        return None
    passes = tag("div", verdicts.answer(contents.verdicts), class_="lead")
    facts = _listed([*_worst(finished), *_missing(finished), *_error(finished)])
    return Section("The answer", "answer", join(passes, facts, by_record(finished)))


Facts = list[tuple[str, Markup]]
"""A few words, and a sentence, of each."""


def worst(finished: Finished) -> Markup:
    """The worst result: the largest rotation, what overturned, and what left the ground."""
    return _listed(_worst(finished))


def _listed(facts: Facts) -> Markup:
    return tag("dl", *(join(tag("dt", words), tag("dd", said)) for words, said in facts), class_="facts")


def _worst(finished: Finished) -> Facts:
    if finished.runs.empty:
        return [("peaks", join("No ground motion could be used: there are no results."))]
    return [*_peak(finished), *_overturned(finished), *_flown(finished)]


def _peak(finished: Finished) -> Facts:
    """The largest rotation of the runs that end standing, and where it is."""
    runs = finished.runs
    stood = runs[(runs["status"] == "ok") & runs["theta_max_over_alpha"].notna()]
    if stood.empty:
        return []
    run = worst_first(stood, 1).iloc[0]
    theta, alpha = float(run["theta_max_over_alpha"]), float(run["alpha"])
    when = f", at t = {number(float(run['t_max_s']))} s" if run["t_max_s"] == run["t_max_s"] else ""
    told = join(
        tag("strong", "θ", tag("sub", "max"), f" = {number(theta)} α, {number(math.degrees(theta * alpha), '.3g')}°"),
        " (mostly the lean of a base that has yielded)" if run["theta_max_is"] else "",
        f" ({number(theta * alpha, '.3g')} rad), and the heel rises by ",
        tag("strong", f"{number(1000 * _uplift(finished, run), '.3g')}\u00a0mm"), f": {finished.where(run)}{when}",
        ", of the runs that end standing." if runs["status"].isin(NO_PEAK).any() else ".",
    )  # fmt: skip
    return [("largest rotation", told)]


def _overturned(finished: Finished) -> Facts:
    runs = finished.runs
    over = runs[runs["status"] == "overturned"]
    if over.empty:
        return [("overturned", join("none"))]
    which = f"{': ' if len(over) == 1 else ', among them '}{finished.where(over.iloc[0])}."
    return [("overturned", join(alarm(f"The pier overturns in {len(over):,} of {counted(len(runs), 'run')}"), which))]


def _flown(finished: Finished) -> Facts:
    """Runs in which both pivots leave the ground: ended there, or guided down."""
    runs = finished.runs
    flown = runs[runs["status"] == "flight"]
    guided = runs[runs["flight_s"].notna() & (runs["status"] == "ok")]
    told: list[object] = []
    if len(flown):
        first = flown.sort_values("flight_s", kind="stable").iloc[0]
        told.append(
            alarm(f"In {counted(len(flown), 'run')} both pivots leave the ground, and the analysis stops there")
        )
        told.append(f"{': ' if len(flown) == 1 else ', soonest in '}{finished.where(first)}. ")
    if len(guided):
        height = float(guided["flight_height_m"].max())
        rose = "" if math.isnan(height) else f"; the lower one rose by {1000 * height:.3g} mm at most"
        told.append(
            f"In {counted(len(guided), 'run')} both pivots left the ground, and the pier was guided down{rose}."
        )
    return [("left the ground", join(*told) if told else join("none"))]


def _missing(finished: Finished) -> Facts:
    """What has no result, and the commonest reasons."""
    failed = finished.runs[finished.runs["status"] == "failed"]
    unread = len(finished.info["unusable"])
    if not len(failed) and not unread:
        return [("without a result", join("none: every run settled"))] if len(finished.runs) else []
    lost = [f"{counted(unread, 'file')} could not be used"] if unread else []
    lost += [f"{counted(len(failed), 'run')} failed"] if len(failed) else []
    told: list[object] = [alarm(" and ".join(lost).capitalize())]
    reasons = failed["reason"].astype(str).str.split("[:;]", n=1).str[0].value_counts().head(MOST_REASONS)
    if len(reasons):
        told.append(f" ({'; '.join(f'{count} ×: {reason}' for reason, count in reasons.items())})")
    return [("without a result", join(*told, "; see ", tag("a", "Not used", href="#unusable"), "."))]


def _uplift(finished: Finished, run: "pd.Series[Any]") -> float:
    """Greatest rise of the heel above the toe [m], as the checks have it."""
    case = finished.cases[run["series"], run["pier"]]
    return float(DEMANDS["heel_uplift_m"].of(run.to_frame().T, case).value[0])


def _error(finished: Finished) -> Facts:
    """How large the errors of the peaks are."""
    numerics = finished.info["numerics"]
    largest = finished.runs["theta_max_error"].max() if len(finished.runs) else math.nan
    if largest == largest:
        told = number(float(largest), ".1g")
        asked = number(numerics["tolerance"])
        return [("error", join(f"The largest estimated error of a peak, in θ/α, is {told}; {asked} was asked."))]
    if numerics.get("substeps"):
        steps = counted(numerics["substeps"], "step")
        return [("error", join(f"Every sampling interval was integrated in {steps}; the error was not estimated."))]
    return []
