"""The reference solver with devices on rigid ground: rest, rocking about a pivot, guided flight, landings; no code of the core.

The devices are those of ``restrained_reference``. A corner is in the air from where the ground would have to hold it down until
it comes back, and a landing behind which the ground would have to do so does not end the flight.
"""

import math
from collections.abc import Sequence

from reference_solver import OM, TH, VD, Surface, TwoSprings, V
from restrained_reference import TiedTwoSprings

from rockbatch.motions.motion import Motion
from rockbatch.pier import Damper, ElasticBase, Pier, RigidBase

STEEP = 100.0
"""Rate over p up to which a damper whose force has an unbounded slope at rest slows a block on rigid ground (THEORY.md)."""

MIDDLE = 0.0
NO_TIME, NO_SPEED = 1e-7, 1e-9
"""Length [s] of a hop, and speed [m/s] of a pivot at its end, up to which it is none."""


class RigidGround(TwoSprings):
    """Ground that does not give, under a block without devices: ``foot`` is the pivot that bears, None at rest and in flight."""

    def stand(self, pier: Pier, base: RigidBase) -> None:
        """Put the block on the ground."""
        self.restitution = pier.restitution if base.restitution is None else base.restitution
        self.v0, self.foot, self.key, self.flies = 0.0, None, MIDDLE, False
        self.mode, self.y[:OF_PIER] = ["load", "load"], [0.0] * OF_PIER
        self.flights: list[list[float]] = []
        self.rested = False

    def arms(self, theta: float, side: float) -> tuple[float, float]:
        """Return dv/dθ about the pivot on ``side``, or the middle, and the height of the centre of mass above it."""
        s, c = math.sin(theta), math.cos(theta)
        return side * self.b * c - self.h * s, self.h * c + side * self.b * s

    def surfaces(self, leg: tuple[float, ...]) -> list[tuple[Surface, float, int, str]]:
        t0, _, h0, hs, v0, vs = leg

        def at(t: float) -> tuple[float, float]:
            return h0 + hs * (t - t0), v0 + vs * (t - t0)

        if self.flies:
            return [(lambda t, y, i=i: self.pivot(i, y), 1e-15 * self.h, i, "lands") for i in (0, 1)]
        if self.foot is None:
            return [
                (lambda t, y, i=i: -self.opening(y, *at(t), 1.0 - 2.0 * i), 1e-13 * self.g / self.h, i, "lifts off")
                for i in (1, 0)
            ]
        side = self.foot
        return [
            (lambda t, y: side * y[TH], 0.0, 0, "passes"),
            (lambda t, y: self.normal(y, *at(t), side), 1e-13 * self.g, 0, "takes off"),
        ]

    def _fire(self, t: float, i: int, kind: str, ah: float, av: float) -> None:
        if kind == "lifts off":
            self._foot_on(1.0 - 2.0 * i, t, ah, av)
            self.out.separations += 1
        elif kind == "takes off":
            self._leave(t)
        elif kind == "passes":
            self._pass(t, ah, av)
        else:
            self._land(t, i, ah, av)

    def _leave(self, t: float) -> None:
        self.key, self.foot, self.flies = self.foot, None, True
        self.flights.append([t, math.nan])
        self._note(t, "take-off", int(self.key > 0.0))

    def _foot_on(self, side: float, t: float, ah: float, av: float) -> None:
        """Stand on a pivot, if the ground then presses it; else go on in the air, its key holding."""
        y, flew = self.y, self.flies
        slope = self.arms(y[TH], side)[0]
        y[V], y[VD] = side * self.b * math.sin(y[TH]) - 2.0 * self.h * math.sin(0.5 * y[TH]) ** 2, slope * y[OM]
        self.foot, self.flies = side, False
        self.turned()
        if self.normal(y, ah, av, side) >= -1e-12 * self.g:
            if flew:
                self.flights[-1][1] = t
        elif flew:
            self.key, self.foot, self.flies = side, None, True
        else:
            self._leave(t)

    def turned(self) -> None:
        """Follow a jump of velocities."""

    def _pass(self, t: float, ah: float, av: float) -> None:
        self.out.impacts += 1
        self._note(t, "impact", int(self.foot < 0.0))
        self.y[OM] *= self.restitution
        self.y[TH] = 0.0
        if abs(self.y[OM]) < 1e-8 * self.p0:
            self.rested, self.foot, self.y[V : OM + 1] = True, None, [0.0] * 4
            return
        self._foot_on(-self.foot, t, ah, av)

    def _land(self, t: float, i: int, ah: float, av: float) -> None:
        y, side = self.y, -1.0 + 2.0 * i
        rate = self.rate(i, y)
        if t - self.flights[-1][0] <= NO_TIME and abs(rate) <= NO_SPEED:
            self.flights.pop()
            self.flies = False
            self._foot_on(side, t, ah, av)
            return
        self.out.impacts += 1
        self._note(t, "landing", i)
        lever = self.arms(y[TH], self.key)[1] * self.arms(y[TH], side)[1]
        y[OM] = ((self.inertia + lever) * y[OM] - self.arm(i, y) * y[VD]) / (self.inertia + self.b**2 + self.h**2)
        self._foot_on(side, t, ah, av)


