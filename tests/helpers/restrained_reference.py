"""The reference solver with dampers and tendons: forces at points of the base, whose places come from its coordinates."""

import math
from collections.abc import Sequence

from reference_solver import OM, TH, VD, TwoSprings, V

from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, ElasticBase, Pier, Tendon, offsets

FIRST = 11
"""Of the states of elements, behind those of the springs."""


class TiedTwoSprings(TwoSprings):
    """Elements: (restraint, offset s); each keeps z of a hysteretic damper, or by how much a tendon has yielded."""

    def __init__(self, pier: Pier, base: ElasticBase, motion: Motion, quiet_s: float) -> None:
        super().__init__(pier, base, motion, quiet_s)
        self.p, self.size = pier.p, math.hypot(self.b, self.h)
        self.elements = [(each, s) for each in base.restraints for s in offsets(pier, each)]
        load = 1.0 + sum(each.psi for each, _ in self.elements if isinstance(each, Tendon))
        share = load * 0.5 * self.g / self.fy
        self.v0, self.z0 = -self.dy * self._static_integral(share), -share
        self.y = [self.v0, 0.0, 0.0, 0.0, self.z0, self.z0] + [0.0] * (5 + len(self.elements))
        self.way = [1.0] * len(self.elements)
        self.state = ["taut"] * len(self.elements)
        for j, (each, _) in enumerate(self.elements):
            if isinstance(each, Tendon) and each.psi == 0.0:
                self.state[j] = "slack"

    def rise(self, j: int, y: Sequence[float]) -> float:
        """Of the point (s, −h) of the block, as seen from its centre of mass."""
        s = self.elements[j][1]
        if self.finite:
            return y[V] - self.v0 + (-self.h * math.cos(y[TH]) - s * math.sin(y[TH])) + self.h
        return y[V] - self.v0 - s * y[TH]

    def speed(self, j: int, y: Sequence[float]) -> float:
        s = self.elements[j][1]
        turn = self.h * math.sin(y[TH]) - s * math.cos(y[TH]) if self.finite else -s
        return y[VD] + turn * y[OM]

    def pull(self, j: int, y: Sequence[float]) -> float:
        """Over the mass, downwards."""
        each, _ = self.elements[j]
        speed = self.speed(j, y)
        if isinstance(each, Tendon):
            if self.state[j] == "slack":
                return 0.0
            return each.strength * self.g if self.state[j] == "yields" else self.tension(j, y)
        if each.kind == "viscous":
            return self.viscous(each, self.elements[j][1], speed)
        return each.f * self.g * y[FIRST + j]

    def viscous(self, damper: Damper, s: float, speed: float) -> float:
        """C |ė|^a; where a < 1, linear where it would damp faster than the supports vibrate (THEORY.md)."""
        c, a = damper.nu * self.p, damper.exponent
        if a < 1.0:
            slow = (c * (1.0 + s * s / (self.inertia + self.h**2)) / self.omega_v) ** (1.0 / (1.0 - a))
            if abs(speed) < slow:
                return c * slow**a * speed / slow
        return math.copysign(c * abs(speed) ** a, speed)

    def tension(self, j: int, y: Sequence[float]) -> float:
        tendon = self.elements[j][0]
        stiffness = tendon.lam * self.g * self.size / self.b**2
        return tendon.psi * self.g + stiffness * (self.rise(j, y) - y[FIRST + j])

    def accelerations(self, modes, y, ah, av):
        pulls = [self.pull(j, y) for j in range(len(self.elements))]
        vdd, thdd = super().accelerations(modes, y, ah, av + sum(pulls))
        if "held" in modes:
            return vdd, thdd
        for pull, (_, s) in zip(pulls, self.elements, strict=True):
            arm = self.h * math.sin(y[TH]) - s * math.cos(y[TH]) if self.finite else self.h * y[TH] - s
            H = self.lever(modes, y)[0] if self.finite else self.h
            thdd -= pull * arm / (self.inertia + H * H)
        return vdd, thdd

    def rhs(self, leg):
        plain = super().rhs(leg)

        def f(t, y):
            y = [float(each) for each in y]
            return plain(t, y) + [self._rate(j, y) for j in range(len(self.elements))]

        return f

    def _rate(self, j: int, y: Sequence[float]) -> float:
        each, _ = self.elements[j]
        speed = self.speed(j, y)
        if isinstance(each, Damper) and each.kind == "hysteretic":
            z = y[FIRST + j]
            return speed / each.yield_m * (1.0 - (abs(z) ** 5 if self.way[j] * z > 0.0 else 0.0))
        return speed if self.state[j] == "yields" else 0.0

    def surfaces(self, leg):
        found = super().surfaces(leg)
        still, slight = 1e-13 * self.omega_v * self.dy, 1e-13 * self.g
        for j, (each, _) in enumerate(self.elements):
            if isinstance(each, Damper):
                found.append((lambda t, y, j=j: self.way[j] * self.speed(j, y), still, j, "turns"))
            elif self.state[j] == "yields":
                found.append((lambda t, y, j=j: self.speed(j, y), still, j, "holds"))
            elif self.state[j] == "slack":
                found.append((lambda t, y, j=j: -self.tension(j, y), slight, j, "holds"))
            else:
                found.append((lambda t, y, j=j: self.tension(j, y), slight, j, "slackens"))
                if math.isfinite(each.strength):
                    limit = each.strength * self.g
                    found.append((lambda t, y, j=j, limit=limit: limit - self.tension(j, y), slight, j, "yields"))
        return found

    def _fire(self, t, i, kind, ah, av):
        after = {"holds": "taut", "slackens": "slack", "yields": "yields"}
        if kind == "turns":
            self.way[i] = -self.way[i]
        elif kind in after:
            self.state[i] = after[kind]
        else:
            super()._fire(t, i, kind, ah, av)
            for j in range(len(self.elements)):  # velocities may have jumped
                speed = self.speed(j, self.y)
                if speed != 0.0:
                    self.way[j] = math.copysign(1.0, speed)
