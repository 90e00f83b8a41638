"""Lift stops (THEORY.md, Stops and deck springs) against closed forms and solvers of their own."""

import math

import numpy as np
import pytest
from core_samples import FIG5, TOWER, broadband, pulse
from device_checks import SEEDS, assert_agreement, assert_balance, assert_fourth_order, reference
from stopped_piers import BASES, BOUC_WEN, ELASTIC, RANDOM_BASES, SHAKEN, crossed, stiffness, stopped, thrown

import rockbatch as rb
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, RigidBase, Stop, Tendon, problems
from rockbatch.simulation import run_fixed, run_to_tolerance
from rockbatch.simulation.steps import first_substeps

STOPS = {
    "elastic": (Stop(0.04, 20.0),),
    "crushes": (Stop(0.04, 20.0, 0.4),),
    "stiff": (Stop(0.05, 500.0, 0.7),),
    "no gap": (Stop(0.0, 1.0, 0.5),),
    "apart": (Stop(0.03, 10.0, 0.8, at=0.5), Stop(0.05, 40.0, 0.3, at="left")),
}


@pytest.mark.parametrize("e", [1.0, 0.7, 0.2])
@pytest.mark.parametrize("lam", [1.0, 30.0, 1000.0])
def test_the_energy_of_a_blow_is_that_of_closed_forms(e, lam):
    """½ k δ² at the peak is the kinetic energy less the work of the weight; e² of it comes back, and the rest is lost.

    ½ (θ̇/p)² = cos(α − θ) − cos α + ½ k δ²/(p² I_O/M) with δ = 4 b sin(θ/2) − gap, and behind the blow at the gap the same less
    (1 − e²) of the last term.
    """
    alpha, b, inertia = FIG5.alpha, FIG5.half_width, FIG5.inertia_about_pivot
    stop = Stop(0.04, lam, e)
    k = stiffness(FIG5, stop.lam)
    omega = 0.6 * FIG5.p * math.sqrt(2.0 * (1.0 - math.cos(alpha)))
    rows, use = thrown(FIG5, RigidBase(0.05, (stop,), confirm=("restitution",)), omega)  # no other blow follows
    upright = np.flatnonzero(rows.kind > 0.0)[0] - 1  # again, before its impact
    peak = np.argmax(rows.theta[:upright])
    theta = rows.theta[peak]
    deflection = 4.0 * b * math.sin(0.5 * theta) - stop.gap_m
    climbed = math.cos(alpha - theta) - math.cos(alpha)
    stored = 0.5 * k * deflection**2 / (inertia * FIG5.p**2)
    assert stored > 0.05 * climbed
    assert climbed + stored == pytest.approx(0.5 * (omega / FIG5.p) ** 2, rel=1e-9)
    assert use.most.max() == pytest.approx(k * deflection, rel=1e-6)
    back = 0.5 * (omega / FIG5.p) ** 2 - (1.0 - e**2) * stored
    assert 0.5 * (rows.omega[upright] / FIG5.p) ** 2 == pytest.approx(back, rel=1e-9)
    assert use.lost.sum() == pytest.approx((1.0 - e**2) * 0.5 * k * deflection**2, rel=1e-5, abs=1e-15)


def test_a_mass_that_hits_a_stop_alone_leaves_it_at_the_restitution():
    """Where weight does next to nothing: a stop of 10⁵ times the stiffness of the first, at the instant of a blow."""
    stop = Stop(0.04, 1e5, 0.5, confirm=("lam",))
    rows, _ = thrown(FIG5, RigidBase(restraints=(stop,)), 0.3, dt=1e-3, substeps=2, samples=100)
    b = FIG5.half_width
    rise = 4.0 * b * np.sin(0.5 * rows.theta)
    met = np.flatnonzero(rise > stop.gap_m)
    before, after = rows.omega[met[0]], rows.omega[met[-1]]
    assert -after / before == pytest.approx(0.5, abs=2e-3)


@pytest.mark.parametrize("base", BASES)
def test_a_stop_that_is_not_met_leaves_the_run_as_it_is(base):
    plain = run_fixed(FIG5, base, SHAKEN, 8)
    far = run_fixed(FIG5, stopped(base, (Stop(3.0, 20.0, 0.5, confirm=("gap_m",)),)), SHAKEN, 8)
    soft = run_fixed(FIG5, stopped(base, (Stop(0.02, 1e-9),)), SHAKEN, 8)
    for other in (far, soft):
        assert other.theta_max == pytest.approx(plain.theta_max, rel=1e-8)
        assert (other.status, other.impacts, other.separations) == (plain.status, plain.impacts, plain.separations)
    assert (far.stop_force, far.stop_blows, far.stop_energy, far.stop_depth) == (0.0, 0, 0.0, 0.0)


