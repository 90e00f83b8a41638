"""Devices on a pier: their force and moment, the rates of their states (THEORY.md, Dampers and tendons, Stops and deck springs).

The force F of a device with the elongation e acts on v and θ by ∂e/∂v and ∂e/∂θ.

The variables x integrated beside the pier's state are the state of each device, the energy dissipated by each [J/kg], the
work of the ground [J/kg], and that of the devices' P–Δ moments [J/kg].
"""

import math
from typing import NamedTuple

import numpy as np

from rockbatch.core.devices.elongation import attitude, gap_of, lifted, put_gap
from rockbatch.core.devices.laws import (
    CLOSES,
    CONTACT,
    FRICTION,
    HYSTERETIC,
    MAXWELL,
    OPENS,
    SLACK,
    STICKS,
    VISCOUS,
    force,
    mode_of,
    response,
    slip_rate,
)
from rockbatch.core.ground import later
from rockbatch.core.kernel import hook, inlined, kernel
from rockbatch.core.system import ground_power, rates, shift
from rockbatch.core.table import with_pull
from rockbatch.core.types import NO_EVENT, Pull

STAYS = 1e-9
"""Acceleration of a place by a unit force there that is rounding: a pivot on rigid ground does not move."""

LINKED = 1e-12
"""Determinant over the product of two such accelerations below which two places can only move together."""

PLASTIC = 1e-14
"""Distance of |z| from 1 at which a hysteretic damper counts as plastic; 1 − z decays by exp(−5 e/u_y) without end."""

TRAVEL = 0.5
"""Greatest elongation of a hysteretic damper over u_y in a step of a whole sample; proportionally less in shorter steps."""

GROWTH = 0.5
"""Longest step of a viscous damper of exponent < 1 at a sampling interval from a velocity reversal, over the step of the run:
|ė|^a has no Taylor series at 0."""

FINE = 0.2
"""Longest step times the rate of vibration against a stop, or of relaxation of a braced damper."""

NEAREST = 1e-3
"""Shortest step near a velocity reversal, over the whole one."""


START, SECOND, THIRD, FOURTH, END, BESIDE = map(np.int64, range(6))  # literals would compile callees for each value
"""Rows of ``rates`` and ``gaps``: start of a step, its stages, its end, and a state beside the step."""


class Devices(NamedTuple):
    """The devices of one run and their states, in arrays that the run writes."""

    elements: np.recarray  # of Element
    level: np.ndarray  # shape (1,), v of the pier at rest [m]
    modes: np.ndarray  # of tendons and stops: TAUT, SLACK or YIELDING
    goes: np.ndarray  # OPENS, CLOSES or, of friction, STICKS
    x: np.ndarray  # states, energies taken, work of the ground, P–Δ
    stage: np.ndarray  # of a Runge–Kutta step
    end: np.ndarray
    rates: np.ndarray  # shape (6, len(x)): of the four stages, at the end, and of a state looked at beside them
    gaps: np.recarray  # of Gap, shape (6, devices), likewise but for stages inside a step
    held: np.ndarray  # shape (6, 2): forces [m/s²] of the first two sticking friction dampers, by row
    use: np.recarray  # of Use
    bound_steps: bool  # some may ask for a shorter step
    ended: np.ndarray  # 1 if the next step goes on from the end of the last one; force [m/s²] and moment [m²/s²] there


def bounds_steps(of):
    """Return True if :func:`step_resolving_devices` may shorten steps for an element.

    It may for hysteretic dampers, stops, and viscous dampers of exponent < 1.
    """
    return of.kind in (HYSTERETIC, CONTACT) or (of.kind in (VISCOUS, MAXWELL) and of.exponent < 1.0)


@kernel
def sticking(devices, after):
    """Return the number of the first sticking friction damper beyond number ``after``, NO_EVENT without one."""
    for j in range(after + 1, len(devices.elements)):
        if devices.elements[j].kind == FRICTION and devices.goes[j] == STICKS:
            return j
    return NO_EVENT