OF_PIER = 6
"""Variables of a state before the counters and the devices: v, θ, their rates, and z of springs, which are 0 here."""


class TiedBlock(TiedTwoSprings, RigidGround):
    """A block on rigid ground with viscous and hysteretic dampers, tendons and stops."""

    def __init__(self, pier: Pier, base: RigidBase, motion: Motion, quiet_s: float = 0.0) -> None:
        stand_in = ElasticBase(50.0 + pier.least_beta, kinematics="finite", restraints=base.restraints)
        super().__init__(pier, stand_in, motion, quiet_s)
        self.p0 = pier.p
        self.stand(pier, base)

    def loads(self, y: Sequence[float]) -> tuple[float, float]:
        """Return Σ F ∂e/∂v and Σ F ∂e/∂θ of all devices."""
        down = back = 0.0
        for j in range(len(self.elements)):
            pull, (_, by_v, by_theta, _) = self.pull(j, y), self.shape(j, y)
            down, back = down + pull * by_v, back + pull * by_theta
        return down, back

    def turning(self, y: Sequence[float], ah: float, av: float, side: float) -> float:
        """Return θ̈ about the pivot on ``side``."""
        down, back = self.loads(y)
        slope, lever = self.arms(y[TH], side)
        return -((self.g + av + down) * slope + ah * lever + back) / (self.inertia + self.b**2 + self.h**2)

    def opening(self, y: Sequence[float], ah: float, av: float, side: float) -> float:
        """Return the acceleration by which a block at rest begins to turn about the pivot on ``side``, to that side."""
        return side * self.turning(y, ah, av, side)

    def under_pulls(self, modes, y, ah, av):
        if self.foot is not None:
            slope, lever = self.arms(y[TH], self.foot)
            turning = self.turning(y, ah, av, self.foot)
            return slope * turning - lever * y[OM] ** 2, turning
        if not self.flies:
            return 0.0, 0.0
        down, back = self.loads(y)
        slope, lever = self.arms(y[TH], self.key)
        turning = -(lever * (slope * y[OM] ** 2 + ah) + back) / (self.inertia + lever**2)
        return -self.g - av - down, turning

    def normal(self, y: Sequence[float], ah: float, av: float, side: float) -> float:
        """Return N/M of a block that rocks about the pivot on ``side``."""
        slope, lever = self.arms(y[TH], side)
        lifts = slope * self.turning(y, ah, av, side) - lever * y[OM] ** 2
        return self.g + av + lifts + self.loads(y)[0]

    def viscous(self, damper: Damper, s: float, speed: float) -> float:
        c, a = damper.nu * self.p, damper.exponent
        if a < 1.0:
            lever = (self.b + abs(s)) ** 2 / (self.inertia + self.b**2 + self.h**2)
            slow = (c * lever / (STEEP * self.p)) ** (1.0 / (1.0 - a))
            if abs(speed) < slow:
                return c * slow**a * speed / slow
        return math.copysign(c * abs(speed) ** a, speed)

    def turned(self) -> None:
        for j in range(len(self.elements)):
            speed = self.speed(j, self.y)
            if abs(speed) > 1e-14 * self.h * self.p:
                self.way[j] = math.copysign(1.0, speed)
            if j in self.stops:
                self.stops[j].after_jump(self.elongation(j, self.y), speed)
