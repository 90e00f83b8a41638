"""A study of forty short runs, for engines that carry it out."""

import pytest
from studies import COSINE, PADS, RIGID, SINE, study_text, write_study

from rockbatch.batch.plan import Plan
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

STUDY = study_text(
    title="Two pulses on many foundations",
    motions={"polarity": ["+", "-"], "scale": [0.5, 1.0]},
    pulses=(SINE, COSINE),
    cases=(RIGID, PADS | {"beta": [30, 50], "eta": [2.0, 3.0], "epsilon": 0.1}),
    output={"both_laws": False, "histories": "none", "forces": True},
)


RUNS = 2 * 2 * 2 * 5


@pytest.fixture
def file(tmp_path):
    return write_study(tmp_path, STUDY)


@pytest.fixture
def study(file):
    return load_study(file)


@pytest.fixture
def runs(study):
    return Plan(study, ground_motions(study))


@pytest.fixture
def in_this_process(monkeypatch):
    """Let workers be threads of this process, which start at once."""
    distributed = pytest.importorskip("distributed")
    client, changes = distributed.Client, {"processes": False, "dashboard_address": ":0"}
    monkeypatch.setattr(distributed, "Client", lambda **given: client(**given | changes))
