"""Which test of CI runs which line of the product: recorded by pytest-cov, with how long each test takes.

This module is a plugin of pytest, too: it keeps the seconds of tests that pass, and ends one that takes longer than LIMIT.
"""

import functools
import json
import os
import re
import signal
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

OF_CI, FAST = "not thorough", "not slow"
"""Marks of the tests that an error meets, and of those that it meets without the compiler or with ``--fast``."""
PHYSICS = "tests/core", "tests/simulation", "tests/verification"
"""Tests that errors in the core meet: uncompiled, since all kernels would be compiled anew for each."""
UNCOMPILED_LIMIT = "20"
"""Seconds that a test may take uncompiled while its lines are recorded: others are not used."""
LIMIT, SECONDS, MARKS = "MUTANTS_LIMIT", "MUTANTS_SECONDS", "MUTANTS_MARKS"
"""Variables of the environment: a test's longest time, the file for the times of all, and the marks of those that are used."""
CONFIG = """
[run]
source = {top}/rockbatch
data_file = {data}
parallel = True
patch = subprocess
context = ${{PYTEST_CURRENT_TEST-}}
"""
_CONTEXT = re.compile(r"(.+?)(?:\|(run|setup|teardown)| \((call|setup|teardown)\))", re.DOTALL)
"""A test and its phase, as pytest-cov names it, and as other processes that the test started find it in the environment."""


def marks() -> str:
    """Return the marks of the tests that errors meet with the compiler."""
    return os.environ.get(MARKS, OF_CI)


@functools.cache
def _seconds() -> Counter[str]:
    return Counter()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Of the physics, keep what is short without the compiler: functions of the core, and what asks for a run without it."""
    if LIMIT in os.environ:
        items[:] = [
            item
            for item in items
            if item.path.parent.name == "core" or "uncompiled" in getattr(item, "fixturenames", ())
        ]


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Add up how long a test takes; one that fails is never used."""
    _seconds()[report.nodeid] += report.duration if report.passed else float("inf")


def _within_limit() -> Iterator[None]:
    """End a test, or its fixtures, if either takes too long."""

    def stop(*_: object) -> None:
        raise TimeoutError

    before = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, float(os.environ.get(LIMIT, 0)))
    try:
        return (yield)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


pytest_runtest_setup = pytest.hookimpl(wrapper=True)(_within_limit)
pytest_runtest_call = pytest.hookimpl(wrapper=True)(_within_limit)


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Write the times of all tests, in the process that has them all."""
    if not hasattr(session.config, "workerinput"):
        Path(os.environ[SECONDS]).write_text(json.dumps(_seconds()), encoding="utf-8")


class Record:
    """Tests by the lines that they run."""

    def __init__(self, top: Path, folder: Path, uncompiled: bool, jobs: int):
        """Open what was recorded of the project at ``top`` in ``folder``, or record it in so many processes."""
        from coverage import CoverageData

        self.top, data, seconds = top, folder / "lines", folder / "seconds.json"
        if not seconds.exists():
            folder.mkdir(parents=True, exist_ok=True)
            config = folder / "coverage.ini"
            config.write_text(CONFIG.format(top=top, data=data), encoding="utf-8")
            tests = PHYSICS if uncompiled else ("tests",)
            environment = {"PYTHONPATH": str(Path(__file__).parent), SECONDS: str(seconds)}
            environment |= {"NUMBA_DISABLE_JIT": "1", LIMIT: UNCOMPILED_LIMIT} if uncompiled else {}
            options = (
                "-q",
                "--tb=no",
                "-m",
                FAST if uncompiled else marks(),
                "-n",
                str(jobs),
                "--dist",
                "loadfile",
                "-p",
                "recording",
            )
            record = "--cov", f"--cov-config={config}", "--cov-context=test", "--cov-report="
            command = [sys.executable, "-m", "pytest", *options, *record, *tests]
            subprocess.run(command, cwd=top, env=os.environ | environment)
        self.seconds: dict[str, float] = json.loads(seconds.read_text(encoding="utf-8"))
        self._data = CoverageData(str(data))
        self._data.read()

    @functools.cache  # noqa: B019  one record for a process
    def _lines(self, file: str) -> dict[int, set[str]]:
        """Return tests by the lines of a file that they run; for a fixture that tests may share, these are all of its file."""
        found: dict[int, set[str]] = defaultdict(set)
        for number, contexts in self._data.contexts_by_lineno(str(self.top / file)).items():
            for match in filter(None, map(_CONTEXT.fullmatch, contexts)):
                test, phase = match[1], match[2] or match[3]
                found[number] |= self._in_file[test.split("::")[0]] if phase == "setup" else {test}
        return found

    @functools.cached_property
    def _in_file(self) -> dict[str, set[str]]:
        found: dict[str, set[str]] = defaultdict(set)
        for test in self.seconds:
            found[test.split("::")[0]].add(test)
        return found

    def tests_of(self, file: str, lines: range) -> list[str]:
        """Return the tests that run one of these lines of a file, in turn one of each test file, and its quickest first."""
        return self._in_turn(set().union(*(self._lines(file).get(line, ()) for line in lines)))

    def naming(self, names: set[str]) -> list[str]:
        """Return the tests of the files in which one of these names is a word: they hold a constant that they do not run."""
        word = re.compile(rf"(?<!\w)(?:{'|'.join(names)})(?!\w)")
        files = [file for file in self._in_file if names and word.search((self.top / file).read_text(encoding="utf-8"))]
        return self._in_turn(set().union(*(self._in_file[file] for file in files)))

    def nearest(self, file: str, count: int) -> list[str]:
        """Return the tests that run most of a file: for what runs when it is imported."""
        runs = Counter(test for tests in self._lines(file).values() for test in tests)
        return self._in_turn({test for test, _ in runs.most_common(count)})

    def _in_turn(self, tests: set[str]) -> list[str]:
        passing = sorted(
            (seconds, test) for test in tests if (seconds := self.seconds.get(test, float("inf"))) < float("inf")
        )
        turns: Counter[str] = Counter()
        ranked = []
        for seconds, test in passing:
            file = test.split("::")[0]
            ranked.append((turns[file], seconds, test))
            turns[file] += 1
        return [test for _, _, test in sorted(ranked)]
