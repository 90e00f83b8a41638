"""Friction dampers that stick, in the pass: the forces that hold them, and whether these surely hold throughout a sub-step."""

from rockbatch.core.clock import ground_at
from rockbatch.core.devices.elongation import Attitude, chosen
from rockbatch.core.devices.lanes import Grip, gap_in_stage
from rockbatch.core.devices.laws import STICKS
from rockbatch.core.devices.pull import forces_that_hold, pushed
from rockbatch.core.ground import later
from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.system import gives_way, in_pass, rates_and_power
from rockbatch.core.table import get, put, with_pull
from rockbatch.core.types import Pull

RANGES = 2.0
"""Ranges of a sticking force in a step by which its reserve of strength surely exceeds the overshoot of the search's cubic."""


@inlined
def friction_holds(traits, equipment, runs):
    """Return True if friction that sticks in a lane may have a force; at the pivot on rigid ground it has none."""
    holds, start = False, equipment.grips[0]
    for j in equipment.rubs:
        for i in range(runs):
            has_force = gives_way(traits) or start.first[i] != 0.0 or start.second[i] != 0.0
            holds = holds or (has_force and equipment.lanes[j].mode.goes[i] == STICKS)
    return holds


@kernel
def hold(traits, lanes, equipment, count, steps, part, number):
    """Add the forces of friction that sticks to the pull in stage ``number``, ``part`` of a step after its start."""
    shared, grip = equipment.shared[0], equipment.grips[number]
    a, b = equipment.lanes[equipment.rubs[0]], equipment.lanes[equipment.rubs[1]]
    for i in range(count):
        m, now, contact = in_pass(traits, lanes, i)
        y, pull, at = get(shared.stage, i, now), get(shared.pull, i, Pull), get(shared.attitude, i, Attitude)
        h = lanes.clock.step[i]
        ground = later(ground_at(lanes, i, steps * h), part * h)
        sticks, other_sticks = a.mode.goes[i] == STICKS, b.mode.goes[i] == STICKS
        here, there = gap_in_stage(traits, lanes, a, shared, i), gap_in_stage(traits, lanes, b, shared, i)
        first, second = chosen(sticks, here, there), chosen(other_sticks, there, here)
        strength, other_strength = a.element.strength[i], b.element.strength[i]
        strengths = strength if sticks else other_strength, other_strength if other_sticks else strength
        k, _ = rates_and_power(with_pull(m, pull), y, contact, ground, at)
        k_first, _ = rates_and_power(with_pull(m, pushed(pull, first)), y, contact, ground, at)
        k_second, _ = rates_and_power(with_pull(m, pushed(pull, second)), y, contact, ground, at)
        one, two = forces_that_hold(first, second, k, k_first, k_second, strengths)
        holds = sticks or other_sticks
        put(grip, i, Grip(one if holds else 0.0, two if holds else 0.0))
        shared.pull.force[i] = pull.force + (one * first.by_v + two * second.by_v if holds else 0.0)
        shared.pull.moment[i] = pull.moment + (one * first.arm + two * second.arm if holds else 0.0)


@kernel
def judge_grip(equipment, shared, count):
    """Count lanes in which friction that sticks may slip: its least reserve of strength does not exceed twice its range."""
    a, b = equipment.lanes[equipment.rubs[0]], equipment.lanes[equipment.rubs[1]]
    for i in range(count):
        sticks, other_sticks = a.mode.goes[i] == STICKS, b.mode.goes[i] == STICKS
        strength, other_strength = a.element.strength[i], b.element.strength[i]
        first, second = strength if sticks else other_strength, other_strength if other_sticks else strength
        start, end = get(equipment.grips[0], i, Grip), get(equipment.grips[4], i, Grip)
        low, high, low_other, high_other = abs(start.first), abs(start.first), abs(start.second), abs(start.second)
        for number in range(1, 5):
            grip = get(equipment.grips[number], i, Grip)
            low, high = min(low, abs(grip.first)), max(high, abs(grip.first))
            low_other, high_other = min(low_other, abs(grip.second)), max(high_other, abs(grip.second))
        surely = min(first - high - RANGES * (high - low), second - high_other - RANGES * (high_other - low_other))
        doubt = 1.0 if sticks or other_sticks else 0.0
        shared.verdict.doubts[i] += 0.0 if surely > 0.0 else doubt
        shared.verdict.holds[i] = 0.0 if end.first == 0.0 and end.second == 0.0 else 1.0
