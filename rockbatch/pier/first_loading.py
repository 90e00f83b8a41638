"""Monotonic first loading of a spring: force/F_y from deflection/δ_y, and the inverse.

A curve is defined by its tangent stiffness over the elastic one, s(z) at z = F/F_y: its deflection is ∫ dz/s(z). The statics
sheet, releases and the static state of a run all use it.
"""

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import numpy.typing as npt

from rockbatch.pier.backbones import Points, greatest, slopes

Array = npt.NDArray[np.float64]

STEEL_EXPONENT = 5.0
"""Exponent n of the Bouc–Wen law of hysteretic dampers."""

SLOW = 0.99
"""zⁿ above which the series of a Bouc–Wen curve converges too slowly."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


@dataclass(frozen=True)
class Straight:
    """A curve with the elastic stiffness up to the force ``most``/F_y."""

    most: float = 1.0
    corner = True
    kinks = ()

    def force(self, deflection: Array) -> Array:
        """Return F/F_y at a ``deflection``/δ_y ≥ 0: the smaller of it and ``most``."""
        return np.minimum(deflection, self.most)

    def deflection(self, force: float) -> float:
        """Return the deflection/δ_y under a ``force``/F_y < 1, the same number."""
        return force

    def tangent(self, force: Array) -> Array:
        """Return ones, in the shape of ``force``: the elastic stiffness."""
        return np.ones_like(force)


@dataclass(frozen=True)
class Smooth:
    """A curve whose tangent stiffness falls to 0 at F_y.

    ``softening`` is s as a function of the deficit 1 − z, which keeps its digits near F_y; ``give`` is the deflection/δ_y under
    F_y of a brace in series with the spring.
    """

    softening: Callable[[Array], Array]
    give: float = 0.0
    corner = False
    most = 1.0
    kinks = ()

    @cached_property
    def _table(self) -> tuple[Array, Array]:
        """Forces/F_y from 0 to 1, closer and closer near 1, and the spring's deflections/δ_y there, without the brace."""
        deficit = np.unique(np.concatenate((np.geomspace(1.0, 1e-15, 1200), np.linspace(1.0, 0.1, 300))))[::-1]
        steps = self._between(deficit[:-1], deficit[1:])
        return 1.0 - deficit, np.concatenate(([0.0], np.cumsum(steps)))

    def _between(self, start: Array, end: Array) -> Array:
        """Return the deflection/δ_y of the spring as its deficit falls from ``start`` to ``end``; 0 if they are equal."""
        half, middle = 0.5 * (start - end), 0.5 * (start + end)
        with np.errstate(divide="ignore", invalid="ignore"):
            compliance = 1.0 / self.softening(middle[..., None] + half[..., None] * _NODES)
        return half * (np.where(half[..., None] > 0.0, compliance, 0.0) @ _WEIGHTS)

    def _deflections(self, force: Array) -> Array:
        """Return the deflections/δ_y, brace included, at ``force``/F_y: the table, and the rest of a step by quadrature."""
        forces, deflections = self._table
        i = np.searchsorted(forces, force, side="right") - 1
        return deflections[i] + self._between(1.0 - forces[i], 1.0 - force) + self.give * force

    def deflection(self, force: float) -> float:
        """Return the deflection/δ_y, brace included, under a ``force``/F_y < 1."""
        return float(self._deflections(np.array([force]))[0])

    def force(self, deflection: Array) -> Array:
        """Return F/F_y at a ``deflection``/δ_y ≥ 0: interpolated, and improved by two steps of Newton's method."""
        forces, deflections = self._table
        force = np.interp(deflection, deflections + self.give * forces, forces)
        for _ in range(2):
            tangent = self.tangent(force)
            step = (deflection - self._deflections(force)) * tangent / (1.0 + self.give * tangent)
            force = np.clip(force + step, 0.0, forces[-1])
        return force

    def tangent(self, force: Array) -> Array:
        """Return tangent over elastic stiffness of the spring at ``force``/F_y, without its brace."""
        return self.softening(1.0 - force)


