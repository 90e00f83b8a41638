"""Carry out a batch on a dask.distributed cluster: groups of runs are tasks, each record is sent once."""

import logging
import signal
import time
from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from importlib.util import find_spec
from types import TracebackType
from typing import TYPE_CHECKING, Self

from rockbatch.batch.digests import program
from rockbatch.batch.groups import Group, groups, outcomes_of
from rockbatch.batch.threads import cores, finished
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError, OutOfRange, Problem, starting_threads
from rockbatch.motions import Motion
from rockbatch.outcome.outcome import Outcome
from rockbatch.results.columns import StudyRun
from rockbatch.results.labelled import Row
from rockbatch.simulation.observing import Observer
from rockbatch.study import Case, Numerics

if TYPE_CHECKING:
    from distributed import Client, Future

Member = tuple[int, str, float, Case, str | None, Outcome | None]
"""The fields of a :class:`StudyRun`, with an index in place of the record."""

AHEAD = 3
"""Groups submitted for each worker thread, so that none waits."""

MOST_RUNS_OF_A_TASK = 16 * 1024
"""Most runs of a task: it takes about a second, so that the scheduler's overhead is negligible."""

PATIENCE_S = 60
"""Time [s] to wait for the scheduler and a first worker, and later for any worker."""

MOST_DEATHS = 5
"""Number of glances at which a worker had died, without a result in between, before the batch gives up."""

_PAUSED = ": all have paused since their memory is full; give each more"

GONE_S = 10
"""Time [s] after which a silent scheduler counts as lost."""

GLANCE_S = 1.0
"""Time [s] between glances at scheduler and workers."""


