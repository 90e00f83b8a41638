"""All peaks in a picture of a few rows, by record or by foundation, for any number of runs."""

from collections.abc import Callable, Sequence
from typing import Any

from rockbatch.checks import wording
from rockbatch.checks.demands import DEMANDS
from rockbatch.checks.responses import PEAKS
from rockbatch.checks.statistics import STATISTICS
from rockbatch.lazy import pd
from rockbatch.report.drawing import dots
from rockbatch.report.drawing.panels import said_of
from rockbatch.report.finished import Finished
from rockbatch.report.markup import Markup, figure, join, tag
from rockbatch.report.table import THETA

MOST_ROWS = 14
"""Rows that fit on the first screen."""
MOST_COLUMNS = 3
MOST_NAMED = 12
"""Most foundations that each have a mark of their own."""
MOST_FOUNDATIONS = 300
SHOWN = ["record", "series", "polarity", "status", "theta_max_over_alpha", "theta_max_error"]
"""Columns that the dots and their words are made of."""
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
    split = _split(columns, "record")
    rows = [_row_of_record(finished, str(name), split) for name in single]
    if len(single) < len(names):
        rows.append(_others(columns, "record", single, len(names)))
    series = finished.series if len(finished.series) <= MOST_NAMED else None
    marks = dots.Marks(
        series,
        lambda run: (
            f"{finished.label(run['record'])}\n{said_of(finished.series[run['series']], run, finished.both_directions)}"
        ),
        "foundation",
    )
    caption = join(
        "Largest rotation over slenderness, ", THETA, ", a row for each record, the worst first", _all(finished)
    )
    limits = [_limits(finished, own) for _, own in columns]
    top = ceiling(runs)
    within = [limit.theta for own in limits for limit in own if limit.theta < MOST_STRETCH * top]
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
        most = DEMANDS[verdict.demand].most if verdict.demand in PEAKS else None
        if most is None or verdict.case not in names or verdict.scale not in scales or verdict.statistic == "count":
            continue
        words = f"limit of {verdict.check}, {wording.number(verdict.limit)} {verdict.unit}".rstrip()
        if verdict.statistic != "max":  # a mean, say, that single records may exceed
            words += f" ({STATISTICS[verdict.statistic].words})"
        cases_of.setdefault(dots.Limit(words, verdict.limit / most.of(cases[0])), set()).add(verdict.case)
    return [
        limit if own == names else limit._replace(words=f"{limit.words} ({', '.join(sorted(own))})")
        for limit, own in sorted(cases_of.items(), key=lambda item: item[0].theta)
    ]


def by_foundation(finished: Finished) -> Markup:
    """Draw a row for each of the best foundations and one for the others; below, folded, a row for every one."""
    runs, columns = finished.runs, _columns(finished)
    best = worst_first(runs, "series")[::-1]
    split = _split(columns, "series")
    rows = [_row_of_foundation(finished, int(place), split) for place in best[: MOST_ROWS - 1]]
    rows.append(_others(columns, "series", best[: MOST_ROWS - 1], len(best)))
    marks = dots.Marks(
        None,
        lambda run: said_of(finished.series[run["series"]], run, True) + f", {finished.label(run['record'])}",
        "record",
    )
    top, words = ceiling(runs), [words for words, _ in columns]
    order = ", a row for each foundation, the best first: those that overturn, fly or fail the least often, then by their peaks"
    caption = join("Largest rotation over slenderness, ", THETA, order, _all(finished))
    every = sorted(best)[:MOST_FOUNDATIONS]
    drawn = dots.draw([_row_of_foundation(finished, int(place), split) for place in every], words, top, marks)
    first = "All" if len(every) == len(best) else f"The first {len(every)} of"
    return join(
        figure(dots.draw(rows, words, top, marks), caption),
        tag("details", tag("summary", f"{first} {len(best):,} foundations, in the order of the study"), drawn),
    )  # fmt: skip


def ceiling(runs: "pd.DataFrame") -> float:
    """Return the top of the axis [θ_max/α] that holds all of ``runs`` that stood."""
    stood = runs[runs["status"] == "ok"]
    highest = (stood["theta_max_over_alpha"] + stood["theta_max_error"].fillna(0)).max()
    return 1.1 * float(highest) if highest > 0 else 1.0


def _columns(finished: Finished) -> "list[tuple[str, pd.DataFrame]]":
    """Return the runs of each pier and scale, or all of them together if those are many."""
    groups = finished.groups()
    return groups if len(groups) <= MOST_COLUMNS else [("", finished.runs)]


def _all(finished: Finished) -> str:
    return "." if len(finished.groups()) <= MOST_COLUMNS else ", of all piers and scales."


def worst_first(runs: "pd.DataFrame", by: str) -> list[Any]:
    """Sort records or foundations by how many runs overturn, end in flight or fail, then by the largest rotation."""
    which = runs[by]
    ended = [(runs["status"] == status).groupby(which).sum() for status in ("overturned", "flight", "failed")]
    stood = runs["theta_max_over_alpha"].where(runs["status"] == "ok").groupby(which).max().fillna(0.0)
    return sorted(stood.index, key=lambda row: (*(-int(count[row]) for count in ended), -float(stood[row]), row))


def _split(columns: "Sequence[tuple[str, pd.DataFrame]]", by: str) -> "list[Callable[[object], pd.DataFrame]]":
    """Of each column what gives the runs of one record or foundation."""

    def of(runs: "pd.DataFrame") -> "Callable[[object], pd.DataFrame]":
        places = runs.groupby(by).indices
        return lambda one: runs.iloc[places.get(one, [])]

    return [of(own[SHOWN]) for _, own in columns]


def _row_of_record(finished: Finished, name: str, columns: "Sequence[Callable[[object], pd.DataFrame]]") -> dots.Row:
    """Of the label the direction, at the end, always stays."""
    words, comma, end = finished.label(name).rpartition(", ")
    words, end = (words, comma + end) if words else (end, "")
    return dots.Row(words, end, finished.named(name), [own(name) for own in columns])


def _row_of_foundation(
    finished: Finished, place: int, columns: "Sequence[Callable[[object], pd.DataFrame]]"
) -> dots.Row:
    label = finished.series[place].label
    return dots.Row(label, "", label, [own(place) for own in columns])


def _others(columns: "Sequence[tuple[str, pd.DataFrame]]", by: str, single: Sequence[object], every: int) -> dots.Row:
    """Return the row of all that have no row of their own."""
    what = {"record": "records", "series": "foundations"}[by]
    rest = [own.loc[~own[by].isin(single), SHOWN] for _, own in columns]
    return dots.Row(f"the other {every - len(single):,} {what}", "", "", rest)
