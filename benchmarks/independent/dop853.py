"""The compiled pair of order 8(5,3) by Dormand and Prince (Hairer's DOP853) on the model of /THEORY.md.

All compiled functions are in this file, because Numba's cache on disk sees changes of one file only. A block on a rigid
base and one on two springs are the same problem to it: a smooth right-hand side as long as ``mode`` stays, and six
signals, positive until something happens. Derived from the equations anew; nothing is taken from ``rockbatch.core``.

State ``y`` = v, θ, v̇, θ̇, z_L, z_R, W, with W the work [J/kg] of all that is not stored (its check is the balance). On the
rigid base v and v̇ are those of flight, 0 in contact, and W and the stored energy are over (I0 + R²)/M.
"""

import math

import numpy as np
from numba import njit
from scipy.integrate._ivp import dop853_coefficients as dop853

SIZE = 7
A, B, C = dop853.A[:12, :12].copy(), dop853.B.copy(), dop853.C[:12].copy()
E3, E5 = dop853.E3.copy(), dop853.E5.copy()
SIGNALS = 6

# Parameters
RIGID, G, HALF_WIDTH, HEIGHT, INERTIA, ALPHA, P, E, FY, DY, N, LAW, FINITE, EPSILON, OMEGA, ETA, STOPS = range(17)
ELASTIC, BOUC_WEN, EPP = range(3)
# Mode: contact of L, R; inelastic branch of L, R; side of a rigid block: the pivot that bears, in flight the one that bore
# last (-1 L, 1 R, 0 at rest). On the rigid base the fourth says that the lower pivot of a flying block rises.
FREE, CONTACT, HELD = range(3)
RISES, SIDE = 3, 4
# What is found out on the way
(STATUS, THETA_MAX, T_MAX, T_END, IMPACTS, SEPARATIONS, T_FLIGHT, THETA_FLIGHT, PEAK_FLIGHT, T_PEAK_FLIGHT, UP_LEFT,
 UP_RIGHT, BALANCE, FORCED, STEPS, DECIDED, HALFWAY, JUMPS, WRITTEN, FLIGHTS, AIR_TIME, AIR_HEIGHT,
 TAKE_OFF) = range(23)  # fmt: skip
FOUND = 23
STANDS, OVERTURNED, FLEW, EXHAUSTED = range(4)

kernel = njit(cache=True, nogil=True, error_model="numpy")


@kernel
def lever(theta, left, right, par):
    """H and dH/dθ; ``left`` and ``right`` are 1 in contact and 0 without."""
    b, h = par[HALF_WIDTH], par[HEIGHT]
    if par[FINITE] == 0.0:
        return h + b * theta * (right - left), 0.0
    sine, cosine = math.sin(theta), math.cos(theta)
    return h * cosine + b * sine * (right - left), -h * sine + b * cosine * (right - left)


@kernel
def arms(theta, par):
    """∂v_L/∂θ, ∂v_R/∂θ and their derivatives."""
    b, h = par[HALF_WIDTH], par[HEIGHT]
    if par[FINITE] == 0.0:
        return b, -b, 0.0, 0.0
    sine, cosine = math.sin(theta), math.cos(theta)
    return b * cosine + h * sine, h * sine - b * cosine, h * cosine - b * sine, h * cosine + b * sine


@kernel
def pivots(y, par):
    """v_L and v_R."""
    b, h = par[HALF_WIDTH], par[HEIGHT]
    if par[FINITE] == 0.0:
        return y[0] + b * y[1], y[0] - b * y[1]
    sine, rise = math.sin(y[1]), 2.0 * h * math.sin(0.5 * y[1]) ** 2
    return y[0] + b * sine + rise, y[0] - b * sine + rise


@kernel
def accelerations(y, left, right, horizontal, vertical, par):
    """v̈ and θ̈ with the contacts as told; the forces are those of z."""
    b, h = par[HALF_WIDTH], par[HEIGHT]
    force_left, force_right = par[FY] * y[4] * left, par[FY] * y[5] * right
    H, slope = lever(y[1], left, right, par)
    if par[FINITE] == 0.0:
        moment = -force_left * (b + h * y[1]) + force_right * (b - h * y[1]) - H * horizontal
        inertia = par[INERTIA] + h * h
    else:
        arm_left, arm_right, _, _ = arms(y[1], par)
        moment = -force_left * arm_left - force_right * arm_right - H * horizontal - H * slope * y[3] ** 2
        inertia = par[INERTIA] + H * H
    return -par[G] - vertical - force_left - force_right, moment / inertia


@kernel
def flies(mode):
    """Whether neither pivot is in contact."""
    return mode[0] == FREE and mode[1] == FREE


@kernel
def keyed(y, mode, par):
    """H and dH/dθ of a flying rigid block: the key at the pivot that bore last keeps its place."""
    return lever(y[1], 1.0 if mode[SIDE] == -1 else 0.0, 1.0 if mode[SIDE] == 1 else 0.0, par)


@kernel
def touching(mode, pivot):
    return 1.0 if mode[pivot] == CONTACT else 0.0


@kernel
def pivot_acceleration(y, up, turn, pivot, par):
    """v̈_i of accelerations ``up`` and ``turn``."""
    left, right, dleft, dright = arms(y[1], par)
    if pivot == 0:
        return up + left * turn + dleft * y[3] ** 2
    return up + right * turn + dright * y[3] ** 2


