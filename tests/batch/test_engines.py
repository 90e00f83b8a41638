"""Engines: whatever carries out the runs, and whatever becomes of it meanwhile, the table is the same bytes."""

import contextlib
import io
import itertools
import json
import logging
import os
import pickle
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest
from studies import COSINE, PADS, RIGID, SINE, study_text, write_study

import rockbatch.batch.dask
import rockbatch.batch.groups
import rockbatch.batch.threads
from rockbatch.batch.dask import Dask, Records, _result_of, simulate
from rockbatch.batch.digests import program
from rockbatch.batch.execution import execute_runs
from rockbatch.batch.groups import outcomes_of
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import silent
from rockbatch.batch.observers import observers_of
from rockbatch.batch.plan import Plan
from rockbatch.batch.threads import Threads
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError
from rockbatch.results.columns import columns
from rockbatch.study import load_study
from rockbatch.study.suite import ground_motions

pytestmark = pytest.mark.usefixtures("no_report")

STUDY = study_text(
    title="Two pulses on many foundations",
    motions={"polarity": ["+", "-"], "scale": [0.5, 1.0]},
    pulses=(SINE, COSINE),
    cases=(RIGID, PADS | {"beta": [30, 50], "eta": [2.0, 3.0], "epsilon": 0.1}),
    output={"both_laws": False, "histories": "none", "forces": True},
)
RUNS = 2 * 2 * 2 * 5


@pytest.fixture
def file(tmp_path):
    return write_study(tmp_path, STUDY)


@pytest.fixture
def study(file):
    return load_study(file)


@pytest.fixture
def runs(study):
    return Plan(study, ground_motions(study))


def table(folder, study, runs, engine, progress=silent):
    """Bytes of peaks.csv as an engine carries out the runs."""
    with engine, Journal(folder / "peaks.csv.part", columns(study), {}, fresh=True) as journal:
        execute_runs(runs, study.numerics, journal, engine, observers_of(study.output), progress=progress)
        journal.write_in_order(folder / "peaks.csv")
    return (folder / "peaks.csv").read_bytes()


@pytest.mark.parametrize("jobs", [1, 2, 7])
def test_threads_yield_every_run_once(study, runs, jobs):
    with Threads(jobs) as engine:
        found = [index for group in engine.outcomes(runs, study.numerics) for index in group]
    assert sorted(found) == list(range(RUNS))


@pytest.mark.parametrize("error", [KeyboardInterrupt, ValueError])
def test_after_ctrl_c_or_an_error_come_the_groups_that_are_finished(study, runs, monkeypatch, error):
    monkeypatch.setattr(rockbatch.batch.threads, "groups", lambda runs, *_: iter([{i: runs[i]} for i in range(6)]))
    handed = []

    def third_interrupts(*asked):
        handed.append(asked)
        if len(handed) == 3:
            raise error
        return outcomes_of(*asked)

    monkeypatch.setattr(rockbatch.batch.threads, "outcomes_of", third_interrupts)
    found = []
    with pytest.raises(error):  # noqa: PT012
        for group in Threads(1).outcomes(runs, study.numerics):
            found += group
    assert sorted(found[:2]) == [0, 1]  # groups come as they finish, and two may have by the time they are asked for
    assert 2 not in found


def test_threads_load_nothing_of_a_cluster():
    imported = re.compile(r"^(?:import|from) (?:dask|distributed)\b", re.MULTILINE)
    files = Path(rockbatch.__file__).parent.rglob("*.py")
    assert not [file for file in files if imported.search(file.read_text(encoding="utf-8"))]


# A dask cluster


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


WITHOUT_ROCKBATCH = """
import sys

class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] == "rockbatch":
            raise ModuleNotFoundError("No module named 'rockbatch'", name="rockbatch")

sys.meta_path.insert(0, Blocked())
from distributed.cli.dask_worker import main
main(["ADDRESS", "--no-nanny", "--nthreads", "1", "--no-dashboard"])
"""


