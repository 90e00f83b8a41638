"""What the energy of a pier on springs may still do to it: against closed forms of small rotations, and balances."""

import math

import numpy as np
import pytest
from core_samples import FIG5
from scipy.optimize import brentq

from rockbatch.common.units import GRAVITY as G
from rockbatch.core.springs.free_vibration import (
    Drift,
    Load,
    further,
    lean_on,
    peak_is_final,
    rocking_period,
    unstable_equilibrium,
)
from rockbatch.core.springs.model import Contact, State, Supports
from rockbatch.core.types import Moment
from rockbatch.pier import ElasticBase, YieldingBase, rocking_frequency
from rockbatch.simulation import springs

NO_DRIFT = Drift(0.0, 0.0, 0.0)


def turned(m, theta, lean=0.0, load=G):
    """The pier in vertical equilibrium at rest at ``theta`` on elastic springs whose base was tilted to ``lean`` at rest."""
    tilt = lean * (1.0 - G * m.height / (2.0 * m.yield_force * m.stiffness * m.half_width**2))
    left, right = m.half_width * tilt, -m.half_width * tilt
    sine = math.sin(theta) if m.finite is not None else theta
    drop = m.height * (1.0 - math.cos(theta)) if m.finite is not None else 0.0
    static, rise = 0.5 * load / m.yield_force * m.yield_deflection, m.half_width * sine
    v = -static - drop
    gaps = [v + rise + drop - left, v - rise + drop - right]
    if max(gaps) > 0.0:
        pressed = gaps.index(min(gaps))
        v += -2.0 * static - gaps[pressed]
    gaps = [v + rise + drop - left, v - rise + drop - right]
    z = [min(gap, 0.0) / m.yield_deflection for gap in gaps]
    contact = Contact(*(float(gap < 0.0) for gap in gaps), 0.0, 0.0, 0.0)
    return State(v, theta, 0.0, 0.0, *z), contact, Supports(left, right, -1.0, -1.0)


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
@pytest.mark.parametrize(("lean", "share"), [(0.0, 0.4), (0.0, 2.0), (0.0, 20.0), (3e-4, 0.4), (3e-4, 2.0)])
def test_a_pier_at_rest_on_elastic_springs_swings_back_as_far_as_it_was_turned(kinematics, lean, share):
    """About where it rests, to either side; 2 % are what P–Δ moments may give back at these rotations."""
    m = springs(FIG5, ElasticBase(50.0, kinematics=kinematics))
    away = share * m.yield_deflection / m.half_width
    for side in (1.0, -1.0):
        y, contact, base = turned(m, lean + side * away, lean)
        largest = max(abs(lean + away), abs(lean - away)) if share < 1.0 else abs(y.theta)
        now = Moment(y, contact, base)
        assert peak_is_final(m, now, Load(G, 0.0), 1.02 * largest + 2.0 * lean * (share > 1.0), False, NO_DRIFT)
        assert not peak_is_final(m, now, Load(G, 0.0), 0.98 * largest - 2.0 * lean * (share > 1.0), False, NO_DRIFT)
        assert not peak_is_final(m, now, Load(G, 0.02 * G * m.half_width * away), 1.005 * largest, False, NO_DRIFT)


def test_energy_of_motion_counts_as_that_of_height_and_springs():
    """Passing its rest with ω = A ω_r, or bouncing with v̇ of the same energy, a pier may turn to A."""
    pier = ElasticBase(50.0)
    m, amplitude = springs(FIG5, pier), 0.4 / 50.0**2 * G / FIG5.half_width
    y, contact, base = turned(m, 0.0)
    inertia, rate = m.inertia + m.height**2, amplitude * rocking_frequency(FIG5, pier)
    for moving in (y._replace(omega=rate), y._replace(omega=-rate), y._replace(v_rate=rate * math.sqrt(inertia))):
        now = Moment(moving, contact, base)
        assert peak_is_final(m, now, Load(G, 0.0), 1.01 * amplitude, False, NO_DRIFT)
        assert not peak_is_final(m, now, Load(G, 0.0), 0.99 * amplitude, False, NO_DRIFT)
    swing = Moment(y._replace(omega=rate), contact, base)
    assert peak_is_final(m, swing, Load(G, 0.0), 1.01 * amplitude, True, NO_DRIFT)  # calm: apart from the bounce
    assert not peak_is_final(m, swing, Load(G, 0.0), 0.99 * amplitude, True, NO_DRIFT)
    bounce = Moment(y._replace(v_rate=0.1 * G / 50.0), contact, base)
    assert peak_is_final(m, bounce, Load(G, 0.0), 1e-6, True, NO_DRIFT)
    assert not peak_is_final(m, bounce, Load(G, 0.0), 1e-6, False, NO_DRIFT)


