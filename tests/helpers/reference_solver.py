"""A second implementation of the model for the tests: SciPy's DOP853, one leg per smooth stretch, no code of the core.

Between two events and two changes of slope of the ground the equations are smooth. Each such leg is integrated to rounding, its
end is polished by repeating the last step, and the next leg starts from there. Slow and plain on purpose.

Symbols: α, μ, p, b, h, o_i, z_i as in THEORY.md, Symbols; everything is per unit mass, SI, radians.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

from rockbatch.motions.motion import Motion
from rockbatch.pier import ElasticBase, Pier, RigidBase, YieldingBase

RTOL, ATOL = 1e-12, 1e-14
FRACTIONS = (0.05, 0.2, 0.4, 0.6, 0.8, 1.0)
TOO_MANY_EVENTS = 20_000

Surface = Callable[[float, list[float]], float]


@dataclass
class ReferenceRun:
    """Results of a run; ``events`` holds (time, kind, pivot)."""

    status: str = "ok"
    t_end: float = 0.0
    theta_max: float = 0.0
    t_max: float = 0.0
    theta: float = 0.0
    omega: float = 0.0
    v: float = 0.0
    v_rate: float = 0.0
    impacts: int = 0
    separations: int = 0
    t_flight: float | None = None
    base_left: float = 0.0
    base_right: float = 0.0
    dissipated_left: float = 0.0
    dissipated_right: float = 0.0
    ledger: dict[str, float] = field(default_factory=dict)
    events: list[tuple[float, str, str]] = field(default_factory=list)


def ground_legs(motion: Motion, quiet_s: float) -> list[tuple[float, float, float, float, float, float]]:
    """Return stretches of linear ground acceleration: t0, t1, ü_g(t0), its slope, v̈_g(t0), its slope."""
    dt = motion.dt
    quiet = math.ceil(quiet_s / dt - 1e-9)
    count = motion.npts + quiet
    horizontal, vertical = np.zeros(count), np.zeros(count)
    horizontal[: motion.npts] = motion.horizontal
    if motion.vertical is not None:
        vertical[: motion.npts] = motion.vertical
    legs, i = [], 0
    while i < count - 1:
        j = i + 1
        slopes = (horizontal[j] - horizontal[i]) / dt, (vertical[j] - vertical[i]) / dt
        if not (horizontal[i] or vertical[i] or slopes[0] or slopes[1]):
            while j < count - 1 and not (horizontal[j + 1] or vertical[j + 1]):
                j += 1
        legs.append(
            (
                i * dt,
                j * dt,
                float(horizontal[i]),
                float(slopes[0]),
                float(vertical[i]),
                float(slopes[1]),
            )
        )
        i = j
    return legs


class Leg:
    """Integration of one smooth stretch up to the first event function that crosses zero downwards."""

    def __init__(self, peak: Callable[[float, float], None], h: float) -> None:
        self.peak = peak  # called with (t, θ) at every velocity reversal
        self.h = h

    def run(
        self,
        rhs: Callable[[float, Sequence[float]], list[float]],
        surfaces: list[tuple[Surface, float]],
        t0: float,
        y0: list[float],
        t1: float,
        theta: int,
        omega: int,
    ) -> tuple[float, list[float], int | None]:
        """Return the final time and state, and the surface that ended the leg (None at ``t1``).

        A surface is positive while the mode lasts; its scale separates rounding from departure. One on which the leg
        starts counts once it has been left; if it is left on the wrong side, it fires at once.
        """
        armed = [g(t0, y0) > tiny for g, tiny in surfaces]
        solver = DOP853(
            rhs, t0, np.array(y0), t1, rtol=RTOL, atol=ATOL, first_step=min(self.h, t1 - t0), max_step=self.h
        )
        while solver.status == "running":
            a, ya = solver.t, solver.y.tolist()
            message = solver.step()
            if solver.status == "failed":
                raise ArithmeticError(message)
            b, dense = solver.t, solver.dense_output()
            hit: tuple[float, int] | None = None
            times = [a + f * (b - a) for f in FRACTIONS]
            states = [*dense(np.array(times[:-1])).T.tolist(), solver.y.tolist()]
            for k, (g, tiny) in enumerate(surfaces):
                before = a
                for s, state in zip(times, states, strict=True):
                    value = g(s, state)
                    if not armed[k] and value < -tiny:
                        hop = self._hop(g, tiny, dense, before, s)
                        if hop is None:
                            return t0, y0, k
                        before, armed[k] = hop, True
                    if armed[k] and value <= 0.0:
                        root = self._root(g, dense, before, s)
                        if hit is None or root < hit[0]:
                            hit = root, k
                        break
                    armed[k] = armed[k] or value > tiny
                    before = s
            if hit is not None:
                root, k = hit
                root, state = self._polish(rhs, surfaces[k][0], a, ya, root, b)
                times = [a + f * (root - a) for f in FRACTIONS]
                states = [*dense(np.array(times[:-1])).T.tolist(), state]
                self._turning(dense, [a, *times], [ya, *states], theta, omega)
                return root, state, k
            self._turning(dense, [a, *times], [ya, *states], theta, omega)
        return t1, solver.y.tolist(), None

    @staticmethod
    def _root(g, dense, before, after):
        """Return where ``g`` falls through zero between two times, from the step's interpolant."""
        if g(before, dense(before).tolist()) <= 0.0:
            return before
        return brentq(lambda x: g(x, dense(x).tolist()), before, after, xtol=1e-17, rtol=1e-15)

    @staticmethod
    def _hop(g, tiny, dense, before, after):
        """Return a time shortly after ``before`` at which ``g`` is positive, if it left its surface and came back at once."""
        for j in range(1, 15):
            s = before + (after - before) * 0.5**j
            if g(s, dense(s).tolist()) > tiny:
                return s
        return None

    @staticmethod
    def _polish(rhs, surface, a, ya, root, b):
        """Repeat the step up to the root, and correct the root: the interpolant is of lower order than the step."""

        def state_at(s: float) -> list[float]:
            if s - a <= 4e-16 * max(1.0, abs(a)):
                return list(ya)
            solver = DOP853(rhs, a, np.array(ya), s, rtol=RTOL, atol=ATOL, first_step=s - a)
            while solver.status == "running":
                solver.step()
            return solver.y.tolist()

        state = state_at(root)
        for _ in range(2):
            rate = rhs(root, state)
            step = 1e-7 * (b - a)
            ahead = [x + step * r for x, r in zip(state, rate, strict=True)]
            slope = (surface(root + step, ahead) - surface(root, state)) / step
            if slope >= 0.0:
                break
            moved = root - surface(root, state) / slope
            if not a <= moved <= b or abs(moved - root) > 1e-3 * (b - a):
                break
            root, state = moved, state_at(moved)
        return root, state

    def _turning(self, dense, times, states, theta, omega) -> None:
        self.peak(times[-1], states[-1][theta])
        for i in range(len(times) - 1):
            if states[i][omega] * states[i + 1][omega] < 0.0:
                pair = times[i : i + 2]
                if dense(pair[0])[omega] * dense(pair[1])[omega] < 0.0:
                    s = brentq(lambda x: float(dense(x)[omega]), *pair, xtol=1e-15)
                    self.peak(s, float(dense(s)[theta]))