@kernel
def pivot_velocity(y, pivot, par):
    left, right, _, _ = arms(y[1], par)
    return y[2] + (left if pivot == 0 else right) * y[3]


@kernel
def normal_force(y, side, ground, tau, par):
    """N/M of a rigid block that rocks about the pivot on ``side``, and its rate.

    N/M = g + v̈_g + v̈ with v = R cos φ − h, φ = α − |θ|, and θ̈ of rocking (flight.md, F1).
    """
    u, w = ground[0] + ground[1] * tau, ground[2] + ground[3] * tau
    size = math.hypot(par[HALF_WIDTH], par[HEIGHT])
    k = size**2 / (size**2 + par[INERTIA])
    phi, speed = par[ALPHA] - side * y[1], side * y[3]
    sine, cosine = math.sin(phi), math.cos(phi)
    weight, across = par[G] + w, side * u
    turn = -k / size * (weight * sine + across * cosine)  # of |θ|
    force = weight * (1 - k * sine**2) - k * across * sine * cosine - size * cosine * speed**2
    rate = ground[3] * (1 - k * sine**2) - k * side * ground[1] * sine * cosine
    rate += k * speed * (2 * weight * sine * cosine + across * math.cos(2 * phi))
    rate -= size * speed * (sine * speed**2 + 2 * cosine * turn)
    return force, rate


@kernel
def lower_pivot(y):
    """The lower pivot of a flying rigid block, at θ = 0 the one that will be."""
    lean = y[1] if y[1] != 0.0 else y[3]
    return 1 if lean > 0 else 0


@kernel
def lifting(y, mode, pivot, horizontal, vertical, par):
    """v̈_i of pivot i at its support, unloaded: by the equations in contact and by the free ones."""
    other = touching(mode, 1 - pivot)
    if pivot == 0:
        up, turn = accelerations(y, 1.0, other, horizontal, vertical, par)
        free_up, free_turn = accelerations(y, 0.0, other, horizontal, vertical, par)
    else:
        up, turn = accelerations(y, other, 1.0, horizontal, vertical, par)
        free_up, free_turn = accelerations(y, other, 0.0, horizontal, vertical, par)
    return pivot_acceleration(y, up, turn, pivot, par), pivot_acceleration(y, free_up, free_turn, pivot, par)


@kernel
def rhs(y, out, tau, ground, mode, par):
    """dy/dt; ``ground`` = ü_g, its rate, v̈_g, its rate at τ = 0."""
    u, w = ground[0] + ground[1] * tau, ground[2] + ground[3] * tau
    out[:] = 0.0
    if par[RIGID] == 1.0:
        if flies(mode):
            H, slope = keyed(y, mode, par)
            inertia = par[INERTIA] + H * H
            out[0], out[1], out[2] = y[2], y[3], -par[G] - w
            out[3] = -H * (slope * y[3] ** 2 + u) / inertia
            out[6] = -(u * H * y[3] + w * y[2]) * par[P] ** 2 / (par[G] * math.hypot(par[HALF_WIDTH], par[HEIGHT]))
            return
        if mode[SIDE] == 0:
            return
        lean = par[ALPHA] * mode[SIDE] - y[1]
        pull = par[P] ** 2 * (w / par[G] * math.sin(lean) + u / par[G] * math.cos(lean))
        out[1] = y[3]
        out[3] = -(par[P] ** 2) * math.sin(lean) - pull
        out[6] = -pull * y[3]
        return
    left, right = touching(mode, 0), touching(mode, 1)
    up, turn = accelerations(y, left, right, u, w, par)
    out[0], out[1] = y[2], y[3]
    velocity_left, velocity_right = pivot_velocity(y, 0, par), pivot_velocity(y, 1, par)
    for pivot in range(2):
        if mode[pivot] == CONTACT:
            z = y[4 + pivot]
            rate = (velocity_left if pivot == 0 else velocity_right) / par[DY]
            if mode[2 + pivot] == 1:
                rate = 0.0 if par[LAW] == EPP else rate * (1.0 - max(-z, 0.0) ** par[N])
            out[4 + pivot] = rate
    force_left, force_right = par[FY] * y[4] * left, par[FY] * y[5] * right
    if mode[0] == HELD or mode[1] == HELD:  # v̈_i = 0 is what θ̈ obeys
        pivot = 0 if mode[0] == HELD else 1
        arm_left, arm_right, dleft, dright = arms(y[1], par)
        turn = -(up + (dleft if pivot == 0 else dright) * y[3] ** 2) / (arm_left if pivot == 0 else arm_right)
        H, slope = lever(y[1], left, right, par)
        out[6] = up * y[2] + (par[INERTIA] + H * H) * turn * y[3] + H * slope * y[3] ** 3 + par[G] * y[2]
        out[6] += par[DY] * (force_left * out[4] + force_right * out[5])
    else:
        H, _ = lever(y[1], left, right, par)
        out[6] = -u * H * y[3] - w * y[2]
        out[6] -= force_left * (velocity_left - par[DY] * out[4]) + force_right * (velocity_right - par[DY] * out[5])
        if par[FINITE] == 0.0:
            out[6] -= par[HEIGHT] * y[1] * (force_left + force_right) * y[3]
    out[2], out[3] = up, turn


