"""Verdicts of two studies side by side: which passes and by how much, in a sentence and check by check."""

import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from rockbatch.checks import Verdict, wording
from rockbatch.checks.scorecard import Cell, Row, scorecard
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS, UNWRITTEN
from rockbatch.common.grouping import grouped
from rockbatch.quantities.design import of_design
from rockbatch.quantities.rows import as_in_peaks
from rockbatch.reporting.differing import other_motions
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, tag
from rockbatch.reporting.pair import SIDES, Pair
from rockbatch.reporting.sections.verdicts import mark, named_designs
from rockbatch.reporting.table import Head, table

MOST_CHECKS = 3
"""Most names of checks that the first line lists."""
DIGITS = 1e-3
"""Difference of demands over limits that is none."""


def headline(pair: Pair) -> str:
    """Return which study passes, by how much, and which fails what: "A passes all, closest 83 % (…); B fails ….".

    If neither has a verdict on a case, it says that neither study has limits. If both have, it says whether their motions or
    checks differ, since the shares then do not compare the piers alone.
    """
    if not any(study.outdated or any(verdict.case for verdict in study.verdicts) for study in pair.studies):
        return "Neither study has limits, so that neither passes or fails."
    states = "; ".join(_state(side, study) for side, study in zip(SIDES, pair.studies, strict=True))
    return f"{states}.{_unlike(*pair.studies)}"


def _unlike(a: Finished, b: Finished) -> str:
    """Return " Their motions and checks are not the same.", or one of both; "" if they are, or if one has no limits."""
    of_cases = [[verdict for verdict in study.verdicts if verdict.case] for study in (a, b)]
    numbers = all(verdict.least != UNWRITTEN for verdicts in of_cases for verdict in verdicts)
    checks = [{_requirement(verdict, numbers=numbers) for verdict in verdicts} for verdicts in of_cases]
    kinds = {"motions": other_motions(a, b), "checks": checks[0] != checks[1]}
    words = " and ".join(kind for kind, differ in kinds.items() if differ)
    return f" Their {words} are not the same." if words and all(checks) else ""


def _requirement(verdict: Verdict, *, numbers: bool) -> tuple[object, ...]:
    """Return what a check asks: its name, demand in words with height and axes, ways of counting records and runs cut short,
    ``numbers`` of records if these are known, sense, limit and capacity.
    """
    demand = verdict.check, verdict.demand, verdict.words, verdict.sense, verdict.limit, verdict.capacity
    of_records = (verdict.least, verdict.per_event) if numbers else ()
    return *demand, verdict.count, verdict.counting, *of_records


def _state(side: str, study: Finished) -> str:
    """Return what a study comes to: "A passes all in 2 of 3 cases, closest 83 % (…), and fails …"; "A has no limits".

    Cases that pass come first, then those that fail, are not decided, are not checked; a suite that fails comes last, and behind
    a pass the number of files that could not be used.
    """
    if not any(verdict.case for verdict in study.verdicts):
        return f"{side} has {'verdicts on another peaks.csv than its own' if study.outdated else 'no limits'}"
    rows = scorecard(study.verdicts, named_designs(study), study.suites, study.worst_at_scales).rows
    kinds = grouped(rows, lambda row: row.verdict)
    parts = []
    for kind, words in _IN_WORDS.items():
        if of_kind := kinds.get(kind):
            share = f" in {len(of_kind)} of {len(rows)} cases" if len(of_kind) < len(rows) else ""
            share = share or {1: "", 2: " in both cases"}.get(len(rows), f" in all {len(rows)} cases")
            parts.append(words(study, of_kind, share, len(rows) > 1))
    suite = any(verdict.verdict == FAIL for verdict in study.verdicts if not verdict.case)
    missing = len(study.info["unusable"]) if PASS in kinds else 0
    files = f", without {missing} file{'s' * (missing > 1)} that could not be used" if missing else ""
    return f"{side} {', and '.join(parts)}{', under a suite that fails its own checks' if suite else ''}{files}"


