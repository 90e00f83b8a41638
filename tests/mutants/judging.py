"""Judge errors by tests in forks of a process that has collected all of them, so that only the tests themselves take time.

A process of it reads requests from its standard input, a JSON object a line, and answers each on its standard output: which
test notices the error, "" if none does. It runs in a copy of the project, in which it also writes the error into its file, for
tests that start processes of their own.
"""

import contextlib
import gc
import inspect
import itertools
import json
import os
import resource
import select
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FunctionType
from typing import TextIO

import pytest
from recording import marks

LONGEST = 600
"""Seconds of computing after which the tests of an error count as failed; by the clock it is twice as long."""
TOO_SLOW = "no end"
OPTIONS = "-q", "-x", "--tb=no", "-p", "no:cacheprovider", "-m", marks()
COMPREHENSIONS = "<listcomp>", "<setcomp>", "<dictcomp>", "<genexpr>"
Codes = dict[tuple[str, int], CodeType]


def _codes(code: CodeType, counts: Counter[str]) -> Iterator[tuple[tuple[str, int], CodeType]]:
    """Yield the codes of functions and classes, each by its name and its number among those of that name."""
    for inner in code.co_consts:
        if isinstance(inner, CodeType):
            yield (inner.co_qualname, counts[inner.co_qualname]), inner
            counts[inner.co_qualname] += 1
            yield from _codes(inner, counts)


def _own(code: CodeType) -> tuple[object, ...]:
    """Return what a code does itself, without the functions that it makes."""
    return code.co_code, [value for value in code.co_consts if not isinstance(value, CodeType)], code.co_names


def _runs_at_import(code: CodeType) -> bool:
    """Return whether it is the body of a class, or a comprehension outside of functions, which is made and gone then."""
    made = code.co_name in COMPREHENSIONS and "<locals>" not in code.co_qualname
    return made or not code.co_flags & inspect.CO_NEWLOCALS


def changed_functions(source: str, wrong: str, path: str) -> Codes | None:
    """Return the functions of a module with an error, by their name and line without it.

    Returns None if the error is in what runs when the module is imported: defaults, bodies of classes, constants.
    """
    module, other = (compile(text, path, "exec") for text in (source, wrong))
    before, after = (dict(_codes(code, Counter())) for code in (module, other))
    bodies = [(module, other), *((code, after.get(name)) for name, code in before.items() if _runs_at_import(code))]
    if before.keys() != after.keys() or any(b is None or _own(a) != _own(b) for a, b in bodies):
        return None
    return {(name, code.co_firstlineno): after[name, i] for (name, i), code in before.items()}


def put_into(path: str, functions: Codes) -> bool:
    """Give the functions of a module that was imported other code; return whether all could take it."""
    for function in gc.get_objects():
        if isinstance(function, FunctionType) and (code := function.__code__).co_filename == path:
            changed = functions.get((code.co_qualname, code.co_firstlineno))
            if changed is not None:
                if len(changed.co_freevars) != len(code.co_freevars):
                    return False
                function.__code__ = changed
    return True


def is_compiled(path: str) -> bool:
    """Return whether Numba has compiled functions of a module, which go on with the code that they had."""
    numba = sys.modules.get("numba.core.dispatcher")
    if numba is None:
        return False
    dispatchers = (found for found in gc.get_objects() if isinstance(found, numba.Dispatcher))
    return any(dispatcher.py_func.__code__.co_filename == path for dispatcher in dispatchers)


