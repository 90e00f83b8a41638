"""Trials: designs with values of the varied keys, run under every motion and bound, and judged by every check."""

import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

from rockbatch.analyses.design.search import REFUSED, WORSE
from rockbatch.analyses.design.study import DesignSpec, rounded
from rockbatch.analyses.design.written import with_value
from rockbatch.batch.plan import Plan
from rockbatch.batch.waves import Waves
from rockbatch.checks.coverage import CaseRuns, runs_of_cases
from rockbatch.checks.judging import judge
from rockbatch.checks.responses import RESPONSES, Worst, unlimited, worst_of_cases
from rockbatch.checks.suite import Suite
from rockbatch.checks.verdicts import DOES_NOT_APPLY, NOT_DECIDED, PASS, Verdict
from rockbatch.checks.wording import are_of_one_motion, is_passed_by_statistic
from rockbatch.common.errors import InputError
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.common.naming import chosen_by
from rockbatch.motions import MotionSet
from rockbatch.quantities.demands import INTERACTION, OF_INTERACTION, OF_SECTIONS, SECTIONS
from rockbatch.quantities.design import of_design
from rockbatch.results.run_json import describe_case
from rockbatch.study import Case, Study
from rockbatch.study.bound_keys import key_at
from rockbatch.study.design_bounds import Change

OnSuite = Callable[[Sequence[Case]], Sequence[Verdict]]
Columns = tuple[tuple[str, float | str], ...]


class Design(NamedTuple):
    """A design to vary: the name of its case, and the values of the other keys that are lists."""

    case: str
    columns: Columns


class Trial(NamedTuple):
    """A design with values of the varied keys, in the order of the study."""

    design: Design
    values: tuple[float, ...]


class Judged(NamedTuple):
    """The verdict on a trial, the check that governs it, and the reason why it is refused or not decided.

    A trial that fails is governed by the check that fails most, one that is not decided by the check nearest to failing or
    beyond, and one that passes by the check closest to its limit.
    """

    verdict: str
    governing: Verdict | None
    reason: str = ""


class Written:
    """The cases of a study in whose file the varied keys have other values."""

    def __init__(self, study: Study, spec: DesignSpec) -> None:
        self.study, self.spec = study, spec
        self.tables: dict[str, Any] = tomllib.loads(study.text)
        self._cases: dict[tuple[str, tuple[float, ...]], dict[Design, list[Case]] | str] = {}

    @cached_property
    def varied(self) -> tuple[str, ...]:
        """Return the keys that are lists, without those that are varied here."""
        changes = [Change(path, key) for path in self.spec.paths if (key := key_at(path)) is not None]
        replaced = {name for change in changes for name in change.among(self.study.varied)}
        return tuple(name for name in self.study.varied if name not in replaced)

    @cached_property
    def designs(self) -> list[Design]:
        """Return the designs of the cases that have the varied keys, each once, also with cases along and across the axis."""
        return list(
            dict.fromkeys(self._design(case) for case in self.study.cases if case.name_along in self.spec.cases)
        )

    def _design(self, case: Case) -> Design:
        columns = of_design({name: case.columns[name] for name in self.varied if name in case.columns})
        return Design(case.name_along, tuple(columns.items()))

    def refusal(self, trial: Trial) -> str:
        """Return why the study is refused with the values of a trial; empty if it is not."""
        cases = self._of(trial)
        return cases if isinstance(cases, str) else ""

    def cases(self, trial: Trial) -> list[Case]:
        """Return the cases of a trial, nominal and under each bound, on every axis, with its values as columns; [] if refused."""
        cases = self._of(trial)
        return [] if isinstance(cases, str) else cases[trial.design]

    def _of(self, trial: Trial) -> dict[Design, list[Case]] | str:
        key = trial.design.case, trial.values
        if key not in self._cases:
            self._cases[key] = self._read(*key)
        return self._cases[key]

    def _read(self, case: str, values: tuple[float, ...]) -> dict[Design, list[Case]] | str:
        tables: Mapping[str, Any] = {name: table for name, table in self.tables.items() if name != "reference"}
        for path, value in zip(self.spec.paths, values, strict=True):
            tables = with_value(tables, path, case, value) or tables
        try:
            study = Study.from_dict(tables, self.study.path, motions=self.study.motions.override)
        except InputError as error:
            return str(replace(error.problems[0], place=""))
        columns: dict[str, float | str] = dict(zip(self.spec.paths, values, strict=True))
        own = [each for each in study.cases if each.name_along == case]
        by_design = grouped(own, self._design)
        names = (*self.varied, *self.spec.paths)
        return {
            design: [replace(each, columns=each.columns | columns).with_columns(names) for each in cases]
            for design, cases in by_design.items()
        }