def _passing(study: Finished, rows: Sequence[Row], share: str, several: bool) -> str:
    """Return that cases pass, with the check that is closest to its limit: "passes all, closest 83 % (uplift, Te Mara)".

    If no check has a share of its limit, as of bans, that is "passes all" and the ``share`` of the cases. Checks that leave
    something out follow by name, or by number if more than three: ", with remarks on uplift, drift".
    """
    name_of, names = named_designs(study), {row.name for row in rows}
    passed = (verdict for verdict in study.verdicts if verdict.case and name_of(verdict) in names)
    noted = [*dict.fromkeys(verdict.check for verdict in passed if verdict.omits)]
    words = ", ".join(noted) if len(noted) <= MOST_CHECKS else f"{len(noted)} checks"
    remarks = f", with remarks on {words}" if noted else ""
    closest = _worst(list(_cells(rows)))
    if closest is None:
        return f"passes all{share}{remarks}"
    row, cell = closest
    words = ", ".join((cell.verdict.check, *_place(study, cell, row.name if several else "")))
    return f"passes all{share}, closest {cell.percent} ({words}){remarks}"


def _failing(study: Finished, rows: Sequence[Row], share: str, several: bool) -> str:
    """Return the failing check with the greatest finite share of its limit, or the first without such a share, and its place.

    "fails anchor at 196 % (Te Mara) and 2 more in 2 of 3 cases": 2 other checks fail; ``share``, " in 2 of 3 cases", says how
    many cases fail. The place begins with the case if ``several``. A share that is not known is left out.
    """
    cells = [(row, cell) for row, cell in _cells(rows) if cell.verdict.verdict == FAIL]
    row, cell = _worst(cells) or cells[0]
    others = len({cell.verdict.check for _, cell in cells}) - 1
    more = f" and {others} more" if others else ""
    at = f" at {cell.percent}" if cell.percent else ""
    place = ", ".join(_place(study, cell, row.name if several else ""))
    return f"fails {cell.verdict.check}{at}{f' ({place})' if place else ''}{more}{share}"


def _undecided(study: Finished, rows: Sequence[Row], share: str, several: bool) -> str:
    """Return that cases are not decided, by which checks, or for lack of limits: "is not decided (drift, no limit on uplift)"."""
    checks = [cell.verdict.check for _, cell in _cells(rows) if cell.verdict.verdict == NOT_DECIDED]
    free = [f"no limit on {words}" for row in rows for words in row.unlimited]
    reasons = ", ".join(dict.fromkeys((*checks, *free)))
    return f"is not decided{share}{f' ({reasons})' if reasons else ''}"


_IN_WORDS = {
    PASS: _passing,
    FAIL: _failing,
    NOT_DECIDED: _undecided,
    DOES_NOT_APPLY: lambda study, rows, share, several: f"is not checked{share}",
}
"""What is said of cases, by the verdict on them, in this order."""


def _cells(rows: Sequence[Row]) -> Iterator[tuple[Row, Cell]]:
    """Yield the cells of rows that are not None, each with its row."""
    for row in rows:
        yield from ((row, cell) for cell in row.cells if cell is not None)


def _worst(cells: Sequence[tuple[Row, Cell]]) -> tuple[Row, Cell] | None:
    """Return the cell with the greatest share of its limit, and its row; None if no share is finite, as of bans alone."""
    known = [pair for pair in cells if math.isfinite(pair[1].verdict.ratio) and pair[1].percent]
    return max(known, key=lambda pair: pair[1].verdict.ratio, default=None)


def _place(study: Finished, cell: Cell, case: str = "") -> list[str]:
    """Return the case, if it is given, the governing station (by name or label, the shorter) and the bound of a cell in words.

    What is empty is left out.
    """
    label = study.label(cell.verdict.record)
    name = study.records.get(cell.verdict.record, {}).get("station_name") or label
    station = min(str(name), label, key=len)
    return [words for words in (case, station, f"under {cell.design_bound}" if cell.design_bound else "") if words]


class Side(NamedTuple):
    """The cells of a design of one study by the names of their checks, with the limit of each, and the design's label.

    The limit of a ban is "".
    """

    label: str
    cells: dict[str, tuple[Cell, str]]


def margins(pair: Pair) -> Markup:
    """Return a table of checks of pairs of designs: demand, share of the limit and record in A and B; empty without checks."""
    sides = [_designs(pair, place) for place in range(2)]
    rows: list[list[object]] = []
    for key in dict.fromkeys((*sides[0], *sides[1])):
        designs = [side.get(key) for side in sides]
        labels = list(dict.fromkeys(design.label for design in designs if design))
        checks = dict.fromkeys(check for design in designs if design for check in design.cells)
        for check in checks:
            cells = [design.cells.get(check) if design else None for design in designs]
            written = [list(_written(study, cell)) for study, cell in zip(pair.studies, cells, strict=True)]
            rows.append([" / ".join(labels), _asked(check, cells), *written[0], *written[1], _change(cells)])
    if not rows:
        return Markup("")
    heads = [Head("case"), Head("check")]
    heads += [Head(words, group=side) for side in SIDES for words in ("demand", "of the limit", "governs")]
    return table([*heads, Head("B − A, of the limit")], rows, prose=True, name="Margins")


