"""The bed of strips under a footing: closed forms, its convexity, and an independent solver."""

import math

import numpy as np
import pytest
from footing_reference import GRAVITY, Foot, bed, solve
from footing_runs import closed_form, model_of, run

from rockbatch.core.footing.model import FIRST, SET, State
from rockbatch.core.footing.statics import lean, level_at
from rockbatch.core.footing.strips import last_node, lay, push, settle, sinking, stored, sum_sets
from rockbatch.core.kernel import entry

DT = 0.01


@entry
def moments(m, rotations, out):
    """Moments about the middle at rotations of an unyielded bed under the weight."""
    lay(m)
    for i in range(len(rotations)):
        v = level_at(m, rotations[i], m.gravity)
        out[i] = push(m, sinking(m, State(v, rotations[i], 0.0, 0.0))).moment


def yield_to(m, sets):
    """Lay a bed that has yielded to ``sets`` [m]."""
    lay(m)
    m.bed[FIRST : FIRST + len(sets), SET] = sets
    sum_sets(m, FIRST)


def nodes_of(m):
    """All nodes of a bed."""
    return range(FIRST, last_node(m) + 1)


def pulse(seconds=1.2, period=0.6, strength=4.0):
    """One cycle of a sine [m/s²]."""
    t = np.arange(0.0, seconds, DT)
    return np.where(t < period, strength * np.sin(2.0 * np.pi * t / period), 0.0)


def largest_error(strips, safety):
    """Greatest error of the moment over W B/2 at rotations from 0.3 to 100 times that of uplift."""
    foot = Foot(strips=strips, safety=safety)
    rotations = 2.0 * foot.settlement / foot.width * np.geomspace(0.3, 100.0, 40)
    found = np.zeros(40)
    moments(model_of(foot), rotations, found)
    exact = [closed_form(t, foot.width, foot.stiffness, safety * GRAVITY, GRAVITY) for t in rotations]
    return np.abs(found - exact).max() / (0.5 * GRAVITY * foot.width)


@pytest.mark.parametrize("safety", [1.5, 2.0, 3.0, 5.0, math.inf])
def test_moment_of_4000_strips_is_that_of_the_closed_forms(safety):
    assert largest_error(4000, safety) < 5e-8


@pytest.mark.parametrize("safety", [1.5, 3.0])
def test_moment_converges_with_the_square_of_the_number_of_strips(safety):
    coarse, fine = largest_error(20, safety), largest_error(40, safety)
    assert 3.5 < coarse / fine < 4.5
    assert fine < 3e-4


def test_moment_of_an_elastic_bed_is_exact_with_any_number_of_strips():
    assert largest_error(5, math.inf) < 1e-14


def test_work_of_the_push_along_a_cycle_is_what_the_bed_stores_and_loses():
    """Without dashpots an elastic bed gives all back, and one that yields never gives back more."""
    for safety, lost in ((math.inf, 0.0), (3.0, 1.0)):
        m = model_of(Foot(strips=8, zeta=0.0, safety=safety))
        lay(m)
        turn = 0.02 * np.sin(np.linspace(0.0, 2.0 * math.pi, 4001))
        work, before = 0.0, State(-0.005, 0.0, 0.0, 0.0)
        start = stored(m, sinking(m, before))
        for theta in turn[1:]:
            now = State(-0.005, theta, 0.0, 0.0)
            middle = push(m, sinking(m, State(-0.005, 0.5 * (before.theta + theta), 0.0, 0.0)))
            work += middle.moment * (theta - before.theta)
            settle(m, sinking(m, before), sinking(m, now), 1.0)
            before = now
        left = work - (stored(m, sinking(m, before)) - start)
        assert left == pytest.approx(0.0, abs=1e-7) if lost == 0.0 else left > 0.01


def deepest(x, d, d_end, h):
    """Greatest depth at ``x`` in a step between two Sinkings: of the cubic through its ends."""
    start, end = d.level + d.slope * x, d_end.level + d_end.slope * x
    rate, rate_end = h * (d.level_rate + d.slope_rate * x), h * (d_end.level_rate + d_end.slope_rate * x)
    cubic = np.polynomial.Polynomial(
        [start, rate, 3.0 * (end - start) - 2.0 * rate - rate_end, 2.0 * (start - end) + rate + rate_end]
    )
    turns = [t.real for t in cubic.deriv().roots() if abs(t.imag) < 1e-9 and 0.0 < t.real < 1.0]
    return max(start, end, *(cubic(t) for t in turns))


