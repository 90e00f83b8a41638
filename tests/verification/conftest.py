"""What several verifications share."""

import importlib
import shutil
from pathlib import Path

import pytest

HERE = Path(__file__).parent
RENEW = "python benchmarks/outcomes.py --cache tests/verification/references --cases 80, and again with --only flight"


@pytest.fixture(scope="module")
def outcomes():
    """The benchmark, imported as a script beside it would be."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(HERE.parents[1] / "benchmarks"))
        yield importlib.import_module("outcomes")


@pytest.fixture(scope="module")
def references(outcomes, tmp_path_factory):
    """What its solver says of some cases: to compile it takes longer than all fast tests here. Slow ones compute it anew."""
    folder = tmp_path_factory.mktemp("references")
    shutil.copytree(HERE / "references", folder, dirs_exist_ok=True)
    cache = outcomes.Cache(folder, 0)
    assert cache.known, f"the pool or its solver has changed: {RENEW}"
    return cache
