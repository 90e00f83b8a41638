"""Sections of the shaft: their heights, and the mass above each (THEORY.md, Forces in sections)."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rockbatch.common.errors import InputError, Problem, refuse
from rockbatch.pier.block import Pier
from rockbatch.pier.parts import Part

_ROUNDING = 1e-9
"""Share of the pier's height within which a mass at one height is at a section: it counts as above it."""

_SAME = 1e-6
"""Share by which parts may differ from the pier that they belong to."""


class Above(NamedTuple):
    """The part of a pier above a section, per unit mass of the pier."""

    share: float  # of the mass
    rise: float  # of its centre of mass above the section [m]
    inertia: float  # about that centre [m²]


def problems(pier: Pier) -> list[Problem]:
    """Return why forces in sections of ``pier`` cannot be computed; empty if they can."""
    return [Problem("sections", None, text) for text in unknown_masses(pier)]


def unknown_masses(pier: Pier) -> list[str]:
    """Return why it is not known how the mass of ``pier`` is spread over its height; empty if it is."""
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
    wrong = [
        f"part {n}, at {part.height_m:g} m, has no length_m, over which its mass is spread; write length_m = 0 for a "
        "mass at one height"
        for n, part in enumerate(pier.parts, 1)
        if part.length_m is None
    ]
    if not wrong:
        whole = _of_parts(pier.parts, 0.0, 0.0)
        alike = zip((whole.rise, whole.inertia), (pier.height, pier.inertia), strict=True)
        if not all(math.isclose(ours, theirs, rel_tol=_SAME) for ours, theirs in alike):
            wrong.append("the parts are those of another pier; make it by Pier.of_parts again")
    return wrong


def section_heights(pier: Pier, sections: int | Sequence[float]) -> tuple[float, ...]:
    """Return the heights [m] of ``sections``: these, or that many from the foot to the top of the pier.

    Raises ``InputError`` for heights outside the pier, and for a pier whose sections are not known.
    """
    refuse(problems(pier))
    top = pier.highest
    if isinstance(sections, int):
        if sections < 2:
            raise InputError(
                f"sections = {sections}: must be 2 or above: the foot and the top of the pier are among them"
            )
        return tuple(np.linspace(0.0, top, sections).tolist())
    wrong = [
        f"sections_m = {height:g}: must be within 0 and the top of the pier, {top:g} m"
        for height in sections
        if not 0.0 <= height <= top * (1.0 + _ROUNDING)
    ]
    if wrong:
        raise InputError(*wrong)
    return tuple(sorted({float(height) for height in sections}))


def above(pier: Pier, height: float) -> Above:
    """Return the part of ``pier`` above ``height`` [m]; a mass at that height is above."""
    return _of_parts(parts_of(pier), height, _ROUNDING * pier.highest)


def parts_of(pier: Pier) -> Sequence[Part]:
    """Return the parts of a pier: a solid rectangle if it has none."""
    if pier.parts is not None:
        return pier.parts
    return (Part.shaft(2.0 * pier.half_width, 2.0 * pier.height, 1.0),)


def _of_parts(parts: Sequence[Part], height: float, rounding: float) -> Above:
    """Return the part of ``parts`` above ``height`` [m], with a mass that is below it by ``rounding`` [m] or less."""
    pieces = [piece for part in parts if (piece := _piece(part, height, rounding)).share > 0.0]
    share = math.fsum(piece.share for piece in pieces)
    if share == 0.0:
        return Above(0.0, 0.0, 0.0)
    rise = math.fsum(piece.share * piece.rise for piece in pieces) / share
    inertia = math.fsum(piece.inertia + piece.share * (piece.rise - rise) ** 2 for piece in pieces)
    mass = math.fsum(part.mass_t for part in parts)
    return Above(share / mass, rise, inertia / mass)


def _piece(part: Part, height: float, rounding: float) -> Above:
    """Return what of a part is above ``height``: mass [t], rise [m] and inertia [t m²].

    What its inertia has beyond that of a rod is spread evenly over its length, as the width of a rectangle is.
    """
    length, rise = part.length_m or 0.0, part.height_m - height
    if length == 0.0:
        return Above(part.mass_t, rise, part.inertia_t_m2) if rise >= -rounding else Above(0.0, 0.0, 0.0)
    share = min(max(0.5 + rise / length, 0.0), 1.0)
    mass, width = share * part.mass_t, part.inertia_t_m2 - part.mass_t * length**2 / 12.0
    top = rise + 0.5 * length
    return Above(mass, top - 0.5 * share * length, share * width + mass * (share * length) ** 2 / 12.0)
