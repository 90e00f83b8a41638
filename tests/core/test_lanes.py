"""Runs side by side: company changes nothing, and the pass's signals are those of the scalar code."""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import hard_case

from rockbatch.core.equations import geometry, rates
from rockbatch.core.events import at_rest, signals
from rockbatch.core.lanes import LANES, watch
from rockbatch.core.transitions import Supports
from rockbatch.core.types import BOUC_WEN, ELASTIC, EPP, Contact, State
from rockbatch.pier import Pier, YieldingBase
from rockbatch.simulation import Run, Stop, run_all_fixed, springs


def crowd():
    """Three times as many runs as lanes, of every kind, with records of different length and sampling interval."""
    runs = []
    for seed in range(3 * LANES):
        pier, base, motion = hard_case(seed, npts=60 + 17 * (seed % 11))
        runs.append(Run(pier, base, replace(motion, dt=(0.005, 0.01, 0.004)[seed % 3])))
    return runs, [4 + 4 * (seed % 4) for seed in range(3 * LANES)]


def test_what_a_run_comes_to_is_the_same_to_the_bit_alone_and_in_any_company():
    runs, substeps = crowd()
    together = run_all_fixed(runs, substeps, 1.0, Stop())
    alone = [run_all_fixed([run], [steps], 1.0, Stop())[0] for run, steps in zip(runs, substeps, strict=True)]
    order = np.random.default_rng(1).permutation(len(runs))
    shuffled = run_all_fixed([runs[i] for i in order], [substeps[i] for i in order], 1.0, Stop())
    assert {outcome.status for outcome in alone} >= {"ok", "overturned", "flight"}
    assert sum(outcome.impacts for outcome in alone) > 200
    assert [repr(outcome) for outcome in together] == [repr(outcome) for outcome in alone]
    assert [repr(shuffled[list(order).index(i)]) for i in range(len(runs))] == [repr(outcome) for outcome in alone]


CONTACTS = [
    Contact(1.0, 1.0, 1.0, 0.0, 0.0),
    Contact(1.0, 1.0, 0.0, 1.0, 0.0),
    Contact(1.0, 0.0, 1.0, 0.0, 0.0),
    Contact(0.0, 1.0, 0.0, 0.0, 0.0),
    Contact(0.0, 0.0, 0.0, 0.0, 0.0),
]


@pytest.mark.parametrize("law", [ELASTIC, BOUC_WEN, EPP], ids=["elastic", "bouc-wen", "epp"])
@pytest.mark.parametrize("contact", CONTACTS, ids=["loading-left", "loading-right", "left", "right", "flight"])
def test_what_the_pass_watches_is_linear_in_z_position_and_velocity_with_the_values_of_the_signals(law, contact):
    """A velocity signal is compared to the velocity that counts as none, which the pass subtracts."""
    m = springs(Pier(0.2, 1.0), YieldingBase(50.0, eta=2.2))._replace(law=law)
    rest = at_rest(m)
    supports = Supports(-0.004, -0.003)
    a = np.reshape(watch(law, contact, supports, rest), (4, 3))
    rng = np.random.default_rng(7)
    for _ in range(50):
        scale = np.array([0.01, 0.05, 0.1, 0.5, 1.0, 1.0])
        y = State(*(scale * rng.uniform(-1.0, 1.0, 6)))
        k = rates(m, y, contact, 1.0, 0.5)
        values, _ = signals(m, y, k, contact, *supports, rest, 1.0, 0.5)
        at = geometry(m, y.theta)
        for side, z, position, velocity in (
            (0, y.z_left, y.v + at.lift_left, y.v_rate + at.arm_left * y.omega),
            (1, y.z_right, y.v + at.lift_right, y.v_rate + at.arm_right * y.omega),
        ):
            contact_signal, law_signal = a[2 * side], a[2 * side + 1]
            watched = contact_signal @ (z, position, 1.0), law_signal @ (z, velocity, 1.0)
            subtracted = rest if law_signal[1] else 0.0
            assert watched[0] == pytest.approx(values[side], abs=1e-15)
            assert watched[1] + subtracted == pytest.approx(values[2 + side], abs=1e-15)


def test_a_lane_that_finishes_early_makes_room_for_the_next_run():
    """Short and long runs mixed: all of them are there, each with its own end."""
    runs, _ = crowd()
    shaken = [replace(run, motion=replace(run.motion, horizontal=0.0 * run.motion.horizontal)) for run in runs]
    still = [replace(run, motion=replace(run.motion, vertical=None)) for run in shaken]
    found = run_all_fixed(still, [16] * len(still), 0.5, Stop(), wait=False)
    for run, outcome in zip(still, found, strict=True):
        dt = run.motion.dt
        assert outcome.status == "ok"
        assert outcome.t_end == pytest.approx((run.motion.npts - 1 + math.ceil(0.5 / dt - 1e-9)) * dt)
