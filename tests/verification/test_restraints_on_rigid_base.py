"""A pier on a rigid base (THEORY.md, Dampers and tendons) against closed forms and a derivation of their own.

The reference below integrates the block with SciPy's DOP853; elongations and moments come from the coordinates of the points
that an element joins, not from the half angles of the core.
"""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from core_samples import FIG5, TOWER, broadband, pulse
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import rockbatch as rb
from rockbatch.common.errors import InputError
from rockbatch.common.units import GRAVITY
from rockbatch.core import types
from rockbatch.core.block import lanes
from rockbatch.core.devices.lanes import equipment_of
from rockbatch.core.history import MOMENT
from rockbatch.core.run import march
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, DeckSpring, ElasticBase, Pier, RigidBase, Stop, Tendon, problems
from rockbatch.simulation import Run, run_fixed, run_to_tolerance, written_run
from rockbatch.simulation.elements import elements
from rockbatch.simulation.models import block
from rockbatch.simulation.restraints import rests_on_rigid_base
from rockbatch.simulation.runs import LEFT_ALONE

ONE_SINE = pulse("sine", 0.5, 1.0, dt=1e-4, end=3.0)
STILL = np.zeros(4001)
GOES_ON = np.zeros(1, np.uint8)


def base(*restraints, restitution=None):
    return RigidBase(restitution, restraints, confirm=("restitution",))


def extremes(theta):
    """Turning values of a history, and those of the samples beside them by a parabola."""
    at = np.flatnonzero((np.abs(theta[1:-1]) > np.abs(theta[:-2])) & (np.abs(theta[1:-1]) >= np.abs(theta[2:]))) + 1
    return theta[at]


def free(pier, foundation, theta, dt=1e-3, samples=STILL, substeps=4):
    """History of a block that is let go at ``theta`` [rad], with every step."""
    m, ground = block(pier, foundation), np.zeros((len(samples), 4))
    kind, line = lanes.system_of(m), lanes.line_of(m, theta, 0.0, dt, substeps, 0, 0, len(samples), 0)
    devices = equipment_of(kind, [(elements(pier, foundation), (), math.nan)])
    history = np.zeros((80_000, len(MOMENT) + len(kind.columns) + devices.x.shape[1] + 2))
    found = march(kind, [line], ground, GOES_ON, substeps, every_step=True, history=history[None], devices=devices)[0]
    names = [*MOMENT, *kind.columns]
    return np.rec.fromarrays(history[: found.rows, : len(names)].T, names=names)


@pytest.mark.parametrize(
    ("restraint", "first", "second"),
    [
        (None, -0.112103, 0.178073),
        (Damper("friction", f=0.1), -0.099236, 0.137669),
        (Damper("viscous", nu=1.0), -0.110036, 0.165510),
        (Tendon(psi=0.5), -0.081923, 0.177956),
        (Tendon(lam=1.0), -0.110447, 0.173430),
    ],
    ids=["none", "friction", "viscous", "prestress", "stiffness"],
)
def test_extremes_under_one_sine_of_two_independent_solvers(restraint, first, second):
    """α = 0.2, μ = 3, p = 1, Housner's e, 1 g × 0.5 s sampled at 0.1 ms."""
    foundation = base(*([restraint] if restraint else [Tendon()]))
    found, rows = written_run(Run(FIG5, foundation, ONE_SINE), 1, 0.0, 40_000, wait=False)
    turned = extremes(rows.theta[: found.rows]) / FIG5.alpha
    assert turned[:2] == pytest.approx([first, second], abs=6e-7)


@pytest.mark.parametrize(
    ("tendon", "time"),
    [(Tendon(), 1.3185043975), (Tendon(psi=0.5), 0.9647481830), (Tendon(lam=1.0), 1.0010008340)],
    ids=["none", "prestress", "stiffness"],
)
def test_quarter_period_from_half_of_alpha(tendon, time):
    rows = free(FIG5, base(tendon), 0.5 * FIG5.alpha)
    assert rows.t[rows.kind > 0.0][0] * FIG5.p == pytest.approx(time, abs=2e-10)


