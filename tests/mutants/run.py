"""Put small errors into the product, one at a time, and see whether its tests notice.

    make mutants [SEED=1] [COUNT=200]
    python tests/mutants/run.py --seed 1 --count 200 [--only core] [--jobs 2]

Places are drawn at random from all lines that compute (places.py). An error meets the tests that execute its line, which coverage
records once for a state of the product and its tests (a quarter of an hour); then their whole files, for what they share; in
the compiled core, whose lines coverage does not see, the tests of the physics. It is noticed where one of them fails, or takes
ten minutes. What is finished is kept in build/mutants and not done again. An error that changes no answer is listed, with the
reason, in equivalent.toml.
"""

import argparse
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

from places import Mutant, mutants

TOP = Path(__file__).parents[2]
BUILD = TOP / "build" / "mutants"
EQUIVALENT = Path(__file__).with_name("equivalent.toml")
LONGEST = 600.0
"""Seconds after which tests that an error makes slow count as failed."""
MOST_TESTS = 300
"""Tests of a line that are run one by one: a line of all tests is as well known by these."""
OF_CORE = ["tests/core", "tests/simulation", "tests/verification"]
NOT_COPIED = (".venv*", "build", "reports", ".git", ".mypy_cache", ".ruff_cache", ".pytest_cache")
PYTEST = "-q", "-x", "-n", "0", "-m", "not slow", "-p", "no:cacheprovider"


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


def state() -> str:
    """Return the digest of the product and its tests."""
    digest = hashlib.sha256()
    for folder in ("rockbatch", "tests"):
        for path in sorted((TOP / folder).rglob("*.py")):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def recorded(jobs: int) -> Path:
    """Return coverage's data of the fast tests of this state, which are run if there is none yet."""
    data = BUILD / f"executed-{state()}"
    if not data.exists():
        print("running the fast tests once, to see which of them execute which line", flush=True)
        settings = BUILD / "coverage.ini"
        settings.write_text(
            f"[run]\nsource = {TOP / 'rockbatch'}\nparallel = true\npatch = subprocess\ndata_file = {data}\n"
        )
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, (TOP, Path(__file__).parent)))}
        command = [
            "coverage",
            "run",
            f"--rcfile={settings}",
            "-m",
            "pytest",
            "-q",
            "-n",
            str(jobs),
            "--dist",
            "loadfile",
        ]
        subprocess.run(
            [sys.executable, "-m", *command, "-p", "executed", "-m", "not slow"], cwd=TOP, env=environment, check=False
        )
        subprocess.run([sys.executable, "-m", "coverage", "combine", f"--rcfile={settings}"], cwd=TOP, check=True)
    return data


class Executed:
    """The tests that execute a line."""

    def __init__(self, path: Path) -> None:
        import coverage

        self.data = coverage.CoverageData(str(path))
        self.data.read()

    def tests(self, place: Place) -> list[list[str]]:
        """Return the arguments for pytest, the nearest tests first; then others that may notice."""
        if place.file.startswith("rockbatch/core/"):
            return [[folder] for folder in OF_CORE]
        contexts = self.data.contexts_by_lineno(str(TOP / place.file)).get(place.mutant.line, [])
        tests = sorted({test for test in contexts if test}, key=lambda test: (place.package not in test, test))
        if not tests:
            return [[folder] for folder in (f"tests/{place.package.split('/')[0]}",) if (TOP / folder).is_dir()]
        files = list(dict.fromkeys(test.partition("::")[0] for test in tests))
        return [tests[:MOST_TESTS], files[:12]]


def survives(place: Place, tests: list[list[str]], copy: Path) -> bool:
    """Return whether the tests pass with the error in a copy of the project."""
    path = copy / place.file
    source, times = path.read_text(encoding="utf-8"), path.stat()
    path.write_text(place.mutant.put_into(source), encoding="utf-8")
    try:
        for chosen in tests:
            try:
                done = subprocess.run(
                    [sys.executable, "-m", "pytest", *PYTEST, *chosen], cwd=copy, timeout=LONGEST, check=False,
                    env=os.environ | {"PYTHONPATH": str(copy)}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                )  # fmt: skip
            except subprocess.TimeoutExpired:
                return False
            if done.returncode:
                return False
        return True
    finally:
        path.write_text(source, encoding="utf-8")
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))


def judged(places: list[Place], executed: Executed, jobs: int) -> Iterator[tuple[Place, bool]]:
    """Yield each place, and whether its error survives; what earlier calls found of this state is kept."""
    journal = BUILD / f"judged-{state()}.jsonl"
    entries = map(json.loads, journal.read_text(encoding="utf-8").splitlines() if journal.exists() else [])
    known = {(entry["place"], entry["line"]): entry["survives"] for entry in entries}
    copies: Queue[Path] = Queue()
    for number in range(jobs):
        copy = BUILD / f"copy-{number}"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(TOP, copy, symlinks=True, ignore=shutil.ignore_patterns(*NOT_COPIED))
        copies.put(copy)

    def judge(place: Place) -> bool:
        if (place.name, place.mutant.line) in known:
            return bool(known[place.name, place.mutant.line])
        copy = copies.get()
        try:
            found = survives(place, executed.tests(place), copy)
        finally:
            copies.put(copy)
        entry = {"place": place.name, "line": place.mutant.line, "survives": found}
        with journal.open("a", encoding="utf-8") as file:
            file.write(json.dumps(entry, ensure_ascii=False) + "\n")
        return found

    with ThreadPoolExecutor(jobs) as pool:
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
    executed = Executed(recorded(chosen.jobs))
    for place, survived in judged(places, executed, chosen.jobs):
        kind = "noticed"
        if survived:
            kind = "equivalent" if place.name in equivalent else "survived"
            print(f"{kind}: {place.file}:{place.mutant.line}: {place.mutant}", flush=True)
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
