"""Error against time in the report."""

from rockbatch.analyses.accuracy.figures import error_and_time
from rockbatch.analyses.accuracy.levels import chosen, read
from rockbatch.analyses.accuracy.quantities import QUANTITIES, rows
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.table import listed
from rockbatch.reporting.templates import render


def section(contents: Contents) -> Markup:
    """Show the measurement of this study; empty without one."""
    levels = read(contents.directory / "accuracy.csv", contents.study["sha256"])
    if not levels:
        return Markup("")
    return render(
        "analyses/accuracy/section.html", levels=levels, own=chosen(levels), picture=drawn(error_and_time(levels)),
        last_change=max((level.reference_change or 0.0 for level in levels), default=0),
        table=listed(QUANTITIES, rows(levels)),
    )  # fmt: skip
