"""Fixtures of the tests in this folder."""

from many_runs import file, in_this_process, runs, study
from no_report import no_report

__all__ = ["file", "in_this_process", "no_report", "runs", "study"]
