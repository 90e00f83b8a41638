"""Whether the pier passes: the answer in a sentence, every check in every case at a glance, and what the checks ask."""

import math
from collections.abc import Sequence

from rockbatch.checks import Verdict, wording
from rockbatch.checks.answer import Line
from rockbatch.checks.answer import answer as answered
from rockbatch.checks.verdicts import CHECKS, DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS
from rockbatch.report.contents import Contents
from rockbatch.report.document import Section
from rockbatch.report.finished import Finished
from rockbatch.report.labels import quantity
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.table import Head, table

BASIS = {"code": "code clause", "literature": "literature", "judgement": "engineering judgement"}
SAID = {PASS: "passes:", FAIL: "fails:", NOT_DECIDED: "not decided:", DOES_NOT_APPLY: "does not apply"}
CLASSES = {PASS: "pass", FAIL: "fail", NOT_DECIDED: "undecided", DOES_NOT_APPLY: "muted"}
MOST_WORST = 10
"""Rows of the worst verdicts, where there are too many to tell all."""


def section(contents: Contents) -> Section | None:
    """Every check in every case, what the checks ask, and every verdict, or the worst of many; None without checks."""
    verdicts = contents.verdicts
    if not verdicts:
        return None
    parts: list[object] = [legend()]
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
        rest = [one for one in verdicts if one.verdict not in (FAIL, NOT_DECIDED)]
        parts += [matrix(verdicts), tag("h3", "Every verdict"), _every([*wording.worst_first(verdicts), *rest], notes)]
    return Section("Every check", "checks", join(*parts, tag("h3", "What the checks ask"), _asked(verdicts)))


def mark(verdict: str, words: str) -> Markup:
    """A verdict's sign before ``words``, in its colour; the sign has a name for those who hear the page."""
    sign = tag("span", wording.SIGNS[verdict], role="img", aria_label=SAID[verdict])
    return tag("span", sign, f"\u00a0{words}" if words else "", class_=CLASSES[verdict])


def answer(verdicts: Sequence[Verdict], finished: Finished) -> Markup:
    """Which cases pass, what fails and by how much, and what is not decided."""
    if not verdicts:
        return join(
            "No limits were set: nothing here passes or fails. ", tag("code", "rockbatch check"),
            " judges finished results by rules.",
        )  # fmt: skip
    scaled = len({one.scale for one in verdicts}) > 1
    lines = answered(verdicts, finished.worst, lambda one: _case(one, scaled), lambda one: finished.label(one.record))
    return tag("ul", *map(_line, lines), class_="answer")


def _line(line: Line) -> Markup:
    which = f": {line.which}." if line.which else "."
    details = tag("ul", *(tag("li", words) for words in line.details)) if line.details else ""
    return tag("li", tag("strong", mark(line.verdict, line.says)), which, details)


def _by_case(verdicts: Sequence[Verdict]) -> dict[str, list[Verdict]]:
    scaled = len({one.scale for one in verdicts}) > 1
    cases: dict[str, list[Verdict]] = {}
    for one in verdicts:
        cases.setdefault(_case(one, scaled), []).append(one)
    return cases


def _case(one: Verdict, scaled: bool) -> str:
    words = [quantity(key, value) for key, value in one.columns.items()]
    words += [f"motions scaled by {one.scale:g}"] if scaled else []
    return one.case + (f" ({', '.join(words)})" if words else "")


def legend() -> Markup:
    """What :func:`matrix` shows."""
    words = (
        "Demand over limit; above 1 is too much; of events, whether there are any. ✓ passes, ✗ fails, ? not decided: the bounds "
        "of the demand straddle the limit, or records are missing; – does not apply."
    )
    return tag("p", words, class_="legend")


def matrix(verdicts: Sequence[Verdict]) -> Markup:
    """A row for each case, a column for each check: demand over limit, and the verdict."""
    checks = list(dict.fromkeys(one.check for one in verdicts))
    rows = []
    for case, same in _by_case(verdicts).items():
        found = {one.check: one for one in same}
        rows.append([case, *(_cell(found[name]) if name in found else "" for name in checks)])
    return table([Head("case"), *(Head(name) for name in checks)], rows, name="Checks of every case")


def _cell(one: Verdict) -> Markup:
    return mark(one.verdict, wording.demanded(one) if one.is_ban else wording.ratio(one))


def _counts(verdicts: Sequence[Verdict]) -> Markup:
    """A row for each check: how many of its verdicts there are of each kind."""
    by_check: dict[str, list[Verdict]] = {}
    for one in verdicts:
        by_check.setdefault(one.check, []).append(one)
    rows = [
        [name, *(mark(way, str(n)) if n else "" for way, n in wording.count_of(same).items())]
        for name, same in by_check.items()
    ]
    return table([Head("check"), *(Head(way) for way in wording.WAYS)], rows, name="Verdicts of each kind")


def _asked(verdicts: Sequence[Verdict]) -> Markup:
    heads = [
        Head("check"),
        Head("asks"),
        Head("limit from"),
        Head("reason"),
    ]
    first = {one.check: one for one in reversed(verdicts)}
    asked = [first[name] for name in dict.fromkeys(one.check for one in verdicts)]
    rows = [[one.check, wording.asked(one), BASIS.get(one.basis, one.basis), one.reason] for one in asked]
    rests = {one.statistic: wording.unchecked(one) for one in asked}
    told = [
        *wording.Notes(verdicts).common(),
        *wording.counting(verdicts),
        *(f"{name}: {words}." for name, words in rests.items() if words),
    ]
    return join(table(heads, rows, prose=True, name="What the checks ask"), *(tag("p", words) for words in told))


def _every(verdicts: Sequence[Verdict], notes: wording.Notes) -> Markup:
    """A row for each verdict: its numbers with their unit, the run that governs, and what else there is to know."""
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
    scaled = len({one.scale for one in verdicts}) > 1
    rows = [
        [
            one.check, _case(one, scaled), mark(one.verdict, one.verdict), wording.demanded(one), _between(one),
            "" if math.isnan(one.value) else wording.limit(one), wording.margin(one), one.unit, one.records or None,
            wording.governing(one), "; ".join(filter(None, (one.counted, notes.of(one)))),
        ]
        for one in verdicts
    ]  # fmt: skip
    return table(heads, rows, sortable=True, prose=True, name="Verdicts")


def _between(one: Verdict) -> str:
    low, high = ("∞" if math.isinf(value) else number(value) for value in (one.low, one.high))
    return f"{low} – {high}" if low != high and not one.is_ban else ""
