"""The examples in docstrings of what is public run, and come to what they say; every public name has one."""

import doctest
import sys
from importlib import import_module
from pathlib import Path

import pytest
from studies import COSINE, PADS, PIER, RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common.errors import InputError

ROOT = Path(__file__).parents[1]

PUBLIC = {name: getattr(import_module(home), name) for name, home in rb._homes().items()}
MODULES = sorted({thing.__module__ for thing in PUBLIC.values()})

STUDY = study_text(
    title="Pier 4",
    pier=PIER,
    pulses=[SINE | {"duration_s": 2.0}, COSINE | {"dt_s": 0.01, "duration_s": 2.0}],
    cases=[RIGID, PADS],
    check=[{"name": "rotation", "demand": "theta_max_over_alpha", "at_most": 0.5, "reason": "what the joints follow"}],
    output={"histories": "all", "both_laws": False},
    design={"vary": "pier.p", "between": [0.8, 2.0], "find": "greatest", "points": 3, "width": 0.3},
    fragility={"measure": "PGA", "levels_g": [0.4, 0.8, 1.6, 3.2]},
    spectrum={"alpha": [0.15], "two_pi_over_p_s": [3.0, 8.0], "points": 3},
    sensitivity={"samples": 4, "uniform": {"alpha": [0.18, 0.22], "eta": [2.2, 3.0]}},
)
"""The study pier4.toml of the examples: two pulses, so that nothing takes long."""


def examples(module):
    """The docstrings with examples of a module, and of what is in it."""
    finder = doctest.DocTestFinder(exclude_empty=True)
    return [found for found in finder.find(module, globs={"rb": rb}) if found.examples]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("examples")
    write_study(place, STUDY, "pier4.toml")
    (place / "motions").symlink_to(ROOT / "motions")
    return place


@pytest.mark.parametrize("name", MODULES)
def test_examples_come_to_what_they_say(name, folder, monkeypatch):
    monkeypatch.chdir(folder)
    told: list[str] = []
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE, verbose=False)
    tests = examples(sys.modules[name])
    for test in tests:
        runner.run(test, out=told.append)
    assert not told, "".join(told)
    assert tests


def test_every_public_name_has_an_example():
    """But the kinds of ``InputError``, whose inputs are in ``test_errors.py``."""
    parser = doctest.DocTestParser()
    without = [thing for thing in PUBLIC.values() if not parser.get_examples(thing.__doc__ or "")]
    assert [thing for thing in without if not (isinstance(thing, type) and issubclass(thing, InputError))] == []
