"""Put small errors into the product, one at a time, and see whether its tests notice.

    make mutants [SEED=1] [COUNT=200]
    python tests/mutants/run.py --seed 1 --count 200 [--only core] [--jobs 2]

Places are drawn at random from all lines that compute (places.py). An error meets the tests that execute its line, which
coverage records once for the product and each file of tests; then their whole files, for what they share; in the compiled core,
whose lines coverage does not see, the tests of the physics. It is noticed where one of them fails, or takes much longer than
without an error. What is finished is kept in build/mutants and not done again. An error that changes no answer is listed, with
the reason, in equivalent.toml.
"""

import argparse
import contextlib
import hashlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from tempfile import TemporaryFile
from typing import Any, NamedTuple

import pytest
from places import Mutant, mutants

TOP = Path(__file__).parents[2]
BUILD = TOP / "build" / "mutants"
EQUIVALENT = Path(__file__).with_name("equivalent.toml")
SLOWER = 5.0
"""Times as long as without an error that tests may take before they count as failed."""
MOST_TESTS, MOST_FILES = 300, 12
"""Tests and files of a line that are run: a line of all tests is as well known by these."""
OF_CORE = ["tests/core/", "tests/simulation/", "tests/verification/"]
NOT_COPIED = (".venv*", "build", "reports", ".git", ".mypy_cache", ".ruff_cache", ".pytest_cache")
PYTEST = "-q", "-n", "0", "-m", "not slow", "-p", "no:cacheprovider"


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
        """Return file and error as equivalent.toml has them: they stay the same when lines move."""
        return f"{self.file}: {self.mutant}"


def drawn(seed: int, count: int, only: str = "") -> list[Place]:
    """Return so many places at random, of a package if ``only`` names one."""
    files = sorted(path.relative_to(TOP).as_posix() for path in (TOP / "rockbatch").rglob("*.py"))
    every = [Place(file, mutant) for file in files for mutant in mutants((TOP / file).read_text(encoding="utf-8"))]
    chosen = [place for place in every if not only or place.package == only]
    return random.Random(seed).sample(chosen, min(count, len(chosen)))


def product_digest() -> str:
    """Return the digest of the product, and of what its tests share."""
    return _digest(path for folder in ("rockbatch", "tests/helpers") for path in sorted((TOP / folder).rglob("*.py")))


def _digest(paths: Iterable[Path]) -> str:
    return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()[:12]


def copied(number: int) -> Path:
    """Return a copy of the project in which errors may be made; kernels that an earlier one compiled stay in it."""
    copy = BUILD / f"copy-{number}"
    for path in copy.rglob("*.py"):
        path.unlink()
    shutil.copytree(TOP, copy, dirs_exist_ok=True, ignore=shutil.ignore_patterns(*NOT_COPIED))
    return copy


class Recorded(NamedTuple):
    """What a file of fast tests does without an error."""

    test: str
    data: Path
    """Coverage's data, empty if it executes nothing of the product."""

    @property
    def summary(self) -> dict[str, Any]:
        """Return the ``seconds`` that the file takes, and the tests that ``failed``."""
        summary: dict[str, Any] = json.loads(self.data.with_suffix(".json").read_text(encoding="utf-8"))
        return summary


def recorded(copy: Path, jobs: int) -> list[Recorded]:
    """Return what each file of tests does; it runs only if itself, or the product, changed since it was recorded."""
    folder = BUILD / f"executed-{product_digest()}"
    folder.mkdir(exist_ok=True)
    every = [
        Recorded(path.relative_to(TOP).as_posix(), folder / f"{path.stem}-{_digest([path])}.coverage")
        for path in sorted((TOP / "tests").rglob("test_*.py"))
    ]
    new = [one for one in every if not one.data.exists()]
    if new:
        print(f"running {len(new)} files of tests once, to see which lines they execute", flush=True)
    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(lambda one: _record(one, copy), new))
    return every


