"""What the last release promised (docs/pages/stability.md) is all there; only additions pass."""

import copy
import json
from pathlib import Path

import pytest
from surface import surface, taken_away

RELEASES = Path(__file__).parent / "stable"
PRESENT = surface()


def promised():
    """The file of the last release."""
    last = max(RELEASES.glob("*.json"), key=lambda path: [int(part) for part in path.stem.split(".")])
    return json.loads(last.read_text(encoding="utf-8"))


def test_nothing_that_the_last_release_promised_is_gone():
    assert taken_away(promised(), PRESENT) == []


@pytest.mark.parametrize(
    ("group", "name", "parts", "lost"),
    [
        ("python", "check", ["results", "*", "study=", "motions="], ["rules is gone"]),
        ("python", "check", ["results", "*", "rules=", "study=", "motions="], ["results, rules stand otherwise"]),
        ("python", "check", ["rules=", "results", "*", "study=", "motions="], ["results, rules stand otherwise"]),
        ("python", "check", ["results", "rules", "*", "study=", "motions="], ["rules has to be given"]),
        ("python", "check", ["results", "rules=", "*", "study=", "motions=", "folder"], ["folder has to be given"]),
        ("python", "check", ["results=", "rules=", "more=", "*", "study=", "motions=", "folder="], []),
        ("commands", "report", ["DIR", "OTHER=", "*", "--pair=", "--all=", "--paper=", "--sheet="], ["--out is gone"]),
        (
            "commands",
            "report",
            ["DIR", "OTHER", "*", "--out=", "--pair=", "--all=", "--paper=", "--sheet="],
            ["OTHER has to be given"],
        ),
        (
            "commands",
            "report",
            ["DIR", "OTHER=", "*", "--out=", "--pair=", "--all=", "--paper=", "--sheet=", "--pdf="],
            [],
        ),
        ("keys", "study.case.base", ["rigid", "elastic", "footing"], ["yielding"]),
        ("keys", "study.case.base", ["rigid", "elastic", "yielding", "footing", "pile"], []),
        ("keys", "study.case.beta", ["40", "80"], ["only 40", "only 80"]),
    ],
)
def test_what_breaks_a_script_differs_from_an_addition(group, name, parts, lost):
    changed = copy.deepcopy(PRESENT)
    changed[group][name] = parts
    assert taken_away(PRESENT, changed) == [f"{group}: {name}: {part}" for part in lost]


@pytest.mark.parametrize("group", PRESENT)
def test_a_name_that_goes_is_reported(group):
    changed = copy.deepcopy(PRESENT)
    name = next(iter(changed[group]))
    del changed[group][name]
    assert taken_away(PRESENT, changed) == [f"{group}: {name}"]
    assert taken_away(changed, PRESENT) == []
