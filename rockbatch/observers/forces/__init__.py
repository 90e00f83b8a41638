"""Forces and motions that a designer sizes."""

from rockbatch.common.slices import ReportPart

REPORT = ReportPart("Forces", "forces", behind="references")