@pytest.fixture
def in_this_process(monkeypatch):
    """Let workers be threads of this process, which start at once."""
    distributed = pytest.importorskip("distributed")
    client, changes = distributed.Client, {"processes": False, "dashboard_address": ":0"}
    monkeypatch.setattr(distributed, "Client", lambda **given: client(**given | changes))


def test_a_worker_without_rockbatch_is_refused(file, tmp_path, capsys, in_this_process, monkeypatch):
    monkeypatch.setattr(rockbatch.batch.dask, "find_spec", lambda _: None)
    assert main(["run", str(file), "--out", str(tmp_path / "out"), "--engine", "dask", "--jobs", "1"]) == 2
    assert "there is no rockbatch where these workers run: inproc://" in capsys.readouterr().err


@pytest.mark.slow
def test_a_worker_without_rockbatch_is_reported_before_anything_waits_for_it(file, tmp_path, capsys):
    """It would end at the first task, and whoever waits for that would wait for ever."""
    pytest.importorskip("distributed")
    scheduler = subprocess.Popen(
        [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
         "--scheduler-file", str(tmp_path / "scheduler.json")], stderr=subprocess.DEVNULL,
    )  # fmt: skip
    address = address_of(tmp_path / "scheduler.json")
    code = WITHOUT_ROCKBATCH.replace("ADDRESS", address)
    worker = subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.DEVNULL)
    try:
        assert main(["run", str(file), "--out", str(tmp_path / "out"), "--scheduler", address]) == 2
        assert "there is no rockbatch where these workers run: tcp://127.0.0.1:" in capsys.readouterr().err
    finally:
        worker.kill()
        scheduler.kill()
        worker.wait()
        scheduler.wait()