def test_free_decay_with_friction_is_that_of_the_energies():
    """V(θ₁) + W(θ₁) = e² [V(θ₀) − W(θ₀)], V = cos(α − θ) − cos α, W = 4 f sin α sin(θ/2); f = 0.1."""
    alpha, f, e = FIG5.alpha, 0.1, FIG5.restitution
    theta, expected = 0.5 * alpha, []
    for _ in range(2):
        level = e**2 * (math.cos(alpha - theta) - math.cos(alpha) - 4 * f * math.sin(alpha) * math.sin(theta / 2))
        low, high = 0.0, theta
        for _ in range(200):
            middle = 0.5 * (low + high)
            over = math.cos(alpha - middle) - math.cos(alpha) + 4 * f * math.sin(alpha) * math.sin(middle / 2) > level
            low, high = (low, middle) if over else (middle, high)
        theta = low
        expected.append(theta / alpha)
    assert expected == pytest.approx([0.224305164, 0.119919682], abs=1e-9)
    rows = free(FIG5, base(Damper("friction", f=f)), 0.5 * alpha, dt=2e-3, substeps=8)
    speeds = rows.omega[np.isin(rows.kind, (types.IMPACT_LEFT, types.IMPACT_RIGHT))][:2]
    for speed, extreme in zip(speeds, expected, strict=True):  # ½ θ̇²/p² after the impact is V + W at the extreme
        theta = extreme * alpha
        climbed = math.cos(alpha - theta) - math.cos(alpha) + 4 * f * math.sin(alpha) * math.sin(theta / 2)
        assert 0.5 * speed**2 / FIG5.p**2 == pytest.approx(climbed, rel=1e-9)


@pytest.mark.parametrize(
    ("restraint", "factor"),
    [(Damper("friction", f=0.2), 1.4), (Tendon(psi=0.5), 1.5), (Tendon(psi=0.5, at="left"), 2.0)],
)
def test_lift_off_takes_what_friction_and_prestress_add(restraint, factor):
    """|ü_g| = (1 + 2 f) g tan α, (1 + ψ) g tan α; a tendon at the other pivot has twice the arm."""
    threshold = factor * GRAVITY * math.tan(FIG5.alpha)
    for share, lifts in ((1.0 - 1e-9, 0), (1.0 + 1e-9, 1)):
        steady = Motion("steady", 0.01, np.full(100, -share * threshold))  # to the right, about the right corner
        outcome = run_fixed(FIG5, base(restraint), steady, 4, 0.0, wait=False)
        assert outcome.separations == lifts


def test_a_block_that_is_let_go_by_no_more_than_rounding_goes():
    """Where the ground reaches the threshold, the acceleration is 0 but for rounding: no endless turning on the spot.

    What is left of a hysteretic damper's force after the bounces before is such a rounding.
    """
    foundation = base(Damper("hysteretic", f=0.05, yield_m=0.005))
    for seed in range(52):
        motion = Motion("noise", 0.01, broadband(np.random.default_rng(seed), 0.01, 300, 4.0))
        outcome = run_fixed(FIG5, foundation, motion, 1, 0.5, wait=False)
        assert outcome.status == "ok", f"{seed}: {outcome.reason}"


@pytest.mark.parametrize("f", [0.2, 0.3, 0.4])
def test_friction_brings_to_rest_a_block_that_impacts_do_not_slow(f):
    """As in the limit of restitutions below 1: of ever lower bounces there were more than a run follows."""
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=4.0)
    limit, found = (
        rb.simulate(FIG5, base(Damper("friction", f=f), restitution=e), motion, substeps=4) for e in (1.0 - 1e-9, 1.0)
    )
    assert found.status == "ok"
    assert found.theta_max == pytest.approx(limit.theta_max, rel=1e-8)
    assert "rest" in set(found.events.kind)
    assert list(found.events.kind) == list(limit.events.kind)
    assert found.events.t.to_numpy() == pytest.approx(limit.events.t.to_numpy(), abs=1e-6)


@pytest.mark.parametrize(("f", "psi"), [(0.499, 0.0), (0.501, 0.0), (0.749, 0.5), (0.751, 0.5)])
def test_it_recentres_below_the_edge_and_is_held_above(f, psi):
    """2 f < 1 + ψ."""
    restraints = (Damper("friction", f=f), Tendon(psi=psi))
    foundation, goes_back = base(*restraints), 2 * f < 1 + psi
    motion = pulse("sine", 0.5, 2.0, dt=0.005, end=2.0)
    outcome = run_to_tolerance(FIG5, foundation, motion, 1e-6)
    assert outcome.status == "ok"
    assert outcome.theta_max > 0.01 * FIG5.alpha
    held = free(FIG5, foundation, 1e-3 * FIG5.alpha)
    assert (held.theta[-1] == pytest.approx(1e-3 * FIG5.alpha, rel=1e-11)) != goes_back  # but for rounding


