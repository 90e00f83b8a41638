"""The flexural modes of a shaft fixed at its foot (THEORY.md, A shaft that bends)."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.common.errors import Problem
from rockbatch.pier.block import Pier
from rockbatch.pier.parts import Part
from rockbatch.pier.sections import ROUNDING, parts_of, share_above, unknown_masses

MOST_MODES = 4
"""Greatest number of modes that are followed."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)
"""Masses by which a length is replaced: with 40 the fourth frequency of a uniform cantilever is right to 2·10⁻⁵."""

_NO_MODE = 1e-12
"""Share of the greatest flexibility below which an eigenvalue is rounding: fewer masses have fewer modes."""

Values = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Modes:
    """Lowest modes of a pier fixed at its foot, with ∫φ_i φ_j dm/M = 1 or 0, and φ_i above 0 at the highest point.

    Attributes
    ----------
    frequency : ndarray, shape (n,)
        ω_i [rad/s], ascending.
    share, coupling : ndarray, shape (n,)
        μ_i = ∫φ_i dm/M and λ_i = ∫φ_i z dm/M [m].
    """

    frequency: Values
    share: Values
    coupling: Values
    _heights: Values  # of masses, shape (k,)
    _loads: Values  # on a shaft of EI = 1 at these heights, which bend it to the shapes, shape (n, k)

    def at(self, height: float) -> Values:
        """Return φ_i at ``height`` [m], shape (n,); above the highest mass along the tangent there."""
        return self.along(np.array([height]))[:, 0]

    def along(self, heights: Values) -> Values:
        """Return φ_i at ``heights`` [m], shape (n, k)."""
        return self._loads @ _flexibility(self._heights, heights)


def problems(pier: Pier) -> list[Problem]:
    """Return a problem for each reason that the shaft of ``pier`` cannot be taken as elastic; empty if it can."""
    lacking = "flexural_period_s is missing, the period of the pier fixed at its base; write it in [pier]"
    texts = [*([lacking] if pier.flexural_period_s is None else []), *unknown_masses(pier)]
    return [Problem("shaft", "elastic", text) for text in texts]


@lru_cache(maxsize=1024)
def modes_of(pier: Pier, most: int = MOST_MODES) -> Modes:
    """Return the lowest modes of ``pier`` by its flexural period, ``most`` or as many as its masses have.

    Its shaft has the same flexural rigidity everywhere, and its sections keep their direction in space when they are bent, so
    that they have no inertia of their own in it.
    """
    heights, masses = (np.concatenate(values) for values in zip(*map(_points, parts_of(pier)), strict=True))
    masses = masses / masses.sum()
    root = np.sqrt(masses)
    flexibility, vectors = np.linalg.eigh(root[:, None] * _flexibility(heights, heights) * root)
    n = min(most, int(np.count_nonzero(flexibility > _NO_MODE * flexibility[-1])))
    flexibility, shapes = flexibility[: -n - 1 : -1], vectors.T[: -n - 1 : -1] / root
    loads = shapes * masses / flexibility[:, None]
    signs = np.sign(shapes[:, heights.argmax()])[:, None]
    shapes, loads = signs * shapes, signs * loads
    frequency = 2.0 * math.pi / (pier.flexural_period_s or math.inf) * np.sqrt(flexibility[0] / flexibility)
    return Modes(frequency, shapes @ masses, shapes @ (masses * heights), heights, loads)


class BentAbove(NamedTuple):
    """Integrals over the mass above a section, dm over M, at the heights z and Δz above it; Δφ_j is φ_j less that there.

    Attributes
    ----------
    share, lever : ndarray, shape (n,)
        ∫φ_i dm and ∫Δz φ_i dm [m].
    offset, turning : ndarray, shape (n,)
        ∫Δφ_j dm and ∫Δφ_j z dm [m].
    both : ndarray, shape (n, n)
        ∫Δφ_j φ_i dm.
    """

    share: Values
    lever: Values
    offset: Values
    turning: Values
    both: Values


def bent_above(pier: Pier, modes: Modes, height: float) -> BentAbove:
    """Return the integrals of the ``modes`` over the mass of ``pier`` above the section at ``height`` [m]."""
    parts = parts_of(pier)
    pieces = [(part, share) for part in parts if (share := share_above(part, height, ROUNDING * pier.highest)) > 0.0]
    n = len(modes.frequency)
    if not pieces:
        return BentAbove(np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros((n, n)))
    z, masses = (np.concatenate(values) for values in zip(*(_points(*piece) for piece in pieces), strict=True))
    masses = masses / sum(part.mass_t for part in parts)
    shapes = modes.along(z)
    bent = shapes - modes.at(height)[:, None]
    return BentAbove(
        shapes @ masses,
        shapes @ (masses * (z - height)),
        bent @ masses,
        bent @ (masses * z),
        (bent * masses) @ shapes.T,
    )


def _flexibility(heights: Values, loaded: Values) -> Values:
    """Return the deflections at ``heights``, shape (k,), of a cantilever of EI = 1 by unit forces at each of ``loaded``."""
    low, high = np.minimum.outer(heights, loaded), np.maximum.outer(heights, loaded)
    return low**2 * (3.0 * high - low) / 6.0


def _points(part: Part, share: float = 1.0) -> tuple[Values, Values]:
    """Return the masses [t] by which the upper ``share`` of a part is replaced, behind their heights [m]."""
    length = share * (part.length_m or 0.0)
    if length == 0.0:
        return np.array([part.height_m]), np.array([part.mass_t])
    return part.upper_end - 0.5 * length * (1.0 - _NODES), 0.5 * _WEIGHTS * share * part.mass_t
