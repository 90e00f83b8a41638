"""Mistakes are values, caught by their class: each class has a real input, and no code reads a message back."""

import ast
import pickle
from pathlib import Path

import pytest
from studies import RIGID, SINE, study_text, write_study

import rockbatch as rb
from rockbatch.common import errors
from rockbatch.common.errors import InputError, Problem, refuse
from rockbatch.study import load_study

TOP = Path(rb.__file__).parent
"""The package."""


def classes(kind=InputError):
    """All classes of errors below one, and itself."""
    own = [below for below in kind.__subclasses__() if not below.__name__.startswith("_")]
    return [kind, *(further for below in own for further in classes(below))]


def study(folder, text=None, **keys):
    """Load a study with such keys, or such a text, which raises what is wrong."""
    load_study(write_study(folder, study_text(pulses=[SINE], cases=[RIGID], **keys) if text is None else text))


def record(folder, name, text):
    """Raise the error by which the only file of a folder is refused."""
    (folder / "records").mkdir()
    (folder / "records" / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    (file,) = rb.read_motions(folder / "records").unusable
    raise file.kind(file.reason)


WHOLE = "NPTS=   8, DT= .0100 SEC\n 0.1 0.2 0.3 0.4\n 0.5 0.6 0.7 0.8\n"
HEAD = "PEER NGA STRONG MOTION DATABASE RECORD\nImperial Valley, 1940, El Centro, 180\nACCELERATION TIME SERIES IN UNITS OF G\n"
NOWHERE = HEAD.replace(", 180", "")
NUMBERS = "".join(f"{0.01 * n:.2f} {0.1 * (-1) ** n:.4f}\n" for n in range(60))
INPUTS = {
    rb.UnknownKey: lambda folder: study(folder, pier={"alpha": 0.2, "p": 1.0, "colour": 3}),
    rb.MissingKey: lambda folder: rb.ElasticBase.from_stiffness(rb.Pier(alpha=0.2, p=1.0), 2e6),
    rb.WrongType: lambda folder: rb.Pier(alpha="steep", p=1.0),
    rb.OutOfRange: lambda folder: rb.Pier(alpha=7.4, p=0.0),
    rb.Unusual: lambda folder: rb.Pier.rectangle(8000.0, 30000.0),
    rb.Contradiction: lambda folder: rb.ElasticBase(beta=40.0, zeta=0.05, epsilon=0.5),
    rb.NotFound: lambda folder: load_study(folder / "none.toml"),
    rb.BadSyntax: lambda folder: study(folder, "[pier\n"),
    rb.UnknownFormat: lambda folder: record(folder, "x.AT2", "a story\n"),
    rb.NoRecord: lambda folder: record(folder, "x.txt", "# period(s) Sa(g)\n" + "0.1 0.2\n0.2 0.3\n0.5 0.4\n" * 9),
    rb.Truncated: lambda folder: record(folder, "x180.AT2", HEAD + WHOLE.replace("  8,", " 80,")),
    rb.NoUnit: lambda folder: record(folder, "x.txt", "# time(s) acc\n" + NUMBERS),
    rb.NoStep: lambda folder: record(folder, "x.txt", "# NS(cm/s2) EW(cm/s2)\n" + NUMBERS.replace("0.00 ", "0.02 ")),
    rb.NoDirection: lambda folder: record(folder, "x.AT2", NOWHERE + WHOLE),
}
"""A real input for each class; the others are above several."""


@pytest.mark.parametrize("kind", INPUTS, ids=lambda kind: kind.__name__)
def test_a_kind_of_mistake_is_caught_by_its_class(tmp_path, kind):
    with pytest.raises(InputError) as caught:
        INPUTS[kind](tmp_path)
    assert type(caught.value) is kind
    assert {problem.kind for problem in caught.value.problems} == {kind}


def test_every_class_has_an_input_is_public_and_stands_in_the_tree():
    assert {kind for kind in classes() if len(classes(kind)) == 1} == set(INPUTS)
    tree = errors.__doc__
    for kind in classes():
        assert getattr(rb, kind.__name__) is kind
        assert f" {kind.__name__} " in tree


def test_several_mistakes_are_raised_as_the_class_they_share():
    no_unit, no_step = Problem("", None, "a", kind=rb.NoUnit), Problem("", None, "b", kind=rb.NoStep)
    with pytest.raises(rb.Unstated) as caught:
        refuse([no_unit, no_step])
    assert type(caught.value) is rb.Unstated
    assert caught.value.problems == (no_unit, no_step)
    with pytest.raises(InputError) as caught:
        refuse([no_unit, "c"])
    assert type(caught.value) is InputError
    assert [problem.kind for problem in caught.value.problems] == [rb.NoUnit, InputError]
    refuse([])


def test_a_problem_says_where_what_and_how_it_is_confirmed():
    problem = Problem("width_m", 8000.0, "more than 400 m", "pier.toml:3", confirm="width_m")
    assert str(problem) == (
        'pier.toml:3: width_m = 8000: more than 400 m; check the unit; if it is right, write confirm = ["width_m"]'
    )
    assert str(Problem("spring", "x", "must be one")) == 'spring = "x": must be one'
    assert str(Problem("parts", None, "there are none")) == "parts: there are none"
    assert str(Problem("eta", 2.0, "eta and yield_kN are given", named=False)) == "eta and yield_kN are given"


def test_a_mistake_in_a_file_has_its_key_its_value_and_its_place(tmp_path):
    with pytest.raises(rb.OutOfRange) as caught:
        study(tmp_path, pier={"alpha": 7.4, "p": 1.0})
    (problem,) = caught.value.problems
    assert (problem.key, problem.value, problem.kind) == ("pier.alpha", 7.4, rb.OutOfRange)
    assert problem.place.startswith(f"{tmp_path / 'study.toml'}:")


@pytest.mark.parametrize("error", [rb.NoUnit("a"), rb.Unstated("a", keys=("layout",)), rb.NoRecord("b", station="S")])
def test_an_error_comes_whole_from_another_process(error):
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), vars(again)) == (type(error), vars(error))