def test_a_stiff_tendon_holds_a_pier_that_leans_beyond_alpha():
    """λ > cos α hardens: cos(α − θ) − λ cos θ has its minimum at 0 alone. λ at cos α stands to a right angle, without falls."""
    for lam in (math.cos(FIG5.alpha), 1.2):
        rows = free(FIG5, base(Tendon(lam=lam), restitution=1.0), 1.3 * FIG5.alpha)
        assert rows.theta.min() < -1.25 * FIG5.alpha
    assert abs(free(FIG5, base(Tendon(lam=0.3)), 1.6 * FIG5.alpha, dt=3e-3).theta[-1]) > 1.5  # falls


def test_hysteretic_dampers_tend_to_friction_as_their_yield_deflection_vanishes():
    motion = pulse("sine", 0.5, 1.0, dt=0.001, end=2.0)
    friction = run_fixed(FIG5, base(Damper("friction", f=0.1)), motion, 4, 0.0, wait=False).theta_max
    soft, hard = (
        run_fixed(FIG5, base(Damper("hysteretic", f=0.1, yield_m=u)), motion, 16, 0.0, wait=False).theta_max
        for u in (1e-3, 1e-4)
    )
    assert abs(hard - friction) < 0.4 * abs(soft - friction) < 0.02 * friction


# Against the reference


def moments(pier, tied, theta, omega):
    """Moment over the mass [m²/s²] of an element about the corner, by coordinates: against the opening, positive.

    ``tied`` is (offset, force of elongation [m] and its rate [m/s]).
    """
    offset, law = tied
    corner = math.copysign(pier.half_width, theta)
    c, s = math.cos(theta), math.sin(theta)
    x0 = offset - corner  # from the corner, the ground's point; the pier's has turned by θ to the right
    point = np.array([x0 * c, -x0 * s])
    apart = point - np.array([x0, 0.0])
    elongation = math.copysign(math.hypot(*apart), apart[1])  # beyond the corner the pier's point goes down
    if elongation == 0.0:
        return 0.0
    direction = apart / elongation
    velocity = omega * np.array([point[1], -point[0]])
    pull = -law(elongation, float(direction @ velocity)) * direction
    torque = point[1] * pull[0] - point[0] * pull[1]  # positive to the right, as θ
    return -torque * math.copysign(1.0, theta)


def peak_of_reference(pier, motion, tied, t_end):
    """Greatest |θ| until ``t_end`` by DOP853, from sample to sample, impacts located; laws without memory."""
    e, inertia = pier.restitution, pier.inertia_about_pivot
    t, y, side, peak = 0.0, [0.0, 0.0], 0.0, 0.0
    samples = np.append(motion.horizontal, 0.0)

    def rhs(t, y, side):
        at = t / motion.dt
        i = min(int(at), len(samples) - 2)
        push = samples[i] + (at - i) * (samples[i + 1] - samples[i]) if at < len(samples) - 1 else 0.0
        theta = y[0] if side * y[0] > 0.0 else side * 1e-300
        lean = pier.alpha * side - theta
        free = -(pier.p**2) * (math.sin(lean) + push / pier.gravity * math.cos(lean))
        held = sum(moments(pier, each, theta, y[1]) for each in tied) / inertia
        return [y[1], free - side * held]

    def lands(t, y, side):
        return side * y[0]

    def turns(t, y, side):
        return y[1]

    lands.terminal, lands.direction = True, -1.0
    turns.terminal = True
    for i in range(round(t_end / motion.dt)):
        t, end = i * motion.dt, (i + 1) * motion.dt
        while t < end:
            if side == 0.0:
                opening = {way: (lambda s, way=way: way * rhs(s, [0.0, way * 1e-13], way)[1]) for way in (1.0, -1.0)}
                lifts = [way for way, excess in opening.items() if excess(end - 1e-9 * motion.dt) > 0.0]
                if not lifts:
                    break
                side = lifts[0]
                if opening[side](t) < 0.0:
                    t = brentq(opening[side], t, end - 1e-9 * motion.dt, xtol=1e-15)
                y = [0.0, side * 1e-13]
            found = solve_ivp(rhs, (t, end), y, "DOP853", args=(side,), events=[lands, turns], rtol=1e-11, atol=1e-14)
            t, y = float(found.t[-1]), found.y[:, -1].tolist()
            peak = max(peak, abs(y[0]))
            if len(found.t_events[0]):
                y = [0.0, e * y[1]]
                side = math.copysign(1.0, y[1])
            elif len(found.t_events[1]):
                y[1] = math.copysign(1e-13, rhs(t, [y[0], 0.0], side)[1])
    return peak


