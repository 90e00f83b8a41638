"""Stops for the reference solvers: their memory, and Housner's block with them, elongations from coordinates of points.

A stop is "open", pressed in for the "first" time in a blow, or "elastic", between where it lets go and where it was deepest.
"""

import math
from collections.abc import Callable, Sequence

from reference_solver import Rigid, Surface

from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, DeckSpring, Pier, Place, RigidBase, Stop, places


class Memory:
    """Mode and greatest depth of one stop, of the stiffness ``k`` [1/s²]."""

    def __init__(self, stop: Stop | DeckSpring, k: float) -> None:
        self.gap, self.k, self.e2 = stop.gap_m, k, stop.restitution**2
        self.linear = isinstance(stop, DeckSpring) and stop.linear
        self.mode, self.deepest = "first" if self.linear else "open", 0.0
        self.blows, self.most = 0, 0.0

    def past(self, elongation: float) -> float:
        """Return how far it is pressed in beyond where it lets go."""
        return elongation - self.gap - (1.0 - self.e2) * self.deepest

    def force(self, elongation: float) -> float:
        if self.mode == "open":
            return 0.0
        return self.k * (elongation - self.gap) if self.mode == "first" else self.k / self.e2 * self.past(elongation)

    def surfaces(
        self, elongation: Callable, speed: Callable, still: float, slight: float
    ) -> list[tuple[Surface, float, str]]:
        """Return what ends its mode; ``elongation`` and ``speed`` are functions of the state."""
        if self.linear:
            return []
        if self.mode == "first":
            return [(lambda t, y: speed(y), still, "turns back")]
        if self.mode == "elastic":
            deeper = (lambda t, y: self.deepest + self.gap - elongation(y), slight, "goes on")
            return [(lambda t, y: self.past(elongation(y)), slight, "leaves"), deeper]
        met = (lambda t, y: -self.past(elongation(y)), slight, "meets")
        recovered = [(lambda t, y: elongation(y) - self.gap, slight, "recovers")] if self.deepest > 0.0 else []
        return [met, *recovered]

    def fire(self, kind: str, elongation: float) -> None:
        if kind == "turns back":
            self.mode, self.deepest = "elastic", elongation - self.gap
            self.most = max(self.most, self.k * self.deepest)
        elif kind == "goes on":
            self.mode = "first"
        elif kind == "leaves":
            self.mode = "open"
        elif kind == "recovers":
            self.deepest = 0.0
        else:
            self.blows += self.deepest == 0.0
            self.mode = "elastic" if self.deepest > 0.0 else "first"

    def after_jump(self, elongation: float, speed: float) -> None:
        """Follow a jump of the velocity."""
        if self.linear:
            return
        if self.mode == "first" and speed < 0.0:
            self.fire("turns back", elongation)
        elif self.mode == "elastic" and speed > 0.0 and elongation - self.gap >= self.deepest:
            self.mode = "first"


class StoppedBlock(Rigid):
    """Housner's block with stops, springs and linear dampers."""

    def __init__(self, pier: Pier, base: RigidBase, motion: Motion, quiet_s: float, theta0: float = 0.0) -> None:
        super().__init__(pier, base, motion, quiet_s, theta0)
        self.b, self.h, self.inertia = pier.half_width, pier.height, pier.inertia_about_pivot
        scale = pier.gravity * pier.size / pier.half_width**2
        located = [(device, place) for device in base.restraints for place in places(pier, device)]
        self.dampers = [(device.nu * pier.p, place) for device, place in located if isinstance(device, Damper)]
        self.stops = [
            (Memory(stop, stop.lam * scale), place) for stop, place in located if not isinstance(stop, Damper)
        ]

    def reach(self, place: Place, theta: float) -> tuple[float, float]:
        """Return the elongation of a device, and its rate over θ."""
        corner = self.b * self.side
        if place.height:
            way, x, y = place.way or 1.0, -corner, place.height
            moved = x * math.cos(theta) + y * math.sin(theta)
            return way * (moved - x), way * (y * math.cos(theta) - x * math.sin(theta))
        x0 = place.offset - corner
        apart = x0 * (math.cos(theta) - 1.0), -x0 * math.sin(theta)
        along = -x0 * math.sin(theta), -x0 * math.cos(theta)
        length = math.hypot(*apart)
        if length == 0.0:
            return 0.0, -x0
        sign = math.copysign(1.0, apart[1])
        return sign * length, sign * (apart[0] * along[0] + apart[1] * along[1]) / length

    def _rhs(self, leg: tuple[float, ...]) -> Callable[[float, Sequence[float]], list[float]]:
        free = super()._rhs(leg)

        def f(t: float, y: Sequence[float]) -> list[float]:
            omega, turning = free(t, y)
            for memory, s in self.stops:
                e, by_theta = self.reach(s, float(y[0]))
                turning -= memory.force(e) * by_theta / self.inertia
            for c, place in self.dampers:
                turning -= c * self.reach(place, float(y[0]))[1] ** 2 * omega / self.inertia
            return [omega, turning]

        return f

    def run(self):
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
                surfaces = [(lambda _, y: self.side * y[0], 0.0, -1, "impact")]
                for j, (memory, s) in enumerate(self.stops):
                    own = memory.surfaces(
                        lambda y, s=s: self.reach(s, y[0])[0],
                        lambda y, s=s: self.reach(s, y[0])[1] * y[1],
                        1e-13,
                        1e-14,
                    )
                    surfaces += [(g, tiny, j, kind) for g, tiny, kind in own]
                t, self.y, fired = self.leg.run(self._rhs(leg), [each[:2] for each in surfaces], t, self.y, t1, 0, 1)
                if abs(self.y[0]) > 0.5 * math.pi:
                    out.status, out.t_end = "overturned", t
                    return out
                if fired is None:
                    continue
                _, _, j, kind = surfaces[fired]
                if j >= 0:
                    memory, s = self.stops[j]
                    memory.fire(kind, self.reach(s, self.y[0])[0])
                else:
                    out.impacts += 1
                    self.y = [0.0, self.e * self.y[1]]
                    self.side = math.copysign(1.0, self.y[1]) if abs(self.y[1]) >= 1e-11 * self.p else 0.0
        out.t_end, out.theta, out.omega = self.legs[-1][1], self.y[0], self.y[1]
        return out
