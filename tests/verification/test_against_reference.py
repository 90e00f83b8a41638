"""The core against a second solver (reference_solver.py: DOP853, one leg per smooth stretch, no shared code).

Tolerances: 1e-8 α on the greatest rotation is the order of RK4's error at the steps used (1e-9 α, by halving) with room
for ten times that; the state at the end has passed every event, whose times are as good.
"""

import numpy as np
import pytest
from core_samples import FIG5, FIG6, TOWER, broadband, hard_case, has_usual_n, pulse
from reference_solver import ReferenceRun, Rigid, TwoSprings, reference

import rockbatch as rb
from rockbatch.motions.motion import Motion
from rockbatch.pier import ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.simulation import run_fixed, run_to_tolerance
from rockbatch.simulation.runs import LEFT_ALONE

SHORT_SINE = pulse("sine", 0.5, dt=0.01, end=3.0)
SHORT_COSINE = pulse("cosine", 1.0, dt=0.01, end=3.0)


def with_vertical(motion: Motion, peak: float, seed: int = 0) -> Motion:
    vertical = broadband(np.random.default_rng(seed), motion.dt, motion.npts, peak)
    return Motion(motion.name + "+vertical", motion.dt, motion.horizontal, vertical)


SPRINGS = [
    pytest.param(FIG5, YieldingBase(50, 0.1, eta=2.2), SHORT_SINE, id="fig5"),
    pytest.param(FIG5, YieldingBase(50, 0.1, "finite", eta=2.2), SHORT_SINE, id="fig5-finite"),
    pytest.param(FIG6, YieldingBase(60, 0.1, eta=2.5), SHORT_COSINE, id="fig6", marks=pytest.mark.slow),
    pytest.param(FIG6, YieldingBase(60, 0.1, "finite", eta=2.5), SHORT_COSINE, id="fig6-finite"),
    pytest.param(FIG5, YieldingBase(50, 0.1, eta=2.2, n=1.0), SHORT_SINE, id="n1"),
    pytest.param(FIG5, YieldingBase(50, 0.1, eta=2.2, n=2.0), SHORT_SINE, id="n2"),
    pytest.param(FIG5, YieldingBase(50, 0.1, "finite", eta=3.0, n=2.5), SHORT_SINE, id="n2.5"),
    pytest.param(FIG5, YieldingBase(50, 0.1, eta=3.0, n=50.0), SHORT_SINE, id="n50"),
    pytest.param(FIG5, YieldingBase(50, 0.1, eta=2.2, spring="epp"), SHORT_SINE, id="epp"),
    pytest.param(FIG6, YieldingBase(40, 0.3, "finite", eta=1.5, spring="epp"), SHORT_COSINE, id="epp-finite"),
    pytest.param(FIG5, YieldingBase(50, 0.1, eta=2.2, spring="hardening"), SHORT_SINE, id="hardening"),
    pytest.param(
        FIG6,
        YieldingBase(40, 0.3, "finite", eta=1.5, spring="hardening", n=2.5),
        SHORT_COSINE,
        id="hardening-finite-n2.5",
    ),
    pytest.param(
        FIG6, YieldingBase(40, 0.3, "finite", eta=1.5, spring="hardening"), SHORT_COSINE, id="hardening-finite"
    ),
    pytest.param(FIG5, YieldingBase(50, 0.1, eta=2.2, spring="hardening", n=2.5), SHORT_SINE, id="hardening-n2.5"),
    pytest.param(FIG5, ElasticBase(50, 0.4), SHORT_SINE, id="elastic"),
    pytest.param(FIG5, ElasticBase(50, 1.0, "finite"), SHORT_SINE, id="elastic-epsilon1-finite"),
    pytest.param(FIG5, ElasticBase(50, 1.0), SHORT_SINE, id="elastic-epsilon1", marks=pytest.mark.slow),
    pytest.param(FIG5, YieldingBase(50, 0.0, eta=2.2), SHORT_SINE, id="epsilon0"),
    pytest.param(FIG5, YieldingBase(50, 0.1, eta=3.0), with_vertical(SHORT_SINE, 6.0), id="vertical"),
    pytest.param(
        FIG5,
        YieldingBase(50, 0.1, "finite", "guided", eta=3.0),
        with_vertical(SHORT_SINE, 25.0),
        id="guided-flight-finite",
    ),
    pytest.param(
        FIG5,
        YieldingBase(50, 0.6, "first-order", "guided", eta=1.5, spring="epp"),
        with_vertical(SHORT_SINE, 25.0),
        id="guided-flight-epp",
        marks=pytest.mark.slow,
    ),
    pytest.param(
        FIG5,
        YieldingBase(50, 0.6, flight="guided", eta=1.5, spring="hardening"),
        with_vertical(SHORT_SINE, 25.0),
        id="guided-flight-hardening",
    ),
    pytest.param(FIG5, ElasticBase(50, 0.1, flight="stop"), with_vertical(SHORT_SINE, 25.0), id="stopped-by-flight"),
    pytest.param(
        Pier(alpha=0.6, p=1.5, mu=1.2),
        YieldingBase(25, 0.2, "finite", eta=3.0),
        pulse("sine", 0.8, 1.6, dt=0.01, end=3.0),
        id="stocky",
    ),
    pytest.param(FIG5, YieldingBase(50, eta=2.2, impact="housner"), SHORT_SINE, id="housner"),
    pytest.param(FIG6, ElasticBase(60, impact="housner"), SHORT_COSINE, id="housner-elastic"),
    pytest.param(
        FIG5,
        YieldingBase(50, eta=2.2, spring="epp", impact="housner"),
        with_vertical(SHORT_SINE, 25.0),
        id="housner-epp",
    ),
    pytest.param(
        FIG5,
        YieldingBase(50, eta=3.0, impact="housner"),
        with_vertical(SHORT_SINE, 25.0),
        id="housner-guided-flight",
    ),
    pytest.param(
        FIG5,
        YieldingBase(50, kinematics="finite", eta=3.0, spring="hardening", impact="housner"),
        with_vertical(SHORT_SINE, 25.0),
        id="housner-guided-flight-finite",
    ),
    pytest.param(
        Pier(alpha=0.6, p=1.5, mu=1.2),
        YieldingBase(25, kinematics="finite", eta=3.0, impact="housner"),
        pulse("sine", 0.8, 1.6, dt=0.01, end=3.0),
        id="housner-stocky-finite",
    ),
    pytest.param(FIG5, ElasticBase(50, zeta=0.05), SHORT_SINE, id="damped"),
    pytest.param(FIG5, ElasticBase(50, kinematics="finite", zeta=0.2), SHORT_SINE, id="damped-finite"),
    pytest.param(FIG5, YieldingBase(50, zeta=0.05, eta=2.2), SHORT_SINE, id="damped-yielding", marks=pytest.mark.slow),
    pytest.param(FIG6, YieldingBase(60, kinematics="finite", zeta=1.0, eta=2.5), SHORT_COSINE, id="critical-finite"),
    pytest.param(
        FIG6, YieldingBase(40, zeta=0.01, eta=1.5, spring="epp"), SHORT_COSINE, id="damped-epp", marks=pytest.mark.slow
    ),
    pytest.param(
        FIG5,
        YieldingBase(50, zeta=0.05, eta=2.2, spring="hardening"),
        SHORT_SINE,
        id="damped-hardening",
        marks=pytest.mark.slow,
    ),
    pytest.param(
        FIG5,
        YieldingBase(50, kinematics="finite", zeta=0.1, eta=3.0, spring="hardening", n=2.0),
        with_vertical(SHORT_SINE, 25.0),
        id="damped-guided-flight-hardening-finite-n2",
        marks=pytest.mark.thorough,
    ),
    pytest.param(
        FIG5,
        YieldingBase(50, kinematics="finite", zeta=0.1, eta=3.0, spring="hardening"),
        with_vertical(SHORT_SINE, 25.0),
        id="damped-guided-flight-hardening-finite",
    ),
    pytest.param(
        FIG5,
        YieldingBase(50, zeta=0.1, eta=3.0, spring="hardening"),
        with_vertical(SHORT_SINE, 25.0),
        id="damped-guided-flight-hardening",
        marks=pytest.mark.slow,
    ),
    pytest.param(
        FIG5,
        YieldingBase(50, flight="guided", zeta=0.1, eta=3.0),
        with_vertical(SHORT_SINE, 25.0),
        id="damped-guided-flight-n5",
    ),
    pytest.param(
        FIG5,
        YieldingBase(50, flight="guided", zeta=0.1, eta=3.0, n=2.0),
        with_vertical(SHORT_SINE, 25.0),
        id="damped-guided-flight",
        marks=pytest.mark.thorough,
    ),
]


