"""A pier that is let go from a rotation: against energy integrals on rigid ground, and DOP853 after a slow pull on springs.

On springs the reference is pulled there by an initial value problem in θ, in equilibrium all the way; rockbatch solves one
equation.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from core_samples import FIG5
from reference_solver import Rigid, TwoSprings
from restrained_reference import FIRST, TiedTwoSprings
from scipy.integrate import quad, solve_ivp

import rockbatch as rb
from rockbatch.pier import Damper, ElasticBase, Pier, RigidBase, Tendon, YieldingBase
from rockbatch.pier.restraints import DeckSpring, Stop
from rockbatch.simulation import run_fixed
from rockbatch.simulation.starting import start_of

STILL = rb.Motion.still(2.0, 0.01)
BLOCK = Pier(alpha=0.25, p=2.0)


def quarter(pier: Pier, amplitude: float) -> float:
    """Return the time [s] from rest at ``amplitude`` [rad], θ0, to the impact.

    ∫ dθ/√(2 p² (cos(α − θ) − cos(α − θ0))), by θ = θ0 − s².
    """

    def rate(s: float) -> float:
        # cos(α − θ) − cos(α − θ0), without the loss of digits near θ0
        drop = 2.0 * math.sin(pier.alpha - amplitude + 0.5 * s * s) * math.sin(0.5 * s * s)
        return (
            2.0 * s / math.sqrt(2.0 * drop) / pier.p
            if s
            else 2.0 / math.sqrt(2.0 * math.sin(pier.alpha - amplitude)) / pier.p
        )

    return quad(rate, 0.0, math.sqrt(amplitude), epsabs=1e-14, epsrel=1e-13)[0]


def after_impact(pier: Pier, amplitude: float, e: float) -> float:
    """Return the amplitude [rad] behind an impact that leaves e² of the energy 1/2 p² (cos(α − θ) − cos α) of the one before."""
    energy = math.cos(pier.alpha - amplitude) - math.cos(pier.alpha)
    return pier.alpha - math.acos(math.cos(pier.alpha) + e * e * energy)


def released(pier: Pier, theta: float) -> Pier:
    return replace(pier, initial_rotation_rad=theta)


@pytest.mark.parametrize("start", [0.05, 0.5, 0.95])
def test_a_block_passes_its_impacts_when_its_energy_says(start):
    """1e-9 s: RK4 at 16 steps of 0.01 s; not linearised, α = 0.25."""
    e, amplitude, t = 0.9, start * BLOCK.alpha, 0.0
    response = rb.simulate(released(BLOCK, amplitude), RigidBase(e), rb.Motion.still(10.0, 0.01), substeps=16)
    impacts = response.events[response.events.kind == "impact"]
    t += quarter(BLOCK, amplitude)
    for n in range(5):
        assert impacts.t.iloc[n] == pytest.approx(t, abs=1e-9)
        amplitude = after_impact(BLOCK, amplitude, e)
        t += 2.0 * quarter(BLOCK, amplitude)


def test_amplitudes_of_a_slender_block_are_housners():
    """φ_n = 1 − √(1 − rⁿ (1 − (1 − φ0)²)), r = e², and T/4 = acosh(1/(1 − φ0))/p (Housner 1963); 1e-6: α² of linearisation."""
    slender, e, phi0 = Pier(alpha=1e-3, p=2.0), 0.92, 0.7
    response = rb.simulate(released(slender, phi0 * 1e-3), RigidBase(e), rb.Motion.still(10.0, 0.001), substeps=16)
    rows = response.history
    for n in range(1, 7):
        ends = response.events[response.events.kind == "impact"].after.iloc[n - 1 : n + 1]
        largest = rows.theta.abs().iloc[ends.iloc[0] : ends.iloc[1]].max() / 1e-3
        assert largest == pytest.approx(1.0 - math.sqrt(1.0 - e ** (2 * n) * (1.0 - (1.0 - phi0) ** 2)), abs=1e-6)
    first = response.events[response.events.kind == "impact"].t.iloc[0]
    assert first == pytest.approx(math.acosh(1.0 / (1.0 - phi0)) / 2.0, abs=1e-6)


def test_a_block_let_go_under_a_record_agrees_with_the_reference():
    motion = rb.pulse("sine", name="sine", amplitude=3.0, period=0.6, dt=0.01, duration=3.0)
    for theta in (0.1, -0.1):
        expected = Rigid(BLOCK, RigidBase(0.9), motion, 0.0, theta0=theta).run()
        last = rb.simulate(
            BLOCK, RigidBase(0.9), motion, substeps=32, quiet_s=0.0, wait=False, initial_rotation_rad=theta
        )
        assert last.theta[-1] == pytest.approx(expected.theta, abs=1e-8)
        assert last.omega[-1] == pytest.approx(expected.omega, abs=1e-7)


# On springs


def pulled(solver: TwoSprings, theta: float) -> None:
    """Pull the reference slowly to ``theta`` > 0 [rad] from its static state, by dv/dθ in equilibrium, and hold it."""

    def softness(z: float, pressed: bool) -> float:
        if solver.law == "epp":
            return 0.0 if pressed and z <= -1.0 else 1.0
        return 1.0 - min(-z, 1.0) ** solver.n if pressed and solver.law in ("bouc-wen", "hardening") else 1.0

    def rates(angle: float, y, both: bool):
        v, z_left, z_right = y
        state = [v, angle, 0.0, 0.0, z_left, z_right]
        left, right = solver.arm(0, state), solver.arm(1, state)
        if not both:
            return [-right, 0.0, 0.0]
        k_left, k_right = softness(z_left, False), softness(z_right, True)
        slope = -(k_left * left + k_right * right) / (k_left + k_right)
        return [slope, k_left * (slope + left) / solver.dy, k_right * (slope + right) / solver.dy]

    def lifts(angle, y, both):
        return y[1]

    def yields(angle, y, both):
        return y[2] + 1.0 if solver.law == "epp" else 1.0

    lifts.terminal = yields.terminal = True
    y, angle, both = [solver.v0, solver.z0, solver.z0], 0.0, True
    while angle < theta:
        events = [lifts] if not both or y[2] <= -1.0 else [lifts, yields]
        way = solve_ivp(
            rates, (angle, theta), y, "DOP853", args=(both,), events=events if both else None, rtol=1e-12, atol=1e-15
        )
        y, angle = list(way.y[:, -1]), float(way.t[-1])
        if both and len(way.t_events[0]):
            y[1], both = 0.0, False
        elif both and angle < theta:
            y[2] = -1.0
    solver.y[:6] = [y[0], theta, 0.0, 0.0, y[1], y[2]]
    solver.rest = [solver.v0 - solver.dy * solver.z0] * 2
    left = "load" if solver.law == "bouc-wen" else "unload"
    solver.mode = [left if both else "free", "unload"]
    solver.deepest[1] = min(solver.deepest[1], y[2])


SPRINGS = {
    "elastic": ElasticBase(50, 0.1), "elastic-finite": ElasticBase(50, 0.1, "finite"), "damped": ElasticBase(50, zeta=0.1),
    "bouc-wen": YieldingBase(50, 0.1, eta=2.5), "bouc-wen-finite": YieldingBase(50, 0.1, "finite", eta=2.2),
    "bouc-wen-sinks": YieldingBase(50, 0.1, eta=1.8), "epp": YieldingBase(50, 0.1, eta=2.5, spring="epp"),
    "epp-sinks": YieldingBase(50, 0.1, eta=1.6, spring="epp"), "hardening": YieldingBase(50, 0.1, eta=2.2, spring="hardening"),
    "damped-hardening": YieldingBase(50, zeta=0.05, eta=2.2, spring="hardening"),
}  # fmt: skip


@pytest.mark.parametrize("share", [0.01, 0.4], ids=["in full contact", "lifted"])
@pytest.mark.parametrize(
    "name",
    [
        name if name in ("elastic", "damped", "bouc-wen", "epp-sinks") else pytest.param(name, marks=pytest.mark.slow)
        for name in SPRINGS
    ],
)
def test_springs_are_held_and_let_go_as_in_the_reference(name, share):
    """The held state to 1e-10; after 2 s 1e-7 α, as without a release (test_against_reference.py)."""
    base, theta = SPRINGS[name], share * FIG5.alpha
    solver = TwoSprings(FIG5, base, STILL, 0.0)
    pulled(solver, theta)
    start = start_of(released(FIG5, theta), base)
    assert start.level == pytest.approx(solver.v0, abs=1e-14)
    assert start.v == pytest.approx(solver.y[0], abs=1e-10)
    assert (start.z_left, start.z_right) == pytest.approx(tuple(solver.y[4:6]), abs=1e-9)
    expected = solver.run()
    pier = released(FIG5, theta)
    outcome = run_fixed(pier, base, STILL, substeps=32, quiet_s=0.0, wait=False)
    last = rb.simulate(pier, base, STILL, substeps=32, quiet_s=0.0, wait=False).history.iloc[-1]
    assert outcome.status == expected.status
    assert (outcome.impacts, outcome.separations) == (expected.impacts, expected.separations)
    assert last["theta"] == pytest.approx(expected.theta, abs=1e-7 * FIG5.alpha)
    assert last["omega"] == pytest.approx(expected.omega, abs=1e-6 * FIG5.alpha * FIG5.p)
    assert last["v"] == pytest.approx(expected.v, abs=1e-8)
    if base.yields:
        assert outcome.dissipated_right == pytest.approx(expected.dissipated_right, rel=1e-7, abs=1e-9)
    if outcome.settlement is not None:
        unstressed = solver.v0 - solver.dy * solver.z0
        assert outcome.settlement == pytest.approx(
            unstressed - 0.5 * (expected.base_left + expected.base_right), abs=1e-8
        )
        tilt = (expected.base_left - expected.base_right) / (2 * FIG5.half_width)
        assert outcome.base_tilt == pytest.approx(tilt, abs=1e-7 * FIG5.alpha)


DEVICES = (Tendon(psi=0.1, lam=0.3), Damper("viscous", nu=0.2), Damper("hysteretic", f=0.05, yield_m=0.02))


STOPS = (Stop(gap_m=0.1, lam=5.0, restitution=0.6), DeckSpring(lam=0.2, gap_m=0.05, restitution=0.5))
"""Met by a pier that is held at 0.05 rad: its heel has risen by 0.15 m, its deck has moved by 0.7 m."""


@pytest.mark.parametrize("base", [
    ElasticBase(50, 0.1, restraints=DEVICES), YieldingBase(50, 0.1, eta=2.5, restraints=(*DEVICES, Damper("friction", f=0.02))),
    RigidBase(0.9, restraints=(*DEVICES, Damper("friction", f=0.02))), RigidBase(0.9, restraints=STOPS),
    ElasticBase(50, 0.1, restraints=STOPS),
], ids=["elastic", "yielding", "rigid", "rigid-stops", "elastic-stops"])  # fmt: skip
def test_other_direction_is_the_mirror_image_with_devices(base):
    right, left = (rb.simulate(FIG5, base, STILL, initial_rotation_rad=theta, substeps=16) for theta in (0.05, -0.05))
    assert right.status == left.status == "ok"
    np.testing.assert_allclose(right.theta, -left.theta, atol=1e-9)
    assert right.row["settlement_m"] == pytest.approx(left.row["settlement_m"], nan_ok=True, abs=1e-12)
    ledger = rb.simulate(FIG5, base, STILL, initial_rotation_rad=0.05, substeps=16, ledger=True).ledger
    assert abs(ledger.remainder).max() < 1e-4 * abs(ledger.potential).max()


@pytest.mark.parametrize(
    "restraints", [pytest.param(DEVICES, id="all"), pytest.param(STOPS, id="stops", marks=pytest.mark.slow)]
)
def test_springs_with_devices_balance_where_they_are_held_and_follow_the_reference(restraints):
    """The reference starts from our held state, of which the balance is checked by its own geometry; then as without devices."""
    base, theta = ElasticBase(50, 0.1, restraints=restraints), 0.4 * FIG5.alpha
    start = start_of(released(FIG5, theta), base)
    solver = TiedTwoSprings(FIG5, base, STILL, 0.0)
    solver.y[:6] = [start.v, theta, 0.0, 0.0, start.z_left, start.z_right]
    solver.y[FIRST:] = list(start.states)
    solver.rest, solver.mode = [solver.v0 - solver.dy * solver.z0] * 2, ["free", "unload"]
    solver.way = [-1.0] * len(solver.elements)  # everything closes next
    for j, stop in solver.stops.items():
        if (elongation := solver.elongation(j, solver.y)) > stop.gap:
            stop.fire("turns back", elongation)
    assert start.z_left == 0.0
    assert solver.accelerations(solver.mode, solver.y, 0.0, 0.0)[0] == pytest.approx(0.0, abs=1e-9 * FIG5.gravity)
    for j, (device, _) in enumerate(solver.elements):
        if isinstance(device, Damper) and device.kind == "hysteretic":
            way = solver.elongation(j, solver.y) / device.yield_m
            z = solve_ivp(lambda _, z: 1.0 - abs(z) ** 5, (0.0, abs(way)), [0.0], "DOP853", rtol=1e-12, atol=1e-14).y[
                0, -1
            ]
            assert start.states[j] == pytest.approx(math.copysign(z, way), abs=1e-10)
    expected = solver.run()
    last = rb.simulate(
        FIG5, base, STILL, initial_rotation_rad=theta, substeps=32, quiet_s=0.0, wait=False
    ).history.iloc[-1]
    assert last["theta"] == pytest.approx(expected.theta, abs=1e-6 * FIG5.alpha)
    assert last["v"] == pytest.approx(expected.v, abs=1e-7)


def test_a_tendon_that_yielded_while_it_was_pulled_stays_longer():
    weak = Tendon(psi=0.1, lam=1.0, strength=0.15)
    for base in (RigidBase(restraints=(weak,)), ElasticBase(80, restraints=(weak,))):
        start = start_of(released(FIG5, 0.1), base)
        stiffness = FIG5.gravity * FIG5.size / FIG5.half_width**2
        elongation = 2.0 * FIG5.half_width * math.sin(0.05) if not base.on_springs else start.v - start.level
        assert start.states[0] == pytest.approx(elongation - 0.05 * FIG5.gravity / stiffness, rel=1e-12)


def test_friction_that_holds_a_pier_holds_it_where_it_is():
    base = RigidBase(restraints=(Damper("friction", f=0.6),))
    response = rb.simulate(FIG5, base, STILL, initial_rotation_rad=0.1)
    assert response.theta[-1] == pytest.approx(0.1, abs=1e-12)
    assert response.theta_res == pytest.approx(0.1, abs=1e-12)


def test_flight_after_a_release_stops_or_goes_on_as_the_base_says():
    block, pads = Pier.rectangle(0.3, 1.2), ElasticBase(40, zeta=0.05, flight="stop")
    stopped = rb.simulate(block, pads, STILL, initial_rotation_rad=0.1, substeps=32)
    assert stopped.status == "flight"
    assert 0.0 < stopped.t[-1] < 1.0
    assert (
        rb.simulate(block, replace(pads, flight="guided"), STILL, initial_rotation_rad=0.1, substeps=32).status == "ok"
    )


def test_a_peak_that_is_the_given_rotation_is_noted_and_a_greater_one_is_not():
    assert "from which the pier was let go" in rb.simulate(FIG5, RigidBase(), STILL, initial_rotation_rad=0.05).note
    motion = rb.pulse("sine", name="sine", amplitude=4.0, period=0.6, dt=0.01, duration=3.0)
    assert "let go" not in rb.simulate(FIG5, RigidBase(), motion, initial_rotation_rad=0.01).note


def test_gaps_of_a_pivot_that_was_lifted_by_hand_count_from_the_support_before_it():
    base = YieldingBase(50, 0.1, eta=2.2)
    response = rb.simulate(FIG5, base, STILL, initial_rotation_rad=0.1, forces=True, substeps=8)
    start = start_of(released(FIG5, 0.1), base)
    gap = start.v + 0.1 * FIG5.half_width - start.unstressed
    assert response.forces.heel_gap_left.iloc[0] == pytest.approx(gap, abs=1e-12)
