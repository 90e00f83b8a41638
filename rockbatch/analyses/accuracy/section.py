"""Error against time in the report."""

from rockbatch.analyses.accuracy.figures import error_and_time
from rockbatch.analyses.accuracy.levels import chosen, read
from rockbatch.report.finished_analysis import Contents
from rockbatch.report.markup import Markup
from rockbatch.report.svg import drawn
from rockbatch.report.table import Head, listed
from rockbatch.report.templates import render

HEADS = (
    Head("method", value="method"),
    Head("k", ".0f", "substeps: steps per sample", value="substeps"),
    Head("tolerance", ".0e", "on θ_max/α", value="tolerance"),
    Head("runs", ".0f", value="runs"),
    Head("median error", ".1e", value="error_median"),
    Head("95 %", ".1e", "error that 95 % of the runs keep", value="error_95"),
    Head("largest", ".1e", value="error_max"),
    Head("time per run [ms]", ".3g", value="milliseconds"),
    Head(
        "other outcome", ".0f", "runs that end otherwise than the reference: overturned, flight",
        value=lambda level: level["status_differs"] or None,
    ),
)  # fmt: skip


def section(contents: Contents) -> Markup:
    """Show the measurement of this study; empty without one."""
    levels = read(contents.directory / "accuracy.csv", contents.study["sha256"])
    if not levels:
        return Markup("")
    return render(
        "analyses/accuracy/section.html", levels=levels, own=chosen(levels), picture=drawn(error_and_time(levels)),
        last_change=max((level.reference_change or 0.0 for level in levels), default=0),
        table=listed(HEADS, [vars(level) | {"milliseconds": level.milliseconds} for level in levels]),
    )  # fmt: skip
