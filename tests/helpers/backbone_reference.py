"""Springs with a backbone in the second implementation of the model (:mod:`reference_solver`), and random cases on them."""

from dataclasses import replace

import numpy as np
from core_samples import hard_case
from reference_solver import ZL, TwoSprings
from restrained_reference import TiedTwoSprings

from rockbatch.pier import YieldingBase, least_beta


class OnBackbone(TwoSprings):
    """Block on two springs with a backbone; an inelastic mode is "load 1", "load 2", …, by the corners passed."""

    def __init__(self, pier, base, motion, quiet_s):
        self.corners = [force for _, force in base.backbone[:-1]]
        self.x, self.forces_at = np.array([(0.0, 0.0), *base.backbone]).T
        self.tangents = np.diff(self.forces_at) / np.diff(self.x)
        self.passed = 0  # corners beyond the first of each loading
        super().__init__(pier, base, motion, quiet_s)
        self.deepest = [min(self.z0, -1.0)] * 2
        self.mode = [self._mode_at(-self.z0)] * 2

    def _static_integral(self, s):
        passed = sum(s > corner for corner in self.corners)
        return float(self.x[passed] + (s - self.forces_at[passed]) / self.tangents[passed])

    def _mode_at(self, force):
        passed = sum(force >= corner for corner in self.corners)
        return f"load {passed}" if passed else "unload"

    def z_rate(self, mode, z, rate):
        if mode.startswith("load "):
            return rate / self.dy * float(self.tangents[int(mode.split()[1])])
        return super().z_rate(mode, z, rate)

    def surfaces(self, leg):
        surfaces = []
        for surface in self._of_elastic_springs(leg):
            _, _, i, kind = surface
            if kind != "separate":
                surfaces.append(surface)
            elif (mode := self.mode[i]) == "unload":
                surfaces += [surface, (lambda t, y, i=i: y[ZL + i] - self.deepest[i], 1e-14, i, "load")]
            else:
                surfaces.append((lambda t, y, i=i: -self.rate(i, y), 1e-13 * self.omega_v * self.dy, i, "unload"))
                passed = int(mode.split()[1])
                if passed < len(self.corners):
                    corner = self.corners[passed]
                    surfaces.append((lambda t, y, i=i, c=corner: y[ZL + i] + c, 1e-14, i, "corner"))
        return surfaces

    def _of_elastic_springs(self, leg):
        self.law = "elastic"
        surfaces = super().surfaces(leg)
        self.law = "backbone"
        return surfaces

    def _fire(self, t, i, kind, ah, av):
        if kind == "unload":
            self.deepest[i] = self.y[ZL + i]
            self.mode[i] = "unload"
        elif kind == "load":
            self.y[ZL + i] = self.deepest[i]
            self.mode[i] = self._mode_at(-self.deepest[i])
        elif kind == "corner":
            self.passed += 1
            passed = int(self.mode[i].split()[1])
            self.y[ZL + i] = -self.corners[passed]
            self.mode[i] = f"load {passed + 1}"
        else:
            super()._fire(t, i, kind, ah, av)
            self._reload_or_unload(kind)

    def _reload_or_unload(self, kind):
        """Follow a blow, by which the velocity of the other pivot has jumped."""
        for i in (0, 1) if kind == "land" else ():
            rate = self.rate(i, self.y)
            if self.mode[i].startswith("load ") and rate > 0.0:
                self.deepest[i] = self.y[ZL + i]
                self.mode[i] = "unload"
            elif self.mode[i] == "unload" and rate < 0.0 and self.y[ZL + i] <= self.deepest[i]:
                self.mode[i] = self._mode_at(-self.deepest[i])


class TiedOnBackbone(OnBackbone, TiedTwoSprings):
    """The same with devices."""


def random_backbone(rng):
    """Return 2 to 6 points of a concave backbone over its first corner; of one in three the last slope is 0."""
    count = int(rng.integers(2, 7))
    slopes = np.sort(rng.uniform(0.02, 1.0, count - 1))[::-1]
    if rng.uniform() < 1.0 / 3.0:
        slopes[-1] = 0.0
    steps = rng.uniform(0.1, 1.5, count - 1)
    x, force = 1.0 + np.cumsum(steps), 1.0 + np.cumsum(steps * slopes)
    return ((1.0, 1.0), *zip(x.tolist(), force.tolist(), strict=True))


def backbone_case(seed, npts=250):
    """Return a random hard case on springs with a backbone, of odd seeds on damped supports; at rest some are beyond a corner."""
    pier, base, motion = hard_case(seed, npts=npts)
    rng = np.random.default_rng([seed, 1])
    points = random_backbone(rng)
    most = points[-2][1] if points[-1][1] == points[-2][1] else points[-1][1]
    damping = {"epsilon": 0.0, "zeta": (0.02, 0.1, 0.5)[seed // 2 % 3]} if seed % 2 else {"epsilon": base.epsilon}
    rest = {"kinematics": base.kinematics, "flight": base.flight, "confirm": ("beta", "eta")}
    eta = rng.uniform(1.05, 2.0) / most
    springs = YieldingBase(base.beta, eta=eta, spring="backbone", backbone=points, **damping, **rest)
    return pier, replace(springs, beta=max(springs.beta, 1.05 * least_beta(pier, springs))), motion
