"""Kelvin–Voigt supports (THEORY.md, Damped supports) against closed forms, another solver's values, and the undamped model."""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import FIG5, TOWER, broadband, hard_case, is_common, pulse
from reference_solver import reference

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.common.units import GRAVITY
from rockbatch.core import types
from rockbatch.core.springs.recovery import decay
from rockbatch.motions.motion import Motion
from rockbatch.pier import ElasticBase, Pier, YieldingBase, problems, rocking_frequency, vertical_frequency
from rockbatch.simulation import Run, run_fixed, run_to_tolerance, written_run
from rockbatch.simulation.runs import LEFT_ALONE


def test_the_decay_is_the_exponential_to_rounding():
    x = np.concatenate([np.linspace(0.0, 1e-3, 50), np.linspace(0.0, 36.0, 2000), [100.0, 1e9]])
    found = np.array([decay(each) for each in x])
    np.testing.assert_allclose(found[:-2], np.exp(-x[:-2]), rtol=1e-14, atol=1e-15)
    assert (found[-2:] < 1e-16).all()


@pytest.mark.parametrize(("zeta", "rebound"), [(0.05, 0.8587581018), (0.1, 0.7440793977), (0.2, 0.5717400276)])
def test_a_weightless_bounce_returns_as_in_closed_form(zeta, rebound):
    """exp[−(ζ/q)(π − atan(2ζq/(1 − 2ζ²)))], q = √(1 − ζ²): from the landing to the moment at which F is 0.

    The ground falls away at 2 g, then stays, and falls at g before the pier lands: nothing but the supports, which have
    crept back, acts on it then.
    """
    q = math.sqrt(1.0 - zeta**2)
    assert math.exp(-zeta / q * (math.pi - math.atan(2 * zeta * q / (1 - 2 * zeta**2)))) == pytest.approx(
        rebound, abs=1e-10
    )
    t = np.arange(601) * 0.01
    vertical = np.interp(t, [0.0, 0.01, 0.5, 0.51, 1.29, 1.3, 6.0], GRAVITY * np.array([-2, -2, -2, 0, 0, -1, -1]))
    motion = Motion("bounce", 0.01, np.zeros(len(t)), vertical)
    base = ElasticBase(40.0, flight="guided", zeta=zeta)
    found, rows = written_run(Run(FIG5, base, motion), 64, 0.0, 2000, wait=False)
    rows = rows[: found.rows]
    landing = np.flatnonzero(rows.kind == types.IMPACT_LEFT)
    leaving = np.flatnonzero(rows.kind == types.SEPARATION_LEFT)
    assert rows.t[landing[0]] > 1.3
    assert abs(rows.z_left[landing[0]]) < 1e-15
    left = leaving[leaving > landing[0]][0]
    assert rows.v_rate[left] / -rows.v_rate[landing[0]] == pytest.approx(rebound, abs=1e-10)


@pytest.mark.parametrize("zeta", [0.02, 0.1, 0.5])
def test_small_rocking_decays_as_in_closed_form(zeta):
    """ζ_r = ζ (ω_v/ω_r) μ sin²α/(1 + μ cos²α): after a push, θ is a cosine and a sine under exp(−ζ_r ω_r t)."""
    pier, base = TOWER, ElasticBase(60.0, zeta=zeta)
    share = pier.mu * math.sin(pier.alpha) ** 2 / (1 + pier.mu * math.cos(pier.alpha) ** 2)
    omega_r = rocking_frequency(pier, base)
    ratio = zeta * vertical_frequency(pier, base) / omega_r * share
    motion = pulse("sine", 0.1, 1e-4, dt=0.005, end=4.0)
    response = rb.simulate(pier, base, motion, substeps=40, quiet_s=0.0, wait=False)
    after = response.t > 0.11
    t, theta = response.t[after], response.theta[after]
    turn = omega_r * math.sqrt(1.0 - ratio**2) * t
    shape = np.array([np.cos(turn), np.sin(turn)]) * np.exp(-ratio * omega_r * t)
    fitted, *_ = np.linalg.lstsq(shape.T, theta, rcond=None)
    np.testing.assert_allclose(fitted @ shape, theta, rtol=0, atol=1e-8 * np.abs(theta).max())


TABLE = [
    ("sine", 1.0, 0.5, ElasticBase(20.0, zeta=0.05), 0.17873368, 8),
    ("sine", 1.0, 0.5, ElasticBase(50.0, zeta=0.05), 0.19662113, 8),
    ("sine", 0.4, 1.0, ElasticBase(50.0, zeta=0.05), 0.33018362, 6),
    ("sine", 1.0, 0.5, YieldingBase(20.0, eta=2.5, zeta=0.05), 0.16257812, 5),
    ("sine", 0.4, 1.0, YieldingBase(50.0, eta=2.5, zeta=0.05), 0.31759424, 6),
]


