"""Effects of each shock of a sequence: shocks.csv."""

from rockbatch.common.slices import ReportPart

TABLE = "shocks.csv"
REPORT = ReportPart("Shock by shock", "shocks", behind="references")
