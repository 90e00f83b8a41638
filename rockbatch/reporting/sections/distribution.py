"""The distribution of the largest rotations over the suite, with a caution about single records."""

from itertools import islice

from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.rows import counts_as
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.overview import groups_worst_first
from rockbatch.reporting.sections.statistics import RECORDS
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.templates import render
from rockbatch.results.figures import distributions

MOST_PANELS = 12
MOST_CURVES = 21
"""Most curves of a panel: three times seven colours; more cannot be distinguished."""
BEST = 7
"""Foundations that are drawn if there are more than :data:`MOST_CURVES`."""
SHOWN = ["record", "station", "series", "status", "theta_max_over_alpha"]
"""Columns that the curves need."""
LEAST_RECORDS = 3
"""Least number of records for a distribution."""


def section(finished: Finished) -> Markup:
    """Return the caution about single peaks, and a curve for each case from three records on; empty without runs.

    Of more than :data:`MOST_CURVES` cases the :data:`BEST` are drawn; the piers and scales have up to :data:`MOST_PANELS` panels.
    """
    if finished.runs.empty:
        return Markup("")
    picture, places = Markup(""), groups_worst_first(finished.runs, "series")[::-1]
    chosen = places if len(places) <= MOST_CURVES else places[:BEST]
    groups = islice(finished.groups(), MOST_PANELS)
    shown = [(words, runs.loc[runs["series"].isin(chosen), SHOWN]) for words, runs in groups]
    if len(set(counts_as(Rows(finished.runs), finished.count)[0])) >= LEAST_RECORDS:
        picture = drawn(distributions(shown, finished.series, finished.count))
    return render(
        "reporting/sections/distribution.html",
        picture=picture,
        records=RECORDS[finished.count],
        shown=len(shown),
        groups=finished.grouped.ngroups,
        foundations=len(places),
        best=BEST if len(places) > MOST_CURVES else None,
    )
