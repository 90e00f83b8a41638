"""The tool that puts small errors into the product: which errors, and that a test is seen to notice one."""

import ast
import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import rockbatch.pier.restraints

TOOL = Path(__file__).parent / "mutants"
PRODUCT = "rockbatch"


@pytest.fixture(autouse=True)
def importable(monkeypatch):
    monkeypatch.syspath_prepend(str(TOOL))
    yield
    for name in ("places", "run", "judging", "recording"):
        sys.modules.pop(name, None)


def test_errors_are_of_signs_comparisons_numbers_conditions_and_swaps():
    from places import mutants

    source = (
        'def f(x: int = 2) -> "a < b":\n'
        '    """1 < 2"""\n'
        "    if x <= 0.5 and not g(x, y):\n"
        '        raise ValueError(f"{x + 1} < 2")\n'
        "    sum(zip(x, strict=True), 1e-9)\n"
        "    return max(x, y) - 3\n"
    )
    assert [str(mutant) for mutant in mutants(source)] == [
        "2 → (3)",
        "x <= 0.5 and not g(x, y) → (x <= 0.5 or not g(x, y))",
        "x <= 0.5 and not g(x, y) → (not g(x, y))",
        "x <= 0.5 and not g(x, y) → (x <= 0.5)",
        "x <= 0.5 → (x < 0.5)",
        "0.5 → (0.55)",
        "not g(x, y) → (g(x, y))",
        "g(x, y) → (g(y, x))",
        "sum(zip(x, strict=True), 1e-9) → pass",
        "max(x, y) - 3 → (max(x, y) + 3)",
        "max(x, y) → (min(x, y))",
        "3 → (4)",
    ]


def test_errors_are_of_statements_functions_columns_thousands_and_messages():
    from places import mutants

    source = (
        "def f(table, found):\n"
        '    """Add it."""\n'
        "    found.add(table)\n"
        '    found["peak"] = 1e3 * table["first"].min()\n'
        "    for each in found:\n"
        "        continue\n"
        "    if found.startswith(table):\n"
        '        raise ValueError(f"{found} of {table:.3g}: {found}")\n'
        '    return f"{table}"\n'
    )
    assert [str(mutant) for mutant in mutants(source)] == [
        "found.add(table) → pass",
        "found.add(table) → (found.discard(table))",
        'found["peak"] = 1e3 * table["first"].min() → pass',
        "found[\"peak\"] → (found['first'])",
        "1e3 * table[\"first\"].min() → (1000.0 / table['first'].min())",
        "1e3 → (1100.0)",
        "1e3 → (1.0)",
        "table[\"first\"].min() → (table['first'].max())",
        "table[\"first\"] → (table['peak'])",
        "continue → pass",
        "found.startswith(table) → (found.endswith(table))",
        "f\"{found} of {table:.3g}: {found}\" → (f'{table:.3g} of {found}: {found}')",
        "f\"{found} of {table:.3g}: {found}\" → (f'{found} of {found}: {table:.3g}')",
    ]


def test_every_error_leaves_a_program_and_another_one():
    from places import mutants

    source = Path(rockbatch.pier.restraints.__file__).read_text(encoding="utf-8")
    whole = ast.dump(ast.parse(source))
    errors = list(mutants(source))
    assert len(errors) > 50
    for error in errors[::5]:
        assert ast.dump(ast.parse(error.put_into(source))) != whole


SMALL = """
LIMIT = 3
HALVES = [x / 2 for x in (10, 11)]
RATIO = 12 / (13 - 14)
def double(x):
    return x + x
DOUBLES = [double(x) for x in HALVES]
def small(x):
    return x < LIMIT
def stopped(x):
    while x < 5:
        x += 1
    return x
class Few:
    def all_small(self, values):
        return all(small(x) for x in values if x > 4)
"""
TESTS = """
import pytest, sys
from few import DOUBLES, HALVES, Few, small, stopped
def test_halves(): assert HALVES == [5.0, 5.5]
def test_doubles(): assert DOUBLES == [10.0, 11.0]
def test_small(): assert small(1) and not small(9)
def test_few(): assert Few().all_small([1, 2]) and not Few().all_small([5, 1])
def test_stopped(): assert stopped(0) == 5
def test_unsound(): assert not small(1) and Few().all_small([1])
"""


