"""How to reproduce the results: command, versions and study file, with the time that the runs took and their errors."""

from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.templates import render


def section(finished: Finished) -> Markup:
    """Report how the results were made."""
    info = finished.info
    return render(
        "reporting/sections/reproduce.html", contents=finished,
        kept=info.get("kept", 0),  # of an earlier session, or of other machines, whose time is unknown
        runs=info["runs"], wall_s=float(info["wall_s"]), jobs=info["jobs"], errors=finished.runs["theta_max_error"].dropna(),
    )  # fmt: skip
