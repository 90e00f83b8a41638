"""Runs with devices side by side: company changes nothing, and the pass gives what event by event is found."""

from dataclasses import replace

import numpy as np
import pytest
from core_samples import FIG5, doubts_of_grips, rows_by_pass_and_by_events, values_of
from scipy.interpolate import CubicHermiteSpline

from rockbatch.core.devices.bounds import Course
from rockbatch.core.devices.elongation import Gap
from rockbatch.core.devices.lanes import Mode
from rockbatch.core.devices.laws import OPENS, SLACK, STICKS, TAUT, TENDON, YIELDING, Use
from rockbatch.core.table import LANES
from rockbatch.motions import Motion
from rockbatch.pier import Damper, Pier, RigidBase, Tendon, YieldingBase
from rockbatch.simulation import Run, Stop, run_all_fixed, runs
from rockbatch.simulation.elements import IDLE
from rockbatch.simulation.runs import written_runs

VISCOUS, SLIDING = Damper("viscous", nu=0.2), Damper("friction", f=0.05)
RESTRAINTS = {
    "none": (),
    "viscous": (VISCOUS,),
    "power": (Damper("viscous", nu=0.1, exponent=0.5),),
    "tendon": (Tendon(psi=0.1, lam=0.5),),
    "weak tendon": (Tendon(lam=0.5, strength=0.02),),
    "friction": (SLIDING,),
    "middle": (Damper("friction", f=0.5, at=0.0),),
    "hysteretic": (Damper("hysteretic", f=0.05, yield_m=0.005),),
    "braced": (Damper("hysteretic", f=0.05, yield_m=0.005, brace=5.0),),
    "several": (VISCOUS, Tendon(psi=0.1, lam=0.5), Damper("hysteretic", f=0.02, yield_m=0.01, at=0.0)),
}
BASES = {
    "bouc-wen": YieldingBase(50.0, 0.1, eta=2.3, flight="guided"),
    "epp": YieldingBase(50.0, 0.1, eta=2.3, flight="guided", spring="epp"),
    "rigid": RigidBase(),
}
EVERY_BASE = pytest.mark.parametrize("base", BASES.values(), ids=list(BASES))


def shaken(seed):
    """Noise that decays, with a vertical component."""
    noise = np.cumsum(np.random.default_rng(seed).normal(size=(2, 120 + 20 * (seed % 5))), axis=1)
    fades = np.exp(-np.linspace(0.0, 2.0, noise.shape[1]))
    return Motion(f"noise {seed}", (0.01, 0.008)[seed % 2], 1.5 * fades * noise[0], 0.5 * fades * noise[1])


def crowd(base, names=RESTRAINTS):
    """More runs with each kind of restraints than lanes, in turn."""
    tied = [replace(base, restraints=RESTRAINTS[name]) for name in names]
    return [Run(FIG5, tied[i % len(tied)], shaken(i)) for i in range(len(tied) * (LANES + 3))]


def outcomes_of(found):
    """What the runs came to, to the last bit."""
    return [repr(outcome) for outcome in run_all_fixed(found, [4] * len(found), 1.0, Stop())]


@EVERY_BASE
def test_a_run_with_devices_is_the_same_to_the_bit_alone_and_in_any_company(base):
    found = crowd(base)[::3]
    alone = [outcome for run in found for outcome in outcomes_of([run])]
    order = np.random.default_rng(2).permutation(len(found))
    shuffled = outcomes_of([found[i] for i in order])
    assert outcomes_of(found) == alone
    assert [shuffled[list(order).index(i)] for i in range(len(found))] == alone


@pytest.fixture
def without_a_pass(monkeypatch):
    """Leaves all devices to scalar code; returns whether each batch from then on would have had a pass."""

    def leave_all():
        made, had = runs.equipment_of, []

        def event_by_event(*given):
            equipment = made(*given)
            had.append(equipment is not None and equipment.passes)
            return None if equipment is None else equipment._replace(passes=False)

        monkeypatch.setattr(runs, "equipment_of", event_by_event)
        return had

    return leave_all


