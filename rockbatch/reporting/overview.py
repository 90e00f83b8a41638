"""All peaks in a picture of a few rows, by record or by foundation, for any number of runs."""

from collections.abc import Callable, Sequence
from typing import Any

from rockbatch.checks import wording
from rockbatch.checks.responses import PEAKS
from rockbatch.common.lazy import pd
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.reporting import dots
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, figure, join, tag
from rockbatch.reporting.table import THETA
from rockbatch.results.figures import said_of
from rockbatch.results.labelled import ceiling

MOST_ROWS = 14
"""Rows that fit on the first screen."""
MOST_COLUMNS = 3
MOST_NAMED = 12
"""Most foundations that each have a mark of their own."""
MOST_FOUNDATIONS = 300
SHOWN = ["record", "series", "polarity", "status", "theta_max_over_alpha", "theta_max_error"]
"""Columns that the dots and their words are made of."""
CAPTION = join("Largest rotation over slenderness, ", THETA, ", a row for each ")
MOST_STRETCH = 2.0
"""Largest factor on the axis, so that a limit far above all peaks does not crowd them at one end."""


def by_record(finished: Finished) -> Markup:
    """Draw a row for each record with the worst runs, and one for all others; with the limits of checks."""
    runs = finished.runs
    if runs.empty:
        return Markup("")
    columns = _columns(finished)
    names = worst_first(runs, "record")
    single = names if len(names) <= MOST_ROWS else names[: MOST_ROWS - 1]

    def label(name: str) -> tuple[str, str, str]:
        words, comma, end = finished.label(name).rpartition(", ")  # the direction always stays
        return (words, comma + end, finished.named(name)) if words else (end, "", finished.named(name))

    def description(run: dict[str, Any]) -> str:
        words = said_of(finished.series[run["series"]], run, finished.both_directions)
        return f"{finished.label(run['record'])}\n{words}"

    rows = _rows(columns, "record", single, label, len(names))
    marks = dots.Marks(finished.series if len(finished.series) <= MOST_NAMED else None, description, "foundation")
    caption = join(CAPTION, "record, the worst first", _all(finished))
    limits = [_limits(finished, column) for _, column in columns]
    top = ceiling(runs)
    within = [limit.theta for column in limits for limit in column if limit.theta < MOST_STRETCH * top]
    top = max([top, *(1.03 * theta for theta in within)])
    return figure(dots.draw(rows, [words for words, _ in columns], top, marks, limits), caption)


def _limits(finished: Finished, runs: "pd.DataFrame") -> list[dots.Limit]:
    """Return the limits of rotation checks as θ/α; empty if the piers of a column differ, since each has its own."""
    if runs["pier"].nunique() != 1:
        return []
    cases = [finished.cases[places] for places in set(zip(runs["series"], runs["pier"], strict=True))]
    names = {str(case["case"]) for case in cases}
    scales = set(runs["scale"])
    cases_of: dict[dots.Limit, set[str]] = {}
    for verdict in finished.verdicts:
        most = DEMANDS[verdict.demand].ceiling if verdict.demand in PEAKS else None
        if most is None or verdict.case not in names or verdict.scale not in scales or verdict.statistic == "count":
            continue
        words = f"limit of {verdict.check}, {wording.number(verdict.limit)} {verdict.unit}".rstrip()
        if verdict.statistic != "max":  # a mean, say, that single records may exceed
            words += f" ({STATISTICS[verdict.statistic].words})"
        cases_of.setdefault(dots.Limit(words, verdict.limit / most.value(cases[0])), set()).add(verdict.case)
    return [
        limit if of_limit == names else limit._replace(words=f"{limit.words} ({', '.join(sorted(of_limit))})")
        for limit, of_limit in sorted(cases_of.items(), key=lambda item: item[0].theta)
    ]


def by_foundation(finished: Finished) -> Markup:
    """Draw a row for each of the best foundations and one for the others; below, folded, a row for every one."""
    runs, columns = finished.runs, _columns(finished)
    best = worst_first(runs, "series")[::-1]
    top, words = ceiling(runs), [words for words, _ in columns]
    every = sorted(best)[:MOST_FOUNDATIONS]

    def label(place: int) -> tuple[str, str, str]:
        return finished.series[place].label, "", finished.series[place].label

    def description(run: dict[str, Any]) -> str:
        return said_of(finished.series[run["series"]], run, True) + f", {finished.label(run['record'])}"

    marks = dots.Marks(None, description, "record")
    order = "foundation, the best first: those that overturn, fly or fail the least often, then by their peaks"
    first = "All" if len(every) == len(best) else f"The first {len(every)} of"
    summary = tag("summary", f"{first} {len(best):,} foundations, in the order of the study")
    rows = _rows(columns, "series", best[: MOST_ROWS - 1], label, len(best), always=True)
    drawn = dots.draw(_rows(columns, "series", every, label, len(every)), words, top, marks)
    return join(
        figure(dots.draw(rows, words, top, marks), join(CAPTION, order, _all(finished))), tag("details", summary, drawn)
    )


def _columns(finished: Finished) -> "list[tuple[str, pd.DataFrame]]":
    """Return the runs of each pier and scale, or all of them together if those are many."""
    return list(finished.groups()) if finished.grouped.ngroups <= MOST_COLUMNS else [("", finished.runs)]


def _all(finished: Finished) -> str:
    return "." if finished.grouped.ngroups <= MOST_COLUMNS else ", of all piers and scales."


def worst_first(runs: "pd.DataFrame", by: str) -> list[Any]:
    """Sort records or foundations by how many runs overturn, end in flight or fail, then by the largest rotation."""
    groups = runs[by]
    ended = [(runs["status"] == status).groupby(groups).sum() for status in ("overturned", "flight", "failed")]
    stood = runs["theta_max_over_alpha"].where(runs["status"] == "ok").groupby(groups).max().fillna(0.0)
    return sorted(stood.index, key=lambda row: (*(-int(count[row]) for count in ended), -float(stood[row]), row))


def _rows(
    columns: "Sequence[tuple[str, pd.DataFrame]]",
    by: str,
    single: Sequence[Any],
    label: Callable[[Any], tuple[str, str, str]],
    all_: int,
    always: bool = False,
) -> list[dots.Row]:
    """Return a row for each record or foundation in ``single``, and one for those of ``all_`` that have none of their own."""
    places = [(runs[SHOWN], runs.groupby(by).indices) for _, runs in columns]
    rows = [dots.Row(*label(group), [runs.iloc[index.get(group, [])] for runs, index in places]) for group in single]
    if len(single) < all_ or always:
        plural = {"record": "records", "series": "foundations"}[by]
        remaining = [runs.loc[~runs[by].isin(single), SHOWN] for _, runs in columns]
        rows.append(dots.Row(f"the other {all_ - len(single):,} {plural}", "", "", remaining))
    return rows
