"""The answer of two studies: the better one, the difference, and the governing records."""

import math

from rockbatch.checks.responses import RESPONSES, Worst, in_words, worst_of_all
from rockbatch.report.document import Section, paragraphs
from rockbatch.report.finished import Finished
from rockbatch.report.labels import counted
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.pair import SIDES, Pair
from rockbatch.report.table import Head, table
from rockbatch.results.suite_statistics import NO_PEAK

LEVEL = 0.02
"""Relative difference of a response up to which neither study is better."""

INDEPENDENT = ("theta_max_over_alpha", "settlement_m", "base_tilt_rad", "ductility")
"""Responses that decide; drift and uplift go with the rotation."""


def section(pair: Pair) -> Section:
    """Report the better study, from the runs that both have."""
    studies = [
        study_of(study, runs.index.tolist()) for study, runs in zip(pair.studies, pair.matched.runs, strict=True)
    ]
    if studies[0].runs.empty:
        return Section("The answer", "answer", tag("p", "The two studies have no run in common."))
    worst = [worst_of_all(study.worst) for study in studies]
    content = join(tag("div", _better(studies, worst), class_="lead"), paragraphs(_pairs(pair)), _table(studies, worst))
    return Section("The answer", "answer", content)


def study_of(study: Finished, index: list[int]) -> Finished:
    """Return a study restricted to some of its runs."""
    return Finished(
        study.saved, study.runs.loc[index], study.series, study.piers, study.places, study.pier_places, study.cases
    )


def _better(studies: list[Finished], worst: list[dict[str, Worst]]) -> Markup:
    """Name the study with fewer runs that do not end standing, or else the one with smaller worst responses."""
    lost = [int(study.runs["status"].isin((*NO_PEAK, "failed")).sum()) for study in studies]
    if lost[0] != lost[1]:
        good, bad = (0, 1) if lost[0] < lost[1] else (1, 0)
        lead = f": of {counted(len(studies[0].runs), 'run')} {lost[good]} do not end standing, of {SIDES[bad]} {lost[bad]}."
        return join(tag("strong", f"{SIDES[good]} is better"), lead)
    changes = {
        name: _change(*(own[name].value for own in worst)) for name in INDEPENDENT if all(name in own for own in worst)
    }
    smaller, larger = (any(sign * change > LEVEL for change in changes.values()) for sign in (-1, 1))
    says = {
        (True, False): "B is better", (False, True): "A is better", (True, True): "Neither is better throughout",
        (False, False): "Neither is better",
    }[smaller, larger]  # fmt: skip
    diff = [
        f"{RESPONSES[name].words} {100 * change:+.3g} % ({_record(studies, worst, name)})"
        for name, change in changes.items()
    ]
    return join(tag("strong", says), f": from A to B, worst {', '.join(diff)}." if diff else ": no run ends standing.")


def _change(first: float, second: float) -> float:
    return second / first - 1.0 if first > 0.0 else math.inf if second > 0.0 else 0.0


def _record(studies: list[Finished], worst: list[dict[str, Worst]], name: str) -> str:
    """Return the record of the worst response, or those of both studies."""
    labels = (study.label(own[name].run["record"]) for study, own in zip(studies, worst, strict=True))
    return "; then ".join(dict.fromkeys(labels))


def _pairs(pair: Pair) -> str:
    """Report in how many pairs of runs the rotation is smaller, and the greatest changes either way."""
    a, b = pair.matched.runs
    first, second = (runs["theta_max_over_alpha"].where(runs["status"] == "ok").to_numpy(float) for runs in (a, b))
    both = (first > 0) & (second >= 0)
    if not both.any():
        return ""
    ratio = second[both] / first[both]
    runs = a[both]
    ends = [(float(ratio[place]), runs.iloc[place]) for place in (int(ratio.argmin()), int(ratio.argmax()))]
    said = [f"{value:.2g} times ({pair.named.label(run['record'])}, {pair.named.which(run)})" for value, run in ends]
    smaller = int((ratio < 1.0).sum())
    return (
        f"From A to B the rotation becomes smaller in {smaller} of {counted(int(both.sum()), 'pair')} of runs, larger in "
        f"{int((ratio > 1.0).sum())}; it changes to {said[0]} at least and to {said[1]} at most."
    )


def _table(studies: list[Finished], worst: list[dict[str, Worst]]) -> Markup:
    """Return the worst of every response in both studies as a table."""
    rows: list[list[object]] = []
    for name, response in RESPONSES.items():
        own = [responses.get(name) for responses in worst]
        if not any(own):
            continue
        row: list[object] = [response.words]
        for study, extreme in zip(studies, own, strict=True):
            row += ["none", None] if extreme is None else [in_words(extreme), _where(study, extreme)]
        values = [math.nan if extreme is None else extreme.value for extreme in own]
        row.append(values[1] / values[0] if values[0] > 0 and values[1] == values[1] else None)
        rows.append(row)
    heads = [Head("worst of the runs in common")]
    heads += [Head(words, over=side) for side in SIDES for words in ("value", "record and case")]
    return table([*heads, Head("B / A", ".3f")], rows, prose=True, name="Worst responses of both")


def _where(study: Finished, worst: Worst) -> str:
    return f"{study.label(worst.run['record'])}, {study.which(worst.run)}"
