"""Piers whose shafts bend, side by side: the pass steps over no event, and gives the bits of scalar code."""

from dataclasses import replace

import numpy as np
import pytest
from bending_lanes import PIER, SPEEDS, STEPS, WAYS, judged
from bending_piers import shaken
from core_samples import values_of

import rockbatch as rb
from rockbatch.core.block.model import Stance
from rockbatch.core.clock import CALM, EVENTFUL, STANDS
from rockbatch.core.flexure.model import Flexing
from rockbatch.core.types import Ground
from rockbatch.pier import Damper
from rockbatch.simulation import Run, Stop, run_all_fixed, runs
from rockbatch.simulation.models import flexible_block

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
    assert (found.kind[found.watched] == EVENTFUL).all()
    for claim in (found.ends, found.taken, found.displaced, found.peak):
        assert claim.all()
    assert (found.kind == CALM).sum() > 200
    assert (found.kind == STANDS).sum() > 20
    assert found.event.sum() > 15
    assert ((found.kind >= EVENTFUL) & ~found.event & ~found.watched).mean() < 0.21


def test_the_moment_that_lifts_a_pier_and_its_rate_are_those_of_scalar_code(uncompiled):
    """Of a pier that stands, about both feet: by θ̈ there, and its difference over 2 µs of the motion."""
    m, rng, near = flexible_block(PIER, BASES["rock"]), np.random.default_rng(5), 1e-6
    (share, coupling), lifts, calls = (np.array(each) for each in (m.share, m.coupling)), [], []
    for _ in range(6):
        u, u_rate = rng.normal(0.0, WAYS), rng.normal(0.0, SPEEDS)
        y = Flexing(0.0, 0.0, 0.0, 0.0, *map(float, (*u, *u_rate)))
        shaking = Ground(*map(float, rng.normal(0.0, (1.0, 30.0, 1.0, 30.0))))
        stance = Stance(1.0, 1.0, 0.0, 0.0)
        (k,) = uncompiled(values_of, [("system", "rates", m, y, stance, shaking)])
        lifts.append(("flexure.passing", "_lift", m, y, k, shaking))
        for side in (-1.0, 1.0):
            for t in (-near, 0.0, near):
                there = Flexing(*(a + t * b for a, b in zip(y, k, strict=True)))
                calls.append(("block.events", "lifting", m, None, there, side, later_by(shaking, t)))
    found, accelerations = uncompiled(values_of, lifts), iter(uncompiled(values_of, calls))
    for lift, call in zip(found, lifts, strict=True):
        for side in (-1.0, 1.0):
            about = []
            for t in (-near, 0.0, near):
                u = np.array(call[3][4:8]) + t * np.array(call[4][4:8])
                inertia = m.inertia + m.height**2 + m.half_width**2 + u @ u - 2.0 * side * m.half_width * (share @ u)
                about.append(-next(accelerations) * (inertia - coupling @ coupling))
            assert lift.holds - side * lift.turns == pytest.approx(about[1], rel=1e-9)
            assert lift.holds_rate - side * lift.turns_rate == pytest.approx(
                (about[2] - about[0]) / (2.0 * near), rel=1e-4
            )


def test_a_held_shaft_hangs_where_its_stiffness_bears_the_weight_in_every_mode(uncompiled):
    m, weight = flexible_block(PIER, BASES["rock"]), 1.7
    (u,) = uncompiled(values_of, [("flexure.ending", "hanging", m, weight)])
    (pushes,) = uncompiled(
        values_of, [("flexure.equations", "straightening", m, Flexing(0.0, 0.1, 0.0, 0.0, *u, 0.0, 0.0, 0.0, 0.0))]
    )
    np.testing.assert_allclose(pushes, -weight * np.array(m.share), rtol=1e-12)


def later_by(ground, t):
    """Return the Ground ``t`` [s] later."""
    return ground._replace(
        horizontal=ground.horizontal + t * ground.horizontal_slope, vertical=ground.vertical + t * ground.vertical_slope
    )


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


@pytest.mark.parametrize(
    "base",
    [
        pytest.param(base, id=name, marks=pytest.mark.slow if name == "bouc-wen" else pytest.mark.thorough)
        for name, base in BASES.items()
    ],
)
def test_a_run_that_bends_is_the_same_to_the_bit_in_any_company(base):
    found = crowd(base)
    assert outcomes_of(found) == [outcome for run in found for outcome in outcomes_of([run])]


@pytest.mark.thorough
@pytest.mark.parametrize("damper", [Damper("viscous", nu=0.1), Damper("friction", f=0.05)], ids=["viscous", "friction"])
@pytest.mark.parametrize("base", [BASES["elastic"], BASES["bouc-wen"]], ids=["elastic", "bouc-wen"])
def test_a_pass_with_devices_of_a_shaft_that_bends_gives_what_events_give(base, damper, monkeypatch):
    """To the bit, with friction that sticks, too."""
    tied = [replace(run, base=replace(run.base, restraints=(damper,))) for run in crowd(base)]
    passed, made = outcomes_of(tied), runs.equipment_of
    monkeypatch.setattr(runs, "equipment_of", lambda *given: made(*given)._replace(passes=False))
    assert outcomes_of(tied) == passed
