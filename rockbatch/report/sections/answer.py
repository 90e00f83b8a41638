"""The answer: verdicts, worst responses, runs without a result, and every peak in one picture."""

import math

from rockbatch.checks.responses import RESPONSES, in_words, worst_of_all
from rockbatch.report.contents import Contents
from rockbatch.report.document import Section
from rockbatch.report.finished import Finished
from rockbatch.report.labels import counted
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.overview import by_record
from rockbatch.report.sections import verdicts
from rockbatch.report.table import alarm
from rockbatch.results.suite_statistics import NO_PEAK

MOST_REASONS = 2

Facts = list[tuple[str, Markup]]
"""Headings with a sentence each."""


def section(contents: Contents) -> Section | None:
    """Return the first screen; every check and every run follow further down."""
    finished = contents.finished
    if finished is None:
        return None
    passes = tag("div", verdicts.answer(contents.verdicts, finished), class_="lead")
    content = join(passes, worst(finished), by_record(finished, contents.verdicts))
    return Section("The answer", "answer", content)


def worst(finished: Finished) -> Markup:
    """Return the worst responses, and how the runs ended, first those that did not end standing."""
    if finished.runs.empty:
        facts = [("peaks", join("No ground motion could be used: there are no results.")), *_missing(finished)]
    else:
        ended = [*_overturned(finished), *_flown(finished), *_missing(finished)]
        facts = [*ended, *_responses(finished), *_guided(finished, ended)]
    listed = tag("dl", *(join(tag("dt", words), tag("dd", said)) for words, said in facts), class_="facts")
    cases = len(finished.cases)
    return (
        join(tag("p", f"Worst of all {cases} cases, whatever is checked", class_="of-all"), listed)
        if cases > 1
        else listed
    )


def _responses(finished: Finished) -> Facts:
    """Return the worst of all cases, regardless of checks, with the run in which it occurs."""
    largest = worst_of_all(finished.worst)
    facts: Facts = []
    first: dict[object, str] = {}
    for name, one in largest.items():
        words, run = RESPONSES[name].words, one.run
        when = f", at t = {number(float(run['t_max_s']))} s" if name == "theta_max_over_alpha" else ""
        where = f": {finished.label(run['record'])}, case {finished.which(run)}{when}"
        if first.setdefault(run.name, words) != words:
            where = f", in the run of the greatest {first[run.name]}"
        leans = name == "theta_max_over_alpha" and run["theta_max_is"]
        lean = " (mostly the lean of a base that has yielded)" if leans else ""
        facts.append((words, join(tag("strong", in_words(one)), lean, where)))
    if all(one.case["base"] == "rigid" for one in finished.worst):
        facts.append(("of the supports", join("neither settlement nor tilt: the ground is rigid")))
    return facts


def _overturned(finished: Finished) -> Facts:
    runs = finished.runs
    over = runs[runs["status"] == "overturned"]
    if over.empty:
        return []
    which = f"{': ' if len(over) == 1 else ', among them '}{finished.where(over.iloc[0])}."
    return [("overturned", join(alarm(f"The pier overturns in {len(over):,} of {counted(len(runs), 'run')}"), which))]


def _flown(finished: Finished) -> Facts:
    """Report runs that ended when both pivots left the ground."""
    flown = finished.runs[finished.runs["status"] == "flight"].sort_values("flight_s", kind="stable")
    if flown.empty:
        return []
    stops = alarm(f"In {counted(len(flown), 'run')} both pivots leave the ground, and the analysis stops there")
    which = f"{': ' if len(flown) == 1 else ', soonest in '}{finished.where(flown.iloc[0])}."
    return [("left the ground", join(stops, which))]


def _missing(finished: Finished) -> Facts:
    """Report files and runs without a result, and the commonest reasons."""
    failed = finished.runs[finished.runs["status"] == "failed"]
    unread = len(finished.info["unusable"])
    if not len(failed) and not unread:
        return []
    lost = [f"{counted(unread, 'file')} could not be used"] if unread else []
    lost += [f"{counted(len(failed), 'run')} failed"] if len(failed) else []
    sentence: list[object] = [alarm(" and ".join(lost).capitalize())]
    reasons = failed["reason"].astype(str).str.split("[:;]", n=1).str[0].value_counts().head(MOST_REASONS)
    if len(reasons):
        sentence.append(f" ({'; '.join(f'{count} ×: {reason}' for reason, count in reasons.items())})")
    return [("without a result", join(*sentence, "; see ", tag("a", "Not used", href="#unusable"), "."))]


def _guided(finished: Finished, ended: Facts) -> Facts:
    """Report how the other runs ended: guided flights, and the errors of the peaks."""
    runs = finished.runs
    stood = runs[runs["status"] == "ok"]
    told = [
        f"{counted(len(runs), 'run')}." if ended else f"{counted(len(runs), 'run')}: all converged, none overturned."
    ]
    if runs["status"].isin(NO_PEAK).any() and len(stood):
        told.append("The responses above are of those that end standing.")
    guided = stood[stood["flight_s"].notna()]
    if len(guided):
        height = float(guided["flight_height_m"].max())
        rose = "" if math.isnan(height) else f"; the lower one rose by {1000 * height:.3g} mm at most"
        told.append(
            f"In {counted(len(guided), 'run')} both pivots left the ground, and the pier was guided down{rose}."
        )
    return [("runs", join(" ".join(filter(None, (*told, _error(finished))))))]


def _error(finished: Finished) -> str:
    """Report the largest error of the peaks, or that none was estimated."""
    numerics = finished.info["numerics"]
    largest = finished.runs["theta_max_error"].max()
    if largest == largest:
        asked = number(numerics["tolerance"])
        return f"The largest estimated error of a peak, in θ/α, is {number(float(largest), '.1g')}; {asked} was asked."
    if numerics.get("substeps"):
        steps = counted(numerics["substeps"], "step")
        return f"Every sampling interval was integrated in {steps}; the error was not estimated."
    return ""
