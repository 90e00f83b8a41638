"""Supports of a pier of known mass: β and η from kN/m and kN, and their usual values."""

import math
from collections.abc import Callable, Collection
from typing import Any, NamedTuple

from rockbatch.common.errors import MissingKey, Problem, Unusual, refuse
from rockbatch.common.units import POSITIVE, in_other_units
from rockbatch.pier.backbones import Points, first_corner, over_first
from rockbatch.pier.block import Pier

MOST_ETA = 100.0
"""η above which a wrong unit is likelier than the support: foundations bear 2 to 20 times their static load."""

LIGHTEST, HEAVIEST = 5.0, 1e5
"""Bounds of the stress under a support at rest [kPa]: footings have 100 to 1000, steel bearings some 30 000."""

LEAST_DEFLECTION_MM = 0.02
"""Static deflection [mm] of supports below which a wrong unit is likelier than the ground: on sound rock it is some 0.1 mm."""

FIXED_BY_POINTS = ("beta", "stiffness_kN_m", "eta", "yield_kN")
"""Keys that the first point of a backbone fixes."""


def beta_of(pier: Pier, stiffness_kN_m: float) -> float:
    """Return β = sqrt(2K/M)/p of supports with the stiffness K [kN/m]. Raises ``InputError`` for a pier without mass."""
    mass = _mass(pier, stiffness_kN_m=stiffness_kN_m)
    return math.sqrt(2 * stiffness_kN_m / mass) / pier.p


def eta_of(pier: Pier, yield_kN: float) -> float:
    """Return η = 2 F_y/(M g) of supports with the yield force F_y [kN]. Raises ``InputError`` for a pier without mass."""
    return 2 * yield_kN / (_mass(pier, yield_kN=yield_kN) * pier.gravity)


def of_backbone(pier: Pier, points_mm_kn: Points) -> dict[str, Any]:
    """Return β, η and the points over the first one, by field, of supports with a backbone [mm, kN].

    Raises ``InputError`` for a pier without mass.
    """
    stiffness, force = first_corner(points_mm_kn)
    return {"beta": beta_of(pier, stiffness), "eta": eta_of(pier, force), "backbone": over_first(points_mm_kn)}


def _mass(pier: Pier, **value: float) -> float:
    """Return the mass [t] of ``pier``. Raises ``InputError`` without one, or if the named value is not positive."""
    wrong = [problem for name, number in value.items() for problem in POSITIVE.problems(name, number)]
    if pier.mass_t is None:
        wrong.append(NO_MASS)
    refuse(wrong)
    assert pier.mass_t is not None
    return pier.mass_t


NO_MASS = Problem(
    "mass_t", None, "mass_t is missing: kN and kN/m are of a pier whose mass is known", kind=MissingKey, named=False
)


class Support(NamedTuple):
    """A measure of a support under a pier of known mass, its usual bounds, and the text of the problem outside them."""

    comes_to: Callable[[Pier, float], float]
    least: float
    most: float
    words: str

    def holds(self, pier: Pier, value: float) -> bool:
        """Return True if the measure of ``value`` is within the usual bounds under ``pier``."""
        return self.least <= self.comes_to(pier, value) <= self.most

    def doubts(self, pier: Pier, name: str, value: float) -> list[Problem]:
        """Return the problem of an unusual value of the key ``name``; empty if it is usual."""
        if self.holds(pier, value):
            return []
        text = self.words.format(self.comes_to(pier, value))
        text += in_other_units(name, value, lambda other: self.holds(pier, other))
        return [Problem(name, value, text, confirm=name, kind=Unusual)]


def _half_weight(pier: Pier) -> float:
    assert pier.mass_t is not None
    return 0.5 * pier.mass_t * pier.gravity


SUPPORTS = {
    "stiffness_kN_m": Support(
        lambda pier, value: 1000.0 * _half_weight(pier) / value,
        LEAST_DEFLECTION_MM,
        math.inf,
        "the pier's weight presses the supports in by {:.2g} mm only, where sound rock gives some 0.1 mm",
    ),
    "contact_stiffness_kN_m": Support(
        lambda pier, value: 1000.0 * _half_weight(pier) / value,
        LEAST_DEFLECTION_MM,
        math.inf,
        "the pier's weight presses the ground in by {:.2g} mm only, where sound rock gives some 0.1 mm",
    ),
    "yield_kN": Support(
        eta_of, 0.0, MOST_ETA, "{:.3g} times what the support carries at rest, where 2 to 20 times is usual"
    ),
    "area_m2": Support(
        lambda pier, value: _half_weight(pier) / value,
        LIGHTEST,
        HEAVIEST,
        "the pier's weight presses {:.2g} kPa on it, where footings have 100 to 1000 kPa",
    ),
}
"""Usual supports of a pier of known mass, in a study and in Python alike; other values suggest a wrong unit."""


def unlikely_supports(pier: Pier, confirm: Collection[str], **values: float | None) -> list[Problem]:
    """Return a problem for each unusual value of :data:`SUPPORTS`; none for None, or for a name in ``confirm``."""
    given = {name: value for name, value in values.items() if value is not None and name not in confirm}
    return [problem for name, value in given.items() for problem in SUPPORTS[name].doubts(pier, name, value)]