def test_a_base_that_tilts_on_takes_the_pier_beyond_the_peak_of_its_energy():
    m = springs(FIG5, YieldingBase(50.0, eta=3.0))
    amplitude = 0.4 * G / 50.0**2 / m.half_width
    now = Moment(*turned(m, amplitude))
    for calm in (False, True):
        for right, left in ((0.5, 0.0), (0.0, 0.5)):
            drift = Drift(right * amplitude, left * amplitude, 0.0)
            assert not peak_is_final(m, now, Load(G, 0.0), 1.4 * amplitude, calm, drift)
            assert peak_is_final(m, now, Load(G, 0.0), 1.6 * amplitude, calm, drift)


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
def test_beyond_the_rotation_at_which_weight_and_supports_balance_nothing_is_final(kinematics):
    """tan θ = b/h, of supports that bear η times half of the weight (η − 1) b/h; tendons add to both."""
    for base, share in (
        (ElasticBase(50.0, kinematics=kinematics), 1.0),
        (YieldingBase(50.0, kinematics=kinematics, eta=1.4, spring="epp"), 0.4),
        (YieldingBase(50.0, kinematics=kinematics, eta=2.5, spring="epp"), 1.0),
    ):
        m = springs(FIG5, base)
        tangent = share * math.tan(FIG5.alpha)
        expected = math.atan(tangent) if kinematics == "finite" else tangent
        assert unstable_equilibrium(m, G) == pytest.approx(expected, rel=1e-12)
    tied = springs(FIG5, ElasticBase(50.0))
    assert unstable_equilibrium(tied, 1.2 * G) == pytest.approx(1.2 * math.tan(FIG5.alpha), rel=1e-12)
    for theta, final in ((0.5 * FIG5.alpha, True), (1.1 * FIG5.alpha, False)):
        now = Moment(*turned(tied, theta))
        assert peak_is_final(tied, now, Load(G, 0.0), 1.2 * theta, False, NO_DRIFT) == final


def potential(m, theta, load, base):
    """Least energy of springs, weight and what else presses the base's centre, at a rotation, by a search over v."""
    k = m.yield_force * m.stiffness
    finite = m.finite is not None
    rise = m.half_width * (math.sin(theta) if finite else theta)
    drop = m.height * (1.0 - math.cos(theta)) if finite else 0.0
    p_delta = 0.0 if finite else 0.5 * G * m.height * theta**2

    def energy(v):
        gaps = v + rise + drop - base.left, v - rise + drop - base.right
        return 0.5 * k * sum(min(gap, 0.0) ** 2 for gap in gaps) + G * v + (load - G) * (v + drop) - p_delta

    low, high = sorted((base.left - rise - drop, base.right + rise - drop))
    both = 0.5 * (low + high) - 0.5 * load / k
    v = both if both <= low else high - load / k  # on one spring alone it hangs below the higher pivot's mark
    return energy(v), v


@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
@pytest.mark.parametrize("seed", range(12))
def test_a_peak_is_final_once_energy_and_p_delta_carry_the_pier_no_further(kinematics, seed):
    """Random moments, leans and loads: that peak by the potential of springs and weight, whose hill is climbed on both sides, and
    2 b h θ/(I0 + h² + b²) of the energy in return (THEORY.md, When a run is over)."""
    rng = np.random.default_rng(seed)
    m = springs(FIG5, ElasticBase(50.0, kinematics=kinematics))
    b, h, k = m.half_width, m.height, m.yield_force * m.stiffness
    load, away = G * rng.uniform(1.0, 1.3), m.yield_deflection / b * rng.choice([0.4, 3.0, 14.0])
    tilt = rng.uniform(-1.0, 1.0) * 0.2 * m.yield_deflection / b
    base = Supports(b * tilt - 1e-3, -b * tilt - 1e-3, -1.0, -1.0)
    lean = tilt / (1.0 - G * h / (2.0 * k * b * b))
    theta = lean + rng.choice([-1.0, 1.0]) * away
    finite = kinematics == "finite"
    rise, drop = (b * math.sin(theta), h * (1.0 - math.cos(theta))) if finite else (b * theta, 0.0)
    _, v = potential(m, theta, load, base)
    v += 0.1 * rng.uniform(-1.0, 1.0) * m.yield_deflection
    gaps = v + rise + drop - base.left, v - rise + drop - base.right
    z = [min(gap, 0.0) / m.yield_deflection for gap in gaps]
    left, right = (float(gap < 0.0) for gap in gaps)
    omega, v_rate = rng.uniform(-1.0, 1.0, 2) * np.array([away * 3.0, 0.02 * G / 50.0])
    y, contact = State(v, theta, v_rate, omega, *z), Contact(left, right, 0.0, 0.0, 0.0)
    lever = h * math.cos(theta) + (right - left) * b * math.sin(theta) if finite else h
    springs_now = 0.5 * k * sum(min(gap, 0.0) ** 2 for gap in gaps)
    height = G * v + (load - G) * (v + drop) - (0.0 if finite else 0.5 * G * h * theta**2)
    rests = potential(m, lean, load, base)[0]
    energy = 0.5 * v_rate**2 + 0.5 * (m.inertia + lever**2) * omega**2 + springs_now + height - rests
    stored = 0.1 * energy

    def lacks(peak):
        hill = min(potential(m, side * peak, load, base)[0] for side in (-1.0, 1.0)) - rests
        return hill - (energy + stored) * (1.0 + 2.0 * b * h * peak / (m.inertia + h * h + b * b))

    expected = brentq(lacks, abs(lean) + 1e-9, 0.9 * unstable_equilibrium(m, load), xtol=1e-12)
    now = Moment(y, contact, base)
    low, high = 0.5 * expected, 2.0 * expected
    for _ in range(40):
        middle = 0.5 * (low + high)
        final = peak_is_final(m, now, Load(load, stored), middle, False, NO_DRIFT)
        low, high = (low, middle) if final else (middle, high)
    # Of the sum over parts of the way; of the bisection
    assert high == pytest.approx(expected, rel=7e-9 if finite else 1e-11)


