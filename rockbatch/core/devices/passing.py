"""A sub-step of all lanes with devices: Runge–Kutta 4 stage by stage, then a verdict whether it stands.

Each stage takes a loop over lanes for each device, which adds its force to the pull on the pier, and one for the pier under
their sum. The numbers of a lane are combined in the order of scalar code, so that a sub-step that stands gives its bits. It
stands in the lanes in which bounds prove that no device has an event in it.
"""

import math

import numpy as np

from rockbatch.core.clock import EVENTFUL, ground_at
from rockbatch.core.devices.bounds import (
    course,
    keeps_branch,
    keeps_mode_of,
    keeps_steep,
    keeps_way,
    most_of_friction,
    most_of_hysteretic,
    most_of_linear,
    most_of_powers,
    most_of_tendon,
    no_event,
    travelled,
)
from rockbatch.core.devices.elongation import Attitude, Gap, attitude_in_pass, put_gap
from rockbatch.core.devices.lanes import Grip, Mode, Progress, Works, devices_in, fetch, gap_in_stage
from rockbatch.core.devices.laws import (
    FRICTION,
    HYSTERETIC,
    VISCOUS,
    Element,
    Use,
    friction,
    hysteretic,
    linear,
    tendon,
    viscous,
)
from rockbatch.core.devices.pull import END, PLASTIC, START, device_rates
from rockbatch.core.devices.sticking import friction_holds, hold, judge_grip
from rockbatch.core.devices.use import take_in
from rockbatch.core.ground import later
from rockbatch.core.kernel import inlined, inlined_once, kernel
from rockbatch.core.system import (
    end_step,
    in_pass,
    lanes_in_pass,
    pier_in,
    rates,
    rates_and_power,
    share,
    stage,
)
from rockbatch.core.table import ZERO, along, get, put, taken, with_pull
from rockbatch.core.types import Pull


@inlined_once
def _start(traits, lanes, equipment, i, steps):
    """Set the rates of lane ``i`` at the start of a sub-step, which does not continue the last one."""
    devices, each, shared = devices_in(equipment, lanes, i), equipment.lanes, equipment.shared[0]
    fetch(equipment, devices, i)
    m, now = pier_in(traits, lanes, i)
    ground = ground_at(lanes, i, steps * lanes.clock.step[i])
    under, _, _ = device_rates(m, devices, now, devices.x, ground, START)
    put(lanes.rates, i, rates(under, now.y, now.contact, ground))
    put(shared.start_pull, i, under.pull)
    put(equipment.grips[0], i, Grip(devices.held[START, 0], devices.held[START, 1]))
    n, moving = len(each), devices.rates[START]
    for j in range(n):
        put(each[j].start_rates, i, Progress(moving[j], moving[n + j]))
        put(each[j].rates, i, Progress(moving[j], moving[n + j]))
        put(each[j].start_gap, i, taken(devices.gaps[START, j], Gap))
    put(shared.works_start, i, Works(moving[2 * n], moving[2 * n + 1]))
    shared.verdict.ended[i] = 1.0


@inlined
def _stage_pier(traits, lanes, shared, i, y):
    """Set the staged state of the pier to ``y``, with its attitude, and its pull to zero."""
    m, _, contact = in_pass(traits, lanes, i)
    put(shared.stage, i, y)
    put(shared.attitude, i, attitude_in_pass(m, y, contact, shared.verdict.level[i]))
    put(shared.pull, i, Pull(0.0, 0.0))


@inlined
def _leave_start(traits, lanes, each, shared, count):
    """Set the stage of the pier in each of ``count`` lanes to half a step after the start, and sums of the rates at inner stages
    to 0.
    """
    for i in range(count):
        m, y, contact = in_pass(traits, lanes, i)
        h, k = lanes.clock.step[i], get(lanes.rates, i, y)
        _stage_pier(traits, lanes, shared, i, stage(m, along(y, k, 0.5 * h), y, contact, share(m, 0.5 * h)))
        put(shared.inner, i, along(k, k, -1.0))
        put(shared.works_inner, i, Works(0.0, 0.0))
    for j in range(len(each)):
        for i in range(count):
            put(each[j].inner, i, Progress(0.0, 0.0))


