"""Intensity measures of each run's motion: intensity.csv."""

from rockbatch.common.slices import ReportPart

TABLE = "intensity.csv"
REPORT = ReportPart("Intensity measures", "intensity", behind="distribution", folded=True)
