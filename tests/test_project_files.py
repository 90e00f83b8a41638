"""Files that say the same of the project in other words: recipe, workflow, citation."""

import re
import runpy
import shlex
import shutil
import subprocess
import tomllib
from datetime import date
from pathlib import Path

import pytest

from rockbatch import __version__

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
WORKFLOW = (ROOT / ".github" / "workflows" / "tests.yml").read_text(encoding="utf-8")
RECIPE = (ROOT / "docs" / "packaging" / "meta.yaml").read_text(encoding="utf-8")


def test_the_recipe_is_of_this_version_and_needs_what_the_package_needs():
    assert re.search(r'set version = "(.+)"', RECIPE).group(1) == __version__
    run = RECIPE.split("  run:\n")[1].split("\n\n")[0]
    needs = {line.split("- ")[1].replace("matplotlib-base", "matplotlib").replace(" ", "") for line in run.splitlines()}
    stated = {need.lower() for need in PROJECT["dependencies"]} | {"python" + PROJECT["requires-python"]}
    assert needs == stated


def test_the_workflow_tests_every_python_that_is_promised_on_every_system():
    (pythons,) = re.findall(r"python: \[(.+)\]", WORKFLOW)
    promised = [line.split(" :: ")[-1] for line in PROJECT["classifiers"] if re.search(r":: 3\.\d+$", line)]
    assert promised == re.findall(r"\d\.\d+", pythons)
    assert f"for version in {' '.join(promised)};" in (ROOT / "Makefile").read_text(encoding="utf-8")
    assert f"Python {promised[0]} to {promised[-1]}," in (ROOT / "README.md").read_text(encoding="utf-8")
    for system in ("ubuntu", "macos", "windows"):
        assert f"{system}-latest" in WORKFLOW


def test_the_workflow_runs_the_tests_of_make_test_and_all_that_a_checkout_does():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    (marks,), (command,) = re.findall(r"MARKS \?= (.*)", makefile), re.findall(r'pytest (-n .*)"\$\(MARKS\)"', makefile)
    assert f'pytest {command}"{marks}"' in WORKFLOW
    assert "run: bash .ci/run\n" in WORKFLOW
    steps = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert {"run", "lint", "docs", "test"} <= set(re.findall(r"^make (\w+)", steps, re.MULTILINE))
    assert 'make test MARKS="not thorough"\n' in steps
    hooks = (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    for linter in re.findall(r"\$\(BIN\)/(ruff \w+|mypy|lint-imports)", makefile.split("lint:")[1].split("docs:")[0]):
        assert f".venv/bin/{linter}" in hooks


def test_the_workflow_keeps_kernels_by_the_sources_that_they_are_compiled_from():
    assert "ROCKBATCH_CACHE: ${{ github.workspace }}/build/kernels\n" in WORKFLOW
    jobs = WORKFLOW.split("\njobs:\n")[1]
    assert jobs.count("    steps:\n") == jobs.count("path: build/kernels\n") == jobs.count("key: kernels-")
    assert jobs.count("hashFiles('rockbatch/core/**/*.py', 'pyproject.toml')") == jobs.count("key: kernels-")


def test_one_command_writes_a_version_wherever_it_stands(tmp_path):
    script = runpy.run_path(str(ROOT / "docs" / "packaging" / "set_version.py"))
    files = {name: tmp_path / name for name, _, _ in script["PLACES"]}
    for name, file in files.items():
        file.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, file)
    files["CHANGELOG.md"].write_text("# Changelog\n\n## 7.1 (not yet released)\n\n## 7.0.0 (2031-01-01)\n")
    script["set_version"](tmp_path, "7.1.0", date(2031, 5, 6))
    assert files["CHANGELOG.md"].read_text() == "# Changelog\n\n## 7.1.0 (2031-05-06)\n\n## 7.0.0 (2031-01-01)\n"
    for file in set(files.values()) - {files["CHANGELOG.md"]}:
        assert "7.1.0" in file.read_text(encoding="utf-8")
    with pytest.raises(SystemExit, match=r"CHANGELOG\.md: found 0 places"):
        script["set_version"](tmp_path, "7.2.0", date(2031, 7, 8))
    assert "7.1.0" in files["rockbatch/common/version.py"].read_text()


def test_no_pattern_has_a_possessive_group():
    """Python 3.11.2, which Debian 12 has, takes ``1.5E`` for a match of ``(?:\\d\\.\\d(?:E\\d)?+)++``."""
    sources = {path.name: path.read_text(encoding="utf-8") for path in (ROOT / "rockbatch").rglob("*.py")}
    assert {name: found for name, text in sources.items() if (found := re.findall(r".*\)[*+?]\+.*", text))} == {}


def test_no_test_has_a_name_of_more_than_80_characters():
    texts = (path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("*.py"))
    names = [name for text in texts for name in re.findall(r"def (test_\w+)", text)]
    assert len(names) > 2000
    assert [name for name in names if len(name) > 80] == []


@pytest.mark.parametrize(
    ("subject", "passes"), [("Say it once", True), ("x" * 72, True), ("x" * 73, False), ("", False)]
)
def test_the_hook_of_commits_takes_subjects_of_up_to_72_characters(tmp_path, subject, passes):
    hooks = (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8")
    (entry,) = re.findall(r"id: subject\n.*\n +entry: (.+)", hooks)
    message = tmp_path / "message"
    message.write_text(f"{subject}\n\nA body of any length: {'y' * 100}\n", encoding="utf-8")
    assert (subprocess.run([*shlex.split(entry), str(message)], check=False).returncode == 0) == passes
