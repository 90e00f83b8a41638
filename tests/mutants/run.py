"""Put small errors into the product, one at a time, and see whether the tests of CI notice.

    make mutants [SEED=1] [COUNT=200]
    python tests/mutants/run.py --seed 1 --count 200 [--only core | --without core] [--jobs 2] [--fast] [--seconds 180]

Places are drawn at random from all lines that compute (places.py). The tests of CI run once, to record which of them runs which
line (recording.py); an error meets those that run its line, three minutes of them, or those whose file names its constant and
those that run anything of its module, if it is in what only runs when this is imported (judging.py). It is noticed where a test
fails that passes without it, or computes far longer. Errors in the core meet tests without the compiler, of a few seconds each;
with ``--fast``, no error meets a slow test.
What is finished is kept in build/mutants and not done again. An error that changes no answer is listed, with the reason, in
equivalent.toml.
"""

import argparse
import ast
import functools
import hashlib
import json
import os
import random
import shutil
import subprocess
import sys
import tomllib
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from typing import NamedTuple

from judging import TOO_SLOW
from places import Mutant, mutants
from recording import FAST, MARKS, PHYSICS, Record, marks
from scipy.stats import binomtest

TOP = Path(__file__).parents[2]
BUILD = TOP / "build" / "mutants"
EQUIVALENT = Path(__file__).with_name("equivalent.toml")
FIRST = 40
"""Tests that an error meets first."""
OF_MODULE = 150
"""Tests that run most of a module, which an error in what runs when it is imported meets before others that run any of it, and
one that few tests run meets, too."""
OF_SOURCES = "tests/test_limits.py"
"""Tests that read the sources instead of running them: every error meets them."""
NOT_COPIED = (".venv*", "build", "reports", ".git", ".mypy_cache", ".ruff_cache", ".pytest_cache")


class Place(NamedTuple):
    """A file of the product, by its path from the top, and the error that is put into it."""

    file: str
    mutant: Mutant

    @property
    def package(self) -> str:
        """Return the package of the file."""
        return _package(self.file)

    @property
    def name(self) -> str:
        """Return file, error and line as equivalent.toml has them: they stay the same when lines move."""
        return f"{self.file}: {self.mutant} in {_lines(self.file)[self.mutant.line - 1].strip()}"

    @property
    def lines(self) -> range:
        """Return the lines on which the error is."""
        return range(self.mutant.line, self.mutant.line + self.mutant.before.count("\n") + 1)


def _package(file: str) -> str:
    """Return the package of a file; readers of formats count by themselves."""
    parts = file.split("/")[1:-1]
    return "/".join(parts) if parts[:2] == ["motions", "formats"] else parts[0] if parts else "rockbatch"


@functools.cache
def _lines(file: str) -> list[str]:
    return (TOP / file).read_text(encoding="utf-8").splitlines()


def drawn(seed: int, count: int, only: str = "", without: str = "") -> list[Place]:
    """Return so many places at random, of one package or of all others if one is named."""
    files = sorted(path.relative_to(TOP).as_posix() for path in (TOP / "rockbatch").rglob("*.py"))
    asked = [file for file in files if _package(file) != without and (not only or _package(file) == only)]
    places = [Place(file, mutant) for file in asked for mutant in mutants((TOP / file).read_text(encoding="utf-8"))]
    return random.Random(seed).sample(places, min(count, len(places)))


def _digest(*folders: str) -> str:
    paths = (path for folder in folders for path in sorted((TOP / folder).rglob("*.py")))
    read = (path.read_bytes() for path in paths if path.parent != Path(__file__).parent)
    return hashlib.sha256(b"".join(read)).hexdigest()[:12]


def copied(number: int) -> Path:
    """Return a copy of the project in which errors may be made."""
    copy = BUILD / f"copy-{number}"
    for path in copy.rglob("*.py"):
        path.unlink()
    shutil.copytree(TOP, copy, dirs_exist_ok=True, ignore=shutil.ignore_patterns(*NOT_COPIED))
    return copy


def tests_of(place: Place, record: Record, longest: float) -> list[list[str]]:
    """Return the tests that an error meets first and those that it meets then, which took so many seconds without it."""
    tests = record.tests_of(place.file, place.lines)
    if not tests:
        tests = record.naming(_constants(place))
        tests += [test for test in record.nearest(place.file, OF_MODULE) if test not in tests]
        tests += [test for test in record.nearest(place.file, len(record.seconds)) if test not in tests]
    elif 0 < len(tests) < FIRST:  # of a function that keeps its results, only the first test runs the lines
        tests += [test for test in record.nearest(place.file, OF_MODULE) if test not in tests]
    rest, seconds = [], 0.0
    for test in sorted(tests[FIRST:], key=record.seconds.__getitem__):
        seconds += record.seconds[test]
        if seconds < longest:
            rest.append(test)
    of_sources = [test for test in record.seconds if test.startswith(OF_SOURCES)]
    return [stage for stage in (tests[:FIRST], of_sources, rest) if stage]