@inlined
def pushed(pull, place):
    """Return the Pull on a pier with a unit force more at a place with the Gap ``place``."""
    return Pull(pull.force + place.by_v, pull.moment + place.arm)


@inlined
def forces_that_hold(first, second, k, k_first, k_second, strengths):
    """Return the friction forces per mass [m/s²] at two places, with the Gaps given, under which neither accelerates.

    ``k`` are the pier's rates under all other forces, ``k_first`` and ``k_second`` those with a unit force more at either place:
    accelerations are linear in the friction forces. A force is 0 where it moves nothing, as at a pivot on the ground, and the
    second is 0 if both places are the same. Two places that can only move together share the force by their ``strengths``.
    """
    free, free_other = lifted(first, k), lifted(second, k)
    own, other_by_own = lifted(first, k_first) - free, lifted(second, k_first) - free_other
    by_other, own_other = lifted(first, k_second) - free, lifted(second, k_second) - free_other
    fixed, other_fixed = abs(own) <= STAYS, abs(own_other) <= STAYS
    alone = other_fixed or first.by_theta == second.by_theta
    determinant = own * own_other - by_other * other_by_own
    linked = abs(determinant) <= LINKED * own * own_other
    with_first = math.copysign(strengths[1], by_other * own)
    share = -free / (own * strengths[0] + by_other * with_first)
    one = share * strengths[0] if linked else (by_other * free_other - own_other * free) / determinant
    two = share * with_first if linked else (other_by_own * free - own * free_other) / determinant
    one, two = -free / own if alone else one, 0.0 if alone else two
    two_alone = 0.0 if other_fixed else -free_other / own_other
    return 0.0 if fixed else one, two_alone if fixed else two


@kernel
def _with_friction(m, devices, at, now, ground):
    """Return the pier ``m`` with sticking friction added to its pull, and the forces [m/s²] of the first two such dampers."""
    first, elements = sticking(devices, NO_EVENT), devices.elements
    second = sticking(devices, first)
    other = second if second != NO_EVENT else first
    here, there = gap_of(m, elements[first], at, now.y), gap_of(m, elements[other], at, now.y)
    strengths, pull = (elements[first].strength, elements[other].strength), m.pull
    k, k_first, k_second = now.y, now.y, now.y
    for unit in range(2 if second == NO_EVENT else 3):  # a loop, since three calls would be much machine code
        arm = 0.0 if unit == 0 else (here.arm if unit == 1 else there.arm)
        down = 0.0 if unit == 0 else (here.by_v if unit == 1 else there.by_v)
        under = with_pull(m, Pull(pull.force + down, pull.moment + arm))
        found = rates(under, now.y, now.contact, ground)
        if unit == 0:
            k = found
        elif unit == 1:
            k_first = k_second = found
        else:
            k_second = found
    one, two = forces_that_hold(here, there, k, k_first, k_second, strengths)
    down = one * here.by_v + two * there.by_v
    return with_pull(m, Pull(m.pull.force + down, m.pull.moment + one * here.arm + two * there.arm)), one, two


@kernel
def device_rates(m, devices, now, x, ground, place):
    """Return the pier ``m`` under all devices, and the forces [m/s²] of the first two sticking friction dampers.

    Write the rates of the devices' states ``x`` and those forces to their row ``place``, and the gaps, except for stages inside
    a step. At END also set ``ended``: whether the next step continues from there, and the pull.
    """
    y, n, k, at = now.y, len(devices.elements), devices.rates[place], attitude(m, now.y, now.contact, devices.level[0])
    total, moment, one, two, holds = 0.0, 0.0, 0.0, 0.0, False
    for j in range(n):
        of, goes = devices.elements[j], devices.goes[j]
        here = gap_of(m, of, at, y)
        if place == START or place >= END:
            put_gap(devices.gaps[place, j], here)
        law = response(of, here.elongation, here.speed, x[j], devices.modes[j], goes)
        k[j], k[n + j] = law.state_rate, law.loss_rate
        total += law.force * here.by_v
        moment += law.force * here.arm
        holds = holds or (goes == STICKS and of.kind == FRICTION)
    under = with_pull(m, Pull(total, moment))
    if holds:
        under, one, two = _with_friction(under, devices, at, now, ground)
    devices.held[place, 0], devices.held[place, 1] = one, two
    if place == END:
        continues = 1.0 if one == 0.0 and two == 0.0 else 0.0
        devices.ended[0], devices.ended[1], devices.ended[2] = continues, total, moment
    k[2 * n] = ground_power(m, y, now.contact, ground)
    k[2 * n + 1] = 0.0 if m.finite is not None else -m.height * y.theta * under.pull.force * y.omega
    return under, one, two