@checked
class Dask:
    """The workers of a dask scheduler, which take the place of ``jobs`` in ``rb.run`` and the analyses.

    Workers may come, go and die: the scheduler passes their tasks and records to others. A group at which several workers
    die in turn ends the batch with an ``InputError``.

    Parameters
    ----------
    address : str, optional
        Address of the scheduler, such as "tcp://10.0.0.1:8786"; by default a scheduler in this process.
    workers : int, optional
        Number of processes on this machine, without an ``address``; all processors by default.

    Raises
    ------
    InputError
        Of fewer than one worker; of a missing package or scheduler when the first run is carried out.

    Examples
    --------
    >>> engine = rb.Dask("tcp://10.0.0.1:8786")
    >>> engine.address
    'tcp://10.0.0.1:8786'

    ``rb.run("pier4.toml", jobs=engine)`` then carries out the runs on its workers.
    """

    def __init__(self, address: str | None = None, workers: int | None = None) -> None:
        if workers is not None and workers < 1:
            raise OutOfRange(Problem("workers", workers, "must be 1 or above"))
        self.address = address
        self.workers = workers or cores()
        self._client: Client | None = None
        self._threads = 0
        self._records: Records | None = None
        self._opened = ExitStack()

    def __enter__(self) -> Self:
        try:
            from dask import config
            from distributed import Client
        except ImportError:
            raise InputError('the engine dask is not installed: pip install "rockbatch[dask]"') from None
        self._opened.enter_context(_quiet())
        self._opened.enter_context(config.set({"distributed.comm.timeouts.connect": f"{GONE_S} s"}))
        try:
            if self.address is None:
                with _without_interrupts():
                    self._client = Client(
                        n_workers=self.workers,
                        threads_per_worker=1,
                        dashboard_address=None,
                        silence_logs=logging.CRITICAL,
                    )
            else:
                self._client = Client(self.address, timeout=PATIENCE_S)
            self._client.wait_for_workers(1, timeout=PATIENCE_S)
        except KeyboardInterrupt:
            self.__exit__(None, None, None)
            raise
        except (OSError, ValueError) as error:  # TimeoutError is an OSError
            self.__exit__(None, None, None)
            raise InputError(
                f"scheduler {self.address or 'of this machine'}: no workers ({error or 'none came'}); start them with "
                "`dask scheduler` and `dask worker ADDRESS`, and give the address"
            ) from error
        except RuntimeError as error:  # of distributed's own processes
            self.__exit__(None, None, None)
            raise InputError(
                f"dask could not start a cluster on this machine ({error}); where processes are limited (ulimit -u, or a "
                "container's limit), use threads: leave --engine out"
            ) from error
        self._check_workers(self._client)
        self._records = Records(self._client)
        return self

    def _check_workers(self, client: "Client") -> None:
        """Raise ``InputError`` for workers without rockbatch, whose tasks would never finish."""
        specs = client.run(find_spec, "rockbatch", on_error="return")
        lacking = [address for address, spec in specs.items() if spec is None or isinstance(spec, Exception)]
        if lacking:
            self.__exit__(None, None, None)
            raise InputError(
                f"there is no rockbatch where these workers run: {', '.join(lacking)}; install the same version there, in the "
                "Python that starts `dask worker`"
            )

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._client is not None:
            with suppress(TimeoutError):
                self._client.close(timeout=GONE_S)
            self._client = None
        self._opened.close()

    def __str__(self) -> str:
        place = self.address or "this machine"
        return f"a dask cluster of {self.jobs} thread{'s' * (self.jobs != 1)} ({place})"

    @property
    def jobs(self) -> int:
        """Return the number of threads of all workers that the scheduler last reported; 0 before it did."""
        if self._client is not None:
            with suppress(OSError):
                self._threads = sum(worker["nthreads"] for worker in _workers(self._client).values())
        return self._threads

    def outcomes(
        self, runs: Sequence[StudyRun], numerics: Numerics, observers: Sequence[Observer] = ()
    ) -> Generator[Group, None, None]:
        """Yield groups of runs with their outcomes, as they finish (:class:`rockbatch.batch.threads.Engine`).

        Raises ``InputError`` if several workers die at a group, or if the cluster is lost.
        """
        from distributed import CancelledError
        from distributed.scheduler import KilledWorker

        records = self._records
        assert self._client is not None
        assert records is not None, "an engine is a context"
        waiting = groups(runs, numerics, max(self.jobs, 1), MOST_RUNS_OF_A_TASK)
        pending: dict[Future, Group] = {}

        def hand_out() -> None:
            most = AHEAD * max(self.jobs, 1)
            while len(pending) < most and (group := next(waiting, None)):
                pending[records.submit(group.values(), numerics, observers)] = group

        try:
            hand_out()
            while pending:
                for future in self._finished_of(self._client, pending):
                    group = pending[future]
                    with starting_threads():  # a worker's error is raised here unchanged
                        outcomes = _result_of(self._client, future)
                    del pending[future]
                    yield finished(group, outcomes)
                    hand_out()
        except KeyboardInterrupt:
            yield from _finished_groups(pending)
            raise
        except KilledWorker as error:
            yield from _finished_groups(pending)
            raise InputError(
                f"runs {min(group) + 1} to {max(group) + 1} of those that were left: several workers died at them in turn, the "
                f"last {error.last_worker.address}; look at its log and memory, and give the same command again"
            ) from error
        except (CancelledError, OSError) as error:
            cause = "the connection to the scheduler broke" if isinstance(error, CancelledError) else error
            raise InputError(
                f"{self.address or 'the cluster of this machine'}: lost ({cause}); give the same command again to go on, with a "
                "scheduler and workers that are there"
            ) from error
        finally:
            if self._client.status == "running":
                self._client.cancel(list(pending))

    def _finished_of(self, client: "Client", pending: "Iterable[Future]") -> "list[Future]":
        """Return the futures that have finished, once one has; raise ``OSError`` if no worker is left, or if they die again and
        again.
        """
        from distributed import TimeoutError as NotYetError
        from distributed import wait

        began = last_seen = time.monotonic()
        alive, deaths = _able(_workers(client)), 0
        while True:
            try:
                return list(wait(list(pending), timeout=GLANCE_S, return_when="FIRST_COMPLETED").done)
            except NotYetError:
                patience, awaited = (PATIENCE_S, "worker") if client.status == "running" else (GONE_S, "scheduler")
                now = time.monotonic()
                listed = _workers(client)
                if able := _able(listed):
                    last_seen = now
                deaths += bool(alive - able)
                alive = able
                if now - last_seen > patience:
                    raise OSError(f"no {awaited} for {patience:g} s{_PAUSED * bool(listed)}") from None
                if deaths >= MOST_DEATHS and now - began > PATIENCE_S:
                    raise OSError(
                        f"workers died {deaths} times in {now - began:.0f} s and nothing was finished; look at their logs, and "
                        "give each more memory"
                    ) from None


