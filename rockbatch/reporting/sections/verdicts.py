"""Verdicts: the answer in sentences, the scorecard, and every verdict with its numbers."""

import math
from collections.abc import Callable, Sequence

from rockbatch.checks import Verdict, wording
from rockbatch.checks.answer import Line
from rockbatch.checks.answer import answer as answered
from rockbatch.checks.coverage import CaseRuns, stations_of
from rockbatch.checks.remarks import bounds_in_words
from rockbatch.checks.scorecard import MOST_CASES, OPEN_CASES, Cell, Column, Row
from rockbatch.checks.scorecard import Scorecard as Card
from rockbatch.checks.scorecard import scorecard as of_verdicts
from rockbatch.checks.verdicts import CHECKS, DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS
from rockbatch.common.grouping import grouped
from rockbatch.common.showing import capital
from rockbatch.quantities.design import under
from rockbatch.quantities.rows import PEAKS
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, join, number, tag
from rockbatch.reporting.table import MOST_ROWS, Head, for_paper, table

BASIS = {"code": "code clause", "literature": "literature", "judgement": "engineering judgement"}
SAID = {PASS: "passes:", FAIL: "fails:", NOT_DECIDED: "not decided:", DOES_NOT_APPLY: "does not apply"}
MOST_COLUMNS = 7
"""Most columns of the scorecard, unless more checks fail or are undecided."""
COLUMNS_ABREAST = 6
"""Columns of the scorecard that fit side by side on paper."""
MOST_DRAWN = 200
"""Most cases that a reader can unfold in the scorecard."""
CLASSES = {PASS: "pass", FAIL: "fail", NOT_DECIDED: "undecided", DOES_NOT_APPLY: "muted"}


def section(finished: Finished) -> Markup:
    """Return the checks' requirements and, folded, every verdict with its numbers; empty without checks."""
    verdicts = finished.verdicts
    if not verdicts:
        return Markup("")
    rest = [verdict for verdict in verdicts if verdict.verdict not in (FAIL, NOT_DECIDED)]
    every = _every(finished, [*wording.worst_first(verdicts), *rest], wording.Notes(verdicts))
    words = "Every verdict with its numbers" if len(verdicts) <= MOST_ROWS else "Verdicts with their numbers"
    summary = tag("summary", f"{words}, the worst first ({len(verdicts):,})")
    return join(_requirements(verdicts), tag("details", summary, every))


def mark(verdict: str, words: str) -> Markup:
    """Return ``words`` after a verdict's sign, in its colour; screen readers read the sign's name."""
    sign = tag("span", wording.SIGNS[verdict], role="img", aria_label=SAID[verdict])
    return tag("span", sign, f"\u00a0{words}" if words else "", class_=CLASSES[verdict])


def answer(finished: Finished) -> Markup:
    """Return lines on cases that pass, fail, are not decided or not checked, and on stations; without checks, how to add some.

    Of outdated verdicts it says that they are on another peaks.csv, and how to check again.
    """
    lines = answered(
        finished.verdicts,
        finished.worst_at_scales,
        named_designs(finished),
        lambda row: finished.label(row.record),
        finished.suites,
        stations_of(finished.info),
    )
    listed = tag("ul", *map(_line, lines), class_="answer") if lines else ""
    if any(verdict.case for verdict in finished.verdicts):
        return join(listed)
    command = tag("code", "rockbatch check DIR --rules FILE")
    if finished.outdated:
        words = (
            f"The verdicts of {CHECKS} are on another {PEAKS} than is there now, and are not shown. Check it again: "
        )
        again = tag("code", "rockbatch check DIR"), ", or if the study has no checks ", command, "."
        return join(listed, words, *again)
    return join(listed, "No limits were set, so nothing was checked. Add some: ", command, ".")


def _line(line: Line) -> Markup:
    cases = f": {line.cases}." if line.cases else "."
    details = join(*(tag("span", " ", words, class_="detail") for words in line.details))
    return tag("li", tag("strong", mark(line.verdict, line.text)), cases, details)


def named_designs(finished: Finished, *, bounds: bool = False) -> Callable[[Verdict | CaseRuns], str]:
    """Return a function that names the case of a row, with its bound only if ``bounds``; a row without a case is the suite."""
    named = finished.named_runs if bounds else finished.named_design
    return lambda row: named(row.case, row.columns, finished.info["varied"], row.scale) if row.case else wording.SUITE


def under_each_bound(finished: Finished) -> Markup:
    """Return the scorecard with a row for each bound of each design, and what the bounds change; empty without bounds."""
    words = [f"{sentence} " for sentence in bounds_in_words(finished.info)]
    if not words:
        return Markup("")
    drawn = scorecard(finished, bounds=True) if any(verdict.case for verdict in finished.verdicts) else ""
    return join(drawn, tag("p", *words, class_="legend"))


