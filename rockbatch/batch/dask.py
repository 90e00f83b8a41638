"""A batch on a dask.distributed cluster: groups of runs as tasks, each record sent once."""

import logging
import signal
import threading
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import TracebackType
from typing import TYPE_CHECKING, Self

from rockbatch.batch.digests import program
from rockbatch.batch.groups import NOTHING_MORE, groups, outcomes_of
from rockbatch.batch.plan import PlannedRun, scaled
from rockbatch.batch.threads import Outcomes, cores, finished
from rockbatch.errors import InputError
from rockbatch.motions import Motion
from rockbatch.results.outcome import Outcome
from rockbatch.study import Case, Numerics, Output

if TYPE_CHECKING:
    from distributed import Client, Future

AHEAD = 3
"""Groups handed to the scheduler for each thread of its workers, so that none waits."""

MOST_RUNS_OF_A_TASK = 16 * 1024
"""A task is to take about a second: what the scheduler spends on each is then nothing."""

PATIENCE_S = 60
"""How long the scheduler and its first worker may take to appear."""


class Dask:
    """The workers of a dask scheduler; see :class:`rockbatch.batch.threads.Engine`.

    Workers may come, go and die meanwhile: the scheduler gives what they had to others, records included. A group at
    which several workers have died in turn ends the batch with an ``InputError``.

    Parameters
    ----------
    address : str, optional
        Of the scheduler, such as "tcp://10.0.0.1:8786"; by default one of this process with workers on this machine.
    workers : int, optional
        Processes on this machine, if there is no address; all processors by default.
    """

    def __init__(self, address: str | None = None, workers: int | None = None) -> None:
        self.address = address
        self.workers = workers or cores()
        self._client: Client | None = None
        self._records: Records | None = None

    def __enter__(self) -> Self:
        try:
            from distributed import Client
        except ImportError:
            raise InputError('the engine dask is not installed: pip install "rockbatch[dask]"') from None
        try:
            if self.address is None:
                with _deaf_to_interrupts():
                    self._client = Client(
                        n_workers=self.workers, threads_per_worker=1, dashboard_address=None, silence_logs=logging.ERROR
                    )
            else:
                self._client = Client(self.address, timeout=PATIENCE_S)
            self._client.wait_for_workers(1, timeout=PATIENCE_S)
        except (OSError, ValueError) as error:  # TimeoutError is an OSError
            self.__exit__(None, None, None)
            raise InputError(
                f"scheduler {self.address or 'of this machine'}: no workers ({error or 'none came'}); start them with "
                "`dask scheduler` and `dask worker ADDRESS`, and give the address"
            ) from error
        self._records = Records(self._client)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None

    def __str__(self) -> str:
        where = self.address or "this machine"
        return f"a dask cluster of {self.jobs} thread{'s' * (self.jobs != 1)} ({where})"

    @property
    def jobs(self) -> int:
        """Threads of all workers that there are now."""
        return sum(self._client.nthreads().values()) if self._client else 0

    def outcomes(
        self, runs: Sequence[PlannedRun], numerics: Numerics, output: Output = NOTHING_MORE
    ) -> Generator[Outcomes, None, None]:
        """See :class:`rockbatch.batch.threads.Engine`."""
        from distributed import CancelledError, as_completed
        from distributed.scheduler import KilledWorker

        records = self._records
        assert self._client is not None
        assert records is not None, "an engine is a context"
        waiting = groups(runs, numerics, max(self.jobs, 1), MOST_RUNS_OF_A_TASK)
        pending: dict[Future, range] = {}
        flow = as_completed()

        def hand_out() -> None:
            most = AHEAD * max(self.jobs, 1)
            while len(pending) < most and (group := next(waiting, None)):
                future = records.submit(runs[group.start : group.stop], numerics, output)
                pending[future] = group
                flow.add(future)

        try:
            hand_out()
            for future in flow:
                group = pending[future]
                found = future.result()
                del pending[future]
                yield finished(group, found)
                hand_out()
        except KeyboardInterrupt:
            yield from _kept(pending)
            raise
        except KilledWorker as error:
            yield from _kept(pending)
            raise InputError(
                f"runs {group.start + 1} to {group.stop} of those that were left: several workers died at them in turn, the "
                f"last {error.last_worker.address}; look at its log and memory, and give the same command again"
            ) from error
        except (CancelledError, OSError) as error:
            raise InputError(f"{self}: lost ({error}); give the same command again to go on") from error
        finally:
            self._client.cancel(list(pending))


def _kept(pending: "dict[Future, range]") -> Iterator[Outcomes]:
    """Of the groups that were handed out, those that are finished."""
    for future, group in pending.items():
        if future.status == "finished":
            yield finished(group, future.result())


@dataclass(frozen=True)
class Member:
    """A run of a group without its motion: which of the group's records, and what is made of it."""

    record: int
    polarity: str
    scale: float
    case: Case


class Records:
    """The records on a cluster, from the first batch that needs one to the last; what is no record, for its group only.

    Each is the result of a task of its own, which the workers hand on to each other, and which the scheduler repeats
    when all that had it have died.
    """

    def __init__(self, client: "Client") -> None:
        self.client = client
        self._sent: dict[int, tuple[Motion, Future]] = {}

    def submit(self, runs: Sequence[PlannedRun], numerics: Numerics, output: Output) -> "Future":
        """Hand out a group of runs."""
        records: dict[int, Future] = {}
        members = []
        for run in runs:
            if run.recorded is not None:
                motion, polarity, scale = run.recorded, run.polarity, run.scale
            else:
                motion, polarity, scale = run.motion, "+", 1.0
            if id(motion) not in records:
                records[id(motion)] = self._record(motion, keep=run.recorded is not None)
            members.append(Member(list(records).index(id(motion)), polarity, scale, run.case))
        return self.client.submit(simulate, list(records.values()), members, numerics, output, program(), pure=False)

    def _record(self, motion: Motion, keep: bool) -> "Future":
        if id(motion) in self._sent:
            return self._sent[id(motion)][1]
        future = self.client.submit(_held, motion, pure=False)
        if keep:  # with the motion, whose id must not become another's
            self._sent[id(motion)] = motion, future
        return future


@contextmanager
def _deaf_to_interrupts() -> Iterator[None]:
    """Processes that are started meanwhile leave Ctrl-C, which a terminal sends to all of them, to this one."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    handler = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)


def _held(motion: Motion) -> Motion:
    return motion


def simulate(
    records: Sequence[Motion], members: Sequence[Member], numerics: Numerics, output: Output, wanted: str
) -> list[Outcome | None]:
    """What a worker does: the outcomes of a group, by the same ``program`` as where the batch began."""
    if program() != wanted:
        raise InputError(
            f"a worker runs another rockbatch or another Numba ({program()}, not {wanted}): install the same everywhere"
        )
    motions: dict[tuple[int, str, float], Motion] = {}
    runs = []
    for member in members:
        variant = member.record, member.polarity, member.scale
        if variant not in motions:
            motions[variant] = scaled(records[member.record], member.scale, member.polarity)
        runs.append(PlannedRun(motions[variant], member.polarity, member.scale, member.case))
    return outcomes_of(runs, numerics, output)
