"""The statics sheet against the simulator: slow ramps of the ground's acceleration, and free rocking.

A ramp of 60 s is slow: the damped supports (ζ = 0.1) lag by τ times the ramp's rate, 0.1 % of it at most.
"""

import math

import numpy as np
import pytest

import rockbatch as rb
from rockbatch.pier.equilibrium import SlowTurn
from rockbatch.pier.free_rocking import FreeRocking

PIER = rb.Pier(alpha=0.2, p=1.0)
TOWER = rb.Pier(alpha=0.13, p=0.38)
RISE, HOLD, DT = 60.0, 10.0, 0.02
DAMPED = {"beta": 30.0, "zeta": 0.1}
TENDON = rb.Tendon(psi=0.2, lam=3.0, strength=0.8)
VISCOUS = rb.Damper("viscous", nu=1.0)  # which bears nothing, and keeps what slips from swinging


def beside(*restraints: rb.Damper | rb.Tendon) -> rb.ElasticBase:
    """Return springs with restraints and, in place of damped supports, a viscous damper: fast tests compile that anyway."""
    return rb.ElasticBase(DAMPED["beta"], restraints=(*restraints, VISCOUS))


def ramp(base: rb.RigidBase | rb.ElasticBase, most_g: float, rise_s: float = RISE) -> rb.Response:
    """Return the run under an acceleration that rises to ``most_g`` [g] and stays: to the right, so that the pier goes left."""
    rise = np.linspace(0.0, 1.0, round(rise_s / DT) + 1)
    samples = PIER.gravity * most_g * np.concatenate((rise, np.ones(round(HOLD / DT))))
    return rb.simulate(PIER, base, rb.Motion("ramp", DT, samples), substeps=20, quiet_s=0.0, wait=False)


@pytest.mark.parametrize("spring", ["epp", "bouc-wen", "hardening"])
@pytest.mark.parametrize("eta", [1.5, 2.5])
def test_a_pier_on_yielding_supports_turns_under_a_slow_ramp_as_the_curve_says(spring, eta):
    """At 0.3, 0.6 and 0.9 of the strength; 1 %: what damping and vibration leave, which Bouc–Wen springs turn into settlement."""
    base = rb.YieldingBase(**DAMPED, eta=eta, spring=spring)
    sheet = rb.statics(PIER, base)
    history = ramp(base, 0.95 * sheet.strength_g).history
    curve = SlowTurn(PIER, base).curve(sheet.strength_rad)
    for share in (0.3, 0.6, 0.9):
        static = np.interp(share * sheet.strength_g, curve.acceleration, curve.theta)
        moved = np.interp(share / 0.95 * RISE, history["t"], history["theta"])
        assert moved == pytest.approx(-static, rel=0.01)


CASES = {
    "elastic": rb.ElasticBase(**DAMPED),
    "weak": rb.YieldingBase(**DAMPED, eta=1.5, spring="epp"),
    "strong": rb.YieldingBase(**DAMPED, eta=2.5, spring="epp"),
    "damper": beside(rb.Damper("hysteretic", f=0.05, yield_m=0.01)),
    "friction": beside(rb.Damper("friction", f=0.05)),
    "tendon": beside(TENDON),
    "rigid": rb.RigidBase(),
    "rigid, tendon": rb.RigidBase(restraints=(TENDON, VISCOUS)),
    "rigid, damper": rb.RigidBase(restraints=(rb.Damper("hysteretic", f=0.05, yield_m=0.01), VISCOUS)),
}


@pytest.mark.parametrize("name", CASES)
def test_a_pier_withstands_just_less_than_its_static_strength_and_no_more(name):
    """It is held at 0.995 of it near the rotation of the sheet, and turns on at 1.005; 0.97 with a tendon, on which it swings."""
    base = CASES[name]
    sheet = rb.statics(PIER, base)
    below, above = (ramp(base, share * sheet.strength_g) for share in (0.97 if "tendon" in name else 0.995, 1.005))
    assert below.theta_max < max(1.4 * sheet.strength_rad, 1e-9 if name == "rigid" else 0.0)
    assert above.theta_max > 1.5 * sheet.strength_rad + 0.01


