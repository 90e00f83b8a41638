"""Accuracy: error of the peak rotation against time per run, on this machine."""

from argparse import SUPPRESS

from rockbatch.common.analyses import Door
from rockbatch.common.argument_values import flag, seconds, value, whole
from rockbatch.common.slices import ReportPart

RUNS, SECONDS = 24, 60.0
"""Default number of runs that are measured, and default time limit [s]."""

DOOR = Door(
    help="measure error against time of a study on this machine",
    example="rockbatch accuracy pier.toml --seconds 30",
    writes="  accuracy.csv, and a section of report.html if the folder has results of the study",
    parts=(ReportPart("Error against time", "error_and_time"),),
    options={
        "--runs": value(whole, "N", f"runs to measure, spread over the study (default: {RUNS})", default=RUNS),
        "--seconds": value(
            seconds,
            "S",
            f"time limit; measurements that do not fit are left out (default: {SECONDS:g})",
            default=SECONDS,
        ),
        "--no-scipy": flag(SUPPRESS),  # without effect, for earlier scripts
    },
    engine=False,
)
