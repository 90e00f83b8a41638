"""Equations of motion of the pier on a footing, once for all states of contact and both kinematics (THEORY.md, A footing)."""

from typing import NamedTuple

from rockbatch.core import system
from rockbatch.core.footing.model import Footing, State
from rockbatch.core.footing.strips import pressed_middle, push, sinking, stored
from rockbatch.core.kernel import inlined, kernel
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
    """Return v̈ [m/s²] and θ̈ [rad/s²] of state ``y`` on a bed with this Push."""
    at = lever(m, y)
    v_acceleration = bed.force - m.gravity - ground.vertical
    moment = bed.force * at.lean - at.cosine * bed.moment - at.length * ground.horizontal
    effective = m.height
    if m.finite is not None:
        effective = at.length
        moment -= at.length * at.slope * y.omega * y.omega
    v_acceleration, moment = with_forces(m.pull, v_acceleration, moment)
    return v_acceleration, moment * (1.0 / (m.inertia + effective * effective))


@system.rates.of(Footing)
def rates(m, y, contact, ground):
    """Return the right-hand side: the rates of all state variables."""
    v_acceleration, theta_acceleration = accelerations(m, y, push(m, sinking(m, y)), ground)
    return State(y.v_rate, y.omega, v_acceleration, theta_acceleration)


@system.ground_power.of(Footing)
def ground_power(m, y, contact, ground):
    """Return the power of the ground's inertia forces [W/kg]."""
    length = lever(m, y).length
    return -ground.horizontal * length * y.omega - ground.vertical * y.v_rate


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
    """Return the kinetic energy, the potential energy g v and the elastic energy of the bed in state ``y`` [J/kg]."""
    d = sinking(m, y)
    arm = m.height if m.finite is None else lever(m, y).length
    kinetic = 0.5 * (y.v_rate * y.v_rate + (m.inertia + arm * arm) * y.omega * y.omega)
    return kinetic, m.gravity * y.v, stored(m, d)