def _constants(place: Place) -> set[str]:
    """Return the names that are bound where the error is."""
    statements = ast.parse("\n".join(_lines(place.file))).body
    bound = (
        node
        for node in statements
        if isinstance(node, ast.Assign) and place.mutant.line in range(node.lineno, (node.end_lineno or 0) + 1)
    )
    return {
        name.id for node in bound for target in node.targets for name in ast.walk(target) if isinstance(name, ast.Name)
    }


def judged(
    places: list[Place], record: Record, copies: list[Path], longest: float, uncompiled: bool = False
) -> Iterator[tuple[Place, str]]:
    """Yield each place, and what notices its error; what earlier calls found with this product is kept.

    What survived meets the tests again if there are others.
    """
    journal, tests = BUILD / f"judged-{_digest('rockbatch')}.jsonl", f"{_digest('tests')} {marks()}"
    entries = map(json.loads, journal.read_text(encoding="utf-8").splitlines() if journal.exists() else [])
    known = {
        (entry["place"], entry["line"]): entry["noticed_by"]
        for entry in entries
        if entry["noticed_by"] or entry["tests"] == tests
    }
    free: Queue[subprocess.Popen[str]] = Queue()
    folders = [folder for folder in (PHYSICS if uncompiled else ("tests",)) if (TOP / folder).exists()]

    def judge(place: Place) -> str:
        key = place.name, place.mutant.line
        if key in known:
            return str(known[key])
        process = free.get()
        assert process.stdin
        assert process.stdout
        wrong = place.mutant.put_into((TOP / place.file).read_text(encoding="utf-8"))
        request = {"file": place.file, "wrong": wrong, "tests": tests_of(place, record, longest)}
        request["at_import"] = not record.tests_of(place.file, place.lines)
        print(json.dumps(request), file=process.stdin, flush=True)
        found = str(json.loads(process.stdout.readline()))
        free.put(process)
        entry = {"place": place.name, "line": place.mutant.line, "noticed_by": found, "tests": tests}
        with journal.open("a", encoding="utf-8") as file:
            file.write(json.dumps(entry, ensure_ascii=False) + "\n")
        return found

    for copy in copies:
        environment = {"PYTHONPATH": str(copy), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
        environment |= {"NUMBA_DISABLE_JIT": "1"} if uncompiled else {}
        command = [sys.executable, str(Path(__file__).with_name("judging.py")), *folders]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        free.put(subprocess.Popen(command, cwd=copy, env=os.environ | environment, **pipes))
    with ThreadPoolExecutor(len(copies)) as pool:
        yield from zip(places, pool.map(judge, places), strict=True)
    while not free.empty():
        free.get().communicate()


def main() -> int:
    """Print what is noticed and what survives, by packages."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--only", default="", metavar="PACKAGE")
    parser.add_argument("--without", default="", metavar="PACKAGE")
    parser.add_argument("--fast", action="store_true")
    parser.add_argument("--seconds", type=float, default=180.0)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    chosen = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    # To compile the libraries and pytest's plugins takes longer than most tests; kernels with errors stay apart
    bytecode, kernels = str(BUILD / "bytecode"), str(BUILD / "kernels")
    os.environ |= {"PYTHONDONTWRITEBYTECODE": "", "PYTHONPYCACHEPREFIX": bytecode, "ROCKBATCH_CACHE": kernels}
    os.environ |= {MARKS: FAST} if chosen.fast else {}
    equivalent = tomllib.loads(EQUIVALENT.read_text(encoding="utf-8")) if EQUIVALENT.exists() else {}
    counts: dict[str, Counter[str]] = {}
    copies = [copied(number) for number in range(chosen.jobs)]
    for uncompiled in (False, True):
        places = [
            place
            for place in drawn(chosen.seed, chosen.count, chosen.only, chosen.without)
            if (place.package == "core") == uncompiled
        ]
        if not places:
            continue
        kind_of_record = "-uncompiled" if uncompiled else "-fast" if chosen.fast else ""
        folder = BUILD / f"record-{_digest('rockbatch', 'tests')}{kind_of_record}"
        record = Record(TOP, folder, uncompiled, chosen.jobs)
        for place, found in judged(places, record, copies, chosen.seconds, uncompiled):
            kind = "noticed" if found else "equivalent" if place.name in equivalent else "survived"
            if not found or found.endswith(TOO_SLOW):
                print(f"{kind}: {place.file}:{place.mutant.line}: {place.mutant} {found}", flush=True)
            for package in (place.package, "all"):
                counts.setdefault(package, Counter())[kind] += 1
    print(
        f"\nseed {chosen.seed}\n{'package':20} {'noticed':>8} {'equivalent':>11} {'survived':>9}  rate, 95 % interval"
    )
    for package, count in sorted(counts.items(), key=lambda item: (item[0] == "all", item[0])):
        matter = count["noticed"] + count["survived"]
        interval = binomtest(count["noticed"], matter).proportion_ci(method="wilson") if matter else (0.0, 1.0)
        rate = f"{count['noticed'] / matter:4.0%} ({interval[0]:.0%} to {interval[1]:.0%})" if matter else ""
        print(f"{package:20} {count['noticed']:8} {count['equivalent']:11} {count['survived']:9}  {rate}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
