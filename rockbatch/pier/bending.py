"""The mode in which a shaft bends, fixed at its foot (THEORY.md, A shaft that bends)."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from rockbatch.pier.block import Pier
from rockbatch.pier.parts import Part
from rockbatch.pier.sections import parts_of, shaft_height, unknown_masses

NO_SECTIONS = 'sections: their forces are those of a rigid shaft; write shaft = "rigid", or leave them out'

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
"""Exact to the degree 7: the mode's square over a part is of degree 6."""


class Mode(NamedTuple):
    """Integrals of the mode's shape φ, 1 at the top, over the mass of a pier, per unit mass."""

    first: float  # μ1 = ∫φ dm/M
    second: float  # μ2 = ∫φ² dm/M
    coupling: float  # λ = ∫φ z dm/M [m]


def problems(pier: Pier) -> list[str]:
    """Return why the shaft of ``pier`` cannot bend; empty if it can."""
    wrong = [] if pier.flexural_period_s is not None else [
        'shaft = "elastic": flexural_period_s is missing, the period of the pier fixed at its base; write it in [pier]'
    ]  # fmt: skip
    return wrong + [f'shaft = "elastic": {problem}' for problem in unknown_masses(pier)]


def mode_of(pier: Pier) -> Mode:
    """Return the mode of ``pier``: the line to which a force at the top bends a uniform shaft, and straight above it."""
    top, sums = shaft_height(pier), np.zeros(3)
    parts = parts_of(pier)
    for part in parts:
        z, mass = _points(part, top)
        shape = _shape(z / top)
        sums += mass @ np.stack([shape, shape**2, shape * z], axis=1)
    first, second, coupling = (sums / sum(part.mass_t for part in parts)).tolist()
    return Mode(first, second, coupling)


def shape_at(pier: Pier, height: float) -> float:
    """Return the share of the top's deflection at ``height`` [m]."""
    return float(_shape(np.array(height / shaft_height(pier))))


def _shape(ratio: "np.ndarray") -> "np.ndarray":
    return np.where(ratio <= 1.0, 0.5 * ratio**2 * (3.0 - ratio), 1.5 * ratio - 0.5)


def _points(part: Part, top: float) -> tuple["np.ndarray", "np.ndarray"]:
    """Return heights [m] and masses [t] that stand for a part in integrals of the mode; above the top it is straight."""
    length = part.length_m or 0.0
    if length == 0.0:
        return np.array([part.height_m]), np.array([part.mass_t])
    low, high = part.height_m - 0.5 * length, part.height_m + 0.5 * length
    bounds = sorted({low, min(max(top, low), high), high})
    pieces = [(0.5 * (a + b) + 0.5 * (b - a) * _NODES, 0.5 * (b - a) * _WEIGHTS) for a, b in pairwise(bounds)]
    z, weights = (np.concatenate(values) for values in zip(*pieces, strict=True))
    return z, weights * part.mass_t / length
