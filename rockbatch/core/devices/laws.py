"""Constitutive models of devices, by their elongation and its rate (THEORY.md, Dampers and tendons, Stops and deck springs).

Forces are positive in tension, over the pier's mass [m/s²].
"""

import math
from typing import NamedTuple

from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.powers import power
from rockbatch.core.table import record

# Kinds
FRICTION = 0.0
VISCOUS = 1.0
HYSTERETIC = 2.0
TENDON = 3.0
MAXWELL = 4.0  # a viscous damper in series with a spring, its brace
CONTACT = 5.0  # a stop
SPRING = 6.0

PASSED = (VISCOUS, HYSTERETIC, TENDON, SPRING, FRICTION)
"""Kinds that the vector pass takes."""

DAMPERS = {"friction": FRICTION, "viscous": VISCOUS, "hysteretic": HYSTERETIC}
"""Kinds of dampers without a brace by their names in studies."""

# Modes of a tendon; of a stop: on its elastic line, open, on its first-loading line
TAUT = 0.0
SLACK = 1.0
YIELDING = 2.0

# Direction of a device: its elongation grows, falls, or friction sticks
OPENS = 1.0
CLOSES = -1.0
STICKS = 0.0


class Element(NamedTuple):
    """One device, per unit mass of the pier."""

    kind: float
    strength: float  # F_d of friction and hysteretic dampers, yield force of a tendon, inf without [m/s²]
    stiffness: float  # 1/u_y of a hysteretic damper [1/m]; k of a tendon, a spring, a stop or a brace [1/s²]
    coefficient: float  # C of a viscous damper [m/s² over (m/s)^exponent]
    exponent: float
    prestress: float  # of a tendon [m/s²]
    offset: float  # from the centre of the base, positive to the right [m]
    linear_below: float  # speed [m/s] up to which a viscous damper is linear, since |ė|^a has an unbounded slope
    slope: float  # of its force there [1/s]
    give: float  # compliance of the brace of a hysteretic damper over that of the damper
    start: float  # elongation at which a stop is met [m]
    returned: float  # e², share of the energy that a stop returns
    quickest: float  # rate of vibration against a stop on its elastic line, or of relaxation of a braced damper at 1 m/s [1/s]
    height: float  # at which a device acts on the deck, horizontally [m]; 0 of one at the base
    swing: float  # b where the pier turns about its pivots [m]
    way: float  # 1, or −1 of a device that lengthens as the deck moves to the left


class Response(NamedTuple):
    """Response of an element to its elongation and its rate, by its constitutive model."""

    force: float  # [m/s²]
    state_rate: float  # of z [1/s], of a tendon's permanent elongation [m/s], of a braced damper's force [m/s³]
    loss_rate: float  # power that is dissipated, not stored in a tendon, spring, stop or brace [W/kg]


class Use(NamedTuple):
    """Extremes of an element in a run: greatest |force| [m/s²], |elongation| [m] and |speed| [m/s]; energy [J/kg]."""

    most: float
    stroke: float
    speed: float
    lost: float
    yielded: float  # permanent elongation of a tendon [m]
    times: float  # number of times that a tendon went slack, or that a stop closed


ELEMENT = record(Element)
USE = record(Use)


@kernel
def tension(of, elongation, slack):
    """Return the force of a linear tendon [m/s²], compression included, with the permanent elongation ``slack`` [m]."""
    return of.prestress + of.stiffness * (elongation - slack)


@kernel
def past_release(of, elongation, deepest):
    """Return the compression of a stop beyond its point of release [m], negative below, after the greatest, ``deepest`` [m]."""
    return elongation - of.start - deepest * (1.0 - of.returned)


@kernel
def stop_force(of, elongation, deepest):
    """Return the force of a stop [m/s²]: k δ in first loading, slope k/e² from the point of release after it; 0 if open."""
    first = of.stiffness * (elongation - of.start)
    return max(min(first, of.stiffness / of.returned * past_release(of, elongation, deepest)), 0.0)


@kernel
def slip_rate(of, pull):
    """Return the speed [m/s], with its sign, of a braced viscous damper itself under the force ``pull`` [m/s²]."""
    return math.copysign((abs(pull) / of.coefficient) ** (1.0 / of.exponent), pull)


@inlined
def linear(of, elongation, speed, state, mode, goes):
    """Return the Response of a linear viscous damper."""
    return Response(of.slope * speed, 0.0, of.slope * speed * speed)


@inlined
def viscous(of, elongation, speed, state, mode, goes):
    """Return the Response of a viscous damper, linear for |speed| below ``linear_below``."""
    beyond = math.copysign(of.coefficient * power(abs(speed), of.exponent), speed)
    pull = of.slope * speed if abs(speed) < of.linear_below else beyond
    return Response(pull, 0.0, pull * speed)


@inlined
def friction(of, elongation, speed, state, mode, goes):
    """Return the Response of a friction damper that slips; no force if it STICKS, which the motion decides."""
    pull = of.strength * goes
    return Response(pull, 0.0, pull * speed)


@inlined
def _unyielded(z, goes):
    """Return the share of its elongation by which a hysteretic damper deforms elastically: 1 − |z|⁵ if loaded, 1 if unloaded."""
    return 1.0 - (power(min(abs(z), 1.0), None) if goes * z > 0.0 else 0.0)


