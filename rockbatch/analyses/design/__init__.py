"""Design: the values of one key, or of two, with which every check passes under every bound."""

from rockbatch.common.analyses import Door
from rockbatch.common.slices import ReportPart

DOOR = Door(
    help="the least or greatest value of a key that passes every check",
    example="rockbatch design pier.toml",
    writes="  design.csv     intervals of values that pass, fail or are not decided\n"
    "  design_values.csv, design_checks.csv, design_runs.csv, design.json, and a section of report.html",
    parts=(ReportPart("Passing values", "design"),),
    tables=("design",),
)
