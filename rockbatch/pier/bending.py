"""The flexural modes of a shaft fixed at its foot (THEORY.md, A shaft that bends)."""

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rockbatch.common.errors import Problem
from rockbatch.pier.block import Pier
from rockbatch.pier.parts import Part
from rockbatch.pier.sections import ROUNDING, distribution_problems, parts_of, share_above

MOST_MODES = 4
"""Greatest number of modes that are followed."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)
"""Masses by which a length is replaced: with 40 the fourth frequency of a uniform cantilever is right to 2·10⁻⁵."""

_NO_MODE = 1e-12
"""Share of the greatest flexibility below which an eigenvalue is rounding: fewer masses have fewer modes."""

Values = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Modes:
    """Lowest modes of a pier fixed at its foot, with ∫φ_i φ_j dm/M = 1 or 0, and φ_i above 0 at the highest point."""

    frequency: Values  # ω_i [rad/s], ascending, shape (n,)
    # μ_i = ∫φ_i dm/M and λ_i = ∫φ_i z dm/M [m], shape (n,)
    share: Values
    coupling: Values
    _stretches: tuple["Stretch", ...]
    _heights: Values  # of masses, shape (k,)
    _loads: Values  # at these heights, which bend it to the shapes, shape (n, k)

    def at(self, height: float) -> Values:
        """Return φ_i at ``height`` [m], shape (n,); above the highest mass along the tangent there."""
        return self.along(np.array([height]))[:, 0]

    def along(self, heights: Values) -> Values:
        """Return φ_i at ``heights`` [m], shape (n, k)."""
        return self._loads @ _flexibility(self._stretches, self._heights, heights)


def problems(pier: Pier) -> list[Problem]:
    """Return a problem for each reason that the shaft of ``pier`` cannot be taken as elastic; empty if it can."""
    texts = distribution_problems(pier)
    rigid = [part for part in pier.parts or () if part.flexural_rigidity_kNm2 is not None]
    if not rigid and pier.flexural_period_s is None:
        texts.insert(
            0,
            "flexural_period_s is missing, the period of the pier fixed at its base; write it in [pier], or "
            "flexural_rigidity_kNm2 in each [[pier.part]] with a length",
        )
    elif rigid and pier.flexural_period_s is not None:
        texts.append("flexural_period_s is given, and follows from flexural_rigidity_kNm2 of the parts; leave one out")
    elif rigid and not texts:
        texts += _without_rigidity(pier)
    return [Problem("shaft", "elastic", text) for text in texts]


def _without_rigidity(pier: Pier) -> list[str]:
    """Return reasons that the rigidity of the shaft is not known from its foot to its end; empty if it is."""
    parts = [part for part in parts_of(pier) if part.length_m]
    wrong = [
        f"flexural_rigidity_kNm2 is missing of the part at {part.height_m:g} m, which has a length; write it beside it"
        for part in parts
        if part.flexural_rigidity_kNm2 is None
    ]
    reached = 0.0
    for part in sorted(parts, key=lambda part: part.upper_end):
        foot = part.upper_end - float(part.length_m or 0.0)
        if foot > reached + ROUNDING * pier.highest:
            wrong.append(f"no part has a rigidity between {reached:g} m and {foot:g} m; write a [[pier.part]] there")
        reached = max(reached, part.upper_end)
    return wrong


def flexural_period(pier: Pier) -> float | None:
    """Return the first period of ``pier`` fixed at its base [s], as given or by the rigidity of its parts; None if unknown."""
    if pier.flexural_period_s is not None or problems(pier):
        return pier.flexural_period_s
    return 2.0 * math.pi / float(modes_of(pier, 1).frequency[0])


@lru_cache(maxsize=1024)
def modes_of(pier: Pier, most: int = MOST_MODES) -> Modes:
    """Return the lowest modes of ``pier``, ``most`` or as many as its masses have.

    Given its flexural period, its shaft has the same flexural rigidity everywhere; given rigidities of parts, it has theirs, and
    is rigid above the highest of them. Sections do not turn in space when it bends, so that they have no inertia of their own.
    """
    heights, masses = (np.concatenate(values) for values in zip(*map(_points, parts_of(pier)), strict=True))
    total, stretches = masses.sum(), _stretches(pier)
    masses = masses / total
    root = np.sqrt(masses)
    softness, vectors = np.linalg.eigh(root[:, None] * _flexibility(stretches, heights, heights) * root)
    n = min(most, int(np.count_nonzero(softness > _NO_MODE * softness[-1])))
    softness, shapes = softness[: -n - 1 : -1], vectors.T[: -n - 1 : -1] / root
    loads = shapes * masses / softness[:, None]
    signs = np.sign(shapes[:, heights.argmax()])[:, None]
    shapes, loads = signs * shapes, signs * loads
    first = 1.0 / math.sqrt(total * softness[0])
    if pier.flexural_period_s is not None:
        first = 2.0 * math.pi / pier.flexural_period_s
    frequency = first * np.sqrt(softness[0] / softness)
    return Modes(frequency, shapes @ masses, shapes @ (masses * heights), stretches, heights, loads)


class Stretch(NamedTuple):
    """A stretch of a shaft between two heights [m], with its 1/E I [1/(kN m²)] and 1/G A_s [1/kN]."""

    low: float
    high: float
    bends: float
    shears: float


def _stretches(pier: Pier) -> tuple[Stretch, ...]:
    """Return the shaft in stretches by its parts' rigidities, which add up side by side; else a single one of E I = 1."""
    parts = [part for part in pier.parts or () if part.length_m and part.flexural_rigidity_kNm2]
    if pier.flexural_period_s is not None or not parts:
        return (Stretch(0.0, pier.highest, 1.0, 0.0),)
    spans = [(part, part.upper_end - float(part.length_m or 0.0), part.upper_end) for part in parts]
    cuts = sorted({cut for _, *ends in spans for cut in ends})
    stretches = []
    for low, high in pairwise(cuts):
        beside = [part for part, foot, end in spans if foot < 0.5 * (low + high) < end]
        rigidity = math.fsum(part.flexural_rigidity_kNm2 or 0.0 for part in beside)
        by_shear = [1.0 / part.shear_rigidity_kN if part.shear_rigidity_kN else 0.0 for part in beside]
        shears = 0.0 if 0.0 in by_shear else 1.0 / math.fsum(1.0 / each for each in by_shear)
        stretches.append(Stretch(low, high, 1.0 / rigidity, shears))
    return tuple(stretches)


