"""Statistics of the suite in each case: mean, median, percentiles, and the number of runs without a peak."""

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from rockbatch.checks.suite import counts_as
from rockbatch.report.contents import Contents
from rockbatch.report.document import Section
from rockbatch.report.finished import Finished
from rockbatch.report.labels import heading
from rockbatch.report.markup import Markup, join, tag
from rockbatch.report.table import MOST_ROWS, Head, alarm, table, told_apart
from rockbatch.results.columns import COLUMNS
from rockbatch.results.suite_statistics import Suite, suite

if TYPE_CHECKING:
    import pandas as pd

RECORDS = {
    "station": "A record is a station, as in the checks: the worst of its components and polarities counts.",
    "component": "A record is a horizontal component, with the worse of its polarities.",
}
WORDS = (
    " One under which the pier overturned, or that was ended by flight, has no largest value and counts as larger than any (∞) "
    "in the median, the percentiles and the maximum; the mean is then that of the records that stood, with their number. One "
    "with a failed run is unknown and counts in its own column only. Percentiles are linear between the records in order."
)


def section(contents: Contents) -> Section | None:
    """Return tables of every quantity, a row for each case; with and without the vertical component side by side."""
    finished = contents.finished
    if finished is None or finished.runs.empty:
        return None
    runs, keys = finished.runs, ["scale", "pier", "series"]
    names, heads = rows_of(finished, runs, keys)
    shown = dict(islice(names.items(), MOST_ROWS))
    if len(shown) < len(names):
        runs = runs[runs.set_index(keys).index.isin(list(shown))]
    sides = {str(side): dict(list(same.groupby(keys))) for side, same in runs.groupby("with_vertical")}
    content = join(told_apart(len(shown), len(names)), tables(sides, shown, heads, finished.count))
    return Section("The suite in each case", "suite", content)


def rows_of(finished: Finished, runs: "pd.DataFrame", keys: list[str]) -> tuple[dict[Hashable, list[str]], list[Head]]:
    """Texts of the first cells of each row, and their heads; ``keys`` are columns of ``runs`` that tell rows apart."""
    many_scales = runs["scale"].nunique() > 1
    words: dict[str, Callable[[Any], str]] = {
        "series": lambda place: finished.series[place].label,
        "pier": lambda place: finished.piers[place],
        "scale": lambda scale: f"{scale:g}" if many_scales else "",
        "with_vertical": str,
    }
    heads = {
        "series": Head("case"),
        "pier": Head("pier"),
        "scale": Head("scale of motions"),
        "with_vertical": Head("vertical"),
    }
    shown = [name for name in heads if name in keys]
    names: dict[Hashable, list[str]] = {}
    for key in runs[keys].drop_duplicates().sort_values(keys).itertuples(index=False, name=None):
        values = dict(zip(keys, key, strict=True))
        names[key] = [words[name](values[name]) for name in shown]
    return names, [heads[name] for name in shown]


def tables(
    sides: "Mapping[str, Mapping[Any, pd.DataFrame]]",
    names: Mapping[Hashable, Sequence[str]],
    heads: Sequence[Head],
    count: str,
) -> Markup:
    """Return a table for each quantity that has values.

    Parameters
    ----------
    sides : mapping
        Runs of each row, for every side that is compared, by the words for the side; one side needs no words.
    names : mapping
        Texts of the first cells of each row, which stand under ``heads``.
    count : str
        What counts as one record, one of :data:`rockbatch.checks.rules.COUNTS`.
    """
    drawn = [tag("p", RECORDS[count] + WORDS)]
    for column in COLUMNS.values():
        there = all(column.name in runs for side in sides.values() for runs in side.values())
        if column.suite is None or column.page is None or not there:
            continue
        says, form = heading(column.suite.heading), column.suite.form
        found = {
            side: {
                key: suite(
                    column.page.factor * runs[column.name].to_numpy(dtype=np.float64),
                    runs["status"].to_list(),
                    counts_as(runs, count)[0].to_list(),
                )
                for key, runs in groups.items()
                if runs[column.name].notna().any()
            }
            for side, groups in sides.items()
        }
        keys = [key for key in names if any(key in suites for suites in found.values())]
        if keys:
            rows = [[*names[key], *_cells([suites.get(key) for suites in found.values()], form)] for key in keys]
            drawn += [
                tag("h3", says),
                table([*heads, *_heads(list(sides), form)], rows, name=f"Suite: {column.suite.heading}"),
            ]
    return join(*drawn)


_COLUMNS = {
    "count": ("n", "records with an outcome"),
    "mean": ("mean", "of the records that stood"),
    "median": ("median", None),
    "low": ("16 %", "value that 16 % of the records do not exceed"),
    "high": ("84 %", "value that 84 % of the records do not exceed"),
    "largest": ("maximum", None),
    "overturned": ("overturned", "records under which the pier overturned"),
    "flight": ("flight", "records with a run that ended when both pivots left the ground"),
    "failed": ("failed", "records with a run without an outcome"),
}


def _heads(sides: Sequence[str], form: str) -> list[Head]:
    several = len(sides) > 1
    return [
        Head(
            side if several else says,
            form if name in ("mean", "median", "low", "high", "largest") else ".0f",
            note,
            says if several else "",
        )
        for name, (says, note) in _COLUMNS.items()
        for side in sides
    ]


def _cells(suites: Sequence[Suite | None], form: str) -> list[object]:
    return [None if own is None else _cell(own, name, form) for name in _COLUMNS for own in suites]


def _cell(own: Suite, name: str, form: str) -> object:
    value = getattr(own, name)
    if name in ("overturned", "flight", "failed"):
        return alarm(str(value)) if value else value
    if isinstance(value, int):
        return value
    if math.isinf(value):
        return alarm("∞")
    if name == "mean" and own.standing < own.count:
        return "—" if math.isnan(value) else join(f"{value:{form}} ", tag("span", f"of {own.standing}", class_="muted"))
    return value
