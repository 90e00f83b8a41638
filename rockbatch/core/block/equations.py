"""Equations of a pier on a rigid base: rocking about a pivot, flight, rest (THEORY.md, Rigid base)."""

from rockbatch.core import system
from rockbatch.core.block.model import Block, Rocker, Rocking, Stance, Tilt
from rockbatch.core.clock import Clearances
from rockbatch.core.kernel import hook, inlined
from rockbatch.core.trigonometry import flat_sine_and_cosine, sine_and_cosine


@inlined
def arms_about(m, theta, side):
    """Return ∂v/∂θ [m] of a block on its pivot on ``side``, and the height H [m] of its centre of mass above that pivot."""
    return _arms_by(m, sine_and_cosine(theta), side)


@inlined
def _arms_by(m, sines, side):
    """Return the results of :func:`arms_about` for sine and cosine of the rotation."""
    sine, cosine = sines
    b = side * m.half_width
    return b * cosine - m.height * sine, m.height * cosine + b * sine


@inlined
def tilt_acceleration(m, slope, lever, ground):
    """Return θ̈ [rad/s²] while rocking, without devices, from the arms about the pivot (THEORY.md, eq. 14)."""
    return -m.quickness * ((m.gravity + ground.vertical) * slope + ground.horizontal * lever)


@system.rates.of(Rocker)
def rocker_rates(m, y, side, ground):
    """Return the rates of a block that rocks about the pivot on ``side`` with |θ| ≤ FLAT, or rests if NEITHER."""
    sine, cosine = flat_sine_and_cosine(y.theta)
    b = side * m.half_width
    slope, arm = b * cosine - m.height * sine, m.height * cosine + b * sine
    return Tilt(y.omega, abs(side) * tilt_acceleration(m, slope, arm, ground))


@inlined
def side_of(contact):
    """Return the pivot about which the block rocks, NEITHER at rest and in flight."""
    return contact.right - contact.left


@inlined
def key_of(m, contact):
    """Return the position, −1 left to 1 right, of the key that guides the block in flight; a weighted mean for a frame."""
    return (1.0 - m.deck) * contact.bore + m.deck * contact.top


@inlined
def halves(m, top):
    """Return the distances of the left and the right pivot from the centre of mass [m], along the base.

    A frame's centre of mass moves along the base with the corner on which its deck rests.
    """
    return m.half_width * (1.0 - m.deck - m.deck * top), m.half_width * (1.0 - m.deck + m.deck * top)


@inlined
def arms(m, theta, top):
    """Return ∂(v_i − v)/∂θ [m] of the left pivot and of the right one at rotation ``theta``."""
    sine, cosine = sine_and_cosine(theta)
    left, right = halves(m, top)
    return left * cosine + m.height * sine, -right * cosine + m.height * sine


@inlined
def lost_by_deck(m):
    """Return the loss of the moment of inertia [m²] as a deck changes corners at θ = 0; 0 without a deck."""
    return 2.0 * m.deck * (1.0 - 2.0 * m.deck) * m.half_width * m.half_width


@system.shift.of(Block)
def shift(m, contact):
    """Return how far the middle of a frame's columns is to the right of that of its equivalent block [m]; 0 without a deck."""
    return m.half_width * m.deck * contact.top


@inlined
def on_pivot(m, theta, side):
    """Return v and ∂v/∂θ [m] of a block on its pivot on ``side``."""
    sine, cosine = sine_and_cosine(theta)
    drop = m.height * sine * sine / (1.0 + cosine)  # h (1 − cos θ), without the loss of digits
    b = side * m.half_width
    return b * sine - drop, b * cosine - m.height * sine


@inlined
def pull_down(pull):
    """Return the devices' force [m/s²] and moment [m²/s²]; zeros without devices."""
    if pull is None:
        return 0.0, 0.0
    return pull.force, pull.moment


