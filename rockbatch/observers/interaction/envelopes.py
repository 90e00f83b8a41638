"""Envelopes of an effect over the axial force of the same moment: the corners at which a capacity may govern."""

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from rockbatch.outcome.changes import LEAST
from rockbatch.quantities.statistics import Values

DIRECTIONS = np.linspace(0.0, np.pi, 61)
"""Directions in the plane of N and E in which two envelopes are compared [rad]."""

FLATNESS = 1e-4
"""Greatest reach, over the greatest |N| or E, that an envelope may lose with the corners that are left out."""


class Envelope(NamedTuple):
    """Corners of the least concave envelope over N of an effect E, each over the mass, shape (k,): the magnitude of the moment in
    a section, or of the shear of the base.

    ``error`` is relative to the greatest |N| and E; None with a fixed step.
    """

    height: float | None  # of the section [m]; None of the base
    axial: Values  # N/M, positive in compression, ascending [m/s²]
    effect: Values  # E/M [m²/s²], or [m/s²] of the base
    error: float | None = None

    @property
    def sizes(self) -> tuple[float, float]:
        """Return the greatest |N| and E, either LEAST at least."""
        return max(float(np.abs(self.axial).max()), LEAST), max(float(self.effect.max()), LEAST)


def envelope(height: float | None, axial: Values, effect: Values) -> Envelope:
    """Return the corners of the least concave envelope of |``effect``| over ``axial``, by ascending axial force.

    A ratio of E to a concave capacity, over time, is greatest at one of its corners (THEORY.md, Forces in sections).
    """
    corners: list[tuple[float, float]] = []
    for point in sorted(_on_the_outside(axial, np.abs(effect))):
        while corners and (
            corners[-1][0] == point[0] or (len(corners) > 1 and not _turns_right(corners[-2], corners[-1], point))
        ):
            corners.pop()
        corners.append(point)
    n, e = np.array(corners).T
    return Envelope(height, n, e)


def _on_the_outside(axial: Values, effect: Values) -> Iterator[tuple[float, float]]:
    """Yield the points that may be corners: those on and above the lines between the farthest ones in :data:`DIRECTIONS`."""
    n, e = axial / max(float(np.abs(axial).max()), LEAST), effect / max(float(effect.max()), LEAST)
    farthest = {int((np.cos(way) * n + np.sin(way) * e).argmax()) for way in DIRECTIONS}
    far = np.array(sorted(farthest | {int(n.argmin()), int(n.argmax())}, key=lambda i: (axial[i], effect[i])))
    outside = effect >= np.interp(axial, axial[far], effect[far])
    outside[far] = True
    return zip(axial[outside].tolist(), effect[outside].tolist(), strict=True)


def thinned(of: Envelope) -> Envelope:
    """Return an envelope without corners whose absence costs it at most :data:`FLATNESS`, which is added to its error, if any.

    Both ends and the greatest effect stay.
    """
    n, e = of.axial / of.sizes[0], of.effect / of.sizes[1]
    kept = [0, int(e.argmax()), len(n) - 1]
    spans = [*pairwise(kept)]
    while spans:
        first, last = spans.pop()
        along = n[last] - n[first], e[last] - e[first]
        away = along[0] * (e[first + 1 : last] - e[first]) - along[1] * (n[first + 1 : last] - n[first])
        if len(away) and away.max() > FLATNESS * math.hypot(*along):
            corner = first + 1 + int(away.argmax())
            kept.append(corner)
            spans += [(first, corner), (corner, last)]
    places = np.unique(kept)
    error = None if of.error is None else of.error + FLATNESS
    return of._replace(axial=of.axial[places], effect=of.effect[places], error=error)


def _turns_right(first: tuple[float, float], second: tuple[float, float], third: tuple[float, float]) -> bool:
    """Return whether a path through three points, by ascending N, turns to the right at the second; False if it is straight."""
    (n, m), (n2, m2), (n3, m3) = first, second, third
    return (n2 - n) * (m3 - m) < (m2 - m) * (n3 - n)


def with_errors(fine: Sequence[Envelope], coarse: Sequence[Envelope], chance: float) -> list[Envelope]:
    """Return ``fine`` with ``chance`` times the greatest change of their reach in any direction added to their errors."""
    changed = []
    for own, other in zip(fine, coarse, strict=True):
        change = float(np.abs(_reach(own, own.sizes) - _reach(other, own.sizes)).max())
        changed.append(own._replace(error=(own.error or 0.0) + chance * max(change, LEAST)))
    return changed


def _reach(of: Envelope, sizes: tuple[float, float]) -> Values:
    """Return how far an envelope reaches in each of :data:`DIRECTIONS`, with N and E over their ``sizes``."""
    n, e = of.axial / sizes[0], of.effect / sizes[1]
    return np.asarray((np.outer(np.cos(DIRECTIONS), n) + np.outer(np.sin(DIRECTIONS), e)).max(axis=1))
