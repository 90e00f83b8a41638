"""Cost and errors of the runs, and the results of ``rockbatch accuracy``."""

from rockbatch.report.drawing.accuracy import draw
from rockbatch.report.finished import Finished
from rockbatch.report.finished_accuracy import chosen, read
from rockbatch.report.markup import Markup
from rockbatch.report.table import Head, listed
from rockbatch.report.templates import render

HEADS = (
    Head("method", value="method"),
    Head("k", ".0f", "substeps: steps per sample", value="substeps"),
    Head("tolerance", ".0e", "on θ_max/α; SciPy's rtol", value="tolerance"),
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


def section(finished: Finished) -> Markup:
    """Report time and estimated errors of the runs, and the measurement of this study if any."""
    info, levels = finished.info, read(finished.directory / "accuracy.csv", finished.study["sha256"])
    return render(
        "sections/accuracy.html", levels=levels, own=chosen(levels),
        kept=info.get("kept", 0),  # of an earlier session, or of other machines, whose time is unknown
        runs=info["runs"], wall_s=float(info["wall_s"]), jobs=info["jobs"], errors=finished.runs["theta_max_error"].dropna(),
        picture=draw(levels) if levels else "", last_change=max((level.reference_change or 0.0 for level in levels), default=0),
        table=listed(HEADS, [vars(level) | {"milliseconds": level.milliseconds} for level in levels]) if levels else "",
    )  # fmt: skip
