"""Optional outputs are read of one history of each run, and one of twice its step: they take few steps beyond the peaks."""

import importlib
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture
def module(monkeypatch):
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    return importlib.import_module("steps_of_outputs")


@pytest.fixture
def study(module):
    """Two records on Bouc–Wen springs and a rigid base with a damper."""
    cases = [case for case in module.STUDY["case"] if case["name"] in ("pads", "damped")]
    return module.STUDY | {"case": cases}


@pytest.mark.slow
def test_all_outputs_take_three_times_the_steps_of_the_peaks_at_most(module):
    assert module.of_folder(module.ALL).steps <= 3.0 * module.of_peaks().steps


def test_the_default_study_takes_half_more_than_its_peaks_at_most(module):
    assert module.of_folder({}).steps <= 1.5 * module.of_peaks().steps


@pytest.mark.slow
def test_every_output_beside_another_takes_no_steps_of_its_own(module, study):
    """Forces take the history of every step; what reads it too costs nothing, and what needs samples only neither."""
    forces = module.NONE | {"forces": True}
    more = forces | {"ledger": True, "rocking": True, "half_cycles": True, "sections": 3, "devices_work": True}
    assert module.of_folder(more, study).simulations == module.of_folder(forces, study).simulations