@inlined
def _progress_at_end(line, i, h):
    """Return the Progress of a device at the end of a step of ``h`` [s]."""
    inner = along(get(line.start_rates, i, Progress), get(line.inner, i, Progress), 2.0)
    return along(get(line.now, i, Progress), along(inner, get(line.rates, i, Progress), 1.0), h * (1.0 / 6.0))


@inlined
def _unchanged(state):
    """Return the ``state`` of a device at the end of a step."""
    return state


@inlined
def _snapped(z):
    """Return ``z`` of a hysteretic damper at the end of a step: ±1 if within PLASTIC of it."""
    return (1.0 if z > 0.0 else -1.0) if abs(z) > 1.0 - PLASTIC else z


@inlined
def _pulled(shared, i, here, force):
    """Add the ``force`` [m/s²] of a device with the Gap ``here`` to the pull of lane ``i``."""
    shared.pull.force[i] += force * here.by_v
    shared.pull.moment[i] += force * here.arm


@inlined
def _rates_under_devices(traits, lanes, shared, i, steps, part):
    """Return the rates of the pier in its stage, under the pull of its devices, and the powers of the Works.

    The stage is ``part`` of a step after its start.
    """
    m, now, contact = in_pass(traits, lanes, i)
    y, h = get(shared.stage, i, now), lanes.clock.step[i]
    ground = later(ground_at(lanes, i, steps * h), part * h)
    under = with_pull(m, get(shared.pull, i, Pull))
    p_delta = 0.0 if m.finite is not None else -m.height * y.theta * under.pull.force * y.omega
    k, power = rates_and_power(under, y, contact, ground, get(shared.attitude, i, Attitude))
    return k, Works(power, p_delta)


@inlined
def _to_next_stage(traits, lanes, shared, count, steps, part, part_next):
    """Set the pier's stage to ``part_next`` of a step after the start, by the rates in the present one, and add these to sums."""
    for i in range(count):
        k, power = _rates_under_devices(traits, lanes, shared, i, steps, part)
        m, y, contact = in_pass(traits, lanes, i)
        h = lanes.clock.step[i]
        left = share(m, 0.5 * h)
        put(shared.inner, i, along(get(shared.inner, i, y), k, 1.0))
        put(shared.works_inner, i, along(get(shared.works_inner, i, Works), power, 1.0))
        remaining = left if part_next < 1.0 else left * left
        _stage_pier(traits, lanes, shared, i, stage(m, along(y, k, part_next * h), y, contact, remaining))


@inlined
def _to_end(traits, lanes, shared, count, steps):
    """Set the pier's stage, and its Works, to the end of the step."""
    for i in range(count):
        k, power = _rates_under_devices(traits, lanes, shared, i, steps, 1.0)
        m, y, contact = in_pass(traits, lanes, i)
        h = lanes.clock.step[i]
        left = share(m, 0.5 * h)
        total = along(along(get(lanes.rates, i, y), get(shared.inner, i, y), 2.0), k, 1.0)
        works = along(along(get(shared.works_start, i, Works), get(shared.works_inner, i, Works), 2.0), power, 1.0)
        put(shared.works_end, i, along(get(shared.works, i, Works), works, h * (1.0 / 6.0)))
        _stage_pier(traits, lanes, shared, i, end_step(m, along(y, total, h * (1.0 / 6.0)), y, contact, left * left))


@inlined
def _evaluate_end(traits, lanes, shared, count, steps):
    """Set the pier's rates, and the powers of its Works, at the end of the step in each of ``count`` lanes.

    Begin each lane's Verdict anew: no holds, no extremes, and no doubts, or one if the lane is not ``smooth``.
    """
    for i in range(count):
        k, power = _rates_under_devices(traits, lanes, shared, i, steps, 1.0)
        put(shared.rates, i, k)
        put(shared.works_rates, i, power)
        shared.verdict.doubts[i] = 0.0 if shared.verdict.smooth[i] > 0.0 else 1.0
        shared.verdict.extremes[i] = shared.verdict.holds[i] = 0.0


@inlined
def _look_ahead(traits, lanes, shared, count, steps):
    """Set ``ahead`` to the rates at the start of the sub-step under the ground motion at its end."""
    for i in range(count):
        m, y, contact = in_pass(traits, lanes, i)
        h = lanes.clock.step[i]
        ground = later(ground_at(lanes, i, steps * h), h)
        put(shared.ahead, i, rates(with_pull(m, get(shared.start_pull, i, Pull)), y, contact, ground))


