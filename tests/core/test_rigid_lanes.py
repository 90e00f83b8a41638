"""The rigid base side by side: company changes nothing, and the pass steps over nothing that happens."""

from dataclasses import replace

import numpy as np
import pytest
from core_runs import block_line, run_blocks
from core_samples import broadband, pulse

from rockbatch.core.table import LANES
from rockbatch.core.types import (
    BEFORE_EVENT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LIFT_OFF,
    REST,
    RUNNING,
    SAMPLE,
)
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, Pier, RigidBase
from rockbatch.simulation import Run, Stop, block, ground_of, run_all_fixed, run_fixed, written_run
from rockbatch.simulation.runs import try_all

LANDINGS = (IMPACT_LEFT, IMPACT_RIGHT, IMPACT_BOTH, REST)


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
        kinds = rows.kind[: run.rows]
        upright = np.abs(rows.theta[: run.rows]) < scene.pier.alpha  # what topples and lands on its way is no impact
        assert (np.isin(kinds, LANDINGS) & upright).sum() + (kinds == IMPACT_BOTH).sum() == run.impacts
        events = np.flatnonzero((kinds > 0.0) & (kinds != LIFT_OFF))  # at which nothing jumps
        assert (kinds[events - 1] == BEFORE_EVENT).all()
        assert (np.diff(rows.t[: run.rows]) >= 0.0).all()


def test_the_pass_steps_over_no_impact():
    """Between the rows of a history a block that rocks keeps its side, but where an impact is written between them.

    1e-12 α: what is left of the rotation when an impact has been located.
    """
    scenes, substeps = crowd()
    crossings = 0
    for scene, steps in zip(scenes, substeps, strict=True):
        run, rows = written_run(scene, steps, 1.0, 20_000, every_step=True)
        rows = rows[: run.rows].view(np.recarray)
        side = rows.right - rows.left
        assert (side * rows.theta >= -1e-12 * scene.pier.alpha).all()
        crossings += np.count_nonzero(np.diff(side[side != 0.0]))
    assert crossings > 300


def test_the_pass_does_what_event_by_event_comes_to():
    """A damper without force has every sub-step searched for events: the same counts, and the peak within RK4's error.

    The damper's velocity reversals divide steps, of which the coarsest are p h = 0.05: 1e-6 of the peak.
    """
    scenes, substeps = crowd()
    flights = 0
    for scene, steps in zip(scenes, substeps, strict=True):
        idle = replace(scene.base, restraints=(Damper("viscous", nu=0.0),))
        passed, searched = (
            run_fixed(scene.pier, base, scene.motion, steps, 1.0, wait=False) for base in (scene.base, idle)
        )
        for name in ("status", "impacts", "separations", "flights"):
            assert getattr(passed, name) == getattr(searched, name), scene.motion.name
        assert passed.theta_max == pytest.approx(searched.theta_max, rel=1e-6)
        assert passed.t_end == pytest.approx(searched.t_end, rel=1e-6)
        flights += passed.flights
    assert flights > 3


def test_extremes_of_windows_are_those_of_the_samples():
    scenes, substeps = crowd()
    for scene, steps in zip(scenes, substeps, strict=True):
        quiet_s, npts = 20 * scene.motion.dt, scene.motion.npts
        (trial,) = try_all([scene], [steps], quiet_s, Stop(), wait=False)
        run, rows = written_run(scene, steps, quiet_s, 20_000, wait=False)
        rows = rows[: run.rows]
        samples = np.abs(rows.theta[rows.kind == SAMPLE])[1:]
        windows = (np.arange(1, len(samples) + 1) * 32 // (npts + 19)).clip(max=31)
        for window in range(32):
            inside = samples[windows == window]
            greatest = trial.extremes[window]
            assert np.isnan(greatest) if not len(inside) else greatest == inside.max()


def test_a_block_that_lies_down_or_rests_makes_room_for_the_next():
    """More runs than lanes, each with its own end: at rest all the time, or overturned by what tips it at the start."""
    motion = pulse("sine", 0.1, 0.1, dt=0.01, end=1.0)
    m = block(Pier(0.2, 2.0), RigidBase(0.9))
    lines = [block_line(m, 1.3 if i % 3 == 0 else 0.0, 0.0, 0.01, 2, motion.npts, i) for i in range(5 * LANES)]
    for i, result in enumerate(run_blocks(lines, ground_of(motion), 2)):
        if i % 3 == 0:
            assert result.theta_max >= 0.5 * np.pi
        else:
            assert (result.theta_max, result.t_rest) == (0.0, 0.0)
            assert result.t_end == pytest.approx((motion.npts - 1 + i) * 0.01)


def test_runs_that_were_stopped_say_that_they_are_not_over():
    stop = Stop()
    stop.set()
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=3.0)
    line = block_line(block(Pier(0.2, 2.0), RigidBase(0.9)), 0.1, 0.0, 0.01, 4, motion.npts)
    results = run_blocks([line] * 40, ground_of(motion), 4, stop=1)
    assert (results.status == RUNNING).all()
    assert run_all_fixed([Run(Pier(0.2, 2.0), RigidBase(), motion)], [4], 1.0, stop) == [None]
