"""Dampers, tendons, stops and deck springs: the greatest demands of every case, for which they are made."""

from rockbatch.quantities.catalogue import report_columns
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.sections.worst import of_cases

LEGEND = (
    "Greatest values of each case over its records. Energies of dampers, stops and deck springs in J/kg are those of all of them "
    "together; all else, and the work of a damper, is that of the device that has most of it. ≥: some runs of the case did "
    "not go through, and theirs may be greater."
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
