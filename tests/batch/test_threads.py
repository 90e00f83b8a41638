"""Runs in threads: each once, and those that are finished are kept whatever ends the batch."""

import itertools
import json
import re
import time
from pathlib import Path

import pytest
from many_runs import RUNS
from studies import RIGID, study_text

import rockbatch.batch.dask
import rockbatch.batch.groups
import rockbatch.batch.threads
from rockbatch.batch.groups import outcomes_of
from rockbatch.batch.threads import Threads
from rockbatch.commands.cli import main


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


def test_where_no_more_threads_can_be_started_a_sentence_says_so(file, tmp_path, capsys, monkeypatch):
    """As under `ulimit -u`, which does not hold for root."""

    def refuses(_):
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr("threading.Thread.start", refuses)
    assert main(["run", str(file), "--out", str(tmp_path / "out")]) == 2
    assert "no more threads can be started: the number of processes is limited here" in capsys.readouterr().err


def test_a_clock_that_jumps_back_an_hour_and_forth_a_day_changes_no_result(file, tmp_path, monkeypatch):
    file.write_text(study_text(cases=(RIGID,), output={"histories": "none"}))
    assert main(["run", str(file), "--out", str(tmp_path / "steady")]) == 0
    plain, jumps = time.time, itertools.cycle([0, -3600, 86400])
    monkeypatch.setattr(time, "time", lambda: plain() + next(jumps))
    assert main(["run", str(file), "--out", str(tmp_path / "jumping")]) == 0
    assert (tmp_path / "jumping/peaks.csv").read_bytes() == (tmp_path / "steady/peaks.csv").read_bytes()
    assert 0 < json.loads((tmp_path / "jumping/run.json").read_text(encoding="utf-8"))["wall_s"] < 600