V, TH, VD, OM, ZL, ZR, WL, WR, INPUT, PDELTA, LOST = range(11)
SIDES = ("left", "right")
CURVED = ("bouc-wen", "hardening")
OFF = ("free", "held")
"""Modes of a pivot that its spring does not bear."""


class TwoSprings:
    """Block on two springs; each pivot is in one of the modes "free", "held", "load", "unload", "yield"."""

    def __init__(self, pier: Pier, base: ElasticBase, motion: Motion, quiet_s: float) -> None:
        r = pier.mu / (1.0 + pier.mu) * pier.gravity / pier.p**2
        self.b, self.h = r * math.sin(pier.alpha), r * math.cos(pier.alpha)
        self.inertia, self.g = r * r / pier.mu, pier.gravity
        self.omega_v = base.beta * pier.p
        static = self.g / self.omega_v**2
        self.law, eta, self.n = "elastic", 1.0, 1.0
        if isinstance(base, YieldingBase):
            self.law, eta, self.n = base.spring, base.eta, base.n
        self.dy, self.fy = eta * static, 0.5 * eta * self.g
        self.finite = base.kinematics == "finite"
        self.guided = base.flight == "guided"
        self.eps = base.epsilon
        self.e = max(0.0, 1.0 - 2.0 * self.b**2 / (self.inertia + r * r)) if base.impact == "housner" else None
        self.zeta = base.zeta or 0.0
        self.c = self.zeta * self.omega_v  # C/M
        if self.zeta:
            self.lag, self.quick = self.c / self.fy, self.omega_v / (2.0 * self.zeta)
        z0 = -1.0 / eta
        self.v0 = -self.dy * self._static_integral(1.0 / eta)
        self.z0 = z0
        self.y = [self.v0, 0.0, 0.0, 0.0, z0, z0, 0.0, 0.0, 0.0, 0.0, 0.0]
        self.mode = ["unload", "unload"]
        self.deepest = [z0, z0]  # of a hardening spring when it was last unloaded
        self.rest = [0.0, 0.0]  # o_i
        self.legs = ground_legs(motion, quiet_s)
        self.out = ReferenceRun()
        self.impact_loss = self.constraint = 0.0
        self.leg = Leg(self._peak, min(0.25 / self.omega_v, 0.02))
        self.count = 0

    def _static_integral(self, s: float) -> float:
        if self.law not in CURVED:
            return s
        from scipy.integrate import quad

        return quad(lambda x: 1.0 / (1.0 - x**self.n), 0.0, s, epsabs=0.0, epsrel=1e-13)[0]

    def _peak(self, t: float, theta: float) -> None:
        if abs(theta) > self.out.theta_max:
            self.out.theta_max, self.out.t_max = abs(theta), t

    # Kinematics of pivot i = 0 (left), 1 (right)

    def pivot(self, i: int, y: Sequence[float]) -> float:
        s = 1.0 - 2.0 * i
        if self.finite:
            return y[V] + s * self.b * math.sin(y[TH]) + 2.0 * self.h * math.sin(0.5 * y[TH]) ** 2
        return y[V] + s * self.b * y[TH]

    def arm(self, i: int, y: Sequence[float]) -> float:
        s = 1.0 - 2.0 * i
        if self.finite:
            return s * self.b * math.cos(y[TH]) + self.h * math.sin(y[TH])
        return s * self.b

    def bend(self, i: int, y: Sequence[float]) -> float:
        s = 1.0 - 2.0 * i
        return -s * self.b * math.sin(y[TH]) + self.h * math.cos(y[TH]) if self.finite else 0.0

    def rate(self, i: int, y: Sequence[float]) -> float:
        return y[VD] + self.arm(i, y) * y[OM]

    def lever(self, modes: Sequence[str], y: Sequence[float]) -> tuple[float, float]:
        left, right = modes[0] != "free", modes[1] != "free"
        side = float(right) - float(left)  # +1 only right, −1 only left
        if self.finite:
            s, c = math.sin(y[TH]), math.cos(y[TH])
            return self.h * c + side * self.b * s, -self.h * s + side * self.b * c
        return self.h + side * self.b * y[TH], 0.0

    # A damped support: force F_y z + C v̇_i under its pivot; without it, F_y z + C ẇ = 0, so that z falls off with τ

    def forces(self, modes: Sequence[str], y: Sequence[float]) -> list[float]:
        if not self.zeta:
            return [self.fy * y[ZL], self.fy * y[ZR]]
        return [0.0 if modes[i] in OFF else self.fy * y[ZL + i] + self.c * self.rate(i, y) for i in (0, 1)]

    def top(self, i: int, y: Sequence[float]) -> float:
        return self.rest[i] + (self.dy * y[ZL + i] if self.zeta else 0.0)

    def top_rate(self, i: int, y: Sequence[float]) -> float:
        return -self.dy * y[ZL + i] * self.quick if self.zeta else 0.0

    def top_acceleration(self, i: int, y: Sequence[float]) -> float:
        return self.dy * y[ZL + i] * self.quick**2 if self.zeta else 0.0

    def pressed(self, i: int, y: Sequence[float]) -> float:
        return -y[ZL + i] - (self.lag * self.rate(i, y) if self.zeta else 0.0)

    def accelerations(self, modes: Sequence[str], y: Sequence[float], ah: float, av: float) -> tuple[float, float]:
        fl, fr = self.forces(modes, y)
        vdd = -self.g - av - fl - fr
        H, Hp = self.lever(modes, y)
        th = y[TH]
        if self.finite:
            s, c = math.sin(th), math.cos(th)
            moment = -fl * (self.b * c + self.h * s) + fr * (self.b * c - self.h * s)
            thdd = (moment - H * ah - H * Hp * y[OM] ** 2) / (self.inertia + H * H)
        else:
            moment = -fl * (self.b + self.h * th) + fr * (self.b - self.h * th)
            thdd = (moment - H * ah) / (self.inertia + self.h**2)
        for i in (0, 1) if "held" in modes else ():
            if modes[i] == "held":  # grazing contact: between the two equations, so that the pivot stays
                thdd = -(vdd - self.top_acceleration(i, y) + self.bend(i, y) * y[OM] ** 2) / self.arm(i, y)
        return vdd, thdd

    def pivot_acceleration(self, i: int, as_mode: str, y: Sequence[float], ah: float, av: float) -> float:
        modes = list(self.mode)
        modes[i] = as_mode
        vdd, thdd = self.accelerations(modes, y, ah, av)
        return vdd - self.top_acceleration(i, y) + self.arm(i, y) * thdd + self.bend(i, y) * y[OM] ** 2

    def z_rate(self, mode: str, z: float, rate: float) -> float:
        """Return ż of a pivot that moves at ``rate``."""
        if mode in OFF and self.zeta:
            return -z * self.quick
        if mode in OFF or mode == "yield":
            return 0.0
        if mode == "load" and self.law in CURVED:
            return rate / self.dy * (1.0 - min(abs(z), 1.0) ** self.n)  # a trial of a large step may leave the law
        return rate / self.dy

    def rhs(self, leg: tuple[float, ...]) -> Callable[[float, Sequence[float]], list[float]]:
        t0, _, h0, hs, v0, vs = leg

        modes, dy, undamped = tuple(self.mode), self.dy, not self.zeta
        left, right = modes[0] not in OFF, modes[1] not in OFF

        def f(t: float, y: Sequence[float]) -> list[float]:
            y = y.tolist() if isinstance(y, np.ndarray) else y
            ah, av = h0 + hs * (t - t0), v0 + vs * (t - t0)
            vdd, thdd = self.accelerations(modes, y, ah, av)
            sunk = self.rate(0, y), self.rate(1, y)
            zl, zr = self.z_rate(modes[0], y[ZL], sunk[0]), self.z_rate(modes[1], y[ZR], sunk[1])
            wl = self.fy * y[ZL] * (sunk[0] - dy * zl) if left else 0.0
            wr = self.fy * y[ZR] * (sunk[1] - dy * zr) if right else 0.0
            lost = (
                0.0
                if undamped
                else self.c * sum((sunk[i] if on else self.top_rate(i, y)) ** 2 for i, on in enumerate((left, right)))
            )
            work = -ah * self.lever(modes, y)[0] * y[OM] - av * y[VD]
            pd = 0.0 if self.finite else -self.h * y[TH] * sum(self.forces(modes, y)) * y[OM]
            return [y[VD], y[OM], vdd, thdd, zl, zr, wl, wr, work, pd, lost]

        return f

    def surfaces(self, leg: tuple[float, ...]) -> list[tuple[Surface, float, int, str]]:
        t0, _, h0, hs, v0, vs = leg
        speed = 1e-13 * self.omega_v * self.dy
        surfaces: list[tuple[Surface, float, int, str]] = []
        for i in (0, 1):
            mode = self.mode[i]
            if mode == "free":
                surfaces.append((lambda t, y, i=i: self.pivot(i, y) - self.top(i, y), 1e-14 * self.dy, i, "land"))
            elif mode == "held":
                for as_mode, sign in (("load", 1.0), ("free", -1.0)):
                    surfaces.append(
                        (
                            lambda t, y, i=i, m=as_mode, s=sign: (
                                s * self.pivot_acceleration(i, m, y, h0 + hs * (t - t0), v0 + vs * (t - t0))
                            ),
                            1e-12 * self.g,
                            i,
                            "released to " + as_mode,
                        )
                    )
            elif self.law == "elastic":
                surfaces.append((lambda t, y, i=i: self.pressed(i, y), 1e-14, i, "separate"))
            elif self.law == "epp":
                if mode == "yield":
                    surfaces.append((lambda t, y, i=i: -self.rate(i, y), speed, i, "unload"))
                else:
                    surfaces.append((lambda t, y, i=i: self.pressed(i, y), 1e-14, i, "separate"))
                    surfaces.append((lambda t, y, i=i: 1.0 + y[ZL + i], 1e-14, i, "yield"))
            elif mode == "load":
                surfaces.append((lambda t, y, i=i: -self.rate(i, y), speed, i, "unload"))
            elif self.law == "hardening":
                surfaces.append((lambda t, y, i=i: self.pressed(i, y), 1e-14, i, "separate"))
                surfaces.append((lambda t, y, i=i: y[ZL + i] - self.deepest[i], 1e-14, i, "load"))
            else:
                surfaces.append((lambda t, y, i=i: self.rate(i, y), speed, i, "load"))
                surfaces.append((lambda t, y, i=i: self.pressed(i, y), 1e-14, i, "separate"))
        return surfaces

    # Events

    def _note(self, t: float, kind: str, i: int) -> None:
        self.out.events.append((float(t), kind, SIDES[i]))

    def _change(self, i: int, mode: str) -> None:
        """Change a pivot's contact, with the constraint's energy ½ Δ(H²) θ̇² (large-rotation kinematics)."""
        before = self.lever(self.mode, self.y)[0]
        self.mode[i] = mode
        if self.finite:
            self.constraint += 0.5 * (self.lever(self.mode, self.y)[0] ** 2 - before**2) * self.y[OM] ** 2

    def _lift(self, t: float, i: int) -> None:
        self.y[ZL + i] = -self.lag * max(self.rate(i, self.y), 0.0) if self.zeta else 0.0
        self.rest[i] = self.pivot(i, self.y) - self.dy * self.y[ZL + i]
        self._change(i, "free")
        self.out.separations += 1
        self._note(t, "separation", i)
        if self.mode == ["free", "free"] and self.out.t_flight is None:
            self.out.t_flight = t

    def _land(self, t: float, i: int, ah: float, av: float) -> None:
        y, other = self.y, 1 - i
        if self.zeta:  # no impulse
            self.out.impacts += 1
            self._note(t, "impact", i)
            if abs(self.rate(i, y) - self.top_rate(i, y)) <= 1e-13 * self.omega_v * self.dy:
                self._settle(t, i, ah, av)
            else:
                self._change(i, self._branch(i))
            return
        if self.e is not None and self.rate(i, y) > 0.0:  # after a hop too low for the search: the bounces are over
            self.out.impacts += 1
            self._note(t, "impact", i)
            self._stop(i)
            self._settle(t, i, ah, av)
            return
        both = (
            self.mode[other] == "free"
            and self.pivot(other, y) - self.rest[other] < 1e-13 * self.dy
            and self.rate(other, y) < 0.0
        )
        if self.e is not None:
            self._turn_less(i, both)
        elif both:  # two impulses: both pivots' velocities, hence v̇ and θ̇, are multiplied by ε
            y[VD] *= self.eps
            y[OM] *= self.eps
        else:
            a, full = self.arm(i, y), self.h * math.cos(y[TH]) if self.finite else self.h
            I = self.inertia + full**2  # noqa: E741
            rate = self.rate(i, y)
            J = -(1.0 - self.eps) * rate / (1.0 + a * a / I)
            self.impact_loss += 0.5 * (1.0 - self.eps**2) * rate**2 / (1.0 + a * a / I)
            if self.finite:  # the impulse changes θ̇ at the full contact's H
                before = self.lever(self.mode, y)[0]
                self.constraint += 0.5 * (full**2 - before**2) * y[OM] ** 2
            y[VD] += J
            y[OM] += J * a / I
            if self.finite:
                self.mode[i] = "load"
                self.constraint += 0.5 * (self.lever(self.mode, y)[0] ** 2 - full**2) * y[OM] ** 2
        for k in (i, other) if both else (i,):
            self.mode[k] = "load" if self.law == "bouc-wen" else "unload"
            y[ZL + k] = 0.0
            self.out.impacts += 1
            self._note(t, "impact", k)
        for k in (i, other) if both else (i,):
            if abs(self.rate(k, y)) <= 1e-13 * self.omega_v * self.dy:
                self._settle(t, k, ah, av)
            elif self.rate(k, y) > 0.0:
                self._lift(t, k)

    def _turn_less(self, i: int, both: bool) -> None:
        """Multiply θ̇ by Housner's e; the other pivot keeps its velocity where it stands on its support, else v̇ is kept."""
        y, other, full = self.y, 1 - i, self.h * math.cos(self.y[TH]) if self.finite else self.h

        def energy(lever: float) -> float:
            return 0.5 * y[VD] ** 2 + 0.5 * (self.inertia + lever**2) * y[OM] ** 2

        before, stands = self.rate(other, y), self.mode[other] != "free"
        lever = self.lever(self.mode, y)[0] if self.finite else full
        self.constraint += energy(full) - energy(lever)
        was = energy(full)
        y[OM] *= self.e
        if stands:
            y[VD] += before - self.rate(other, y)
        self.impact_loss += was - energy(full)
        for k in (i, other) if both else (i,):
            self.mode[k] = "load"
        lever = self.lever(self.mode, y)[0] if self.finite else full
        self.constraint += energy(lever) - energy(full)

    def _stop(self, i: int) -> None:
        """Take its velocity from a pivot; the other one keeps its own."""
        y, rate = self.y, self.rate(i, self.y)
        arm, other = self.arm(i, y), self.arm(1 - i, y)
        y[OM] -= rate / (arm - other)
        y[VD] += other * rate / (arm - other)

    def _branch(self, i: int) -> str:
        rising = bool(self.zeta) and self.rate(i, self.y) > 0.0
        return "load" if self.law == "bouc-wen" and not rising else "unload"

    def _settle(self, t: float, i: int, ah: float, av: float) -> None:
        """Decide the mode of a pivot at z = 0 without velocity: loaded, lifted, or in grazing contact."""
        if self.pivot_acceleration(i, "load", self.y, ah, av) <= 0.0:
            self.mode[i] = self._branch(i)
        elif self.pivot_acceleration(i, "free", self.y, ah, av) > 0.0:
            self._lift(t, i)
        else:
            self.mode[i] = "held"
            self._note(t, "held", i)

    def _fire(self, t: float, i: int, kind: str, ah: float, av: float) -> None:
        if kind == "land":
            self._land(t, i, ah, av)
        elif kind == "separate":
            self.y[ZL + i] = -self.lag * max(self.rate(i, self.y), 0.0) if self.zeta else 0.0
            self.rest[i] = self.pivot(i, self.y) - self.dy * self.y[ZL + i]
            if self.rate(i, self.y) > 1e-13 * self.omega_v * self.dy and not self.zeta:
                self._lift(t, i)
            else:
                self._settle(t, i, ah, av)
        elif kind == "released to free":
            self._lift(t, i)
        elif kind == "released to load":
            self.mode[i] = self._branch(i)
        else:
            if kind == "yield":
                self.y[ZL + i] = -1.0
            elif self.law == "hardening" and kind == "load":
                self.y[ZL + i] = self.deepest[i]
            elif self.law == "hardening":
                self.deepest[i] = self.y[ZL + i]
            self.mode[i] = kind

    def run(self) -> ReferenceRun:
        out = self.out
        for leg in self.legs:
            t, t1 = leg[0], leg[1]
            while t < t1:
                surfaces = self.surfaces(leg)
                t, self.y, fired = self.leg.run(self.rhs(leg), [s[:2] for s in surfaces], t, self.y, t1, TH, OM)
                if fired is not None:
                    passed = t - leg[0]
                    _, _, i, kind = surfaces[fired]
                    self._fire(t, i, kind, leg[2] + leg[3] * passed, leg[4] + leg[5] * passed)
                    self.count += 1
                    if self.count > TOO_MANY_EVENTS:
                        out.status = "chatter"
                        return self._finish(t)
                if out.t_flight is not None and not self.guided:
                    out.status = "overturned" if self._falls() else "flight"
                    return self._finish(t)
                if abs(self.y[TH]) > 0.5 * math.pi:
                    out.status = "overturned"
                    return self._finish(t)
        return self._finish(self.legs[-1][1])

    def _falls(self) -> bool:
        """Return whether a pier that leaves the ground turns outwards where no ground acceleration can turn it back."""
        y, beyond = self.y, abs(self.y[TH]) - math.atan2(self.b, self.h)
        strongest = max(abs(h0 + slope * (t - t0)) for t0, t1, h0, slope, *_ in self.legs for t in (t0, t1))
        return beyond >= 0.0 and y[TH] * y[OM] > 0.0 and self.g * math.tan(beyond) >= strongest

    def _finish(self, t: float) -> ReferenceRun:
        y, out = self.y, self.out
        out.t_end, out.theta, out.omega, out.v, out.v_rate = t, y[TH], y[OM], y[V], y[VD]
        bases = [self.rest[i] if self.mode[i] == "free" else self.pivot(i, y) - self.dy * y[ZL + i] for i in (0, 1)]
        out.base_left, out.base_right = bases
        out.dissipated_left, out.dissipated_right = y[WL], y[WR]
        H = self.lever(self.mode, y)[0] if self.finite else self.h
        stored = 0.5 * y[VD] ** 2 + 0.5 * (self.inertia + H**2) * y[OM] ** 2 + self.g * (y[V] - self.v0)
        stored += sum(0.5 * self.fy * self.dy * (y[k] ** 2 - self.z0**2) for k in (ZL, ZR))
        out.ledger = {
            "stored": stored,
            "input": y[INPUT],
            "plastic": y[WL] + y[WR],
            "impact": self.impact_loss,
            "p_delta": y[PDELTA],
            "constraint": self.constraint,
            "damping": y[LOST],
        }
        return out


