"""An analysis is one folder and one name in a tuple: each is taken away, and another added, in a copy of the package."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from studies import PIER, RIGID, SINE, study_text, write_study

import rockbatch
from rockbatch.commands.cli import parser
from rockbatch.common.analyses import ANALYSES, doors

TOP = Path(rockbatch.__file__).parent

LOOK = """
import sys
import rockbatch
from rockbatch.commands.cli import parser
from rockbatch.reporting.page import PARTS
from rockbatch.study.schema import FILES, schema_of
print(parser().format_help())
print(*rockbatch.__all__)
print(*(part.heading for part in PARTS), sep=" | ")
for name, sections in FILES.items():
    print(schema_of(sections, name))
"""
"""Prints what users see of analyses: commands, public names, parts of the report, tables of the study."""


@pytest.fixture
def copied(tmp_path):
    shutil.copytree(TOP, tmp_path / "rockbatch", ignore=shutil.ignore_patterns("*.nb[ci]"))  # compiled kernels
    return tmp_path


def python(place, *arguments):
    """What Python prints with the copy; it has to end well."""
    done = subprocess.run(
        [sys.executable, *arguments], cwd=place, env=os.environ | {"PYTHONPATH": str(place)}, text=True,
        capture_output=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def write_tuple(place, names):
    """Write the one line that lists the analyses."""
    path = place / "rockbatch" / "common" / "analyses.py"
    text = path.read_text(encoding="utf-8")
    line = next(line for line in text.splitlines() if line.startswith("ANALYSES = "))
    path.write_text(text.replace(line, f"ANALYSES = {tuple(names)!r}"), encoding="utf-8")


def test_every_analysis_is_seen():
    commands = {name for name in ANALYSES if f"\n  {name} " in parser().format_help()}
    assert commands == {name for name, door in doors().items() if door.help} == {*ANALYSES} - {"release"}
    assert {*ANALYSES} < {*rockbatch.__all__}


@pytest.mark.slow
@pytest.mark.parametrize("name", [ANALYSES[0], *(pytest.param(name, marks=pytest.mark.slow) for name in ANALYSES[1:])])
def test_an_analysis_is_deleted_with_its_folder_and_its_name(copied, name):
    shutil.rmtree(copied / "rockbatch" / "analyses" / name)
    write_tuple(copied, [other for other in ANALYSES if other != name])
    study = write_study(copied, study_text(pier=PIER, pulses=[SINE], cases=[RIGID]))
    run = f"\nfrom rockbatch.commands.cli import main\nassert main(['statics', {str(study)!r}]) == 0"
    after, _, statics = python(copied, "-c", f"{LOOK}print('statics:'){run}").rpartition("statics:\n")
    assert f"\n  {name} " not in after
    assert f", by `rockbatch {name}`: " not in after
    assert name not in after.splitlines()[-5].split()
    assert all(other in after for other in ANALYSES if other != name)
    assert "rigid" in statics


@pytest.mark.slow
def test_an_analysis_is_added_with_a_folder_and_a_name(copied):
    folder = copied / "rockbatch" / "analyses" / "census"
    folder.mkdir()
    (folder / "__init__.py").write_text(
        "from rockbatch.common.analyses import Door\n"
        "from rockbatch.common.slices import ReportPart\n"
        'DOOR = Door(help="count cases", example="rockbatch census pier.toml", writes="",\n'
        '            parts=(ReportPart("Census", "census"),), tables=("census",))\n'
    )
    (folder / "study.py").write_text(
        "from rockbatch.toml.kinds import boolean\n"
        "from rockbatch.toml.section import Key, Section\n"
        'SECTIONS = (Section(("census",), "A count.", {"all": Key(boolean, "true", "Whether all are counted.")}),)\n'
    )
    (folder / "analysis.py").write_text("def census(study):\n    return len(study.cases)\n")
    (folder / "command.py").write_text(
        'def main(arguments, study):\n    import rockbatch\n    print(rockbatch.census(study), "cases")\n    return 0\n'
    )
    (folder / "section.py").write_text(
        "from rockbatch.reporting.markup import tag\ndef section(contents):\n    return tag('p', 'one census')\n"
    )
    write_tuple(copied, [*ANALYSES, "census"])
    text = study_text(pier=PIER, pulses=[SINE], cases=[RIGID], census={"all": True})
    study = write_study(copied, text)
    (copied / "census.json").write_text("{}")
    more = f"""
from pathlib import Path
from rockbatch.commands.cli import main
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.reporting.page import page
print(page(Contents(Path("."), {{"title": "t", "notes": "", "text": "", "sha256": "x", "path": "x"}})))
main(["census", {str(study)!r}])
"""
    seen = python(copied, "-c", LOOK + more)
    assert "\n  census " in seen
    assert " Census" in seen
    assert "one census" in seen
    assert seen.endswith("\n1 cases\n")
