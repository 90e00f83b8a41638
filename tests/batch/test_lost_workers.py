"""Workers and schedulers that cannot be used, die or do not answer: reported, and not waited for without end."""

import itertools
import re
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import pytest
from clusters import WORKER, cluster

import rockbatch.batch.dask
import rockbatch.batch.groups
import rockbatch.batch.threads
from rockbatch.batch.dask import Dask, _result_of, simulate
from rockbatch.batch.digests import program
from rockbatch.commands.cli import main
from rockbatch.common.errors import InputError

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


def test_a_worker_without_rockbatch_is_refused(file, tmp_path, capsys, in_this_process, monkeypatch):
    monkeypatch.setattr(rockbatch.batch.dask, "find_spec", lambda _: None)
    assert main(["run", str(file), "--out", str(tmp_path / "out"), "--engine", "dask", "--jobs", "1"]) == 2
    assert "there is no rockbatch where these workers run: inproc://" in capsys.readouterr().err


@pytest.mark.slow
def test_a_worker_without_rockbatch_is_reported_before_anything_waits_for_it(file, tmp_path, capsys):
    """It would end at the first task, and whoever waits for that would wait for ever."""
    pytest.importorskip("distributed")
    with cluster(tmp_path, ["-c", WITHOUT_ROCKBATCH]) as (address, _, _):
        assert main(["run", str(file), "--out", str(tmp_path / "out"), "--scheduler", address]) == 2
    assert "there is no rockbatch where these workers run: tcp://127.0.0.1:" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.parametrize("how", [signal.SIGKILL, pytest.param(signal.SIGSTOP, marks=pytest.mark.thorough)])
def test_a_scheduler_that_stops_or_falls_silent_is_reported_in_a_sentence(file, tmp_path, how):
    """And soon; in a process of its own, because distributed logs to the real stderr."""
    pytest.importorskip("distributed")
    file.write_text(file.read_text().replace("[0.5, 1.0]", str([0.5 + 0.001 * i for i in range(120)])))
    part = tmp_path / "out" / "peaks.csv.part"
    command = [sys.executable, "-m", "rockbatch", "run", str(file), "--out", str(part.parent), "--scheduler"]
    with cluster(tmp_path, WORKER) as (address, scheduler, _):
        run = subprocess.Popen([*command, address], stderr=subprocess.PIPE, text=True)
        try:
            until = time.monotonic() + 300
            while not (part.exists() and part.read_bytes().count(b"\n") > 1):
                assert time.monotonic() < until
                time.sleep(0.1)
            scheduler.send_signal(how)
            started = time.monotonic()
            _, told = run.communicate(timeout=60)
        finally:
            run.kill()
            run.wait()
    assert run.returncode == 2
    assert time.monotonic() - started < 40
    assert f"rockbatch: {address}: lost (" in told
    assert "give the same command again to go on, with a scheduler and workers that are there" in told
    assert "Traceback" not in told
    assert "distributed." not in told


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
