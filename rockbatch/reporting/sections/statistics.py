"""Statistics of the suite in each case: mean, median, percentiles, and numbers of records without a peak."""

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from itertools import islice
from typing import Any

import numpy as np

from rockbatch.common.lazy import pd
from rockbatch.common.statuses import NOT_STANDING
from rockbatch.common.units import with_unit
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.catalogue import COLUMNS
from rockbatch.quantities.rows import counts_as
from rockbatch.quantities.statistics import FRACTILES_FROM, P84, exceedance
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import heading
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.table import MOST_ROWS, Head, alarm, shown_of, table
from rockbatch.results.suite_statistics import Statistics, suites

Row = tuple[Hashable, ...]
"""Values of the key columns that identify a row of the tables."""

RECORDS = {
    "station": "A record is a station, as in the checks: the worst of its components and polarities counts.",
    "component": "A record is a horizontal component, with the worse of its polarities.",
}
WORDS = (
    " A record under which the pier overturned or a run stopped in flight counts as infinite (∞) in the median, percentiles and "
    "maximum; the mean is over the standing records (n given). A record with a failed run is unknown and counts in its own "
    "column only. Percentiles are interpolated linearly between the ordered records, and not stated for fewer than "
    f"{FRACTILES_FROM}, of which more than {100 * exceedance(P84, FRACTILES_FROM):.0f} % of further records are expected beyond."
)


def section(finished: Finished) -> Markup:
    """Return a table for each quantity, with and without the vertical component side by side; empty without runs.

    It has a row for each case, pier and scale, up to MOST_ROWS.
    """
    if finished.runs.empty:
        return Markup("")
    runs, keys = finished.runs, ["scale", "pier", "series"]
    names, heads = rows_of(finished, runs, keys)
    shown = dict(islice(names.items(), MOST_ROWS))
    sides = {str(side): group for side, group in runs.groupby("with_vertical")}
    return join(shown_of(len(shown), len(names)), tables(sides, keys, shown, heads, finished.count))


def rows_of(finished: Finished, runs: "pd.DataFrame", keys: list[str]) -> tuple[dict[Row, list[str]], list[Head]]:
    """Return the first cells of each row by its values of ``keys``, columns of ``runs``, and the heads of these cells."""
    many_scales = runs["scale"].nunique() > 1
    columns: dict[str, tuple[str, Callable[[Any], str]]] = {
        "series": ("case", lambda place: finished.series[place].label),
        "pier": ("pier", lambda place: finished.piers[place]),
        "scale": ("scale of motions", lambda scale: f"{scale:g}" if many_scales else ""),
        "with_vertical": ("vertical", str),
    }
    shown = {keys.index(name): column for name, column in columns.items() if name in keys}
    rows = runs[keys].drop_duplicates().sort_values(keys).itertuples(index=False, name=None)
    names = {key: [words(key[place]) for place, (_, words) in shown.items()] for key in rows}
    return names, [Head(heading) for heading, _ in shown.values()]


def tables(
    sides: "Mapping[str, pd.DataFrame]",
    keys: list[str],
    names: Mapping[Row, Sequence[str]],
    heads: Sequence[Head],
    count: str,
) -> Markup:
    """Return a heading and a table for each quantity that has values.

    ``sides`` are the runs to compare, by their caption ("" for a single side). ``names`` has the first cells of each row,
    under ``heads``, by its values of ``keys``; runs of no row are left out. ``count`` is the unit of counting, one of
    :data:`rockbatch.checks.rules.COUNTS`.
    """
    drawn = [tag("p", RECORDS[count] + WORDS)]
    index = pd.MultiIndex.from_tuples(list(names), names=keys)
    placed = [(runs, index.get_indexer(pd.MultiIndex.from_frame(runs[keys]))) for runs in sides.values()]
    grouped = [(runs[place >= 0], place[place >= 0].astype(np.int64)) for runs, place in placed]
    counted_as = [counts_as(Rows(runs), count)[0].tolist() for runs, _ in grouped]
    for column in COLUMNS.values():
        present = all(column.name in runs for runs, _ in grouped)
        if column.suite is None or column.page is None or not present:
            continue
        title, form = with_unit(column.suite.heading, column.unit_on_page), column.suite.form
        of_sides = []
        for (runs, rows), records in zip(grouped, counted_as, strict=True):
            values = column.page.factor * runs[column.name].to_numpy(dtype=np.float64)
            has_value = np.bincount(rows, ~np.isnan(values), len(names)) > 0
            of_rows = suites(values, runs["status"].to_list(), records, rows, len(names))
            of_sides.append([suite if any_ else None for suite, any_ in zip(of_rows, has_value, strict=True)])
        cells: list[list[object]] = []
        for words, *row_of_sides in zip(names.values(), *of_sides, strict=True):
            if any(row_of_sides):
                cells.append([*words, *(_cell(suite, name, form) for name in _COLUMNS for suite in row_of_sides)])
        if cells:
            all_heads = [*heads, *_heads(list(sides), form)]
            drawn += [tag("h3", heading(title)), table(all_heads, cells, name=f"Suite: {title}")]
    return join(*drawn)


_COLUMNS = {
    "count": ("n", "records with an outcome"),
    "mean": ("mean", "of the records that stood"),
    "median": ("median", None),
    "low": ("16 %", f"16th percentile over the records, of {FRACTILES_FROM} or more"),
    "high": ("84 %", f"84th percentile over the records, of {FRACTILES_FROM} or more"),
    "largest": ("maximum", None),
    "overturned": ("overturned", "records under which the pier overturned"),
    "flight": ("flight", "records with a run that ended when both pivots left the ground"),
    "failed": ("failed", "records with a run without an outcome"),
}


def _heads(sides: Sequence[str], form: str) -> list[Head]:
    heads = []
    for name, (label, note) in _COLUMNS.items():
        fmt = form if name in ("mean", "median", "low", "high", "largest") else ".0f"
        heads += [Head(side, fmt, note, label) if len(sides) > 1 else Head(label, fmt, note) for side in sides]
    return heads


def _cell(s: Statistics | None, name: str, form: str) -> object:
    """Return the cell of statistic ``name``; None without statistics, "∞" in bold if infinite.

    A mean of fewer records than have an outcome has their number behind it; "—" is a mean without any, or a percentile of too
    few. Counts above 0 of records without a peak are in bold.
    """
    if s is None:
        return None
    value = getattr(s, name)
    if name in NOT_STANDING:
        return alarm(str(value)) if value else value
    if isinstance(value, int):
        return value
    if math.isinf(value):
        return alarm("∞")
    if math.isnan(value):
        return "—"
    if name == "mean" and s.standing < s.count:
        return join(f"{value:{form}} ", tag("span", f"of {s.standing}", class_="muted"))
    return value
