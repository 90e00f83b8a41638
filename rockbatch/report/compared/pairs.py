"""Every pair of runs in numbers, the worst first."""

import math

from rockbatch.report.document import Section
from rockbatch.report.finished import as_dicts, worst_first
from rockbatch.report.labels import head, symbol
from rockbatch.report.markup import join
from rockbatch.report.pair import SIDES, Pair
from rockbatch.report.sections.peaks import on_scale, outcome
from rockbatch.report.table import MOST_ROWS, THETA, THETA_FORMAT, Head, table, told_apart
from rockbatch.results.columns import COLUMNS


def section(pair: Pair) -> Section | None:
    """Return a row for each pair of runs."""
    a, b = pair.matched.runs
    if a.empty:
        return None
    worse = a["theta_max_over_alpha"].fillna(0).to_numpy() < b["theta_max_over_alpha"].fillna(0).to_numpy()
    worst = a.assign(theta_max_over_alpha=a["theta_max_over_alpha"].where(~worse, b["theta_max_over_alpha"].to_numpy()))
    worst["status"] = [max(both, key=_badness) for both in zip(a["status"], b["status"], strict=True)]
    order = a.index.get_indexer(worst_first(worst, MOST_ROWS).index)
    names = [key for key in pair.matched.keys if key in ("record", "case") or a[key].nunique() > 1]
    heads = [Head(symbol(name)) for name in names]
    heads += [
        Head("A", THETA_FORMAT, over=THETA),
        Head("B", THETA_FORMAT, over=THETA),
        Head("B / A", ".3f", over=THETA),
    ]
    more = [
        column
        for column in COLUMNS.values()
        if column.suite and column.name != "theta_max_over_alpha" and column.name in a and column.name in b
    ]
    heads += [Head(side, over=head(column).says, form=head(column).form) for column in more for side in SIDES]
    pairs = as_dicts(a.iloc[order]), as_dicts(b.iloc[order])
    rows = []
    for place in range(len(order)):
        both = pairs[0][place], pairs[1][place]
        shown = [outcome(run) for run in both]
        ratio = _ratio(*(run["theta_max_over_alpha"] if run["status"] == "ok" else math.nan for run in both))
        others = (on_scale(column.name, run[column.name]) for column in more for run in both)
        rows.append([*(both[0][name] for name in names), *shown, ratio, *others])
    shown_of = told_apart(len(order), len(a), "worst")
    content = join(shown_of, table(heads, rows, sortable=True, name="Pairs of runs"))
    return Section("Every pair of runs", "peaks", content)


def _badness(status: str) -> int:
    return ("ok", "failed", "flight", "overturned").index(status)


def _ratio(a: float, b: float) -> float | None:
    return b / a if a > 0 and b == b else None
