"""Put small errors into the product, one at a time, and see whether its tests notice.

    make mutants [SEED=1] [COUNT=200]
    python tests/mutants/run.py --seed 1 --count 200 [--only core] [--jobs 2]

Places are drawn at random from all lines that compute (places.py). An error meets first the test files that name most of what its
module defines, then those of the next dozen files about its package, then the slow tests of the nearest files; others may notice
more. It is noticed where a test fails that passes without it, or computes far longer. What is finished is kept in build/mutants
and not done again. An error that changes no answer is listed, with the reason, in equivalent.toml.
"""

import argparse
import ast
import contextlib
import functools
import hashlib
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tomllib
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from tempfile import TemporaryFile
from typing import NamedTuple

import pytest
from places import Mutant, mutants

TOP = Path(__file__).parents[2]
BUILD = TOP / "build" / "mutants"
EQUIVALENT = Path(__file__).with_name("equivalent.toml")
LONGEST = 200
"""Seconds of computing for each file of tests, its kernels included, after which they count as failed."""
TOO_SLOW = "no end"
"""What ends a name of tests that took longer, or were killed."""
NEAREST, MOST = 6, 18
"""Test files that meet an error first, and at all."""
UNCOMPILED = [
    "tests/verification/test_dimensions.py",
    "tests/core/test_free_vibration.py",
    "tests/core/test_trigonometry.py",
]
"""Tests of the core without a run, for which a minute would be compiled anew: errors in the core meet them first."""
TESTS = {
    "core": ("core", "simulation", "verification"),
    "simulation": ("simulation", "batch", "core", "verification"),
    "pier": ("test_pier*.py", "test_statics.py", "verification", "study"),
    "motions/formats": ("motions",),
    "reporting": ("report", "docs"),
    "quantities": ("results", "checks", "analyses/test_quantities.py", "report"),
    "results": ("results", "report", "batch"),
    "checks": ("checks", "results", "report"),
    "toml": ("test_toml.py", "test_units.py", "study"),
    "rockbatch": ("test_python_doors.py", "test_python_pieces.py", "test_doors.py"),
    "commands": (
        "test_cli.py",
        "test_arguments.py",
        "test_doors.py",
        "test_outputs.py",
        "test_hostile_calls.py",
        "checks",
    ),
    "common": (
        *(
            "test_f*.py",
            "test_units.py",
            "test_arguments.py",
            "test_notebooks.py",
            "test_outputs.py",
            "test_interrupts.py",
        ),
        *("test_pier_figures.py", "results", "report", "batch"),
    ),
}
"""Tests of a package, the nearest first, where they are not in a folder of its name."""
NOT_COPIED = (".venv*", "build", "reports", ".git", ".mypy_cache", ".ruff_cache", ".pytest_cache")
PYTEST = "-q", "-x", "--tb=no", "-p", "no:cacheprovider"
FAST, SLOW = "not slow", "slow and not thorough"
BY_SLOW = " (slow)"
"""What ends the name of a slow test where no fast one noticed the error."""


class Place(NamedTuple):
    """A file of the product, by its path from the top, and the error that is put into it."""

    file: str
    mutant: Mutant

    @property
    def package(self) -> str:
        """Return the package of the file; readers of formats count by themselves."""
        parts = self.file.split("/")[1:-1]
        return "/".join(parts) if parts[:2] == ["motions", "formats"] else parts[0] if parts else "rockbatch"

    @property
    def name(self) -> str:
        """Return file, error and line as equivalent.toml has them: they stay the same when lines move."""
        return f"{self.file}: {self.mutant} in {_lines(self.file)[self.mutant.line - 1].strip()}"


@functools.cache
def _lines(file: str) -> list[str]:
    return (TOP / file).read_text(encoding="utf-8").splitlines()


def drawn(seed: int, count: int, only: str = "") -> list[Place]:
    """Return so many places at random, of a package if ``only`` names one."""
    files = sorted(path.relative_to(TOP).as_posix() for path in (TOP / "rockbatch").rglob("*.py"))
    every = [Place(file, mutant) for file in files for mutant in mutants((TOP / file).read_text(encoding="utf-8"))]
    chosen = [place for place in every if not only or place.package == only]
    return random.Random(seed).sample(chosen, min(count, len(chosen)))