class Rigid:
    """Housner's block: at rest, or rocking about the pivot given by the sign s of θ."""

    def __init__(self, pier: Pier, base: RigidBase, motion: Motion, quiet_s: float, theta0: float = 0.0) -> None:
        self.alpha, self.p, self.g = pier.alpha, pier.p, pier.gravity
        e = base.restitution
        self.e = 1.0 - 2.0 * pier.mu / (1.0 + pier.mu) * math.sin(pier.alpha) ** 2 if e is None else e
        self.legs = ground_legs(motion, quiet_s)
        self.out = ReferenceRun()
        self.side = math.copysign(1.0, theta0) if theta0 else 0.0
        self.y = [theta0, 0.0]
        self.leg = Leg(self._peak, 0.02)
        self._peak(0.0, theta0)

    def _peak(self, t: float, theta: float) -> None:
        if abs(theta) > self.out.theta_max:
            self.out.theta_max, self.out.t_max = abs(theta), t

    def _lift_off(self, leg: tuple[float, ...], t: float) -> float | None:
        """Return the first instant ≥ t in the leg at which |ü_g| exceeds (g + v̈_g) tan α."""
        t0, t1, h0, hs, v0, vs = leg
        first = None
        for s in (1.0, -1.0):
            excess = s * h0 - (self.g + v0) * math.tan(self.alpha)
            slope = s * hs - vs * math.tan(self.alpha)
            now = excess + slope * (t - t0)
            when = None
            if now > 0.0 or (now == 0.0 and slope > 0.0):
                when = t
            elif slope > 0.0 and t0 - excess / slope < t1:
                when = max(t, t0 - excess / slope)
            if when is not None and (first is None or when < first[0]):
                first = when, -s
        if first is None:
            return None
        self.side = first[1]
        return first[0]

    def _rhs(self, leg: tuple[float, ...]) -> Callable[[float, Sequence[float]], list[float]]:
        t0, _, h0, hs, v0, vs = leg

        def f(t: float, y: Sequence[float]) -> list[float]:
            up = 1.0 + (v0 + vs * (t - t0)) / self.g
            push = (h0 + hs * (t - t0)) / self.g
            angle = self.alpha * self.side - float(y[0])
            return [float(y[1]), -(self.p**2) * (up * math.sin(angle) + push * math.cos(angle))]

        return f

    def run(self) -> ReferenceRun:
        out = self.out
        for leg in self.legs:
            t, t1 = leg[0], leg[1]
            while t < t1:
                if self.side == 0.0:
                    lift = self._lift_off(leg, t)
                    if lift is None:
                        break
                    t, self.y = lift, [0.0, 0.0]
                    out.separations += 1
                    out.events.append((float(t), "lift-off", ""))

                raised = [(lambda _, y: self.side * y[0], 0.0)]
                t, self.y, fired = self.leg.run(self._rhs(leg), raised, t, self.y, t1, 0, 1)
                if abs(self.y[0]) > 0.5 * math.pi:
                    out.status, out.t_end = "overturned", t
                    return out
                if fired is not None:
                    out.impacts += 1
                    out.events.append((float(t), "impact", ""))
                    self.y = [0.0, self.e * self.y[1]]
                    self.side = math.copysign(1.0, self.y[1])
                    if abs(self.y[1]) < 1e-11 * self.p:
                        self.side = 0.0
        out.t_end, out.theta, out.omega = self.legs[-1][1], self.y[0], self.y[1]
        return out


def reference(pier: Pier, base: ElasticBase | RigidBase, motion: Motion, quiet_s: float = 0.0) -> ReferenceRun:
    """Return the run of ``pier`` on ``base`` under ``motion``, to about ten digits."""
    if isinstance(base, RigidBase):
        return Rigid(pier, base, motion, quiet_s).run()
    return TwoSprings(pier, base, motion, quiet_s).run()
