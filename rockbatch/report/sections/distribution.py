"""The distribution of the largest rotations over the suite, and what a single record can tell."""

from rockbatch.checks.suite import counts_as
from rockbatch.report.drawing import distribution
from rockbatch.report.finished import Finished
from rockbatch.report.markup import Markup, figure, join, paragraphs, tag
from rockbatch.report.overview import worst_first
from rockbatch.report.sections.statistics import RECORDS

MOST_PANELS = 12
MOST_CURVES = 21
"""Most curves of a panel: three times seven colours; more cannot be distinguished."""
BEST = 7
"""Foundations that are drawn if there are more."""
LEAST_RECORDS = 3
"""Least number of records for a distribution."""

ONE_RECORD = (
    "The peak under one record predicts no earthquake. Held against shaking tables, planar rocking models miss the "
    "response to a single motion, and tests do not even repeat themselves; they meet the distribution of the maxima "
    "over an ensemble of motions (Bachmann, Strand, Vassiliou, Broccardo & Stojadinović 2018, Earthq. Eng. Struct. "
    "Dyn. 47(2), 535–552; Vassiliou et al. 2021, Earthquake Spectra, doi 10.1177/8755293020988017). Judge by the suite."
)


def section(finished: Finished) -> Markup:
    """Return the caution that belongs to every peak, and a curve for each case if there are enough records."""
    if finished.runs.empty:
        return Markup("")
    return join(paragraphs(ONE_RECORD), _picture(finished))


def _picture(finished: Finished) -> Markup:
    if counts_as(finished.runs, finished.count)[0].nunique() < LEAST_RECORDS:
        return tag("p", "There are too few records for a distribution.", class_="muted")
    groups = finished.groups()
    shown = groups[:MOST_PANELS]
    places = worst_first(finished.runs, "series")[::-1]
    if len(places) > MOST_CURVES:
        shown = [(words, runs[runs["series"].isin(places[:BEST])]) for words, runs in shown]
    caption = (
        "Share of the records under which the largest rotation does not exceed a value; steps are single records. "
        f"{RECORDS[finished.count]} Those under which the pier overturned, or that were ended by flight, exceed every "
        "value: they stand at the right edge. Records with a failed run do not count."
    )
    caption += f" The first {len(shown)} of {len(groups)} groups are shown." if len(shown) < len(groups) else ""
    caption += f" The {BEST} best of {len(places)} foundations are shown." if len(places) > MOST_CURVES else ""
    return figure(distribution.draw(shown, finished.series, finished.count), caption)
