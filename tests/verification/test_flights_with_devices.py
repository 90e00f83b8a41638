"""Flights and impacts of piers with devices, counted by a solver of the tests (benchmarks/flights.py has the whole pool)."""

import importlib
import math
from pathlib import Path

import numpy as np
import pytest
from core_samples import rate_of_normal, values_of

import rockbatch as rb
from rockbatch.core.block.model import Rocking, Stance
from rockbatch.core.types import Ground, Instant, Moment, Pull
from rockbatch.simulation import written_run
from rockbatch.simulation.elements import elements
from rockbatch.simulation.models import block
from rockbatch.simulation.runs import Run

BENCHMARKS = Path(__file__).parents[2] / "benchmarks"
G = 9.81


@pytest.fixture(scope="module")
def pool():
    """The benchmark, imported as a script beside it would be."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(BENCHMARKS))
        yield importlib.import_module("flights")


FAST = (11, 12, 39)
"""Cases of the pool."""


@pytest.mark.sweep(fast=1, slow=8)
@pytest.mark.parametrize(
    "number", [*FAST, *(pytest.param(number, marks=pytest.mark.slow) for number in range(30) if number not in FAST)]
)
def test_flights_and_impacts_on_rigid_ground_are_those_of_the_reference(pool, number):
    row = pool.judge(number, on_springs=False)
    assert row.same_peak
    assert row.wrong == []


@pytest.mark.thorough
def test_flights_impacts_and_separations_on_springs_are_those_of_the_reference(pool):
    rows = [row for row in pool.survey(0, 20, on_springs=True) if row.same_peak]
    assert len(rows) >= 15
    assert {row.number: row.wrong for row in rows if row.wrong} == {}


def test_a_block_that_the_ground_would_have_to_hold_behind_an_impact_flies_on(uncompiled):
    """N/M = 0 about the pivot decides, by the devices' pull, which is tried a hundredth to either side of what lifts it."""
    m = block(rb.Pier(alpha=0.2, p=1.0), rb.RigidBase())
    y, side, ground = Rocking(0.0, 0.0, 0.3 * m.half_width, 0.3), 1.0, Ground(0.2, 0.0, -0.3, 0.0)
    turned = m.inertia + m.half_width**2 + m.height**2
    # N = g + v̈_g + F + b θ̈ − h θ̇² with (I0 + R²) θ̈ = −((g + v̈_g + F) b + h ü_g) about a pivot at θ = 0
    share = 1.0 - m.half_width**2 / turned
    lifting = (m.height * 0.09 + m.half_width * m.height * 0.2 / turned) / share - (G - 0.3)
    now = Moment(y, Stance(0.0, 1.0, 1.0, 1.0), None)
    calls = [("system", "released", m._replace(pull=Pull(lifting + more, 0.0)), now, ground) for more in (-0.01, 0.01)]
    found = uncompiled(values_of, calls)
    assert [each.contact for each in found] == [Stance(0.0, 0.0, side, side), now.contact]
    assert found[0].y == now.y


def test_the_normal_force_falls_with_the_forces_of_its_devices(uncompiled):
    """By hand at θ = 0 about the right pivot, with a viscous and a hysteretic damper at mid-base, whose ė = b θ̇ and θ̈ b there."""
    pier, friction, yields = rb.Pier(alpha=0.2, p=1.0), 0.1, 0.004
    dampers = rb.Damper("viscous", nu=0.3, at=0.0), rb.Damper("hysteretic", f=friction, yield_m=yields, at=0.0)
    laws, m = elements(pier, rb.RigidBase(restraints=dampers)), block(pier, rb.RigidBase())
    b, h, omega = m.half_width, m.height, 0.4
    ground = Ground(0.7, -2.0, -0.5, 3.0)
    turned, force, down = m.inertia + b**2 + h**2, 0.3 * pier.p * b * omega, G + ground.vertical
    turning = -((down + force) * b + h * ground.horizontal) / turned
    faster = 0.3 * pier.p * b * turning + friction * G / yields * b * omega
    jerk = (-(ground.vertical_slope + faster) * b + (down + force) * h * omega) / turned
    jerk -= (h * ground.horizontal_slope + b * omega * ground.horizontal) / turned
    rate = ground.vertical_slope + faster + b * jerk - 3.0 * h * omega * turning - b * omega**3
    now = Instant(Rocking(0.0, 0.0, b * omega, omega), None, Stance(0.0, 1.0, 1.0, 1.0), None, ground)
    found = uncompiled(rate_of_normal, m, now, laws)
    assert found[0] == pytest.approx(down + force + b * turning - h * omega**2, rel=1e-12)
    assert found[1] == pytest.approx(rate, rel=1e-4)


def test_a_pivot_that_rises_from_the_ground_has_not_landed_for_rounding(uncompiled):
    """Just behind a take-off its height is less than the rounding of what it is computed from."""
    m = block(rb.Pier(alpha=0.2, p=1.0), rb.RigidBase())
    speed = 20.0 * m.rest
    calls = [("block.events", "_height", m, -1e-16, speed, 1e-4), ("block.events", "_height", m, -1e-16, -speed, 1e-4)]
    rises, falls = uncompiled(values_of, calls)
    assert rises[0] > 0.0
    assert rises[1] == speed
    assert falls == (-1e-16, -speed)


def test_flights_of_a_history_begin_where_nothing_presses_and_last(pool):
    """Of take-offs that a damper resists: at each the normal force is zero to rounding, and none is over within 10⁻⁶ s."""
    pier, base, motion = pool.case(39, on_springs=False)
    steps = pool.REFINED * pool.first_substeps(pier, base, motion.dt)
    found, rows = written_run(Run(pier, base, motion), steps, 0.0, 60_000, wait=False)
    rows = rows[: found.rows].view(np.recarray)
    up = rows.left + rows.right == 0.0
    began, ended = np.flatnonzero(~up[:-1] & up[1:]) + 1, np.flatnonzero(up[:-1] & ~up[1:]) + 1
    assert len(began) == found.flights > 0
    lengths = [rows.t[end] - rows.t[start] for start, end in zip(began, ended, strict=False)]
    assert min(lengths) > 1e-6
    assert math.isclose(sum(lengths), found.flight_duration, rel_tol=1e-9)
