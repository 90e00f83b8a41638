"""A pytest plugin: which test executes which line of the product, as coverage's contexts.

What is made once for several tests (fixtures of a module, caches) counts for the test that made it.
"""

import coverage
import pytest


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item):
    """Record what runs from here on for this test."""
    measured = coverage.Coverage.current()
    if measured is not None:
        measured.switch_context(item.nodeid)
    return (yield)