@kernel
def stored(y, mode, par):
    """Kinetic, potential and elastic energy."""
    if par[RIGID] == 1.0 and flies(mode):
        H, _ = keyed(y, mode, par)
        energy = 0.5 * y[2] ** 2 + 0.5 * (par[INERTIA] + H * H) * y[3] ** 2 + par[G] * y[0]
        return energy * par[P] ** 2 / (par[G] * math.hypot(par[HALF_WIDTH], par[HEIGHT]))
    if par[RIGID] == 1.0:
        return 0.5 * y[3] ** 2 + par[P] ** 2 * (math.cos(par[ALPHA] - abs(y[1])) - math.cos(par[ALPHA]))
    H = par[HEIGHT]
    if par[FINITE] == 1.0:
        H, _ = lever(y[1], touching(mode, 0), touching(mode, 1), par)
    springs = 0.5 * par[FY] * par[DY] * (y[4] ** 2 + y[5] ** 2)
    return 0.5 * y[2] ** 2 + 0.5 * (par[INERTIA] + H * H) * y[3] ** 2 + par[G] * y[0] + springs


@kernel
def step(y, f, h, tau, ground, mode, par, stages, new, new_f, tolerance):
    """One step of length ``h`` into ``new`` and its slope into ``new_f``; returns the error over the tolerance."""
    stages[0] = f
    for s in range(1, 12):
        for i in range(SIZE):
            total = 0.0
            for k in range(s):
                total += A[s, k] * stages[k, i]
            new[i] = y[i] + h * total
        rhs(new, stages[s], tau + C[s] * h, ground, mode, par)
    for i in range(SIZE):
        total = 0.0
        for k in range(12):
            total += B[k] * stages[k, i]
        new[i] = y[i] + h * total
    rhs(new, new_f, tau + h, ground, mode, par)
    stages[12] = new_f
    fifth, third = 0.0, 0.0
    for i in range(SIZE):
        if i == 6:
            continue  # the work is only looked at
        if i == 0:
            scale = par[HALF_WIDTH] * par[ALPHA]
        elif i == 1:
            scale = par[ALPHA]
        elif i == 2:
            scale = par[HALF_WIDTH] * par[ALPHA] * par[P]
        elif i == 3:
            scale = par[ALPHA] * par[P]
        else:
            scale = 1.0
        scale = tolerance * (scale + max(abs(y[i]), abs(new[i])))
        error5, error3 = 0.0, 0.0
        for k in range(13):
            error5 += E5[k] * stages[k, i]
            error3 += E3[k] * stages[k, i]
        fifth += (error5 / scale) ** 2
        third += (error3 / scale) ** 2
    if fifth == 0.0 and third == 0.0:
        return 0.0
    return h * fifth / math.sqrt((fifth + 0.01 * third) * (SIZE - 1))


@kernel
def rigid_signals(y, f, tau, ground, mode, par, g, dg):
    """Signals 0 to 3 of a rigid block, as :func:`signals` says."""
    u, w = ground[0] + ground[1] * tau, ground[2] + ground[3] * tau
    if flies(mode):
        g[0], g[1] = pivots(y, par)
        dg[0], dg[1] = pivot_velocity(y, 0, par), pivot_velocity(y, 1, par)
        if mode[RISES] == 1:
            lower = lower_pivot(y)
            g[3], dg[3] = dg[lower], pivot_acceleration(y, f[2], f[3], lower, par)
    elif mode[SIDE] == 0:
        grip = (par[G] + w) * math.tan(par[ALPHA])
        dgrip = ground[3] * math.tan(par[ALPHA])
        g[0], dg[0] = grip - u, dgrip - ground[1]
        g[1], dg[1] = grip + u, dgrip + ground[1]
        g[2], dg[2] = par[G] + w, ground[3]
    else:
        g[0], dg[0] = mode[SIDE] * y[1], mode[SIDE] * y[3]
        g[2], dg[2] = normal_force(y, mode[SIDE], ground, tau, par)


@kernel
def signals(y, f, tau, ground, mode, supports, peak_matters, par, g, dg):
    """Six signals, positive until something happens, and their rates.

    0, 1: pivot L, R leaves or lands (held: pressed down by contact). 2, 3: L, R turns or yields (held: lifted by the free
    equations). 4: |θ| = π/2. 5: |θ| turns. Rigid, at rest: 0, 1 lifts to the left, right, 2 ground drops away; rocking:
    0 impact, 2 the normal force vanishes; in flight: 0, 1 pivot L, R lands, 3 the lower pivot rises no more.
    """
    g[:] = 1.0
    dg[:] = 0.0
    u, w = ground[0] + ground[1] * tau, ground[2] + ground[3] * tau
    if par[RIGID] == 1.0:
        rigid_signals(y, f, tau, ground, mode, par, g, dg)
    else:
        for pivot in range(2):
            z = y[4 + pivot]
            velocity = pivot_velocity(y, pivot, par)
            if mode[pivot] == FREE:
                left, right = pivots(y, par)
                g[pivot] = (left if pivot == 0 else right) - supports[pivot]
                dg[pivot] = velocity
            elif mode[pivot] == CONTACT:
                g[pivot], dg[pivot] = -z, -f[4 + pivot]
                if par[LAW] == EPP and mode[2 + pivot] == 0:
                    g[2 + pivot], dg[2 + pivot] = z + 1.0, f[4 + pivot]
                elif par[LAW] != ELASTIC:
                    sign = -1.0 if mode[2 + pivot] == 1 else 1.0
                    g[2 + pivot] = sign * velocity
                    dg[2 + pivot] = sign * pivot_acceleration(y, f[2], f[3], pivot, par)
            else:
                contact, free = lifting(y, mode, pivot, u, w, par)
                g[pivot], g[2 + pivot] = contact, -free
    g[4] = 0.5 * math.pi - abs(y[1])
    dg[4] = -y[3] if y[1] > 0 else y[3]
    if peak_matters != 0:
        g[5], dg[5] = peak_matters * y[3], peak_matters * f[3]


