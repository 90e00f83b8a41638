"""Fixtures of the tests in this folder."""

from rules_of_checks import passing

__all__ = ["passing"]
