"""The pass over lanes: vector instructions, all numbers of a lane in one place, and nothing that it steps over on springs."""

import math
import platform
import re

import numba
import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from rockbatch.core.block.lanes import LANE
from rockbatch.core.block.model import BlockTraits
from rockbatch.core.clock import EVENTFUL
from rockbatch.core.devices.lanes import equipment_of
from rockbatch.core.rk4 import rk4
from rockbatch.core.run import Settings
from rockbatch.core.springs import lanes as spring_lanes
from rockbatch.core.springs.backbone import backbone_of, branch_at, corner_beyond
from rockbatch.core.springs.laws import CODES, kept_sign, may_yield
from rockbatch.core.springs.model import Contact, SpringTraits, State, Supports
from rockbatch.core.springs.passing import correct_lane
from rockbatch.core.springs.recovery import lag, top
from rockbatch.core.springs.reversal import pivots
from rockbatch.core.system import one_pass, rates
from rockbatch.core.table import LANES, move, table
from rockbatch.core.types import Ground, Instant
from rockbatch.pier import Pier, RigidBase, YieldingBase
from rockbatch.simulation import block, springs
from rockbatch.simulation.elements import IDLE
from rockbatch.simulation.models import system_of

KINDS = {"block": (BlockTraits(), LANE), "springs": (SpringTraits(None, None, None), spring_lanes.LANE)}


def test_all_numbers_of_lanes_begin_where_a_line_of_the_cache_does():
    """At a multiple of 64 bytes; those of devices, too, as many as there are."""
    system = system_of(block(Pier(alpha=0.2, p=1.0), RigidBase()))
    for size in range(1, 9):
        devices = equipment_of(system, [([IDLE] * size, (), math.nan)])
        arrays = [table(LANE)[0], devices.lanes, devices.shared, devices.grips]
        assert [array.ctypes.data % 64 for array in arrays] == [0, 0, 0, 0]
        assert all(offset % 64 == 0 for array in arrays for offset in offsets_of(array.dtype))


def offsets_of(kind):
    """Yield the offset of each number of a lane in a record, those of its parts included."""
    for part, offset in kind.fields.values():
        yield from (offset + inside for inside in (offsets_of(part) if part.names else [0]))


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


SLOW_PIERS = {
    "finite": {"finite": True},
    "damped": {"damped": True, "damping": 3.0, "epsilon": 1.0},
    "finite-damped": {"finite": True, "damped": True, "damping": 0.5, "epsilon": 1.0},
    "backbone": {"law": CODES["backbone"], "backbone": backbone_of((1.0, 1.02, 1.05), (0.3, 0.6, 1.0))},
}
PIERS = {name: {"law": law} for name, law in CODES.items() if name != "backbone"}


def random_lanes(rng, m):
    """Return a table of piers that hardly touch their supports or hang right above them, near their yield points, and shake."""
    lanes = table(spring_lanes.system_of(m).lane)[0]
    lane, soft = lanes[0], m.yield_deflection
    for name, _ in spring_lanes.NUMBERS:
        lane.model[name][:] = 5.0 if name == "exponent" else getattr(m, name)
    h = rng.uniform(0.1, 0.4, LANES) * math.sqrt(soft / m.yield_force)
    lane.clock.step[:] = h
    lane.peak.theta[:], lane.lowest.left[:], lane.lowest.right[:] = 1.0, -1.0, -1.0  # no extremes
    speeds = rng.normal(0.0, 0.05 * soft, (2, LANES)) / h
    lane.now.v_rate[:], lane.now.omega[:] = speeds.mean(axis=0), (speeds[0] - speeds[1]) / (2.0 * m.half_width)
    for side, speed in zip(("left", "right"), speeds, strict=True):
        on = rng.integers(0, 2, LANES)
        lane.contact[side][:], lane.contact[f"{side}_yields"][:] = on, on * (speed < 0.0) * (m.law == CODES["bouc-wen"])
        z = -rng.uniform(0.0, 0.02, LANES)
        lane.now[f"z_{side}"][:] = z if m.damped else on * z
        lane.supports[side][:] = -rng.uniform(0.0, 0.02 * soft, LANES)
        lane.supports[f"yield_{side}"][:] = z - rng.uniform(0.0, 0.02, LANES) if m.law == CODES["hardening"] else -1.0
    if m.backbone is not None:
        between_corners(rng, m, lane, speeds)
    lane.ground.horizontal[:], lane.ground.vertical[:] = rng.normal(0.0, 20.0, (2, LANES))
    return lanes