@pytest.mark.parametrize(("shape", "amplitude", "period", "base", "peak", "impacts"), TABLE)
def test_peaks_of_an_independent_solver(shape, amplitude, period, base, peak, impacts):
    """α = 0.2, p = 1, sampled at 0.005 s. Its counts are those of the first ten seconds."""
    motion = pulse(shape, period, amplitude, dt=0.005, end=10.0)
    outcome = run_fixed(FIG5, base, motion, 8, 0.0, wait=False)
    assert outcome.status == "ok"
    assert outcome.theta_max / FIG5.alpha == pytest.approx(peak, abs=6e-9)
    assert outcome.impacts == impacts


@pytest.mark.parametrize("law", [None, "bouc-wen", "epp"])
def test_vanishing_damping_joins_perfect_restitution(law):
    """The peak differs by a share of ζ: ε = 1 is met from 1e-2 to 1e-5 in proportion."""
    motion = pulse("sine", 0.5, 1.0, dt=0.005, end=3.0)

    def peak(**given):
        base = ElasticBase(40.0, **given) if law is None else YieldingBase(40.0, eta=2.5, spring=law, **given)
        return run_fixed(FIG5, base, motion, 16, 0.0, wait=False).theta_max / FIG5.alpha

    undamped = peak(epsilon=1.0)
    assert peak(zeta=0.0) == undamped
    far, near = peak(zeta=1e-3) - undamped, peak(zeta=1e-5) - undamped
    assert near == pytest.approx(0.01 * far, rel=0.05)
    assert abs(far) < 5e-3


@pytest.mark.parametrize("base", [ElasticBase(40.0, zeta=0.1), YieldingBase(40.0, eta=2.5, zeta=0.02)])
def test_order_four_across_landings_on_damped_supports(base):
    motion = pulse("sine", 0.5, 1.0, dt=0.02, end=2.5)
    exact = run_fixed(FIG5, base, motion, 512, 0.0, wait=False)
    steps = np.array([16, 32, 64])
    errors = [abs(run_fixed(FIG5, base, motion, int(k), 0.0, wait=False).theta_max - exact.theta_max) for k in steps]
    order = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert exact.impacts >= 1
    assert order == pytest.approx(4.0, abs=0.35)


@pytest.mark.parametrize(
    "base",
    [
        ElasticBase(40.0, zeta=0.05),
        pytest.param(YieldingBase(40.0, eta=2.5, zeta=0.3), marks=pytest.mark.slow),
        YieldingBase(40.0, eta=2.5, kinematics="finite", zeta=0.3),
    ],
    ids=["elastic", "yielding", "finite"],
)
def test_the_ledger_closes_with_what_the_dashpots_lose(base):
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=6.0)
    ledger = rb.simulate(FIG5, base, motion, substeps=32, quiet_s=0.0, ledger=True, wait=False).ledger
    assert ledger["remainder"].abs().max() < 2e-7 * ledger["input"].abs().max()
    assert ledger["damping"].iloc[-1] > 0.05 * ledger["input"].iloc[-1]
    assert (np.diff(ledger["damping"]) >= -1e-15).all()
    assert (ledger["impact"] == 0.0).all()


def test_damping_keeps_a_pier_on_the_ground_that_resonance_throws_up():
    """0.2 g at ω_v: an undamped oscillator reaches 1 g; with ζ = 5 % it stays below, by 0.2 g/(2 ζ) √… twice over at most."""
    t = np.arange(801) * 0.005
    shake = Motion("resonance", 0.005, np.zeros(801), 0.08 * GRAVITY * np.sin(20.0 * t))
    assert run_to_tolerance(FIG5, ElasticBase(20.0, flight="stop"), shake, 1e-4).status == "flight"
    assert run_to_tolerance(FIG5, ElasticBase(20.0, zeta=0.05), shake, 1e-4).status == "ok"


def test_a_flight_says_how_little_the_supports_damp():
    t = np.arange(801) * 0.005
    shake = Motion("resonance", 0.005, np.zeros(801), 0.3 * GRAVITY * np.sin(20.0 * t))
    outcome = run_to_tolerance(FIG5, ElasticBase(20.0, flight="stop", zeta=0.02), shake, 1e-4)
    assert outcome.status == "flight"
    assert "vertical oscillator of 3.18 Hz, damping 2 %, reached 1 g" in outcome.reason