@pytest.mark.parametrize("lam", [1.0, 50.0])
def test_an_elastic_stop_without_a_gap_in_the_middle_is_a_tendon_without_prestress(lam):
    """On the axis of a block on rigid ground, which only rises there."""
    for base in (RigidBase(), ELASTIC):
        one, other = (
            run_fixed(FIG5, stopped(base, (device,)), SHAKEN, 16, 0.0, wait=False)
            for device in (Stop(0.0, lam, at=0.0), Tendon(lam=lam))
        )
        assert one.theta_max == pytest.approx(other.theta_max, rel=1e-9)
        assert one.stop_force == pytest.approx(other.tendon_force, rel=1e-5)  # of a tendon that at the end of a step


@pytest.mark.parametrize(("base", "stops"), crossed(BASES, STOPS, "crushes", wholly=True))
def test_runs_agree_with_the_reference(base, stops):
    base = stopped(base, stops)
    solver = reference(FIG5, base, SHAKEN)
    end = solver.run()
    memories = list(solver.stops.values()) if base.on_springs else [memory for memory, _ in solver.stops]
    outcome = run_fixed(FIG5, base, SHAKEN, 32, 0.0, wait=False)
    assert outcome.impacts == end.impacts
    assert outcome.theta_max == pytest.approx(end.theta_max, rel=2e-8)
    touching = sum(
        stop.gap_m == 0.0 for stop in stops
    )  # from the start: what then counts as a blow is a matter of rounding
    assert touching or outcome.stop_blows == sum(memory.blows for memory in memories)
    assert outcome.stop_force * FIG5.gravity == pytest.approx(max(memory.most for memory in memories), rel=1e-5)


def drawn(seed, pier):
    """A base with one or two stops and perhaps a damper, and a strong motion, at random."""
    rng = np.random.default_rng([28, seed])
    b = pier.half_width
    devices = ()
    for _ in range(rng.integers(1, 3)):
        gap = float(b * pier.alpha * 10.0 ** rng.uniform(-2.0, 0.0))
        at = None if rng.random() < 0.5 else float(rng.uniform(-1.0, 1.0) * b)
        devices += (Stop(gap, float(10.0 ** rng.uniform(0.0, 3.0)), float(rng.uniform(0.1, 1.0)), at),)
    shaken = broadband(rng, 0.01, 300, pier.gravity * math.tan(pier.alpha) * rng.uniform(1.5, 4.0))
    one_sine = pulse("sine", rng.uniform(0.4, 0.7) / pier.p, rng.uniform(3.0, 6.0) * math.tan(pier.alpha), 0.01, 2.99)
    return devices, Motion(f"seed {seed}", 0.01, shaken + one_sine.horizontal)


@pytest.mark.parametrize("seeds", SEEDS)
@pytest.mark.parametrize("base", RANDOM_BASES)
def test_random_stops_agree_with_the_reference_within_the_reported_error(base, seeds):
    assert_agreement([drawn(seed, FIG5) for seed in seeds], base, 1e-10)


@pytest.mark.parametrize(("base", "stops"), crossed(BASES, STOPS, "crushes"))
def test_the_order_across_blows_is_four(base, stops):
    assert_fourth_order(stopped(base, stops), 1e-11)


@pytest.mark.parametrize(("base", "stops"), crossed(BASES, STOPS, "crushes"))
def test_the_ledger_closes_with_what_stops_take_and_store(base, stops):
    assert_balance(stopped(base, stops))
    lossless = all(stop.restitution == 1.0 for stop in stops)
    outcome = run_fixed(FIG5, stopped(base, stops), SHAKEN, 32, 0.0, wait=False)
    assert (outcome.stop_energy < 1e-12) == lossless


@pytest.mark.parametrize("base", BASES)
def test_the_reversed_motion_gives_the_mirror_image(base):
    reversed_motion = Motion("reversed", SHAKEN.dt, -SHAKEN.horizontal)
    for there, here in (
        (STOPS["crushes"], STOPS["crushes"]),
        ((Stop(0.04, 20.0, 0.4, at="left"),), (Stop(0.04, 20.0, 0.4, at="right"),)),
    ):
        one = run_fixed(FIG5, stopped(base, there), SHAKEN, 4)
        two = run_fixed(FIG5, stopped(base, here), reversed_motion, 4)
        assert one.theta_max == pytest.approx(two.theta_max, rel=1e-11)
        assert (one.status, one.impacts, one.stop_blows) == (two.status, two.impacts, two.stop_blows)


