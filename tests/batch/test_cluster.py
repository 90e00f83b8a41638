"""Runs on a cluster: the table is the same bytes as by threads."""

import contextlib
import io
import logging
import os
import pickle
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import pytest
from many_runs import RUNS

import rockbatch.batch.dask
import rockbatch.batch.groups
import rockbatch.batch.threads
from rockbatch.batch.dask import Dask, Records, simulate
from rockbatch.batch.execution import execute_runs
from rockbatch.batch.groups import outcomes_of
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import silent
from rockbatch.batch.observers import observers_of
from rockbatch.batch.threads import Threads, cores
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.results.columns import columns


def table(folder, study, runs, engine, progress=silent):
    """Bytes of peaks.csv as an engine carries out the runs."""
    with engine, Journal(folder / "peaks.csv.part", columns(study), {}, fresh=True) as journal:
        execute_runs(runs, study.numerics, journal, engine, observers_of(study.output), progress=progress)
        journal.write_in_order(folder / "peaks.csv")
    return (folder / "peaks.csv").read_bytes()


@pytest.mark.slow
def test_a_cluster_with_a_worker_killed_in_the_middle_comes_to_the_same_bytes(tmp_path, study, runs, monkeypatch):
    distributed = pytest.importorskip("distributed")
    monkeypatch.setattr(rockbatch.batch.groups, "LEAST_GROUP", 4)
    done, killed = [], []
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
    ) as cluster:
        workers = list(cluster.workers.values())

        def kill_one(finished):
            done.append(finished)
            if not killed and sum(done) >= RUNS // 4:
                killed.append(workers[0].pid)
                os.kill(workers[0].pid, signal.SIGKILL)

        with monkeypatch.context() as patch:
            patch.setattr(rockbatch.batch.dask, "MOST_RUNS_OF_A_TASK", 4)
            found = table(tmp_path, study, runs, Dask(cluster.scheduler_address), kill_one)
        assert len(killed) == 1
        assert sum(done) == RUNS // 2  # the others are mirror images
    assert found == table(tmp_path, study, runs, Threads(2))


@pytest.mark.thorough
@pytest.mark.slow
def test_runs_at_which_workers_die_end_the_batch_and_what_is_finished_is_kept(tmp_path, study, runs, monkeypatch):
    """Here the first death is one too many; as delivered, dask allows three for a task."""
    distributed = pytest.importorskip("distributed")
    from dask import config

    monkeypatch.setattr(rockbatch.batch.groups, "LEAST_GROUP", 4)
    monkeypatch.setattr(rockbatch.batch.dask, "MOST_RUNS_OF_A_TASK", 4)
    with (
        config.set({"distributed.scheduler.allowed-failures": 0}),
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
        ) as cluster,
    ):
        (worker,) = cluster.workers.values()
        with pytest.raises(InputError, match=r"runs \d+ to \d+ .* workers died at them in turn, the last tcp://"):
            table(tmp_path, study, runs, Dask(cluster.scheduler_address), lambda _: os.kill(worker.pid, signal.SIGKILL))
    with Journal(tmp_path / "peaks.csv.part", columns(study), {}) as journal:
        assert 0 < len(journal) < RUNS


def test_an_empty_address_is_a_mistake_and_not_threads(file, tmp_path, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["run", str(file), "--out", str(tmp_path / "out"), "--scheduler", ""])
    assert ended.value.code == 2
    assert "--scheduler: must be an address such as tcp://10.0.0.1:8786; it is empty" in capsys.readouterr().err


def carried_out_by_dask(file, out):
    """Return what is said, and the table."""
    with contextlib.redirect_stderr(io.StringIO()) as said:
        rc = main(["run", str(file), "--out", str(out), "--engine", "dask", "--jobs", "1"])
    assert rc == 0, said.getvalue()
    return said.getvalue(), (out / "peaks.csv").read_bytes()


@pytest.mark.slow
def test_the_command_line_carries_out_a_study_on_a_cluster(file, tmp_path, study, runs, in_this_process):
    said, found = carried_out_by_dask(file, tmp_path / "out")
    assert "on a dask cluster of 1 thread (this machine)" in said
    assert found == table(tmp_path, study, runs, Threads(2))


