"""The digest of the program: whatever can change a row, or the runs that come next, takes part in it."""

import ast
import functools
import shutil
from pathlib import Path

import rockbatch
from rockbatch.batch import digests

TOP = Path(rockbatch.__file__).parent


def file_of(module):
    """The file of a module of the package, or None for what is none, such as a name within one."""
    path = TOP.parent.joinpath(*module.split("."))
    return next((file for file in (path.with_suffix(".py"), path / "__init__.py") if file.is_file()), None)


@functools.cache
def imports(file):
    """The files of the package that ``file`` imports, anywhere in it; with a module come the packages around it."""
    found = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        names = []
        if isinstance(node, ast.Import):
            names = [name.name for name in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{file}: a relative import"
            names = [node.module, *(f"{node.module}.{name.name}" for name in node.names)]
        for name in names:
            parts = name.split(".")
            found |= {file_of(".".join(parts[:n])) for n in range(2, len(parts) + 1) if parts[0] == "rockbatch"}
    return found - {None}


def reached(starts):
    """All files that ``starts`` import, directly or through others, and they themselves."""
    found, new = set(), set(starts)
    while new:
        found |= new
        new = set().union(*map(imports, new)) - found
    return found


def starts():
    """What makes a row of a run, and the analyses that ask for runs."""
    plan = TOP / "batch" / "plan.py"
    asking = {file for file in TOP.joinpath("analyses").rglob("*.py") if plan in imports(file)}
    return {TOP / "batch" / "groups.py", TOP / "batch" / "execution.py", *asking}


def test_every_module_that_can_change_a_row_takes_part():
    takes_part = reached(starts())
    for known in (
        "core/springs/equations.py",
        "simulation/error_control.py",
        "pier/block.py",
        "motions/suites/pulses.py",
        "analyses/fragility/ida.py",
    ):
        assert TOP / known in takes_part  # the walk finds its way
    missing = takes_part - set(digests.sources()) - {TOP / "common" / "version.py"}  # names the program; no row has it
    assert not missing, (
        f"these can change a row: strike them from SHOW in rockbatch/batch/digests.py: {sorted(missing)}"
    )


def test_the_digest_is_another_where_a_module_that_takes_part_is(tmp_path, monkeypatch):
    copy = tmp_path / "rockbatch"
    shutil.copytree(TOP, copy, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(digests, "_TOP", copy)
    before = digests.program.__wrapped__()
    assert before == digests.program()
    for module, takes_part in (
        ("core/springs/equations.py", True),
        ("analyses/fragility/ida.py", True),
        ("pier/block.py", True),
        ("common/units.py", True),
        ("reporting/page.py", False),
        ("analyses/fragility/section.py", False),
        ("commands/cli.py", False),
        ("common/version.py", False),
    ):
        with copy.joinpath(module).open("a", encoding="utf-8") as file:
            file.write("\n# a change\n")
        after = digests.program.__wrapped__()
        assert (after != before) == takes_part, module
        before = after
