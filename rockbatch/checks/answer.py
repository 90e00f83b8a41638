"""The answer to a set of checks, in the order in which a designer asks: what passes, what fails and by what, what is open."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from rockbatch.checks import wording
from rockbatch.checks.demands import DEMANDS
from rockbatch.checks.responses import RESPONSES, Worst, in_words, unlimited, worst_of_all
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS, Verdict

MOST_NAMES = 6
MOST_CHECKS = 3
"""Checks that fail, or are not decided, of which the answer has a line each."""

Words = Callable[[Verdict], str]


class Line(NamedTuple):
    """One statement of the answer: its sign, what it says, of which cases, and why."""

    verdict: str
    says: str
    which: str
    details: tuple[str, ...]


def answer(verdicts: Sequence[Verdict], worst: Sequence[Worst], case_of: Words, record_of: Words) -> list[Line]:
    """Return the lines of the answer.

    Parameters
    ----------
    verdicts : sequence of Verdict
    worst : sequence of Worst
        The worst response of every case.
    case_of, record_of : function
        Of a verdict: what its case, and the record that governs it, are called.
    """
    cases: dict[str, list[Verdict]] = {}
    for one in verdicts:
        cases.setdefault(case_of(one), []).append(one)
    ways = {name: {one.verdict for one in same} for name, same in cases.items()}
    failing = [name for name, found in ways.items() if FAIL in found]
    open_ = [name for name, found in ways.items() if NOT_DECIDED in found and FAIL not in found]
    meeting = [name for name in cases if name not in failing and name not in open_]
    free = {name: _unlimited(cases[name], worst) for name in meeting}
    passing = [name for name in meeting if not free[name]]
    lines = [
        _passing(passing, cases, case_of),
        _without_limit({name: free[name] for name in meeting if free[name]}, len(cases)),
        _failing(failing, cases, case_of, record_of),
        _open(open_, failing, cases, case_of, record_of),
    ]
    return [line for line in lines if line]


def _unlimited(verdicts: Sequence[Verdict], worst: Sequence[Worst]) -> list[Worst]:
    own = [
        one
        for one in worst
        if _key(one.case["case"], one.case["columns"]) == _key(verdicts[0].case, verdicts[0].columns)
    ]
    return unlimited(own, verdicts)


def _key(case: str, columns: Mapping[str, float | str]) -> tuple[object, ...]:
    """Return what distinguishes cases, in the ten digits that the files have."""
    values = ((name, value if isinstance(value, str) else f"{value:.9g}") for name, value in columns.items())
    return str(case), *sorted(values)


def _passing(names: Sequence[str], cases: Mapping[str, Sequence[Verdict]], case_of: Words) -> Line | None:
    if not names:
        return None
    ratios = [one for name in names for one in cases[name] if math.isfinite(one.ratio) and not one.is_ban]
    closest = max(ratios, key=lambda one: one.ratio, default=None)
    details: tuple[str, ...] = ()
    if closest is not None:
        where = f", in {case_of(closest)}" if len(names) > 1 else ""
        details = (f"Closest to its limit: {closest.check}, {wording.against(closest)}{where}.",)
    details += _exempt({name: cases[name] for name in names})
    if len(names) == len(cases):
        return Line(PASS, f"Every check passes in {_among(len(names), len(cases))}", "", details)
    says = f"{_among(len(names), len(cases))} pass{'es' * (len(names) == 1)} every check"
    return Line(PASS, says, _listed(names), details)


def _exempt(cases: Mapping[str, Sequence[Verdict]]) -> tuple[str, ...]:
    """Return which checks do not apply to which cases, a sentence for each set of checks."""
    exempt: dict[tuple[str, ...], list[str]] = {}
    for name, own in cases.items():
        if checks := tuple(one.check for one in own if one.verdict == DOES_NOT_APPLY):
            exempt.setdefault(checks, []).append(name)
    return tuple(
        f"Not asked of {_listed(names)}: {', '.join(checks)}, which do{'es' * (len(checks) == 1)} not apply there."
        for checks, names in exempt.items()
    )


def _without_limit(free: Mapping[str, Sequence[Worst]], all_: int) -> Line | None:
    """Return the line on cases that fail nothing because nothing limits what governs them."""
    worst = worst_of_all(one for same in free.values() for one in same)
    if not worst:
        return None
    names = ", ".join(RESPONSES[name].words for name in worst)
    says = f"{_among(len(free), all_)} meet{'s' * (len(free) == 1)} the limits, but none is set on {names}"
    values = ", ".join(f"{RESPONSES[name].words} {in_words(one)}" for name, one in worst.items())
    return Line(NOT_DECIDED, _capital(says), _listed(list(free)), (f"Without a limit, at most: {values}.",))


def _failing(
    names: Sequence[str], cases: Mapping[str, Sequence[Verdict]], case_of: Words, record_of: Words
) -> Line | None:
    """Return the line on checks that fail, each with its worst demand, and the case nearest to passing."""
    if not names:
        return None
    failed = {name: [one for one in cases[name] if one.verdict == FAIL] for name in names}
    checks: dict[str, list[Verdict]] = {}
    for one in (one for same in failed.values() for one in same):
        checks.setdefault(one.check, []).append(one)
    worst = sorted((max(same, key=_excess) for same in checks.values()), key=_excess, reverse=True)
    details = [
        _told(one, record_of, _where(one, checks[one.check], len(cases), case_of)) for one in worst[:MOST_CHECKS]
    ]
    if rest := [one.check for one in worst[MOST_CHECKS:]]:
        details.append(f"{', '.join(rest[:MOST_NAMES])}: fail, too; see every check.")
    near = min((max(same, key=_excess) for same in failed.values()), key=_excess)
    if len(names) > 1 and math.isfinite(_excess(near)):
        details.append(f"Nearest to passing: {case_of(near)}, {near.check} at {wording.ratio(near)} × its limit.")
        details += _exempt({case_of(near): cases[case_of(near)]})
    says = f"{_among(len(names), len(cases))} fail{'s' * (len(names) == 1)}"
    return Line(FAIL, _capital(says), _listed(names), tuple(details))


def _where(worst: Verdict, same: Sequence[Verdict], cases: int, case_of: Words) -> str:
    if cases == 1:
        return ""
    return f"in {case_of(worst)}" + (f" and {len(same) - 1} more case{'s' * (len(same) > 2)}" if len(same) > 1 else "")


def _told(one: Verdict, record_of: Words, where: str) -> str:
    """Return a check with its demand, its limit and the record that governs it."""
    record = record_of(one) if one.record else ""
    if one.is_ban:
        verb = DEMANDS[one.demand].verb if one.demand in DEMANDS else "is not so"
        return " ".join(filter(None, (f"{one.check}: {record or 'some record'} {verb}", where))) + "."
    if record and math.isfinite(one.governing) and one.governing != one.value:  # a mean, say, of several
        record = f"at most {wording.number(one.governing)} {one.unit}".rstrip() + f" in {record}"
    return ", ".join(filter(None, (f"{one.check}: {wording.against(one)}", record, where))) + "."


def _open(
    names: Sequence[str],
    failing: Sequence[str],
    cases: Mapping[str, Sequence[Verdict]],
    case_of: Words,
    record_of: Words,
) -> Line | None:
    """Return what is not decided, and why; in cases that fail anyway it does not matter."""
    idle = [one for name in failing for one in cases[name] if one.verdict == NOT_DECIDED]
    if not names and not idle:
        return None
    checks = ", ".join(dict.fromkeys(one.check for one in idle))
    if not names:
        return Line(NOT_DECIDED, "Left undecided", f"{checks}, in cases that fail anyway", ())
    anyway = f"{checks}: not decided in cases that fail anyway." if idle else ""
    left = [one for name in names for one in cases[name] if one.verdict == NOT_DECIDED]
    details = [_why(one, record_of, case_of(one) if len(cases) > 1 else "") for one in left[:MOST_CHECKS]]
    if len(left) > MOST_CHECKS:
        details.append(f"and {len(left) - MOST_CHECKS} more.")
    says = f"{_among(len(names), len(cases))} cannot be decided"
    return Line(NOT_DECIDED, _capital(says), _listed(names), tuple(filter(None, (*details, anyway))))


def _why(one: Verdict, record_of: Words, case: str) -> str:
    limit = "" if one.is_ban else f"limit {wording.number(one.limit)} {one.unit}".rstrip()
    by = f"left open by {record_of(one)}" if one.record else ""
    return ", ".join(filter(None, (f"{one.check}{f' in {case}' if case else ''}: {one.note}", limit, by))) + "."


def _excess(one: Verdict) -> float:
    """Return the ratio by which a check exceeds its limit; infinite for events that may not be."""
    return math.inf if one.is_ban or math.isnan(one.ratio) else one.ratio


def _among(some: int, all_: int) -> str:
    if some == all_:
        return {1: "the only case", 2: "both cases"}.get(all_, f"all {all_} cases")
    return f"{some} of {all_} cases"


def _capital(words: str) -> str:
    return words[0].upper() + words[1:]


def _listed(names: Sequence[str]) -> str:
    more = len(names) - MOST_NAMES
    return "; ".join(names[:MOST_NAMES]) + (f"; and {more} more" if more > 0 else "")
