"""Piers whose shafts bend, side by side: the pass steps over no event, and gives the bits of scalar code."""

from dataclasses import replace

import numpy as np
import pytest
from bending_lanes import PIER, STEPS, judged
from bending_piers import shaken

import rockbatch as rb
from rockbatch.core.clock import CALM, EVENTFUL, STANDS
from rockbatch.pier import Damper
from rockbatch.simulation import Run, Stop, run_all_fixed, runs

BENDS = {"shaft": "elastic", "flexural_damping": 0.03}
SPRINGS = BENDS | {"kinematics": "finite", "zeta": 0.2}
BASES = {
    "rock": rb.RigidBase(**BENDS),
    "elastic": rb.ElasticBase.from_stiffness(PIER, 3e6, **SPRINGS),
    "bouc-wen": rb.YieldingBase.from_stiffness(PIER, 3e6, eta=2.2, spring="bouc-wen", **SPRINGS),
}


@pytest.mark.parametrize("base", BASES.values(), ids=list(BASES))
def test_the_pass_steps_over_no_event_of_a_shaft_that_bends(base, uncompiled):
    """Random moments with contacts, standing, rocking and in flight: what stands is to the bit what the search steps over."""
    parts = [uncompiled(judged, base, seed, 12, h) for seed, h in enumerate(STEPS)]
    found = type(parts[0])(*map(np.concatenate, zip(*parts, strict=True)))
    assert not found.event[found.kind < EVENTFUL].any()
    for claim in (found.ends, found.taken, found.displaced, found.peak):
        assert claim.all()
    assert (found.kind == CALM).sum() > 200
    assert (found.kind == STANDS).sum() > 20
    assert found.event.sum() > 15
    assert ((found.kind >= EVENTFUL) & ~found.event).mean() < 0.3


def crowd(base):
    """More runs than lanes, weak and strong, some in flight."""
    scenes = []
    for i in range(20):
        pier = replace(PIER, flexural_period_s=0.5 + 0.04 * i)
        motion = shaken(2.0 + 0.25 * i, 0.8 + 0.1 * (i % 7), upwards=0.9 * (i % 3 == 0), duration=3.0)
        modes = {"flexural_modes": 1 + i % 4}
        scenes.append(Run(pier, replace(base, **modes), motion))
    return scenes


def outcomes_of(found, leaves_out=()):
    """What the runs came to, to the last bit, without the work of devices."""
    outcomes = run_all_fixed(found, [64] * len(found), 1.0, Stop())
    return [repr(replace(outcome, **dict.fromkeys(leaves_out))) for outcome in outcomes]


@pytest.mark.slow
@pytest.mark.parametrize("base", BASES.values(), ids=list(BASES))
def test_a_run_that_bends_is_the_same_to_the_bit_in_any_company(base):
    found = crowd(base)
    assert outcomes_of(found) == [outcome for run in found for outcome in outcomes_of([run])]


@pytest.mark.thorough
@pytest.mark.parametrize("base", [BASES["elastic"], BASES["bouc-wen"]], ids=["elastic", "bouc-wen"])
def test_a_pass_with_devices_of_a_shaft_that_bends_gives_what_events_give(base, monkeypatch):
    """To the bit; a damper as weak as rounding leaves the run what it is without one."""
    tied = [replace(run, base=replace(run.base, restraints=(Damper("viscous", nu=0.1),))) for run in crowd(base)]
    passed, made = outcomes_of(tied), runs.equipment_of
    monkeypatch.setattr(runs, "equipment_of", lambda *given: made(*given)._replace(passes=False))
    assert outcomes_of(tied) == passed
