"""Springs with a backbone: the polyline traced by hand, the elastic–perfectly plastic limit, and solvers that share no code."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from backbone_reference import OnBackbone, TiedOnBackbone, backbone_case
from core_samples import FIG5, pulse

import rockbatch as rb
from rockbatch import simulate
from rockbatch.pier import Damper, Tendon, YieldingBase, yield_deflection
from rockbatch.pier.equilibrium import SlowTurn
from rockbatch.simulation import run_fixed, run_to_tolerance

POINTS = ((1.0, 1.0), (2.0, 1.7), (3.5, 2.3), (6.0, 2.8))
ENDLESS = YieldingBase(50.0, 0.1, eta=1.2, spring="backbone", backbone=POINTS)
PLASTIC = replace(ENDLESS, backbone=((1.0, 1.0), (1.5, 1.35), (2.5, 1.55), (4.0, 1.55)))
SOFT_AT_REST = replace(ENDLESS, eta=0.7)
PUSH = pulse("sine", 0.5, dt=0.01, end=1.5)


def envelope(base, depth):
    """Return force/F_y of the polyline at a deflection/δ_y, by hand."""
    (x_before, force_before), (x_last, force_last) = base.backbone[-2:]
    x, force = np.array([(0.0, 0.0), *base.backbone]).T
    beyond = np.maximum(depth - x_last, 0.0) * (force_last - force_before) / (x_last - x_before)
    return np.interp(depth, x, force) + beyond


def deflections(response, side):
    """Return the deflection/δ_y of a support below its unstressed place at the start, and its force/F_y, while in contact."""
    history, soft = response.history, yield_deflection(FIG5, response.base)
    depth = -history[f"v_{side}"].to_numpy() / soft
    force = -history[f"z_{side}"].to_numpy()
    return depth[force > 0.0], force[force > 0.0]


@pytest.mark.parametrize(
    "base",
    [ENDLESS, pytest.param(PLASTIC, marks=pytest.mark.slow), pytest.param(SOFT_AT_REST, marks=pytest.mark.slow)],
    ids=["endless", "plastic", "soft at rest"],
)
def test_a_spring_traces_its_backbone_and_is_elastic_below_it(uncompiled, base):
    """Where it is deeper than ever it bears the polyline's force, elsewhere less by the way up from there over δ_y.

    1e-10: at an event the force is set to that of the corner, which is located to 2e-11 of δ_y.
    """
    response = uncompiled(simulate, FIG5, base, PUSH, substeps=2, quiet_s=0.0, wait=False)
    deepest = 0.0
    for side in ("left", "right"):
        depth, force = deflections(response, side)
        most = np.maximum.accumulate(np.maximum(depth, depth[0]))
        np.testing.assert_allclose(force, envelope(base, most) - (most - depth), rtol=0, atol=1e-10)
        deepest = max(deepest, most.max())
    assert deepest > base.backbone[-2][0]  # beyond its last corner


@pytest.mark.slow
def test_one_corner_and_no_slope_beyond_it_is_the_elastic_perfectly_plastic_spring(uncompiled):
    """With a damper reversals of both laws are events, so that they take the same steps."""
    rest = {"epsilon": 0.1, "eta": 2.2, "restraints": (Damper("viscous", nu=0.02),)}
    laws = {"spring": "epp"}, {"spring": "backbone", "backbone": ((1.0, 1.0), (2.0, 1.0))}
    runs = [
        uncompiled(simulate, FIG5, YieldingBase(50.0, **rest, **law), PUSH, substeps=2, quiet_s=0.0, wait=False)
        for law in laws
    ]
    for name in ("t", "theta", "v", "z_left", "z_right"):
        np.testing.assert_allclose(runs[1].history[name], runs[0].history[name], rtol=0, atol=1e-13, err_msg=name)
    assert runs[0].history.z_left.min() == pytest.approx(-1.0, abs=1e-9)


def test_a_support_at_rest_beyond_a_corner_is_in_equilibrium(uncompiled):
    """η = 0.7: the force at rest is 1.43 F_y, on the second slope, at 1 + 0.43/0.7 δ_y."""
    still = rb.Motion.still(0.5)
    response = uncompiled(simulate, FIG5, SOFT_AT_REST, still, substeps=1, quiet_s=0.0, wait=False)
    soft, first = yield_deflection(FIG5, SOFT_AT_REST), response.history.iloc[0]
    assert first.z_left == pytest.approx(-1.0 / 0.7, rel=1e-15)
    assert first.v == pytest.approx(-soft * (1.0 + (1.0 / 0.7 - 1.0) / 0.7), rel=1e-14)
    assert response.theta_max == 0.0
    assert response.history.v.to_numpy() == pytest.approx(first.v, rel=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize("base", [ENDLESS, PLASTIC, SOFT_AT_REST], ids=["endless", "plastic", "soft at rest"])
def test_the_ledger_closes_and_has_the_work_of_each_branch(base):
    """The closed form of each branch against the ledger's quadrature, which is exact where force and velocity are cubic."""
    remainders = []
    for steps in (4, 8):
        run = simulate(FIG5, base, PUSH, substeps=steps, quiet_s=0.0, wait=False, ledger=True)
        remainders.append(np.abs(run.ledger["remainder"]).max())
    plastic, outcome = run.ledger["plastic"].iloc[-1], run_fixed(FIG5, base, PUSH, 8, 0.0, wait=False)
    assert plastic == pytest.approx(outcome.dissipated_left + outcome.dissipated_right, rel=1e-7)
    assert remainders[1] < 1e-6 * plastic
    assert remainders[1] < remainders[0] / 8.0