MESSAGES = {"problem", "problems", "message", "messages", "complaint", "refusal", "advice"}
"""Names of what is said of a mistake."""
TESTS = {
    "startswith",
    "endswith",
    "split",
    "rsplit",
    "partition",
    "rpartition",
    "replace",
    "removeprefix",
    "removesuffix",
    "find",
}


def _name(node):
    if isinstance(node, ast.Subscript):
        return _name(node.value)
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def read_back(tree):
    """Lines of a module in which a message is searched, cut or changed: its methods, and texts that are looked for in it."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in TESTS:
            if _name(node.func.value) in MESSAGES:
                yield node.lineno
        elif isinstance(node, ast.Compare) and any(isinstance(op, ast.In | ast.NotIn) for op in node.ops):
            looked_for = isinstance(node.left, ast.Constant | ast.JoinedStr) and isinstance(
                getattr(node.left, "value", ""), str
            )
            if looked_for and any(_name(place) in MESSAGES for place in node.comparators):
                yield node.lineno


def test_no_message_is_read_back_to_decide():
    places = [TOP, TOP.parent / "docs", TOP.parent / "benchmarks"]
    found = {
        f"{path.relative_to(TOP.parent)}:{line}"
        for place in places
        for path in place.rglob("*.py")
        for line in read_back(ast.parse(path.read_text(encoding="utf-8")))
    }
    assert found == {
        f"rockbatch/commands/cli.py:{line}" for line in _ending_line()
    }  # of argparse, where a question ends it


def _ending_line():
    lines = (TOP / "commands" / "cli.py").read_text(encoding="utf-8").splitlines()
    return [n for n, line in enumerate(lines, 1) if 'message.endswith("?")' in line]


@pytest.mark.parametrize(
    "code",
    [
        '"beta" in problem',
        'problem.startswith("beta")',
        'error.messages[0].split(": ")',
        'f"{x} = " not in problem.text.message',
    ],
)
def test_what_reads_a_message_is_found(code):
    assert list(read_back(ast.parse(code))) == [1]
