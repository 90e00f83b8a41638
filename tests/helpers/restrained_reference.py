"""The reference solver with devices: elongations and their derivatives from the coordinates of points of the base.

Friction dampers without velocity are a linear complementarity problem: each has a force within its bounds, and moves only
against a force at its bound. Projected Gauss–Seidel iterations solve it.
"""

import math
from collections.abc import Sequence

import numpy as np
from reference_solver import OM, TH, VD, TwoSprings, V
from stop_reference import Memory

from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, DeckSpring, ElasticBase, Pier, Stop, Tendon, places

FIRST = 11
"""Index of the first device's state, behind those of the springs."""


class TiedTwoSprings(TwoSprings):
    """Block with devices (restraint, offset s); the states are z of hysteretic dampers and plastic elongations of tendons."""

    def __init__(self, pier: Pier, base: ElasticBase, motion: Motion, quiet_s: float) -> None:
        super().__init__(pier, base, motion, quiet_s)
        self.p, self.size = pier.p, math.hypot(self.b, self.h)
        self.places = [place for device in base.restraints for place in places(pier, device)]
        self.elements = [(device, place.offset) for device in base.restraints for place in places(pier, device)]
        self.slopes = [  # ∂e/∂v and ∂e/∂θ in first-order kinematics
            (0.0, (place.way or 1.0) * place.height) if place.height else (1.0, -place.offset) for place in self.places
        ]
        load = 1.0 + sum(device.psi for device, _ in self.elements if isinstance(device, Tendon))
        share = load * 0.5 * self.g / self.fy
        self.v0, self.z0 = -self.dy * self._static_integral(share), -share
        self.deepest = [self.z0, self.z0]
        self.y = [self.v0, 0.0, 0.0, 0.0, self.z0, self.z0] + [0.0] * (5 + len(self.elements))
        self.hold = [0.0] * len(self.elements)
        self.state = ["taut"] * len(self.elements)
        for j, (device, _) in enumerate(self.elements):
            if isinstance(device, Tendon) and device.psi == 0.0:
                self.state[j] = "slack"
        scale = self.g * self.size / self.b**2
        self.friction = [j for j, (d, _) in enumerate(self.elements) if isinstance(d, Damper) and d.kind == "friction"]
        self.braces = [d.brace * scale if isinstance(d, Damper) else math.inf for d, _ in self.elements]
        self.way = [0.0 if self.rubs(j) else 1.0 for j in range(len(self.elements))]  # 0 while friction holds
        self.stops = {
            j: Memory(d, d.lam * scale) for j, (d, _) in enumerate(self.elements) if isinstance(d, Stop | DeckSpring)
        }

    def shape(self, j: int, y: Sequence[float]) -> tuple[float, ...]:
        """Return the elongation e, ∂e/∂v, ∂e/∂θ, and what ë has beside v̈ ∂e/∂v + θ̈ ∂e/∂θ.

        The point (s, −h) of the block, as seen from its centre of mass, has risen by u. With finite kinematics e = w u,
        w² = 2/(1 + cos θ), so that w' = w q and q' = 1/(2 + 2 cos θ), where q = sin θ/(2 + 2 cos θ).
        """
        theta = y[TH]
        if not self.finite:
            by_v, by_theta = self.slopes[j]
            return by_v * (y[V] - self.v0) + by_theta * theta, by_v, by_theta, 0.0
        s, turn = self.elements[j][1], y[OM]
        if height := self.places[j].height:
            way = (self.places[j].way or 1.0) * height
            return way * math.sin(theta), 0.0, way * math.cos(theta), -way * math.sin(theta) * turn * turn
        sine, cosine = math.sin(theta), math.cos(theta)
        u = y[V] - self.v0 + (-self.h * cosine - s * sine) + self.h
        by_theta, bend = self.h * sine - s * cosine, self.h * cosine + s * sine
        w, q, q_slope = math.sqrt(2.0 / (1.0 + cosine)), sine / (2.0 + 2.0 * cosine), 0.5 / (1.0 + cosine)
        twist = w * ((q * q + q_slope) * u + 2.0 * q * by_theta + bend)
        return w * u, w, w * (q * u + by_theta), 2.0 * w * q * y[VD] * turn + twist * turn * turn

    def elongation(self, j: int, y: Sequence[float]) -> float:
        return self.shape(j, y)[0]

    def speed(self, j: int, y: Sequence[float]) -> float:
        _, by_v, by_theta, _ = self.shape(j, y)
        return by_v * y[VD] + by_theta * y[OM]

    def rubs(self, j: int) -> bool:
        return j in self.friction

    def lift(self, j: int, y: Sequence[float], accelerations: tuple[float, float]) -> float:
        """Return the second rate of the elongation."""
        _, by_v, by_theta, bend = self.shape(j, y)
        return by_v * accelerations[0] + by_theta * accelerations[1] + bend

    def still(self, modes, y, ah, av, which: Sequence[int]) -> tuple[np.ndarray, np.ndarray]:
        """Return accelerations at the dampers ``which`` without their forces, and what one of each adds to all of them."""

        def lifts() -> np.ndarray:
            accelerations = self.under_pulls(modes, y, ah, av)
            return np.array([self.lift(j, y, accelerations) for j in which])

        for j in which:
            self.hold[j] = 0.0
        free, by = lifts(), []
        for j in which:
            self.hold[j] = 1.0
            by.append(lifts() - free)
            self.hold[j] = 0.0
        return free, np.array(by).T

    def pull(self, j: int, y: Sequence[float]) -> float:
        """Return the force over the mass, in tension."""
        device, _ = self.elements[j]
        if j in self.stops:
            return self.stops[j].force(self.elongation(j, y))
        if j in self.friction:
            return self.way[j] * device.f * self.g if self.way[j] else self.hold[j]
        if isinstance(device, Tendon):
            if self.state[j] == "slack":
                return 0.0
            return device.strength * self.g if self.state[j] == "yields" else self.tension(j, y)
        if device.kind == "hysteretic":
            return device.f * self.g * y[FIRST + j]
        return y[FIRST + j] if device.brace < math.inf else self.viscous(device, self.elements[j][1], self.speed(j, y))

    def viscous(self, damper: Damper, s: float, speed: float) -> float:
        """Return C |ė|^a; if a < 1, linear where it would damp faster than the supports vibrate (THEORY.md)."""
        c, a = damper.nu * self.p, damper.exponent
        if a < 1.0:
            slow = (c * (1.0 + s * s / (self.inertia + self.h**2)) / self.omega_v) ** (1.0 / (1.0 - a))
            if abs(speed) < slow:
                return c * slow**a * speed / slow
        return math.copysign(c * abs(speed) ** a, speed)

    def tension(self, j: int, y: Sequence[float]) -> float:
        tendon = self.elements[j][0]
        stiffness = tendon.lam * self.g * self.size / self.b**2
        return tendon.psi * self.g + stiffness * (self.elongation(j, y) - y[FIRST + j])

    def accelerations(self, modes, y, ah, av):
        holding = [j for j in self.friction if not self.way[j]]
        if holding:
            free, by = self.still(modes, y, ah, av, holding)
            for j, force in zip(holding, np.linalg.solve(by, -free), strict=True):
                self.hold[j] = float(force)
        return self.under_pulls(modes, y, ah, av)

    def under_pulls(self, modes, y, ah, av):
        pulls = [(self.pull(j, y), self.shape(j, y), place) for j, place in enumerate(self.places)]
        vdd, thdd = super().accelerations(modes, y, ah, av + sum([pull * shape[1] for pull, shape, _ in pulls]))
        if "held" in modes:
            return vdd, thdd
        H = self.lever(modes, y)[0] if self.finite else self.h
        for pull, (_, _, by_theta, _), place in pulls:
            arm = by_theta if self.finite or place.height else self.h * y[TH] + by_theta  # with P–Δ
            thdd -= pull * arm / (self.inertia + H * H)
        return vdd, thdd

    def rhs(self, leg):
        plain = super().rhs(leg)
        change = [
            brace < math.inf or self.state[j] == "yields" or getattr(device, "kind", "") == "hysteretic"
            for j, ((device, _), brace) in enumerate(zip(self.elements, self.braces, strict=True))
        ]

        def f(t, y):
            y = y.tolist() if isinstance(y, np.ndarray) else y
            return plain(t, y) + [self._rate(j, y) if changes else 0.0 for j, changes in enumerate(change)]

        return f

    def _rate(self, j: int, y: Sequence[float]) -> float:
        device, brace = self.elements[j][0], self.braces[j]
        if isinstance(device, Damper) and device.kind == "hysteretic":
            z, speed = y[FIRST + j], self.speed(j, y)
            by_slip = (1.0 - (min(abs(z), 1.0) ** 5 if self.way[j] * z > 0.0 else 0.0)) / device.yield_m
            if brace < math.inf:  # F_d ż = k (ė − ẇ) with ż = ẇ by_slip
                speed *= brace / (brace + device.f * self.g * by_slip)
            return speed * by_slip
        if brace < math.inf:
            pull = y[FIRST + j]
            slip = math.copysign((abs(pull) / (device.nu * self.p)) ** (1.0 / device.exponent), pull)
            return brace * (self.speed(j, y) - slip)
        return self.speed(j, y)

    def surfaces(self, leg):
        surfaces = super().surfaces(leg)
        still, slight = 1e-13 * self.omega_v * self.dy, 1e-13 * self.g
        t0, _, h0, hs, v0, vs = leg

        def bears(t, y, j):
            self.accelerations(self.mode, y, h0 + hs * (t - t0), v0 + vs * (t - t0))
            return self.elements[j][0].f * self.g - abs(self.hold[j])

        for j, (device, _) in enumerate(self.elements):
            if j in self.stops:
                own = self.stops[j].surfaces(
                    lambda y, j=j: self.elongation(j, y), lambda y, j=j: self.speed(j, y), still, 1e-14 * self.dy
                )
                surfaces += [(g, tiny, j, kind) for g, tiny, kind in own]
            elif self.rubs(j) and not self.way[j]:
                surfaces.append((lambda t, y, j=j: bears(t, y, j), slight, j, "slips"))
            elif isinstance(device, Damper) and device.kind == "viscous" and device.brace < math.inf:
                continue
            elif isinstance(device, Damper):
                surfaces.append((lambda t, y, j=j: self.way[j] * self.speed(j, y), still, j, "turns"))
            elif self.state[j] == "yields":
                surfaces.append((lambda t, y, j=j: self.speed(j, y), still, j, "holds"))
            elif self.state[j] == "slack":
                surfaces.append((lambda t, y, j=j: -self.tension(j, y), slight, j, "holds"))
            else:
                surfaces.append((lambda t, y, j=j: self.tension(j, y), slight, j, "slackens"))
                if math.isfinite(device.strength):
                    limit = device.strength * self.g
                    surfaces.append((lambda t, y, j=j, limit=limit: limit - self.tension(j, y), slight, j, "yields"))
        return surfaces

    def _fire(self, t, i, kind, ah, av):
        after = {"holds": "taut", "slackens": "slack", "yields": "yields"}
        if kind == "turns" and not self.rubs(i):
            self.way[i] = -self.way[i]
        elif kind in ("turns", "slips"):
            self.settle_friction(ah, av)
        elif kind in after:
            self.state[i] = after[kind]
        elif kind in ("turns back", "goes on", "leaves", "recovers", "meets"):
            self.stops[i].fire(kind, self.elongation(i, self.y))
        else:
            super()._fire(t, i, kind, ah, av)
            for j in range(len(self.elements)):  # velocities may have jumped
                speed = self.speed(j, self.y)
                if speed != 0.0 and not self.rubs(j):
                    self.way[j] = math.copysign(1.0, speed)
                if j in self.stops:
                    self.stops[j].after_jump(self.elongation(j, self.y), speed)
            self.settle_friction(ah, av)

    def settle_friction(self, ah: float, av: float) -> None:
        """Let dampers that move go on; of the others, those at their bound slip, and the rest hold."""
        rubbing = [j for j in range(len(self.elements)) if self.rubs(j)]
        which = []
        for j in rubbing:
            speed = self.speed(j, self.y)
            self.way[j] = math.copysign(1.0, speed) if abs(speed) > 1e-12 * self.omega_v * self.dy else 0.0
            which += [] if self.way[j] else [j]
        if not which:
            return
        free, by = self.still(self.mode, self.y, ah, av, which)
        limits = [self.elements[j][0].f * self.g for j in which]
        forces = np.zeros(len(which))
        for _ in range(10_000):
            before = forces.copy()
            for k, limit in enumerate(limits):
                forces[k] = np.clip(forces[k] - (free[k] + by[k] @ forces) / by[k, k], -limit, limit)
            if (forces == before).all():
                break
        for j, force, limit in zip(which, forces, limits, strict=True):
            self.way[j] = math.copysign(1.0, force) if abs(force) >= (1.0 - 1e-10) * limit else 0.0
