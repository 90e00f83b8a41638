"""A short text in place of the page that runs, checks and analyses write by themselves: it takes longer than their runs."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rockbatch.analyses.accuracy import analysis as of_accuracy
from rockbatch.commands import check
from rockbatch.reporting import REPORT, write_analyses, write_report
from rockbatch.results.run_json import describe_study, is_of
from rockbatch.study import Study
from rockbatch.workflow import analysis, running


def _of_results(directory: Path, **_: Any) -> Path:
    return Path(shutil.copy(directory / "run.json", directory / REPORT))


def _of_analyses(directory: Path, study: Study) -> Path:
    description = describe_study(study)
    if is_of(directory, description["sha256"]):
        return _of_results(directory)
    path = directory / "analyses.html"
    path.write_text(repr(description), encoding="utf-8")
    return path


def _let(patch: pytest.MonkeyPatch, of_results: Any, of_analyses: Any) -> None:
    """Let commands write their pages by these functions."""
    for module in (running, check, of_accuracy):
        patch.setattr(module, "write_report", of_results)
    patch.setattr(analysis, "write_analyses", of_analyses)


@pytest.fixture(scope="module", autouse=True)
def short_pages(request: pytest.FixtureRequest) -> Iterator[None]:
    """Write run.json once more in place of each page, unless all tests of a module use the fixture ``pages``."""
    with pytest.MonkeyPatch.context() as patch:
        if not any("pages" in mark.args for mark in request.node.iter_markers("usefixtures")):
            _let(patch, _of_results, _of_analyses)
        yield


@pytest.fixture
def pages(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw the pages of runs, checks and analyses, for a test that looks at them."""
    _let(monkeypatch, write_report, write_analyses)