@pytest.mark.parametrize("base", [RigidBase(), ELASTIC], ids=["rigid", "elastic"])
def test_forces_of_the_history_are_those_of_the_run_and_its_loop_is_what_was_lost(base):
    stops = (Stop(0.04, 20.0, 0.4),)
    response = rb.simulate(FIG5, stopped(base, stops), SHAKEN, substeps=32, wait=False, quiet_s=0.0, ledger=True)
    outcome = run_fixed(FIG5, stopped(base, stops), SHAKEN, 32, 0.0, wait=False)
    force = max(response.restraints[f"stop 1 {side} force"].max() for side in ("left", "right"))
    assert force == pytest.approx(outcome.stop_force * FIG5.gravity, rel=1e-3)  # at a row beside the peak
    assert outcome.stop_depth == pytest.approx(
        outcome.stop_force * FIG5.gravity / stiffness(FIG5, stops[0].lam), rel=1e-12
    )
    work = 0.0
    for side in ("left", "right"):
        pull, way = (response.restraints[f"stop 1 {side} {what}"].to_numpy() for what in ("force", "elongation"))
        work += float(np.sum(0.5 * (pull[1:] + pull[:-1]) * np.diff(way)))
    assert work == pytest.approx(outcome.stop_energy, rel=0.02)


def test_a_stop_lets_a_pier_stand_that_would_overturn():
    """And it ends decided, whatever the quiet time: what the stop holds counts as energy."""
    motion = pulse("sine", 1.0, 1.2, dt=0.005, end=6.0)
    assert run_to_tolerance(FIG5, RigidBase(), motion, 1e-4).status == "overturned"
    base = RigidBase(restraints=(Stop(0.5, 50.0, 0.5),))
    ends = [run_to_tolerance(FIG5, base, motion, 1e-4, quiet_s) for quiet_s in (2.0, 60.0)]
    assert [end.status for end in ends] == ["ok", "ok"]
    assert ends[0].theta_max == ends[1].theta_max < FIG5.alpha
    assert not ends[0].note


@pytest.mark.slow
@pytest.mark.parametrize(
    "seeds", [range(4), pytest.param(range(4, 30), marks=pytest.mark.thorough)], ids=["few", "most"]
)
def test_random_stops_beside_dampers_and_tendons_settle_on_real_records(seeds):
    from pathlib import Path

    motions = rb.read_motions(Path(__file__).parents[2] / "motions" / "near_fault")
    piers, others = (
        (TOWER, FIG5, rb.Pier(0.25, 2.0)),
        (Damper("hysteretic", f=0.05, yield_m=0.005), Tendon(psi=0.1, lam=0.5)),
    )
    runs = 0
    for seed in seeds:
        rng = np.random.default_rng([7, seed])
        pier, motion = piers[rng.integers(3)], motions[int(rng.integers(len(motions)))]
        base = stopped(
            (RigidBase(), ELASTIC, BOUC_WEN)[rng.integers(3)], (*drawn(seed, pier)[0], others[rng.integers(2)])
        )
        if problems(pier, base):
            continue
        outcome = run_to_tolerance(pier, base, motion, 1e-4)
        assert outcome.status in ("ok", "overturned", "flight"), (seed, outcome.reason)
        runs += 1
        if outcome.status == "ok" and outcome.theta_max_error is not None:
            finer = run_fixed(pier, base, motion, 4 * max(outcome.substeps, first_substeps(pier, base, motion.dt)))
            assert abs(finer.theta_max - outcome.theta_max) <= outcome.theta_max_error, seed
    assert runs > len(seeds) * 2 / 3


@pytest.mark.parametrize(
    ("made", "told"),
    [
        (lambda: Stop(-0.1, 20.0), "stop: gap_m = -0.1: must be 0 or above"),
        (lambda: Stop(0.1, 20.0, 0.0), "stop: restitution = 0: must be a number above 0"),
        (lambda: Stop(0.1, 20.0, 1.5), "stop: restitution = 1.5: must be within 0.1 and 1"),
        (lambda: Stop(0.1, -1.0), "stop: lambda = -1: must be 0 or above"),
        (lambda: Stop(0.1, 1.0, at="middle"), 'stop: at = "middle": must be "left"'),
    ],
)
def test_what_cannot_be_is_said_where_it_is_made(made, told):
    with pytest.raises(rb.InputError) as caught:
        made()
    (problem,) = caught.value.messages
    assert problem.startswith(told)