@inlined
def hysteretic(of, elongation, speed, z, mode, goes):
    """Return the Response of a hysteretic damper without a brace."""
    pull = of.strength * z
    return Response(pull, speed * of.stiffness * _unyielded(z, goes), pull * speed)


@inlined
def _braced_hysteretic(of, speed, z, goes):
    """Return the Response of a hysteretic damper with or without a brace; ``speed`` is that of both together."""
    pull, share = of.strength * z, _unyielded(z, goes)
    rate = speed * of.stiffness * share / (1.0 + of.give * share)
    return Response(pull, rate, pull * (speed - of.give / of.stiffness * rate))


@inlined
def tendon(of, elongation, speed, slack, mode, goes):
    """Return the Response of a tendon, whose permanent elongation grows while it yields; or of a spring, which stays TAUT."""
    if mode == TAUT:
        return Response(tension(of, elongation, slack), 0.0, 0.0)
    return Response(0.0, 0.0, 0.0) if mode == SLACK else Response(of.strength, speed, of.strength * speed)


@inlined
def _braced(of, speed, pull):
    """Return the Response of a viscous damper behind a brace, whose force is its state."""
    slips = slip_rate(of, pull)
    return Response(pull, of.stiffness * (speed - slips), pull * slips)


@inlined
def _stop(of, elongation, speed, deepest, mode):
    """Return the Response of a stop by its ``mode``: on its elastic line (TAUT), open (SLACK), or in first loading."""
    if mode == TAUT:
        return Response(of.stiffness / of.returned * past_release(of, elongation, deepest), 0.0, 0.0)
    if mode == SLACK:
        return Response(0.0, 0.0, 0.0)
    pull = of.stiffness * (elongation - of.start)
    return Response(pull, 0.0, (1.0 - of.returned) * pull * speed)


@inlined
def response(of, elongation, speed, state, mode, goes):
    """Return the Response of an element in ``mode`` that ``goes`` OPENS, CLOSES or STICKS.

    ``state``: z of a hysteretic damper, permanent elongation [m] of a tendon, force [m/s²] of a braced viscous damper,
    greatest compression [m] of a stop.
    """
    if of.kind == VISCOUS and of.linear_below == math.inf:
        return linear(of, elongation, speed, state, mode, goes)  # a selection would compute the power, too
    if of.kind == VISCOUS:
        return viscous(of, elongation, speed, state, mode, goes)
    if of.kind == MAXWELL:
        return _braced(of, speed, state)
    if of.kind == CONTACT:
        return _stop(of, elongation, speed, state, mode)
    if of.kind == HYSTERETIC:
        return _braced_hysteretic(of, speed, state, goes)
    if of.kind == FRICTION:
        return friction(of, elongation, speed, state, mode, goes)
    return tendon(of, elongation, speed, state, mode, goes)


@kernel
def force(of, elongation, speed, state, mode, goes):
    """Return the force [m/s²] of an element; arguments are those of :func:`response`."""
    return response(of, elongation, speed, state, mode, goes).force


@kernel
def own_speed(of, speed, state):
    """Return the speed [m/s] of a damper without its brace, if it has one; ``speed`` is that of both together."""
    if of.kind == MAXWELL:
        return slip_rate(of, state)
    if of.give > 0.0:
        rate = response(of, 0.0, speed, state, TAUT, math.copysign(1.0, speed)).state_rate
        return speed - of.give / of.stiffness * rate
    return speed


@kernel
def stored(of, elongation, state):
    """Return the elastic energy [J/kg] of a tendon, stop, spring or damper's brace; 0 for dampers without one.

    A tendon stores nothing while slack, and without stiffness its prestress times the elongation, with its sign.
    """
    if of.kind == CONTACT:
        pull = stop_force(of, elongation, state)
        return 0.5 * pull * pull * of.returned / of.stiffness
    if of.kind == MAXWELL:
        return 0.5 * state * state / of.stiffness
    if of.kind == HYSTERETIC:
        return 0.5 * of.strength * state * state * of.give / of.stiffness
    if of.kind == SPRING:
        return 0.5 * of.stiffness * elongation * elongation
    if of.kind != TENDON:
        return 0.0
    pull = min(max(tension(of, elongation, state), 0.0), of.strength)
    return 0.5 * pull * pull / of.stiffness if of.stiffness > 0.0 else of.prestress * elongation


@kernel
def mode_of(of, elongation, state, goes):
    """Return the mode of a tendon or a stop at an ``elongation`` that ``goes`` OPENS or CLOSES; TAUT for other devices.

    A tendon is SLACK in compression, YIELDING from its strength on if it OPENS; a stop is SLACK if open, else in first loading,
    YIELDING. At zero force both are SLACK unless ``goes`` is OPENS, by which the elongation grows.
    """
    if of.kind == CONTACT:
        depth = elongation - of.start
        return SLACK if depth < 0.0 or (depth == 0.0 and goes != OPENS) else YIELDING
    if of.kind != TENDON:
        return TAUT
    pull = tension(of, elongation, state)
    if pull < 0.0 or (pull == 0.0 and goes != OPENS):
        return SLACK
    return YIELDING if pull >= of.strength and goes == OPENS else TAUT
