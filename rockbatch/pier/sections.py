"""Sections of the shaft: their heights, and the mass above each (THEORY.md, Forces in sections)."""

import math
from collections.abc import Iterable, Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from rockbatch.common.errors import InputError, Problem, refuse
from rockbatch.pier.block import Pier
from rockbatch.pier.parts import Part

ROUNDING = 1e-9
"""Distance over the pier's height within which a point mass is at a section, and counts as above it."""

_SAME = 1e-6
"""Relative difference allowed between the pier and the sum of its parts."""


class Above(NamedTuple):
    """The part of a pier above a section, per unit mass of the pier."""

    share: float  # of the pier's mass
    rise: float  # height of its centre of mass above the section [m]
    inertia: float  # about that centre [m²]


def problems(pier: Pier) -> list[Problem]:
    """Return a problem for each reason that section forces of ``pier`` cannot be computed; empty if they can."""
    return [Problem("sections", None, text) for text in distribution_problems(pier)]


def distribution_problems(pier: Pier) -> list[str]:
    """Return reasons that the distribution of ``pier``'s mass over its height is not known; [] if it is.

    It is known of a solid rectangle, μ = 3, and of parts that all have a ``length_m``, 0 included, and have the pier's centre and
    inertia; never of a frame.
    """
    if pier.deck_over_columns is not None:
        return [
            "how the deck of a frame presses on each of its columns is not known; leave them out, or give a bent "
            "whose columns are fixed to its cap beam as one pier with parts"
        ]
    if pier.parts is None:
        if math.isclose(pier.mu, 3.0):
            return []
        return [
            f"mu = {pier.mu:g} does not say how the mass is spread over the height; give the pier by [[pier.part]], or "
            "as a solid rectangle, mu = 3"
        ]
    advice = "has no length_m, over which its mass is spread; write length_m = 0 for a mass at one height"
    lacking = [(n, part) for n, part in enumerate(pier.parts, 1) if part.length_m is None]
    wrong = [f"part {n}, at {part.height_m:g} m, {advice}" for n, part in lacking]
    if not wrong:
        whole = _above_section(pier.parts, 0.0, 0.0)
        alike = zip((whole.rise, whole.inertia), (pier.height, pier.inertia), strict=True)
        if not all(math.isclose(ours, theirs, rel_tol=_SAME) for ours, theirs in alike):
            wrong.append("the parts are those of another pier; make it by Pier.of_parts again")
    return wrong


def section_heights(pier: Pier, sections: int | Sequence[float], key: str = "sections_m") -> tuple[float, ...]:
    """Return the heights [m] of ``sections``, ascending, each once: the given ones, or that number at equal distances.

    ``key`` names them in messages. Raises ``InputError`` for a number below two, for heights outside the pier, and for a pier
    whose mass over the height is not known.
    """
    refuse(problems(pier))
    top = pier.highest
    if isinstance(sections, int):
        if sections < 2:
            raise InputError(
                f"sections = {sections}: must be 2 or above: the foot and the top of the pier are among them"
            )
        return tuple(np.linspace(0.0, top, sections).tolist())
    outside = [height for height in sections if not 0.0 <= height <= top * (1.0 + ROUNDING)]
    if outside:
        bounds = f"must be within 0 and the top of the pier, {top:g} m"
        raise InputError(*(f"{key} = {height:g}: {bounds}" for height in outside))
    return tuple(sorted({float(height) for height in sections}))


def heights_in_all(piers: Iterable[Pier], sections: int | Sequence[float], key: str = "sections_m") -> set[float]:
    """Return the set of heights [m] of ``sections`` in all ``piers``; a pier of which :func:`misfits` complains adds none."""
    heights = set[float]()
    for pier in piers:
        with suppress(InputError):
            heights.update(section_heights(pier, sections, key))
    return heights


def misfits(piers: Iterable[Pier], sections: int | Sequence[float], key: str = "sections_m") -> list[str]:
    """Return why some of the ``piers`` cannot have the ``sections``, each reason once; [] if all can."""
    reasons = dict[str, None]()
    for pier in piers:
        try:
            section_heights(pier, sections, key)
        except InputError as error:
            reasons |= dict.fromkeys(error.messages)
    return [*reasons]


def above(pier: Pier, height: float) -> Above:
    """Return the part of ``pier`` above ``height`` [m]; a mass at that height is above."""
    return _above_section(parts_of(pier), height, ROUNDING * pier.highest)


def parts_of(pier: Pier) -> Sequence[Part]:
    """Return the parts of a pier; a solid rectangle of 1 t if it has none."""
    if pier.parts is not None:
        return pier.parts
    return (Part.shaft(2.0 * pier.half_width, 2.0 * pier.height, 1.0),)


def _above_section(parts: Sequence[Part], height: float, rounding: float) -> Above:
    """Return mass share, rise and inertia of ``parts`` above ``height`` [m]; zeros if nothing is above.

    A point mass at most ``rounding`` [m] below the section counts as above.
    """
    pieces = [piece for part in parts if (piece := _piece(part, height, rounding)).share > 0.0]
    share = math.fsum(piece.share for piece in pieces)
    if share == 0.0:
        return Above(0.0, 0.0, 0.0)
    rise = math.fsum(piece.share * piece.rise for piece in pieces) / share
    inertia = math.fsum(piece.inertia + piece.share * (piece.rise - rise) ** 2 for piece in pieces)
    mass = math.fsum(part.mass_t for part in parts)
    return Above(share / mass, rise, inertia / mass)


def share_above(part: Part, height: float, rounding: float) -> float:
    """Return the share of a part above ``height`` [m], 0 to 1.

    A point mass at most ``rounding`` [m] below counts as above, and the end of a shaft at most that far above does not.
    """
    length, rise = part.length_m or 0.0, part.height_m - height
    if length == 0.0:
        return 1.0 if rise >= -rounding else 0.0
    return min(0.5 + rise / length, 1.0) if rise + 0.5 * length > rounding else 0.0


def _piece(part: Part, height: float, rounding: float) -> Above:
    """Return mass [t], rise [m] and inertia [t m²] of the piece of a part above ``height`` [m]; zeros for a point mass below it.

    The inertia in excess of a rod's is spread evenly over the length, as that of a rectangle's width is.
    """
    length, rise = part.length_m or 0.0, part.height_m - height
    share = share_above(part, height, rounding)
    if length == 0.0:
        return Above(part.mass_t, rise, part.inertia_t_m2) if share else Above(0.0, 0.0, 0.0)
    mass, width = share * part.mass_t, part.inertia_t_m2 - part.mass_t * length**2 / 12.0
    top = rise + 0.5 * length
    return Above(mass, top - 0.5 * share * length, share * width + mass * (share * length) ** 2 / 12.0)
