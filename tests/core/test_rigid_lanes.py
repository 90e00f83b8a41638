"""The rigid base side by side: company changes nothing, and the pass steps over nothing that happens."""

import math
import platform
import re
from dataclasses import replace

import numba
import numpy as np
import pytest
from core_runs import block_line, run_blocks
from core_samples import broadband, pulse
from scipy.interpolate import CubicHermiteSpline

from rockbatch.core.block.lanes import LANE
from rockbatch.core.block.model import BlockTraits
from rockbatch.core.clock import EVENTFUL
from rockbatch.core.rk4 import rk4
from rockbatch.core.run import Settings
from rockbatch.core.springs import lanes as spring_lanes
from rockbatch.core.springs.laws import kept_sign
from rockbatch.core.springs.model import BOUC_WEN, ELASTIC, Contact, SpringTraits, State
from rockbatch.core.springs.passing import correct_reversals
from rockbatch.core.springs.reversal import pivots
from rockbatch.core.system import at_rest, one_pass, rates
from rockbatch.core.table import LANES, move, table
from rockbatch.core.types import (
    BEFORE_EVENT,
    IMPACT_BOTH,
    IMPACT_LEFT,
    IMPACT_RIGHT,
    LIFT_OFF,
    REST,
    RUNNING,
    SAMPLE,
    Ground,
)
from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, Pier, RigidBase, YieldingBase
from rockbatch.simulation import Run, Stop, block, ground_of, run_all_fixed, run_fixed, springs, written_run
from rockbatch.simulation.runs import try_all

LANDINGS = (IMPACT_LEFT, IMPACT_RIGHT, IMPACT_BOTH, REST)


def crowd():
    """Three times as many runs as lanes, weak and strong, short and long, and some whose ground falls away."""
    rng = np.random.default_rng(11)
    scenes = []
    for i in range(3 * LANES):
        dt, npts = (0.005, 0.01, 0.02)[i % 3], 80 + 37 * (i % 11)
        vertical = broadband(rng, dt, npts, 14.0 if i % 8 == 1 else 3.0) if i % 2 else None
        motion = Motion(f"noise {i}", dt, broadband(rng, dt, npts, rng.uniform(1.0, 9.0)), vertical)
        base = RigidBase((0.5, 0.9, None, 0.0)[i % 4], flight="stop" if i % 16 == 1 else "guided")
        scenes.append(Run(Pier(rng.uniform(0.08, 0.4), rng.uniform(0.4, 3.0)), base, motion))
    return scenes, [(1, 2, 3, 8)[i % 4] for i in range(3 * LANES)]


def test_what_a_run_comes_to_is_the_same_to_the_bit_alone_and_in_any_company():
    scenes, substeps = crowd()
    together = run_all_fixed(scenes, substeps, 1.0, Stop())
    alone = [run_all_fixed([scene], [steps], 1.0, Stop())[0] for scene, steps in zip(scenes, substeps, strict=True)]
    order = np.random.default_rng(1).permutation(len(scenes))
    shuffled = run_all_fixed([scenes[i] for i in order], [substeps[i] for i in order], 1.0, Stop())
    assert {outcome.status for outcome in alone} >= {"ok", "overturned", "flight"}
    assert sum(outcome.impacts for outcome in alone) > 500
    assert [repr(outcome) for outcome in together] == [repr(outcome) for outcome in alone]
    assert [repr(shuffled[list(order).index(i)]) for i in range(len(scenes))] == [repr(outcome) for outcome in alone]


def test_a_run_that_is_written_down_is_the_run_that_is_not():
    scenes, substeps = crowd()
    outcomes = run_all_fixed(scenes, substeps, 1.0, Stop())
    for scene, steps, outcome in zip(scenes, substeps, outcomes, strict=True):
        run, rows = written_run(scene, steps, 1.0, 20_000, every_step=True)
        assert run.rows <= len(rows)
        assert (run.impacts, run.t_end, run.t_max) == (outcome.impacts, outcome.t_end, outcome.t_max)
        assert np.abs(rows.theta[: run.rows]).max() <= run.theta_max * (1.0 + 1e-12)
        kinds = rows.kind[: run.rows]
        upright = np.abs(rows.theta[: run.rows]) < scene.pier.alpha  # what topples and lands on its way is no impact
        assert (np.isin(kinds, LANDINGS) & upright).sum() + (kinds == IMPACT_BOTH).sum() == run.impacts
        events = np.flatnonzero((kinds > 0.0) & (kinds != LIFT_OFF))  # at which nothing jumps
        assert (kinds[events - 1] == BEFORE_EVENT).all()
        assert (np.diff(rows.t[: run.rows]) >= 0.0).all()


def test_the_pass_steps_over_no_impact():
    """Between the rows of a history a block that rocks keeps its side, but where an impact is written between them.

    1e-12 α: what is left of the rotation when an impact has been located.
    """
    scenes, substeps = crowd()
    crossings = 0
    for scene, steps in zip(scenes, substeps, strict=True):
        run, rows = written_run(scene, steps, 1.0, 20_000, every_step=True)
        rows = rows[: run.rows].view(np.recarray)
        side = rows.right - rows.left
        assert (side * rows.theta >= -1e-12 * scene.pier.alpha).all()
        crossings += np.count_nonzero(np.diff(side[side != 0.0]))
    assert crossings > 300