@kernel
def dip(g0, d0, g1, d1, h):
    """Where the cubic through both ends has its minimum inside, as a share of h, and its value; -1 where it has none."""
    d0, d1 = d0 * h, d1 * h
    a, b = 2 * (g0 - g1) + d0 + d1, 3 * (g1 - g0) - 2 * d0 - d1
    if abs(a) < 1e-12 * (abs(b) + abs(d0)):
        if b <= 0:
            return -1.0, 0.0
        s = -0.5 * d0 / b
    else:
        root = b * b - 3 * a * d0
        if root <= 0:
            return -1.0, 0.0
        s = (-b + math.sqrt(root)) / (3 * a)
    if not 0 < s < 1:
        return -1.0, 0.0
    return s, g0 + s * (d0 + s * (b + s * a))


@kernel
def tried(h, rate, k, y, f, tau, ground, mode, supports, matters, par, stages, new, new_f, g, dg):
    """Signal k (or its rate) after a step of length h."""
    step(y, f, h, tau, ground, mode, par, stages, new, new_f, 1.0)
    signals(new, new_f, tau + h, ground, mode, supports, matters, par, g, dg)
    return dg[k] if rate else g[k]


@kernel
def falls(low, value_low, high, value_high, rate, fine, k, y, f, tau, ground, mode, supports, matters, par, stages, new,
          new_f, g, dg):  # fmt: skip
    """Time at which signal k (or minus its rate) falls through zero, by Chandrupatla's method; the later end."""
    x1, f1, x2, f2, t = low, value_low, high, value_high, 0.5
    x3, f3 = x1, f1
    first = True
    for _ in range(200):
        if abs(x2 - x1) <= fine:
            break
        if first:
            t = min(max(f1 / (f1 - f2), 0.01), 0.99)
            first = False
        x = x1 + t * (x2 - x1)
        if x in (x1, x2):
            break
        value = tried(x, rate, k, y, f, tau, ground, mode, supports, matters, par, stages, new, new_f, g, dg)
        if rate:
            value = -value
        if value == 0.0:
            return x
        if (value > 0) == (f1 > 0):
            x3, f3 = x1, f1
        else:
            x3, f3, x2, f2 = x2, f2, x1, f1
        x1, f1 = x, value
        xi, phi = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
        if phi * phi < xi and (1 - phi) ** 2 < 1 - xi:
            t = f1 / (f2 - f1) * f3 / (f2 - f3) + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        else:
            t = 0.5
        edge = 0.5 * fine / max(abs(x2 - x1), 1e-300)
        t = min(max(t, edge), 1 - edge)
    return x1 if f1 <= 0 else x2


@kernel
def earliest(h, y, f, tau, ground, mode, supports, matters, par, stages, new, new_f, g0, d0, g1, d1, g, dg):
    """The first signal to fall below zero within (0, h] and its time: (-1, h) if none does.

    (-2, s) asks for a step of length s only: something may happen twice within h.
    """
    which, when = -1, h
    fine = 1e-15 * max(h, 1e-6) + 4e-17
    for k in range(SIGNALS):
        high, value = h, g1[k]
        if value >= 0:
            share, least = dip(g0[k], d0[k], g1[k], d1[k], h)
            if share < 0 or least > 0.1 * max(g0[k], g1[k]):
                continue
            if d0[k] < 0 < d1[k]:
                high = falls(0.0, -d0[k], h, -d1[k], True, 1e-9 * h, k, y, f, tau, ground, mode, supports, matters, par,
                             stages, new, new_f, g, dg)  # fmt: skip
                value = tried(
                    high, False, k, y, f, tau, ground, mode, supports, matters, par, stages, new, new_f, g, dg
                )
                if value >= 0:
                    continue
            elif share > 1e-3:
                return -2, share * h
            else:
                continue
        low, value_low = 0.0, g0[k]
        if value_low <= 0:  # starts on its own surface: is it above at all?
            low = high
            while low > 1e-13 * h + 1e-17:
                low *= 0.5
                value_low = tried(
                    low, False, k, y, f, tau, ground, mode, supports, matters, par, stages, new, new_f, g, dg
                )
                if value_low > 0:
                    break
                high, value = low, value_low
            if value_low <= 0:
                return k, 0.0
        if low >= when:
            continue
        time = falls(low, value_low, high, value, False, fine, k, y, f, tau, ground, mode, supports, matters, par, stages,
                     new, new_f, g, dg)  # fmt: skip
        if time < when or which < 0:
            which, when = k, time
    return which, when