@pytest.mark.slow
def test_the_mirror_image_of_a_motion_gives_the_mirror_image():
    """To the bit but for the order of two sums."""
    there, back = (
        simulate(FIG5, ENDLESS, motion, substeps=4, quiet_s=0.0, wait=False).history
        for motion in (PUSH, PUSH.scaled(-1.0))
    )
    np.testing.assert_allclose(back.theta, -there.theta, rtol=0, atol=1e-13 * FIG5.alpha)
    np.testing.assert_allclose(back.z_right, there.z_left, rtol=0, atol=1e-10)


@pytest.mark.slow
def test_corners_at_which_the_slope_stays_change_nothing():
    more = replace(ENDLESS, backbone=((1.0, 1.0), (1.5, 1.35), *POINTS[1:3], (5.0, 2.6), POINTS[3]))
    runs = [run_fixed(FIG5, base, PUSH, 16, 0.0, wait=False) for base in (ENDLESS, more)]
    assert runs[1].theta_max == pytest.approx(runs[0].theta_max, rel=1e-8)
    assert runs[1].settlement == pytest.approx(runs[0].settlement, rel=1e-8)


@pytest.mark.slow
@pytest.mark.parametrize("base", [ENDLESS, PLASTIC, SOFT_AT_REST], ids=["endless", "plastic", "soft at rest"])
def test_the_order_is_four_across_corners(base):
    solver = OnBackbone(FIG5, base, PUSH, 0.0)
    expected = solver.run()
    assert solver.passed > 2
    errors = [
        max(abs(run.theta_max - expected.theta_max), abs(run.dissipated_left - expected.dissipated_left))
        for run in (run_fixed(FIG5, base, PUSH, steps, 0.0, wait=False) for steps in (2, 4, 8, 16))
    ]
    orders = [math.log2(coarse / fine) for coarse, fine in pairwise(errors)]
    assert np.mean(orders) > 3.5
    assert errors[-1] < 1e-8


def seeds_of(kinds):
    """Return seeds of undamped cases in first-order kinematics ("common"), whose kernel slow tests compile, or of the others."""
    cases = {seed: backbone_case(seed)[1] for seed in range(60)}
    return [
        seed
        for seed, base in cases.items()
        if (base.zeta is None and base.kinematics == "first-order") == (kinds == "common")
    ]


