"""The answer to a set of checks, in a designer's order: cases that pass, that fail and why, and that are not decided."""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from rockbatch.checks import wording
from rockbatch.checks.coverage import ALL_STATIONS, CaseRuns, File, Stations, joined
from rockbatch.checks.omissions import OMISSIONS
from rockbatch.checks.responses import RESPONSES, Worst, in_words, unlimited, worst_of_all
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, MEAN_OVER_TARGET, NOT_DECIDED, PASS, Verdict
from rockbatch.common.grouping import grouped
from rockbatch.common.showing import MOST_LISTED, abridged, capital, shown
from rockbatch.quantities.cases import name_along
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.design import BOUND, under
from rockbatch.quantities.statistics import STATISTICS

MOST_NAMES = 3
"""Most names of cases that are listed, since the scorecard has all of them."""
MOST_CHECKS = 3
"""Greatest number of checks that fail or are not decided with a line each in the answer."""

Words = Callable[[Verdict], str]
CaseWords = Callable[[Verdict | CaseRuns], str]


class Line(NamedTuple):
    """One statement of the answer: its verdict, its text, its cases and the details."""

    verdict: str
    text: str
    cases: str
    details: tuple[str, ...]


def answer(
    verdicts: Sequence[Verdict],
    worst: Sequence[Worst],
    case_of: CaseWords,
    record_of: Words,
    runs: Sequence[CaseRuns] = (),
    stations: Stations = ALL_STATIONS,
) -> list[Line]:
    """Return the lines of the answer: failing suite, cases that pass, lack a limit, fail or are undecided, missing stations.

    A line with nothing to say is left out; missing stations come before the cases if any case meets its limits. Unchecked cases
    have a line of their own only if no case passes. ``worst`` are the worst responses of every case at each scale. ``case_of``
    and ``record_of`` name the case of a verdict, the same under all bounds of the design, and the record that governs it.
    ``runs`` are of every case of the study, checked or not; by default of those with verdicts.
    """
    below = [verdict for verdict in verdicts if not verdict.case and verdict.verdict == FAIL]
    of_cases = [verdict for verdict in verdicts if verdict.case]
    cases = grouped(of_cases, case_of)
    names_of = {_key(verdict.case, verdict.columns | {"": verdict.scale}): case_of(verdict) for verdict in of_cases}
    by_name = grouped(
        runs, lambda case: names_of.get(_key(case.case, {**case.columns, "": case.scale})) or case_of(case)
    )
    every = _Cases(cases, by_name, case_of, record_of, stations)
    kinds = {name: {verdict.verdict for verdict in of_case} for name, of_case in cases.items()}
    failing = [name for name, of_case in kinds.items() if FAIL in of_case]
    open_ = [name for name, of_case in kinds.items() if NOT_DECIDED in of_case and FAIL not in of_case]
    meeting = [name for name in cases if name not in {*failing, *open_, *every.unchecked}]
    free = without_limits({name: cases[name] for name in meeting}, worst)
    scales = {verdict.scale for verdict in below}
    doubted = [name for name in meeting if name not in free and cases[name][0].scale in scales]
    passing = every.passing([name for name in meeting if name not in {*free, *doubted}])
    lines = [
        passing,
        _line_under_failing_suite(every.passing(doubted), below),
        every.without_limit(free),
        every.failing(failing),
        every.undecided(open_, failing),
        None if passing or doubted or not of_cases else every.unchecked_alone(),
    ]
    missing = missing_stations(stations)
    # Missing stations qualify a pass; a failure holds without them, too
    lines = [missing, *lines] if meeting else [*lines, missing]
    return [*_lines_on_suite(below), *filter(None, lines)]


def _is_low(below: Sequence[Verdict]) -> bool:
    """Return whether one of the failing verdicts on a suite is that its mean spectrum is too low."""
    return any(verdict.demand == MEAN_OVER_TARGET for verdict in below)


def _lines_on_suite(verdicts: Sequence[Verdict]) -> list[Line]:
    """Return one line that the suite fails, with up to three sentences on the failing ``verdicts``, "and 2 more."; or []."""
    sentences: dict[str, None] = {}  # most conditions are the same at every scale
    for verdict in verdicts:
        parts = filter(None, (wording.against(verdict), verdict.note))
        sentences[f"{wording.name_of(verdict)}: {', '.join(parts)}."] = None
    details = [*sentences]
    more = [f"and {len(details) - MOST_CHECKS} more."] if len(details) > MOST_CHECKS else []
    text = (
        "The suite is below its target" if _is_low(verdicts) else "The suite does not conform to the code of its target"
    )
    return [Line(FAIL, text, "", (*details[:MOST_CHECKS], *more))] if details else []