def clipped(psi, stiffness, gravity):
    return lambda e, rate: max(psi * gravity + stiffness * e, 0.0)


@pytest.mark.parametrize("at", ["left", 0.7, 0.0, 1.4 * FIG5.half_width, -2.0 * FIG5.half_width])
def test_elements_at_offsets_agree_with_the_reference(at):
    """A viscous damper with an exponent of 1.5 and a tendon, anywhere; to 1e-8 α."""
    restraints = (Damper("viscous", nu=0.4, exponent=1.5, at=at), Tendon(psi=0.1, lam=0.5, at=at))
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=1.6)
    offset = -FIG5.half_width if at == "left" else at
    stiffness = 0.5 * FIG5.gravity * FIG5.size / FIG5.half_width**2
    tied = [
        (offset, lambda e, rate: math.copysign(0.4 * FIG5.p * abs(rate) ** 1.5, rate)),
        (offset, clipped(0.1, stiffness, FIG5.gravity)),
    ]
    outcome = run_fixed(FIG5, base(*restraints), motion, 64, 0.0, wait=False)
    expected = peak_of_reference(FIG5, motion, tied, 1.6)
    assert outcome.theta_max == pytest.approx(expected, abs=1e-8 * FIG5.alpha)


def rubbing(strength):
    return lambda e, rate: math.copysign(strength, rate) if rate != 0.0 else 0.0


def test_friction_at_two_places_beyond_both_pivots_agrees_with_the_reference():
    """At ±1.4 b: one opens while the other closes, whichever corner the block rocks about."""
    b = FIG5.half_width
    restraints = (Damper("friction", f=0.1, at=1.4 * b), Damper("friction", f=0.06, at=-1.4 * b))
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=1.6)
    tied = [(1.4 * b, rubbing(0.1 * GRAVITY)), (-1.4 * b, rubbing(0.06 * GRAVITY))]
    outcome = run_fixed(FIG5, base(*restraints), motion, 64, 0.0, wait=False)
    assert outcome.theta_max == pytest.approx(peak_of_reference(FIG5, motion, tied, 1.6), abs=1e-8 * FIG5.alpha)


@pytest.mark.parametrize("exponent", [0.1, 0.15, 0.2, 0.3])
def test_small_exponents_agree_with_the_reference(exponent):
    """The same law: linear below the speed at which the damper would slow the block at a rate of 100 p."""
    c, b, inertia = 0.3 * FIG5.p, FIG5.half_width, FIG5.inertia_about_pivot
    slow = (c * (2.0 * b) ** 2 / inertia / (100.0 * FIG5.p)) ** (1.0 / (1.0 - exponent))

    def law(e, rate):
        return (
            c * slow ** (exponent - 1.0) * rate if abs(rate) < slow else math.copysign(c * abs(rate) ** exponent, rate)
        )

    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=1.6)
    outcome = run_fixed(FIG5, base(Damper("viscous", nu=0.3, exponent=exponent)), motion, 64, 0.0, wait=False)
    expected = peak_of_reference(FIG5, motion, [(-b, law), (b, law)], 1.6)
    assert outcome.theta_max == pytest.approx(expected, abs=1e-7 * FIG5.alpha)


def test_small_exponents_never_fail():
    rng = np.random.default_rng(11)
    for number in range(60):
        pier = Pier(alpha=float(rng.uniform(0.1, 0.3)), p=float(10.0 ** rng.uniform(-0.5, 0.5)))
        damper = Damper("viscous", nu=float(10.0 ** rng.uniform(-1.5, 0.0)), exponent=(0.1, 0.15, 0.2, 0.3)[number % 4])
        period, strength = float(rng.uniform(0.3, 2.0)), float(rng.uniform(0.1, 1.2))
        motion = pulse(("sine", "cosine")[number % 2], period, strength, dt=0.005, end=period + 2.0)
        outcome = run_to_tolerance(pier, base(damper), motion, 1e-4)
        assert outcome.status != "failed", (number, outcome.reason)


