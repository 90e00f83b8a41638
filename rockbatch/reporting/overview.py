"""Draw all peaks in a few rows, by record or by foundation, for any number of runs."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeVar

from rockbatch.checks import wording
from rockbatch.checks.responses import PEAKS
from rockbatch.common.lazy import pd
from rockbatch.common.statuses import NOT_STANDING
from rockbatch.outcome.outcome import LEANS
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.reporting import dots
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, figure, join, tag
from rockbatch.reporting.table import THETA
from rockbatch.results.figures import tooltip
from rockbatch.results.labelled import Row, ceiling

Group = TypeVar("Group", str, int)
"""A record's name, or a foundation's place in the list of series."""

MOST_ROWS = 14
"""Rows that fit on the first screen."""
MOST_COLUMNS = 3
MOST_NAMED = 12
"""Most foundations that each have a mark of their own."""
MOST_SERIES, MOST_FOUNDATIONS = 24, 300
"""Most foundations without a picture by foundation, and most rows of that picture."""
MOST_MARKS = 3_000
"""Most runs for which every record gets a row, folded behind those of the first screen."""
SHOWN = ["record", "series", "polarity", "status", "theta_max_over_alpha", "theta_max_error", "pga"]
"""Columns needed by dots and their tooltips."""
CAPTION = join("Largest rotation over slenderness, ", THETA, ", a row for each ")
MOST_STRETCH = 2.0
"""Largest factor by which a limit extends the axis: a limit far above all peaks would crowd them at one end."""


def by_record(finished: Finished) -> Markup:
    """Return the figure of peaks, a row for each of the worst records and one for all others, with limits; empty without runs."""
    if finished.runs.empty:
        return Markup("")
    columns = _columns(finished)
    return drawn_by_record(finished, columns, [_limits(finished, column) for _, column in columns])


def drawn_by_record(
    finished: Finished, columns: "Sequence[tuple[str, pd.DataFrame]]", limits: Sequence[Sequence[dots.Limit]] = ()
) -> Markup:
    """Return the figure of runs in rows by record; ``columns`` are (caption, runs), ``limits`` those of each column.

    Of more than :data:`MOST_ROWS`, 14, records all but the worst 13 share a row, and have a folded one each if there are up to
    :data:`MOST_MARKS` runs.
    """
    runs = pd.concat([of_column for _, of_column in columns]) if len(columns) > 1 else columns[0][1]
    names = groups_worst_first(runs, "record")
    single = names if len(names) <= MOST_ROWS else names[: MOST_ROWS - 1]
    folded = names[len(single) :] if len(runs) <= MOST_MARKS else []

    ends = {
        record["record"]: f", {record['direction']}" for record in finished.info["records"] if record.get("direction")
    }

    def label(name: str) -> tuple[str, str, str]:
        whole = finished.label(name)
        words = whole.removesuffix(ends.get(name, ""))  # the direction is never cut off
        return words, whole[len(words) :], finished.named(name)

    def description(run: Row) -> str:
        words = tooltip(finished.series[run["series"]], run, run["polarity"] if finished.both_directions else "")
        return f"{finished.label(run['record'])}\n{words}"

    rows = _rows(columns, "record", single, label, len(names), folded=folded)
    marks = dots.Marks(finished.series if len(finished.series) <= MOST_NAMED else None, description, "foundation")
    caption = join(CAPTION, "record, the worst first", _end_of_caption(finished), *_marks_in_words(finished))
    top = ceiling(runs)
    within = [limit.theta for column in limits for limit in column if limit.theta < MOST_STRETCH * top]
    top = max([top, *(1.03 * theta for theta in within)])
    drawn = dots.draw(rows, [words for words, _ in columns], top, marks, limits)
    return tag("figure", drawn, tag("figcaption", caption), class_="whole peaks")


def _marks_in_words(finished: Finished) -> Iterator[str]:
    """Yield sentences on peaks that are not plain rocking: after flight, or mostly the lean of a yielded base."""
    stood = finished.runs[finished.runs["status"] == "ok"]
    if lifted := int(stood["flight_s"].notna().sum()):
        height = stood["flight_height_m"].max()
        most = f", by up to {1000 * height:.3g} mm" if height == height else ""
        yield f" In {counted(lifted, 'run')} the pier left the ground altogether{most}; it was guided down."
    if leaning := int((stood["theta_max_is"] == LEANS).sum()):
        yield f" In {counted(leaning, 'run')} the peak is mostly the lean of a yielded base, not rocking."


def _limits(finished: Finished, runs: "pd.DataFrame") -> list[dots.Limit]:
    """Return the limits of checks of rotation, drift or uplift as θ/α, ascending, but of checks that count records.

    [] if the column has several piers, whose limits differ.
    """
    if runs["pier"].nunique() != 1:
        return []
    cases = [finished.cases[places] for places in set(zip(runs["series"], runs["pier"], strict=True))]
    names = {str(case["case"]) for case in cases}
    scales = set(runs["scale"])
    cases_of: dict[dots.Limit, dict[str, None]] = {}
    for verdict in finished.verdicts:
        most = DEMANDS[verdict.demand].ceiling if verdict.demand in PEAKS else None
        if most is None or verdict.case not in names or verdict.scale not in scales or verdict.statistic == "count":
            continue
        limit = f"{wording.number(verdict.limit)} {verdict.unit}".rstrip()
        words = f"limit of {verdict.check}, {limit}{wording.at(verdict.at_m)}"
        if verdict.statistic != "max":  # single records may exceed a mean, say
            words += f" ({STATISTICS[verdict.statistic].words})"
        cases_of.setdefault(dots.Limit(words, verdict.limit / most.value(cases[0])), {})[verdict.case] = None
    limits = []
    for drawn, of_limit in sorted(cases_of.items(), key=lambda item: item[0].theta):
        words = drawn.words if of_limit.keys() == names else f"{drawn.words} ({', '.join(of_limit)})"
        limits.append(drawn._replace(words=words))
    return limits


def by_foundation(finished: Finished) -> Markup:
    """Return the figure of many foundations: the best 13 in rows, the others in one, then up to 300, folded.

    Empty if no pier and scale has more than :data:`MOST_SERIES`, 24.
    """
    if finished.runs.empty or finished.grouped["series"].nunique().max() <= MOST_SERIES:
        return Markup("")
    runs, columns = finished.runs, _columns(finished)
    best = groups_worst_first(runs, "series")[::-1]
    top, words = ceiling(runs), [words for words, _ in columns]
    every = sorted(best)[:MOST_FOUNDATIONS]

    def label(place: int) -> tuple[str, str, str]:
        return finished.series[place].label, "", finished.series[place].label

    def description(run: Row) -> str:
        return tooltip(finished.series[run["series"]], run, run["polarity"]) + f", {finished.label(run['record'])}"

    marks = dots.Marks(None, description, "record")
    order = "foundation, the best first: those that overturn, fly or fail the least often, then by their peaks"
    first = "All" if len(every) == len(best) else f"The first {len(every)} of"
    summary = tag("summary", f"{first} {len(best):,} foundations, in the order of the study")
    rows = _rows(columns, "series", best[: MOST_ROWS - 1], label, len(best), always=True)
    drawn = dots.draw(_rows(columns, "series", every, label, len(every)), words, top, marks)
    return join(
        figure(dots.draw(rows, words, top, marks), join(CAPTION, order, _end_of_caption(finished))),
        tag("details", summary, drawn),
    )


def _columns(finished: Finished) -> "list[tuple[str, pd.DataFrame]]":
    """Return captions and runs of each pier, scale and vertical component; if over :data:`MOST_COLUMNS`, all runs under ""."""
    return list(finished.groups()) if finished.grouped.ngroups <= MOST_COLUMNS else [("", finished.runs)]


def _end_of_caption(finished: Finished) -> str:
    """Return the end of a caption: "." if each pier and scale has a column, ", of all piers and scales." if they share one."""
    return "." if finished.grouped.ngroups <= MOST_COLUMNS else ", of all piers and scales."


def groups_worst_first(runs: "pd.DataFrame", by: str) -> list[Any]:
    """Return the distinct values of column ``by``, worst first: by overturned runs, then flights, failed runs, rotation."""
    groups = runs[by]
    ended = [(runs["status"] == status).groupby(groups).sum() for status in NOT_STANDING]
    stood = runs["theta_max_over_alpha"].where(runs["status"] == "ok").groupby(groups).max().fillna(0.0)
    return sorted(stood.index, key=lambda row: (*(-int(count[row]) for count in ended), -float(stood[row]), row))


def _rows(
    columns: "Sequence[tuple[str, pd.DataFrame]]",
    by: str,
    single: Sequence[Group],
    label: Callable[[Group], tuple[str, str, str]],
    all_: int,
    always: bool = False,
    folded: Sequence[Group] = (),
) -> list[dots.Row]:
    """Return a row for each record or foundation in ``single``, one for the remaining of ``all_``, and ``folded`` rows.

    Without remaining ones, their row is left out unless ``always``.
    """
    places = [(runs[SHOWN], runs.groupby(by).indices) for _, runs in columns]

    def row(group: Group, role: str = "") -> dots.Row:
        return dots.Row(*label(group), [runs.iloc[index.get(group, [])] for runs, index in places], role)

    rows = list(map(row, single))
    if len(single) < all_ or always:
        plural = {"record": "records", "series": "foundations"}[by]
        remaining = [runs.loc[~runs[by].isin(single), SHOWN] for _, runs in columns]
        rows.append(dots.Row(f"the other {all_ - len(single):,} {plural}", "", "", remaining, "rest"))
    return rows + [row(group, "folded") for group in folded]