def _line_under_failing_suite(line: Line | None, below: Sequence[Verdict]) -> Line | None:
    """Return the line on cases that pass, as undecided because their suite fails; None for None."""
    if line is None:
        return None
    suite = "a suite below its target" if _is_low(below) else "a suite that does not conform to the code of its target"
    return line._replace(verdict=NOT_DECIDED, text=f"{line.text}, but under {suite}")


def missing_stations(stations: Stations) -> Line | None:
    """Return the line on stations without a usable motion, or with unusable files beside usable ones; None if there are none.

    Its text is "8 of 10 stations; A, 2 files of B could not be used", without the numbers if stations are not known.
    A single reason follows the text; of several, up to three are details, and how many more. The last detail is the key that
    leaves these stations out.
    """
    if not stations.unusable:
        return None
    whole = [name for name in stations.unusable if name not in stations.used]
    parts = {name: files for name, files in stations.unusable.items() if name in stations.used}
    names = _wholly_or_in_part(stations.unusable, stations.used)
    text = f"{abridged(names, ', ')} could not be used"
    if stations.known:
        text = f"{len(stations.used)} of {stations.total} stations; {text}"
    reasons = grouped(
        stations.unusable, lambda name: "{source}: {reason}".format_map(stations.unusable[name][0]).rstrip(".")
    )
    details = [f"{abridged(of_reason, ', ')}: {reason}." for reason, of_reason in reasons.items()]
    more = [f"and {len(details) - MOST_CHECKS} more."] if len(details) > MOST_CHECKS else []
    keys = [*whole, *(file["name"] for files in parts.values() for file in files)]
    listed = ", ".join([*map(shown, keys[:MOST_LISTED]), *("…" for _ in keys[MOST_LISTED : MOST_LISTED + 1])])
    remedy = f"To leave them out on purpose: leave_out = [{listed}] under [motions]."
    if len(details) == 1:
        return Line(NOT_DECIDED, text, next(iter(reasons)), (remedy,))
    return Line(NOT_DECIDED, text, "", (*details[:MOST_CHECKS], *more, remedy))


def _wholly_or_in_part(stations: Mapping[str, Sequence[File]], used: Collection[str]) -> list[str]:
    """Return the names of ``stations`` that are not ``used``, then for each used one the number of its files: "2 files of A"."""
    parts = [f"{len(files)} file{'s' * (len(files) > 1)} of {name}" for name, files in stations.items() if name in used]
    return [name for name in stations if name not in used] + parts


def without_limits(cases: Mapping[str, Sequence[Verdict]], worst: Sequence[Worst]) -> dict[str, list[Worst]]:
    """Return the governing responses that no check bounds, by the name of their case; cases without any are left out.

    ``cases`` have the verdicts of each case at one scale, ``worst`` the worst responses of every case at each scale.
    """
    by_case = grouped(
        worst, lambda response: (*_key(name_along(response.case), response.case["columns"]), response.scale)
    )
    free: dict[str, list[Worst]] = {}
    for name, verdicts in cases.items():
        under_bounds = grouped(verdicts, lambda verdict: (*_key(verdict.case, verdict.columns), verdict.scale))
        without_limit = [
            response for key, of_case in under_bounds.items() for response in unlimited(by_case.get(key, []), of_case)
        ]
        if without_limit:
            free[name] = without_limit
    return free


def _key(case: object, columns: Mapping[str, float | str]) -> tuple[object, ...]:
    """Return a key that equal cases share: the name and the sorted varied values, numbers as text of nine digits."""
    values = ((name, value if isinstance(value, str) else f"{value:.9g}") for name, value in columns.items())
    return str(case), *sorted(values)


