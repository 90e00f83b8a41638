"""The rigid base side by side: company changes nothing, and the pass steps over nothing that happens."""

import platform
import re
from dataclasses import replace

import numba
import numpy as np
import pytest
from core_samples import broadband, pulse

from rockbatch.core.records import LANES, table
from rockbatch.core.rigid.lane import LANE, RUN
from rockbatch.core.rigid.passing import one_pass
from rockbatch.core.rigid.runs import rock_side_by_side, run_line
from rockbatch.core.types import BEFORE_EVENT, RUNNING, SAMPLE, Block
from rockbatch.motions.motion import Motion
from rockbatch.pier import Pier, RigidBase
from rockbatch.simulation import Run, Stop, ground_of, run_all_fixed, written_run


def crowd():
    """Three times as many runs as lanes, weak and strong, short and long, and some whose ground falls away."""
    rng = np.random.default_rng(11)
    scenes = []
    for i in range(3 * LANES):
        dt, npts = (0.005, 0.01, 0.02)[i % 3], 80 + 37 * (i % 11)
        vertical = broadband(rng, dt, npts, 14.0 if i % 8 == 1 else 3.0) if i % 2 else None
        motion = Motion(f"noise {i}", dt, broadband(rng, dt, npts, rng.uniform(1.0, 9.0)), vertical)
        base = RigidBase((0.5, 0.9, None, 0.0)[i % 4], flight="stop" if i % 16 == 1 else "guided")
        scenes.append(Run(Pier(rng.uniform(0.08, 0.4), rng.uniform(0.4, 3.0)), base, motion))
    return scenes, [(1, 2, 3, 8)[i % 4] for i in range(3 * LANES)]


def test_what_a_run_comes_to_is_the_same_to_the_bit_alone_and_in_any_company():
    scenes, substeps = crowd()
    together = run_all_fixed(scenes, substeps, 1.0, Stop())
    alone = [run_all_fixed([scene], [steps], 1.0, Stop())[0] for scene, steps in zip(scenes, substeps, strict=True)]
    order = np.random.default_rng(1).permutation(len(scenes))
    shuffled = run_all_fixed([scenes[i] for i in order], [substeps[i] for i in order], 1.0, Stop())
    assert {outcome.status for outcome in alone} >= {"ok", "overturned", "flight"}
    assert sum(outcome.impacts for outcome in alone) > 500
    assert [repr(outcome) for outcome in together] == [repr(outcome) for outcome in alone]
    assert [repr(shuffled[list(order).index(i)]) for i in range(len(scenes))] == [repr(outcome) for outcome in alone]


def test_a_run_that_is_written_down_is_the_run_that_is_not():
    scenes, substeps = crowd()
    outcomes = run_all_fixed(scenes, substeps, 1.0, Stop())
    for scene, steps, outcome in zip(scenes, substeps, outcomes, strict=True):
        run, rows = written_run(scene, steps, 1.0, 20_000, every_step=True)
        assert run.rows <= len(rows)
        assert (run.impacts, run.t_end, run.t_max) == (outcome.impacts, outcome.t_end, outcome.t_max)
        assert np.abs(rows.theta[: run.rows]).max() <= run.theta_max * (1.0 + 1e-12)
        assert np.count_nonzero(rows.kind[: run.rows] == BEFORE_EVENT) == run.impacts
        assert (np.diff(rows.t[: run.rows]) >= 0.0).all()


def test_the_pass_steps_over_no_impact():
    """Between the rows of a history the block keeps its side, but where an impact is written between them."""
    scenes, substeps = crowd()
    crossings = 0
    for scene, steps in zip(scenes, substeps, strict=True):
        run, rows = written_run(scene, steps, 1.0, 20_000, every_step=True)
        theta, kind = rows.theta[: run.rows], rows.kind[: run.rows]
        goes_over = theta[1:] * theta[:-1] < 0.0
        crossings += np.count_nonzero(np.diff(np.sign(theta[theta != 0.0])))
        assert not goes_over.any()
        assert not theta[kind == BEFORE_EVENT].any()
    assert crossings > 300


def test_extremes_of_windows_are_those_of_the_samples():
    scenes, substeps = crowd()
    for scene, steps in zip(scenes, substeps, strict=True):
        m = Block(scene.pier.alpha, scene.pier.p, scene.pier.gravity, 0.9)
        ground = ground_of(scene.motion)
        line = run_line(m, 0.0, 0.0, scene.motion.dt, steps, 20, 0, len(ground))
        result = rock_side_by_side([line], ground, Stop().flag)[0]
        run, rows = written_run(replace(scene, base=RigidBase(0.9)), steps, 20 * scene.motion.dt, 20_000, wait=False)
        rows = rows[: run.rows]
        samples = np.abs(rows.theta[rows.kind == SAMPLE])[1:]
        windows = (np.arange(1, len(samples) + 1) * 32 // (len(ground) + 19)).clip(max=31)
        for window in range(32):
            inside = samples[windows == window]
            greatest = result.extremes[window]
            assert np.isnan(greatest) if not len(inside) else greatest == inside.max()


def test_a_block_that_lies_down_or_rests_makes_room_for_the_next():
    """More runs than lanes, each with its own end: at rest all the time, or overturned by what tips it at the start."""
    motion = pulse("sine", 0.1, 0.1, dt=0.01, end=1.0)
    lines = [
        run_line(Block(0.2, 2.0, 9.81, 0.9), 1.3 if i % 3 == 0 else 0.0, 0.0, 0.01, 1 + i % 2, i, 0, motion.npts)
        for i in range(5 * LANES)
    ]
    for i, result in enumerate(rock_side_by_side(lines, ground_of(motion), Stop().flag)):
        if i % 3 == 0:
            assert result.theta_max >= 0.5 * np.pi
        else:
            assert (result.theta_max, result.t_rest) == (0.0, 0.0)
            assert result.t_end == pytest.approx((motion.npts - 1 + i) * 0.01)


def test_runs_that_were_stopped_say_that_they_are_not_over():
    stop = Stop()
    stop.set()
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=3.0)
    line = run_line(Block(0.2, 2.0, 9.81, 0.9), 0.1, 0.0, 0.01, 4, 0, 0, motion.npts)
    results = rock_side_by_side([line] * 40, ground_of(motion), stop.flag)
    assert (results.status == RUNNING).all()
    assert run_all_fixed([Run(Pier(0.2, 2.0), RigidBase(), motion)], [4], 1.0, stop) == [None]


def test_the_numbers_of_one_run_and_of_all_lanes_are_in_the_same_order():
    """They are copied by their order when a run enters a lane or leaves it."""
    assert [(part, RUN[part].names) for part in RUN.names] == [(part, LANE[part].names) for part in LANE.names]
    assert RUN.itemsize * LANES == LANE.itemsize


@numba.njit(error_model="numpy", _nrt=False)
def passes(lanes, count):
    one_pass(lanes, count)


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="looks for the instructions of x86-64")
def test_the_pass_is_vector_instructions():
    """As many products of several numbers at once as of one, which the lanes that are left over take; and no calls."""
    passes(table(LANE)[0], LANES)
    (code,) = passes.inspect_asm().values()
    body = code[: code.index("_ZN7cpython")]
    packed, single = len(re.findall(r"\bv?mulpd\b", body)), len(re.findall(r"\bv?mulsd\b", body))
    assert packed >= single > 60
    assert not re.findall(r"\bcall\w*\b.*\b(sin|cos)\b", body)
