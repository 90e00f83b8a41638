"""Forces in sections of the shaft: sections.csv."""

from rockbatch.common.observers import ReportPart

TABLE = "sections.csv"
REPORT = ReportPart("Forces over the height of the shaft", "shaft", behind="devices")