def _workers(client: "Client") -> dict[str, Row]:
    """Return the workers' states by address; empty while disconnected; raise ``OSError`` if the scheduler does not answer."""
    if client.status != "running":
        return {}
    listed: dict[str, Row] = client.sync(client.scheduler.identity, callback_timeout=GONE_S)["workers"]
    return listed


def _result_of(client: "Client", future: "Future") -> list[Outcome | None]:
    """Return the outcomes of a finished group; raise ``OSError`` if they do not arrive, early if the scheduler is silent."""
    with suppress(TimeoutError):
        return list(future.result(timeout=GONE_S))
    _workers(client)
    return list(future.result(timeout=PATIENCE_S))


def _able(workers: dict[str, Row]) -> set[str]:
    """Return the addresses of the workers that have not paused."""
    return {address for address, worker in workers.items() if worker.get("status") != "paused"}


def _finished_groups(pending: "dict[Future, Group]") -> Iterator[Group]:
    """Yield those of the submitted groups that are finished, with their outcomes."""
    for future, group in pending.items():
        if future.status == "finished":
            yield finished(group, future.result())


class Records:
    """The records on a cluster, each sent once and kept for later batches.

    Each is the result of a task, which workers pass to each other, and which the scheduler repeats when all workers that
    held it have died.
    """

    def __init__(self, client: "Client") -> None:
        self.client = client
        self._sent: dict[int, tuple[Motion, Future]] = {}

    def submit(self, runs: Iterable[StudyRun], numerics: Numerics, observers: Sequence[Observer]) -> "Future":
        """Submit a group of runs, whose records are sent once each; return the future of their outcomes."""
        places: dict[int, int] = {}
        records = []
        members = []
        for run in runs:
            if id(run.record) not in places:
                places[id(run.record)] = len(places)
                records.append(self._record(run.record))
            members.append((places[id(run.record)], *run[1:]))
        return self.client.submit(simulate, records, members, numerics, observers, program(), pure=False)

    def _record(self, motion: Motion) -> "Future":
        if id(motion) not in self._sent:  # keeping the motion prevents reuse of its id
            self._sent[id(motion)] = motion, self.client.submit(_identity, motion, pure=False)
        return self._sent[id(motion)][1]


@contextmanager
def _quiet() -> Iterator[None]:
    """Silence the logs of distributed: lost connections are reported in one sentence instead."""
    names = [name for name in logging.root.manager.loggerDict if name.partition(".")[0] == "distributed"]
    levels = {logging.getLogger(name): logging.getLogger(name).level for name in names}
    for logger in levels:
        logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for logger, level in levels.items():
            logger.setLevel(level)


@contextmanager
def _without_interrupts() -> Iterator[None]:
    """Block Ctrl-C in this thread while processes start, which inherit that.

    No Ctrl-C is lost: another thread receives it, or it stays pending until the block ends.
    """
    if not hasattr(signal, "pthread_sigmask"):  # on Windows
        yield
        return
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)


def _identity(motion: Motion) -> Motion:
    return motion


def simulate(
    records: Sequence[Motion],
    members: Iterable[Member],
    numerics: Numerics,
    observers: Sequence[Observer],
    expected: str,
) -> list[Outcome | None]:
    """Simulate a group on a worker; raise ``InputError`` unless its program has the ``expected`` digest.

    ``members`` are the fields of :class:`StudyRun`, with an index into ``records`` in place of the record.
    """
    if program() != expected:
        raise InputError(
            f"a worker runs another rockbatch or another Numba ({program()}, not {expected}): install the same everywhere"
        )
    return outcomes_of([StudyRun(records[member[0]], *member[1:]) for member in members], numerics, observers)
