"""Fixtures of the tests in this folder."""

from no_report import no_report
from rules_of_checks import passing

__all__ = ["no_report", "passing"]
