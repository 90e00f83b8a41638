"""Equations of the block on a rigid base: rocking, the ground's push at rest, and the bounces that are left."""

import math

from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.trigonometry import sine_and_cosine
from rockbatch.core.types import LEFT, RIGHT, Ground, Rocking


@inlined
def acceleration(m, theta, side, horizontal, vertical):
    """θ̈ [rad/s²] while rocking about the corner on ``side`` (LEFT or RIGHT) (THEORY.md, eq. 14)."""
    sine, cosine = sine_and_cosine(side * m.alpha - theta)
    return -m.p * m.p / m.gravity * ((m.gravity + vertical) * sine + horizontal * cosine)


@inlined
def rocking_step(m, y, k1, ground, h):
    """One Runge–Kutta step of order 4 from ``y`` over ``h`` [s]; ``k1`` is θ̈ at its start."""
    half = 0.5 * h
    a_middle = ground.horizontal + half * ground.horizontal_slope
    c_middle = ground.vertical + half * ground.vertical_slope
    omega2 = y.omega + half * k1
    k2 = acceleration(m, y.theta + half * y.omega, y.side, a_middle, c_middle)
    omega3 = y.omega + half * k2
    k3 = acceleration(m, y.theta + half * omega2, y.side, a_middle, c_middle)
    omega4 = y.omega + h * k3
    a_end = ground.horizontal + h * ground.horizontal_slope
    c_end = ground.vertical + h * ground.vertical_slope
    k4 = acceleration(m, y.theta + h * omega3, y.side, a_end, c_end)
    sixth = h / 6.0
    return Rocking(
        y.theta + sixth * (y.omega + 2.0 * (omega2 + omega3) + omega4),
        y.omega + sixth * (k1 + 2.0 * (k2 + k3) + k4),
        y.side,
    )


@inlined
def later(ground, x):
    """The ground ``x`` [s] later, as long as it is linear in time."""
    return Ground(
        ground.horizontal + x * ground.horizontal_slope,
        ground.horizontal_slope,
        ground.vertical + x * ground.vertical_slope,
        ground.vertical_slope,
    )


@kernel
def lift_off(m, ground, h):
    """Time in [0, h] from which the ground overcomes |ü_g| = (g + v̈_g) tan α, −1 if it does not; and the corner.

    Exact, since the ground acceleration is linear in time. A positive ü_g throws the block to the left.
    """
    sine, cosine = sine_and_cosine(m.alpha)
    tangent = sine / cosine
    first, side = -1.0, 0.0
    for corner in (RIGHT, LEFT):
        excess = -corner * ground.horizontal - (m.gravity + ground.vertical) * tangent
        slope = -corner * ground.horizontal_slope - ground.vertical_slope * tangent
        at = -1.0
        if excess > 0.0 or (excess == 0.0 and slope > 0.0):
            at = 0.0
        elif slope > 0.0 and excess + slope * h > 0.0:
            at = min(-excess / slope, h)
        if at >= 0.0 and (first < 0.0 or at < first):
            first, side = at, corner
    return first, side


@kernel
def carried_until(m, ground, h):
    """Time in [0, h] at which the ground falls away from under the block, v̈_g = −g; infinite if it does not."""
    if min(ground.vertical, ground.vertical + h * ground.vertical_slope) > -m.gravity:
        return math.inf
    return 0.0 if ground.vertical <= -m.gravity else (-m.gravity - ground.vertical) / ground.vertical_slope


@kernel
def time_to_rest(m, omega, horizontal, vertical):
    """Height [rad] of the next bounce, and the time [s] of all that are left (Zeno), if the ground allows rest.

    Small bounces see constant accelerations κ± towards rest on either side, take 2 θ̇/κ± each, and shrink by e.
    Infinite where there is no rest.
    """
    speed = abs(omega)
    here = RIGHT if omega > 0.0 else LEFT
    towards = -here * acceleration(m, 0.0, here, horizontal, vertical)
    back = here * acceleration(m, 0.0, -here, horizontal, vertical)
    if towards <= 0.0 or back <= 0.0 or m.restitution == 1.0:
        return math.inf, math.inf
    total = 2.0 * speed * (1.0 / towards + m.restitution / back)
    return 0.5 * speed * speed / min(towards, back), total / (1.0 - m.restitution * m.restitution)
