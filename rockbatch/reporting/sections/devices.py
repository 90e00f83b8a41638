"""Dampers, tendons, stops and deck springs: the greatest demands of every case, for which they are made."""

from rockbatch.quantities.catalogue import report_columns
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.sections.worst import of_cases

LEGEND = (
    "Greatest values of each case over its records. Energies of dampers, stops and deck springs in J/kg are totals; other "
    "columns, and the work of a damper, are of the device that has most of it. ≥: some runs of the case stopped early; the true "
    "value may be larger."
)


def section(finished: Finished) -> Markup:
    """Return the table of demands on devices, a row for each case; empty without devices."""
    runs = finished.runs
    shown = [
        column
        for column in report_columns()
        if column.device and column.name in runs and runs[column.name].notna().any()
    ]
    if not shown:
        return Markup("")
    return join(of_cases(finished, shown, "Devices of every case"), tag("p", LEGEND, class_="legend"))
