"""The answer of a design in sentences: the value that just passes, what governs it, and what the scan leaves open."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

from rockbatch.analyses.design.search import REFUSED
from rockbatch.analyses.design.tables import RECORDS, is_known
from rockbatch.checks.verdicts import FAIL, NOT_DECIDED, PASS
from rockbatch.checks.wording import percent
from rockbatch.common.analyses import Entry
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.common.showing import abridged, capital
from rockbatch.reporting.finished_analysis import named
from rockbatch.reporting.labels import counted
from rockbatch.results.labelled import as_dicts

Said = tuple[str, str]
"""A verdict, and the sentence on it."""
MOST_INTERVALS = 5
"""Most intervals that a sentence lists; the table has all."""

_OTHER_END = {"least": "greatest", "greatest": "least"}
_FURTHER = {"least": "below it", "greatest": "above it"}
_STATES = {PASS: "passes", FAIL: "fails", NOT_DECIDED: "is not decided", REFUSED: "is refused"}


def answer(info: Entry, intervals: "pd.DataFrame", values: "pd.DataFrame") -> list[Said]:
    """Return the sentences of the answer, each with its verdict, "" for a remark without one.

    ``info`` is design.json, the tables are design.csv and design_values.csv.
    """
    rows, tried = with_labels(info, intervals), by_design(info, with_labels(info, values))
    said: list[Said] = []
    for label, own in by_design(info, rows).items():
        several = len(info["designs"]) > 1 or info["lacking"]
        of_one = (_of_map if len(info["vary"]) > 1 else _of_line)(info, own, tried[label])
        said += [(verdict, f"{label}: {words}" if several else capital(words)) for verdict, words in of_one]
    return [*said, *_remarks(info, rows)]


def with_labels(info: Entry, table: "pd.DataFrame") -> list[dict[str, Any]]:
    """Return the rows of a table with the labels of records in place of their names."""
    labels = {motion["record"]: motion["label"] for motion in info["under"]}
    return [
        {name: labels.get(cell, cell) if name in RECORDS else cell for name, cell in row.items()}
        for row in as_dicts(table)
    ]


def by_design(info: Entry, rows: Sequence[Entry]) -> dict[str, list[Entry]]:
    """Return the rows of a table by their design, "pads: β = 40", in the order of the study; [] for one without rows."""
    keys = ["case", *info["varied"]]
    by_name = grouped(rows, lambda row: named(info, row, keys))
    names = [
        named(info, {"case": design["case"], **design["columns"]}, list(design["columns"]))
        for design in info["designs"]
    ]
    return {name: by_name.get(name, []) for name in names}


def plain(value: float) -> str:
    """Return a value with ten significant digits, all that a value of a scan has: "1,187.5"."""
    return f"{value:,.10g}"


def governs(row: Entry, end: str = "", short: bool = False) -> str:
    """Return what governs at a value, or at an ``end`` of an interval: "drift under soft ground at 101 %, in LGP000".

    Without a check it is the reason, or empty; the reason also follows if the value is not decided. A ratio of 0 or infinity
    and a scale of 1 are left out, and with ``short`` record and reason, too.
    """
    prefix = f"{end}_" if end else ""
    check, reason = row[f"{prefix}check"], row[f"{prefix}reason"]
    if not is_known(check):
        return str(reason) if is_known(reason) else ""
    ratio, bound, record, scale = (row[f"{prefix}{name}"] for name in ("ratio", "under_bound", "record", "at_scale"))
    words = f"{check} under {bound}" if is_known(bound) else str(check)
    words += f" at {percent(ratio)}".replace("\u00a0", " ") if is_known(ratio) and 0.0 < ratio < math.inf else ""
    words += f", scale {scale:g}" if scale != 1.0 else ""
    if short:
        return words
    words += f", in {record}" if is_known(record) else ""
    return f"{words}: {reason}" if is_known(reason) else words


def _of_line(info: Entry, rows: Sequence[Entry], tried: Sequence[Entry]) -> Iterator[Said]:
    """Yield sentences on the passing values of one key: the least or greatest, the neighbour that does not pass, and gaps.

    If none passes, a single one says so, with the value that is nearest to passing.
    """
    path, find = info["vary"][0]["path"], info["find"]
    passing = [row for row in rows if row["verdict"] == PASS]
    if not passing:
        low, high = (plain(info["vary"][0][end]) for end in ("low", "high"))
        yield (
            _verdict_without_pass(rows),
            f"no value of {path} that was run from {low} to {high} passes every check{_nearest(tried, [path])}.",
        )
        return
    row = passing[0 if find == "least" else -1]
    end, outer, side = ("low", "below", "lower") if find == "least" else ("high", "above", "upper")
    best = next(value for value in tried if value[path] == row[end])
    bounds = " under every bound" if info["bounds"] else ""
    closest = f" (closest to its limit: {governs(best)})" if best["ratio"] > 0.0 else ""
    if not is_known(row[outer]):
        edge = f"That is where the scan ends, and not the {find} value that passes: no value {_FURTHER[find]} was run"
        yield (
            PASS,
            f"with {path} = {plain(row[end])}, the {side} end of the scan, every check passes{bounds}{closest}. {edge}.",
        )
    else:
        beyond = f"At {plain(row[outer])} it {_STATES[row[f'{outer}_verdict']]}: {governs(row, outer)}"
        yield PASS, f"the {find} {path} found that passes every check{bounds} is {plain(row[end])}{closest}. {beyond}."
    if row[f"{outer}_verdict"] == NOT_DECIDED:
        yield _beyond(rows, row, end)
    if len(passing) > 1 or is_known(passing[0]["above" if find == "least" else "below"]):
        listed = [_interval(each) for each in passing[:MOST_INTERVALS]]
        more = f" and {len(passing) - MOST_INTERVALS} more" if len(passing) > MOST_INTERVALS else ""
        yield (
            NOT_DECIDED,
            f"not every value {_FURTHER[_OTHER_END[find]]} passes: {path} passes from {'; from '.join(listed)}{more}.",
        )


def _interval(row: Entry) -> str:
    """Return an interval in words with what governs its ends: "4 to 6 (below: end of the scan; above it fails: drift)".

    An interval of a single value is "4 to 4".
    """
    ends = []
    for end in ("below", "above"):
        state = (
            f" it {_STATES[row[f'{end}_verdict']]}: {governs(row, end, short=True)}"
            if is_known(row[end])
            else ": end of the scan"
        )
        is_open = row[f"{end}_verdict"] == NOT_DECIDED and is_known(row[f"{end}_reason"])
        ends.append(f"{end}{state}, {row[f'{end}_reason']}" if is_open else f"{end}{state}")
    return f"{plain(row['low'])} to {plain(row['high'])} ({'; '.join(ends)})"


def _beyond(rows: Sequence[Entry], row: Entry, end: str) -> Said:
    """Return the sentence on values beyond the ``end`` of an interval that are not decided, and may pass."""
    other = rows[rows.index(row) + (-1 if end == "low" else 1)]
    extreme = f"the {'least' if end == 'low' else 'greatest'} value that passes may be as {end} as {plain(other[end])}"
    return NOT_DECIDED, f"from {plain(other['low'])} to {plain(other['high'])} nothing is decided, so that {extreme}."


def _verdict_without_pass(rows: Sequence[Entry]) -> str:
    """Return the verdict on a key of which no value passes: "not decided" if that is the verdict on any value, else "fail"."""
    return NOT_DECIDED if any(row["verdict"] == NOT_DECIDED for row in rows) else FAIL


def _nearest(tried: Sequence[Entry], paths: Sequence[str]) -> str:
    """Return the value nearest to passing: "; nearest is 4, which fails: drift at 120 %, in LGP000"; empty if all are refused.

    Of two keys it has both values. A value that is not decided is nearer than one that fails, then one with a lower ratio.
    """
    order = {NOT_DECIDED: 0, FAIL: 1}
    candidates = [row for row in tried if row["verdict"] in order]
    if not candidates:
        return ""
    nearest = min(candidates, key=lambda row: (order[row["verdict"]], row["ratio"] if is_known(row["ratio"]) else 0.0))
    values = ", ".join(plain(nearest[path]) for path in paths)
    return f"; nearest is {values}, which {_STATES[nearest['verdict']]}: {governs(nearest)}"


def _of_map(info: Entry, rows: Sequence[Entry], tried: Sequence[Entry]) -> Iterator[Said]:
    """Yield sentences on the passing values of two keys: the least or greatest of the first over all values of the second.

    Then at how many values of the second none passes, if any; a single sentence if no pair passes.
    """
    (path, other), find = (varied["path"] for varied in info["vary"]), info["find"]
    passing, number = [row for row in rows if row["verdict"] == PASS], len({row[other] for row in rows})
    if not passing:
        nearest = _nearest(tried, [path, other])
        yield _verdict_without_pass(rows), f"no pair of values that was run passes every check{nearest}."
        return
    end, outer, best = ("low", "below", min) if find == "least" else ("high", "above", max)
    row = best(passing, key=lambda each: float(each[end]))
    edge = "" if is_known(row[outer]) else ", where its scan ends"
    second = info["vary"][1]
    at = f"{other} = {plain(row[other])}"
    at += ", an end of its scan" if row[other] in (second["low"], second["high"]) else ""
    beyond = (
        f" At {plain(row[outer])} it {_STATES[row[f'{outer}_verdict']]}: {governs(row, outer)}."
        if is_known(row[outer])
        else ""
    )
    every = f"passes every check{' under every bound' if info['bounds'] else ''}"
    yield PASS, f"the {find} {path} found that {every} is {plain(row[end])}{edge}, with {at}.{beyond}"
    share = len({each[other] for each in passing})
    if share < number:
        yield NOT_DECIDED, f"at {number - share} of {number} values of {other} no value of {path} that was run passes."


def _remarks(info: Entry, rows: Sequence[Entry]) -> Iterator[Said]:
    """Yield what the answer leaves open: steps without a run, responses without a limit, single records, runs and demands that
    passes leave out, unusable files, stations of which no record is selected.

    Then, without a verdict, how many values are refused, with the first reason, and which cases lack the keys.
    """
    widest = max((row["widest_step"] for row in rows), default=0.0)
    if widest > info["width"]:
        yield (
            NOT_DECIDED,
            f"The response need not change steadily: between neighbours of one verdict, up to {widest:.4g} apart, nothing was "
            "run, and a narrower interval that passes or fails may lie there. More points narrow it.",
        )
    if len(info["vary"]) > 1:
        other = info["vary"][1]
        yield NOT_DECIDED, f"Between the values of {other['path']}, {other['step']:.4g} apart, nothing was run."
    if info["without_limit"]:
        yield NOT_DECIDED, f"No limit is set on {', '.join(info['without_limit'])}, of designs that pass."
    if info["beyond"]:
        yield NOT_DECIDED, f"Single records are beyond the limit, with values that pass: {', '.join(info['beyond'])}."
    if info["cut_short"]:
        yield (
            NOT_DECIDED,
            f"Not every run ends standing, with {info['cut_short']} of {info['passing']} values that pass.",
        )
    if info["of_one_motion"]:
        yield NOT_DECIDED, "Under one motion only."
    for omitted in info["omitted"]:
        yield NOT_DECIDED, f"{', '.join(omitted['checks'])}: {omitted['remark']}."
    if info["unusable"]:
        files = counted(info["unusable"], "file")
        yield NOT_DECIDED, f"{files} of the suite could not be used: what passes does so without these."
    if info["not_selected"]:
        yield NOT_DECIDED, f"Not selected: {abridged(info['not_selected'], ', ')}."
    if info["refused"]:
        first, more = info["refused"][0], len(info["refused"])
        values = zip(info["vary"], first["values"], strict=True)
        at = ", ".join(f"{varied['path']} = {plain(value)}" for varied, value in values)
        yield "", f"At {more} of {info['tried']} values the study is refused; at {at}: {first['reason']}."
    if info["lacking"]:
        keys = " and ".join(varied["path"] for varied in info["vary"])
        yield "", f"Left out, without {keys}: {', '.join(info['lacking'])}."
