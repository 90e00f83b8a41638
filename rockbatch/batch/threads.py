"""Engines for the runs of a batch: threads of this process here, a cluster in rockbatch.batch.dask."""

import os
from collections.abc import Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from types import TracebackType
from typing import Protocol, Self, runtime_checkable

from rockbatch.batch.groups import Group, groups, outcomes_of
from rockbatch.common.errors import InputError, starting_threads
from rockbatch.outcome.outcome import Outcome
from rockbatch.results.columns import StudyRun
from rockbatch.simulation.observing import Observer
from rockbatch.simulation.runs import Stop
from rockbatch.study import Numerics

AHEAD = 2
"""Groups submitted for each thread, so that none waits."""


@runtime_checkable
class Engine(Protocol):
    """Carries out runs; a context, within which it can be used repeatedly. ``str`` describes it: "2 threads"."""

    @property
    def jobs(self) -> int:
        """Return the number of its threads."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def outcomes(
        self, runs: Sequence[StudyRun], numerics: Numerics, observers: Sequence[Observer] = ()
    ) -> Generator[Group, None, None]:
        """Yield groups of runs with their outcomes, as they finish.

        Outcomes depend neither on the engine nor on the grouping; only their order does. After Ctrl-C, groups finished by
        then are yielded before ``KeyboardInterrupt``.
        """


def cores() -> int:
    """Return the number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def engine_of(jobs: int | Engine | None) -> Engine:
    """Return ``jobs`` threads, one for each processor for None, or the given engine; ``InputError`` for fewer than one."""
    if jobs is None:
        return Threads(cores())
    if not isinstance(jobs, int):
        return jobs
    if jobs < 1:
        raise InputError(f"jobs = {jobs}: must be at least 1, or left out for all processors")
    return Threads(jobs)


@dataclass(frozen=True)
class Threads:
    """Threads of this process; the kernels release the interpreter."""

    jobs: int

    def __str__(self) -> str:
        return f"{self.jobs} thread{'s' * (self.jobs > 1)}"

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Release nothing: threads live as long as a batch."""

    def outcomes(
        self, runs: Sequence[StudyRun], numerics: Numerics, observers: Sequence[Observer] = ()
    ) -> Generator[Group, None, None]:
        """Yield groups of runs with their outcomes, as they finish (:class:`Engine`)."""
        waiting = groups(runs, numerics, self.jobs)
        pending: dict[Future[list[Outcome | None]], Group] = {}
        stop = Stop()
        pool = ThreadPoolExecutor(self.jobs)
        try:
            while True:
                while len(pending) < AHEAD * self.jobs and (group := next(waiting, None)):
                    with starting_threads(", or write --jobs 1" * (self.jobs > 1)):
                        pending[pool.submit(outcomes_of, group.values(), numerics, observers, stop)] = group
                if not pending:
                    return
                done, _ = wait(pending, return_when=FIRST_COMPLETED)
                for future in done:
                    outcomes = future.result()
                    yield finished(pending.pop(future), outcomes)
        except (KeyboardInterrupt, Exception):  # groups finished by then are not lost
            stop.set()
            pool.shutdown(cancel_futures=True)
            for future, group in pending.items():
                if not future.cancelled() and future.exception() is None:
                    yield finished(group, future.result())
            raise
        finally:
            stop.set()
            pool.shutdown(cancel_futures=True)


def finished(group: Group, outcomes: Sequence[Outcome | None]) -> Group:
    """Return the runs of a group with their outcomes, without stopped ones."""
    ended = zip(group.items(), outcomes, strict=True)
    return {i: run._replace(outcome=outcome) for (i, run), outcome in ended if outcome is not None}