def _digest(*folders: str) -> str:
    paths = (path for folder in folders for path in sorted((TOP / folder).rglob("*.py")))
    read = (path.read_bytes() for path in paths if path.parent != Path(__file__).parent)
    return hashlib.sha256(b"".join(read)).hexdigest()[:12]


def copied(number: int) -> Path:
    """Return a copy of the project in which errors may be made; kernels that an earlier one compiled stay in it."""
    copy = BUILD / f"copy-{number}"
    for path in copy.rglob("*.py"):
        path.unlink()
    shutil.copytree(TOP, copy, dirs_exist_ok=True, ignore=shutil.ignore_patterns(*NOT_COPIED))
    return copy


def tests_of(place: Place) -> list[tuple[str, list[str]]]:
    """Return test files, each time with the mark of the tests in them that run.

    First are fast tests of the files that name most of what the module of the error defines, then those of further ones.
    """
    folders = TESTS.get(place.package, (place.package,))
    path, order = TOP / place.file, dict[Path, int]()
    for i, name in enumerate(folders):
        for found in (TOP / "tests").glob(name):
            for test in found.rglob("test_*.py") if found.is_dir() else [found]:
                order.setdefault(test, i)
    names = {path.stem} | {name for name in _defined(path) if not name.startswith("_")}

    def nearness(test: Path) -> tuple[int, str]:
        words = set(re.findall(r"\w+", test.read_text(encoding="utf-8")))
        shared = len({*path.parts} & {*test.parts}) + 2 * (path.stem in test.stem)  # of folders, and the name itself
        return 2 * order[test] - len(names & words) - 3 * shared, str(test)

    tests = [test.relative_to(TOP).as_posix() for test in sorted(order, key=nearness)]
    first = UNCOMPILED if place.package == "core" else []
    tests = [test for test in tests if test not in first]
    stages = (FAST, first), (FAST, tests[:NEAREST]), (FAST, tests[NEAREST:MOST]), (SLOW, tests[:NEAREST])
    return [(mark, chosen) for mark, chosen in stages if chosen]


def _defined(path: Path) -> Iterator[str]:
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        match node:
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                yield name
            case ast.Assign(targets=[ast.Name(id=name)]) | ast.AnnAssign(target=ast.Name(id=name)):
                yield name


def noticed_by(place: Place, copy: Path, sound: set[str]) -> str:
    """Return the test that fails with the error in a copy of the project, and passes without it; "" if none does.

    ``sound`` are tests that are known to pass without an error; this adds to them.
    """
    for mark, tests in tests_of(place):
        unsound: list[str] = []
        while True:
            with _error_in(copy, place):
                failed = _failure(mark, [*tests, *(f"--deselect={test}" for test in unsound)], copy)
            if not failed or failed in unsound:
                break
            if failed in sound or failed.endswith(TOO_SLOW) or not _failure(mark, [failed], copy):
                sound.add(failed)
                return failed + BY_SLOW * (mark == SLOW)
            unsound.append(failed)
    return ""


@contextlib.contextmanager
def _error_in(copy: Path, place: Place) -> Iterator[None]:
    path, compiled = copy / place.file, copy / "rockbatch/core/__pycache__"
    source, times, kernels = path.read_text(encoding="utf-8"), path.stat(), set(compiled.glob("kernels-*"))
    path.write_text(place.mutant.put_into(source), encoding="utf-8")
    try:
        yield
    finally:
        path.write_text(source, encoding="utf-8")
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
        for wrong in set(compiled.glob("kernels-*")) - kernels:
            if place.file.startswith("rockbatch/core/"):
                shutil.rmtree(wrong)


