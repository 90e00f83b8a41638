"""Parts of a pier: masses and uniform lengths with their centres on its axis."""

from typing import NamedTuple

from rockbatch.common.arguments import checked
from rockbatch.common.errors import OutOfRange, Problem, refuse
from rockbatch.common.units import LEAST, MOST, POSITIVE
from rockbatch.pier.sizes import BOUNDS, out_of_bounds


class Part(NamedTuple):
    """A part of a pier, its centre on the axis: mass [t], height above the pivots [m], rotary inertia about it [t m²].

    ``length_m`` is the length along the axis over which its mass is spread evenly, 0 of a mass at one height; only forces in
    sections and shafts that bend need it. ``flexural_rigidity_kNm2`` E I of that length takes the place of
    :attr:`Pier.flexural_period_s`; with ``shear_rigidity_kN`` G A_s it gives by shear, too.

    Examples
    --------
    >>> rb.Part.shaft(width_m=8.0, height_m=30.0, mass_t=2000.0)[:4]
    (2000.0, 15.0, 160666.66666666666, 30.0)
    """

    mass_t: float
    height_m: float
    inertia_t_m2: float = 0.0
    length_m: float | None = None
    flexural_rigidity_kNm2: float | None = None  # noqa: N815 (the study's key)
    shear_rigidity_kN: float | None = None  # noqa: N815

    @property
    def upper_end(self) -> float:
        """Return the height of the part's upper end above the pivots [m]; of its centre if it has no length."""
        return self.height_m + 0.5 * (self.length_m or 0.0)

    @property
    def is_slab_at_foot(self) -> bool:
        """Return whether the part stands on the pivots and is wider than long, by its inertia as a rectangle."""
        length = self.length_m or 0.0
        square = self.mass_t * length**2 / 6.0  # inertia of one as wide as long
        return self.height_m <= 0.5 * length * (1.0 + _ROUNDING) and self.inertia_t_m2 > square

    @classmethod
    @checked
    def shaft(cls, width_m: float, height_m: float, mass_t: float) -> "Part":
        """Return a uniform rectangular shaft from the pivots up to ``height_m``."""
        refuse(out_of_bounds(width_m=width_m, height_m=height_m, mass_t=mass_t))
        return cls.rectangle(mass_t, 0.5 * height_m, height_m, width_m)

    @classmethod
    @checked
    def rectangle(
        cls, mass_t: float, height_m: float, length_m: float, width_m: float, apart_m: float = 0.0, **rigidities: float
    ) -> "Part":
        """Return a rectangle with its centre at ``height_m`` and ``length_m`` along the pier's axis; with ``apart_m`` two such
        legs, of ``mass_t`` together, whose axes are ``apart_m`` from each other."""
        inertia = mass_t * (length_m**2 + width_m**2 + 3.0 * apart_m**2) / 12.0
        return cls(mass_t, height_m, inertia, length_m, **rigidities)


def in_floats(mass_t: float, height_m: float, inertia_t_m2: float = 0.0, *others: float | None) -> Part:
    """Return the part with all values converted to float; ``others`` are its length and rigidities, None for those not given.

    Raises
    ------
    TypeError, ValueError, OverflowError
        If a value is not a number.
    """
    return Part(
        float(mass_t), float(height_m), float(inertia_t_m2), *(None if each is None else float(each) for each in others)
    )


def part_problems(n: int, part: Part) -> list[Problem]:
    """Return a problem for each impossible value of part ``n``; empty if all are possible."""
    wrong = BOUNDS["mass_t"].problems(f"part_{n}_mass_t", part.mass_t)
    for name, value in (("height_m", part.height_m), ("inertia_t_m2", part.inertia_t_m2)):
        if not (value == 0 or LEAST <= value <= MOST):
            wrong.append(Problem(f"part_{n}_{name}", value, _NOT_NEGATIVE, kind=OutOfRange))
    for name in ("flexural_rigidity_kNm2", "shear_rigidity_kN"):
        value = getattr(part, name)
        if value is not None:
            wrong += POSITIVE.problems(f"part_{n}_{name}", value)
    return wrong + _length_problems(n, part)


def _length_problems(n: int, part: Part) -> list[Problem]:
    """Return the problem of an impossible length of part ``n``; empty if it is possible, 0 or not given."""
    length = part.length_m
    if length is None or length == 0:
        return []
    rod = part.mass_t * length**2 / 12.0
    if not LEAST <= length <= MOST:
        text = _NOT_NEGATIVE
    elif 0.5 * length > part.height_m * (1.0 + _ROUNDING):
        text = f"reaches below the pivots; about {part.height_m:g} m it may be {2.0 * part.height_m:g} at most"
    elif part.inertia_t_m2 < rod * (1.0 - _ROUNDING):
        text = (
            f"a mass spread over it has an inertia of m L²/12 = {rod:.6g} t m² at least, inertia_t_m2 = "
            f"{part.inertia_t_m2:g} is less"
        )
    else:
        return []
    return [Problem(f"part_{n}_length_m", length, text, kind=OutOfRange)]


_NOT_NEGATIVE = f"must be 0 or a number above it, to {MOST:g}"

_ROUNDING = 1e-6
"""Relative excess of lengths and inertias over their bounds that is taken for rounding in the study."""