RUNS: dict[tuple[Pier, ElasticBase, int], ReferenceRun] = {}


def expected_of(pier, base, motion):
    """Return the reference's run of one of SPRINGS, which is carried out once."""
    key = pier, base, id(motion)
    if key not in RUNS:
        RUNS[key] = reference(pier, base, motion)
    return RUNS[key]


@pytest.mark.sweep(fast=4, slow=12)
@pytest.mark.parametrize(("pier", "base", "motion"), SPRINGS)
def test_springs_agree_with_the_reference_in_peak_end_state_and_counts(pier, base, motion):
    """Plastic work 1e-7 relative: it is accumulated over all loadings."""
    expected = expected_of(pier, base, motion)
    outcome = run_fixed(pier, base, motion, substeps=32, quiet_s=0.0, wait=False)
    history = rb.simulate(pier, base, motion, substeps=32, quiet_s=0.0, wait=False).history.iloc[-1]
    assert outcome.status == expected.status
    assert (outcome.impacts, outcome.separations) == (expected.impacts, expected.separations)
    assert outcome.theta_max == pytest.approx(expected.theta_max, abs=1e-8 * pier.alpha)
    assert outcome.t_max == pytest.approx(expected.t_max, abs=1e-6)
    assert outcome.t_end == pytest.approx(expected.t_end, abs=1e-7)
    assert outcome.t_flight == pytest.approx(expected.t_flight, abs=1e-7)
    assert history["theta"] == pytest.approx(expected.theta, abs=1e-7 * pier.alpha)
    assert history["omega"] == pytest.approx(expected.omega, abs=1e-6 * pier.alpha * pier.p)
    assert history["v"] == pytest.approx(expected.v, abs=1e-8)
    if isinstance(base, YieldingBase):
        for side in ("left", "right"):
            work = getattr(expected, f"dissipated_{side}")
            assert getattr(outcome, f"dissipated_{side}") == pytest.approx(work, rel=1e-7, abs=1e-9)
    if outcome.status == "ok":
        solver = TwoSprings(pier, base, motion, 0.0)
        unstressed = solver.v0 - solver.dy * solver.z0
        settlement = unstressed - 0.5 * (expected.base_left + expected.base_right)
        tilt = (expected.base_left - expected.base_right) / (2 * pier.half_width)
        assert outcome.settlement == pytest.approx(settlement, abs=1e-8)
        assert outcome.base_tilt == pytest.approx(tilt, abs=1e-7 * pier.alpha)


