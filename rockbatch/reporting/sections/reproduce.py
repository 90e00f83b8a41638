"""How to reproduce the results: command, versions, study file, computing time and errors."""

from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.templates import render


def section(finished: Finished) -> Markup:
    """Return command, versions, computing time, errors and study file of the results."""
    info = finished.info
    return render(
        "reporting/sections/reproduce.html",
        contents=finished,
        kept=info.get("kept", 0),  # by an earlier session or another machine, whose computing time is unknown
        runs=info["runs"],
        wall_s=float(info["wall_s"]),
        jobs=info["jobs"],
        errors=finished.runs["theta_max_error"].dropna(),
    )