# How runs end


@pytest.mark.parametrize(
    ("f", "yield_m", "amplitude", "status"),
    [(0.1, 0.005, 9.252525, "overturned"), (0.7, 0.03, 17.3145, "overturned"), (0.55, 0.001, 16.0, "failed")],
)
def test_how_a_run_with_a_hysteretic_damper_ends_does_not_depend_on_the_quiet_time(f, yield_m, amplitude, status):
    """What it has stored, about to turn the pier further, keeps a run from being decided."""
    foundation = base(Damper("hysteretic", f=f, yield_m=yield_m))
    motion = rb.pulse("half-sine", name="h", amplitude=amplitude, period=1.0, dt=0.005, duration=6.0)
    ends = [run_to_tolerance(FIG5, foundation, motion, 1e-4, quiet_s).status for quiet_s in (2.0, 60.0, 240.0)]
    assert ends == [status] * 3


def test_a_tendon_of_twice_the_weight_keeps_the_block_on_the_ground():
    """N = g + v̈_g + P0/M = 1.95 g at −1.05 g; without the tendon it flies."""
    down = np.zeros(400)
    down[100:140] = -1.05 * GRAVITY
    motion = Motion("down", 0.005, pulse("sine", 1.0, 0.3, end=1.995).horizontal, down)
    held = run_fixed(FIG5, base(Tendon(psi=2.0, lam=0.5)), motion, 4)
    assert (held.status, held.flights) == ("ok", 0)
    free_to_fly = run_fixed(FIG5, replace(base(), flight="guided"), motion, 4)
    assert free_to_fly.flights > 0


@pytest.mark.parametrize(("strength", "count"), [(math.inf, 0), (0.1, 4)])
def test_slackness_without_prestress_is_no_matter_of_rounding(strength, count):
    """Taut wherever the block is not upright, until it has yielded."""
    motion = pulse("sine", 0.5, 1.5, dt=0.01, end=3.0)
    foundation = base(Tendon(psi=0.0, lam=1.0, strength=strength))
    found = [run_fixed(FIG5, foundation, motion, k).tendon_slack for k in (1, 2, 4, 8, 16)]
    assert found == [count] * 5


@pytest.mark.parametrize("damper", [Damper("friction", f=0.6), Damper("hysteretic", f=0.9, yield_m=0.005)])
def test_dampers_that_hold_the_block_give_its_residual_rotation(damper):
    """2 f > 1. Friction holds it where it stops; hysteretic dampers where, elastic from the end on, they balance the weight."""
    motion, b = pulse("sine", 0.5, 3.0, dt=0.005, end=2.0), FIG5.half_width
    outcome = run_fixed(FIG5, base(damper), motion, 8)
    found, rows = written_run(Run(FIG5, base(damper), motion), 8, 2.0, 60_000)
    last, rests = rows[found.rows - 1], outcome.theta_res
    assert outcome.status == "ok"
    assert abs(rests) > 0.01 * FIG5.alpha
    if damper.kind == "friction":
        assert rests == last.theta
        return

    def law(offset, z):
        now = 2.0 * abs(offset - math.copysign(b, rests)) * math.sin(0.5 * abs(last.theta))
        return offset, lambda e, rate: damper.f * GRAVITY * (z + (e - now) / damper.yield_m)

    ways = [law(offset, z) for offset, z in zip((-b, b), last.state, strict=True)]
    righting = GRAVITY * FIG5.size * math.sin(FIG5.alpha - abs(rests))
    assert sum(moments(FIG5, each, rests, 0.0) for each in ways) == pytest.approx(-righting, rel=1e-9)
    rubs, end = base(damper, Damper("friction", f=0.1, at=0.0)), SimpleNamespace(theta_end=last.theta)
    assert rests_on_rigid_base(FIG5, rubs, end, [*last.state, 0.0], [False] * 3) == pytest.approx(rests, rel=1e-12)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_damper_at_the_deck_holds_the_block_where_it_balances_the_weight(side):
    """Beside a spring. Points of the block about its pivot are complex numbers, turned by exp(−iθ); the damper is elastic from
    the end on."""
    damper, b, deck, theta, z = Damper("hysteretic", f=0.5, yield_m=0.02, at="deck"), FIG5.half_width, 7.0, 0.05, -0.1
    pier = replace(FIG5, deck_height_m=deck)

    def moment(tilt):
        centre, top = ((-b + 1j * height) * np.exp(-1j * tilt) for height in (FIG5.height, deck))
        steel = 0.5 * (z + (top - (-b + 1j * deck) * np.exp(-1j * theta)).real / 0.02)
        spring = 0.01 * FIG5.size / b**2 * (top.real + b)
        return GRAVITY * ((-1j * centre).imag + (steel + spring) * (-1j * top).real)

    end, devices = SimpleNamespace(theta_end=side * theta), (damper, DeckSpring(0.01))
    rests = rests_on_rigid_base(pier, base(*devices), end, [side * z, 0.0], [False] * 2)
    assert rests == pytest.approx(side * brentq(moment, 0.0, theta, xtol=1e-15), rel=1e-10)


