"""Effects of each shock of a sequence: shocks.csv."""

from rockbatch.common.observers import ReportPart

TABLE = "shocks.csv"
REPORT = ReportPart("Shock by shock", "shocks", behind="references")