@pytest.mark.parametrize(
    "seeds",
    [
        pytest.param(seeds_of("common"), id="common", marks=pytest.mark.slow),
        pytest.param(seeds_of("others"), id="others", marks=pytest.mark.thorough),
    ],
)
def test_random_hard_cases_agree_with_the_reference(seeds):
    """Status, peak to the tolerance of 1e-6 α and within the run's error, impacts, plastic work; the reference errs by 1e-9 α."""
    compared = 0
    for seed in seeds:
        pier, base, motion = backbone_case(seed)
        converged = run_to_tolerance(pier, base, motion, 1e-6, 1.0)
        if converged.status != "ok":
            continue  # where an overturning pier stops is a matter of definition
        outcome = run_fixed(pier, base, motion, converged.substeps, 1.0, wait=False)
        expected = OnBackbone(pier, base, motion, 1.0).run()
        assert outcome.status == expected.status == "ok", seed
        assert outcome.theta_max == pytest.approx(expected.theta_max, rel=0, abs=1e-6 * pier.alpha), seed
        error = abs(converged.theta_max - expected.theta_max)
        assert error <= converged.theta_max_error + 1e-9 * pier.alpha or outcome.theta_max != converged.theta_max, seed
        assert outcome.impacts == expected.impacts, seed
        work = outcome.dissipated_left + outcome.dissipated_right
        assert work == pytest.approx(expected.dissipated_left + expected.dissipated_right, rel=1e-5, abs=1e-12), seed
        compared += 1
    assert compared >= len(seeds) / 2


@pytest.mark.thorough
@pytest.mark.parametrize("zeta", [None, 0.05])
@pytest.mark.parametrize(
    "device",
    [Damper("viscous", nu=0.1), Damper("friction", f=0.05), Tendon(psi=0.1, lam=0.2)],
    ids=["viscous", "friction", "tendon"],
)
def test_devices_on_a_backbone_agree_with_the_reference(device, zeta):
    """A tendon's prestress adds to the force at rest, which is beyond the first corner then."""
    base = replace(ENDLESS, epsilon=0.0 if zeta else 0.1, eta=1.05, zeta=zeta, restraints=(device,))
    solver = TiedOnBackbone(FIG5, base, PUSH, 0.0)
    expected = solver.run()
    assert solver.passed > 0
    outcome = run_fixed(FIG5, base, PUSH, 16, 0.0, wait=False)
    assert outcome.theta_max == pytest.approx(expected.theta_max, rel=2e-8)
    assert outcome.impacts == expected.impacts
    work = outcome.dissipated_left + outcome.dissipated_right
    assert work == pytest.approx(expected.dissipated_left + expected.dissipated_right, rel=1e-6)


@pytest.mark.thorough
def test_a_release_from_a_rotation_starts_on_the_polyline():
    """The compressed spring bears the weight but for the other one's share: here alone, 2/η = 5/3 F_y, on the second slope."""
    base = replace(ENDLESS, epsilon=0.0, zeta=0.05)
    response = simulate(
        FIG5, base, rb.Motion.still(2.0), initial_rotation_rad=0.05, substeps=8, quiet_s=0.0, wait=False, ledger=True
    )
    first, soft = response.history.iloc[0], yield_deflection(FIG5, base)
    assert (first.z_left, first.z_right) == pytest.approx((0.0, -5.0 / 3.0), rel=1e-12)
    assert -first.v_right / soft == pytest.approx(1.0 + (5.0 / 3.0 - 1.0) / 0.7, rel=1e-10)
    assert np.abs(response.ledger["remainder"]).max() < 1e-6


@pytest.mark.thorough
@pytest.mark.parametrize("eta", [0.8, 1.2])
def test_a_pier_turns_under_a_slow_ramp_as_the_statics_sheet_says(eta):
    """At 0.3, 0.6 and 0.9 of the strength; 1 %: what damping and vibration leave."""
    base, dt, rise = replace(ENDLESS, beta=80.0, epsilon=0.0, eta=eta, zeta=0.5), 0.01, 60.0
    sheet = rb.statics(FIG5, base)
    shares = np.linspace(0.0, 0.95, round(rise / dt) + 1)
    motion = rb.Motion("ramp", dt, FIG5.gravity * sheet.strength_g * shares)
    history = simulate(FIG5, base, motion, substeps=4, quiet_s=0.0, wait=False).history
    curve = SlowTurn(FIG5, base).curve(sheet.strength_rad)
    for share in (0.3, 0.6, 0.9):
        static = np.interp(share * sheet.strength_g, curve.acceleration, curve.theta)
        assert np.interp(share / 0.95 * rise, history["t"], history["theta"]) == pytest.approx(-static, rel=0.01)