JUDGED = {
    "x < LIMIT → (x <= LIMIT)": (["small", "few"], ""),
    "x > 4 → (x >= 4)": (["small", "few"], ""),
    "x < 5 → (x <= 5)": (["small", "stopped"], "stopped"),
    "4 → (5)": (["unsound", "few"], "few"),  # in a generator in a method
    "3 → (4)": (["unsound", "small"], ""),  # when it is imported
    "x / 2 → (x * 2)": (["small", "halves"], "halves"),
    "x + x → (x - x)": (["small", "doubles"], "doubles"),  # in a function that only runs then
    "13 → (14)": (["small"], "test_few.py"),  # which cannot be imported
    "1 → (2)": (["stopped"], "stopped"),
}
"""Errors, the tests that they meet, and which notices them."""


@pytest.mark.thorough
def test_an_error_is_noticed_by_a_sound_test_that_fails_with_it(tmp_path):
    from places import mutants

    (tmp_path / "few.py").write_text(SMALL)
    os.utime(
        tmp_path / "few.py", (0, 1)
    )  # older than any error: Python takes a file of the same second and length for the same
    (tmp_path / "test_few.py").write_text(TESTS)
    wrong = {str(mutant): mutant.put_into(SMALL) for mutant in mutants(SMALL)}
    requests = [
        {
            "file": "few.py",
            "wrong": wrong[error],
            "tests": [[f"test_few.py::test_{name}" for name in tests]],
            "at_import": "x + x" in error,
        }
        for error, (tests, _) in JUDGED.items()
    ]
    process = subprocess.run(
        [sys.executable, TOOL / "judging.py", "."], input="\n".join(map(json.dumps, requests)), cwd=tmp_path, text=True,
        env=os.environ | {"PYTHONPATH": str(tmp_path)}, capture_output=True,
    )  # fmt: skip
    answers = [json.loads(line).removeprefix("test_few.py::test_") for line in process.stdout.splitlines()]
    assert dict(zip(JUDGED, answers, strict=True)) == {error: noticed for error, (_, noticed) in JUDGED.items()}
    assert (tmp_path / "few.py").read_text() == SMALL


def test_an_error_in_a_constant_meets_first_the_tests_that_name_it(tmp_path):
    from places import mutants
    from recording import Record
    from run import Place, tests_of

    files = [tmp_path / "tests" / f"test_{name}.py" for name in "ab"]
    files[0].parent.mkdir()
    files[0].write_text("MOST_STEPS_RECORDED, STEPS\n")
    files[1].write_text('"{MOST_STEPS}"\n')
    a, b = (file.relative_to(tmp_path).as_posix() for file in files)
    record = Record.__new__(Record)
    record.top, record.seconds = tmp_path, {f"{a}::test_other": 0.1, f"{b}::test_long": 2.0, f"{b}::test_short": 0.2}
    record.tests_of, record.nearest = lambda file, lines: [], lambda file, count: [f"{a}::test_other"]
    file = "rockbatch/motions/limits.py"
    source = (TOOL.parents[1] / file).read_text(encoding="utf-8")
    met = {str(error): tests_of(Place(file, error), record, 9.0)[0] for error in mutants(source)}
    assert met["20 → (21)"] == [f"{b}::test_short", f"{b}::test_long", f"{a}::test_other"]
    assert met["0.01 → (0.011000000000000001)"] == [f"{a}::test_other"]


@pytest.mark.thorough
def test_errors_are_drawn_from_all_packages_and_equivalent_ones_still_fit():
    from run import EQUIVALENT, drawn

    places = drawn(seed=1, count=sys.maxsize)
    assert len({place.package for place in places[:100]}) > 10
    assert set(tomllib.loads(EQUIVALENT.read_text(encoding="utf-8"))) <= {place.name for place in places}


@pytest.mark.thorough
def test_draws_of_one_package_and_of_all_others_are_disjoint():
    from run import drawn

    terminal = {place.name for place in drawn(8, sys.maxsize, only="terminal")}
    others = drawn(8, 2000, without="terminal")
    assert {name.split("/")[1] for name in terminal} == {"terminal"}
    assert len({place.package for place in others}) > 10
    assert not terminal & {place.name for place in others}