class Trials:
    """All trials, each run and judged once, with the ``verdicts`` of every check.

    Of the trials that pass, ``free`` has the responses without a limit, ``omitted`` the checks whose demands leave something
    out, by the names of :data:`rockbatch.checks.omissions.OMISSIONS`, ``beyond`` the checks that a single record exceeds, and
    ``cut_short`` the number of trials with runs that do not end standing; ``of_one_motion`` is True if any counts a single
    record. ``of_motions`` describes the motions. ``suite`` returns the verdicts on the suite with the cases of a trial: if one
    of them fails, the trial is not decided.
    """

    def __init__(self, written: Written, motions: MotionSet, waves: Waves, of_motions: Suite, suite: OnSuite) -> None:
        self.written, self.motions, self.waves = written, motions, waves
        self.of_motions, self.suite = of_motions, suite
        self.judged: dict[Trial, Judged] = {}
        self.verdicts: list[Verdict] = []
        self.free: dict[str, None] = {}
        self.omitted: dict[str, dict[str, None]] = {}
        self.beyond: dict[str, None] = {}
        self.cut_short = 0
        self.of_one_motion = False

    def execute(self, requested: Iterable[Trial]) -> None:
        """Run and judge those trials that are not judged yet; one with which the study is refused is REFUSED without a run."""
        trials = [trial for trial in dict.fromkeys(requested) if trial not in self.judged]
        for trial in trials:
            if reason := self.written.refusal(trial):
                self.judged[trial] = Judged(REFUSED, None, reason)
        trials = [trial for trial in trials if trial not in self.judged]
        if not trials:
            return
        peaks = self.waves(self.plan(trials))
        for name, of_name in grouped(trials, lambda trial: trial.design.case).items():
            self._judge(name, {trial: self.written.cases(trial) for trial in of_name}, peaks)

    def plan(self, trials: Iterable[Trial]) -> Plan:
        """Return the runs of trials; of one with which the study is refused there are none."""
        cases = tuple(case for trial in trials for case in self.written.cases(trial))
        return Plan(replace(self.waves.study, cases=cases), self.motions)

    def _judge(self, name: str, cases: Mapping[Trial, Sequence[Case]], peaks: "pd.DataFrame") -> None:
        """Judge the trials of a case by the checks that are about it, and :meth:`_note` what those that pass leave out."""
        study = self.waves.study
        described = [describe_case(case) for of_trial in cases.values() for case in of_trial]
        names = frozenset(case.name_along for case in self.written.study.cases)
        about = (rule for rule in study.checks if not rule.case or name in chosen_by(tuple(rule.case), names))
        rules = [replace(rule, case=()) for rule in about]
        runs = peaks[peaks["case"].isin({str(case["case"]) for case in described})]
        verdicts = judge(
            rules,
            runs,
            described,
            self.of_motions,
            study.count,
            self._beside(SECTIONS, OF_SECTIONS),
            interaction=self._beside(INTERACTION, OF_INTERACTION),
        )
        self.verdicts += verdicts
        of_values = grouped(verdicts, lambda verdict: _values(verdict.columns, self.written.spec))
        worst = grouped(worst_of_cases(runs, described), lambda each: _values(each.case["columns"], self.written.spec))
        counted = runs_of_cases(runs, described, len(self.motions.motions))
        suites = grouped(counted, lambda each: _values(each.columns, self.written.spec))
        for trial in cases:
            key = trial.values, trial.design.columns
            own = of_values.get(key, [])
            of_suite = (verdict for verdict in self.suite(cases[trial]) if verdict.verdict != PASS)
            self.judged[trial] = judged = _judged(
                [*own, *(replace(verdict, verdict=NOT_DECIDED) for verdict in of_suite)]
            )
            if judged.verdict == PASS:
                self._note(own, worst.get(key, []), suites.get(key, []))

    def _note(self, verdicts: Sequence[Verdict], worst: Sequence[Worst], suites: Sequence[CaseRuns]) -> None:
        """Note what a trial that passes leaves out, by its verdicts, worst responses and runs."""
        self.free |= dict.fromkeys(RESPONSES[each.demand].words for each in unlimited(worst, verdicts))
        self.beyond |= dict.fromkeys(verdict.check for verdict in verdicts if is_passed_by_statistic(verdict))
        self.cut_short += any(runs.ended for runs in suites)
        self.of_one_motion |= are_of_one_motion(verdicts)
        for verdict in verdicts:
            for name in verdict.omits:
                self.omitted.setdefault(name, {})[verdict.check] = None

    def _beside(self, name: str, numbers: Iterable[str]) -> "pd.DataFrame | None":
        """Return a table beside the runs, its ``numbers`` with the digits that they have in its file; None without it."""
        rows = self.waves.tables.get(name)
        if rows is None:
            return None
        table, columns = pd.DataFrame(rows), list(numbers)
        table[columns] = table[columns].astype("float64").map(rounded)
        return table


def _values(columns: Mapping[str, Any], spec: DesignSpec) -> tuple[tuple[float, ...], Columns]:
    """Return the values of the varied keys in the columns of a case, and its other columns as pairs, without the bound."""
    others = {name: value for name, value in of_design(columns).items() if name not in spec.paths}
    return tuple(float(columns[path]) for path in spec.paths), tuple(others.items())


def _judged(verdicts: Sequence[Verdict]) -> Judged:
    """Return the worst verdict of all checks on a trial, governed by the check with the greatest ratio among those that have it.

    A ratio of NaN is the least. If no check applies the trial is not decided, and no check governs.
    """
    applying = [verdict for verdict in verdicts if verdict.verdict != DOES_NOT_APPLY]
    if not applying:
        return Judged(NOT_DECIDED, None, "no check applies")
    worst = max((verdict.verdict for verdict in applying), key=WORSE.index)
    of_worst = [verdict for verdict in applying if verdict.verdict == worst]
    governing = max(of_worst, key=lambda verdict: -1.0 if verdict.ratio != verdict.ratio else verdict.ratio)
    return Judged(worst, governing, governing.why_open)


def worse(first: Judged, second: Judged) -> Judged:
    """Return the one with the worse verdict, the first if both have the same."""
    return max(first, second, key=lambda judged: WORSE.index(judged.verdict))