def test_epsilon_and_zeta_exclude_each_other_and_zeta_has_limits():
    with pytest.raises(InputError, match="keep one"):
        ElasticBase(40.0, 0.1, zeta=0.05)
    for zeta in (-0.01, 1.01, math.nan):
        with pytest.raises(InputError, match=r"^zeta = "):
            ElasticBase(40.0, zeta=zeta)
    assert problems(FIG5, ElasticBase(40.0, zeta=1.0)) == []


@pytest.mark.slow
def test_stocky_piers_on_critically_damped_supports_do_not_blow_up():
    """Rocking of α = 1.2 is damped beyond critical then: the steps respect its quicker exponential."""
    pier, base = Pier(alpha=1.2, p=1.0), ElasticBase(30.0, zeta=1.0)
    motion = Motion("noise", 0.01, broadband(np.random.default_rng(5), 0.01, 300, 6.0 * GRAVITY))
    outcome = run_to_tolerance(pier, base, motion, 1e-6)
    assert outcome.status == "ok"
    expected = reference(pier, base, motion, quiet_s=0.0)
    assert outcome.theta_max == pytest.approx(expected.theta_max, abs=1e-6 * pier.alpha)


@pytest.mark.slow
@pytest.mark.parametrize(
    "seeds",
    [
        [seed for seed in range(40) if is_common(hard_case(seed)[1])],
        *(pytest.param(range(first, first + 20), marks=pytest.mark.thorough) for first in range(0, 120, 20)),
    ],
    ids=lambda seeds: f"{seeds[0]}-{seeds[-1]}",
)
def test_random_hard_cases_on_damped_supports_agree_with_the_reference(seeds):
    """As the undamped ones (test_against_reference), with ζ from 10⁻⁴ to 1 in place of ε."""
    compared = 0
    for seed in seeds:
        pier, base, motion = hard_case(seed)
        zeta = float(np.random.default_rng(1000 + seed).choice([1e-4, 1e-3, 0.01, 0.05, 0.2, 1.0]))
        base = replace(base, epsilon=0.0, zeta=zeta)
        settled = run_to_tolerance(pier, base, motion, tolerance=1e-6, quiet_s=1.0)
        assert settled.status != "failed" or settled.failure in LEFT_ALONE or zeta < 1e-3, f"{seed}: {settled.reason}"
        if settled.status != "ok":
            continue
        outcome = run_fixed(pier, base, motion, settled.substeps, 1.0, wait=False)
        expected = reference(pier, base, motion, quiet_s=1.0)
        assert outcome.status == expected.status == "ok", seed
        assert outcome.theta_max == pytest.approx(expected.theta_max, abs=1e-6 * pier.alpha), seed
        assert abs(outcome.impacts - expected.impacts) <= 1, seed
        compared += 1
    assert compared >= len(seeds) * 2 // 5


@pytest.mark.parametrize("kinematics", ["first-order", pytest.param("finite", marks=pytest.mark.thorough)])
def test_the_forces_of_damped_supports_are_what_the_pier_feels(kinematics):
    """N/M = g + v̈_g + v̈ by differences of v̇ between events; a free pivot has no force, and its gap closes at 0."""
    base = ElasticBase(40.0, kinematics=kinematics, zeta=0.1)
    motion = pulse("sine", 0.5, 1.0, dt=0.005, end=2.0)
    response = rb.simulate(FIG5, base, motion, substeps=16, quiet_s=0.0, wait=False, forces=True)
    table, v, t = response.forces, response.history["v"].to_numpy(), response.t
    second = np.full(len(t), np.nan)
    second[1:-1] = (v[2:] - 2.0 * v[1:-1] + v[:-2]) / 0.005**2
    events = response.events["t"].to_numpy()
    even = np.array([abs(t[i] - t[i - 1] - 0.005) + abs(t[i + 1] - t[i] - 0.005) < 1e-9 for i in range(1, len(t) - 1)])
    apart = np.array([np.abs(events - each).min() > 0.02 for each in t[1:-1]])
    found, expected = table["normal_force"].to_numpy()[1:-1], GRAVITY + second[1:-1]
    sure = even & apart
    assert sure.sum() > 100
    np.testing.assert_allclose(found[sure], expected[sure], atol=0.01 * GRAVITY)
    assert (response.history["force_left"] <= 1e-9).all()
    for side in ("left", "right"):
        gap = table[f"heel_gap_{side}"]
        assert gap.min() > -1e-9
        assert gap.max() > 1e-3
