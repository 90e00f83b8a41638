"""Equations of motion of the pier on a footing, once for all states of contact and both kinematics (THEORY.md, A footing).

Of a pier whose shaft bends in one kinematics (A shaft that bends).
"""

from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.flexure.ending import hanging
from rockbatch.core.flexure.equations import flexing
from rockbatch.core.flexure.model import Shaft
from rockbatch.core.flexure.modes import deflection_rates, scaled
from rockbatch.core.flexure.shaft import accelerations_over, energies_of_modes, power_of_ground
from rockbatch.core.footing.model import Footing, State
from rockbatch.core.footing.strips import pressed_middle, push, sinking, stored
from rockbatch.core.kernel import hook, inlined, kernel
from rockbatch.core.springs.equations import with_forces
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import STEP, Signals, Transition


class Lever(NamedTuple):
    """Lever of the ground's horizontal acceleration, and arms of the bed's push about the centre of mass."""

    length: float  # H [m]
    slope: float  # dH/dθ [m]
    lean: float  # arm of the whole push [m]: hθ, or h sin θ
    cosine: float  # by which the push's moment about the middle counts


@inlined
def lever(m, y):
    """Return the Lever in state ``y``; with ``shifting`` its length and slope are about the :func:`pressed_middle`."""
    if m.finite is None:
        length = m.height
        if m.shifting is not None:
            length += pressed_middle(m, sinking(m, y)) * y.theta
        return Lever(length, 0.0, m.height * y.theta, 1.0)
    s, c = sine_and_cosine(y.theta)
    length, slope = m.height * c, -m.height * s
    if m.shifting is not None:
        x = pressed_middle(m, sinking(m, y))
        length, slope = length + x * s, slope + x * c
    return Lever(length, slope, m.height * s, c)


@inlined
def accelerations(m, y, bed, ground):
    """Return v̈ [m/s²] and θ̈ [rad/s²] of state ``y`` of a pier with a rigid shaft on a bed with this Push."""
    at = lever(m, y)
    v_acceleration = bed.force - m.gravity - ground.vertical
    moment = bed.force * at.lean - at.cosine * bed.moment - at.length * ground.horizontal
    effective = m.height
    if m.finite is not None:
        effective = at.length
        moment -= at.length * at.slope * y.omega * y.omega
    v_acceleration, moment = with_forces(m.pull, v_acceleration, moment)
    return v_acceleration, moment * (1.0 / (m.inertia + effective * effective))


@inlined
def bent_accelerations(m, y, bed, ground):
    """Return the Accelerations of state ``y`` of a pier whose shaft bends, on a bed with this Push."""
    at = lever(m, y)
    moment = bed.force * at.lean - at.cosine * bed.moment
    up, moment = with_forces(m.pull, bed.force - m.gravity - ground.vertical, moment)
    return accelerations_over(m, y, at.length, at.slope, up, moment, ground)


@hook
def rates_under(shaft, m, y, bed, ground):
    """Return the rates of state ``y`` on a bed with this Push; ``shaft`` is that of ``m``, None if it is rigid."""


@rates_under.of(type(None))
def _rigid_rates(shaft, m, y, bed, ground):
    v_acceleration, theta_acceleration = accelerations(m, y, bed, ground)
    return State(y.v_rate, y.omega, v_acceleration, theta_acceleration)


@rates_under.of(Shaft)
def _bent_rates(shaft, m, y, bed, ground):
    k = bent_accelerations(m, y, bed, ground)
    return flexing(y.v_rate, y.omega, k.v, k.theta, deflection_rates(y), k.u)


@system.rates.of(Footing)
def rates(m, y, contact, ground):
    """Return the right-hand side: the rates of all state variables."""
    return rates_under(m.shaft, m, y, push(m, sinking(m, y)), ground)


@hook
def at_rest(shaft, m, v, theta):
    """Return the state at rest at ``v`` [m] and ``theta`` [rad]: a ``shaft`` that bends hangs over under its weight."""


@at_rest.of(type(None))
def _straight_at_rest(shaft, m, v, theta):
    return State(v, theta, 0.0, 0.0)


@at_rest.of(Shaft)
def _bent_at_rest(shaft, m, v, theta):
    u = hanging(shaft, m.gravity * sine_and_cosine(theta)[0])
    return flexing(v, theta, 0.0, 0.0, u, scaled(u, 0.0))


@system.ground_power.of(Footing)
def ground_power(m, y, contact, ground):
    """Return the power of the ground's inertia forces [W/kg]."""
    return power_of_ground(m.shaft, m, y, lever(m, y).length, ground)


@system.airborne.of(Footing)
def airborne(m, contact):
    """Return whether the foot is in the air: no part of it is pressed."""
    return contact.clear != 0.0


@system.event_functions.of(Footing)
def event_functions(m, devices, now):
    """Return Signals of 1 with slopes of 0: nothing jumps on a bed, and no event is searched for."""
    return Signals(1.0, 1.0, 1.0, 1.0), Signals(0.0, 0.0, 0.0, 0.0)


@system.transition.of(Footing)
def transition(m, devices, now, which, ground, dt):
    """Return the Moment ``now`` unchanged, as a Transition without counts: no event occurs on a bed."""
    return Transition(now, STEP, 0.0, 0.0, 0.0)


@kernel
def energies(m, y):
    """Return the kinetic energy, the potential one of the weight, and the elastic one of bed and shaft in state ``y`` [J/kg]."""
    d = sinking(m, y)
    arm = m.height if m.finite is None else lever(m, y).length
    kinetic = 0.5 * (y.v_rate * y.v_rate + (m.inertia + arm * arm) * y.omega * y.omega)
    by_motion, by_height, by_bending = energies_of_modes(m.shaft, m, y, arm)
    return kinetic + by_motion, m.gravity * y.v + by_height, stored(m, d) + by_bending
