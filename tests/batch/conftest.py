"""Fixtures of the tests in this folder."""

from no_report import no_report

__all__ = ["no_report"]