@pytest.mark.parametrize(
    ("gap", "deepest", "e", "closed"),
    [(0.01, 0.0, 0.6, True), (0.01, 0.14, 0.95, True), (0.1, 0.0, 0.6, False), (0.01, 0.2, 0.6, False)],
)
def test_a_stop_that_opens_before_the_block_rests_pulls_no_more(gap, deepest, e, closed):
    """The stop goes up by k, and after a compression down by k/e² until it opens; the damper is elastic from the end on."""
    b, k, z, yield_m, theta = FIG5.half_width, 0.5 * GRAVITY * FIG5.size / FIG5.half_width**2, 0.2, 0.05, 0.1

    def pull(tilt):
        u = 2.0 * b * math.sin(0.5 * tilt)
        return max(0.0, min(k * (u - gap), k / e**2 * (u - gap - deepest) + k * deepest))

    def moment(tilt):
        steel = 0.5 * GRAVITY * (z + 2.0 * b * (math.sin(0.5 * tilt) - math.sin(0.5 * theta)) / yield_m)
        return GRAVITY * FIG5.size * math.sin(FIG5.alpha - tilt) + (steel + pull(tilt)) * b * math.cos(0.5 * tilt)

    devices = Damper("hysteretic", f=0.5, yield_m=yield_m, at=0.0), Stop(gap, 0.5, e, at=0.0)
    expected = brentq(moment, 0.0, theta, xtol=1e-15)
    assert (pull(expected) > 0.0) == closed
    assert pull(theta) > 0.0
    for side in (1.0, -1.0):
        rests = rests_on_rigid_base(
            FIG5, base(*devices), SimpleNamespace(theta_end=side * theta), [z, deepest], [False] * 2
        )
        assert rests == pytest.approx(side * expected, rel=1e-10)


@pytest.mark.parametrize("damper", [Damper("friction", f=2.0), Damper("hysteretic", f=2.0, yield_m=0.005)])
@pytest.mark.parametrize("foundation", [RigidBase(), ElasticBase(50.0, epsilon=0.3)], ids=["rigid", "elastic"])
def test_a_pier_that_is_held_beyond_alpha_has_not_survived(foundation, damper):
    """Nor has it overturned: what holds it is all that keeps it from it."""
    motion = pulse("sine", 1.0, 6.0, dt=0.005, end=2.0)
    outcome = run_fixed(FIG5, replace(foundation, restraints=(damper,)), motion, 8)
    assert FIG5.alpha < outcome.theta_max < math.pi / 2
    assert outcome.status == "failed"
    assert outcome.failure == LEFT_ALONE[0]


YIELDS = base(
    Damper("hysteretic", f=0.05, yield_m=0.01), Damper("friction", f=0.03, at="left"), Damper("viscous", nu=0.2),
    Tendon(psi=0.2, lam=1.5, strength=0.3), Tendon(psi=0.05, lam=2.0, at=0.5),
)  # fmt: skip


@pytest.mark.parametrize(
    "foundation",
    [
        base(Damper("friction", f=0.1)),
        base(Tendon(psi=0.2, lam=1.5, strength=0.3)),
        base(Damper("hysteretic", f=0.1, yield_m=0.01)),
        YIELDS,
    ],
    ids=["turning", "yield and slack", "hysteretic", "all"],
)
def test_order_four_across_turning_yield_and_slack(foundation):
    motion = pulse("sine", 0.5, 1.0, dt=0.02, end=3.0)
    steps = np.array([4, 8, 16])
    peaks = [run_fixed(FIG5, foundation, motion, int(k), 0.0, wait=False).theta_max for k in (*steps, 256)]
    errors = np.abs(np.array(peaks[:-1]) - peaks[-1])
    order = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order > 3.6