STAGE, END_OF_STEP, VERDICT = map(np.int64, range(3))
"""What is done with a device in all lanes: a stage inside the step, its end, or whether the step stands."""


def _law(respond, clear, most, state_at_end=None):
    """Return a kernel that takes one device in all lanes through a stage, or judges it, by functions of its law.

    A loop for each law is shorter than one that computes all laws and selects one.
    """
    ends = state_at_end or _unchanged

    @kernel
    def take(what, part, traits, lanes, line, shared, count):
        if what == STAGE:
            for i in range(count):
                here, h = gap_in_stage(traits, lanes, line, shared, i), lanes.clock.step[i]
                of, mode = get(line.element, i, Element), get(line.mode, i, Mode)
                state = line.now.state[i] + part * h * line.rates.state[i]
                response = respond(of, here.elongation, here.speed, state, mode.mode, mode.goes)
                moving = Progress(response.state_rate, response.loss_rate)
                put(line.rates, i, moving)
                put(line.inner, i, along(get(line.inner, i, Progress), moving, 1.0 if part < 1.0 else 0.0))
                _pulled(shared, i, here, response.force)
        elif what == END_OF_STEP:
            for i in range(count):
                here, h = gap_in_stage(traits, lanes, line, shared, i), lanes.clock.step[i]
                of, mode = get(line.element, i, Element), get(line.mode, i, Mode)
                end = _progress_at_end(line, i, h)
                state = ends(end.state)
                response = respond(of, here.elongation, here.speed, state, mode.mode, mode.goes)
                put(line.end, i, Progress(state, end.lost))
                put(line.gap, i, here)
                put(line.rates, i, Progress(response.state_rate, response.loss_rate))
                _pulled(shared, i, here, response.force)
        else:
            for i in range(count):
                c = course(traits, lanes, line, shared, i)
                of, mode = get(line.element, i, Element), get(line.mode, i, Mode)
                use, more = travelled(line, i, c)
                force, stronger = most(of, mode, c, use, get(line.use, i, Use))
                put(line.use_end, i, Use(force, use.stroke, use.speed, use.lost, use.yielded, use.times))
                # Counts, since the compiler makes of min and max in place a masked store, which takes twenty times as long
                shared.verdict.doubts[i] += 0.0 if clear(of, mode, c) > 0.0 else 1.0
                shared.verdict.extremes[i] += 1.0 if max(more, stronger) > 0.0 else 0.0

    return take


_linear = _law(linear, no_event, most_of_linear)
_by_powers = _law(viscous, keeps_steep, most_of_powers)
_tendon = _law(tendon, keeps_mode_of, most_of_tendon)
_hysteretic = _law(hysteretic, keeps_branch, most_of_hysteretic, _snapped)
_friction = _law(friction, keeps_way, most_of_friction)


@inlined
def _take_all(what, part, traits, lanes, each, shared, count):
    """Take all devices through a stage ``part`` of a step after its start, or judge them; kinds are alike in all lanes."""
    for j in range(len(each)):
        line, kind = each[j], each[j].element.kind[0]
        if kind == VISCOUS and line.element.linear_below[0] == math.inf:
            _linear(what, part, traits, lanes, line, shared, count)
        elif kind == VISCOUS:
            _by_powers(what, part, traits, lanes, line, shared, count)
        elif kind == HYSTERETIC:
            _hysteretic(what, part, traits, lanes, line, shared, count)
        elif kind == FRICTION:
            _friction(what, part, traits, lanes, line, shared, count)
        else:
            _tendon(what, part, traits, lanes, line, shared, count)