def scorecard(finished: Finished, *, bounds: bool = False) -> Markup:
    """Return a table of demand, share of the limit and a bar (full at twice the limit), by case and check.

    A design has one row, with the worst of its bounds in each cell, or with ``bounds`` one for each of them, in
    their order. Up to :data:`MOST_DRAWN` cases are drawn, the best, or the first with ``bounds``; the others are counted.
    """
    card = of_verdicts(
        finished.verdicts, named_designs(finished, bounds=bounds), finished.suites, finished.worst_at_scales
    )
    if bounds:  # a design with its bounds, which all are listed
        order = list(dict.fromkeys(map(named_designs(finished, bounds=True), finished.verdicts)))
        card.rows.sort(key=lambda row: order.index(row.name) if row.name in order else len(order))
    best, chosen = card.rows[:MOST_DRAWN], "first" if bounds else "best"
    if for_paper():
        places = range(len(card.columns))
        parts = [places[i : i + COLUMNS_ABREAST] for i in places[::COLUMNS_ABREAST]]
        tables = [_card(finished, card, part, best, len(best), named=not bounds, of_all=False) for part in parts]
        left_out = f"The {chosen} {len(best)} of {len(card.rows):,} cases are shown; all are in {CHECKS}."
        return join(*tables, tag("p", left_out, class_="legend") if len(best) < len(card.rows) else "")
    shown = MOST_CASES if len(card.rows) <= MOST_CASES else OPEN_CASES
    shown = MOST_DRAWN if bounds else shown
    drawn = _card(finished, card, card.open_columns(MOST_COLUMNS), best, shown, named=not bounds)
    if shown >= len(card.rows):
        return drawn
    arranged = "in the order of the study" if bounds else "the best first"
    words, button = f"{shown} of {len(card.rows):,} cases, {arranged}.", f"All {len(card.rows)} cases"
    if len(best) < len(card.rows):
        words, button = f"{words} All are in {CHECKS}.", f"The {chosen} {len(best)} cases"
    return join(drawn, tag("p", words, class_="legend rest", data_button=button))


def _card(
    finished: Finished,
    card: Card,
    columns: Sequence[int],
    cases: Sequence[Row],
    shown: int,
    *,
    named: bool,
    of_all: bool = True,
) -> Markup:
    """Return the scorecard of some columns, cells with their bound if ``named``; cases behind the first ``shown`` are folded.

    With ``of_all`` a last column counts the passes of checks that have none.
    """
    asked = wording.requirements(finished.verdicts)
    heads = []
    for column in (card.columns[i] for i in columns):
        small = tag("small", ", ".join(filter(None, (column.at, column.limit))))
        heads.append(tag("th", column.check, small, scope="col", title="; ".join(asked[column.check])))
    others = [i for i in range(len(card.columns)) if i not in columns] if of_all else []
    more = [tag("th", scope="col")] if others else []
    rows = [
        _row(finished, card, row, (columns, others), "folded" if place >= shown else None, named=named)
        for place, row in enumerate(cases)
    ]
    head = tag("thead", tag("tr", tag("th", "Case", scope="col"), *heads, *more))
    return tag("div", tag("table", head, tag("tbody", *rows), class_="card"), class_="wide")


def statistics_in_words(finished: Finished) -> str:
    """Return "Median over stations (drift, uplift). The mark on a bar is the limit.", by statistic; empty if no check has one."""
    with_statistic = (v for v in finished.verdicts if v.case and not v.is_ban and v.statistic)
    checks_of: dict[str, dict[str, None]] = {}
    for verdict in with_statistic:
        checks_of.setdefault(verdict.statistic, {})[verdict.check] = None
    over = wording.records_of(finished.verdicts)
    values = "; ".join(
        f"{STATISTICS[name].words} over {over} ({', '.join(checks)})" for name, checks in checks_of.items()
    )
    return f"{capital(values)}. The mark on a bar is the limit." if values else ""


def _row(
    finished: Finished,
    card: Card,
    row: Row,
    columns: tuple[Sequence[int], Sequence[int]],
    class_: str | None,
    *,
    named: bool,
) -> Markup:
    """Return the row of a case, its cells with their bounds if ``named``; checks of the second ``columns`` are counted as
    "3 more" if passed.
    """
    shown, others = columns
    cells = [_cell(finished, card.columns[i], row.cells[i], named=named) for i in shown]
    if others:
        passing = sum(cell is not None and cell.verdict.verdict == PASS for cell in (row.cells[i] for i in others))
        cells.append(tag("td", mark(PASS, f"{passing} more") if passing else "", class_="others"))
    return tag("tr", tag("th", row.name, tag("small", row.in_words), scope="row"), *cells, class_=class_)


