"""Histories that are written side by side are those of runs that are written down one by one."""

import numpy as np
import pytest

from rockbatch.motions import Motion
from rockbatch.pier import Damper, ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.simulation import Run, Stop, recording, run_all_fixed
from rockbatch.simulation.recording import recorded, recorded_side_by_side
from rockbatch.simulation.runs import try_all

PIER = Pier(0.2, 1.0)
BASES = (
    YieldingBase(50.0, 0.1, eta=2.0, flight="guided"),
    ElasticBase(60.0, 0.2, flight="guided"),
    RigidBase(),
    RigidBase(restraints=(Damper("friction", f=0.1),)),
)


@pytest.fixture(scope="module")
def runs():
    """Runs of all kinds in turn, at two steps, and their outcomes."""
    found = []
    for i in range(32):
        noise = np.random.default_rng(i).normal(size=(2, 120 + 20 * (i % 7)))
        dt = (0.01, 0.008, 0.005)[i % 3]
        found.append(Run(PIER, BASES[i % 4], Motion(f"noise {i}", dt, 5.0 * noise[0], 3.0 * noise[1])))
    outcomes = run_all_fixed(found, [4 + 4 * (i // 4 % 2) for i in range(32)], 1.0, Stop())
    assert sum(outcome.impacts for outcome in outcomes) > 300
    return found, outcomes


def rows_of(*given, **more):
    return {i: found.rows for i, found in recorded_side_by_side(*given, **more)}


def same(runs, outcomes, together, wait=True):
    """Return whether histories written ``together`` are, to the bit, those of runs by themselves."""
    alone = {
        i: recorded(run, outcome, 1.0, every_step=False, wait=wait).rows
        for i, (run, outcome) in enumerate(zip(runs, outcomes, strict=True))
    }
    return sorted(together) == sorted(alone) and all(
        rows.dtype == alone[i].dtype and rows.tobytes() == alone[i].tobytes() for i, rows in together.items()
    )


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("room", [recording.ROWS_TOGETHER, 2000, 1], ids=["all", "a few", "one"])
def test_histories_written_side_by_side_are_those_written_alone(runs, room, monkeypatch):
    """Whatever finds room together; pivots land and lift off in all of them, and the springs' velocities turn."""
    monkeypatch.setattr(recording, "ROWS_TOGETHER", room)
    assert same(*runs, rows_of(*runs, 1.0))


def test_those_that_end_with_their_quiet_time_are_those_written_alone(runs):
    assert same(*runs, rows_of(*runs, 1.0, wait=False), wait=False)


def test_a_history_that_finds_no_room_beside_others_is_written_alone(runs, monkeypatch):
    expected = rows_of(*runs, 1.0)
    monkeypatch.setattr(recording, "_room", lambda *_, **__: 50)
    found = rows_of(*runs, 1.0)
    assert min(map(len, found.values())) > 50
    assert {i: rows.tobytes() for i, rows in found.items()} == {i: rows.tobytes() for i, rows in expected.items()}


def test_histories_that_are_too_long_are_left_out_and_a_stop_leaves_out_the_rest(runs, monkeypatch):
    lengths = {i: len(rows) for i, rows in rows_of(*runs, 1.0).items()}
    most = int(np.median(list(lengths.values())))
    monkeypatch.setattr(recording, "MOST_ROWS", most)
    monkeypatch.setattr(recording, "ROWS_TOGETHER", 1)
    assert {i for i, _ in recorded_side_by_side(*runs, 1.0)} == {i for i, rows in lengths.items() if rows <= most}
    monkeypatch.setattr(recording, "ROWS_TOGETHER", 150_000)
    # That one is too long shows only once it is written beside others
    monkeypatch.setattr(recording, "_room", lambda *_, **__: 50)
    assert {i for i, _ in recorded_side_by_side(*runs, 1.0)} == {i for i, rows in lengths.items() if rows <= most}
    stop = Stop()
    stop.set()
    assert list(recorded_side_by_side(*runs, 1.0, stop=stop)) == []


def test_runs_side_by_side_go_on_for_times_of_their_own(runs):
    """To the bit as alone, and for just that time behind the record."""
    some, outcomes = runs[0][3::4], runs[1][3::4]
    steps, tails = [outcome.substeps for outcome in outcomes], [0.5 + 0.1 * i for i in range(len(some))]
    together = try_all(some, steps, tails, Stop(), wait=False)
    for run, substeps, tail, trial in zip(some, steps, tails, together, strict=True):
        (alone,) = try_all([run], [substeps], tail, Stop(), wait=False)
        assert trial.outcome == alone.outcome
        if trial.outcome.status == "ok":
            assert trial.outcome.t_end == pytest.approx(run.motion.duration + tail, abs=run.motion.dt)
    assert sum(trial.outcome.status == "ok" for trial in together) > 4
