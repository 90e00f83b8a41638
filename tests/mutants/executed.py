"""A pytest plugin: which test executes which line of the product, as coverage's contexts, and which tests fail as it is.

What is made once for several tests (fixtures of a module, caches) counts for the test that made it.
"""

import os
from pathlib import Path

import coverage
import pytest


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """Record what runs from here on for this test."""
    measured = coverage.Coverage.current()
    if measured is not None:
        measured.switch_context(item.nodeid)
    return (yield)


def pytest_runtest_logreport(report):
    """Keep the names of tests that fail without an error."""
    if report.failed:
        with Path(os.environ["FAILED_TESTS"]).open("a", encoding="utf-8") as file:
            file.write(report.nodeid + "\n")