@kernel
def choose_branches(y, mode, par):
    """After an impulse every spring's branch is chosen anew."""
    for pivot in range(2):
        if mode[pivot] != CONTACT:
            mode[2 + pivot] = 0
        elif par[LAW] == BOUC_WEN:
            mode[2 + pivot] = 1 if pivot_velocity(y, pivot, par) < 0 else 0
        elif par[LAW] == EPP:
            mode[2 + pivot] = 1 if y[4 + pivot] <= -1 and pivot_velocity(y, pivot, par) < 0 else 0


@kernel
def push(y, pivot, factor, par):
    """Impulse at a pivot that multiplies its velocity by ``factor``."""
    left, right, _, _ = arms(y[1], par)
    arm = left if pivot == 0 else right
    H, _ = lever(y[1], 1.0, 1.0, par)
    inertia = par[INERTIA] + H * H
    impulse = -(1 - factor) * (y[2] + arm * y[3]) / (1 + arm * arm / inertia)
    y[2] += impulse
    y[3] += impulse * arm / inertia


@kernel
def rest_at_support(y, mode, pivot, u, w, supports, par):
    """A pivot unloaded at its support with hardly a velocity: contact, free or held, as the accelerations say."""
    contact, free = lifting(y, mode, pivot, u, w, par)
    if contact < 0:
        mode[pivot] = CONTACT
        return
    push(y, pivot, 0.0, par)
    mode[pivot] = FREE if free > 0 else HELD
    left, right = pivots(y, par)
    supports[pivot] = left if pivot == 0 else right


@kernel
def land(y, mode, pivot, u, w, supports, found, par):
    """Impact of one pivot, or of both at one instant."""
    other = 1 - pivot
    left, right = pivots(y, par)
    gap = (left if other == 0 else right) - supports[other]
    y[4 + pivot] = 0.0
    found[IMPACTS] += 1
    if mode[other] == FREE and gap <= 1e-12 * par[HALF_WIDTH] and pivot_velocity(y, other, par) < 0:
        y[2] *= par[EPSILON]
        y[3] *= par[EPSILON]
        y[4 + other] = 0.0
        found[IMPACTS] += 1
        mode[0], mode[1] = CONTACT, CONTACT
        return
    push(y, pivot, par[EPSILON], par)
    if mode[other] == HELD:
        mode[other] = CONTACT if pivot_velocity(y, other, par) < 0 else FREE
    if abs(pivot_velocity(y, pivot, par)) < 1e-7 * math.sqrt(par[G] * par[HALF_WIDTH]):
        rest_at_support(y, mode, pivot, u, w, supports, par)
    else:
        mode[pivot] = CONTACT


@kernel
def take_off(y, mode, pivot, u, w, supports, found, par):
    """A support unloads, or a held pivot is lifted."""
    left, right = pivots(y, par)
    y[4 + pivot] = 0.0
    supports[pivot] = left if pivot == 0 else right
    held = mode[pivot] == HELD
    mode[pivot] = FREE
    if not held and pivot_velocity(y, pivot, par) < 1e-7 * math.sqrt(par[G] * par[HALF_WIDTH]):
        rest_at_support(y, mode, pivot, u, w, supports, par)
    if mode[pivot] == FREE:
        found[SEPARATIONS] += 1


@kernel
def leave_ground(y, mode, side):
    """Take-off from rocking about the pivot on ``side``, or from rest: its height and velocity are those of contact."""
    mode[0], mode[1], mode[RISES], mode[SIDE] = FREE, FREE, 1, side


@kernel
def take_off_rocking(y, mode, par):
    """Take-off of a block whose pivot is pressed down no longer: v_i = v̇_i = 0 gives v and v̇."""
    pivot = 0 if mode[SIDE] == -1 else 1
    y[0] = y[2] = 0.0
    y[0], y[2] = -pivots(y, par)[pivot], -pivot_velocity(y, pivot, par)
    leave_ground(y, mode, mode[SIDE])


@kernel
def leave_rest(y, mode, ground, tau, found, par):
    """Lift-off about one pivot, or, where nothing would press on it, take-off of both."""
    side = -1 if ground[0] + ground[1] * tau > 0 else 1
    found[SEPARATIONS] += 1
    if normal_force(y, side, ground, tau, par)[0] > 1e-9 * par[G]:
        mode[SIDE] = side
    else:
        leave_ground(y, mode, 0)


@kernel
def come_to_rest(y, mode, ground, tau, found, par):
    """Rest, unless the ground lifts the block again at once."""
    u, w = ground[0] + ground[1] * tau, ground[2] + ground[3] * tau
    y[:4] = 0.0
    mode[0], mode[1], mode[SIDE] = CONTACT, CONTACT, 0
    if abs(u) > (par[G] + w) * math.tan(par[ALPHA]):
        leave_rest(y, mode, ground, tau, found, par)


