"""Measured numbers stand on the pages as benchmarks/figures.toml has them, and what is measured otherwise is told."""

import importlib
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.fixture
def figures(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    return importlib.import_module("figures")


def test_pages_state_what_the_file_has(figures):
    for command in figures.commands():
        for script in re.findall(r"(?:benchmarks|configs)/[\w.]+", command["run"]):
            assert (ROOT / script).is_file()
        for figure in command.get("figure", ()):
            page = figures.squashed((ROOT / figure["page"]).read_text(encoding="utf-8"))
            assert figures.sentence(figure) in page
            assert re.compile(figure["prints"]).groups == len(figures.STATED.findall(figure["says"])) > 0
        for table in command.get("table", ()):
            assert figures.rows(**table)


@pytest.mark.parametrize(
    ("says", "factor", "printed", "told"),
    [
        ("in {1,014} of {1024} runs", None, "1014 of 1024", []),
        ("in {1,014} of {1024} runs", None, "1013 of 1024", ["1,014 is now 1013"]),
        ("at most {2.6·10⁻⁸} of {0.05}", None, "2.64e-08 of 0.0549", []),
        ("at most {2.6·10⁻⁸} of {0.05}", None, "2.66e-08 of 5.0 × 10⁻²", ["2.6·10⁻⁸ is now 2.66e-08"]),
        ("{3.5} and {80} ms", 2, "6.9 of 41", []),
        ("{3.5} and {80} ms", 2, "7.1 of 39", ["3.5 is now 7.1", "80 is now 39"]),
        ("{1} of {2}", None, "nothing", ["not printed any more"]),
    ],
)
def test_a_number_that_is_stated_otherwise_is_found(figures, says, factor, printed, told):
    figure = {"page": "README.md", "says": says, "prints": r"^(.+) of (.+)$"} | ({"factor": factor} if factor else {})
    assert [line.split(": ")[-1] for line in figures.differing({"figure": [figure]}, printed)] == told


def test_a_row_of_a_table_that_is_not_printed_is_found(figures, tmp_path, monkeypatch):
    (tmp_path / "page.md").write_text("| a | b |\n| --- | --- |\n| 1 | 2 |\n| 3 |  |\n\n| 5 | 6 |\n", encoding="utf-8")
    monkeypatch.setattr(figures, "ROOT", tmp_path)
    table = {"page": "page.md", "head": "| a |"}
    assert figures.rows(**table) == ["| 1 | 2 |", "| 3 | |"]
    assert list(figures.differing({"table": [table]}, "| 1 | 2 |\n| 3 |   |\n")) == []
    assert list(figures.differing({"table": [table]}, "| 1 | 7 |\n| 3 |   |\n")) == [
        "page.md: not so any more: | 1 | 2 |"
    ]