@inlined
def _accelerations(m, y, contact, ground):
    """Return v̈ [m/s²] and θ̈ [rad/s²]: rocking (eq. 14), in flight with the key of the last pivot in contact, or at rest."""
    side = side_of(contact)
    down, back = pull_down(m.pull)
    if side != 0.0:
        slope, arm = arms_about(m, y.theta, side)
        turning = tilt_acceleration(m, slope, arm, ground) - m.quickness * (back + down * slope)
        return slope * turning - arm * y.omega * y.omega, turning
    if contact.left != 0.0:
        return 0.0, 0.0
    slope, arm = arms_about(m, y.theta, key_of(m, contact))
    turning = -(arm * slope * y.omega * y.omega + arm * ground.horizontal + back) / (m.inertia + arm * arm)
    return -m.gravity - ground.vertical - down, turning


@system.rates.of(Block)
def rates(m, y, contact, ground):
    """Return the rates of state ``y``: the right-hand side."""
    v_acceleration, theta_acceleration = _accelerations(m, y, contact, ground)
    return Rocking(y.v_rate, y.omega, v_acceleration, theta_acceleration)


@hook
def constrained(m, y, contact):
    """Return ``y`` with v and v̇ that follow from θ about the pivot on the ground; unchanged in flight and at rest."""


@constrained.of(Block)
def _constrained_block(m, y, contact):
    side = side_of(contact)
    if side == 0.0:
        return y
    v, slope = on_pivot(m, y.theta, side)
    return Rocking(v, y.theta, slope * y.omega, y.omega)


@system.sines_in_pass.of(Block)
def sines_in_pass(m, angle):
    """Return sine and cosine of a rotation for |θ| ≤ FLAT = 0.75 rad; sub-steps beyond it do not stand."""
    return flat_sine_and_cosine(angle)


@system.rates_and_power.of(Block)
def rates_and_power(m, y, contact, ground, at):
    """Return rates and ground power of a block that rocks about a pivot or rests."""
    side = side_of(contact)
    slope, arm = _arms_by(m, (at.sine, at.cosine), side)
    down, back = pull_down(m.pull)
    turning = abs(side) * (tilt_acceleration(m, slope, arm, ground) - m.quickness * (back + down * slope))
    power = -ground.horizontal * arm * y.omega - ground.vertical * y.v_rate
    return Rocking(y.v_rate, y.omega, slope * turning - arm * y.omega * y.omega, turning), power


@system.end_step.of(Block)
def end_step(m, y, start, contact, remaining):
    """Return the end of a step, projected onto the pivot that is on the ground."""
    return constrained(m, y, contact)


@inlined
def lever(m, y, contact):
    """Return H [m], the height of the centre of mass above the pivot in contact, or last in contact."""
    side = side_of(contact)
    return arms_about(m, y.theta, side if side != 0.0 else key_of(m, contact))[1]


@system.ground_power.of(Block)
def ground_power(m, y, contact, ground):
    """Return the power of the ground's inertia forces [W/kg]."""
    return -ground.horizontal * lever(m, y, contact) * y.omega - ground.vertical * y.v_rate


@hook
def normal_force(m, y, k, vertical):
    """Return N/M [m/s²] of the ground on a block that rocks with rates ``k``, at the ground's acceleration ``vertical`` [m/s²].

    See THEORY.md, Flight on the rigid base.
    """


@normal_force.of(Block)
def _normal_of_block(m, y, k, vertical):
    return m.gravity + vertical + k.v_rate + pull_down(m.pull)[0]


@inlined
def clearances(m, y, top):
    """Return the Clearances of both pivots above the ground."""
    sine, cosine = sine_and_cosine(y.theta)
    drop = m.height * sine * sine / (1.0 + cosine)
    arm_left, arm_right = arms(m, y.theta, top)
    left, right = halves(m, top)
    speed_left, speed_right = y.v_rate + arm_left * y.omega, y.v_rate + arm_right * y.omega
    return Clearances(y.v + left * sine + drop, y.v - right * sine + drop, speed_left, speed_right)


@inlined
def on_side(side):
    """Return the Stance of a block that rocks about its pivot on ``side``."""
    return Stance(0.5 * (1.0 - side), 0.5 * (1.0 + side), side, side)
