"""Constitutive models of dampers and tendons, by their elongation and its rate (THEORY.md, Dampers and tendons).

Forces are positive in tension, over the pier's mass [m/s²].
"""

import math
from typing import NamedTuple

from rockbatch.core.kernel import kernel
from rockbatch.core.powers import power
from rockbatch.core.table import record

# Kinds
FRICTION = 0.0
VISCOUS = 1.0
HYSTERETIC = 2.0
TENDON = 3.0

# Modes of a tendon
TAUT = 0.0
SLACK = 1.0
YIELDING = 2.0

# Direction of a device: its elongation grows, falls, or friction holds it
OPENS = 1.0
CLOSES = -1.0
STICKS = 0.0


class Element(NamedTuple):
    """One damper or tendon, per unit mass of the pier."""

    kind: float
    strength: float  # F_d of friction and hysteretic dampers, yield force of a tendon, inf without [m/s²]
    stiffness: float  # 1/u_y of a hysteretic damper [1/m]; k of a tendon [1/s²]
    coefficient: float  # C of a viscous damper [m/s² over (m/s)^exponent]
    exponent: float
    prestress: float  # of a tendon [m/s²]
    offset: float  # from the centre of the base, positive to the right [m]
    linear_below: float  # speed [m/s] up to which a viscous damper is linear: |ė|^a would rise without bound in slope
    slope: float  # of its force there [1/s]


class Use(NamedTuple):
    """Extremes of an element in a run: greatest and least force [m/s²], elongation [m], speed [m/s], energy [J/kg]."""

    most: float
    least: float
    stroke: float
    speed: float
    lost: float
    yielded: float  # by how much a tendon has been lengthened for good [m]
    slack: float  # how often it has gone slack


ELEMENT = record(Element)
USE = record(Use)


@kernel
def tension(of, elongation, slack):
    """Return the force of a tendon unstressed at ``slack`` − prestress/k, were it to take compression and any tension."""
    return of.prestress + of.stiffness * (elongation - slack)


@kernel
def force(of, elongation, speed, state, mode, goes):
    """Return the force [m/s²] of an element that ``goes`` out or in; ``state``: z of a hysteretic damper, u_0 [m] of a tendon."""
    if of.kind == FRICTION:
        return of.strength * goes
    if of.kind == VISCOUS and abs(speed) < of.linear_below:
        return of.slope * speed
    if of.kind == VISCOUS:
        return math.copysign(of.coefficient * abs(speed) ** of.exponent, speed) if speed != 0.0 else 0.0
    if of.kind == HYSTERETIC:
        return of.strength * state
    if mode == TAUT:
        return tension(of, elongation, state)
    return 0.0 if mode == SLACK else of.strength


@kernel
def state_rate(of, speed, state, mode, goes):
    """Return the rate of an element's state [1/s or m/s]: two-sided Bouc–Wen, n = 5; a tendon lengthens while it yields."""
    if of.kind == HYSTERETIC:
        loads = goes * state > 0.0
        return speed * of.stiffness * (1.0 - (power(min(abs(state), 1.0), None) if loads else 0.0))
    return speed if of.kind == TENDON and mode == YIELDING else 0.0


@kernel
def loss_rate(of, speed, pull, mode):
    """Return the power [W/kg] that goes into an element and is not stored in a tendon."""
    return 0.0 if of.kind == TENDON and mode != YIELDING else pull * speed


@kernel
def stored(of, elongation, state):
    """Return the energy [J/kg] that a tendon gives back when it goes slack; 0 of dampers."""
    if of.kind != TENDON:
        return 0.0
    pull = min(max(tension(of, elongation, state), 0.0), of.strength)
    return 0.5 * pull * pull / of.stiffness if of.stiffness > 0.0 else of.prestress * elongation


@kernel
def mode_of(of, elongation, state, goes):
    """Return the mode of a tendon at this elongation that goes on out or in."""
    if of.kind != TENDON:
        return TAUT
    pull = tension(of, elongation, state)
    if pull < 0.0 or (pull == 0.0 and goes != OPENS):
        return SLACK
    return YIELDING if pull >= of.strength and goes == OPENS else TAUT
