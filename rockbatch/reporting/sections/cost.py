"""Time and estimated errors of the runs."""

from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.templates import render


def section(finished: Finished) -> Markup:
    """Report the time that the runs took, and their estimated errors."""
    info = finished.info
    return render(
        "reporting/sections/cost.html",
        kept=info.get("kept", 0),  # of an earlier session, or of other machines, whose time is unknown
        runs=info["runs"], wall_s=float(info["wall_s"]), jobs=info["jobs"], errors=finished.runs["theta_max_error"].dropna(),
    )  # fmt: skip