@kernel
def rebound(y, side, pivot, epsilon, par):
    """θ̇ and v̇ after pivot i lands, with the pivot on ``side`` in its place until then (flight.md, F4).

    The impulse acts at pivot i: angular momentum about it is kept, v̇_i is −ε times itself, and i keeps its place then.
    """
    arm = arms(y[1], par)[pivot]
    before, _ = lever(y[1], 1.0 if side == -1 else 0.0, 1.0 if side == 1 else 0.0, par)
    after, _ = lever(y[1], 1.0 - pivot, float(pivot), par)
    momentum = (par[INERTIA] + after * before) * y[3] - arm * y[2]
    upward = -epsilon * pivot_velocity(y, pivot, par)
    turn = (momentum + arm * upward) / (par[INERTIA] + after * after + arm * arm)
    return turn, upward - arm * turn


@kernel
def touch_down(y, mode, pivot, ground, tau, found, par):
    """Landing of a flying rigid block on one pivot, or on both at one instant; N decides whether it stays."""
    unit = math.sqrt(par[G] * par[HALF_WIDTH])
    other, speed = 1 - pivot, -pivot_velocity(y, pivot, par)
    gap = pivots(y, par)[other]
    epsilon = par[EPSILON] if par[EPSILON] * speed > 1e-7 * unit else 0.0
    noticed = 1 if speed > 1e-9 * unit else 0  # less is rounding at take-off
    found[IMPACTS] += noticed
    mode[RISES] = 1
    if abs(gap) <= 1e-12 * par[HALF_WIDTH] and pivot_velocity(y, other, par) < 0:
        found[IMPACTS] += noticed
        if epsilon == 0.0:
            come_to_rest(y, mode, ground, tau, found, par)
        y[2] *= -epsilon
        y[3] *= -epsilon
    else:
        y[3], y[2] = rebound(y, mode[SIDE], pivot, epsilon, par)
        mode[SIDE] = 2 * pivot - 1
        if epsilon == 0.0 and normal_force(y, mode[SIDE], ground, tau, par)[0] > 0:
            mode[0], mode[1] = CONTACT, CONTACT
            y[0] = y[2] = 0.0
    if flies(mode):  # it is off again
        found[FLIGHTS] += noticed


@kernel
def rock_over(y, mode, ground, tau, left_s, found, par):
    """Impact of a rocking rigid block at θ = 0: it goes on about the other pivot, rests or takes off."""
    u, w = ground[0] + ground[1] * tau, ground[2] + ground[3] * tau
    y[1] = 0.0
    found[IMPACTS] += 1
    mode[SIDE] = -mode[SIDE]
    y[3] *= par[E]
    weight, pull = (1 + w / par[G]) * math.sin(par[ALPHA]), abs(u) / par[G] * math.cos(par[ALPHA])
    restoring = par[P] ** 2 * (weight - pull)
    speed = abs(y[3])
    if mode[SIDE] * y[3] < 0 or speed == 0.0:
        come_to_rest(y, mode, ground, tau, found, par)
        return
    if restoring > 0 and par[E] < 1:
        low = speed**2 < 2 * restoring * 1e-15 * par[ALPHA]
        if low and 2 * speed / (restoring * (1 - par[E])) < 0.01 * left_s:
            y[3] = 0.0
            mode[SIDE] = 0
            return
    if normal_force(y, mode[SIDE], ground, tau, par)[0] <= 0:
        take_off_rocking(y, mode, par)


@kernel
def change_rigid(k, y, mode, ground, tau, left_s, found, par):
    """Events of the rigid base."""
    if flies(mode):
        if k == 3:
            mode[RISES] = 0
        else:
            touch_down(y, mode, k, ground, tau, found, par)
    elif mode[SIDE] == 0:
        leave_rest(y, mode, ground, tau, found, par)
    elif k == 2:
        take_off_rocking(y, mode, par)
    else:
        rock_over(y, mode, ground, tau, left_s, found, par)


@kernel
def change(k, y, mode, ground, tau, left_s, supports, found, par):
    """What event k does to the state."""
    u, w = ground[0] + ground[1] * tau, ground[2] + ground[3] * tau
    pivot = k % 2
    if k >= 4:
        return
    if par[RIGID] == 1.0:
        change_rigid(k, y, mode, ground, tau, left_s, found, par)
    elif k < 2 and mode[pivot] == FREE:
        land(y, mode, pivot, u, w, supports, found, par)
        choose_branches(y, mode, par)
    elif k < 2 and mode[pivot] == CONTACT:
        take_off(y, mode, pivot, u, w, supports, found, par)
    elif k < 2:
        push(y, pivot, 0.0, par)
        mode[pivot] = CONTACT
        choose_branches(y, mode, par)
    elif mode[pivot] == HELD:
        push(y, pivot, 0.0, par)
        take_off(y, mode, pivot, u, w, supports, found, par)
    else:
        mode[2 + pivot] = 1 - mode[2 + pivot]
        if par[LAW] == EPP and mode[2 + pivot] == 1:
            y[4 + pivot] = -1.0


@kernel
def barrier(theta, u_left, u_right, par):
    """Least potential energy at rotation ``theta`` on supports u_L, u_R, with springs that stay elastic and no tension."""
    g, b, h, delta = par[G], par[HALF_WIDTH], par[HEIGHT], par[G] / par[OMEGA] ** 2
    sink = 2.0 * h * math.sin(0.5 * theta) ** 2
    # the v at which each support is just met
    left, right = u_left - b * math.sin(theta) - sink, u_right + b * math.sin(theta) - sink
    upper, lower = max(left, right), min(left, right)
    v = upper - 2 * delta
    if v >= lower:
        return g * v + g * delta
    v = 0.5 * (upper + lower) - delta
    return g * v + 0.25 * par[OMEGA] ** 2 * ((upper - v) ** 2 + (lower - v) ** 2)