@inlined
def goes_on(devices):
    """Return True if a step continues from the rates at the end of the last one: not after events, nor while friction holds."""
    return devices.ended[0] != 0.0


@kernel
def pulled_at_end(m, devices):
    """Return the pier under its devices at the end of the last step; copy rates, forces and gaps to the next one's start."""
    devices.held[START, 0], devices.held[START, 1] = devices.held[END, 0], devices.held[END, 1]
    for i in range(len(devices.x)):
        devices.rates[START, i] = devices.rates[END, i]
    for j in range(len(devices.elements)):
        devices.gaps[START, j] = devices.gaps[END, j]
    return with_pull(m, Pull(devices.ended[1], devices.ended[2]))


@kernel
def under_devices(m, devices, now, x, ground):
    """Return the result of :func:`device_rates` for a Moment beside a step, without changing rows of the step."""
    return device_rates(m, devices, now, x, ground, BESIDE)


@hook
def loaded(devices, m, now, ground):
    """Return the pier ``m`` under its devices in the Moment ``now``; ``m`` itself without any."""


@loaded.of(type(None))
def _alone(devices, m, now, ground):
    return m


@loaded.of(Devices)
def _loaded(devices, m, now, ground):
    return under_devices(m, devices, now, devices.x, ground)[0]


@hook
def loaded_soon(devices, m, now, soon, ground, near):
    """Return the pier ``m`` under its devices in the Moment ``soon``, ``near`` [s] after ``now``; ``m`` itself without any.

    The staged states, those of ``now``, are advanced by ``near``.
    """


@loaded_soon.of(type(None))
def _alone_soon(devices, m, now, soon, ground, near):
    return m


@loaded_soon.of(Devices)
def _loaded_soon(devices, m, now, soon, ground, near):
    under_devices(m, devices, now, devices.stage, ground)
    for i in range(len(devices.stage)):
        devices.stage[i] += near * devices.rates[BESIDE, i]
    return under_devices(m, devices, soon, devices.stage, later(ground, near))[0]


@hook
def about_to_turn(devices, m, y, contact, sense):
    """Return the pier ``m`` at rest under its devices as it begins to move with the ``contact`` to come; ``m`` without any.

    ``sense`` is OPENS or, for a block about to land, CLOSES. Friction resists with its full force, but for 0 right at the pivot.
    """


@about_to_turn.of(type(None))
def _nothing_holds(devices, m, y, contact, sense):
    return m


@about_to_turn.of(Devices)
def _devices_hold(devices, m, y, contact, sense):
    total, moment, at = 0.0, 0.0, attitude(m, y, contact, devices.level[0])
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        here, way = gap_of(m, of, at, y), sense * way_of_opening(m, of, contact)
        pull = force(of, here.elongation, 0.0, devices.x[j], mode_of(of, here.elongation, devices.x[j], way), way)
        total += pull * here.by_v
        moment += pull * here.arm
    return with_pull(m, Pull(total, moment))


@kernel
def way_of_opening(m, of, contact):
    """Return the direction that a device takes as the pier begins to turn about the pivot in ``contact``, or to rise (OPENS).

    OPENS or CLOSES by its side of the pivot, STICKS right at it.
    """
    side = contact.right - contact.left
    if side == 0.0:
        return OPENS
    if of.height != 0.0:
        return OPENS if side * of.way > 0.0 else CLOSES
    distance = m.half_width - side * (of.offset + shift(m, contact))
    return OPENS if distance > 0.0 else (CLOSES if distance < 0.0 else STICKS)