def address_of(file):
    """Of a scheduler that was started with this file."""
    until = time.monotonic() + 60
    while time.monotonic() < until:
        with contextlib.suppress(OSError, ValueError):
            return json.loads(file.read_text())["address"]
        time.sleep(0.1)
    raise AssertionError("no scheduler")


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGKILL, pytest.param(signal.SIGSTOP, marks=pytest.mark.thorough)])
def test_a_scheduler_that_stops_or_falls_silent_is_reported_in_a_sentence(file, tmp_path, how):
    """And soon; in a process of its own, because distributed logs to the real stderr."""
    pytest.importorskip("distributed")
    file.write_text(file.read_text().replace("[0.5, 1.0]", str([0.5 + 0.001 * i for i in range(120)])))
    dask = [sys.executable, "-m"]
    scheduler = subprocess.Popen(
        [*dask, "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
         "--scheduler-file", str(tmp_path / "scheduler.json")], stderr=subprocess.DEVNULL,
    )  # fmt: skip
    address = address_of(tmp_path / "scheduler.json")
    worker = subprocess.Popen(
        [*dask, "distributed.cli.dask_worker", address, "--no-nanny", "--no-dashboard"], stderr=subprocess.DEVNULL
    )
    part = tmp_path / "out" / "peaks.csv.part"
    run = subprocess.Popen(
        [*dask, "rockbatch", "run", str(file), "--out", str(part.parent), "--scheduler", address],
        stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    try:
        until = time.monotonic() + 300
        while not (part.exists() and part.read_bytes().count(b"\n") > 1):
            assert time.monotonic() < until
            time.sleep(0.1)
        scheduler.send_signal(how)
        started = time.monotonic()
        _, told = run.communicate(timeout=60)
        assert run.returncode == 2
        assert time.monotonic() - started < 40
        assert f"rockbatch: {address}: lost (" in told
        assert "give the same command again to go on, with a scheduler and workers that are there" in told
        assert "Traceback" not in told
        assert "distributed." not in told
    finally:
        for process in (worker, scheduler, run):
            process.kill()
            process.wait()


class Late:
    """A future whose result does not come the first ``times``, and a client whose scheduler ``answers`` or does not."""

    status = "running"
    scheduler = SimpleNamespace(identity=None)

    def __init__(self, times, answers):
        self.times, self.answers, self.asked = times, answers, 0

    def result(self, timeout):
        self.asked += 1
        if self.asked <= self.times:
            raise TimeoutError
        return ["outcomes"]

    def sync(self, ask, callback_timeout):
        if not self.answers:
            raise TimeoutError
        return {"workers": {}}


def test_a_result_that_does_not_come_is_waited_for_only_while_the_scheduler_answers():
    late, silent, never = Late(1, answers=True), Late(1, answers=False), Late(2, answers=True)
    assert _result_of(late, late) == ["outcomes"]
    with pytest.raises(TimeoutError):
        _result_of(silent, silent)
    assert silent.asked == 1
    with pytest.raises(TimeoutError):
        _result_of(never, never)
    assert never.asked == 2


@pytest.mark.parametrize("error", ["cancelled", OSError("timed out")])
def test_a_lost_scheduler_is_reported_with_what_lost_it(study, runs, monkeypatch, error):
    distributed = pytest.importorskip("distributed")
    words = "timed out" if isinstance(error, OSError) else "the connection to the scheduler broke"

    def lost(self, client, pending):
        raise distributed.CancelledError("task-1") if error == "cancelled" else error

    monkeypatch.setattr(Dask, "jobs", 1)
    monkeypatch.setattr(Dask, "_finished_of", lost)
    engine = Dask("tcp://10.0.0.1:8786")
    engine._client = SimpleNamespace(status="closed")
    engine._records = SimpleNamespace(submit=lambda *task: object())
    with pytest.raises(
        InputError, match=re.escape(f"tcp://10.0.0.1:8786: lost ({words}); give the same command again")
    ):
        list(engine.outcomes(runs, study.numerics))


def test_an_empty_address_is_a_mistake_and_not_threads(file, tmp_path, capsys):
    with pytest.raises(SystemExit) as ended:
        main(["run", str(file), "--out", str(tmp_path / "out"), "--scheduler", ""])
    assert ended.value.code == 2
    assert "--scheduler: must be an address such as tcp://10.0.0.1:8786; it is empty" in capsys.readouterr().err


def test_where_no_more_threads_can_be_started_a_sentence_says_so(file, tmp_path, capsys, monkeypatch):
    """As under `ulimit -u`, which does not hold for root."""

    def refuses(_):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr("threading.Thread.start", refuses)
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 2
    assert "no more threads can be started: the number of processes is limited here" in capsys.readouterr().err


def carried_out_by_dask(file, out):
    """Return what is said, and the table."""
    with contextlib.redirect_stderr(io.StringIO()) as said:
        rc = main(["run", str(file), "--out", str(out), "--engine", "dask", "--jobs", "1"])
    assert rc == 0, said.getvalue()
    return said.getvalue(), (out / "peaks.csv").read_bytes()


def test_the_command_line_carries_out_a_study_on_a_cluster(file, tmp_path, study, runs, in_this_process):
    said, found = carried_out_by_dask(file, tmp_path / "out")
    assert "on a dask cluster of 1 thread (this machine)" in said
    assert found == table(tmp_path, study, runs, Threads(2))


@pytest.mark.slow
def test_the_command_line_carries_out_a_study_on_processes_of_this_machine(file, tmp_path, study, runs):
    pytest.importorskip("distributed")
    assert carried_out_by_dask(file, tmp_path / "out")[1] == table(tmp_path, study, runs, Threads(2))


def test_a_clock_that_jumps_back_an_hour_and_forth_a_day_changes_no_result(file, tmp_path, monkeypatch):
    file.write_text(study_text(cases=(RIGID,), output={"histories": "none"}))
    assert main(["run", str(file), "--out", str(tmp_path / "steady")]) == 0
    plain, jumps = time.time, itertools.cycle([0, -3600, 86400])
    monkeypatch.setattr(time, "time", lambda: plain() + next(jumps))
    assert main(["run", str(file), "--out", str(tmp_path / "jumping")]) == 0
    assert (tmp_path / "jumping/peaks.csv").read_bytes() == (tmp_path / "steady/peaks.csv").read_bytes()
    assert 0 < json.loads((tmp_path / "jumping/run.json").read_text(encoding="utf-8"))["wall_s"] < 600


def test_a_scheduler_that_does_not_answer_is_reported(file, tmp_path, capsys, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(rockbatch.batch.dask, "PATIENCE_S", 0.2)
    out = tmp_path / "out"
    assert main(["run", str(file), "--out", str(out), "--scheduler", "tcp://127.0.0.1:9"]) == 2
    assert "scheduler tcp://127.0.0.1:9: no workers" in capsys.readouterr().err


class FullWorkers:
    """A client whose workers have no memory for what they are asked, and finish nothing: they pause, or die and come again."""

    status = "running"

    def __init__(self, pause: bool) -> None:
        self.scheduler = self
        self.pause, self.looks = pause, 0

    def sync(self, asked, callback_timeout):
        return asked()

    def identity(self):
        self.looks += 1
        address, status = ("tcp://a", "paused") if self.pause else (f"tcp://{self.looks}", "running")
        return {"workers": {address: {"status": status, "nthreads": 1}}}


@pytest.mark.parametrize(
    ("pause", "said"),
    [(True, "no worker for 0.2 s: all have paused"), (False, "workers died [5-9] times in 0")],
)
def test_workers_without_memory_are_not_waited_for_for_ever(monkeypatch, pause, said):
    import distributed

    def nothing(*_, **__):
        time.sleep(0.05)
        raise distributed.TimeoutError

    monkeypatch.setattr(distributed, "wait", nothing)
    monkeypatch.setattr(rockbatch.batch.dask, "PATIENCE_S", 0.2)
    engine = Dask("tcp://a")
    engine._client = client = FullWorkers(pause)
    with pytest.raises(OSError, match=said):
        engine._finished_of(client, ())


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


def test_a_worker_with_other_kernels_refuses(study):
    with pytest.raises(InputError, match=rf"{program()}, not 0123\): install the same everywhere"):
        simulate([], [], study.numerics, (), "0123")


def test_workers_that_die_and_come_again_are_waited_for_while_there_is_patience(monkeypatch):
    """Nor is patience lost with a few deaths, however long ago the first was."""
    import distributed

    looks = []

    def late(*_, **__):
        looks.append(1)
        if len(looks) < 9:
            raise distributed.TimeoutError
        return SimpleNamespace(done={"future"})

    monkeypatch.setattr(distributed, "wait", late)
    engine = Dask("tcp://a")
    engine._client = client = FullWorkers(pause=False)
    assert engine._finished_of(client, ()) == ["future"]
    looks.clear()
    monkeypatch.setattr(rockbatch.batch.dask, "MOST_DEATHS", 9)
    monkeypatch.setattr(rockbatch.batch.dask, "PATIENCE_S", -1.0)
    with pytest.raises(OSError, match="no worker for -1 s"):  # not the deaths, though they took longer
        engine._finished_of(client, ())


def test_workers_that_died_are_counted_from_the_first_that_was_seen(monkeypatch):
    """The one that is there at first has not died; each that is gone at the next look has."""
    import distributed

    def late(*_, **__):
        raise distributed.TimeoutError

    monkeypatch.setattr(distributed, "wait", late)
    seconds = itertools.count(0.0, 30.0)
    monkeypatch.setattr(rockbatch.batch.dask, "time", SimpleNamespace(monotonic=lambda: next(seconds)))
    engine = Dask("tcp://a")
    engine._client = client = FullWorkers(pause=False)
    with pytest.raises(OSError, match="workers died 5 times in 150 s and nothing was finished"):
        engine._finished_of(client, ())
    assert client.looks == 6


def test_what_distributed_logs_of_lost_connections_is_silenced_and_nothing_else():
    loggers = [
        logging.getLogger(name) for name in ("distributed.comm", "distributed", "undistributed", "numba.distributed")
    ]
    before = [logger.level for logger in loggers]
    with rockbatch.batch.dask._quiet():
        assert [logger.level == logging.CRITICAL for logger in loggers] == [True, True, False, False]
    assert [logger.level for logger in loggers] == before
