"""Error against time in the report."""

from collections.abc import Iterator

from rockbatch.analyses.accuracy.figures import error_and_time
from rockbatch.analyses.accuracy.levels import NO_ERROR, Level, chosen, read
from rockbatch.analyses.accuracy.quantities import QUANTITIES, rows
from rockbatch.reporting.finished_analysis import Contents, of_earlier_version
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import listed
from rockbatch.reporting.templates import render


def section(contents: Contents) -> Markup:
    """Return the report's section of error against time measured for this study; empty without a measurement."""
    levels = read(contents.directory / "accuracy.csv", contents.study["sha256"])
    if levels is None:
        return of_earlier_version("accuracy")
    if not levels:
        return Markup("")
    own, last_change = chosen(levels), max((level.reference_change or 0.0 for level in levels), default=0)
    return render(
        "analyses/accuracy/section.html",
        levels=levels,
        own=own,
        no_error=NO_ERROR,
        picture=drawn(error_and_time(levels)),
        last_change=last_change,
        remarks=list(_remarks(own, last_change)) if own else [],
        table=listed(QUANTITIES, rows(levels)),
    )


def _remarks(own: Level, last_change: float) -> Iterator[str]:
    """Yield remarks on the error of the study's own setting: that it is above the tolerance, or lacks runs that end otherwise.

    The last is that it is no more than ``last_change``, to which the references are known.
    """
    error, differing = own.error_max or 0.0, int(own.status_differs or 0)
    if own.tolerance and error > own.tolerance:
        yield "that is more than the tolerance"
    if differing:
        end, have = ("ends", "has") if differing == 1 else ("end", "have")
        yield f"{differing} of these runs {end} otherwise than the reference, and {have} no error"
    if last_change >= error:
        yield f"the references themselves are known to {last_change:.0e} only"
