"""Force of a support that is loaded slowly for the first time (THEORY.md, Statics), over the weight M g."""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from rockbatch.pier.bases import ElasticBase, YieldingBase
from rockbatch.pier.block import Pier
from rockbatch.pier.frequencies import static_deflection

Array = npt.NDArray[np.float64]


@cache
def _curve(exponent: float) -> tuple[Array, Array, Array]:
    """Return deflections, forces and stiffnesses of the first loading ∫ dz/(1 − zⁿ), in ever smaller steps towards z = 1."""
    deficit = np.unique(np.concatenate((np.geomspace(1.0, 1e-15, 1200), np.linspace(1.0, 0.1, 300))))[::-1]
    nodes, weights = np.polynomial.legendre.leggauss(8)
    half, middle = 0.5 * -np.diff(deficit), 0.5 * (deficit[1:] + deficit[:-1])

    def stiffness(deficit: Array) -> Array:
        with np.errstate(divide="ignore"):
            return -np.expm1(exponent * np.log1p(-deficit))

    steps = half * (weights / stiffness(middle[:, None] + half[:, None] * nodes)).sum(axis=1)
    return np.concatenate(([0.0], np.cumsum(steps))), 1.0 - deficit, stiffness(deficit)


def first_loading(deflection: Array, exponent: float, give: float = 0.0) -> Array:
    """Return F/F_y at a ``deflection``/δ_y ≥ 0 of a Bouc–Wen spring that is loaded for the first time.

    ``give`` is the deflection/δ_y of a brace in series with it under F_y.
    """
    x, z, slope = _curve(exponent)
    if give:
        x, slope = x + give * z, slope / (1.0 + give * slope)
    i = np.clip(np.searchsorted(x, deflection, side="right") - 1, 0, len(x) - 2)
    step = x[i + 1] - x[i]
    s = np.clip((deflection - x[i]) / step, 0.0, 1.0)
    rise, start, end = z[i + 1] - z[i], slope[i] * step, slope[i + 1] * step
    return z[i] + s * (start + s * (3.0 * rise - 2.0 * start - end + s * (start + end - 2.0 * rise)))


def deflection_under(force: float, exponent: float) -> float:
    """Return the deflection/δ_y of a Bouc–Wen spring that is first loaded to ``force``/F_y < 1."""
    x, z, slope = _curve(exponent)
    i = int(np.searchsorted(z, force, side="right")) - 1
    deflection = float(x[i] + (force - z[i]) / slope[i])
    for _ in range(20):  # Newton's method, from the side on which the curve is concave
        loading = float(first_loading(np.array([deflection]), exponent)[0])
        step = (force - loading) / -math.expm1(exponent * math.log(loading))
        deflection += step
        if step <= 1e-15 * deflection:
            break
    return deflection


@dataclass(frozen=True)
class Spring:
    """A support: stiffness [1/m] and strength over the weight; the Bouc–Wen exponent of its first loading if it has one."""

    stiffness: float
    strength: float = math.inf
    exponent: float | None = None

    def force(self, depth: Array) -> Array:
        """Return the force at a ``depth`` [m] of the pivot below its unstressed place, in first loading; 0 above it."""
        elastic = self.stiffness * np.maximum(depth, 0.0)
        if self.exponent is None:
            return np.minimum(elastic, self.strength)
        return self.strength * first_loading(elastic / self.strength, self.exponent)

    def depth(self, force: float) -> float:
        """Return the depth [m] under a ``force`` below the strength, in first loading."""
        if self.exponent is None:
            return force / self.stiffness
        return deflection_under(force / self.strength, self.exponent) * self.strength / self.stiffness


def spring_of(pier: Pier, base: ElasticBase) -> Spring:
    """Return a support of ``base`` under ``pier``."""
    stiffness = 0.5 / static_deflection(pier, base)
    if not isinstance(base, YieldingBase):
        return Spring(stiffness)
    return Spring(stiffness, 0.5 * base.eta, base.n if base.has_exponent else None)