def between_corners(rng, m, lane, speeds):
    """Press the springs of a ``lane`` until they are near the corners of their backbones, each on its branch there."""
    for name in m.backbone._fields:
        lane.backbone[name][:] = getattr(m.backbone, name)
    for side, speed in zip(("left", "right"), speeds, strict=True):
        z, on = -rng.uniform(0.98, 1.06, LANES), lane.contact[side]
        branch = [branch_at(m.backbone, -each) for each in z]
        lane.now[f"z_{side}"][:], lane.contact[f"{side}_yields"][:] = on * z, on * (speed < 0.0) * branch
        lane.supports[f"yield_{side}"][:] = np.minimum(z - rng.uniform(0.0, 0.02, LANES), -1.0)


def margins(m, side, j, y, contact, supports, k):
    """Return what stays above zero while nothing happens at the pivot ``j`` on ``side``, and its rates: a row each."""
    pivot, z, z_rate = pivots(m, y)[j], getattr(y, f"z_{side}"), getattr(k, f"z_{side}")
    on_spring = getattr(contact, side) != 0.0
    if on_spring and may_yield(m.law, getattr(contact, f"{side}_yields")):
        return [(-z, -z_rate), (z - getattr(supports, f"yield_{side}"), z_rate)]
    if on_spring and getattr(contact, f"{side}_yields") != 0.0 and m.backbone is not None:
        corner = corner_beyond(m.backbone, getattr(contact, f"{side}_yields"))
        return [(z + corner, z_rate)] if corner < math.inf else []
    if m.damped:  # no cubics: the path below
        return []
    return [(-z, -z_rate) if on_spring else (pivot.position - getattr(supports, side), pivot.velocity)]


def hold_pivot(m, side, contact, supports, path, rates_at_ends, h):
    """Assert that nothing happens at the pivot on ``side`` between the ends of ``path``; return how many cubics dip between."""
    j, on_spring, dips = ("left", "right").index(side), getattr(contact, side) != 0.0, 0
    starts, ends = (margins(m, side, j, path[n], contact, supports, rates_at_ends[n]) for n in (0, -1))
    for (f, d), (f_end, d_end) in zip(starts, ends, strict=True):
        between = CubicHermiteSpline([0.0, h], [f, f_end], [d, d_end])(np.linspace(0.0, h, 201))
        assert between.min() > 0.0
        dips += between.min() < 0.999 * min(f, f_end)
    velocities = [pivots(m, each)[j].velocity for each in path]
    rounding = 1e-4 * abs(velocities[0]) + m.rest
    sign = kept_sign(m.law, getattr(contact, side), getattr(contact, f"{side}_yields"))
    assert all(sign * velocity > -rounding for velocity in velocities)
    if m.damped:
        z, support = [getattr(each, f"z_{side}") for each in path], getattr(supports, side)
        if on_spring:
            assert max(x + lag(m) * w for x, w in zip(z, velocities, strict=True)) < lag(m) * rounding
        else:
            assert all(pivots(m, each)[j].position > top(m, support, x) for each, x in zip(path, z, strict=True))
    return dips


@pytest.mark.parametrize(
    "changes",
    [
        *PIERS.values(),
        *(
            pytest.param(pier, marks=pytest.mark.slow if name in ("finite", "backbone") else pytest.mark.thorough)
            for name, pier in SLOW_PIERS.items()
        ),
    ],
    ids=[*PIERS, *SLOW_PIERS],
)
def test_the_pass_on_springs_misses_no_event_of_a_pivot(changes):
    """Of cubics through both ends of the sub-step at 200 places; of velocities, and of dashpots, in 16 parts of it."""
    rng, calm, dips = np.random.default_rng(5), 0, 0
    m = springs(Pier(0.2, 1.0), YieldingBase(50.0, eta=2.2))._replace(**changes)
    for _ in range(100):
        lanes = random_lanes(rng, m)
        before = lanes.copy()[0]
        passes(spring_lanes.system_of(m).traits, lanes[0], LANES)
        for i in np.flatnonzero((lanes[0].step_status.kind < EVENTFUL) & (lanes[0].reversals.keeps >= 0.0)):
            contact, supports = lane_of(before.contact, i, Contact), lane_of(before.supports, i, Supports)
            h, ground = before.clock.step[i], Ground(before.ground.horizontal[i], 0.0, before.ground.vertical[i], 0.0)
            path = [lane_of(before.now, i, State)]
            for _ in range(16):
                k = rates(m, path[-1], contact, ground)
                path.append(rk4(m, None, Instant(path[-1], k, contact, None, ground), h / 16))
            path.append(lane_of(lanes[0].end, i, State))
            at_ends = [rates(m, path[n], contact, ground) for n in (0, -1)]
            dips += sum(hold_pivot(m, side, contact, supports, path, at_ends, h) for side in ("left", "right"))
            calm += 1
    assert calm > 80
    assert dips > 10 or m.damped


@numba.njit(error_model="numpy", _nrt=False)
def corrections(traits, lanes, i):
    correct_lane(traits, lanes, i)


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