def test_a_damper_that_yields_within_a_step_is_resolved_from_the_coarsest_on():
    """0.2 mm, which a corner passes forty times over in a step of 20 ms: order 4 from one step a sample, and errors that tell."""
    foundation = base(Damper("hysteretic", f=0.1, yield_m=2e-4))
    motion = pulse("sine", 0.5, 1.0, dt=0.02, end=3.0)
    peaks = [run_fixed(FIG5, foundation, motion, k, 0.0, wait=False).theta_max for k in (1, 2, 4, 8, 256)]
    errors = np.abs(np.array(peaks[:-1]) - peaks[-1]) / FIG5.alpha
    assert errors[0] < 1e-6
    assert errors[3] < errors[0] / 200.0
    settled = run_to_tolerance(FIG5, foundation, motion, 1e-4, 0.0)
    assert abs(settled.theta_max - peaks[-1]) <= settled.theta_max_error


def test_a_damper_whose_force_is_a_root_of_the_speed_is_resolved_where_it_turns():
    """√|ė| has no Taylor series at a turning: steps from one and to one grow and shrink with the speed."""
    foundation = base(Damper("viscous", nu=0.3, exponent=0.5))
    motion = pulse("sine", 0.5, 1.0, dt=0.02, end=3.0)
    peaks = [run_fixed(FIG5, foundation, motion, k, 0.0, wait=False).theta_max for k in (1, 2, 4, 512)]
    errors = np.abs(np.array(peaks[:-1]) - peaks[-1]) / FIG5.alpha
    assert errors[0] < 1e-7
    assert errors[2] < errors[0] / 8.0


@pytest.mark.parametrize(
    "foundation", [base(Damper("friction", f=0.1)), base(Tendon(psi=0.2, lam=1.5, strength=0.3)), YIELDS]
)
def test_the_ledger_closes_with_what_dampers_and_tendons_take(foundation):
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=4.0)
    response = rb.simulate(FIG5, foundation, motion, substeps=16, quiet_s=0.0, ledger=True, wait=False)
    ledger = response.ledger
    assert ledger["remainder"].abs().max() < 1e-8 * ledger["input"].abs().max()
    taken = ledger["damping"] + ledger["plastic"]
    assert taken.iloc[-1] > 0.1 * ledger["input"].iloc[-1]
    work = 0.0  # of the loops that are shown
    for name in [name for name in response.restraints if name.endswith("force")]:
        force, way = response.restraints[name], response.restraints[name.replace("force", "elongation")]
        work += float(np.sum(0.5 * (force[1:].to_numpy() + force[:-1].to_numpy()) * np.diff(way)))
    stored = ledger["elastic"].iloc[-1]
    assert work == pytest.approx(taken.iloc[-1] + stored, rel=0.02)


def test_a_tendon_that_yielded_is_slack_when_the_pier_lands():
    """Prestress lost: T = P0 + k (u − u_0) is below 0 at u = 0 once u_0 > P0/k; the next lift-off is that without a tendon."""
    tendon = Tendon(psi=0.02, lam=2.0, strength=0.1)
    outcome = run_to_tolerance(FIG5, base(tendon), pulse("sine", 0.5, 1.0, dt=0.01, end=3.0), 1e-6)
    stiffness = 2.0 * FIG5.gravity * FIG5.size / FIG5.half_width**2
    assert outcome.tendon_force == pytest.approx(0.1, rel=1e-12)
    assert outcome.tendon_slack >= 1
    stroke = FIG5.half_width * 2.0 * math.sin(0.5 * outcome.theta_max)
    assert outcome.tendon_yield == pytest.approx(stroke - 0.08 * FIG5.gravity / stiffness, rel=1e-9)


def test_what_dampers_have_been_through():
    """Friction: F_d, a stroke of 4 b sin(θ_max/2) at the pivots, F_d times the ways there and back."""
    motion = pulse("sine", 0.5, 1.0, dt=0.005, end=1.2)
    outcome = run_fixed(FIG5, base(Damper("friction", f=0.1)), motion, 8, 0.0, wait=False)
    assert outcome.damper_force == pytest.approx(0.1, rel=1e-12)
    assert outcome.damper_stroke == pytest.approx(4 * FIG5.half_width * math.sin(0.5 * outcome.theta_max), rel=1e-9)
    assert 0.1 < outcome.damper_speed < 1.0
    viscous = run_fixed(FIG5, base(Damper("viscous", nu=1.0)), motion, 8, 0.0, wait=False)
    assert viscous.damper_force * FIG5.gravity == pytest.approx(FIG5.p * viscous.damper_speed, rel=1e-9)