def _record(one: Recorded, copy: Path) -> None:
    """Run a file of tests, and keep what it executes, also in the processes that it starts."""
    parts = one.data.with_suffix(".parts")
    shutil.rmtree(parts, ignore_errors=True)
    parts.mkdir()
    settings, failed = parts / "coverage.ini", parts / "failed"
    settings.write_text(
        f"[run]\nsource = {copy / 'rockbatch'}\nparallel = true\npatch = subprocess\ndata_file = {parts / 'data'}\n"
    )
    failed.touch()
    paths = {"PYTHONPATH": os.pathsep.join(map(str, (copy, Path(__file__).parent))), "FAILED_TESTS": str(failed)}
    coverage, since = [sys.executable, "-m", "coverage"], time.monotonic()
    for command in (
        [*coverage, "run", f"--rcfile={settings}", "-m", "pytest", "-p", "executed", *PYTEST, one.test],
        [*coverage, "combine", "--quiet", f"--rcfile={settings}"],
    ):
        subprocess.run(
            command, cwd=copy, env=os.environ | paths, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
    summary = {"seconds": time.monotonic() - since, "failed": failed.read_text(encoding="utf-8").splitlines()}
    one.data.with_suffix(".json").write_text(json.dumps(summary), encoding="utf-8")
    (parts / "data").touch()
    (parts / "data").replace(one.data)
    shutil.rmtree(parts)


class Chosen(NamedTuple):
    """Arguments for pytest, and the seconds after which tests that an error makes slow count as failed."""

    arguments: list[str]
    limit: float


class Executed:
    """The tests that execute a line."""

    def __init__(self, every: list[Recorded], copy: Path) -> None:
        import coverage

        self.copy = copy
        summaries = {one.test: one.summary for one in every}
        self.seconds = {test: value["seconds"] for test, value in summaries.items()}
        self.failed = [f"--deselect={test}" for value in summaries.values() for test in value["failed"]]
        self.data = {one.test: coverage.CoverageData(str(one.data)) for one in every if one.data.stat().st_size}
        for data in self.data.values():
            data.read()

    def tests(self, place: Place) -> list[Chosen]:
        """Return the tests that execute a place, those first that execute most of its file; then their whole files."""
        lines = {test: data.contexts_by_lineno(str(self.copy / place.file)) for test, data in self.data.items()}
        files = [test for test, contexts in lines.items() if place.mutant.line in contexts]
        files.sort(key=lambda test: len(lines[test]), reverse=True)
        tests = [test for file in files for test in sorted(lines[file][place.mutant.line]) if test][:MOST_TESTS]
        compiled = place.file.startswith("rockbatch/core/")
        if compiled or not files:
            folders = OF_CORE if compiled else [f"tests/{place.package.split('/')[0]}/"]
            tests, files = [], [test for folder in folders for test in self.seconds if test.startswith(folder)]
        first = [self._chosen(tests, dict.fromkeys(test.partition("::")[0] for test in tests))] if tests else []
        others = files if compiled else files[:MOST_FILES]
        return first + [self._chosen([file], [file], 300.0 if compiled else 60.0) for file in others]

    def _chosen(self, arguments: list[str], files: Iterable[str], least: float = 60.0) -> Chosen:
        return Chosen([*arguments, *self.failed], least + SLOWER * sum(self.seconds[file] for file in files))


def noticed_by(place: Place, tests: list[Chosen], copy: Path) -> str:
    """Return the test that fails, or becomes too slow, with the error in a copy of the project; "" if none does."""
    path, compiled = copy / place.file, copy / "rockbatch/core/__pycache__"
    source, times, kernels = path.read_text(encoding="utf-8"), path.stat(), set(compiled.glob("kernels-*"))
    path.write_text(place.mutant.put_into(source), encoding="utf-8")
    try:
        return next(filter(None, (_failure(chosen, copy) for chosen in tests)), "")
    finally:
        path.write_text(source, encoding="utf-8")
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
        for wrong in set(compiled.glob("kernels-*")) - kernels:
            shutil.rmtree(wrong)


def _failure(chosen: Chosen, copy: Path) -> str:
    """Return the test that fails in a copy of the project, "" if none does."""
    command = [sys.executable, "-m", "pytest", "-x", *PYTEST, *chosen.arguments]
    with TemporaryFile("w+", encoding="utf-8", errors="replace") as output:
        process = subprocess.Popen(
            command, cwd=copy, env=os.environ | {"PYTHONPATH": str(copy)}, stdout=output, stderr=output,
            start_new_session=True,
        )  # fmt: skip
        try:
            code = process.wait(chosen.limit)
        except subprocess.TimeoutExpired:
            return f"{chosen.arguments[0]} takes longer than {chosen.limit:.0f} s"
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        output.seek(0)
        failed = [line for line in output if line.startswith(("FAILED", "ERROR"))]
    if code in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
        return ""
    if code == pytest.ExitCode.USAGE_ERROR and "::" in chosen.arguments[0]:  # a test has another name with the error
        return ""
    return failed[0].split(" - ")[0].strip() if failed else f"{chosen.arguments[0]} ends with code {code}"


def judged(places: list[Place], executed: Executed, copies: list[Path]) -> Iterator[tuple[Place, str]]:
    """Yield each place, and what notices its error; what earlier calls found with the same tests is kept."""
    journal = BUILD / f"judged-{product_digest()}.jsonl"
    entries = map(json.loads, journal.read_text(encoding="utf-8").splitlines() if journal.exists() else [])
    tests = _digest(path for path in sorted((TOP / "tests").rglob("*.py")))
    known = {
        (entry["place"], entry["line"]): entry["noticed_by"]
        for entry in entries
        if entry["noticed_by"] or entry["tests"] == tests
    }
    free: Queue[Path] = Queue()
    for copy in copies:
        free.put(copy)

    def judge(place: Place) -> str:
        if (place.name, place.mutant.line) in known:
            return str(known[place.name, place.mutant.line])
        copy = free.get()
        try:
            found = noticed_by(place, executed.tests(place), copy)
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
    equivalent = tomllib.loads(EQUIVALENT.read_text(encoding="utf-8")) if EQUIVALENT.exists() else {}
    counts: dict[str, Counter[str]] = {}
    places = drawn(chosen.seed, chosen.count, chosen.only)
    copies = [copied(number) for number in range(chosen.jobs)]
    executed = Executed(recorded(copies[0], chosen.jobs), copies[0])
    for place, found in judged(places, executed, copies):
        kind = "noticed" if found else "equivalent" if place.name in equivalent else "survived"
        if not found.startswith(("FAILED", "ERROR")):
            print(f"{kind}: {place.file}:{place.mutant.line}: {place.mutant} {found}", flush=True)
        for package in (place.package, "all"):
            counts.setdefault(package, Counter())[kind] += 1
    print(f"\nseed {chosen.seed}\n{'package':20} {'noticed':>8} {'equivalent':>11} {'survived':>9}  rate")
    for package, count in sorted(counts.items(), key=lambda item: (item[0] == "all", item[0])):
        matter = count["noticed"] + count["survived"]
        rate = f"{count['noticed'] / matter:.0%}" if matter else ""
        print(f"{package:20} {count['noticed']:8} {count['equivalent']:11} {count['survived']:9}  {rate}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
