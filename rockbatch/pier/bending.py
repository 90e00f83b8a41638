"""The flexural mode of a shaft fixed at its foot (THEORY.md, A shaft that bends)."""

from typing import NamedTuple

import numpy as np

from rockbatch.common.errors import Problem
from rockbatch.pier.block import Pier
from rockbatch.pier.parts import Part
from rockbatch.pier.sections import parts_of, unknown_masses

NO_SECTIONS = 'sections: their forces are those of a rigid shaft; write shaft = "rigid", or leave them out'

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
"""Exact to the degree 7: the mode's square over a part is of degree 6."""


class Mode(NamedTuple):
    """Integrals of the mode shape φ, 1 at the top, over the mass of a pier, per unit mass."""

    first: float  # μ1 = ∫φ dm/M
    second: float  # μ2 = ∫φ² dm/M
    coupling: float  # λ = ∫φ z dm/M [m]


def problems(pier: Pier) -> list[Problem]:
    """Return a problem for each reason that the shaft of ``pier`` cannot be taken as elastic; empty if it can."""
    lacking = "flexural_period_s is missing, the period of the pier fixed at its base; write it in [pier]"
    texts = [*([lacking] if pier.flexural_period_s is None else []), *unknown_masses(pier)]
    return [Problem("shaft", "elastic", text) for text in texts]


def mode_of(pier: Pier) -> Mode:
    """Return the mode of ``pier``: the deflection of a uniform cantilever under a force at its highest point."""
    top, sums = pier.highest, np.zeros(3)
    parts = parts_of(pier)
    for part in parts:
        z, mass = _points(part)
        shape = _shape(z / top)
        sums += mass @ np.stack([shape, shape**2, shape * z], axis=1)
    first, second, coupling = (sums / sum(part.mass_t for part in parts)).tolist()
    return Mode(first, second, coupling)


def shape_at(pier: Pier, height: float) -> float:
    """Return the mode shape at ``height`` [m]: its deflection over that of the highest point."""
    return float(_shape(np.array(height / pier.highest)))


def _shape(ratio: "np.ndarray") -> "np.ndarray":
    """Return φ at a ``ratio`` of heights, 1 at the highest point; the tangent continues above it, where drift may be read."""
    return np.where(ratio <= 1.0, 0.5 * ratio**2 * (3.0 - ratio), 1.5 * ratio - 0.5)


def _points(part: Part) -> tuple["np.ndarray", "np.ndarray"]:
    """Return quadrature points of a part: heights [m] and masses [t]."""
    length = part.length_m or 0.0
    if length == 0.0:
        return np.array([part.height_m]), np.array([part.mass_t])
    return part.height_m + 0.5 * length * _NODES, 0.5 * _WEIGHTS * part.mass_t
