"""Possible and plausible sizes of a pier.

Implausible ones, as of a wrong unit or of two values exchanged, are refused until ``confirm`` names them.
"""

import math
from collections.abc import Collection, Mapping

from rockbatch.common.errors import OutOfRange, Problem, Unusual
from rockbatch.common.units import LEAST, MOST, POSITIVE, Bounds, Usual


def _if_in_degrees(angle: float) -> str:
    """Return advice to append for an angle [rad] that may be in degrees: "; if it is in degrees, write 0.2"; "" for NaN, inf."""
    return f"; if it is in degrees, write {math.radians(angle):.4g}" if math.isfinite(angle) else ""


def _slenderness(alpha: float) -> str:
    if alpha < math.pi / 2:
        return f"must be within {BOUNDS['alpha'].low:g} and π/2 = 1.5708 rad"
    return f"must be below π/2 = 1.5708 rad{_if_in_degrees(alpha)}"


def _rotation(theta: float) -> str:
    return f"must be between −π/2 and π/2 rad{_if_in_degrees(theta)}"


_LENGTH, _MASS = Bounds(LEAST, MOST, " [m]"), Bounds(LEAST, MOST, " [t]")

BOUNDS = {
    "alpha": Bounds(1e-4, math.pi / 2, " [rad]", _slenderness, below=True),
    "p": Bounds(1e-3, 1e3, " [rad/s]"),
    "mu": Bounds(1e-3, 1e12, " (3 for a rectangle)"),
    "gravity": Bounds(1e-3, 1e3, " [m/s²]"),
    **dict.fromkeys(("size_m", "width_m", "height_m", "top_m", "deck_height_m"), _LENGTH),
    **dict.fromkeys(("mass_t", "deck_mass_t"), _MASS),
    "flexural_period_s": Bounds(LEAST, MOST, " [s]"),
    "deck_over_columns": POSITIVE,
    "initial_rotation_rad": Bounds(-math.pi / 2, math.pi / 2, why=_rotation),
}
"""Possible values of a pier, far wider than any that exists: p = 0.001 rad/s is a size of 7000 km. Beyond them a run would never
end."""


_USUAL_HEIGHT = Usual(
    400.0, "m: the highest bridge piers reach some 300 m, blocks in laboratories 0.1 m at least", 0.05
)
_USUAL_MASS = Usual(1e6, "t: the heaviest bridge piers weigh some 200 000 t")

USUAL: dict[str, Usual] = {
    "gravity": Usual(30.0, "m/s²: on Earth it is 9.81", 1.0),
    "p": Usual(30.0, "rad/s: piers have 0.2 to 2, which are 200 to 2 m of R0, blocks in laboratories up to 10", 0.1),
    "size_m": _USUAL_HEIGHT._replace(least=0.1),
    "width_m": _USUAL_HEIGHT._replace(least=0.01),
    **dict.fromkeys(("height_m", "top_m", "deck_height_m"), _USUAL_HEIGHT),
    **dict.fromkeys(("mass_t", "deck_mass_t"), _USUAL_MASS),
    "flexural_period_s": Usual(10.0, "s: bridge piers have 0.1 to 3", 0.02),
    "initial_rotation_rad": Usual(2.0, "rad: release tests have 0.2 to 0.9 of alpha", 1e-4),
}
"""Usual values of a pier, in a study and in Python alike."""


LOWEST, HIGHEST = 0.25, 2.5
"""Bounds of the heights of deck and drift, over the pier's height."""

THINNEST, THICKEST = 0.03, 1000.0
"""Bounds of the rocking mass over width squared times twice the height of its centre [t/m³]: hollow towers have some 0.2, walls
with a deck some 30, slender frames more."""

NARROWEST, BROADEST = 0.01, 5.0
"""Bounds of a deck's radius of gyration over its height: a deck 10 m wide has 3 m."""

LIGHTEST, HEAVIEST = 0.005, 100.0
"""Bounds of the mass of a deck over the mass that carries it."""


def out_of_bounds(**values: float | None) -> list[Problem]:
    """Return a problem for each of the named values that is not None and outside its :data:`BOUNDS`."""
    return [problem for name, value in values.items() for problem in BOUNDS[name].problems(name, value)]


def falls(alpha: float, theta: float) -> list[Problem]:
    """Return the problem of a release from ``theta`` [rad] at or beyond ±``alpha``, which overturns; empty between these."""
    if abs(theta) < alpha:
        return []
    degrees = _if_in_degrees(theta) if abs(theta) > 0.5 else ""
    text = f"must be below alpha = {alpha:.4g} rad in magnitude, beyond which a released pier overturns{degrees}"
    return [Problem("initial_rotation_rad", theta, text, kind=OutOfRange)]


def odd(name: str, value: float, text: str) -> Problem:
    """Return the problem of an unusual value, which ``confirm`` accepts under the same name."""
    return Problem(name, value, text, confirm=name, kind=Unusual)


def unusual(usual: Mapping[str, Usual], confirm: Collection[str], **values: float | None) -> list[Problem]:
    """Return a problem for each of the named values that is not None, outside ``usual`` and not in ``confirm``."""
    given = {name: value for name, value in values.items() if value is not None and name not in confirm}
    return [problem for name, value in given.items() for problem in usual[name].doubts(name, value)]


def unlikely_sizes(width_m: float, height_m: float, confirm: Collection[str], **heights: float | None) -> list[Problem]:
    """Return a problem for a pier wider than high, and one for each implausible height [m]; none for names in ``confirm``."""
    wrong = []
    if width_m > height_m and "width_m" not in confirm:
        text = (
            f"more than the height, {height_m:g} m: such a block lifts off at {width_m / height_m:.2g} g only, and slides "
            "before; width and height may be exchanged"
        )
        wrong = [odd("width_m", width_m, text)]
    return wrong + unlikely_heights(height_m, confirm, **heights)


def unlikely_heights(height_m: float, confirm: Collection[str], **heights: float | None) -> list[Problem]:
    """Return a problem for each of ``heights`` [m] outside 0.25 to 2.5 times ``height_m``, unless it is in ``confirm``."""
    wrong = []
    for name, value in heights.items():
        if value is None or LOWEST * height_m <= value <= HIGHEST * height_m or name in confirm:
            continue
        wrong.append(odd(name, value, f"{value / height_m:.2g} times the height of the pier, {height_m:g} m"))
    return wrong


def unlikely_deck(mass_t: float, deck_mass_t: float, confirm: Collection[str]) -> list[Problem]:
    """Return the problem of a deck implausibly light or heavy for the ``mass_t`` below it; empty if in ``confirm``."""
    ratio = deck_mass_t / mass_t
    if LIGHTEST <= ratio <= HEAVIEST or "deck_mass_t" in confirm:
        return []
    return [odd("deck_mass_t", deck_mass_t, f"{ratio:.3g} times the mass of the pier, mass_t = {mass_t:g}")]


def unlikely_inertia(
    deck_mass_t: float, inertia_t_m2: float, height_m: float, confirm: Collection[str]
) -> list[Problem]:
    """Return the problem of an implausible radius of gyration of a deck at ``height_m``; empty if 0 or in ``confirm``."""
    radius = math.sqrt(max(inertia_t_m2, 0.0) / deck_mass_t)
    if inertia_t_m2 == 0 or NARROWEST * height_m <= radius <= BROADEST * height_m or "deck_inertia_t_m2" in confirm:
        return []
    text = f"that of a mass of {deck_mass_t:g} t at {radius:.2g} m from its axis, of a deck at {height_m:g} m"
    return [odd("deck_inertia_t_m2", inertia_t_m2, text)]