def _asked(check: str, cells: Sequence[tuple[Cell, str] | None]) -> str:
    """Return a check with its limit, and that of B if it is another: "uplift ≤ 0.1 m, in B ≤ 0.2 m".

    If the studies do not compare the same with it, what each asks: "drift: in A mean of top_drift_m at most 1 m, in B …".
    """
    if not _is_same(cells):
        asked = [
            f"in {side} {wording.requirement(verdict)}" + (f" over {verdict.count}s" if verdict.count else "")
            for side, verdict in zip(SIDES, _verdicts(cells), strict=True)
        ]
        return f"{check}: {', '.join(asked)}"
    limits = list(dict.fromkeys(limit for _, limit in filter(None, cells)))
    return f"{check} {limits[0]}".rstrip() + (f", in B {limits[1]}" if len(limits) > 1 else "")


def _verdicts(cells: Sequence[tuple[Cell, str] | None]) -> list[Verdict]:
    """Return the verdicts of the cells that are there."""
    return [cell[0].verdict for cell in cells if cell]


def _is_same(cells: Sequence[tuple[Cell, str] | None]) -> bool:
    """Return whether both studies compare the same with the limit: demand, statistic, height, axes, and what a record is."""
    return len({(verdict.words, verdict.count, verdict.demand) for verdict in _verdicts(cells)}) < 2


def _designs(pair: Pair, place: int) -> dict[tuple[object, ...], Side]:
    """Return the designs of a study by case, varied values that both studies have, and scale; units suit both studies' limits."""
    study, of_label = pair.studies[place], named_designs(pair.studies[place])
    by_label = grouped((verdict for verdict in study.verdicts if verdict.case), of_label)
    beside = [*{verdict.check: verdict for verdict in pair.studies[1 - place].verdicts}.values()]
    found: dict[tuple[object, ...], Side] = {}
    for label, verdicts in by_label.items():
        key = _key(pair, place, verdicts[0])
        if key in found:  # only one study varies the value that tells them apart: they have no counterpart
            key = (*key, SIDES[place], label)
        card = scorecard(verdicts, of_label, beside=beside)
        pairs = zip(card.columns, card.rows[0].cells, strict=True)
        cells = [
            (column, cell, "" if cell.verdict.is_ban else column.limit) for column, cell in pairs if cell is not None
        ]
        found[key] = Side(label, {column.check: (cell, limit) for column, cell, limit in cells})
    return found


def _key(pair: Pair, place: int, verdict: Verdict) -> tuple[object, ...]:
    """Return the key that a design has in both studies; a case without a counterpart has "A" or "B" in its key."""
    columns = of_design(verdict.columns)
    values = [as_in_peaks(columns.get(name)) for name in pair.keys if name in columns]
    names = pair.names if place else {name: name for name in pair.names.values()}
    own = () if verdict.case in names else (SIDES[place],)
    return names.get(verdict.case, verdict.case), *values, verdict.scale, *own


def _written(study: Finished, cell: tuple[Cell, str] | None) -> Iterator[object]:
    """Yield three cells of a design: demand, share of the limit with its sign, and governing record; "not checked" for None."""
    if cell is None:
        yield from ("", tag("span", "not checked", class_="muted"), "")
        return
    own, _ = cell
    verdict = own.verdict
    yield own.value
    yield mark(verdict.verdict, own.percent)
    yield tag("span", ", ".join(_place(study, own)), title=study.named(verdict.record))


def _change(cells: Sequence[tuple[Cell, str] | None]) -> str:
    """Return the difference of the shares of the limit, B less A: "+12 %", "0 %" below 0.1 %; empty unless both are known.

    Empty also if the studies do not compare the same with it.
    """
    if not _is_same(cells):
        return ""
    ratios = [cell[0].verdict.ratio if cell and cell[0].percent else math.nan for cell in cells]
    change = ratios[1] - ratios[0]
    if not math.isfinite(change):
        return ""
    return "0 %" if abs(change) < DIGITS else f"{100 * change:+.3g} %".replace("-", "−")