@inlined
def stage_states(devices, place, h):
    """Set the staged states of devices to those ``h`` [s] after the start by the rates at ``place``; nothing without devices."""
    if devices is None:
        return
    for i in range(len(devices.x)):
        devices.stage[i] = devices.x[i] + h * devices.rates[place, i]


@inlined
def advance_states(devices, h):
    """Set ``end`` and the staged states of devices to those at the end of a step of ``h`` [s]; nothing without devices.

    z of a hysteretic damper is set to ±1 within PLASTIC of it.
    """
    if devices is None:
        return
    k, n = devices.rates, len(devices.elements)
    for i in range(len(devices.x)):
        end = devices.x[i] + h * (1.0 / 6.0) * (k[0, i] + 2.0 * (k[1, i] + k[2, i]) + k[3, i])
        if i < n and devices.elements[i].kind == HYSTERETIC and abs(end) > 1.0 - PLASTIC:
            end = math.copysign(1.0, end)
        devices.end[i] = devices.stage[i] = end


@kernel
def step_resolving_devices(under, devices, start, h, dt):
    """Return the longest step [s] from the Instant ``start``, at most ``h``, that resolves the laws of devices.

    They are hysteretic dampers not yet plastic, viscous ones of exponent < 1 near a velocity reversal or behind a brace, and
    closed stops; ``h`` without such. The factor on ``h`` depends on ``dt`` and hardly on ``h``, so that a run with half the step
    halves these steps, too, and its change still measures the error.
    """
    if devices is None or not devices.bound_steps:
        return h
    share, asked = 1.0, False
    for j in range(len(devices.elements)):
        of = devices.elements[j]
        asked = asked or (of.kind == HYSTERETIC and devices.goes[j] * devices.x[j] < 1.0) or _is_steep(of)
        asked = asked or (of.kind == MAXWELL and of.exponent < 1.0)
        if of.kind == CONTACT and devices.modes[j] != SLACK:
            share = min(share, FINE / (of.quickest * dt))
    if not asked:
        return share * h
    k = rates(under, start.y, start.contact, start.ground)
    k_end = rates(
        under, start.y, start.contact, later(start.ground, h)
    )  # where a pier lifts off it has no acceleration yet
    for j in range(len(devices.elements)):
        of, here = devices.elements[j], devices.gaps[START, j]
        if of.kind == MAXWELL and of.exponent < 1.0:
            slips = max(abs(slip_rate(of, devices.x[j])), abs(here.speed))
            share = min(share, FINE / (of.quickest * slips ** (1.0 - of.exponent) * dt)) if slips > 0.0 else share
        soft = of.kind == HYSTERETIC and devices.goes[j] * devices.x[j] < 1.0
        if not (_is_steep(of) or soft):
            continue
        lift = max(abs(lifted(here, k)), abs(lifted(here, k_end)))
        if soft:
            way = (abs(here.speed) + lift * h) * dt * of.stiffness
            share = min(share, TRAVEL / way) if way > 0.0 else share
        elif lift > 0.0:
            share = min(share, max(share_near_reversal(of, here.speed, lift * dt), NEAREST))
    return share * h


@inlined
def share_near_reversal(of, speed, gain):
    """Return the share of a step that resolves a viscous damper at ``speed`` [m/s], which changes by ``gain`` in a sample.

    At the time τ from the reversal the error of a step h is about τᵃ⁻⁴ h⁵: it hardly depends on τ for h ~ τ^¾.
    """
    time = max(abs(speed), of.linear_below) / gain
    return GROWTH * math.sqrt(time * math.sqrt(time))


@kernel
def _is_steep(of):
    """Return True for a viscous damper of exponent < 1 without a brace, whose force has an unbounded slope at speed 0."""
    return of.kind == VISCOUS and of.exponent < 1.0