@dataclass(frozen=True)
class Polyline:
    """A concave polyline from the origin through ``points``, (deflection/δ_y, force/F_y), the first of which is (1, 1).

    All but the last point are corners; that gives the slope beyond them.
    """

    points: Points
    corner = False

    @cached_property
    def tangents(self) -> Array:
        """Tangent stiffness over the elastic one, 1, and beyond each corner."""
        return np.array(slopes(self.points))

    @property
    def kinks(self) -> tuple[float, ...]:
        """Return the forces/F_y at the corners."""
        return tuple(force for _, force in self.points[:-1])

    @property
    def most(self) -> float:
        """Return the greatest force/F_y: that at the last corner if the spring is plastic beyond it, else infinity."""
        return greatest(self.points)

    def force(self, deflection: Array) -> Array:
        """Return F/F_y at a ``deflection``/δ_y ≥ 0."""
        x, force = np.array([(0.0, 0.0), *self.points]).T
        return np.interp(deflection, x, force) + self.tangents[-1] * np.maximum(deflection - x[-1], 0.0)

    def deflection(self, force: float) -> float:
        """Return the deflection/δ_y under a ``force``/F_y below the greatest."""
        starts, i = ((0.0, 0.0), *self.points), bisect_left(self.kinks, force)
        return float(starts[i][0] + (force - starts[i][1]) / self.tangents[i])

    def tangent(self, force: Array) -> Array:
        """Return tangent over elastic stiffness at ``force``/F_y; at a corner, that beyond it."""
        return self.tangents[np.searchsorted(self.kinks, force, side="right")]


Curve = Straight | Smooth | Polyline
"""First loading of a spring."""


@dataclass(frozen=True)
class BoucWen(Smooth):
    """The curve of s = 1 − zⁿ, whose deflection is a series."""

    exponent: float = 5.0

    def deflection(self, force: float) -> float:
        """Return the deflection/δ_y under a ``force``/F_y < 1: ∫ ds/(1 − sⁿ) from 0, by its series up to :data:`SLOW`."""
        n = self.exponent
        ratio = force * force * (force * force) * force if n == 5.0 else force**n
        if ratio > SLOW:
            return super().deflection(force)
        term, total, k = force, 0.0, 0
        while term > 1e-17 * total:
            total += term / (1.0 + k * n)
            term *= ratio
            k += 1
        return total + self.give * force


@cache
def bouc_wen(exponent: float, give: float = 0.0) -> BoucWen:
    """Return the curve of a Bouc–Wen spring, in series with a brace that deflects by ``give`` δ_y under F_y."""

    def softening(deficit: Array) -> Array:
        with np.errstate(divide="ignore"):
            return -np.expm1(exponent * np.log1p(-deficit))

    return BoucWen(softening, give, exponent)


def steel(give: float) -> BoucWen:
    """Return the curve of a hysteretic damper on a brace that deflects by ``give`` δ_y under the damper's yield force."""
    return bouc_wen(STEEL_EXPONENT, give)


@dataclass(frozen=True)
class Spring:
    """A support: stiffness [1/m] and yield force over the weight, and the curve of its first loading."""

    stiffness: float
    yield_force: float
    curve: Curve

    @property
    def strength(self) -> float:
        """Return the greatest force over the weight."""
        return self.yield_force * self.curve.most

    def force(self, depth: Array) -> Array:
        """Return the force over the weight in first loading at a ``depth`` [m] below the unstressed place; 0 above it."""
        elastic = self.stiffness * np.maximum(depth, 0.0)
        if self.curve.corner:
            return np.minimum(elastic, self.strength)
        return self.yield_force * self.curve.force(elastic / self.yield_force)

    def depth(self, force: float) -> float:
        """Return the depth [m] under a ``force`` over the weight, below the strength, in first loading."""
        if self.curve.corner:
            return force / self.stiffness
        return self.curve.deflection(force / self.yield_force) * self.yield_force / self.stiffness
