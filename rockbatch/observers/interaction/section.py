"""Capacities that depend on the axial force, with the demands of all cases."""

from rockbatch.checks.rule_choices import is_height
from rockbatch.common.grouping import grouped
from rockbatch.observers.interaction import TABLE
from rockbatch.observers.interaction.figure import over_axial_force
from rockbatch.quantities.demands import OF_INTERACTION
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup
from rockbatch.reporting.svg import drawn
from rockbatch.reporting.templates import render
from rockbatch.results.sections import read_forces

MOST_CHECKS = 8
"""Most checks that are drawn."""


def section(finished: Finished) -> Markup:
    """Return the report's section of checks of a capacity that depends on the axial force, with a figure of the first eight.

    Empty without such a check, or interaction.csv.
    """
    path = finished.directory / TABLE
    of_checks = grouped((verdict for verdict in finished.verdicts if verdict.capacity), lambda verdict: verdict.check)
    if not (path.exists() and of_checks):
        return Markup("")
    rows = read_forces(path, finished.info["varied"], OF_INTERACTION)
    runs = finished.runs.merge(rows, on=[name for name in rows if name not in OF_INTERACTION])
    checks = []
    for verdict, *_ in list(of_checks.values())[:MOST_CHECKS]:
        at = verdict.at_m
        here = runs["height_m"].map(lambda height, at=at: height != height if at != at else is_height(height, at))
        if here.any():
            checks.append((verdict, runs[here]))
    return render(
        "observers/interaction/section.html",
        file=TABLE,
        picture=drawn(over_axial_force(checks, finished.series)),
        shown=len(checks),
        checks=len(of_checks),
    )
