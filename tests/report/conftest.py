"""Fixtures of the tests in this folder, which look at pages."""

import pytest
from report_samples import histories, report


@pytest.fixture(scope="module", autouse=True)
def short_pages():
    """Let all pages be drawn, other than elsewhere."""


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """Return responses, and the text of a report with these, a published value and a file that could not be used."""
    responses, results = histories()
    reference = {"record": "*", "case": "1", "columns": {}, "theta_max_over_alpha": 0.1, "source": "s"}
    unusable = [{"name": "x", "source": "x", "reason": "empty"}]
    folder = tmp_path_factory.mktemp("drawn")
    return responses, report(folder, *responses, references=[reference], unusable=unusable, **results)
