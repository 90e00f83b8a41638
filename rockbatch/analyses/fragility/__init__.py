"""Fragility: the probability of overturning and of exceeding each limit of a check, by intensity; annual rates by a hazard."""

from rockbatch.common.analyses import Door
from rockbatch.common.slices import ReportPart

DOOR = Door(
    help="fragility curves for overturning and for design checks",
    example="rockbatch fragility pier.toml --jobs 4",
    writes="  fragility.csv  shares of the records that exceed each limit\n"
    "  fragility_capacities.csv, fragility_runs.csv, fragility.json, and a section of report.html",
    parts=(
        ReportPart("Fragility", "fragility"),
        ReportPart("Annual rates", "risk", "section.rates"),
    ),
    tables=("fragility",),
)
