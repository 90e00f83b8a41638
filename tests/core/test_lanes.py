"""Runs side by side: company changes nothing, and reversals that the pass corrects are as good as located ones."""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import EVERY_KIND, FIG5, hard_case, hard_seeds

from rockbatch.core.ground import later
from rockbatch.core.rk4 import rk4
from rockbatch.core.springs.laws import CODES, kept_sign
from rockbatch.core.springs.model import Contact, State
from rockbatch.core.springs.reversal import Pivot, corrected, pivot_accelerations, pivots, reversal
from rockbatch.core.system import rates
from rockbatch.core.table import LANES
from rockbatch.core.types import Ground, Instant
from rockbatch.motions import Motion
from rockbatch.pier import RigidBase, YieldingBase
from rockbatch.simulation import Run, Stop, run_all_fixed, springs


def crowd(kinds):
    """Three times as many runs as lanes, of many kinds, with records of different length and sampling interval."""
    runs = []
    for seed in hard_seeds(range(13 * LANES), kinds)[: 3 * LANES]:
        pier, base, motion = hard_case(seed, npts=60 + 17 * (seed % 11))
        if seed % 4 == 0 and isinstance(base, YieldingBase):
            base = replace(base, spring="hardening", n=base.n if base.has_exponent else 5.0)
        if seed % 3 == 0 and base.has_epsilon:
            base = replace(base, epsilon=0.0, impact="housner")
        runs.append(Run(pier, base, replace(motion, dt=(0.005, 0.01, 0.004)[seed % 3])))
    return runs, [4 + 4 * (seed % 4) for seed in range(3 * LANES)]


@EVERY_KIND
def test_what_a_run_comes_to_is_the_same_to_the_bit_alone_and_in_any_company(kinds):
    runs, substeps = crowd(kinds)
    together = run_all_fixed(runs, substeps, 1.0, Stop())
    alone = [run_all_fixed([run], [steps], 1.0, Stop())[0] for run, steps in zip(runs, substeps, strict=True)]
    order = np.random.default_rng(1).permutation(len(runs))
    shuffled = run_all_fixed([runs[i] for i in order], [substeps[i] for i in order], 1.0, Stop())
    assert {outcome.status for outcome in alone} >= {"ok", "overturned", "flight"}
    assert sum(outcome.impacts for outcome in alone) > 200
    assert [repr(outcome) for outcome in together] == [repr(outcome) for outcome in alone]
    assert [repr(shuffled[list(order).index(i)]) for i in range(len(runs))] == [repr(outcome) for outcome in alone]


@pytest.mark.parametrize(
    "base", [YieldingBase(50.0, 0.1, eta=2.0, flight="guided"), RigidBase()], ids=["springs", "rigid"]
)
def test_what_a_run_comes_to_does_not_depend_on_how_many_lanes_are_empty(base):
    """Vector instructions take empty lanes along, and those left over are taken one by one."""
    runs = [Run(FIG5, base, shaken(i, 80 + 9 * i)) for i in range(LANES)]
    alone = [repr(run_all_fixed([run], [4], 0.5, Stop())[0]) for run in runs]
    assert len(set(alone)) == LANES
    for number in range(2, LANES + 1):
        found = run_all_fixed(runs[:number], [4] * number, 0.5, Stop())
        assert [repr(outcome) for outcome in found] == alone[:number]


def shaken(seed, npts):
    """White noise."""
    return Motion(f"noise {seed}", 0.01, 6.0 * np.random.default_rng(seed).normal(size=npts))


MODEL = springs(FIG5, YieldingBase(50.0, eta=2.2))
GROUND = Ground(1.0, 3.0, 0.5, -2.0)
LOADING = State(-0.02, 0.002, -0.01, -0.004, -0.75, -0.5), Contact(1.0, 1.0, 1.0, 0.0, 0.0)
UNLOADING = State(-0.02, 0.002, 0.01, 0.004, -0.75, -0.5), Contact(1.0, 1.0, 0.0, 0.0, 0.0)


def fine(y, contact, t, h, parts=200):
    """State after ``h`` [s] from ``t`` on one branch, as good as exact."""
    for i in range(parts):
        ground = later(GROUND, t + i * h / parts)
        y = rk4(MODEL, None, Instant(y, rates(MODEL, y, contact, ground), contact, None, ground), h / parts)
    return y


def left_turn(y, contact, until):
    """When the left pivot's velocity turns before ``until`` [s], by halving."""
    sign, early = math.copysign(1.0, pivots(MODEL, y)[0].velocity), 0.0
    for _ in range(50):
        middle = 0.5 * (early + until)
        turned = sign * pivots(MODEL, fine(y, contact, 0.0, middle))[0].velocity < 0.0
        early, until = (early, middle) if turned else (middle, until)
    return until


