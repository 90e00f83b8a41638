"""Period of free rocking over its amplitude, and the viscous damping equivalent to its impacts (THEORY.md, Statics).

Both follow from the energy integral under weight, springs, tendons and stops; dampers are left out. Springs are elastic, as
yielding ones are between landings, and do not vibrate vertically: the height follows the rotation.
"""

import math
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.pier.bases import Base, ElasticBase, RigidBase
from rockbatch.pier.block import Pier
from rockbatch.pier.equilibrium import ONSET, Equilibria, without_dampers
from rockbatch.pier.footings import slow_turn
from rockbatch.pier.places import symmetric

Array = npt.NDArray[np.float64]

_OUTER, _INNER = (np.polynomial.legendre.leggauss(n) for n in (20, 8))


class Swings(NamedTuple):
    """Free rocking over its amplitude [rad]: period [s] and equivalent damping ratio of impacts; NaN where undefined."""

    amplitude: Array
    period: Array
    impact_damping: Array


class FreeRocking:
    """A pier that rocks freely on a base between equal rotations to both sides.

    ``even`` is False if tendons, stops or deck springs on one side make the swings uneven, without amplitude and period.
    """

    def __init__(self, pier: Pier, base: Base) -> None:
        holding = without_dampers(base.restraints)
        springs = (
            ElasticBase(base.beta, kinematics=base.kinematics, confirm=base.confirm)
            if isinstance(base, ElasticBase)
            else base
        )
        self.pier, self.base, self.even = pier, base, symmetric(pier, holding)
        self.turn = slow_turn(pier, springs, holding)

    def swings(self, amplitudes: Array) -> Swings:
        """Return period and damping at ``amplitudes`` > 0 [rad], below the unstable equilibrium; NaN if the swings are uneven.

        The damping is NaN on springs and footings, too.
        """
        none = np.full_like(amplitudes, math.nan)
        if not self.even:
            return Swings(amplitudes, none, none)
        damping = none
        if isinstance(self.base, RigidBase):
            restitution = self.pier.restitution if self.base.restitution is None else self.base.restitution
            damping = self.impact_damping(amplitudes, restitution)
        return Swings(amplitudes, self.periods(amplitudes), damping)

    @property
    def in_full_contact(self) -> float | None:
        """Return the period of small rocking on both supports [s]; None on rigid ground, or if the swings are uneven.

        None also for a bed that hardly carries the weight, and gives way to the least tilt.
        """
        if self.turn.on_pivots or not self.even:
            return None
        theta = 1e-3 * (self.turn.lift_off or self.pier.alpha)
        stiffness = self.pier.gravity * float(self.turn.at(np.array([theta])).moment[0]) / theta
        return 2.0 * math.pi * math.sqrt((self.pier.inertia + self.turn.h**2) / stiffness) if stiffness > 0.0 else None

    @cached_property
    def _edges(self) -> list[float]:
        """Rotations [rad] at which the moment's slope jumps, sorted."""
        return sorted((self.turn.lift_off or 0.0, *self._kinks))

    @cached_property
    def _kinks(self) -> Array:
        return self.turn.kinks(self._grid)

    @cached_property
    def _grid(self) -> Equilibria:
        return self.turn.curve(self.turn.unstable or 0.5 * math.pi, before=20, after=200)

    @cached_property
    def _curve(self) -> Equilibria:
        return self.turn.with_rotations(self._grid, self._kinks)

    @cached_property
    def _tabulated(self) -> tuple[Array, Array, Array]:
        """Rotations [rad] up to the unstable equilibrium, moments [m], and derivatives of the toe's depth by θ [m]."""
        turn, curve = self.turn, self._curve
        lifted = int(np.searchsorted(curve.theta, turn.lift_off or 0.0, "right"))
        slopes = []
        for part in (slice(0, lifted), slice(lifted, None)):  # the slope jumps at lift-off
            depth, theta = curve.depth[part], curve.theta[part]
            slopes.append(np.gradient(depth, theta) if len(theta) > 1 else np.zeros(len(theta)))
        return curve.theta, curve.moment, np.concatenate(slopes)

    def _moment(self, theta: Array) -> Array:
        """Return the righting moment over the weight [m]: exact on pivots and on springs without devices, else interpolated."""
        if self.turn.on_pivots or not (self.turn.places or self.turn.spring is None):
            return self.turn.at(theta).moment
        angles, moments, _ = self._tabulated
        return np.interp(theta, angles, moments)

    def _inertia(self, theta: Array) -> Array:
        """Return the effective inertia per unit mass of θ̇ [m²], with the rise of the centre of mass by the rotation."""
        turn, pier = self.turn, self.pier
        if turn.on_pivots:
            return np.full_like(theta, pier.inertia_about_pivot)
        on_both = theta <= (math.inf if turn.lift_off is None else turn.lift_off)
        rising = turn.b * (np.cos(theta) if turn.finite else np.ones_like(theta))
        if turn.places or turn.spring is None:
            rising = rising - np.interp(theta, self._tabulated[0], self._tabulated[2])
        else:
            rising = np.where(on_both, 0.0, rising)
        if not turn.finite:
            return pier.inertia + turn.h**2 + rising * (turn.b - turn.h * theta)
        lever = turn.h * np.cos(theta)
        if turn.spring is not None:
            lever = lever + np.where(on_both, 0.0, turn.b * np.sin(theta))
        return pier.inertia + lever**2 + (rising - turn.h * np.sin(theta)) ** 2

    def _work(self, low: Array, high: Array) -> Array:
        """Return the integral of the righting moment over the weight from ``low`` to ``high`` [m].

        In first-order kinematics, whose equations have no Lagrangian, the integrand is divided by the inertia.
        """
        total = np.zeros_like(low)
        for start, end in pairwise(np.clip(edge, low, high) for edge in (0.0, *self._edges, math.inf)):
            half, nodes = 0.5 * (end - start), _INNER[0]
            theta = np.maximum((0.5 * (end + start))[..., None] + half[..., None] * nodes, ONSET)
            moment = self._moment(theta) if self.turn.finite else self._moment(theta) / self._inertia(theta)
            total += half * (moment @ _INNER[1])
        return total

    def periods(self, amplitudes: Array) -> Array:
        """Return the periods [s] at ``amplitudes`` > 0 [rad], below the unstable equilibrium: 4 ∫ dθ/θ̇ from 0 to the amplitude.

        With θ = amplitude (1 − x²) the integrand is smooth at both ends; it is split where the moment changes its slope.
        """
        quarter = np.zeros_like(amplitudes)
        ends = (np.clip(1.0 - edge / amplitudes, 0.0, 1.0) ** 0.5 for edge in (math.inf, *self._edges[::-1], 0.0))
        for start, end in pairwise(ends):
            half = 0.5 * (end - start)
            x = (0.5 * (end + start))[:, None] + half[:, None] * _OUTER[0]
            theta = np.maximum(amplitudes[:, None] * (1.0 - x**2), ONSET)
            energy = self.pier.gravity * self._work(theta, np.broadcast_to(amplitudes[:, None], theta.shape))
            inertia = self._inertia(theta) if self.turn.finite else np.ones_like(theta)
            with np.errstate(divide="ignore", invalid="ignore"):
                slowness = np.sqrt(inertia / (2.0 * energy)) * 2.0 * amplitudes[:, None] * x
            quarter += half * (np.where(half[:, None] > 0.0, slowness, 0.0) @ _OUTER[1])
        return 4.0 * quarter

    def impact_damping(self, amplitudes: Array, restitution: float) -> Array:
        """Return the viscous damping ratio of the same decay over a cycle from each of ``amplitudes`` [rad], on rigid ground.

        Each of the two impacts leaves e² of the energy, so that the next amplitude θ_2 has e⁴ of it; ζ = ln(θ_0/θ_2)/(2π).
        Infinite if the pier stops at its first impact, e = 0.
        """
        remaining_energy = restitution**4 * self._work(np.zeros_like(amplitudes), amplitudes)
        low, high = np.zeros_like(amplitudes), amplitudes
        for _ in range(12):
            middle = 0.5 * (low + high)
            above = self._work(np.zeros_like(middle), middle) > remaining_energy
            low, high = np.where(above, low, middle), np.where(above, middle, high)
        least, most = (self._work(np.zeros_like(low), end) for end in (low, high))
        following = low + (high - low) * (remaining_energy - least) / (most - least)
        with np.errstate(divide="ignore"):
            return np.log(amplitudes / (following if restitution > 0.0 else 0.0)) / (2.0 * math.pi)
