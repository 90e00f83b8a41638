"""Sensitivity: which parameters the peak rotation depends on most, one at a time and by Sobol's indices."""

from rockbatch.common.analyses import Door
from rockbatch.common.slices import ReportPart

DOOR = Door(
    help="which parameters the peak rotation depends on most",
    example="rockbatch sensitivity pier.toml",
    writes="  sensitivity.csv   peaks at both ends of each parameter\n"
    "  sobol.csv, sensitivity_runs.csv, sensitivity.json, and a section of report.html",
    parts=(ReportPart("What the answer depends on", "sensitivity"),),
    tables=("sensitivity",),
)