@pytest.mark.parametrize(
    "base",
    [RigidBase(), pytest.param(YieldingBase(80, 0.05, eta=2.5), marks=pytest.mark.slow)],
    ids=["rigid", "yielding"],
)
def test_a_real_record_agrees_with_the_reference(base):
    """The tower of Fig. 7 under Sylmar 360 as recorded (0.843 g, dt = 0.02 s), to 1e-8 α with all counts."""
    pytest.importorskip("hdf5plugin")
    from rockbatch.motions import read_motions

    motion = read_motions([], fema=[("SYL", 360.0)]).motions[0]
    motion = Motion(motion.name, motion.dt, motion.horizontal[:1000])  # 20 s: all of the strong shaking
    expected = reference(TOWER, base, motion)
    outcome = run_fixed(TOWER, base, motion, substeps=32, quiet_s=0.0, wait=False)
    history = rb.simulate(TOWER, base, motion, substeps=32, quiet_s=0.0, wait=False).history.iloc[-1]
    assert expected.status == outcome.status == "ok"
    assert expected.theta_max > 0.05 * TOWER.alpha
    assert outcome.theta_max == pytest.approx(expected.theta_max, rel=0, abs=1e-8 * TOWER.alpha)
    assert history["theta"] == pytest.approx(expected.theta, rel=0, abs=1e-8 * TOWER.alpha)
    assert outcome.impacts == expected.impacts


@pytest.mark.sweep(fast=4, slow=12)
@pytest.mark.parametrize(("pier", "base", "motion"), SPRINGS)
def test_energy_ledger_closes(pier, base, motion):
    """The core's stored energy against input − plastic − impact − damping + P–Δ + constraint, which the reference integrates.

    The parts do not follow from each other, so a wrong sign or arm anywhere leaves a gap; 1e-7 of their sum is the
    error of the state at the end.
    """
    parts = expected_of(pier, base, motion).ledger
    end = rb.simulate(pier, base, motion, substeps=32, quiet_s=0.0, wait=False).energy[-1]
    lost = parts["plastic"] + parts["impact"] + parts["damping"]
    balance = parts["input"] - lost + parts["p_delta"] + parts["constraint"]
    size = sum(abs(part) for name, part in parts.items() if name != "stored")
    assert end == pytest.approx(balance, abs=1e-7 * size)
    assert parts["plastic"] >= -1e-15  # of an elastic spring: rounding
    assert parts["impact"] >= 0.0


