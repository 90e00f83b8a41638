"""Forces in sections of the shaft: sections.csv."""

from rockbatch.common.slices import ReportPart
from rockbatch.quantities.demands import SECTIONS

TABLE = SECTIONS
REPORT = ReportPart("Forces over the height of the shaft", "shaft", behind="devices")