@kernel
def no_more(y, mode, supports, found, par):
    """Whether the energy left says that |θ| cannot exceed its greatest value any more (after the motion)."""
    peak = found[THETA_MAX]
    if par[RIGID] == 1.0:
        if flies(mode):
            return False
        if mode[SIDE] == 0:
            return True
        level = par[P] ** 2 * (math.cos(par[ALPHA] - min(peak, par[ALPHA])) - math.cos(par[ALPHA]))
        return abs(y[1]) < par[ALPHA] and stored(y, mode, par) <= level * (1 + 1e-14)
    up_left, up_right = unstressed(y, mode, supports, par)
    b = par[HALF_WIDTH]
    tilt = 0.5 * (up_left - up_right) / b
    stiff = par[OMEGA] ** 2 * b * b - par[G] * par[HEIGHT]
    lean = tilt * par[OMEGA] ** 2 * b * b / stiff
    least = barrier(lean, up_left, up_right, par)
    energy = stored(y, mode, par) - least
    top = min(barrier(peak, up_left, up_right, par), barrier(-peak, up_left, up_right, par)) - least
    if par[LAW] == ELASTIC:
        return peak < par[ALPHA] and energy < 0.98 * top
    swing, heave = math.sqrt(2 * max(energy, 0.0) / stiff), math.sqrt(2 * max(energy, 0.0)) / par[OMEGA]
    if (swing + abs(lean - tilt)) * b + heave > par[G] / par[OMEGA] ** 2:
        return False  # it still lifts
    reach = abs(lean) + 3 * swing
    if par[LAW] == BOUC_WEN:
        # loading is softer than unloading: what leans creeps on, without end where that is unstable
        reach *= 1.5
        for _ in range(2):
            load = min(1.0, (1 + 2 * reach / math.tan(par[ALPHA])) / par[ETA])
            loading = 1 - load ** par[N]
            soft = par[OMEGA] ** 2 * b * b * 2 * loading / (1 + loading) - par[G] * par[HEIGHT]
            if soft <= 0.0:
                return False
            reach = max(reach, 1.5 * (abs(lean) + 3 * swing) * stiff / soft)
    firm = reach < 0.4 * min(1.0, par[ETA] - 1) * math.tan(par[ALPHA])
    return firm and energy < 0.5 * top and reach < 0.8 * peak


@kernel
def unstressed(y, mode, supports, par):
    """Unstressed positions of the supports, 0 on the rigid base."""
    if par[RIGID] == 1.0:
        return 0.0, 0.0
    left, right = pivots(y, par)
    return (
        supports[0] if mode[0] == FREE else left - par[DY] * y[4],
        supports[1] if mode[1] == FREE else right - par[DY] * y[5],
    )


@kernel
def lay_ground(piece, dt, horizontal, vertical, ground):
    """The ground's line from sample ``piece`` to the next; after the last one it falls to zero, and stays there."""
    ground[:] = 0.0
    npts = len(horizontal)
    if piece < npts:
        further = 1.0 if piece + 1 < npts else 0.0
        last = min(piece + 1, npts - 1)
        ground[0], ground[2] = horizontal[piece], vertical[piece]
        ground[1] = (horizontal[last] * further - horizontal[piece]) / dt
        ground[3] = (vertical[last] * further - vertical[piece]) / dt


@kernel
def outward(y, h, found):
    """Sign of θ̇ while |θ| grows and may exceed the peak within ``h``, else 0."""
    reach = abs(y[1]) + 2 * abs(y[3]) * h
    if y[3] == 0 or y[1] * y[3] < 0 or reach <= found[THETA_MAX] * (1 - 1e-9):
        return 0.0
    return 1.0 if y[3] > 0 else -1.0


@kernel
def happen(which, y, t, tau, span, ground, mode, supports, par, found):
    """Event ``which`` at t + τ: the state after it, and what it means for the outcome."""
    before, flew = stored(y, mode, par), flies(mode)
    change(which, y, mode, ground, tau, span - tau, supports, found, par)
    found[JUMPS] += stored(y, mode, par) - before
    if flew and not flies(mode):
        found[AIR_TIME] += t + tau - found[TAKE_OFF]
    elif flies(mode) and not flew:
        found[TAKE_OFF] = t + tau
        found[FLIGHTS] += 1
        if math.isnan(found[T_FLIGHT]):
            found[T_FLIGHT], found[THETA_FLIGHT] = t + tau, math.copysign(abs(y[1]), y[1] * y[3])
            found[PEAK_FLIGHT], found[T_PEAK_FLIGHT] = found[THETA_MAX], found[T_MAX]
        if par[STOPS] == 1.0 and (abs(y[1]) < par[ALPHA] or y[1] * y[3] < 0):
            found[STATUS] = FLEW
    if which == 4:
        found[STATUS] = OVERTURNED