def test_mirror_images_with_elements_on_one_side():
    """Element on the left and a push to the right are those on the right and a push to the left."""
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=2.0)
    other = Motion("other", motion.dt, -motion.horizontal)
    left = run_fixed(FIG5, base(Damper("friction", f=0.1, at="left")), motion, 4, 0.0, wait=False)
    right = run_fixed(FIG5, base(Damper("friction", f=0.1, at="right")), other, 4, 0.0, wait=False)
    assert left.theta_max == right.theta_max
    assert left.damper_energy == pytest.approx(right.damper_energy, rel=1e-12)


def test_without_force_the_block_is_that_of_the_lanes():
    motion = pulse("sine", 1.5, dt=0.01, end=4.0)
    bare = run_fixed(TOWER, RigidBase(), motion, 8, 0.0, wait=False)
    tied = run_fixed(TOWER, base(Damper("friction", f=0.0)), motion, 8, 0.0, wait=False)
    assert tied.theta_max == pytest.approx(bare.theta_max, abs=1e-10 * TOWER.alpha)
    assert (tied.status, tied.impacts) == (bare.status, bare.impacts)


def test_impossible_devices_are_refused():
    for kind, values in (
        (Damper, {"kind": "friction", "f": -0.1}),
        (Damper, {"kind": "hysteretic", "f": 0.1}),
        (Damper, {"kind": "viscous", "nu": 1.0, "exponent": 5.0}),
        (Damper, {"kind": "rubber"}),
        (Tendon, {"psi": -1.0}),
        (Tendon, {"psi": 0.5, "strength": 0.4}),
        (Tendon, {"at": "middle"}),
    ):
        with pytest.raises(InputError) as caught:
            kind(**values)
        assert len(caught.value.messages) == 1, values
    assert len(problems(FIG5, base(Damper("friction", f=0.1, at=99.0)))) == 1
    frame = Pier.frame(replace(Pier.rectangle(1.0, 5.0), mass_t=100.0), 2, 400.0)
    for each in (Damper("viscous", nu=0.1, at="deck"), DeckSpring(lam=1.0)):
        assert "columns" in problems(frame, base(each))[0].text
    assert problems(frame, base(Tendon(psi=0.1), Damper("viscous", nu=0.1))) == []


@pytest.mark.usefixtures("pages")
def test_what_a_folder_keeps_of_dampers_comes_back(tmp_path):
    """Loops in the file and the report; the energy of a history is that of the ledger."""
    text = """
    [pier]
    alpha = 0.2
    p = 1.0
    [[motions.pulse]]
    name = "sine"
    shape = "sine"
    amplitude_g = 1.0
    period_s = 0.5
    dt_s = 0.01
    duration_s = 2.0
    [numerics]
    substeps = 4
    [output]
    histories = "all"
    ledger = true
    [[case]]
    base = "rigid"
    [[case.damper]]
    kind = "friction"
    f = 0.1
    [case.tendon]
    psi = 0.2
    lambda = 0.5
    """
    (tmp_path / "study.toml").write_text(text)
    table = rb.run(tmp_path / "study.toml", out=tmp_path / "out")
    assert table["damper_force_over_weight"][0] == pytest.approx(0.1, rel=1e-9)
    response = rb.open_results(tmp_path / "out").responses[0]
    expected = rb.simulate(FIG5, response.base, pulse("sine", 0.5, 1.0, dt=0.01, end=2.0), substeps=4)
    assert response.base == base(Damper("friction", f=0.1), Tendon(psi=0.2, lam=0.5))
    assert set(response.restraints) == set(expected.restraints)
    assert np.abs(response.restraints["damper 1 left force"]).max() == pytest.approx(0.1 * GRAVITY)
    energy = response.ledger[["kinetic", "potential", "elastic"]].sum(axis=1)
    np.testing.assert_allclose(response.energy, energy, atol=1e-9)
    report = (tmp_path / "out" / "report.html").read_text()
    assert ", damper 1</span></figcaption>" in report
    assert "F/(M g) left" in report