@EVERY_BASE
def test_the_pass_with_devices_gives_what_is_found_event_by_event(base, without_a_pass):
    """Peaks, impacts, residuals, and forces, strokes, speeds and energies of devices, to the bit."""
    found = crowd(base)
    passed, had = outcomes_of(found), without_a_pass()
    assert outcomes_of(found) == passed
    # Both tendons go in one call; runs without devices and with braces have no such pass
    assert had.count(True) == len(RESTRAINTS) - 3


@EVERY_BASE
def test_histories_by_the_pass_are_those_found_event_by_event(base, without_a_pass):
    """At each sample: the state of the pier, and states and energies of the devices, work of ground and P–Δ, to the bit."""
    crowds = [crowd(base, (name,))[:5] for name in RESTRAINTS if name != "none"]
    passed = [written_runs(found, 4, 1.0, 2000) for found in crowds]
    without_a_pass()
    for found, by_pass in zip(crowds, passed, strict=True):
        for (_, rows), (_, rows_by_pass) in zip(written_runs(found, 4, 1.0, 2000), by_pass, strict=True):
            assert rows.tobytes() == rows_by_pass.tobytes()
            assert rows.input.any()


SHAKES = [Motion(f"noise × {a}", 0.01, a * shaken(i).horizontal[20:35]) for i, a in ((1, 0.5), (2, 2.5))]
FRAME = replace(Pier.frame(Pier.rectangle(2.0, 12.0, mass_t=60.0), 4, 180.0), initial_rotation_rad=0.1)
MIDDLE = (Damper("friction", f=0.5, at=0.0),)
HELD = {
    "large rotations": (FIG5, YieldingBase(50.0, 0.1, eta=2.3, flight="guided", kinematics="finite")),
    "frame": (FRAME, RigidBase()),
}


@pytest.mark.parametrize("case", HELD)
def test_the_pass_holds_by_friction_what_is_held_event_by_event(case, uncompiled):
    """By the kinematics of large rotations, and below the columns of a frame."""
    pier, base = HELD[case]
    found = [Run(pier, replace(base, restraints=MIDDLE), motion) for motion in SHAKES]
    (by_pass, repeated), (by_events, all_repeated) = uncompiled(rows_by_pass_and_by_events, found, 2)
    assert by_pass == by_events
    assert repeated < all_repeated


def test_each_lane_judges_by_its_own_forces_whether_friction_may_slip(uncompiled):
    """Friction of strength 1 may slip if the least reserve is below twice the range of its force; one that slips has none."""
    lanes = [
        (STICKS, [0.5, 0.5, 0.5, 0.5, 0.6]),
        (STICKS, [0.5, 0.5, 0.5, 0.5, 1.1]),
        (STICKS, [-0.6, -0.7, -0.7, -0.7, -0.8]),
        (STICKS, [0.2, 0.2, 0.9, 0.2, 0.2]),
        (STICKS, [0.0] * 5),
        (OPENS, [0.0] * 5),
    ]
    found = uncompiled(doubts_of_grips, lanes)
    assert found == [(False, True), (True, True), (True, True), (True, True), (False, False), (False, False)]
    assert uncompiled(doubts_of_grips, lanes[::-1]) == found[::-1]


