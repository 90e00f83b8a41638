"""A block on rigid ground by Taylor series, whose zero crossings are certain: thousands of records in a minute.

The equations are those of THEORY.md (Rigid base), written anew. Where the ground is linear in time, the solution is expanded
to order 20 about the start of a sub-step. What may happen (impact, take-off, landing, reversal) is the first zero of a
polynomial, and its Bernstein coefficients prove where it has none: nothing happens unseen, however briefly. Zeros at the start
of a sub-step, where an event has just been, are divided out.

All compiled functions are in this file, because Numba's cache on disk sees changes of one file only.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from rockbatch.motions import Motion
from rockbatch.pier import Pier, RigidBase

ORDER = 20
COLUMNS = ORDER + 1
HORIZON = 400.0  # s after the motion
TRUNCATED = 1e-18  # of α: largest last term of a series
LONGEST = 0.5  # of 1/p: longest sub-step
LOWEST = 1e-20  # of α: height of the bounces that are summed up instead of followed
NO_ACCELERATION = 1e-12  # of g: rounding
DEPTH = 60  # halvings of a sub-step in the search for a zero
MOST_STEPS = 3_000_000
STATUS = ("stands", "overturned", "exhausted")
STANDS, OVERTURNED, EXHAUSTED = range(3)
REST, ROCKS, FLIES = range(3)
NOTHING, IMPACT, TAKE_OFF, LANDS_LEFT, LANDS_RIGHT, REVERSAL, FALLEN = range(7)

kernel = njit(cache=True, nogil=True, error_model="numpy")


class Truth(NamedTuple):
    """What a run comes to; angles in rad, times in s.

    ``status`` is "stands", "overturned" (|θ| = π/2, ever) or "exhausted" (too many sub-steps: no truth). ``decided``: the energy
    left after the motion cannot exceed ``theta_max`` any more.
    """

    status: str
    theta_max: float
    t_max: float
    t_end: float
    impacts: int
    flights: int
    decided: bool
    steps: int


class Block(NamedTuple):
    """A pier as the equations have it."""

    alpha: float
    p: float
    gravity: float
    size: float  # R0 [m]
    half_width: float
    height: float
    inertia: float  # I0/M [m²]
    share: float  # k = μ/(1+μ)
    restitution: float


class Series(NamedTuple):
    """Taylor coefficients at the start of a sub-step, and room for the search."""

    theta: np.ndarray
    omega: np.ndarray
    sine: np.ndarray  # of α s − θ while it rocks, of θ in flight
    cosine: np.ndarray
    normal: np.ndarray  # N/M while it rocks
    left: np.ndarray  # height of a pivot in flight
    right: np.ndarray
    work: np.ndarray  # shape (5, COLUMNS)
    stack: np.ndarray  # shape (DEPTH + 2, COLUMNS)
    ends: np.ndarray  # shape (DEPTH + 2, 2)


class State(NamedTuple):
    """State between events.

    In flight ``gap`` is the height of the pivot ``side``: the one that bore last, after rest the right one.
    """

    mode: int
    side: int  # −1 L, 1 R: about which it rocks, or whose height is kept
    bore: int  # in flight, the pivot whose key keeps its place; 0 after rest
    theta: float
    omega: float
    gap: float
    gap_rate: float


class Ground(NamedTuple):
    """ü_g and v̈_g [m/s²] at the start of a sub-step, and their rates."""

    across: float
    across_rate: float
    up: float
    up_rate: float


class Record(NamedTuple):
    """The largest rotation so far, and counts."""

    theta_max: float
    t_max: float
    impacts: int
    flights: int
    steps: int


@kernel
def value(series, t):
    """Return a series at ``t``."""
    total = 0.0
    for k in range(ORDER, -1, -1):
        total = total * t + series[k]
    return total


@kernel
def product(a, b, k):
    """Return coefficient ``k`` of the product of two series."""
    total = 0.0
    for j in range(k + 1):
        total += a[j] * b[k - j]
    return total


@kernel
def extend_circle(angle, sine, cosine, k):
    """Write coefficient ``k`` ≥ 1 of sine and cosine of the series ``angle``."""
    s = c = 0.0
    for j in range(1, k + 1):
        s += j * angle[j] * cosine[k - j]
        c -= j * angle[j] * sine[k - j]
    sine[k], cosine[k] = s / k, c / k


@kernel
def expand_rocking(block, y, ground, series):
    """Expand θ̈ = −p² [(1 + v̈_g/g) sin ψ + ü_g/g cos ψ], ψ = s α − θ, about the pivot on side s."""
    theta, sine, cosine, angle = series.theta, series.sine, series.cosine, series.work[0]
    theta[0], theta[1] = y.theta, y.omega
    angle[0], angle[1] = y.side * block.alpha - y.theta, -y.omega
    sine[0], cosine[0] = math.sin(angle[0]), math.cos(angle[0])
    weight, weight_rate = 1.0 + ground.up / block.gravity, ground.up_rate / block.gravity
    across, across_rate = ground.across / block.gravity, ground.across_rate / block.gravity
    for k in range(ORDER - 1):
        if k > 0:
            extend_circle(angle, sine, cosine, k)
        pull = weight * sine[k] + across * cosine[k]
        if k > 0:
            pull += weight_rate * sine[k - 1] + across_rate * cosine[k - 1]
        theta[k + 2] = -(block.p**2) * pull / ((k + 1) * (k + 2))
        angle[k + 2] = -theta[k + 2]
    if y.theta == 0.0 and y.omega == 0.0 and abs(theta[2]) < NO_ACCELERATION * block.p**2:
        theta[2] = 0.0  # lifted by a ground that grows
    for k in range(ORDER):
        series.omega[k] = (k + 1) * theta[k + 1]
    series.omega[ORDER] = 0.0


@kernel
def expand_normal(block, y, ground, series):
    """Expand N/M = (g + v̈_g)(1 − k sin²φ) − s k ü_g sin φ cos φ − R cos φ θ̇², φ = α − |θ|."""
    sine, cosine, omega = series.sine, series.cosine, series.omega
    down, across, squared = series.work[1], series.work[2], series.work[3]
    for k in range(ORDER - 1, COLUMNS):
        extend_circle(series.work[0], sine, cosine, k)
    for k in range(COLUMNS):
        down[k] = (1.0 if k == 0 else 0.0) - block.share * product(sine, sine, k)
        across[k] = -block.share * product(sine, cosine, k)
        squared[k] = product(omega, omega, k)
    for k in range(COLUMNS):
        n = (block.gravity + ground.up) * down[k] + ground.across * across[k] - block.size * product(cosine, squared, k)
        if k > 0:
            n += ground.up_rate * down[k - 1] + ground.across_rate * across[k - 1]
        series.normal[k] = n


@kernel
def expand_flight(block, y, ground, series):
    """Expand v̈ = −g − v̈_g and (I0 + H²) θ̈ = −H (H' θ̇² + ü_g), H = h cos θ + s b sin θ, and the heights of both pivots."""
    theta, omega, sine, cosine = series.theta, series.omega, series.sine, series.cosine
    lever, slope, squared = series.work[0], series.work[1], series.work[2]
    turned, inertia = series.work[3], series.work[4]
    h, b = block.height, block.half_width
    theta[0], theta[1] = y.theta, y.omega
    sine[0], cosine[0] = math.sin(y.theta), math.cos(y.theta)
    for k in range(COLUMNS):
        if k > 0:
            extend_circle(theta, sine, cosine, k)
        lever[k] = h * cosine[k] + y.bore * b * sine[k]
        slope[k] = -h * sine[k] + y.bore * b * cosine[k]
        omega[k] = (k + 1) * theta[k + 1] if k < ORDER else 0.0
        if k > ORDER - 2:
            continue
        squared[k] = product(omega, omega, k)
        turned[k] = product(slope, squared, k)
        turned[k] += ground.across if k == 0 else (ground.across_rate if k == 1 else 0.0)
        inertia[k] = product(lever, lever, k) + (block.inertia if k == 0 else 0.0)
        rest = -product(lever, turned, k)
        for j in range(1, k + 1):
            rest -= inertia[j] * (k - j + 1) * (k - j + 2) * theta[k - j + 2]
        theta[k + 2] = rest / inertia[0] / ((k + 1) * (k + 2))
    near, far = (series.left, series.right) if y.side < 0 else (series.right, series.left)
    near[0], near[1] = y.gap, y.gap_rate
    for k in range(2, COLUMNS):  # v_i = v − s b sin θ + h (1 − cos θ)
        near[k] = -y.side * b * sine[k] - h * cosine[k]
    near[2] -= 0.5 * (block.gravity + ground.up)
    near[3] -= ground.up_rate / 6.0
    if y.gap == 0.0 and y.gap_rate == 0.0 and abs(near[2]) < NO_ACCELERATION * block.gravity:
        near[2] = 0.0  # N falls through zero
    for k in range(COLUMNS):
        far[k] = near[k] + 2.0 * y.side * b * sine[k]


@kernel
def polished(a, low, high):
    """Return the zero in [low, high] of the polynomial ``a``, positive before it and negative after it."""
    x = 0.5 * (low + high)
    for _ in range(200):
        f = slope = 0.0
        for k in range(ORDER, -1, -1):
            slope = slope * x + f
            f = f * x + a[k]
        if f > 0.0:
            low = x
        else:
            high = x
        new = x - f / slope if slope != 0.0 else low
        if not low < new < high:
            new = 0.5 * (low + high)
        if abs(new - x) <= 2e-16 * abs(x) or new in (low, high):
            return new
        x = new
    return x


@kernel
def bernstein(a, degree, b):
    """Write the Bernstein coefficients on [0, 1] of the polynomial ``a``."""
    for i in range(degree + 1):
        b[i] = a[i]
    ratio = 1.0
    for j in range(1, degree + 1):  # c_j / C(n, j), then summed up: Pascal's triangle
        ratio *= (degree - j + 1) / j
        b[j] /= ratio
    for j in range(1, degree + 1):
        for i in range(degree, j - 1, -1):
            b[i] += b[i - 1]


@kernel
def sign_changes(b, degree):
    """Return how often the coefficients change sign, and the first sign that is not 0."""
    changes, first, last = 0, 0, 0
    for i in range(degree + 1):
        sign = 1 if b[i] > 0.0 else (-1 if b[i] < 0.0 else 0)
        if sign != 0:
            first = sign if first == 0 else first
            changes += 1 if last != 0 and sign != last else 0
            last = sign
    return changes, first


@kernel
def halve(b, degree, left):
    """Split Bernstein coefficients at the middle by de Casteljau: ``b`` keeps the right half."""
    for i in range(degree + 1):
        left[i] = b[0]
        for j in range(degree - i):
            b[j] = 0.5 * (b[j] + b[j + 1])
    # b[j] holds the last point of diagonal j: the right half, in order


@kernel
def first_fall(poly, h, series):
    """Return when, in [0, h], a polynomial first is below zero; −1 if never. Zeros at the start are divided out."""
    a, b, stack, ends = series.work[4], series.stack[0], series.stack, series.ends
    lead = 0
    while lead < COLUMNS and poly[lead] == 0.0:
        lead += 1
    if lead == COLUMNS:
        return -1.0
    if poly[lead] < 0.0:
        return 0.0
    degree, power, negative = ORDER - lead, 1.0, 0.0
    a[:] = 0.0
    for k in range(degree + 1):
        a[k] = poly[lead + k] * power
        power *= h
        negative += min(a[k], 0.0)
    if a[0] + negative > 0.0:
        return -1.0
    bernstein(a, degree, b)
    top = 0
    ends[0, 0], ends[0, 1] = 0.0, 1.0
    while top >= 0:
        low, width = ends[top, 0], ends[top, 1]
        changes, first = sign_changes(stack[top], degree)
        if first < 0:
            return low * h
        if changes == 0:
            top -= 1
        elif changes == 1:
            return polished(a, low, low + width) * h
        elif top >= DEPTH or width < 1e-15 * low:
            if stack[top, degree] < 0.0:
                return (low + width) * h
            top -= 1
        else:
            halve(stack[top], degree, stack[top + 1])
            ends[top + 1, 0], ends[top + 1, 1] = low, 0.5 * width
            ends[top, 0], ends[top, 1] = low + 0.5 * width, 0.5 * width
            top += 1
    return -1.0


@kernel
def largest(poly, h):
    """Return a bound of a series' magnitude within ``h``."""
    total, power = 0.0, 1.0
    for k in range(COLUMNS):
        total += abs(poly[k]) * power
        power *= h
    return total


@kernel
def surely_pressed(block, y, ground, h):
    """Return whether a bound on N shows that a rocking block stays on its pivot for ``h``."""
    g = block.gravity
    up_end, across_end = ground.up + h * ground.up_rate, ground.across + h * ground.across_rate
    across, weight = max(abs(ground.across), abs(across_end)), g + max(ground.up, up_end)
    fastest = abs(y.omega) + h * block.p**2 * (max(abs(weight), abs(g + min(ground.up, up_end))) + across) / g
    steep = min(abs(block.alpha - abs(y.theta)) + h * fastest, 1.0)
    least = g + min(ground.up, up_end)
    return least * (1.0 - block.share * steep**2) > block.share * across * steep + block.size * fastest**2


@kernel
def next_of_rocking(block, y, ground, h, peak, series):
    """Return what happens first to a rocking block within ``h``, and when."""
    which, when = NOTHING, h
    outward = series.left  # free while it rocks
    for k in range(COLUMNS):
        outward[k] = y.side * series.theta[k]
    at = first_fall(outward, when, series)
    if at >= 0.0:
        which, when = IMPACT, at
    if not surely_pressed(block, y, ground, h):
        expand_normal(block, y, ground, series)
        at = 0.0 if series.normal[0] <= 0.0 else first_fall(series.normal, when, series)
        if at >= 0.0:
            which, when = TAKE_OFF, at
    return turning(y, when, which, peak, series)


@kernel
def turning(y, when, which, peak, series):
    """Return a reversal of θ̇ that may be the peak, or |θ| = π/2, if earlier than event ``which``; and when."""
    most = largest(series.theta, when)
    outward = series.left if y.mode == ROCKS else series.normal
    if most > peak and y.omega != 0.0:
        sign = 1.0 if y.omega > 0.0 else -1.0
        for k in range(COLUMNS):
            outward[k] = sign * series.omega[k]
        at = first_fall(outward, when, series)
        if at >= 0.0:
            which, when = REVERSAL, at
    elif most > peak:
        for side in (-1.0, 1.0):
            for k in range(COLUMNS):
                outward[k] = side * series.omega[k]
            if outward[1] > 0.0 or (outward[1] == 0.0 and outward[2] > 0.0):
                at = first_fall(outward, when, series)
                if at >= 0.0:
                    which, when = REVERSAL, at
    if most >= 0.5 * math.pi:
        for side in (-1.0, 1.0):
            for k in range(COLUMNS):
                outward[k] = -side * series.theta[k]
            outward[0] += 0.5 * math.pi
            at = first_fall(outward, when, series)
            if at >= 0.0:
                which, when = FALLEN, at
    return which, when


@kernel
def next_of_flight(y, h, peak, series):
    """Return what happens first to a flying block within ``h``, and when."""
    which, when = NOTHING, h
    at = first_fall(series.left, when, series)
    if at >= 0.0:
        which, when = LANDS_LEFT, at
    at = first_fall(series.right, when, series)
    if at >= 0.0 and (which == NOTHING or at < when):
        which, when = LANDS_RIGHT, at
    return turning(y, when, which, peak, series)


@kernel
def normal_force(block, side, theta, omega, ground):
    """Return N/M of a block that rocks about the pivot on ``side``."""
    phi = block.alpha - side * theta
    sine, cosine = math.sin(phi), math.cos(phi)
    force = (block.gravity + ground.up) * (1.0 - block.share * sine**2)
    return force - side * block.share * ground.across * sine * cosine - block.size * cosine * omega**2


@kernel
def from_rest(block, ground):
    """Return the state of a block at rest, or lifted by the ground of this instant."""
    grip = (block.gravity + ground.up) * math.tan(block.alpha)
    left, right = ground.across > grip, -ground.across > grip
    if not (left or right):
        return State(REST, 0, 0, 0.0, 0.0, 0.0, 0.0)
    return lifted(block, -1 if left else 1, ground)


@kernel
def lifted(block, side, ground):
    """Return the state of a block that leaves rest about ``side``, or with both pivots where nothing presses on that one."""
    if normal_force(block, side, 0.0, 0.0, ground) > 1e-9 * block.gravity:
        return State(ROCKS, side, 0, 0.0, 0.0, 0.0, 0.0)
    return State(FLIES, 1, 0, 0.0, 0.0, 0.0, 0.0)


@kernel
def after_impact(block, side, omega, ground, left):
    """Return the state after θ = 0 with ``omega``, about the pivot on ``side`` from there on."""
    omega *= block.restitution
    if omega * side <= 0.0:
        return from_rest(block, ground)
    weight = (1.0 + ground.up / block.gravity) * math.sin(block.alpha)
    across = ground.across / block.gravity * math.cos(block.alpha)
    slow, back = block.p**2 * (weight + side * across), block.p**2 * (weight - side * across)
    if slow > 0.0 and back > 0.0 and block.restitution < 1.0:
        height, speed = 0.5 * omega**2 / min(slow, back), abs(omega)
        if height < LOWEST * block.alpha and 2.0 * speed / min(slow, back) / (1.0 - block.restitution) < 0.01 * left:
            return State(REST, 0, 0, 0.0, 0.0, 0.0, 0.0)
    return State(ROCKS, side, 0, 0.0, omega, 0.0, 0.0)


@kernel
def after_landing(block, y, pivot, series, t, ground):
    """Return the state after ``pivot`` lands (−1 L, 1 R): its velocity is gone, angular momentum about it is kept."""
    h, b = block.height, block.half_width
    theta, omega = value(series.theta, t), value(series.omega, t)
    sine, cosine = math.sin(theta), math.cos(theta)
    mine, other = (series.left, series.right) if pivot < 0 else (series.right, series.left)
    gap, rate, other_rate = value(other, t), 0.0, 0.0
    for k in range(ORDER, 0, -1):
        rate, other_rate = rate * t + k * mine[k], other_rate * t + k * other[k]
    if abs(gap) <= 1e-12 * b and other_rate < 0.0:
        return from_rest(block, ground)
    arm = -pivot * b * cosine + h * sine
    before, after = h * cosine + y.bore * b * sine, h * cosine + pivot * b * sine
    omega = ((block.inertia + after * before) * omega - arm * (rate - arm * omega)) / (block.inertia + block.size**2)
    theta = theta if pivot * theta > 0.0 else 0.0
    if normal_force(block, pivot, theta, omega, ground) <= 0.0:
        return State(FLIES, pivot, pivot, theta, omega, 0.0, 0.0)
    return State(ROCKS, pivot, 0, theta, omega, 0.0, 0.0)


@kernel
def leave_rest(block, ground, h):
    """Return the time until a block at rest is lifted, ``h`` if it stays, and about which pivot."""
    tangent = math.tan(block.alpha)
    when, side = h, 0
    for way in (-1, 1):
        now = -way * ground.across - (block.gravity + ground.up) * tangent
        rate = -way * ground.across_rate - ground.up_rate * tangent
        at = 0.0 if now > 0.0 or (now == 0.0 and rate > 0.0) else (-now / rate if rate > 0.0 else math.inf)
        if at < when:
            when, side = at, way
    return when, side


@kernel
def shorter(block, y, ground, h, series):
    """Return the sub-step, up to ``h``, over which the series of a block that moves has converged, expanded."""
    h = min(h, LONGEST / block.p)
    if y.mode == ROCKS:
        expand_rocking(block, y, ground, series)
        back = -y.side * series.theta[2]
        if y.theta == 0.0 and back > 0.0:
            h = min(h, 2.0 * abs(y.omega) / back)  # twice the hop
    else:
        expand_flight(block, y, ground, series)
    for k in range(ORDER - 1, ORDER + 1):
        last = abs(series.theta[k])
        if last * h**k > TRUNCATED * block.alpha:
            h = min(h, (TRUNCATED * block.alpha / last) ** (1.0 / k))
    return h


@kernel
def moved(y, t, which, series):
    """Return the state at ``t`` of a sub-step that ends with event ``which``."""
    theta, omega = value(series.theta, t), value(series.omega, t)
    omega = 0.0 if which == REVERSAL else omega
    if y.mode == ROCKS:
        return State(ROCKS, y.side, 0, 0.0 if which == IMPACT else theta, omega, 0.0, 0.0)
    near, rate = series.left if y.side < 0 else series.right, 0.0
    for k in range(ORDER, 0, -1):
        rate = rate * t + k * near[k]
    return State(FLIES, y.side, y.bore, theta, omega, value(near, t), rate)


@kernel
def changed(block, y, end, which, t, ground, left, series):
    """Return the state after event ``which``, ``t`` after ``y``, where smooth motion has led to ``end``."""
    if which == IMPACT:
        return after_impact(block, -y.side, end.omega, ground, left)
    if which == TAKE_OFF:
        return State(FLIES, y.side, y.side, end.theta, end.omega, 0.0, 0.0)
    if which in (LANDS_LEFT, LANDS_RIGHT):
        return after_landing(block, y, -1 if which == LANDS_LEFT else 1, series, t, ground)
    return end


@kernel
def over_piece(block, y, start, span, ground, most_steps, record, series):
    """Take the block over ``span`` of linear ground from time ``start``: its state, record and status."""
    tau, status = 0.0, STANDS
    peak, t_max, impacts, flights, steps = record
    while tau < span and status == STANDS:
        steps += 1
        if steps > most_steps:
            status = EXHAUSTED
        left = span - tau
        here = Ground(
            ground.across + tau * ground.across_rate,
            ground.across_rate,
            ground.up + tau * ground.up_rate,
            ground.up_rate,
        )
        if y.mode == REST:
            when, side = leave_rest(block, here, left)
            tau = tau + when if when < left else span
            if side != 0:
                there = Ground(
                    here.across + when * here.across_rate, here.across_rate, here.up + when * here.up_rate, here.up_rate
                )
                y = lifted(block, side, there)
                flights += 1 if y.mode == FLIES else 0
            continue
        h = shorter(block, y, here, left, series)
        which, when = (
            next_of_rocking(block, y, here, h, peak, series) if y.mode == ROCKS else next_of_flight(y, h, peak, series)
        )
        end = moved(y, when, which, series)
        tau = span if when >= left else tau + when
        if abs(end.theta) > peak:
            peak, t_max = min(abs(end.theta), 0.5 * math.pi), start + tau
        there = Ground(
            here.across + when * here.across_rate, here.across_rate, here.up + when * here.up_rate, here.up_rate
        )
        flew = y.mode == FLIES
        y = changed(block, y, end, which, when, there, span - tau, series)
        impacts += 1 if which in (IMPACT, LANDS_LEFT, LANDS_RIGHT) else 0
        flights += 1 if y.mode == FLIES and (not flew or which in (LANDS_LEFT, LANDS_RIGHT)) else 0
        if which == FALLEN:
            status = OVERTURNED
    return y, Record(peak, t_max, impacts, flights, steps), status, start + tau


@kernel
def decided(block, y, peak):
    """Return whether a block on ground that rests cannot turn beyond ``peak`` any more."""
    if y.mode != ROCKS:
        return y.mode == REST
    level = math.cos(block.alpha - min(peak, block.alpha))
    energy = 0.5 * (y.omega / block.p) ** 2 + math.cos(block.alpha - abs(y.theta))
    return abs(y.theta) < block.alpha and energy <= level * (1.0 + 1e-15)


@kernel
def room():
    """Return the arrays that a run works in."""
    return Series(
        np.zeros(COLUMNS), np.zeros(COLUMNS), np.zeros(COLUMNS), np.zeros(COLUMNS), np.zeros(COLUMNS), np.zeros(COLUMNS),
        np.zeros(COLUMNS), np.zeros((5, COLUMNS)), np.zeros((DEPTH + 2, COLUMNS)), np.zeros((DEPTH + 2, 2)),
    )  # fmt: skip


@kernel
def solve(block, dt, across, up, horizon, most_steps):
    """Run a block from rest through a motion until nothing can exceed its peak, ``horizon`` [s] after it at the latest."""
    series = room()
    npts, quiet = len(across), max(dt, 0.25 / block.p)
    y, record, status, t = State(REST, 0, 0, 0.0, 0.0, 0.0, 0.0), Record(0.0, 0.0, 0, 0, 0), STANDS, 0.0
    for piece in range(npts):
        further = piece + 1 < npts
        next_across, next_up = (across[piece + 1], up[piece + 1]) if further else (0.0, 0.0)
        ground = Ground(across[piece], (next_across - across[piece]) / dt, up[piece], (next_up - up[piece]) / dt)
        y, record, status, t = over_piece(block, y, piece * dt, dt, ground, most_steps, record, series)
        if status != STANDS:
            return status, t, False, record
    still, after = Ground(0.0, 0.0, 0.0, 0.0), 0
    while status == STANDS and after * quiet < horizon:
        if decided(block, y, record.theta_max):
            return status, t, True, record
        y, record, status, t = over_piece(block, y, npts * dt + after * quiet, quiet, still, most_steps, record, series)
        after += 1
    return status, t, False, record


def block_of(pier: Pier, base: RigidBase) -> Block:
    """Return ``pier`` as the equations have it."""
    share = pier.mu / (1.0 + pier.mu)
    size = share * pier.gravity / pier.p**2
    housner = max(1.0 - 2.0 * share * math.sin(pier.alpha) ** 2, 0.0)
    return Block(
        pier.alpha, pier.p, pier.gravity, size, size * math.sin(pier.alpha), size * math.cos(pier.alpha), size**2 / pier.mu,
        share, housner if base.restitution is None else float(base.restitution),
    )  # fmt: skip


def truth(pier: Pier, base: RigidBase, motion: Motion, factor: float = 1.0, horizon: float = HORIZON) -> Truth:
    """Return the truth about ``pier`` under ``motion`` times ``factor``, flight guided, followed for ``horizon`` [s] after it."""
    up = np.zeros(motion.npts) if motion.vertical is None else np.asarray(motion.vertical, float)
    across = np.asarray(motion.horizontal, float)
    status, t, is_decided, record = solve(
        block_of(pier, base), motion.dt, factor * across, factor * up, horizon, MOST_STEPS
    )
    return Truth(
        STATUS[status], record.theta_max, record.t_max, t, record.impacts, record.flights, is_decided, record.steps
    )
