"""When within a step a block is back on both corners."""

from rockbatch.core.kernel import inlined, kernel
from rockbatch.core.rigid.equations import rocking_step
from rockbatch.core.roots import BISECT_AFTER, CLOSE, TRIALS, falls

CORRECTIONS = 5
"""Of Newton's method, which doubles the digits with each: two trials are the rule, three have always been enough."""


@inlined
def inner_points(y, end, h):
    """Tilt towards the block's corner [rad] at the inner two of the four Bézier points of the cubic from ``y`` to ``end``.

    A cubic lies between the least and the greatest of its Bézier points: those at its ends, and at a third and two
    thirds of ``h`` [s] on the tangents of the ends.
    """
    third = h * (1.0 / 3.0)
    return y.side * (y.theta + third * y.omega), y.side * (end.theta - third * end.omega)


@inlined
def stays(y, end, h):
    """Whether the block surely keeps its corner on the way; it may start at the moment of an impact."""
    early, late = inner_points(y, end, h)
    return y.side * y.theta >= 0.0 and min(min(early, late), y.side * end.theta) > 0.0


@kernel
def landing(m, y, k1, ground, h, end):
    """Time in [0, h] at which the block is back, −1 if it is not, and its state then, or at the ``end`` of the step.

    The root of the cubic through both ends is corrected by Newton's method, whose function is the Runge–Kutta step itself.
    What touches down without velocity, or leaves and comes back at once, is searched for between its ends.
    """
    at = falls(y.side * y.theta, y.side * y.omega, y.side * end.theta, y.side * end.omega, h)
    if at < 0.0:
        return at, end
    x = at
    for _ in range(CORRECTIONS):
        if not CLOSE * h < x <= h:
            break
        trial = rocking_step(m, y, k1, ground, x)
        if y.side * trial.omega >= 0.0:
            break
        correction = -trial.theta / trial.omega
        if abs(correction) <= CLOSE * h:
            return x, trial
        x += correction
    return _search(m, y, k1, ground, h, end, at)


@kernel
def _search(m, y, k1, ground, h, end, at):
    """As :func:`landing`, from the root ``at`` of the cubic, by cubics through ever closer ends."""
    a, f_a, d_a = 0.0, y.side * y.theta, y.side * y.omega
    b, f_b, d_b = h, y.side * end.theta, y.side * end.omega
    for trial in range(TRIALS):
        if at < 0.0 or at <= CLOSE * h:
            break
        x = a + at if trial < BISECT_AFTER or trial % 2 == 0 else 0.5 * (a + b)
        tried = rocking_step(m, y, k1, ground, x)
        f_x, d_x = y.side * tried.theta, y.side * tried.omega
        if falls(f_a, d_a, f_x, d_x, x - a) >= 0.0:
            b, f_b, d_b = x, f_x, d_x
        else:
            a, f_a, d_a = x, f_x, d_x
        at = falls(f_a, d_a, f_b, d_b, b - a)
        if at >= 0.0 and abs(a + at - x) <= CLOSE * h:
            return x, tried
    if at < 0.0:
        return -1.0, end
    return a + at, rocking_step(m, y, k1, ground, a + at)
