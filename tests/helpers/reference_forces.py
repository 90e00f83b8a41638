"""Greatest forces of the reference solver: sampled many times in every step of DOP853, with no code of the core."""

import math

import numpy as np
from reference_solver import OM, TH, Leg, ground_legs
from restrained_reference import TiedTwoSprings

LOOKS = 24
"""Samples of a step, of 0.25/ω_v at most: a sine between two of them exceeds both by 1.4·10⁻⁵ of itself at most."""


class Looking(Leg):
    """A leg that samples its steps at many times."""

    def __init__(self, peak, h, look):
        super().__init__(peak, h)
        self.look = look

    def _turning(self, dense, times, states, theta, omega):
        super()._turning(dense, times, states, theta, omega)
        within = np.linspace(times[0], times[-1], LOOKS + 1)[1:-1]
        self.look(times[0], states[0])
        for s, state in zip(within.tolist(), dense(within).T.tolist(), strict=True):
            self.look(s, state)
        self.look(times[-1], states[-1])


class WithForces(TiedTwoSprings):
    """``greatest``: forces, gaps and speeds by the names of PeakForces, and ``key_shear``, while N is below ``least`` M g."""

    def __init__(self, pier, base, motion, quiet_s, least=0.1):
        super().__init__(pier, base, motion, quiet_s)
        self.leg = Looking(self._peak, self.leg.h, self._look)
        self.ground_legs = ground_legs(motion, quiet_s)
        self.deck, self.least = pier.deck, least
        self.greatest: dict[str, float] = {}
        self.now = self.ground_legs[0]
        self.before = (0.0, 0.0, self.g)

    def rhs(self, leg):
        self.now = leg
        return super().rhs(leg)

    def _look(self, t, y):
        t0, _, h0, hs, v0, vs = self.now
        ah, av = h0 + hs * (t - t0), v0 + vs * (t - t0)
        _, turning = self.accelerations(self.mode, y, ah, av)
        on = [mode not in ("free", "held") for mode in self.mode]
        pressed = [max(0.0, -force) * bears for force, bears in zip(self.forces(self.mode, y), on, strict=True)]
        shear, swung = ah + self.h * turning, (self.deck - self.h) * turning
        if self.finite:
            lever, slope = self.lever(self.mode, y)
            shear = ah + lever * turning + slope * y[OM] ** 2
            swung = (self.deck - self.h) * (math.cos(y[TH]) * turning - math.sin(y[TH]) * y[OM] ** 2)
        inertial = shear
        shear += sum((place.way or 1.0) * self.pull(j, y) for j, place in enumerate(self.places) if place.height)
        normal = sum(pressed)
        passes = self._passing(t, shear, normal)
        found = {"base_shear": abs(shear), "normal_force": normal, "deck_acceleration": abs(inertial + swung)}
        if not self.finite:  # where places of the base keep theirs
            ties = sum(self.pull(j, y) * s for j, (_, s) in enumerate(self.elements))
            found["base_moment"] = abs(self.b * (pressed[1] - pressed[0]) - ties)
        if normal >= self.least * self.g:
            found["friction_demand"] = abs(shear) / normal
        else:
            found["key_shear"] = abs(shear)
        for i, side in enumerate(("left", "right")):
            free = self.mode[i] == "free"
            found[f"pivot_{side}"] = pressed[i] / (0.5 * self.g)
            found[f"heel_gap_{side}"] = self.pivot(i, y) - self.top(i, y) if free else 0.0
            found[f"heel_speed_{side}"] = abs(self.rate(i, y) - self.top_rate(i, y)) if free else 0.0
        for name, share in (("friction_demand", 1.0), ("key_shear", self.least * self.g)):
            found[name] = max(found.get(name, 0.0), share * passes)
        for name, value in found.items():
            self.greatest[name] = max(self.greatest.get(name, 0.0), value)

    def _passing(self, t, shear, normal):
        """Return |V|/N where N has crossed its limit since the last sample, by linear interpolation; 0 if it has not."""
        t_before, shear_before, normal_before = self.before
        self.before = t, shear, normal
        limit = self.least * self.g
        if t <= t_before or (normal < limit) == (normal_before < limit):
            return 0.0
        part = (limit - normal_before) / (normal - normal_before)
        return abs(shear_before + part * (shear - shear_before)) / limit


def greatest_forces(pier, base, motion, quiet_s=0.0, least=0.1):
    """Run the reference solver and return its outcome and the greatest forces."""
    solver = WithForces(pier, base, motion, quiet_s, least)
    return solver.run(), solver.greatest