TIE = IDLE._replace(kind=TENDON, strength=4.0, stiffness=30.0, prestress=1.0)
NO_USE = Use(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def course(start, end, h=0.1):
    """The Course of a tendon between two pairs of elongation [m] and speed [m/s]."""
    ends = (Gap(*each, 1.0, 0.0, 0.0, 0.0) for each in (start, end))
    return Course(*ends, 0.0, 0.0, 0.0, 0.0, 0.0, h, h, 1e-9, 1e-9, 1e-9)


@pytest.mark.parametrize(
    ("start", "end", "mode", "keeps"),
    [
        ((0.05, 0.2), (0.06, -0.2), TAUT, True),
        ((0.09, 1.0), (0.09, -1.0), TAUT, False),  # 3.7 at both ends, but 4.7 by the cubic's inner points
        ((0.02, 0.5), (0.11, 3.0), TAUT, False),  # 4.3 at the end, 2.1 at most by the inner points
        ((0.02, -0.5), (-0.04, -3.0), TAUT, False),  # -0.2 at the end, 1.1 at least by the inner points
        ((-0.02, -1.0), (-0.02, 1.0), TAUT, False),  # 0.4 at both ends, slack between
        ((-0.05, 0.2), (-0.06, -0.2), SLACK, True),
        ((-0.05, 1.0), (-0.05, -1.0), SLACK, False),
        ((0.12, 0.2), (0.13, 0.2), YIELDING, False),
    ],
)
def test_the_pass_leaves_a_tendon_that_may_yield_or_slacken_inside_to_scalar_code(start, end, mode, keeps, uncompiled):
    """Its force is 1 + 30 e, and it yields at 4."""
    (sure,) = uncompiled(values_of, [("devices.bounds", "_keeps_mode", TIE, mode, course(start, end))])
    assert (sure > 0.0) == keeps


def test_the_pass_leaves_a_greatest_force_inside_a_sub_step_to_scalar_code(uncompiled):
    """Of a tendon that turns after it is drawn out; not of one that goes on, nor if a greater force was before."""
    turns, goes_on = course((0.05, 1.0), (0.05, -1.0)), course((0.05, 1.0), (0.09, 1.0))
    calls = [
        ("devices.bounds", "most_of_tendon", TIE, Mode(TAUT, OPENS), c, NO_USE._replace(most=most), NO_USE)
        for c, most in ((turns, 0.0), (goes_on, 0.0), (turns, 3.9))
    ]
    found = uncompiled(values_of, calls)
    assert [most for most, _ in found] == pytest.approx([2.5, 3.7, 3.9])
    assert [stronger > 0.0 for _, stronger in found] == [True, False, False]


def test_what_the_pass_takes_as_greatest_is_exceeded_nowhere_inside(uncompiled):
    """Of random cubics that turn: where no more is suspected, 101 points have none; of those far below it there is none."""
    rng, h, s = np.random.default_rng(4), 0.1, np.linspace(0.0, 1.0, 101)
    ends = [
        tuple(map(float, (f0, d0, f1, -d1))) for f0, d0, f1, d1 in rng.uniform([0, 0, 0, 0], [1, 20, 1, 20], (200, 4))
    ]
    calls = [("devices.bounds", "_greatest", *each, h, best) for each in ends for best in (0.0, 1.0, 9.0)]
    for (*_, f0, d0, f1, d1, _, best), (most, beyond) in zip(calls, uncompiled(values_of, calls), strict=True):
        inside = np.abs(CubicHermiteSpline([0.0, h], [f0, f1], [d0, d1])(h * s)).max()
        assert most == max(best, f0, f1)
        assert beyond > 0.0 or inside <= most
        assert beyond <= 0.0 or best < 9.0


def test_a_hysteretic_damper_counts_as_plastic_within_rounding(uncompiled):
    """At the end of a sub-step of the pass: its z approaches 1 exponentially, and would never reach it."""
    ends = (1.0 - 5e-15, 5e-15 - 1.0, 1.0 - 1e-13, 1e-13 - 1.0, 0.3)
    found = uncompiled(values_of, [("devices.passing", "_snapped", z) for z in ends])
    assert found == [1.0, -1.0, *ends[2:]]


def share_repeated(base, name, monkeypatch):
    """Share of the sub-steps of runs with one kind of restraints that is integrated event by event."""
    found, marched, march = crowd(base, (name,)), [], runs.march
    monkeypatch.setattr(runs, "march", lambda *given: marched.append(march(*given)) or marched[-1])
    outcomes = run_all_fixed(found, [4] * len(found), 1.0, Stop())
    steps = sum(outcome.t_end / run.motion.dt * 4.0 for run, outcome in zip(found, outcomes, strict=True))
    return sum(records.repeated.sum() for records in marched) / steps


@pytest.mark.parametrize("name", ["viscous", "tendon", "friction", "hysteretic", "several"])
@pytest.mark.parametrize(("base", "most"), [("epp", 0.05), ("rigid", 0.2)])
def test_the_pass_takes_most_sub_steps_with_devices(base, most, name, monkeypatch):
    """The noise throws blocks on rigid ground into the air now and then, where all sub-steps are repeated."""
    assert 0.0 < share_repeated(BASES[base], name, monkeypatch) < most


def test_without_a_pass_all_sub_steps_are_repeated(monkeypatch):
    """Braced dampers have none."""
    assert share_repeated(BASES["rigid"], "braced", monkeypatch) == pytest.approx(1.0, abs=0.01)
