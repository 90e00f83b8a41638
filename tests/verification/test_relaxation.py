"""The error of a residual rotation holds while dampers slip under the vibration that remains (THEORY.md, Results of a run)."""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import FIG5, pulse
from restrained_reference import TiedTwoSprings

from rockbatch.common.units import GRAVITY
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, DeckSpring, ElasticBase, FootingBase, Pier, RigidBase, Tendon, YieldingBase
from rockbatch.simulation import Run, relaxation, run_to_tolerance
from rockbatch.simulation.relaxation import AHEAD, PARTS, Slipping, decays, further_slip

ROUNDING = 1e-11
"""Change over α of a pier that friction holds, by rounding in five minutes."""


def stilled(motion: Motion, seconds: float) -> Motion:
    """Return the motion with ``seconds`` of still ground behind it."""
    still = np.zeros(round(seconds / motion.dt))
    vertical = None if motion.vertical is None else np.append(motion.vertical, still)
    return replace(motion, horizontal=np.append(motion.horizontal, still), vertical=vertical)


def changes(pier, base, motion, seconds):
    """Return the error of θ_res/α, and its changes by ``seconds`` of still ground; None if chaotic, or if a pier fell."""
    outcome = run_to_tolerance(pier, base, motion, 1e-4)
    later = [run_to_tolerance(pier, base, stilled(motion, each), 1e-4) for each in seconds]
    if outcome.theta_res_error is None or {outcome.status, *(each.status for each in later)} != {"ok"}:
        return None
    return outcome.theta_res_error / pier.alpha, [
        abs(each.theta_res - outcome.theta_res) / pier.alpha for each in later
    ]


HYSTERETIC = Damper("hysteretic", f=0.1, yield_m=0.005)


@pytest.mark.parametrize(
    "base",
    [
        ElasticBase(50.0, epsilon=0.3, restraints=(HYSTERETIC,)),
        ElasticBase(50.0, epsilon=0.3, restraints=(replace(HYSTERETIC, at="left"),)),
        ElasticBase(50.0, epsilon=0.3, restraints=(Damper("friction", f=0.1),)),
        RigidBase(restraints=(replace(HYSTERETIC, f=0.7),)),
    ],
    ids=["pivots", "left", "friction", "rigid"],
)
def test_still_ground_changes_a_residual_rotation_by_no_more_than_its_error(base):
    """It changes by more than 10⁻³ α, as no halving of the step does."""
    error, later = changes(FIG5, base, pulse("sine", 0.5, 1.0, end=1.2), [40.0, 200.0])
    assert min(later) > 1e-3
    assert max(later) <= error


def test_a_run_goes_on_for_no_pier_that_stands_upright_or_has_only_viscous_dampers(monkeypatch):
    monkeypatch.setattr(relaxation, "recorded", None)
    viscous = ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1),))
    for base in (viscous, RigidBase(restraints=(HYSTERETIC,))):
        assert run_to_tolerance(FIG5, base, pulse("sine", 0.5, 1.0, end=1.2), 1e-4).status == "ok"


def falling(ratio, slip_over_travel=0.25):
    """Return two dampers whose speed falls by ``ratio`` from part to part, and that of the second twice as fast."""
    t = np.linspace(0.0, PARTS, 40001)
    rates = -math.log(ratio) * np.array([1.0, 2.0])
    speed = np.exp(-t[:, None] * rates)
    return Slipping(t, slip_over_travel * (1.0 - speed) / rates, speed, np.ones_like(speed))


def test_further_slip_is_twice_that_of_vibration_which_decays_geometrically():
    during = falling(0.8)
    ahead = 0.25 * during.speed[-1] / -np.log([0.8, 0.64])
    assert further_slip(during, damped=True) == pytest.approx(2.0 * ahead, rel=2e-3)


def test_further_slip_is_that_of_all_parts_ahead_if_vibration_need_not_decay():
    during = falling(0.8)
    last = during.slip[-1] - during.slip[30000]
    assert further_slip(during, damped=False) == pytest.approx(2.0 * AHEAD * last, rel=2e-3)


@pytest.mark.parametrize(
    ("base", "damped"),
    [
        (ElasticBase(50.0, zeta=0.01), True),
        (ElasticBase(50.0, epsilon=0.3), False),
        (ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1),)), True),
        (ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1, at=0.0),)), False),
        (ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1, exponent=0.5),)), True),
        (ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1, exponent=2.0),)), False),
        (ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1, brace=5.0),)), True),
        (ElasticBase(50.0, epsilon=0.3, restraints=(Damper("viscous", nu=0.1, exponent=0.5, brace=5.0),)), False),
        (RigidBase(restraints=(HYSTERETIC,)), False),
        (RigidBase(restraints=(Damper("viscous", nu=0.1, at=0.0),)), True),
    ],
)
def test_rocking_decays_geometrically_where_a_damper_of_it_is_linear_at_low_speed(base, damped):
    assert decays(Run(FIG5, base, Motion.still(1.0))) is damped


