"""What several verifications share."""

import importlib
from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def outcomes():
    """The benchmark, imported as a script beside it would be."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(Path(__file__).parents[2] / "benchmarks"))
        yield importlib.import_module("outcomes")
