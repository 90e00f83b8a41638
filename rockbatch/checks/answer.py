"""The answer to a set of checks, in a designer's order: cases that pass, that fail and why, and that are not decided."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from rockbatch.checks import wording
from rockbatch.checks.demands import DEMANDS
from rockbatch.checks.responses import RESPONSES, Worst, in_words, unlimited, worst_of_all
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS, Verdict
from rockbatch.common.grouping import grouped

MOST_NAMES = 6
MOST_CHECKS = 3
"""Greatest number of checks that fail or are not decided with a line each in the answer."""

Words = Callable[[Verdict], str]


class Line(NamedTuple):
    """One statement of the answer: its verdict, its text, its cases and the details."""

    verdict: str
    text: str
    cases: str
    details: tuple[str, ...]


def answer(verdicts: Sequence[Verdict], worst: Sequence[Worst], case_of: Words, record_of: Words) -> list[Line]:
    """Return the lines of the answer.

    Parameters
    ----------
    verdicts : sequence of Verdict
    worst : sequence of Worst
        The worst response of every case.
    case_of, record_of : function
        Of a verdict: the name of its case, and of the record that governs it.
    """
    below = [verdict for verdict in verdicts if not verdict.case and verdict.verdict == FAIL]
    cases = grouped((verdict for verdict in verdicts if verdict.case), case_of)
    kinds = {name: {verdict.verdict for verdict in of_case} for name, of_case in cases.items()}
    failing = [name for name, of_case in kinds.items() if FAIL in of_case]
    open_ = [name for name, of_case in kinds.items() if NOT_DECIDED in of_case and FAIL not in of_case]
    meeting = [name for name in cases if name not in failing and name not in open_]
    free = {name: _unlimited(cases[name], worst) for name in meeting}
    every = _Cases(cases, case_of, record_of)
    lines = [
        every.passing([name for name in meeting if not free[name]]),
        every.without_limit({name: free[name] for name in meeting if free[name]}),
        every.failing(failing),
        every.undecided(open_, failing),
    ]
    return [*_below(below), *(_doubted(line) if below else line for line in lines if line)]


def _below(verdicts: Sequence[Verdict]) -> list[Line]:
    """Return the line on a suite that fails these checks of its own; none if it fails none."""
    details = tuple(f"{verdict.check}: {wording.against(verdict)}, {verdict.note}." for verdict in verdicts)
    return [Line(FAIL, "The suite is below its target", "", details)] if details else []


def _doubted(line: Line) -> Line:
    """Return a line under a suite below its target: it fails what fails, and passes nothing."""
    if line.verdict != PASS:
        return line
    return line._replace(verdict=NOT_DECIDED, text=f"{line.text}, but under a suite below its target")


def _unlimited(verdicts: Sequence[Verdict], worst: Sequence[Worst]) -> list[Worst]:
    key = _key(verdicts[0].case, verdicts[0].columns)
    return unlimited(
        [response for response in worst if _key(response.case["case"], response.case["columns"]) == key], verdicts
    )


def _key(case: str, columns: Mapping[str, float | str]) -> tuple[object, ...]:
    """Return the key that distinguishes cases, with the ten digits of the files."""
    values = ((name, value if isinstance(value, str) else f"{value:.9g}") for name, value in columns.items())
    return str(case), *sorted(values)


@dataclass(frozen=True)
class _Cases:
    """Verdicts by the name of their case, and the words for the case and the record of a verdict."""

    verdicts: Mapping[str, Sequence[Verdict]]
    case_of: Words
    record_of: Words

    def passing(self, names: Sequence[str]) -> Line | None:
        """Return the line on cases that pass every check."""
        if not names:
            return None
        ratios = [judged for judged in self._of(names) if math.isfinite(judged.ratio) and not judged.is_ban]
        closest = max(ratios, key=lambda verdict: verdict.ratio, default=None)
        details = self._exempt(names)
        if closest is not None:
            place = f", in {self.case_of(closest)}" if len(names) > 1 else ""
            details = (f"Closest to its limit: {closest.check}, {wording.against(closest)}{place}.", *details)
        if len(names) == len(self.verdicts):
            return Line(PASS, f"Every check passes in {self._among(names)}", "", details)
        return Line(PASS, f"{self._among(names)} pass{'es' * (len(names) == 1)} every check", _listed(names), details)

    def without_limit(self, free: Mapping[str, Sequence[Worst]]) -> Line | None:
        """Return the line on cases that pass only because their governing responses have no limit."""
        worst = worst_of_all(response for responses in free.values() for response in responses)
        if not worst:
            return None
        names = ", ".join(RESPONSES[name].words for name in worst)
        text = f"{self._among(free)} meet{'s' * (len(free) == 1)} the limits, but none is set on {names}"
        values = ", ".join(f"{RESPONSES[name].words} {in_words(response)}" for name, response in worst.items())
        return Line(NOT_DECIDED, _capital(text), _listed(list(free)), (f"Without a limit, at most: {values}.",))

    def failing(self, names: Sequence[str]) -> Line | None:
        """Return the line on checks that fail, each with its worst demand, and the case nearest to passing."""
        if not names:
            return None
        checks = grouped(self._of(names, FAIL), lambda verdict: verdict.check)
        worst = sorted((max(group, key=_excess) for group in checks.values()), key=_excess, reverse=True)
        details = [self._failure(verdict, len(checks[verdict.check]) - 1) for verdict in worst[:MOST_CHECKS]]
        if others := [verdict.check for verdict in worst[MOST_CHECKS:]]:
            details.append(f"{', '.join(others[:MOST_NAMES])}: fail, too; see every check.")
        near = min((max(self._of([name], FAIL), key=_excess) for name in names), key=_excess)
        if len(names) > 1 and math.isfinite(_excess(near)):
            case = self.case_of(near)
            details.append(f"Nearest to passing: {case}, {near.check} at {wording.ratio(near)} × its limit.")
            details += self._exempt([case])
        text = f"{self._among(names)} fail{'s' * (len(names) == 1)}"
        return Line(FAIL, _capital(text), _listed(names), tuple(details))

    def _failure(self, verdict: Verdict, more: int) -> str:
        """Return a check with its demand, its limit and the record that governs it; ``more`` cases fail it, too."""
        other_cases = f" and {more} more case{'s' * (more > 1)}" if more else ""
        place = f"in {self.case_of(verdict)}{other_cases}" if len(self.verdicts) > 1 else ""
        record = self.record_of(verdict) if verdict.record else ""
        if verdict.is_ban:
            verb = DEMANDS[verdict.demand].verb if verdict.demand in DEMANDS else "is not so"
            return " ".join(filter(None, (f"{verdict.check}: {record or 'some record'} {verb}", place))) + "."
        if (
            record and math.isfinite(verdict.governing) and verdict.governing != verdict.value
        ):  # a mean, say, of several
            record = f"at most {wording.number(verdict.governing)} {verdict.unit}".rstrip() + f" in {record}"
        return ", ".join(filter(None, (f"{verdict.check}: {wording.against(verdict)}", record, place))) + "."

    def undecided(self, names: Sequence[str], failing: Sequence[str]) -> Line | None:
        """Return the line on cases that are not decided, and why; in cases that fail anyway it does not matter."""
        idle = ", ".join(dict.fromkeys(verdict.check for verdict in self._of(failing, NOT_DECIDED)))
        if not names:
            return Line(NOT_DECIDED, "Left undecided", f"{idle}, in cases that fail anyway", ()) if idle else None
        verdicts = self._of(names, NOT_DECIDED)
        details = [self._doubt(verdict) for verdict in verdicts[:MOST_CHECKS]]
        if len(verdicts) > MOST_CHECKS:
            details.append(f"and {len(verdicts) - MOST_CHECKS} more.")
        if idle:
            details.append(f"{idle}: not decided in cases that fail anyway.")
        return Line(NOT_DECIDED, _capital(f"{self._among(names)} cannot be decided"), _listed(names), tuple(details))

    def _doubt(self, verdict: Verdict) -> str:
        case = f" in {self.case_of(verdict)}" if len(self.verdicts) > 1 else ""
        limit = "" if verdict.is_ban else f"limit {wording.number(verdict.limit)} {verdict.unit}".rstrip()
        cause = f"left open by {self.record_of(verdict)}" if verdict.record else ""
        return ", ".join(filter(None, (f"{verdict.check}{case}: {verdict.note}", limit, cause))) + "."

    def _exempt(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return which checks do not apply to which cases, a sentence for each set of checks."""
        exempt = grouped(names, lambda name: tuple(verdict.check for verdict in self._of([name], DOES_NOT_APPLY)))
        return tuple(
            f"Not asked of {_listed(cases)}: {', '.join(checks)}, which do{'es' * (len(checks) == 1)} not apply there."
            for checks, cases in exempt.items()
            if checks
        )

    def _of(self, names: Sequence[str], kind: str = "") -> list[Verdict]:
        """Return the verdicts of these cases, all or those of one kind."""
        return [verdict for name in names for verdict in self.verdicts[name] if not kind or verdict.verdict == kind]

    def _among(self, cases: Collection[str]) -> str:
        total = len(self.verdicts)
        if len(cases) == total:
            return {1: "the only case", 2: "both cases"}.get(total, f"all {total} cases")
        return f"{len(cases)} of {total} cases"


def _excess(verdict: Verdict) -> float:
    """Return the ratio by which a check exceeds its limit; infinite for events that must not occur."""
    return math.inf if verdict.is_ban or math.isnan(verdict.ratio) else verdict.ratio


def _capital(words: str) -> str:
    return words[0].upper() + words[1:]


def _listed(names: Sequence[str]) -> str:
    more = len(names) - MOST_NAMES
    return "; ".join(names[:MOST_NAMES]) + (f"; and {more} more" if more > 0 else "")