def _cell(finished: Finished, column: Column, cell: Cell | None, *, named: bool) -> Markup:
    """Return a cell: value, sign, share of the limit, bar, the bound of the design if ``named``, the governing run and, on paper,
    bounds of the demand that differ. It is "–" for None and for a check that does not apply.
    """
    check = " ".join(filter(None, (column.check, column.at, column.limit)))
    if cell is None or cell.verdict.verdict == DOES_NOT_APPLY:
        return tag("td", tag("span", "–", aria_label="does not apply"), class_="na", data_check=check)
    verdict = cell.verdict
    share = min(max(verdict.ratio, 0.0), 2.0) / 2.0 if verdict.ratio == verdict.ratio and not verdict.is_ban else None
    bar = tag("span", class_="bar", style=f"--share:{100 * share:.0f}%") if share is not None else ""
    bounds = tag("small", cell.bounds, class_="bounds") if cell.bounds and for_paper() else ""
    record = tag("small", _governs(finished, verdict), class_="governs") if verdict.record else ""
    bound = tag("small", cell.design_bound, class_="bound") if named and cell.design_bound else ""
    return tag(
        "td",
        tag("span", tag("strong", cell.value), mark(verdict.verdict, cell.percent), class_="top"),
        bar,
        bounds,
        bound,
        record,
        class_=CLASSES[verdict.verdict],
        title=_tooltip(finished, verdict),
        data_check=check,
    )


def _governs(finished: Finished, verdict: Verdict) -> str:
    """Return the record that governs, with polarity and scale if the study has several: "Kobe, Takatori, 0° (+) × 2"."""
    polarity = f"({verdict.polarity})" if finished.both_directions else ""
    scale = f"× {verdict.scale:g}" if finished.many_scales else ""
    return " ".join(filter(None, (finished.label(verdict.record), polarity, scale)))


def _tooltip(finished: Finished, verdict: Verdict) -> str:
    """Return what a cell says on hovering, a line each, without those that are empty.

    They are requirement, demand against limit, bound on an input, bounds of the demand, governing record, number of runs
    that ended early, and remarks.
    """
    between = f"between {_between(verdict)}" if _between(verdict) else ""
    record = f"{finished.label(verdict.record)} ({verdict.polarity})" if verdict.record else ""
    against = "" if verdict.is_ban or math.isnan(verdict.value) else wording.against(verdict)
    parts = (
        wording.requirement(verdict),
        against,
        under(verdict.columns),
        between,
        record,
        verdict.counted,
        verdict.note,
    )
    return "\n".join(filter(None, parts))


def _requirements(verdicts: Sequence[Verdict]) -> Markup:
    """Return a table of each check's requirement, its source and reason, and notes on counting and on codes' texts."""
    asked = wording.requirements(verdicts)
    firsts = {name: of_check[0] for name, of_check in grouped(verdicts, wording.name_of).items()}
    rows = [[name, "; ".join(asked[name]), BASIS.get(row.basis, row.basis), row.reason] for name, row in firsts.items()]
    rests = {row.statistic: wording.unchecked(row) for row in firsts.values()}
    heads = map(Head, ("check", "requirement", "limit from", "reason"))
    sentences = (f"{name}: {words}." for name, words in rests.items() if words)
    drawn = table([*heads], rows, prose=True, name="Requirements")
    notes = [*wording.Notes(verdicts).common(), *wording.counting(verdicts), *sentences]
    return join(drawn, tag("ul", *(tag("li", note) for note in notes), class_="legend") if notes else "")


def _every(finished: Finished, verdicts: Sequence[Verdict], notes: wording.Notes) -> Markup:
    """Return a table with a row for each of the first :data:`MOST_ROWS` verdicts: its numbers, governing run and remarks."""
    bounds = "bounds due to errors, the other spring law and runs without an outcome"
    heads = [
        Head("check"),
        Head("case", key=True),
        Head("verdict"),
        Head("demand"),
        Head("between", note=bounds),
        Head("limit"),
        Head("margin", note="distance to the limit; negative beyond it"),
        Head("unit"),
        Head(wording.records_of(verdicts), note="number counted"),
        Head("governing run", note="station, component, polarity and demand of that run; for a mean, of the largest"),
        Head("note"),
    ]
    case_of = named_designs(finished, bounds=True)
    rows: list[list[object]] = []
    for row in verdicts[:MOST_ROWS]:
        limit = "" if math.isnan(row.value) else wording.limit(row)
        numbers = wording.demanded(row), _between(row), limit, wording.margin(row), row.unit, row.records or None
        remarks = "; ".join(filter(None, (row.counted, notes.about(row))))
        verdict, governing = mark(row.verdict, row.verdict), wording.governing(row, finished.label(row.record))
        rows.append(
            [
                wording.name_of(row),
                case_of(row),
                verdict,
                *numbers,
                governing,
                remarks,
            ]
        )
    return table(heads, rows, sortable=True, prose=True, name="Verdicts", worst_of=len(verdicts))


def _between(verdict: Verdict) -> str:
    """Return the bounds of a demand, "0.1 – 0.2"; empty if equal, or for a check that bans something."""
    ends = (0.0 if wording.is_nothing(end, verdict.limit) else end for end in (verdict.low, verdict.high))
    low, high = ("∞" if math.isinf(end) else number(end) for end in ends)
    return f"{low} – {high}" if low != high and not verdict.is_ban else ""