@inlined
def integrate(traits, lanes, equipment, runs, substep):
    """Integrate the first ``runs`` lanes over a sub-step, and judge their devices; return the number of lanes with padding.

    ``stage`` and ``rates`` are then those at its end.
    """
    each, shared, steps, count = equipment.lanes, equipment.shared[0], float(substep), lanes_in_pass(traits, runs)
    for i in range(runs):
        if shared.verdict.ended[i] == 0.0 and shared.verdict.smooth[i] > 0.0:
            _start(traits, lanes, equipment, i, steps)
        else:
            put(equipment.grips[0], i, Grip(0.0, 0.0))
    _leave_start(traits, lanes, each, shared, count)
    holds = friction_holds(traits, equipment, runs)
    for number in range(3):
        part = 1.0 if number == 2 else 0.5
        _take_all(STAGE, part, traits, lanes, each, shared, count)
        if holds:
            hold(traits, lanes, equipment, count, steps, part, ZERO + 1 + number)
        if number < 2:
            _to_next_stage(traits, lanes, shared, count, steps, 0.5, 0.5 if number == 0 else 1.0)
    _to_end(traits, lanes, shared, count, steps)
    _take_all(END_OF_STEP, 1.0, traits, lanes, each, shared, count)
    if holds:
        hold(traits, lanes, equipment, count, steps, 1.0, ZERO + 4)
    _evaluate_end(traits, lanes, shared, count, steps)
    if equipment.bound_steps:
        _look_ahead(traits, lanes, shared, count, steps)
    _take_all(VERDICT, 1.0, traits, lanes, each, shared, count)
    if holds:
        judge_grip(equipment, shared, count)
    return count


@inlined_once
def _use_inside(traits, lanes, equipment, i):
    """Set the Use of the devices of lane ``i`` at the end of its sub-step with extremes inside it."""
    devices, each, shared = devices_in(equipment, lanes, i), equipment.lanes, equipment.shared[0]
    fetch(equipment, devices, i)
    n, now = len(each), in_pass(traits, lanes, i)[1]
    for j in range(n):
        line = each[j]
        put_gap(devices.gaps[START, j], get(line.start_gap, i, Gap))
        put_gap(devices.gaps[END, j], get(line.gap, i, Gap))
        devices.end[j], devices.end[n + j] = line.end.state[i], line.end.lost[i]
    take_in(devices, get(lanes.rates, i, now), get(shared.rates, i, now), lanes.clock.step[i])
    for j in range(n):
        put(each[j].use_end, i, taken(devices.use[j], Use))


@inlined_once
def _stay(traits, lanes, equipment, i):
    """Set the numbers of lane ``i`` at the end of a sub-step that does not stand to those at its start."""
    each, shared, now = equipment.lanes, equipment.shared[0], in_pass(traits, lanes, i)[1]
    for j in range(len(each)):
        line = each[j]
        put(line.end, i, get(line.now, i, Progress))
        put(line.rates, i, get(line.start_rates, i, Progress))
        put(line.gap, i, get(line.start_gap, i, Gap))
        put(line.use_end, i, get(line.use, i, Use))
    put(shared.rates, i, get(lanes.rates, i, now))
    put(shared.works_end, i, get(shared.works, i, Works))
    put(shared.works_rates, i, get(shared.works_start, i, Works))
    put(shared.pull, i, get(shared.start_pull, i, Pull))


@inlined
def settle(traits, lanes, equipment, runs, count):
    """Advance the devices to the ends of the sub-steps that stand; lanes from ``runs`` to ``count`` are padding.

    All lanes are copied: a selection in the loop would make masked stores.
    """
    each, shared, kinds = equipment.lanes, equipment.shared[0], lanes.step_status.kind
    for i in range(count):
        if kinds[i] >= EVENTFUL:
            _stay(traits, lanes, equipment, i)
        elif i < runs:
            shared.verdict.ended[i] = 1.0 - shared.verdict.holds[i]
            if shared.verdict.extremes[i] > 0.0:
                _use_inside(traits, lanes, equipment, i)
    for j in range(len(each)):
        line = each[j]
        for i in range(count):
            put(line.now, i, get(line.end, i, Progress))
            put(line.start_rates, i, get(line.rates, i, Progress))
            put(line.start_gap, i, get(line.gap, i, Gap))
            put(line.use, i, get(line.use_end, i, Use))
    for i in range(count):
        put(lanes.rates, i, get(shared.rates, i, in_pass(traits, lanes, i)[1]))
        put(shared.works, i, get(shared.works_end, i, Works))
        put(shared.works_start, i, get(shared.works_rates, i, Works))
        put(shared.start_pull, i, get(shared.pull, i, Pull))
