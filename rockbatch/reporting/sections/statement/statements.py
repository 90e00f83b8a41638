"""Statements for a calculation file: a paragraph on each design, with what was checked, what governs and what is left out.

What a statement says follows from the columns of checks.csv and peaks.csv and from run.json; remarks are quoted, never read.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from rockbatch.checks import Verdict, wording
from rockbatch.checks.answer import without_limits
from rockbatch.checks.coverage import CaseRuns, Stations, joined, stations_of
from rockbatch.checks.remarks import changes_of
from rockbatch.checks.responses import RESPONSES, Worst, in_words, worst_of_all
from rockbatch.checks.scorecard import scorecard
from rockbatch.checks.suite_target import is_recorded
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS
from rockbatch.common.grouping import distinct, grouped
from rockbatch.common.showing import abridged
from rockbatch.quantities.cases import Case, is_across, name_along
from rockbatch.quantities.design import of_design, under
from rockbatch.quantities.labels import in_full
from rockbatch.quantities.rows import with_case
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import counted
from rockbatch.reporting.sections import assumptions
from rockbatch.reporting.sections.statement.check_sentences import (
    VERBS,
    listed,
    quoted,
    remarks,
    sentence,
    worst_by_check,
)
from rockbatch.results.labelled import Item, foundation_key, pier_key

SHORT = 16
"""Characters of a digest that are printed; the calculation sheet has all."""


class Statement(NamedTuple):
    """The statement on a design at one scale of its motions.

    ``name`` is the label of the design and ``case`` the name of its case; ``verdict`` is a word of checks.csv; the first of the
    ``sentences`` says it.
    """

    name: str
    case: str
    verdict: str
    sentences: tuple[str, ...]

    @property
    def text(self) -> str:
        """The sentences in one paragraph."""
        return " ".join(self.sentences)


@dataclass(frozen=True, eq=False)
class _Design:
    """A design at one scale, under all its bounds.

    ``cases`` are its entries in run.json, ``runs`` counts its runs, ``of_suite`` are verdicts on its suite, and ``free`` its
    governing responses without a limit.
    """

    name: str
    cases: Sequence[Case]
    runs: CaseRuns
    verdicts: Sequence[Verdict]
    of_suite: Sequence[Verdict]
    free: Sequence[Worst]
    verdict: str

    @cached_property
    def checks(self) -> list[tuple[Verdict, Sequence[Verdict]]]:
        """The worst verdict of each check, and those under all bounds, the worst check first."""
        return worst_by_check(self.verdicts)

    def having(self, kind: str) -> list[str]:
        """Return the names of the checks whose worst verdict is ``kind``, such as "fail", the worst check first."""
        return [worst.check for worst, _ in self.checks if worst.verdict == kind]

    @property
    def is_bounded(self) -> bool:
        """Whether it was run under bounds."""
        return any(under(case["columns"]) for case in self.cases)

    @property
    def nominal(self) -> list[Case]:
        """Its entries in run.json without a bound: one, or one for each axis of its pier."""
        return [case for case in self.cases if not under(case["columns"])]


def statements(finished: Finished) -> Iterator[Statement]:
    """Yield a statement on each design at each scale, also without checks, in the order of the study; none without runs."""
    stations = stations_of(finished.info)
    for design in _designs(finished, stations):
        sentences = tuple(_sentences(finished, design, stations))
        yield Statement(design.name, design.runs.case, design.verdict, sentences)


def _sentences(finished: Finished, design: _Design, stations: Stations) -> Iterator[str]:
    """Yield the sentences of a statement: result, suite, bounds, checks, remarks, assumptions, what is not covered, identity."""
    yield _result(design, stations, outdated=finished.outdated)
    yield _suite(finished, design)
    yield _conforming(finished.info, design.of_suite)
    yield from _bounds(finished.info, design)
    for worst, same in design.checks:
        if worst.verdict != DOES_NOT_APPLY:
            yield sentence(finished, worst, same)
    if noted := list(remarks(design.verdicts)):
        yield f"Remarks: {'; '.join(noted)}."
    bounded = ", for the nominal design" if design.is_bounded else ""
    yield f"Assumed{bounded}: {' '.join(assumptions.lines(finished, design.nominal))}"
    yield f"Not covered: {'; '.join(_not_covered(design, stations))}."
    yield _identity(finished.info)


def _designs(finished: Finished, stations: Stations) -> Iterator[_Design]:
    """Yield the designs of run.json at each scale, with their verdicts."""
    varied = finished.info["varied"]

    def key_of(name: str, columns: Mapping[str, float | str], scale: float) -> str:
        nominal = of_design(columns)
        return repr((foundation_key(name, nominal, varied), pier_key(nominal, varied), f"{scale:.9g}"))

    def key_of_row(row: Verdict | CaseRuns) -> str:
        return key_of(row.case, row.columns, row.scale)

    runs = grouped(finished.suites, key_of_row)
    verdicts = grouped((verdict for verdict in finished.verdicts if verdict.case), key_of_row)
    cases = grouped(finished.info["cases"], lambda case: key_of(name_along(case), case["columns"], math.nan))
    card = scorecard(finished.verdicts, key_of_row, finished.suites, finished.worst_at_scales)
    kinds = {row.name: row.verdict for row in card.rows}
    free = without_limits(verdicts, finished.worst_at_scales)
    for (key, under_bounds), name in zip(runs.items(), _names(finished, runs), strict=True):
        its = joined(under_bounds)
        yield _Design(
            name,
            cases[key_of(its.case, its.columns, math.nan)],
            its,
            verdicts.get(key, ()),
            [verdict for verdict in finished.verdicts if not verdict.case and math.isclose(verdict.scale, its.scale)],
            free.get(key, ()),
            NOT_DECIDED if kinds[key] == PASS and stations.unusable else kinds[key],
        )


def _names(finished: Finished, designs: Mapping[str, Sequence[CaseRuns]]) -> list[str]:
    """Return the labels of designs, with case and varied values where labels are alike."""
    firsts = [runs[0] for runs in designs.values()]

    def told_apart(place: int, label: str) -> str:
        name = in_full(firsts[place].case, of_design(firsts[place].columns))
        return f"{label} (case {name})"

    labels = [finished.named_design(its.case, its.columns, finished.info["varied"], its.scale) for its in firsts]
    return distinct(labels, told_apart)


def _result(design: _Design, stations: Stations, *, outdated: bool) -> str:
    """Return the first sentence: that the design passes, fails which checks, is not decided and why, or is not checked.

    'Case "pads" fails 1 of 3 checks: "drift"; "uplift" is not decided.'
    """
    subject = f"Case {quoted(design.name)}"
    failing, open_, met = (design.having(kind) for kind in (FAIL, NOT_DECIDED, PASS))
    total = len(design.checks) - len(design.having(DOES_NOT_APPLY))
    if design.verdict == DOES_NOT_APPLY:
        none = "the verdicts are on another peaks.csv than is there now" if outdated else "no limit was set"
        reason = "no check applies to it" if design.checks else none
        return f"{subject} is not checked: {'no run ends standing' if met else reason}."
    if failing:
        also = f"; {listed(open_)} {'is' if len(open_) == 1 else 'are'} not decided" if open_ else ""
        return f"{subject} fails {_share(failing, total)}{also}."
    if open_:
        return f"{subject} is not decided by {_share(open_, total)}."
    every = {1: "its only check", 2: "both checks"}.get(total, f"all {total} checks")
    bound = " under every bound" if design.is_bounded else ""
    if design.verdict == PASS:
        return f"{subject} passes {every}{bound}."
    return f"{subject} meets {every}{bound}, but is not decided: {'; '.join(_reasons(design, stations))}."


def _share(names: Sequence[str], total: int) -> str:
    """Return the names of checks after their number: "2 of 3 checks: "drift", "uplift""; "its only check: …" of one in all."""
    return f"{f'{len(names)} of {total} checks' if total > 1 else 'its only check'}: {listed(names)}"


def _reasons(design: _Design, stations: Stations) -> Iterator[str]:
    """Yield why a design that meets every limit is not decided: responses without a limit, its suite, or unusable records."""
    if design.free:
        words = dict.fromkeys(RESPONSES[its.demand].words for its in design.free)
        yield f"no check limits its {', '.join(words)}"
    if any(verdict.verdict == FAIL for verdict in design.of_suite):
        yield "its suite of motions fails a check of its own"
    if stations.unusable:
        total = f" of {stations.total}" if stations.known else ""
        yield f"records of {len(stations.unusable)}{total} stations could not be used"


def _suite(finished: Finished, design: _Design) -> str:
    """Return the sentence on the motions under which the design was run: their number, factors, directions and verticals."""
    records = finished.info["records"]
    recorded = [record for record in records if is_recorded(record)]
    parts = []
    if recorded:
        stations = {record.get("station") or record["record"] for record in recorded}
        n, plural = len(recorded), "s" * (len(recorded) > 1)
        both = any(is_across(case) for case in design.cases)
        components = f"{n} pair{plural} of horizontal components" if both else f"{n} horizontal component{plural}"
        parts.append(f"{components} of {counted(len(stations), 'station')}{_events(recorded)}")
    if made := len(records) - len(recorded):
        parts.append(counted(made, "analytical motion"))
    factors = sorted(float(record.get("factor") or 1.0) for record in records)
    if factors and (factors[0], factors[-1]) != (1.0, 1.0):
        parts.append(f"multiplied by factors of {factors[0]:.4g} to {factors[-1]:.4g}")
    if design.runs.scale != 1.0:
        parts.append(f"all scaled by {design.runs.scale:g}")
    directions = set(with_case(finished.saved.peaks)["polarity"])
    parts.append("in both directions" if len(directions) > 1 else "reversed" if directions == {"-"} else "")
    vertical = sum(record["pga_v_g"] is not None for record in records)
    some = "" if vertical == len(records) else f" in {vertical} of {len(records)}"
    parts.append(f"with the vertical component{some}" if vertical else "without vertical components")
    return f"It was run under {', '.join(filter(None, parts))}."


def _events(records: Sequence[Item]) -> str:
    """Return the earthquakes of records: " in 2 earthquakes ("Kobe 1995", "Waiau 2016")"; empty if not all are known."""
    events = dict.fromkeys(str(record.get("event") or "") for record in records)
    return "" if "" in events else f" in {counted(len(events), 'earthquake')} ({listed([*events])})"


def _conforming(info: Item, verdicts: Sequence[Verdict]) -> str:
    """Return sentences on the conditions of target spectra: "The suite meets all 3 conditions of …", or which it does not meet.

    Without ``verdicts``, returns the sentence that the suite was only compared with a target, or has none.
    """
    if not verdicts:
        target = info.get("target")
        return (
            f"The suite was compared with {quoted(target['spectrum'])} only."
            if target
            else "The suite has no target spectrum."
        )
    sentences = []
    for name, same in grouped(verdicts, lambda verdict: verdict.check).items():
        sources = f"{quoted(name)} ({listed([verdict.reason for verdict in same])})"
        if unmet := [verdict for verdict in same if verdict.verdict != PASS]:
            words = "; ".join(f"{_condition(verdict)}: {VERBS[verdict.verdict]}" for verdict in unmet)
            sentences.append(f"Of {counted(len(same), 'condition')} of {sources} the suite does not meet: {words}.")
        else:
            number = "the only condition" if len(same) == 1 else f"all {len(same)} conditions"
            sentences.append(f"The suite meets {number} of {sources}.")
    return " ".join(sentences)


def _condition(verdict: Verdict) -> str:
    """Return a condition on the suite with its value and limit: "stations 2, at least 3"."""
    limit = "what is not known" if math.isnan(verdict.limit) else f"{wording.number(verdict.limit)} {verdict.unit}"
    value = f"{wording.number(verdict.value, verdict.limit)} {verdict.unit}".rstrip()
    return f"{verdict.words} {value}, {verdict.sense} {limit}".rstrip()


def _bounds(info: Item, design: _Design) -> Iterator[str]:
    """Yield sentences on the bounds under which the design was run; none without bounds."""
    bounds = info.get("bounds", ()) if design.is_bounded else ()
    if bounds:
        changes = "; ".join(f"{quoted(bound['bound'])}, {changes_of(bound)}" for bound in bounds)
        yield f"It was run with its nominal values and, one at a time, under {counted(len(bounds), 'bound')}: {changes}."
    lacking = [(case, bound) for bound in bounds for case in bound["lacking"] if case["case"] == design.runs.case]
    for keys, pairs in grouped(lacking, lambda pair: ", ".join(pair[0]["keys"])).items():
        names = listed([bound["bound"] for _, bound in pairs])
        yield f"It lacks {keys}, and ran without this change under {names}."


def _not_covered(design: _Design, stations: Stations) -> Iterator[str]:
    """Yield what the statement does not cover: responses, runs, records and checks left out, and texts of codes."""
    for name, free in worst_of_all(design.free).items():
        yield f"{RESPONSES[name].words}, which no check limits, of up to {in_words(free)}".replace("\u00a0", " ")
    if design.runs.ended:
        yield f"what follows where the pier does not end standing: {design.runs.in_words}"
    for kind, files in (("that could not be used", stations.unusable), ("left out by name", stations.left_out)):
        if files:
            yield f"records {kind}: {listed([str(file['name']) for of_station in files.values() for file in of_station])}"
    if stations.not_selected:
        yield f"stations of which no record is selected: {abridged([*map(quoted, stations.not_selected)], ', ')}"
    for worst, _ in design.checks:
        if worst.verdict == DOES_NOT_APPLY:
            yield f"{quoted(worst.check)}, which does not apply: {worst.note}"
    for words in dict.fromkeys(wording.unchecked(verdict) for verdict in design.verdicts if wording.unchecked(verdict)):
        yield f"the text of a code: {words}"
    if any(verdict.basis == "code" for verdict in design.of_suite):
        yield "the text of the clauses on the suite, which are applied as they are commonly cited"
    if design.verdict == DOES_NOT_APPLY:
        yield "every limit of rotation, displacement, settlement and force"
    else:
        yield "whether the limits are right, which are taken as they were given"
        yield "any strength of pier, joints, devices and ground but as these limits state it"


def _identity(info: Item) -> str:
    """Return 'Computed by rockbatch 1.0 on 2026-11-29 from "a.toml" (SHA-256 1f2e…, results 3d4e…).', results if noted."""
    commit = info["versions"].get("commit", "")
    program = f"rockbatch {info['rockbatch']}" + (f" (commit {commit})" if commit else "")
    results = str((info.get("peaks") or {}).get("sha256", ""))[:SHORT]
    digests = f"SHA-256 {info['study']['sha256'][:SHORT]}…" + (f", results {results}…" if results else "")
    return f"Computed by {program} on {str(info['created'])[:10]} from {quoted(info['study']['path'])} ({digests})."