def test_the_pass_does_what_event_by_event_comes_to():
    """A damper without force has every sub-step searched for events: the same counts, and the peak within RK4's error.

    The damper's velocity reversals divide steps, of which the coarsest are p h = 0.05: 1e-6 of the peak.
    """
    scenes, substeps = crowd()
    flights = 0
    for scene, steps in zip(scenes, substeps, strict=True):
        idle = replace(scene.base, restraints=(Damper("viscous", nu=0.0),))
        passed, searched = (
            run_fixed(scene.pier, base, scene.motion, steps, 1.0, wait=False) for base in (scene.base, idle)
        )
        for name in ("status", "impacts", "separations", "flights"):
            assert getattr(passed, name) == getattr(searched, name), scene.motion.name
        assert passed.theta_max == pytest.approx(searched.theta_max, rel=1e-6)
        assert passed.t_end == pytest.approx(searched.t_end, rel=1e-6)
        flights += passed.flights
    assert flights > 3


def test_extremes_of_windows_are_those_of_the_samples():
    scenes, substeps = crowd()
    for scene, steps in zip(scenes, substeps, strict=True):
        quiet_s, npts = 20 * scene.motion.dt, scene.motion.npts
        (trial,) = try_all([scene], [steps], quiet_s, Stop(), wait=False)
        run, rows = written_run(scene, steps, quiet_s, 20_000, wait=False)
        rows = rows[: run.rows]
        samples = np.abs(rows.theta[rows.kind == SAMPLE])[1:]
        windows = (np.arange(1, len(samples) + 1) * 32 // (npts + 19)).clip(max=31)
        for window in range(32):
            inside = samples[windows == window]
            greatest = trial.extremes[window]
            assert np.isnan(greatest) if not len(inside) else greatest == inside.max()


def test_a_block_that_lies_down_or_rests_makes_room_for_the_next():
    """More runs than lanes, each with its own end: at rest all the time, or overturned by what tips it at the start."""
    motion = pulse("sine", 0.1, 0.1, dt=0.01, end=1.0)
    m = block(Pier(0.2, 2.0), RigidBase(0.9))
    lines = [block_line(m, 1.3 if i % 3 == 0 else 0.0, 0.0, 0.01, 2, motion.npts, i) for i in range(5 * LANES)]
    for i, result in enumerate(run_blocks(lines, ground_of(motion), 2)):
        if i % 3 == 0:
            assert result.theta_max >= 0.5 * np.pi
        else:
            assert (result.theta_max, result.t_rest) == (0.0, 0.0)
            assert result.t_end == pytest.approx((motion.npts - 1 + i) * 0.01)


def test_runs_that_were_stopped_say_that_they_are_not_over():
    stop = Stop()
    stop.set()
    motion = pulse("sine", 0.5, 1.0, dt=0.01, end=3.0)
    line = block_line(block(Pier(0.2, 2.0), RigidBase(0.9)), 0.1, 0.0, 0.01, 4, motion.npts)
    results = run_blocks([line] * 40, ground_of(motion), 4, stop=1)
    assert (results.status == RUNNING).all()
    assert run_all_fixed([Run(Pier(0.2, 2.0), RigidBase(), motion)], [4], 1.0, stop) == [None]


KINDS = {"block": (BlockTraits(), LANE), "springs": (SpringTraits(None, None, None), spring_lanes.LANE)}


@pytest.mark.parametrize("lane", [lane for _, lane in KINDS.values()], ids=list(KINDS))
def test_a_run_moves_to_another_lane_with_all_its_numbers(lane):
    lanes, cells = table(lane)
    cells[:] = np.arange(cells.size).reshape(cells.shape)
    before = cells.copy()
    move(cells, LANES - 1, 2)
    numbers = [lanes[0][part][name] for part in lane.names for name in lane[part].names]
    assert all(number[2] == number[LANES - 1] for number in numbers)
    assert len(numbers) == len(cells)
    assert (np.delete(cells, 2, axis=1) == np.delete(before, 2, axis=1)).all()


SETTINGS = Settings(1, True, False)


@numba.njit(error_model="numpy", _nrt=False)
def passes(traits, lanes, count):
    one_pass(traits, lanes, count, 0, SETTINGS)


def lane_of(part, i, kind):
    return kind(*(float(part[name][i]) for name in kind._fields))


FIG5_ON_SPRINGS = springs(Pier(0.2, 1.0), YieldingBase(50.0, eta=2.2))


def random_lanes(rng, law):
    """Return a table of piers on springs of ``law`` that hardly touch their supports, or hang right above them, and shake."""
    lanes, m = table(spring_lanes.LANE)[0], FIG5_ON_SPRINGS._replace(law=law)
    lane, soft = lanes[0], m.yield_deflection
    for name, _ in spring_lanes.NUMBERS:
        lane.model[name][:] = 5.0 if name == "exponent" else getattr(m, name)
    h = rng.uniform(0.1, 0.4, LANES) * math.sqrt(soft / m.yield_force)
    lane.clock.step[:], lane.clock.rest[:] = h, at_rest(m)
    lane.peak.theta[:], lane.lowest.left[:], lane.lowest.right[:] = 1.0, -1.0, -1.0  # no extremes
    left_on, right_on = rng.integers(0, 2, LANES), rng.integers(0, 2, LANES)
    lane.contact.left[:], lane.contact.right[:] = left_on, right_on
    speeds = rng.normal(0.0, 0.05 * soft, (2, LANES)) / h
    lane.now.v_rate[:], lane.now.omega[:] = speeds.mean(axis=0), (speeds[0] - speeds[1]) / (2.0 * m.half_width)
    for side, on, speed in (("left", left_on, speeds[0]), ("right", right_on, speeds[1])):
        lane.contact[f"{side}_yields"][:] = on * (speed < 0.0) * (law == BOUC_WEN)
        lane.now[f"z_{side}"][:] = -on * rng.uniform(0.0, 0.02, LANES)
        lane.supports[side][:] = -rng.uniform(0.0, 0.02 * soft, LANES)
        lane.supports[f"yield_{side}"][:] = -1.0
    lane.ground.horizontal[:], lane.ground.vertical[:] = rng.normal(0.0, 20.0, (2, LANES))
    return lanes, m


@pytest.mark.parametrize("law", [ELASTIC, BOUC_WEN], ids=["elastic", "bouc-wen"])
def test_where_the_pass_on_springs_sees_nothing_no_pivot_separates_lands_or_turns_back(law):
    """Of cubics through both ends of the sub-step at 200 places, and of velocities in 16 parts of it."""
    rng, share, calm, humps = np.random.default_rng(5), np.linspace(0.0, 1.0, 201), 0, 0
    for _ in range(100):
        lanes, m = random_lanes(rng, law)
        before = lanes.copy()[0]
        passes(SpringTraits(None, None, None), lanes[0], LANES)
        for i in np.flatnonzero((lanes[0].step_status.kind < EVENTFUL) & (lanes[0].step_status.turns >= 0.0)):
            y, contact = lane_of(before.now, i, State), lane_of(before.contact, i, Contact)
            a, c, h = before.ground.horizontal[i], before.ground.vertical[i], before.clock.step[i]
            path = [y]
            for _ in range(16):
                path.append(
                    rk4(m, None, path[-1], rates(m, path[-1], contact, a, c), contact, Ground(a, 0.0, c, 0.0), h / 16)
                )
            end = lane_of(lanes[0].end, i, State)
            k, k_end = rates(m, y, contact, a, c), rates(m, end, contact, a, c)
            signs = (
                kept_sign(m.law, contact.left, contact.left_yields),
                kept_sign(m.law, contact.right, contact.right_yields),
            )
            for j, (side, sign) in enumerate(zip(("left", "right"), signs, strict=True)):
                start, stop = pivots(m, y)[j], pivots(m, end)[j]
                if getattr(contact, side) != 0.0:
                    ends = [-getattr(each, f"z_{side}") for each in (y, k, end, k_end)]
                else:
                    support = before.supports[side][i]
                    ends = [start.position - support, start.velocity, stop.position - support, stop.velocity]
                between = CubicHermiteSpline([0.0, h], ends[::2], ends[1::2])(share * h)
                assert between.min() > 0.0
                assert all(
                    sign * pivots(m, each)[j].velocity > -1e-4 * abs(start.velocity) - at_rest(m) for each in path
                )
                calm, humps = calm + 1, humps + (between.min() < 0.999 * min(ends[0], ends[2]))
    assert calm > 400
    assert humps > 20


@numba.njit(error_model="numpy", _nrt=False)
def corrections(traits, lanes, i):
    correct_reversals(traits, lanes, i)


def machine_code(function, *arguments):
    function(*arguments)
    code = function.inspect_asm(tuple(map(numba.typeof, arguments)))
    return code[: code.index("_ZN7cpython")]


def single_products(code):
    return len(re.findall(r"\bv?mulsd\b", code))


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="looks for the instructions of x86-64")
@pytest.mark.parametrize("kind", KINDS)
def test_the_pass_is_vector_instructions(kind):
    """As many products of several numbers at once as of one, which the lanes that are left over take; and no calls.

    Springs that have reversed are corrected one by one. 0.95 of springs: in their loops a few products of one number are of
    all lanes. No store is under a mask of a vector register, which takes some processors as long as ten others.
    """
    traits, lane = KINDS[kind]
    lanes = table(lane)[0][0]
    body = machine_code(passes, traits, lanes, LANES)
    alone = single_products(machine_code(corrections, traits, lanes, 0)) if kind == "springs" else 0
    packed, single = len(re.findall(r"\bv?mulpd\b", body)), single_products(body) - alone
    assert packed >= {"block": 1.0, "springs": 0.95}[kind] * single > 60
    assert not re.findall(r"\bcall\w*\b.*\b(sin|cos)\b", body)
    assert not re.findall(r"\bvp?maskmov\w+\s+%\w+, %\w+, [^%]*\(", body)