def _failure(mark: str, chosen: list[str], copy: Path) -> str:
    """Return the test, of those ``chosen`` that have a mark, that fails in a copy of the project; "" if none does."""
    limited = ["sh", "-c", 'ulimit -t "$0" && exec "$@"', str(limit := LONGEST * len(chosen))]
    with TemporaryFile("w+", encoding="utf-8", errors="replace") as output:
        process = subprocess.Popen(
            [*limited, sys.executable, "-m", "pytest", *PYTEST, "-m", mark, *chosen], cwd=copy, stdout=output, stderr=output,
            env=os.environ | {"PYTHONPATH": str(copy), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}, start_new_session=True,
        )  # fmt: skip
        try:
            code = process.wait(10 * limit)
        except subprocess.TimeoutExpired:
            code = -signal.SIGXCPU
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        output.seek(0)
        failed = [line.split(" ", 1)[1].split(" - ")[0] for line in output if line.startswith(("FAILED", "ERROR "))]
    if code in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
        return ""
    if code == pytest.ExitCode.USAGE_ERROR and "::" in chosen[0]:  # a test has another name with the error
        return ""
    return failed[0].strip() if failed else f"{chosen[0]}: {TOO_SLOW}"


def judged(places: list[Place], copies: list[Path]) -> Iterator[tuple[Place, str]]:
    """Yield each place, and what notices its error; what earlier calls found with this product is kept.

    What survived meets the tests again if there are others.
    """
    journal, tests = BUILD / f"judged-{_digest('rockbatch')}.jsonl", _digest("tests")
    entries = map(json.loads, journal.read_text(encoding="utf-8").splitlines() if journal.exists() else [])
    known = {
        (entry["place"], entry["line"]): entry["noticed_by"]
        for entry in entries
        if entry["noticed_by"] or entry["tests"] == tests
    }
    sound = {name.removesuffix(BY_SLOW) for name in known.values() if name}
    free: Queue[Path] = Queue()
    for copy in copies:
        free.put(copy)

    def judge(place: Place) -> str:
        key = place.name, place.mutant.line
        if key in known:
            return str(known[key])
        copy = free.get()
        try:
            found = noticed_by(place, copy, sound)
        finally:
            free.put(copy)
        entry = {"place": place.name, "line": place.mutant.line, "noticed_by": found, "tests": tests}
        with journal.open("a", encoding="utf-8") as file:
            file.write(json.dumps(entry, ensure_ascii=False) + "\n")
        return found

    with ThreadPoolExecutor(len(copies)) as pool:
        yield from zip(places, pool.map(judge, places), strict=True)


def main() -> int:
    """Print what is noticed and what survives, by packages."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--only", default="", metavar="PACKAGE")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    chosen = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    # To compile the libraries and pytest's plugins takes longer than most tests
    os.environ |= {"PYTHONDONTWRITEBYTECODE": "", "PYTHONPYCACHEPREFIX": str(BUILD / "bytecode")}
    equivalent = tomllib.loads(EQUIVALENT.read_text(encoding="utf-8")) if EQUIVALENT.exists() else {}
    counts: dict[str, Counter[str]] = {}
    places = drawn(chosen.seed, chosen.count, chosen.only)
    copies = [copied(number) for number in range(chosen.jobs)]
    for place, found in judged(places, copies):
        kind = "noticed" if found else "equivalent" if place.name in equivalent else "survived"
        if not found or found.endswith((TOO_SLOW, BY_SLOW)):
            print(f"{kind}: {place.file}:{place.mutant.line}: {place.mutant} {found}", flush=True)
        for package in (place.package, "all"):
            counts.setdefault(package, Counter()).update([kind, BY_SLOW] if found.endswith(BY_SLOW) else [kind])
    print(
        f"\nseed {chosen.seed}\n{'package':20} {'noticed':>8} {'only by slow':>13} {'equivalent':>11} {'survived':>9}  rate"
    )
    for package, count in sorted(counts.items(), key=lambda item: (item[0] == "all", item[0])):
        matter = count["noticed"] + count["survived"]
        rate = f"{count['noticed'] / matter:.0%}" if matter else ""
        print(
            f"{package:20} {count['noticed']:8} {count[BY_SLOW]:13} {count['equivalent']:11} {count['survived']:9}  {rate}"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