@kernel
def run_piece(t, span, length, ground, mode, supports, par, tolerance, longest, most_steps, work, stages, found, trace):
    """From ``t`` over ``span`` [s] of straight ground, or to the end of the run; returns the length of the next step."""
    y, f, new, new_f, trial, trial_f = work[0], work[1], work[2], work[3], work[4], work[5]
    g0, d0, g1, d1, g, dg = work[6], work[7], work[8], work[9], work[10], work[11]
    tau, stuck = 0.0, 0
    rhs(y, f, tau, ground, mode, par)
    while tau < span and found[STATUS] == STANDS:
        h = min(length, longest, span - tau)
        if span - tau - h < 1e-3 * h:
            h = span - tau
        if par[RIGID] == 1.0 and flies(mode) and pivot_velocity(y, lower_pivot(y), par) > 0:
            mode[RISES] = 1
        matters = outward(y, h, found)
        error = step(y, f, h, tau, ground, mode, par, stages, new, new_f, tolerance)
        found[STEPS] += 1
        if found[STEPS] > most_steps:
            found[STATUS] = EXHAUSTED
        if not error <= 1.0:
            length = h * max(0.2, 0.9 * error ** (-1 / 8)) if error > 0 else 0.1 * h
            continue
        length = max(length, h * (min(5.0, 0.9 * error ** (-1 / 8)) if error > 0 else 5.0))
        signals(y, f, tau, ground, mode, supports, matters, par, g0, d0)
        signals(new, new_f, tau + h, ground, mode, supports, matters, par, g1, d1)
        which, when = earliest(h, y, f, tau, ground, mode, supports, matters, par, stages, trial, trial_f, g0, d0, g1,
                               d1, g, dg)  # fmt: skip
        if which == -2:
            length = when
            continue
        if when <= 1e-15 * span and which >= 0:
            stuck += 1
            if stuck > 40:  # an event that returns at once: a short step that looks at nothing
                found[FORCED] += 1
                which, when, stuck = -1, min(1e-9 / max(par[OMEGA], par[P]), span - tau), 0
        elif when > 1e-12 * span:
            stuck = 0
        if when > 0:
            if which >= 0 or when < h:
                step(y, f, when, tau, ground, mode, par, stages, new, new_f, tolerance)
            y[:] = new
            f[:] = new_f
            tau = span if when == h and h == span - tau else tau + when
        if abs(y[1]) > found[THETA_MAX]:
            found[THETA_MAX], found[T_MAX] = abs(y[1]), t + tau
        if par[RIGID] == 1.0 and flies(mode):
            found[AIR_HEIGHT] = max(found[AIR_HEIGHT], pivots(y, par)[lower_pivot(y)])
        if which >= 0:
            happen(which, y, t, tau, span, ground, mode, supports, par, found)
            rhs(y, f, tau, ground, mode, par)
        note(t + tau, y, mode, found, trace)
    found[T_END] = t + tau
    return length


@kernel
def note(t, y, mode, found, trace):
    """A row of the trace, as far as it reaches."""
    row = int(found[WRITTEN])
    if row < len(trace):
        trace[row, 0], trace[row, 1], trace[row, 2], trace[row, 3] = t, y[1], y[3], y[2]
        trace[row, 4], trace[row, 5], trace[row, 6] = mode[0] + 3 * mode[1], y[4], y[5]
        found[WRITTEN] += 1


@kernel
def solve(par, start, dt, horizontal, vertical, horizon, tolerance, longest, most_steps, patient, trace):
    """Runs a block from rest to the end that physics decides, ``horizon`` [s] after the motion at the latest.

    A ``patient`` run goes on to the horizon. Steps are ``longest`` [s] at most, so that nothing happens twice in one unseen.
    ``trace`` is filled with t, θ, θ̇, v̇, contacts, z_L, z_R of every step as far as it reaches. Returns FOUND values.
    """
    found = np.zeros(FOUND)
    found[T_FLIGHT] = found[THETA_FLIGHT] = found[PEAK_FLIGHT] = found[T_PEAK_FLIGHT] = math.nan
    work, stages = np.zeros((12, SIZE)), np.zeros((13, SIZE))
    ground, supports = np.zeros(4), np.zeros(2)
    mode = np.array([CONTACT, CONTACT, 0, 0, 0])
    y = work[0]
    y[:6] = start
    begin = stored(y, mode, par)
    npts, piece, length = len(horizontal), 0, longest
    while found[STATUS] == STANDS:
        span, t, left = dt, piece * dt, horizon
        if piece >= npts:  # sample npts is the zero that the ground falls to
            span = max(dt, 0.25 / par[P])
            t, left = npts * dt + (piece - npts) * span, horizon - (piece - npts) * span
            if left > 0.5 * horizon:
                found[HALFWAY] = found[THETA_MAX]
            if piece > npts and not patient and no_more(y, mode, supports, found, par):
                found[DECIDED] = 1
                break
            if left <= 0:
                break
        lay_ground(piece, dt, horizontal, vertical, ground)
        span = span if piece < npts else min(span, left)
        length = run_piece(t, span, length, ground, mode, supports, par, tolerance, longest, most_steps, work, stages,
                           found, trace)  # fmt: skip
        piece += 1
    if flies(mode):
        found[AIR_TIME] += found[T_END] - found[TAKE_OFF]
    found[UP_LEFT], found[UP_RIGHT] = unstressed(y, mode, supports, par)
    found[BALANCE] = stored(y, mode, par) - begin - y[6] - found[JUMPS]
    return found
