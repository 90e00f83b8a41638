"""Every peak in a picture of a few rows, by record or by foundation, however many there are."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from rockbatch.checks import Verdict, wording
from rockbatch.checks.demands import DEMANDS
from rockbatch.checks.responses import PEAKS
from rockbatch.checks.statistics import STATISTICS
from rockbatch.report.document import figure
from rockbatch.report.drawing import dots
from rockbatch.report.drawing.panels import said_of
from rockbatch.report.finished import Finished
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.table import THETA

if TYPE_CHECKING:
    import pandas as pd

MOST_ROWS = 14
"""More would leave the first screen."""
MOST_COLUMNS = 3
MOST_NAMED = 12
"""Foundations with a mark of their own."""
MOST_FOUNDATIONS = 300
MOST_STRETCH = 2.0
"""Of the axis, so that a limit far above all peaks does not crowd them at one end."""


def by_record(finished: Finished, verdicts: Sequence[Verdict] = ()) -> Markup:
    """A row for each of the records with the worst runs, and the other records in a last row; with the limits of checks."""
    runs = finished.runs
    if runs.empty:
        return Markup("")
    columns = _columns(finished)
    names = worst_first(runs, "record")
    single = names if len(names) <= MOST_ROWS else names[: MOST_ROWS - 1]
    rows = [_row_of_record(finished, str(name), columns) for name in single]
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
    limits = [_limits(finished, own, verdicts) for _, own in columns]
    top = ceiling(runs)
    within = [one.theta for own in limits for one in own if one.theta < MOST_STRETCH * top]
    top = max([top, *(1.03 * theta for theta in within)])
    return figure(dots.draw(rows, [words for words, _ in columns], top, marks, limits), caption)


def _limits(finished: Finished, runs: "pd.DataFrame", verdicts: Sequence[Verdict]) -> list[dots.Limit]:
    """Limits of the checks of a rotation, as θ/α; none where piers of a column differ, since each has its own."""
    if runs["pier"].nunique() != 1:
        return []
    cases = [finished.cases[places] for places in set(zip(runs["series"], runs["pier"], strict=True))]
    names = {str(case["case"]) for case in cases}
    scales = set(runs["scale"])
    of: dict[dots.Limit, set[str]] = {}
    for one in verdicts:
        most = DEMANDS[one.demand].most if one.demand in PEAKS else None
        if most is None or one.case not in names or one.scale not in scales or one.statistic == "count":
            continue
        words = f"limit of {one.check}, {wording.number(one.limit)} {one.unit}".rstrip()
        if one.statistic != "max":  # a mean, say, that single records may exceed
            words += f" ({STATISTICS[one.statistic].words})"
        of.setdefault(dots.Limit(words, one.limit / most.of(cases[0])), set()).add(one.case)
    return [
        limit if own == names else limit._replace(words=f"{limit.words} ({', '.join(sorted(own))})")
        for limit, own in sorted(of.items(), key=lambda item: item[0].theta)
    ]


def by_foundation(finished: Finished) -> Markup:
    """A row for each of the best foundations, the others in a last row; and all of them, to be unfolded."""
    runs, columns = finished.runs, _columns(finished)
    best = worst_first(runs, "series")[::-1]
    rows = [_row_of_foundation(finished, int(place), columns) for place in best[: MOST_ROWS - 1]]
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
    drawn = dots.draw([_row_of_foundation(finished, int(place), columns) for place in every], words, top, marks)
    first = "All" if len(every) == len(best) else f"The first {len(every)} of"
    return join(
        figure(dots.draw(rows, words, top, marks), caption),
        tag("details", tag("summary", f"{first} {len(best):,} foundations, in the order of the study"), drawn),
    )  # fmt: skip


def ceiling(runs: "pd.DataFrame") -> float:
    """Top of the axis [θ_max/α] that holds all of ``runs`` that stood."""
    stood = runs[runs["status"] == "ok"]
    highest = (stood["theta_max_over_alpha"] + stood["theta_max_error"].fillna(0)).max()
    return 1.1 * float(highest) if highest > 0 else 1.0


def _columns(finished: Finished) -> "list[tuple[str, pd.DataFrame]]":
    """Runs of each pier and scale, or all of them together where those are many."""
    groups = finished.groups()
    return groups if len(groups) <= MOST_COLUMNS else [("", finished.runs)]


def _all(finished: Finished) -> str:
    return "." if len(finished.groups()) <= MOST_COLUMNS else ", of all piers and scales."


def worst_first(runs: "pd.DataFrame", by: str) -> list[Any]:
    """Records or foundations: by how many of their runs overturn, are ended by flight or fail, then by the largest rotation."""
    which = runs[by]
    ended = [(runs["status"] == status).groupby(which).sum() for status in ("overturned", "flight", "failed")]
    stood = runs["theta_max_over_alpha"].where(runs["status"] == "ok").groupby(which).max().fillna(0.0)
    return sorted(stood.index, key=lambda one: (*(-int(each[one]) for each in ended), -float(stood[one]), one))


def _row_of_record(finished: Finished, name: str, columns: "Sequence[tuple[str, pd.DataFrame]]") -> dots.Row:
    """Of the label the direction, at the end, always stays."""
    words, comma, end = finished.label(name).rpartition(", ")
    words, end = (words, comma + end) if words else (end, "")
    return dots.Row(words, end, finished.named(name), [own[own["record"] == name] for _, own in columns])


def _row_of_foundation(finished: Finished, place: int, columns: "Sequence[tuple[str, pd.DataFrame]]") -> dots.Row:
    label = finished.series[place].label
    return dots.Row(label, "", label, [own[own["series"] == place] for _, own in columns])


def _others(columns: "Sequence[tuple[str, pd.DataFrame]]", by: str, single: Sequence[object], every: int) -> dots.Row:
    """All that have no row of their own."""
    what = {"record": "records", "series": "foundations"}[by]
    rest = [own[~own[by].isin(single)] for _, own in columns]
    return dots.Row(f"the other {every - len(single):,} {what}", "", "", rest)