def _flexibility(stretches: tuple[Stretch, ...], heights: Values, loaded: Values) -> Values:
    """Return the deflections [m] at ``heights``, shape (k,), of a shaft by unit forces at each of ``loaded``, shape (k, n).

    By virtual work, ∫(z − x)(s − x) dx/(E I) + ∫dx/(G A_s) up to the lower of the heights z and s.
    """
    product, total = np.multiply.outer(heights, loaded), np.add.outer(heights, loaded)
    lower, deflections = np.minimum.outer(heights, loaded), np.zeros((len(heights), len(loaded)))
    for low, high, bends, shears in stretches:
        a, b = np.minimum(low, lower), np.minimum(high, lower)
        bent = product * (b - a) - 0.5 * total * (b**2 - a**2) + (b**3 - a**3) / 3.0
        deflections += bends * bent + shears * (b - a)
    return deflections


class BentAbove(NamedTuple):
    """Integrals over the mass above a section, dm over M, at the heights z and Δz above it; Δφ_j is φ_j less that there."""

    # ∫φ_i dm and ∫Δz φ_i dm [m], shape (n,)
    share: Values
    lever: Values
    # ∫Δφ_j dm and ∫Δφ_j z dm [m], shape (n,)
    offset: Values
    turning: Values
    both: Values  # ∫Δφ_j φ_i dm, shape (n, n)


def bent_above(pier: Pier, modes: Modes, height: float) -> BentAbove:
    """Return the integrals of the ``modes`` over the mass of ``pier`` above the section at ``height`` [m]; 0 without mass."""
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


def _points(part: Part, share: float = 1.0) -> tuple[Values, Values]:
    """Return heights [m] and masses [t] of the points that replace the upper ``share`` of a part; one if it has no length."""
    length = share * (part.length_m or 0.0)
    if length == 0.0:
        return np.array([part.height_m]), np.array([part.mass_t])
    return part.upper_end - 0.5 * length * (1.0 - _NODES), 0.5 * _WEIGHTS * share * part.mass_t
