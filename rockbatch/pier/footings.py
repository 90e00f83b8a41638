"""Equilibrium of a pier that is turned slowly on a footing: the bed's push in closed form (THEORY.md, A footing)."""

import math
from functools import cached_property

import numpy as np

from rockbatch.pier.bases import Base, static_deflection
from rockbatch.pier.block import Pier
from rockbatch.pier.equilibrium import NEAR, Equilibria, SlowTurn, bracketed
from rockbatch.pier.first_loading import Array
from rockbatch.pier.footing_base import FootingBase
from rockbatch.pier.places import prestress_over_weight
from rockbatch.pier.restraints import Restraint

HALVINGS = 60
"""Of the rotation of lift-off: to rounding."""


class SlowFooting(SlowTurn):
    """A pier on a footing that is turned slowly from rest; the ground has been loaded once.

    The toe and the heel are the edges of the foot. In its Equilibria ``toe`` is the pressure under the edge over that of the
    weight at rest, and ``heel`` the share of the foot that is pressed.
    """

    def __init__(
        self, pier: Pier, base: FootingBase, restraints: tuple[Restraint, ...] | None = None, side: float = 1.0
    ) -> None:
        super().__init__(pier, base, restraints, side)
        devices = base.restraints if restraints is None else restraints
        self.deflection = static_deflection(pier, base)
        self.strength = math.inf if base.safety_factor is None else base.safety_factor
        self.at_rest = 1.0 + prestress_over_weight(pier, devices)
        self.settled = self.at_rest * self.deflection

    def bed(self, theta: Array, depth: Array) -> tuple[Array, Array, Array]:
        """Return force over the weight, moment about the middle [m], and the pressed share, of a toe at a ``depth`` [m]."""
        b, slope = self.b, np.sin(theta) if self.finite else theta
        middle, most = depth - b * slope, self.strength * self.deflection
        with np.errstate(divide="ignore", invalid="ignore"):
            low = np.clip(np.where(slope > 0.0, -middle / slope, -b), -b, b)
            high = np.clip(np.where(slope > 0.0, (most - middle) / slope, b), low, b)
        per_depth, full = 0.5 / (b * self.deflection), 0.0 if math.isinf(self.strength) else 0.5 * self.strength / b
        way, square, cube = high - low, 0.5 * (high**2 - low**2), (high**3 - low**3) / 3.0
        force = per_depth * (middle * way + slope * square) + full * (b - high)
        moment = per_depth * (middle * square + slope * cube) + full * 0.5 * (b**2 - high**2)
        return force, moment, 0.5 * (b - low) / b

    def _parts(self, theta: Array, on_both: bool) -> Equilibria:
        """Return the equilibria at rotations ``theta`` [rad]."""
        since = [0.0] * len(self.places)

        def excess(depth: Array) -> Array:
            pulls = zip(self.places, self._pulls(theta, depth, since), strict=True)
            vertical = (pull for place, pull in pulls if not place.height)
            return self.bed(theta, depth)[0] - 1.0 - self._by_v(theta) * sum(vertical, start=np.zeros_like(theta))

        room = 4.0 * np.abs(self._rise(theta)) + 4.0 * self.settled
        low, high, share = bracketed(excess, np.zeros_like(theta), room, NEAR * self.deflection)
        depth = (1.0 - share) * low + share * high
        force, moment, pressed = self.bed(theta, depth)
        of_devices = self._moments(theta, depth, self._pulls(theta, depth, since))
        cosine = np.cos(theta) if self.finite else np.ones_like(theta)
        of_weight = self._toe_arm(theta) - (force * self.b - moment) * cosine
        toe = np.minimum(depth / self.deflection, self.strength)
        return Equilibria(theta, of_weight, *of_devices, self.h * cosine, toe, pressed, depth)

    def at(self, theta: Array) -> Equilibria:
        """Return the equilibria at rotations ``theta`` > 0 [rad]."""
        return self._parts(theta, True)

    @cached_property
    def lift_off(self) -> float | None:
        """The rotation at which the heel's edge is no longer pressed [rad]; π/2 if it always is."""
        low, high = 0.0, 0.5 * math.pi
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self.at(np.array([middle])).heel[0] >= 1.0 else (low, middle)
        return high

    @cached_property
    def unstable(self) -> float | None:
        """The rotation from which on the righting moment is negative [rad]; None if there is none up to π/2."""
        return self.search_unstable()


def slow_turn(pier: Pier, base: Base, restraints: tuple[Restraint, ...] | None = None, side: float = 1.0) -> SlowTurn:
    """Return the pier turned slowly on its ``base``: a SlowFooting on a footing, else a SlowTurn, with their arguments."""
    if isinstance(base, FootingBase):
        return SlowFooting(pier, base, restraints, side)
    return SlowTurn(pier, base, restraints, side)


def facts_of_bed(pier: Pier, base: Base) -> dict[str, float | None]:
    """Return the statics sheet's facts on the ground under a footing, by the names in ``FACTS``; {} on other bases.

    Rocking stiffness [MN m/rad] and ultimate moment [kN m], W B/2 of an elastic bed, are there if the mass is known.
    """
    if not isinstance(base, FootingBase):
        return {}
    facts = {"safety_factor": base.safety_factor, "vertical_over_formula": base.vertical_over_formula}
    if pier.mass_t is None:
        return facts
    weight, b = pier.mass_t * pier.gravity, pier.half_width
    facts["rocking_stiffness_MN_m"] = weight / static_deflection(pier, base) * b * b / 3000.0
    facts["ultimate_moment_kN_m"] = weight * b * (1.0 - 1.0 / (base.safety_factor or math.inf))
    return facts
