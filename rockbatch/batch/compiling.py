"""Compile kernels, or load them from their cache, before runs start; several processes compile in parallel."""

import pickle
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from threading import Thread

import numpy as np

from rockbatch.batch.groups import outcomes_of
from rockbatch.batch.listening import Listener
from rockbatch.batch.observers import observers_of
from rockbatch.batch.threads import cores
from rockbatch.common.garbage import collect_rarely
from rockbatch.motions import Motion
from rockbatch.results.columns import StudyRun
from rockbatch.simulation import kept
from rockbatch.simulation.compilation import compiles, kernel_of, load_numba, on_compilation
from rockbatch.simulation.observing import Observer
from rockbatch.study import Numerics, Study

Task = tuple[StudyRun, Numerics, Sequence[Observer]]
"""A short run that needs one kernel."""


def make_ready(study: Study, listener: Listener, observers: Sequence[Observer] | None = None) -> None:
    """Compile or load every kernel that ``study`` needs; tell ``listener`` if any has to be compiled.

    ``observers`` are those of its runs, by default those of columns of peaks.csv.

    Numba compiles one function at a time in a process. When the first kernel is not in the cache, processes on the other
    processors start to compile from the end of the list, and share their kernels through the cache.
    """
    if not compiles():
        listener.say(
            "NUMBA_DISABLE_JIT is set: nothing is compiled, and runs take a thousand times as long; run `unset NUMBA_DISABLE_JIT`"
        )
    load_numba()
    tasks = _tasks(study, observers_of(study.output) if observers is None else observers)
    waiting, assistants = deque(tasks), list[Thread]()

    def assist() -> None:
        listener.say("compiling the kernels (once for each kind of foundation, 10 to 30 s each)")
        for _ in range(min(cores() - 1, len(waiting)) if kept.usable() else 0):
            assistant = Thread(target=_compile_elsewhere, args=(waiting,), daemon=True)
            with suppress(RuntimeError):  # if no further thread can start, this thread compiles all
                assistant.start()
                assistants.append(assistant)

    with on_compilation(assist):
        while task := _next_task(waiting.popleft):
            _compile(task)
    for assistant in assistants:
        assistant.join()
    for task in tasks if assistants else ():
        _compile(task)  # loads kernels compiled elsewhere
    if reason := kept.unreported():
        listener.say(reason)


def _tasks(study: Study, observers: Sequence[Observer]) -> list[Task]:
    """Return one short run for each kernel of the study."""
    still = Motion("still", 1e-3, np.zeros(2))
    numerics = replace(study.numerics, quiet_s=0.0)
    kernels = {kernel_of(case.pier, case.base): case for case in study.cases}
    return [(StudyRun(still, "+", 1.0, case), numerics, observers) for case in kernels.values()]


def _next_task(take: Callable[[], Task]) -> Task | None:
    """Return the task that ``take`` pops; None if none is waiting."""
    with suppress(IndexError):
        return take()
    return None


def _compile(task: Task) -> None:
    run, numerics, observers = task
    outcomes_of([run], numerics, observers)


def _compile_elsewhere(waiting: "deque[Task]") -> None:
    """Compile waiting tasks, from the last, in another process; what fails there is compiled in this one."""
    while task := _next_task(waiting.pop):
        with suppress(OSError):
            subprocess.run(
                [sys.executable, "-P", "-m", __name__], input=pickle.dumps(task), capture_output=True, check=False
            )


if __name__ == "__main__":
    collect_rarely()
    _compile(pickle.loads(sys.stdin.buffer.read()))
