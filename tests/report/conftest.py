"""Fixtures of the tests in this folder, which look at pages."""

import pytest


@pytest.fixture(scope="module", autouse=True)
def short_pages():
    """Let all pages be drawn, other than elsewhere."""
