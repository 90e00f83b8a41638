"""Verdicts: the answer in a sentence, every check in every case, and the demands of the checks."""

import math
from collections.abc import Sequence

from rockbatch.checks import Verdict, wording
from rockbatch.checks.answer import Line
from rockbatch.checks.answer import answer as answered
from rockbatch.checks.coverage import CaseRuns, stations_of
from rockbatch.checks.verdicts import CHECKS, DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS
from rockbatch.common.grouping import grouped
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, join, number, paragraphs, tag
from rockbatch.reporting.table import Head, table
from rockbatch.results.labels import quantity

BASIS = {"code": "code clause", "literature": "literature", "judgement": "engineering judgement"}
SAID = {PASS: "passes:", FAIL: "fails:", NOT_DECIDED: "not decided:", DOES_NOT_APPLY: "does not apply"}
CLASSES = {PASS: "pass", FAIL: "fail", NOT_DECIDED: "undecided", DOES_NOT_APPLY: "muted"}
MOST_WORST = 10
"""Rows of the worst verdicts, if there are too many to list all."""


def section(finished: Finished) -> Markup:
    """Return all checks in all cases, their demands, and all verdicts, or the worst of many; empty without checks."""
    verdicts = finished.verdicts
    if not verdicts:
        return Markup("")
    parts: list[object] = [LEGEND]
    notes = wording.Notes(verdicts)
    if len(verdicts) > wording.MOST:
        every = tag("summary", f"All {len(verdicts)} verdicts, a row for each case")
        worst = wording.worst_first(verdicts)[:MOST_WORST]
        parts += [_counts(verdicts), tag("details", every, matrix(verdicts)), tag("h3", "The worst verdicts")]
        parts.append(_every(worst, notes) if worst else tag("p", "Nothing fails or is left undecided."))
        parts.append(
            tag("p", "All of them, with what governs each, are in ", tag("a", tag("code", CHECKS), href=CHECKS), ".")
        )
    else:
        rest = [verdict for verdict in verdicts if verdict.verdict not in (FAIL, NOT_DECIDED)]
        parts += [matrix(verdicts), tag("h3", "Every verdict"), _every([*wording.worst_first(verdicts), *rest], notes)]
    return join(*parts, tag("h3", "What the checks ask"), _requirements(verdicts))


def mark(verdict: str, words: str) -> Markup:
    """Put a verdict's sign before ``words``, in its colour; screen readers read the sign's name."""
    sign = tag("span", wording.SIGNS[verdict], role="img", aria_label=SAID[verdict])
    return tag("span", sign, f"\u00a0{words}" if words else "", class_=CLASSES[verdict])


def answer(finished: Finished) -> Markup:
    """Report the cases that pass, what fails and by how much, and what is not decided."""
    scaled = len({runs.scale for runs in finished.suites}) > 1
    lines = answered(
        finished.verdicts, finished.worst, lambda row: _case(row, scaled), lambda row: finished.label(row.record),
        finished.suites, stations_of(finished.info),
    )  # fmt: skip
    listed = tag("ul", *map(_line, lines), class_="answer") if lines else ""
    if any(verdict.case for verdict in finished.verdicts):
        return join(listed)
    hint = join(tag("code", "rockbatch check"), " judges finished results by rules.")
    return join(listed, "No limits were set: no response passes or fails. ", hint)


def _line(line: Line) -> Markup:
    cases = f": {line.cases}." if line.cases else "."
    details = tag("ul", *(tag("li", words) for words in line.details)) if line.details else ""
    return tag("li", tag("strong", mark(line.verdict, line.text)), cases, details)


def _case(verdict: Verdict | CaseRuns, scaled: bool) -> str:
    if not verdict.case:
        return wording.SUITE
    words = [quantity(key, value) for key, value in verdict.columns.items()]
    words += [f"motions scaled by {verdict.scale:g}"] if scaled else []
    return verdict.case + (f" ({', '.join(words)})" if words else "")


LEGEND = tag(
    "p",
    "Demand over limit; above 1 is too much; of events, whether there are any. ✓ passes, ✗ fails, ? not decided: the bounds "
    "of the demand straddle the limit, or records are missing; – does not apply.",
    class_="legend",
)
"""Legend of :func:`matrix`."""


def matrix(verdicts: Sequence[Verdict]) -> Markup:
    """Return a row for each case, a column for each check: demand over limit, and the verdict."""
    checks = list(dict.fromkeys(verdict.check for verdict in verdicts))
    rows = []
    scaled = wording.scaled(verdicts)
    for case, of_case in grouped(verdicts, lambda verdict: _case(verdict, scaled)).items():
        by_check = {verdict.check: verdict for verdict in of_case}
        rows.append([case, *(_cell(by_check[name]) if name in by_check else "" for name in checks)])
    return table([Head("case"), *(Head(name) for name in checks)], rows, name="Checks of every case")


def _cell(verdict: Verdict) -> Markup:
    return mark(verdict.verdict, wording.demanded(verdict) if verdict.is_ban else wording.ratio(verdict))


def _counts(verdicts: Sequence[Verdict]) -> Markup:
    """Return a row for each check: the number of verdicts of each kind."""
    rows = [
        [name, *(mark(kind, str(n)) if n else "" for kind, n in count.items())]
        for name, count in wording.count_by_check(verdicts).items()
    ]
    return table([Head("check"), *map(Head, wording.WAYS)], rows, name="Verdicts of each kind")


def _requirements(verdicts: Sequence[Verdict]) -> Markup:
    firsts = [of_check[0] for of_check in grouped(verdicts, lambda verdict: verdict.check).values()]
    rows = [[row.check, wording.requirement(row), BASIS.get(row.basis, row.basis), row.reason] for row in firsts]
    rests = {row.statistic: wording.unchecked(row) for row in firsts}
    heads = map(Head, ("check", "asks", "limit from", "reason"))
    sentences = (f"{name}: {words}." for name, words in rests.items() if words)
    drawn = table([*heads], rows, prose=True, name="What the checks ask")
    return join(drawn, paragraphs(*wording.Notes(verdicts).common(), *wording.counting(verdicts), *sentences))


def _every(verdicts: Sequence[Verdict], notes: wording.Notes) -> Markup:
    """Return a row for each verdict: its numbers with their unit, the governing run, and remarks."""
    bounds = "bounds left by errors, by the other spring law and by runs without an outcome"
    heads = [
        Head("check"),
        Head("case"),
        Head("verdict"),
        Head("demand"),
        Head("between", note=bounds),
        Head("limit"),
        Head("margin", note="distance to the limit; negative beyond it"),
        Head("unit"),
        Head(wording.records_of(verdicts), note="that count"),
        Head(
            "governing run", note="station, component and polarity, and what that run demands; of a mean, the largest"
        ),
        Head("note"),
    ]
    scaled = wording.scaled(verdicts)
    rows = [
        [
            row.check, _case(row, scaled), mark(row.verdict, row.verdict), wording.demanded(row), _between(row),
            "" if math.isnan(row.value) else wording.limit(row), wording.margin(row), row.unit, row.records or None,
            wording.governing(row), "; ".join(filter(None, (row.counted, notes.about(row)))),
        ]
        for row in verdicts
    ]  # fmt: skip
    return table(heads, rows, sortable=True, prose=True, name="Verdicts")


def _between(verdict: Verdict) -> str:
    low, high = ("∞" if math.isinf(value) else number(value) for value in (verdict.low, verdict.high))
    return f"{low} – {high}" if low != high and not verdict.is_ban else ""