@dataclass(frozen=True)
class _Cases:
    """Verdicts and runs by the name of their case, those under its bounds too, the words for a verdict, and the stations."""

    verdicts: Mapping[str, Sequence[Verdict]]
    runs: Mapping[str, Sequence[CaseRuns]]
    case_of: CaseWords
    record_of: Words
    stations: Stations

    @cached_property
    def every(self) -> list[str]:
        """Names of all cases."""
        return list(dict.fromkeys((*self.runs, *self.verdicts)))

    @cached_property
    def unchecked(self) -> list[str]:
        """Names of cases to which no check applies, or whose checks pass though under one of the bounds no run ends standing."""
        return [name for name in self.every if not self._of([name], FAIL, NOT_DECIDED) and not self._passes(name)]

    def _passes(self, name: str) -> bool:
        """Return whether a check of the case passes, and runs end standing under every bound of the design."""
        return bool(self._of([name], PASS)) and not any(runs.none_stands for runs in self.runs.get(name, ()))

    def passing(self, names: Sequence[str]) -> Line | None:
        """Return the line on cases that pass every check; None for no case.

        Its verdict is "not decided" if another case is not checked, or a station could not be used.
        """
        if not names:
            return None
        ratios = [judged for judged in self._of(names) if math.isfinite(judged.ratio) and not judged.is_ban]
        closest = max(ratios, key=lambda verdict: verdict.ratio, default=None)
        details: tuple[str, ...] = ()
        if closest is not None:
            details = (f"Closest to its limit: {self._place(closest)} at {wording.percent(closest.ratio)}.",)
        details = (
            *details,
            *self._alone(names),
            *self._coverage(names),
            *self._beyond(names),
            *self._cut_short(names),
            *self._omitted(names),
            *self._without_a_case(),
            *self._left_out(),
        )
        verdict = NOT_DECIDED if self.unchecked or self.stations.unusable else PASS
        if len(names) == len(self.every):
            return Line(verdict, f"Every check passes in {self._among(names)}{self._under_every_bound}", "", details)
        passes = f"{self._among(names)} pass{'es' * (len(names) == 1)}"
        if not self.unchecked:
            return Line(verdict, f"{passes} every check{self._under_every_bound}", _few(names), details)
        rest = f"{len(self.unchecked)} {'is' if len(self.unchecked) == 1 else 'are'} not checked"
        passed = (f"Passes: {_few(names)}.",) if _few(names) else ()
        lists = f"Not checked: {self._with_ends(self.unchecked)}.", *passed
        return Line(verdict, f"{passes}; {rest}", "", (*lists, *details))

    def unchecked_alone(self) -> Line | None:
        """Return the line on all cases that are not checked, for an answer without other lines on them; None if none is."""
        names = self.unchecked
        if not names:
            return None
        text = f"{self._among(names)} {'is' if len(names) == 1 else 'are'} not checked"
        return Line(NOT_DECIDED, capital(text), self._with_ends(names), ())

    def _with_ends(self, names: Sequence[str]) -> str:
        """Return up to three names of cases, most runs cut short first: "pads, 2 of 10 runs overturned; piles".

        Of more follows "; and 2 more", and how many of these have runs that do not end standing, if any.
        """
        runs = {name: joined(self.runs[name]) for name in names if name in self.runs}
        ends = {name: runs[name].in_words if name in runs else "" for name in names}
        order = sorted(names, key=lambda name: -sum(runs[name].ended.values()) if ends[name] else 0)
        words = [f"{name}, {ends[name]}" if ends[name] else name for name in order]
        more = sum(bool(ends[name]) for name in order[MOST_NAMES:])
        return abridged(words, most=MOST_NAMES) + (
            f", {more} of them with runs that do not end standing" if more else ""
        )

    def _cut_short(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return a sentence on the cases with runs that do not end standing, by :meth:`_with_ends`; () if all runs stand."""
        ended = [name for name in names if any(runs.ended for runs in self.runs.get(name, ()))]
        return (f"Not every run ends standing: {self._with_ends(ended)}.",) if ended else ()

    def _alone(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return "Under one motion only." if no check that these cases pass counts more than one record; () otherwise."""
        return ("Under one motion only.",) if wording.are_of_one_motion(self._of(names, PASS)) else ()

    def _coverage(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return the sentences of statistics on how many further records may exceed them, each after the checks that these cases
        pass by it; () for none.
        """
        passed = [
            (statistic.coverage(verdict.records), verdict.check)
            for verdict in self._of(names, PASS)
            if (statistic := STATISTICS.get(verdict.statistic)) and statistic.coverage
        ]
        checks = grouped(passed, lambda pair: pair[0])
        return tuple(
            f"{', '.join(dict.fromkeys(check for _, check in of_words))}: {words}."
            for words, of_words in checks.items()
        )

    def _beyond(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return a sentence on checks that these cases pass by a statistic though a record is beyond the limit; () for none.

        Each has the record farthest beyond it: "Single records are beyond the limit: drift (Te Mara, 0.6 m).".
        """
        passed = [verdict for verdict in self._of(names, PASS) if wording.is_passed_by_statistic(verdict)]
        farthest = {
            check: max(same, key=lambda verdict: verdict.governing)
            for check, same in grouped(passed, lambda verdict: verdict.check).items()
        }
        words = [f"{check} ({wording.demanded_by(row, self.record_of(row))})" for check, row in farthest.items()]
        return (f"Single records are beyond the limit: {abridged(words, most=MOST_CHECKS)}.",) if words else ()

    def _omitted(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return a sentence, "drift, uplift: REMARK; REMARK.", on omissions of the same checks that these cases pass.

        More than three checks are "all checks of runs", except whether they settled, or "drift, uplift, fall, and 2 more".
        """
        passed = self._of(names, PASS)
        every = {verdict.check for verdict in passed if DEMANDS[verdict.demand].of_motion}
        checks = {
            name: omitting
            for name in OMISSIONS
            if (omitting := tuple(dict.fromkeys(verdict.check for verdict in passed if name in verdict.omits)))
        }
        sentences = []
        for of_checks, omitted in grouped(checks, checks.__getitem__).items():
            is_all = len(of_checks) > MOST_CHECKS and every.issubset(of_checks)
            words = "all checks of runs" if is_all else abridged(of_checks, ", ", MOST_CHECKS)
            sentences.append(f"{words}: {'; '.join(OMISSIONS[name].remark for name in omitted)}.")
        return tuple(sentences)

    def _without_a_case(self) -> tuple[str, ...]:
        """Return "Applies to no case: bearing, tilt." for checks of which every verdict says so; () for none."""
        by_check = grouped(self._of(self.every), lambda verdict: verdict.check)
        idle = [name for name, same in by_check.items() if {verdict.verdict for verdict in same} == {DOES_NOT_APPLY}]
        return (f"{'Apply' if len(idle) > 1 else 'Applies'} to no case: {abridged(idle, ', ')}.",) if idle else ()

    def _left_out(self) -> tuple[str, ...]:
        """Return sentences on stations, and files of used ones, left out by name, and on stations not selected; () for none.

        "Left out by name: A, 2 files of B.", "Not selected: C, D."
        """
        by_name = _wholly_or_in_part(self.stations.left_out, self.stations.used)
        lists = {"Left out by name": by_name, "Not selected": self.stations.not_selected}
        return tuple(f"{words}: {abridged(names, ', ')}." for words, names in lists.items() if names)

    def without_limit(self, free: Mapping[str, Sequence[Worst]]) -> Line | None:
        """Return the line on cases that pass only because their governing responses have no limit; None for no case."""
        worst = worst_of_all(response for responses in free.values() for response in responses)
        if not worst:
            return None
        names = ", ".join(RESPONSES[name].words for name in worst)
        text = f"{self._among(free)} meet{'s' * (len(free) == 1)} the limits, but none is set on {names}"
        values = ", ".join(f"{RESPONSES[name].words} {in_words(response)}" for name, response in worst.items())
        details = f"Without a limit, at most: {values}.", *self._cut_short(list(free))
        return Line(NOT_DECIDED, capital(text), _few(list(free)), details)

    def failing(self, names: Sequence[str]) -> Line | None:
        """Return the line on cases that fail a check, with the nearest to passing if its ratio is finite; None for no case."""
        if not names:
            return None
        near = min((max(self._of([name], FAIL), key=_excess) for name in names), key=_excess)
        details = f"Nearest to passing: {self._place(near)} at {wording.percent(near.ratio)} of its limit."
        text = f"{self._among(names)} fail{'s' * (len(names) == 1)}"
        return Line(
            FAIL,
            capital(text),
            "" if len(names) == len(self.every) else _few(names),
            ((details,) * math.isfinite(_excess(near)) + self._failing_bounds(names)),
        )

    def _place(self, verdict: Verdict) -> str:
        """Return "pads, drift, under stiff ground": case (unless it is the only one), check, and bound of the design, if any."""
        case = self.case_of(verdict) if len(self.every) > 1 else ""
        return ", ".join(filter(None, (case, verdict.check, under(verdict.columns))))

    @property
    def _under_every_bound(self) -> str:
        """Words to follow what passes: " under every bound"; empty without bounds of the design."""
        return " under every bound" if any(under(verdict.columns) for verdict in self._of(self.every)) else ""

    def _failing_bounds(self, names: Sequence[str]) -> tuple[str, ...]:
        """Return "pads fails under soft, stiff only." for each of up to three cases that fail under bounds but not nominally.

        Without the name of a case that is the only one; () for none.
        """
        sentences = []
        for name in names:
            failing = dict.fromkeys(verdict.columns.get(BOUND, "") for verdict in self._of([name], FAIL))
            if "" not in failing:
                place = f"{name} " if len(self.every) > 1 else ""
                sentences.append(f"{place}fails under {abridged([str(bound) for bound in failing], ', ')} only.")
        few = sentences[:MOST_NAMES]
        return (*(capital(words) if len(self.every) == 1 else words for words in few),)

    def undecided(self, names: Sequence[str], failing: Sequence[str]) -> Line | None:
        """Return the line on undecided cases ``names`` with reasons, and undecided checks of ``failing`` ones; None for neither.

        All omissions without an upper bound are reasons, and the first three other checks, with "and 2 more." behind.
        """
        idle = ", ".join(dict.fromkeys(verdict.check for verdict in self._of(failing, NOT_DECIDED)))
        if not names:
            return Line(NOT_DECIDED, "Left undecided", f"{idle}, in cases that fail anyway", ()) if idle else None
        verdicts = self._of(names, NOT_DECIDED)
        details = self._reasons_without_bound(verdicts)
        others = [verdict for verdict in verdicts if not verdict.left_open]
        details += [self._reason_of_verdict(verdict) for verdict in others[:MOST_CHECKS]]
        if len(others) > MOST_CHECKS:
            details.append(f"and {len(others) - MOST_CHECKS} more.")
        if idle:
            details.append(f"{idle}: not decided in cases that fail anyway.")
        return Line(NOT_DECIDED, capital(f"{self._among(names)} cannot be decided"), _few(names), tuple(details))

    def _reasons_without_bound(self, verdicts: Sequence[Verdict]) -> list[str]:
        """Return a sentence for each omission that leaves demands without an upper bound; [] for none."""
        by_cause = grouped((verdict for verdict in verdicts if verdict.left_open), lambda verdict: verdict.left_open)
        sentences = []
        for name, of_cause in by_cause.items():
            cases = list(dict.fromkeys(map(self.case_of, of_cause)))
            place = f" in {_few(cases) or f'{len(cases)} cases'}" if len(by_cause) > 1 else ""
            checks = ", ".join(dict.fromkeys(verdict.check for verdict in of_cause))
            sentences.append(f"{checks}{place}: {OMISSIONS[name].remark}.")
        return sentences

    def _reason_of_verdict(self, verdict: Verdict) -> str:
        """Return why a check is not decided: "drift in pads: between 0.2 and 0.6, limit 0.5 m, left open by Te Mara."

        The case is left out if it is the only one; limit (not of a ban) and run follow the note if bounds straddle the limit.
        """
        case = " ".join(
            filter(None, (f" in {self.case_of(verdict)}" if len(self.every) > 1 else "", under(verdict.columns)))
        )
        case = f" {case.strip()}" if case else ""
        is_open = wording.is_left_open(verdict)
        limit = (
            f"limit {wording.number(verdict.limit)} {verdict.unit}".rstrip() if is_open and not verdict.is_ban else ""
        )
        cause = f"left open by {self.record_of(verdict)}" if is_open and verdict.record else ""
        return ", ".join(filter(None, (f"{verdict.check}{case}: {verdict.note}", limit, cause))) + "."

    def _of(self, names: Sequence[str], *kinds: str) -> list[Verdict]:
        """Return the verdicts of these cases that are of one of ``kinds``, such as "pass"; all if no kind is given."""
        verdicts = (verdict for name in names for verdict in self.verdicts.get(name, ()))
        return [verdict for verdict in verdicts if not kinds or verdict.verdict in kinds]

    def _among(self, cases: Collection[str]) -> str:
        """Return the number of cases among all: "2 of 6 cases", "all 3 cases", "both cases", "the only case"."""
        total = len(self.every)
        if len(cases) == total:
            return {1: "the only case", 2: "both cases"}.get(total, f"all {total} cases")
        return f"{len(cases)} of {total} cases"


def _excess(verdict: Verdict) -> float:
    """Return the ratio of a failing check, above 1: demand over limit, or limit over demand if it asks for a least value.

    Infinite for events that must not occur, and for a ratio of NaN.
    """
    return math.inf if verdict.is_ban or math.isnan(verdict.ratio) else verdict.ratio


def _few(names: Sequence[str]) -> str:
    """Return the names with semicolons between them if there are at most three; "" for more, which the scorecard lists."""
    return "; ".join(names) if len(names) <= MOST_NAMES else ""