def test_set_is_the_greatest_depth_of_any_motion_and_stays_convex():
    """Also of steps that press both edges, one after the other: on it relies that what is pressed is one interval."""
    foot = Foot(strips=40)
    m = model_of(foot)
    random, sets, most = np.random.default_rng(3), np.zeros(41), foot.safety * foot.settlement
    before, by_step = State(-0.005, 0.0, 0.0, 0.0), []
    for number in range(200):
        if number % 10 == 0:
            lay(m)
            sets = np.zeros(41)
        now = State(
            -0.004 + 0.006 * random.standard_normal(),
            0.01 * random.standard_normal(),
            *(random.choice([0.02, 2.0]) * random.standard_normal(2)),
        )
        d, d_end = sinking(m, before), sinking(m, now)
        grown = np.maximum(sets, [deepest(x, d, d_end, 0.01) - most for x in foot.nodes])
        assert settle(m, d, d_end, 0.01) == (grown > sets).any()
        assert m.bed[nodes_of(m), SET] == pytest.approx(grown, rel=1e-12, abs=1e-15)
        by_step.append(grown > sets)
        before, sets = now, grown
        assert np.diff(m.bed[nodes_of(m), SET], 2).min() > -1e-15
        d = sinking(m, State(-0.02 * random.random(), *(0.005 * random.standard_normal(3))))
        e, rate = d.level + d.slope * foot.nodes - m.bed[nodes_of(m), SET], d.level_rate + d.slope_rate * foot.nodes
        assert np.abs(np.diff((e > 0.0).astype(int))).sum() <= 2
        assert push(m, d)[:2] == pytest.approx(bed(foot, e, rate), rel=1e-12, abs=1e-13)
    assert any(step[0] and step[-1] and not step.all() for step in by_step)
    assert any(step.any() and not step[0] and not step[-1] for step in by_step)


def test_push_of_a_yielded_bed_is_the_sum_over_its_strips():
    """Pressed from an edge, in the middle alone, everywhere or nowhere, with dashpots, against a loop over the strips."""
    foot = Foot(strips=49)  # 49 times a 49th is not 1
    m = model_of(foot)
    sets = foot.settlement * (0.2 + foot.nodes**2)
    yield_to(m, sets)
    random, seen = np.random.default_rng(4), set()
    for _ in range(300):
        d = sinking(m, State(*(random.standard_normal(4) * (0.03, 0.005, 0.05, 0.05))))
        e, rate = d.level + d.slope * foot.nodes - sets, d.level_rate + d.slope_rate * foot.nodes
        seen.add((bool(e[0] > 0.0), bool(e[-1] > 0.0), bool(e.max() > 0.0)))
        found = push(m, d)
        assert found[:2] == pytest.approx(bed(foot, e, rate), rel=1e-13, abs=1e-13)
        assert (found.touched == 0.0) == (e.max() <= 0.0)
        assert (found.touched == 1.0) == (e.min() > 0.0)
    assert len(seen) == 5


def test_pier_at_rest_on_a_yielded_bed_leans_further_than_the_bed():
    """K_θ tilt = (K_θ − g h) lean of a bed whose set is a plane, in full contact."""
    foot = Foot(strips=40, width=9.0)
    m = model_of(foot)
    yield_to(m, 0.002 + 1e-4 * foot.nodes)
    rocking = foot.stiffness * foot.width**2 / 12.0
    assert lean(m, GRAVITY) == pytest.approx(1e-4 * rocking / (rocking - GRAVITY * foot.height), rel=1e-9)


@pytest.mark.sweep(slow=4)
@pytest.mark.parametrize("finite", [False, True])
@pytest.mark.parametrize(("safety", "zeta"), [(3.0, 0.05), (1.5, 0.05), (math.inf, 0.0), (2.0, 0.2)])
def test_runs_come_to_what_an_independent_solver_does(finite, safety, zeta):
    foot = Foot(strips=8, safety=safety, zeta=zeta, finite=finite)
    reference = solve(foot, pulse(), 0.0 * pulse(), DT)
    result = run(model_of(foot), pulse(), DT, 32)[0]
    assert result.theta_max == pytest.approx(reference.theta_max, rel=1e-6)
    assert result.theta_end == pytest.approx(reference.y[1], abs=1e-6 * reference.theta_max)
    assert result.base_left == pytest.approx(reference.plastic[0], rel=1e-6, abs=1e-6 * foot.settlement)
    assert result.base_right == pytest.approx(reference.plastic[-1], rel=1e-6, abs=1e-6 * foot.settlement)


@pytest.mark.slow
def test_reversed_motion_gives_the_mirror_image():
    first, second = (run(model_of(Foot()), sign * pulse(), DT, 4)[0] for sign in (1.0, -1.0))
    assert first.theta_max == pytest.approx(second.theta_max, rel=1e-12)
    assert (first.base_left, first.base_right) == pytest.approx((second.base_right, second.base_left), rel=1e-10)
    assert first.lean == pytest.approx(-second.lean, rel=1e-6)


@pytest.mark.slow
def test_results_do_not_depend_on_the_runs_beside_it():
    alone = run(model_of(Foot()), pulse(), DT, 4, quiet_s=1.0, patience_s=20.0)
    for count in (3, 16, 19):
        beside = run(model_of(Foot()), pulse(), DT, 4, quiet_s=1.0, patience_s=20.0, copies=count)
        for name in ("theta_max", "base_left", "lean", "t_end", "contact_least"):
            assert (beside[name] == alone[name][0]).all()