class Judge:
    """Plugin of pytest that answers requests where pytest would run the tests."""

    def __init__(self, requests: TextIO, answers: TextIO):
        """Read from and write to these files."""
        self.requests, self.answers = requests, answers
        self.failed = ""
        self.sound: set[str] = set()
        self.items: dict[str, pytest.Item] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep the first test that fails."""
        if report.failed:
            self.failed = self.failed or report.nodeid

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Answer all requests."""
        self.items = {item.nodeid: item for item in session.items}
        for line in self.requests:
            request = json.loads(line)
            found = self.noticed_by(
                Path(request["file"]).absolute(), request["wrong"], request["tests"], request["at_import"]
            )
            print(json.dumps(found), file=self.answers, flush=True)
        return True

    def noticed_by(self, path: Path, wrong: str, tests: list[list[str]], at_import: bool) -> str:
        """Return the test that fails with a ``wrong`` source in the file, and passes with the right one; "" if none does.

        What only runs ``at_import`` of the file meets them in new processes.
        """
        source, times = path.read_text(encoding="utf-8"), path.stat()
        anew = at_import or is_compiled(str(path))
        functions = None if anew else changed_functions(source, wrong, str(path))
        for stage in tests:
            names = [name for name in self.items if name in set(stage)]  # files after each other, as fixtures want them
            while names:
                path.write_text(wrong, encoding="utf-8")
                try:
                    failed = self._failing(names, str(path), functions)
                finally:
                    path.write_text(source, encoding="utf-8")
                    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
                if not failed:
                    break
                # Too slow, or a file that cannot be imported, is no single test
                if failed not in self.items or failed in self.sound or not self._failing([failed], str(path), {}):
                    self.sound.add(failed)
                    return failed
                names.remove(failed)
        return ""

    def _failing(self, names: list[str], path: str, functions: Codes | None) -> str:
        """Return the first of these tests that fails with functions that are changed; None stands for a whole new process."""
        if functions is None:
            return _failing_anew(names)
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            answer = TOO_SLOW
            try:
                os.setsid()
                resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST + 10))
                answer = self._failing_here(names) if put_into(path, functions) else _failing_anew(names)
            finally:
                os.write(writing, answer.encode() + b"\n")
                os._exit(0)
        os.close(writing)
        with os.fdopen(reading) as pipe:
            ready, _, _ = select.select([pipe], [], [], 2 * LONGEST)
            answer = pipe.readline() if ready else ""
        _end(child)
        os.waitpid(child, 0)
        return answer.removesuffix("\n") if answer else f"{names[0]}: {TOO_SLOW}"

    def _failing_here(self, names: list[str]) -> str:
        items = [self.items[name] for name in names]
        for item, following in itertools.zip_longest(items, items[1:]):
            item.ihook.pytest_runtest_protocol(item=item, nextitem=following)
            if self.failed:
                break
        return self.failed


def _failing_anew(names: list[str]) -> str:
    """Return the first of these tests that fails in a process of its own.

    It writes no bytecode: Python would take that of an error for the next one's of the same second and length.
    """
    process = subprocess.Popen(
        [sys.executable, "-m", "pytest", *OPTIONS, *names], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        stdin=subprocess.DEVNULL, text=True, errors="replace", start_new_session=True,
        env=os.environ | {"PYTHONDONTWRITEBYTECODE": "1"},
    )  # fmt: skip
    try:
        output, _ = process.communicate(timeout=2 * LONGEST)
    except subprocess.TimeoutExpired:
        output = ""
    _end(process.pid)
    process.wait()
    if process.returncode in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
        return ""
    failed = [
        line.split(" ", 1)[1].split(" - ")[0] for line in output.splitlines() if line.startswith(("FAILED", "ERROR "))
    ]
    return failed[0].strip() if failed else f"{names[0]}: {TOO_SLOW}"


def _end(group: int) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.killpg(group, signal.SIGKILL)


def main() -> None:
    """Judge what is asked on standard input by the tests in the folders that are named."""
    requests, answers = os.fdopen(os.dup(0)), os.fdopen(os.dup(1), "w")
    silence = os.open(os.devnull, os.O_RDWR)
    for number in range(3):
        os.dup2(silence, number)
    pytest.main([*OPTIONS, *sys.argv[1:]], plugins=[Judge(requests, answers)])


if __name__ == "__main__":
    main()
