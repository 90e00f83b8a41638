"""Forces and motions that a designer sizes."""

from rockbatch.common.observers import ReportPart

REPORT = ReportPart("Forces", "forces", behind="references")