def burst(random, alpha):
    """Return a random burst of 2 to 5 s, half of them with a vertical one."""
    dt = random.choice([0.005, 0.01, 0.02])
    t = np.arange(0.0, random.uniform(2.0, 5.0), dt)

    def noise(peak, highest):
        waves = np.sin(
            2.0 * np.pi * random.uniform(0.3, highest, (12, 1)) * t + random.uniform(0.0, 2.0 * np.pi, (12, 1))
        )
        return peak * GRAVITY * waves.sum(axis=0) / 4.0 * np.hanning(len(t))

    vertical = noise(random.uniform(0.1, 0.5), 10.0) if random.random() < 0.5 else None
    return Motion("burst", dt, noise(math.tan(alpha) * random.uniform(0.8, 4.0), 6.0), vertical)


BESIDE = {
    "alone": (),
    "viscous": (Damper("viscous", nu=0.05),),
    "tendon": (Tendon(psi=0.15, lam=0.5, strength=0.5),),
    "deck": (DeckSpring(0.1),),
    "friction": (Damper("friction", f=0.05),),
}


def hard(number, beside, kinematics):
    """Return a random pier with hysteretic dampers on springs, elastic, yielding or damped, or on a footing, and a burst."""
    random = np.random.default_rng([number, len(beside), len(kinematics)])
    alpha = random.uniform(0.08, 0.3)
    pier = Pier(alpha, random.uniform(0.5, 2.0), random.uniform(2.0, 5.0), confirm=("alpha", "mu", "p"))
    steel = Damper(
        "hysteretic", f=random.uniform(0.02, 0.2), yield_m=10 ** random.uniform(-3.0, -2.0), confirm=("f", "yield_m")
    )
    place = random.choice(["pivots", "left", "deck"], p=[0.7, 0.15, 0.15])
    steel = replace(steel, at=None if place == "pivots" else str(place), f=steel.f * (0.2 if place == "deck" else 1.0))
    devices = (steel, *BESIDE[beside])
    beta, damped = max(1.3 * pier.least_beta, random.uniform(20.0, 80.0)), {"zeta": 10 ** random.uniform(-2.0, -0.3)}
    support = damped if number % 3 else {"epsilon": random.choice([0.0, 0.3, 0.9])}
    shared = {"kinematics": kinematics, "restraints": devices}
    if number % 4 == 0:
        base = FootingBase(2.0 * beta, random.uniform(2.0, 8.0), **damped, **shared, confirm=("zeta", "safety_factor"))
    elif number % 4 == 1:
        base = YieldingBase(beta, eta=random.uniform(2.0, 5.0), spring="epp", **support, **shared)
    else:
        base = ElasticBase(beta, **support, **shared)
    return pier, base, burst(random, alpha)


@pytest.mark.thorough
@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
@pytest.mark.parametrize("beside", BESIDE)
def test_of_random_hard_cases_still_ground_changes_none_by_more_than_its_error(beside, kinematics):
    """By a minute and by five; the median of the errors is at most 15 times the greater change where that is no rounding."""
    ratios = []
    for number in range(24):
        found = changes(*hard(number, beside, kinematics), [60.0, 300.0])
        if found is None:
            continue
        error, later = found
        assert max(later) <= error + ROUNDING, number
        ratios += [error / max(later)] if max(later) > 1e-8 else []
    assert len(ratios) >= 5
    assert np.median(ratios) <= 15.0


@pytest.mark.thorough
@pytest.mark.parametrize("beside", ["alone", "viscous", "tendon"])
@pytest.mark.parametrize("kinematics", ["first-order", "finite"])
def test_the_reference_comes_to_rest_within_the_error(beside, kinematics):
    """A minute after the motion, on damped springs, by a solver of its own; it rests elsewhere than the last forces say."""
    base = ElasticBase(50.0, zeta=0.1, kinematics=kinematics, restraints=(HYSTERETIC, *BESIDE[beside]))
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=1.2)
    outcome = run_to_tolerance(FIG5, base, motion, 1e-5)
    rest = TiedTwoSprings(FIG5, base, motion, 60.0).run()
    assert abs(rest.omega) < 1e-5
    assert 4e-4 < abs(rest.theta - outcome.theta_res) <= outcome.theta_res_error