@pytest.mark.parametrize(
    ("pier", "base", "motion"),
    [
        pytest.param(FIG5, RigidBase(), SHORT_SINE, id="fig5"),
        pytest.param(FIG5, RigidBase(restitution=0.7), with_vertical(SHORT_SINE, 7.0), id="vertical"),
        pytest.param(TOWER, RigidBase(), pulse("sine", 1.5, dt=0.01, end=4.0), id="tower"),
    ],
)
def test_rigid_base_agrees_with_the_reference(pier, base, motion):
    expected = reference(pier, base, motion)
    outcome = run_fixed(pier, base, motion, substeps=16, quiet_s=0.0, wait=False)
    end = rb.simulate(pier, base, motion, substeps=16, quiet_s=0.0, wait=False).history.iloc[-1]
    assert outcome.theta_max == pytest.approx(expected.theta_max, abs=1e-8 * pier.alpha)
    assert outcome.separations == expected.separations
    assert outcome.impacts == expected.impacts
    assert end["theta"] == pytest.approx(expected.theta, abs=1e-7 * pier.alpha)
    assert end["omega"] == pytest.approx(expected.omega, abs=1e-6 * pier.alpha * pier.p)


def test_rigid_block_comes_to_rest_and_lifts_off_again():
    """Two pulses, the second reversed and 1.2 times as strong, with time to come to rest in between (e = 0.3)."""
    first = pulse("sine", 0.5, 0.5, dt=0.01, end=4.0).horizontal
    motion = Motion("twice", 0.01, np.concatenate([first, -1.2 * first]))
    base = RigidBase(restitution=0.3)
    expected = Rigid(FIG5, base, motion, 0.0).run()
    outcome = run_fixed(FIG5, base, motion, substeps=16, quiet_s=0.0, wait=False)
    events = rb.simulate(FIG5, base, motion, substeps=16, quiet_s=0.0, wait=False).events
    assert (outcome.separations, expected.separations) == (2, 2)
    assert outcome.theta_max == pytest.approx(expected.theta_max, abs=1e-8 * FIG5.alpha)
    lift_offs = events.loc[events.kind == "lift-off", "t"].to_numpy()
    expected_lift_offs = [t for t, kind, _ in expected.events if kind == "lift-off"]
    assert lift_offs == pytest.approx(expected_lift_offs, abs=1e-12)  # exact: the ground is linear in time
    assert list(events.kind).count("rest") == 2


@pytest.mark.slow
@pytest.mark.parametrize(
    "seeds",
    [
        [seed for seed in range(18) if has_usual_n(hard_case(seed)[1])],
        *(pytest.param(range(first, first + 20), marks=pytest.mark.thorough) for first in range(0, 240, 20)),
    ],
    ids=lambda seeds: f"{seeds[0]}-{seeds[-1]}",
)
def test_random_hard_cases_agree_with_the_reference(seeds):
    """With the steps at which the error control is satisfied to 1e-6 α the run until a second after the record is right
    to that tolerance: outcome and peak. (What comes later is held in test_outcomes_against_independent.py.)

    The estimate itself covers the error but for one run of a block at most (case 118: 1.1e-8 α for 1.0e-9 α reported);
    1e-9 α is the reference's own error. Where no note says otherwise counts agree but for a hop so low that it is within
    the errors of either (one of 64 in case 206; one of 30 in case 138, which the reference misses). Where a pier rests after
    450 impacts is not settled to 1e-6 α in case 138 (5.04e-4 to 5.16e-4 rad with 1280 to 5120 substeps); its peak is held too.
    """
    compared, other_counts, not_covered, unclaimed, elsewhere = 0, 0, 0, 0, 0
    for seed in seeds:
        pier, base, motion = hard_case(seed)
        settled = run_to_tolerance(pier, base, motion, tolerance=1e-6, quiet_s=1.0)
        left_alone = settled.failure in LEFT_ALONE
        rests_elsewhere = "still changed theta_res" in settled.reason
        if settled.status == "failed" and not (
            left_alone or rests_elsewhere
        ):  # chaos: nothing is lost at impacts with ε = 1
            assert base.epsilon > 0.99, f"case {seed}: {settled.reason}"
            continue
        outcome = run_fixed(pier, base, motion, settled.substeps, 1.0, wait=False)
        if outcome.status != "ok" or settled.status == "overturned":
            continue  # where an overturning pier stops is a matter of definition
        expected = reference(pier, base, motion, quiet_s=1.0)
        assert expected.status == "ok", seed
        error = abs(outcome.theta_max - expected.theta_max)
        assert error <= 1e-6 * pier.alpha, seed
        compared += 1
        elsewhere += rests_elsewhere
        if left_alone:
            continue
        if settled.status == "failed":
            assert settled.theta_max_error is None, seed  # what has not settled claims no error
        elif settled.theta_max_error is None:
            assert settled.chaotic, seed
            unclaimed += 1
        elif outcome.theta_max == settled.theta_max:
            not_covered += error > settled.theta_max_error + 1e-9 * pier.alpha
        if "impacts" not in settled.note:
            assert abs(outcome.impacts - expected.impacts) <= 1, seed
            other_counts += outcome.impacts != expected.impacts
    assert other_counts <= 1
    assert not_covered <= 1
    assert unclaimed <= 1
    assert elsewhere <= 1
    assert compared >= 8