@pytest.mark.parametrize("after", [0.2, 0.7], ids=["late", "early"])
@pytest.mark.parametrize(("begin", "until"), [(LOADING, 0.01), (UNLOADING, 0.07)], ids=["to-unloading", "to-loading"])
def test_a_step_across_a_reversal_is_corrected_to_the_next_order(begin, until, after):
    """One branch throughout, then corrected, against both branches in turn; ω_v h = 0.2, ``after`` of it behind.

    Of what the other branch changes, 10⁻⁴ is left in the spring's own z, 1 % in velocities, 3 % in positions and in the
    other spring's z, which are wrong in the second, third and fourth order of the step without the correction.
    """
    y, contact = begin
    h, turn = 0.004, left_turn(y, contact, until)
    at_turn, t = fine(y, contact, 0.0, turn), turn - (1.0 - after) * h
    start, ground = fine(y, contact, 0.0, t), later(GROUND, t)
    end = fine(start, contact, t, h)
    truth = fine(at_turn, contact._replace(left_yields=1.0 - contact.left_yields), turn, after * h)
    k = rates(MODEL, start, contact, ground)
    signs = kept_sign(CODES["bouc-wen"], 1.0, contact.left_yields), 0.0
    given = zip(
        signs, pivots(MODEL, start), pivot_accelerations(MODEL, start, k), pivots(MODEL, end), end[4:], strict=True
    )
    found = [reversal(MODEL, sign, *more, h) for sign, *more in given]
    assert [one.after > 0.0 for one in found] == [True, False]
    assert found[0].z == pytest.approx(at_turn.z_left, abs=3e-8)
    left = np.abs(np.subtract(corrected(MODEL, contact, end, *found), truth)) / np.abs(np.subtract(end, truth))
    assert (left < [0.03, 0.03, 0.01, 0.01, 1e-4, 0.03]).all(), left


@pytest.mark.parametrize(("sign", "softness"), [(1.0, 1.0), (0.0, 1.0), (-1.0, 1.0 - 0.5**5)])
def test_a_spring_whose_velocity_keeps_its_sign_stays_as_it_is(sign, softness):
    """It follows displacements by its own branch: elastic, without one that depends on the velocity, and inelastic."""
    start, end = Pivot(0.0, 1e-3 * sign), Pivot(1e-5 * sign, 1e-3 * sign)
    found = reversal(MODEL, sign, start, 0.0, end, -0.5, 0.01)
    unstressed = end.position + 0.5 * MODEL.yield_deflection
    assert found[:5] == (0.0, -0.5, unstressed, 0.0, pytest.approx(softness, rel=1e-15))
    assert found.surely > 0.0


def test_two_reversals_in_one_step_and_sharp_ones_are_left_to_the_search():
    sign = kept_sign(CODES["bouc-wen"], 1.0, 0.0)
    assert (sign, kept_sign(CODES["bouc-wen"], 1.0, 1.0)) == (1, -1)
    assert (kept_sign(CODES["epp"], 1.0, 0.0), kept_sign(CODES["epp"], 1.0, 1.0)) == (0, -1)
    # w = 0.001 (1 − 8 s + 8 s²) dips to −0.001 and is back; the way between is −1/3 of that of 0.001
    dipping = reversal(MODEL, sign, Pivot(0.0, 1e-3), -0.8, Pivot(-1e-5 / 3.0, 1e-3), -0.5, 0.01)
    steady = reversal(MODEL, sign, Pivot(0.0, 1e-3), 0.0, Pivot(1e-5, 1e-3), -0.5, 0.01)
    assert (dipping.after, dipping.surely < 0.0, steady.surely > 0.0) == (0.0, True, True)
    # The whole yield deflection in one step
    way = 0.5 * MODEL.yield_deflection
    sharp = reversal(MODEL, sign, Pivot(0.0, 0.0), -200.0 * way, Pivot(-way, -2.0 * way / 0.01), -0.9, 0.01)
    assert sharp.after > 0.0 > sharp.surely


def test_a_lane_that_finishes_early_makes_room_for_the_next_run():
    """Short and long runs mixed: all of them are there, each with its own end."""
    runs, _ = crowd("common")
    shaken = [replace(run, motion=replace(run.motion, horizontal=0.0 * run.motion.horizontal)) for run in runs]
    still = [replace(run, motion=replace(run.motion, vertical=None)) for run in shaken]
    found = run_all_fixed(still, [16] * len(still), 0.5, Stop(), wait=False)
    for run, outcome in zip(still, found, strict=True):
        dt = run.motion.dt
        assert outcome.status == "ok"
        assert outcome.t_end == pytest.approx((run.motion.npts - 1 + math.ceil(0.5 / dt - 1e-9)) * dt)