def test_a_period_of_rocking_is_that_of_full_contact():
    for base in (ElasticBase(50.0), YieldingBase(40.0, eta=2.0, kinematics="finite")):
        expected = 2.0 * math.pi / rocking_frequency(FIG5, base)
        assert rocking_period(springs(FIG5, base)) == pytest.approx(expected, rel=1e-12)


def test_a_drift_of_the_base_is_amplified_by_lean_and_grows_where_supports_creep():
    """exp(n h a s/b²) − 1 for supports that both sink by s, a the lean over the tilt of the base; by that much of the mean."""
    creeps, holds = (springs(FIG5, YieldingBase(50.0, eta=2.5, spring=law)) for law in ("bouc-wen", "epp"))
    b, h = creeps.half_width, creeps.height
    amplified = 1.0 / (1.0 - G * h / (50.0 * FIG5.p * b) ** 2)
    for right, left in ((2e-4, 1e-4), (2e-4, -1e-4), (-2e-4, 3e-4)):
        grown = [amplified * max(tilt, 0.0) for tilt in (right, left)]
        assert further(holds, right, left, 1e-3) == pytest.approx((*grown, 0.0))
        assert further(creeps, right, left, 0.0) == pytest.approx((*grown, 0.0))
        for sinking in (1e-3, 5e-2):
            exponent = 5.0 * h * amplified * sinking / b**2
            growth = math.exp(exponent) - 1.0
            expected = [value * growth / exponent for value in grown]
            assert further(creeps, right, left, sinking) == pytest.approx((*expected, growth), rel=1e-9)
    assert lean_on(holds, Supports(1e-3, -2e-3)) == pytest.approx(amplified * 0.5 * 3e-3 / b)


def test_a_lean_that_grows_and_a_tilt_that_goes_on_are_added_on_their_own_side():
    m = springs(FIG5, YieldingBase(50.0, eta=2.5))
    lean = 0.1 * G / 50.0**2 / m.half_width
    for side in (1.0, -1.0):
        now = Moment(*turned(m, side * lean, side * lean))  # at rest
        for calm in (False, True):
            assert peak_is_final(m, now, Load(G, 0.0), 1.01 * lean, calm, NO_DRIFT)
            assert not peak_is_final(m, now, Load(G, 0.0), 0.99 * lean, calm, NO_DRIFT)
            for growth, beside in ((0.5, 0.0), (0.3, 0.2), (0.0, 0.5)):
                there, away = (beside * lean, 0.0) if side > 0.0 else (0.0, beside * lean)
                for drift in (Drift(there, away, growth),):
                    assert peak_is_final(m, now, Load(G, 0.0), 1.52 * lean, calm, drift)
                    assert not peak_is_final(m, now, Load(G, 0.0), 1.48 * lean, calm, drift)
            back = Drift(*((0.0, 1.9 * lean) if side > 0.0 else (1.9 * lean, 0.0)), 0.0)
            assert peak_is_final(m, now, Load(G, 0.0), 1.01 * lean, calm, back)  # it tilts to the other side, by less


def test_what_rocks_calmly_is_softened_by_the_load_that_bounces():
    """By a share s of the load the pier's stiffness falls to k − s g h; its lean about the supports swells by as much."""
    for kinematics in ("first-order", "finite"):
        m = springs(FIG5, ElasticBase(50.0, kinematics=kinematics))
        deflection = m.yield_deflection
        plain = 2.0 * m.yield_force * m.stiffness * m.half_width**2 - G * m.height
        for share, lean in ((0.0, 0.0), (0.3, 0.0), (0.3, 2e-4), (0.3, -2e-4)):
            softer = plain - share * G * m.height
            away = 0.3 * deflection / m.half_width
            y, contact, base = turned(m, lean + away, lean)
            moving = y._replace(v=y.v + 0.6 * share * deflection, v_rate=0.8 * share * math.sqrt(deflection * G))
            now = Moment(moving, contact, base)
            furthest = abs(lean) * plain / softer + away * math.sqrt(plain / softer)
            assert peak_is_final(m, now, Load(G, 0.0), (1.0 + 1e-4) * furthest, True, NO_DRIFT)
            assert not peak_is_final(m, now, Load(G, 0.0), (1.0 - 1e-4) * furthest, True, NO_DRIFT)
        wild = y._replace(v_rate=1.1 * plain / (G * m.height) * math.sqrt(deflection * G))
        assert not peak_is_final(
            m, Moment(wild, contact, base), Load(G, 0.0), 0.1, True, NO_DRIFT
        )  # no stiffness is left
