"""Fixtures of the tests in this folder."""

from many_runs import file, in_this_process, runs, study

__all__ = ["file", "in_this_process", "runs", "study"]