@pytest.mark.slow
def test_the_command_line_carries_out_a_study_on_processes_of_this_machine(file, tmp_path, study, runs):
    pytest.importorskip("distributed")
    assert carried_out_by_dask(file, tmp_path / "out")[1] == table(tmp_path, study, runs, Threads(2))


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="no signal can be blocked here")
def test_ctrl_c_while_a_cluster_starts_ends_this_process_and_not_its_workers(monkeypatch):
    """A terminal sends it to all of them. It was lost in that second, and the batch went on to its end."""
    pytest.importorskip("distributed")
    workers, blocked = [], signal.pthread_sigmask(signal.SIG_BLOCK, ())

    def starts(**_):
        echo = "print(input(), flush=True)"
        workers.append(subprocess.Popen([sys.executable, "-c", echo], stdin=-1, stdout=-1, stderr=-1, text=True))
        for process in (workers[0].pid, os.getpid()):
            os.kill(process, signal.SIGINT)
        return SimpleNamespace(wait_for_workers=lambda *_, **__: time.sleep(5.0), close=lambda **_: None)

    earlier = signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell ignores in the background
    monkeypatch.setattr("distributed.Client", starts)
    try:
        with pytest.raises(KeyboardInterrupt):
            Dask(workers=1).__enter__()
        assert signal.pthread_sigmask(signal.SIG_BLOCK, ()) == blocked
        assert workers[0].communicate("goes on", timeout=60.0)[0] == "goes on\n"
    finally:
        signal.signal(signal.SIGINT, earlier)
        workers[0].kill()


def test_ctrl_c_while_workers_are_waited_for_closes_the_cluster(monkeypatch):
    pytest.importorskip("distributed")
    closed = []

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    client = SimpleNamespace(wait_for_workers=interrupted, close=lambda timeout: closed.append(timeout))
    monkeypatch.setattr("distributed.Client", lambda **_: client)
    with pytest.raises(KeyboardInterrupt):
        Dask(workers=1).__enter__()
    assert closed == [rockbatch.batch.dask.GONE_S]


def test_a_cluster_of_ones_own_has_the_workers_asked_for_or_one_for_each_core():
    assert [Dask(workers=workers).workers for workers in (1, 3, None)] == [1, 3, cores()]
    for workers in (0, -1):
        with pytest.raises(InputError, match=f"workers = {workers}: must be 1 or above"):
            Dask(workers=workers)


def test_without_dask_the_engine_says_how_to_get_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r'pip install "rockbatch\[dask\]"'):
        Dask().__enter__()


class Notebook:
    """Stands for a dask client: writes down what it is handed."""

    def __init__(self):
        self.tasks = []

    def submit(self, function, *given, **_):
        self.tasks.append((function, given))
        return f"future {len(self.tasks)}"


def test_each_record_is_sent_once_whatever_its_scales_polarities_and_cases(study, runs):
    client = Notebook()
    records = Records(client)
    for first in range(0, RUNS, 7):
        records.submit(runs[first : first + 7], study.numerics, observers_of(study.output))
    sent = [given for function, given in client.tasks if function is not simulate]
    assert [motion.name for (motion,) in sent] == ["one-sine", "one-cosine"]
    groups = [given for function, given in client.tasks if function is simulate]
    assert max(len(pickle.dumps(given)) for given in groups) < 5000  # a record is 3 kB and more, a run 100 bytes


def test_a_worker_rebuilds_the_very_runs(study, runs):
    ours = [*runs[:12], *runs[-12:]]
    client = Notebook()
    Records(client).submit(ours, study.numerics, observers_of(study.output))
    (_, (futures, members, *rest)) = client.tasks[-1]
    motions = [client.tasks[int(future.split()[1]) - 1][1][0] for future in futures]
    assert simulate(motions, members, *rest) == outcomes_of(ours, study.numerics, observers_of(study.output))


def test_what_distributed_logs_of_lost_connections_is_silenced_and_nothing_else():
    loggers = [
        logging.getLogger(name) for name in ("distributed.comm", "distributed", "undistributed", "numba.distributed")
    ]
    before = [logger.level for logger in loggers]
    with rockbatch.batch.dask._quiet():
        assert [logger.level == logging.CRITICAL for logger in loggers] == [True, True, False, False]
    assert [logger.level for logger in loggers] == before