def test_a_tendon_holds_a_pier_beyond_lift_off_where_the_curve_says():
    """λ > cos α makes the righting moment rise until the tendon yields: equilibria on one pivot, on springs and without."""
    for name in ("tendon", "rigid, tendon"):
        base = CASES[name]
        sheet, turn = rb.statics(PIER, base), SlowTurn(PIER, base)
        assert sheet.strength_rad > 3.0 * turn.lift_off + 0.01
        history = ramp(base, 0.97 * sheet.strength_g, 4.0 * RISE).history
        curve = turn.curve(sheet.strength_rad)
        for goal in (0.5 * (sheet.lift_off_g + sheet.strength_g), 0.95 * sheet.strength_g):
            static = np.interp(goal, curve.acceleration, curve.theta)
            moved = history["theta"][np.abs(history["t"] - goal / (0.97 * sheet.strength_g) * 4.0 * RISE) < 4.0].mean()
            assert moved == pytest.approx(-static, rel=0.01)


def test_the_heel_leaves_its_support_at_the_acceleration_and_rotation_of_the_sheet():
    for base in (CASES["elastic"], rb.YieldingBase(**DAMPED, eta=2.5, n=5.0), CASES["tendon"], CASES["friction"]):
        sheet = rb.statics(PIER, base)
        run = ramp(base, 1.02 * sheet.lift_off_g)
        first = run.events[run.events["kind"] == "separation"].iloc[0]
        assert first["t"] / RISE * 1.02 == pytest.approx(1.0, abs=3e-3)
        assert run.history["theta"][first["before"]] == pytest.approx(-sheet.lift_off_rad, rel=5e-3)


def swings(base: rb.RigidBase | rb.ElasticBase, amplitude_g: float) -> list[tuple[float, float]]:
    """Return amplitude [rad] and twice the duration [s] of each swing to one side after a sine of 2.5 s has gone."""
    motion = rb.pulse("sine", name="sine", amplitude=amplitude_g * 9.81, period=2.5, dt=0.01, duration=60.0)
    history = rb.simulate(TOWER, base, motion, substeps=16, quiet_s=0.0, wait=False).history
    t, theta = history["t"].to_numpy(), history["theta"].to_numpy()
    after = np.flatnonzero((theta[:-1] * theta[1:] < 0.0) & (t[:-1] > 2.5))
    zeros = t[after] - theta[after] * (t[after + 1] - t[after]) / (theta[after + 1] - theta[after])
    return [
        (float(np.abs(theta[a : b + 2]).max()), 2.0 * (end - start))
        for a, b, start, end in zip(after[:-1], after[1:], zeros[:-1], zeros[1:], strict=True)
    ]


@pytest.mark.parametrize(
    ("base", "amplitude_g", "within"),
    [
        (rb.ElasticBase(beta=80.0, epsilon=1.0, kinematics="finite"), 0.25, 3e-4),
        (rb.ElasticBase(beta=80.0, zeta=0.05), 0.25, 1e-4),
        (rb.ElasticBase(beta=40.0, zeta=0.05), 0.25, 2e-3),
        (rb.ElasticBase(beta=20.0, zeta=0.05), 0.25, 3e-3),
        pytest.param(  # compiled by itself; on the rigid base: below
            rb.ElasticBase(beta=80.0, zeta=0.05, restraints=(rb.Tendon(psi=0.3, lam=0.5),)),
            0.4,
            2e-4,
            marks=pytest.mark.slow,
        ),
    ],
)
def test_free_rocking_takes_the_period_of_its_amplitude(base, amplitude_g, within):
    """Swings of 0.16 to 0.45 α on springs that let go at 0.01 to 0.2 α; what is left out is their vertical vibration."""
    free = FreeRocking(TOWER, base)
    measured = [swing for swing in swings(base, amplitude_g) if swing[0] > 0.5 * free.turn.lift_off]
    assert len(measured) > 8
    amplitudes, periods = np.array(measured).T
    assert periods == pytest.approx(free.periods(amplitudes), rel=within)


def test_rocking_on_rigid_ground_has_the_period_and_losses_of_the_sheet():
    """After two impacts the amplitude is down by exp(−2π ζ); 1e-3: zero crossings between rows, straight."""
    base = rb.RigidBase(restraints=(rb.Tendon(psi=0.3, lam=0.5),))
    free, measured = FreeRocking(TOWER, base), swings(base, 0.4)
    amplitudes = np.array([amplitude for amplitude, _ in measured])
    damping = free.impact_damping(amplitudes[:-2], TOWER.restitution)
    assert amplitudes[2:] / amplitudes[:-2] == pytest.approx(np.exp(-2.0 * math.pi * damping), rel=1e-5)
    assert np.array([period for _, period in measured]) == pytest.approx(free.periods(amplitudes), rel=1e-3)
