"""A support's backbone: points of deflection and force through which its first loading passes, and what is possible of them."""

import math
from collections.abc import Sequence
from itertools import pairwise
from numbers import Real

Points = tuple[tuple[float, float], ...]
"""Points (deflection, force), from the first corner on; the last one gives the slope that goes on."""

MOST_POINTS = 9
"""Greatest number of points of a backbone."""

COLLINEAR = 1e-9
"""Growth of a slope from one point to the next over that slope, and a slope over the first one, that are rounding."""


def slopes(points: Points) -> list[float]:
    """Return the slopes between the origin and the points, of force over deflection; none is above the one before.

    One of the size of rounding is 0: the spring is plastic there.
    """
    least: list[float] = []
    for (x, force), (x_end, force_end) in pairwise(((0.0, 0.0), *points)):
        slope = (force_end - force) / (x_end - x)
        least.append(min([slope, *least[-1:]]))
    return [slope if slope > COLLINEAR * least[0] else 0.0 for slope in least]


def greatest(points: Points) -> float:
    """Return the greatest force: that at the last corner if the last slope is 0, else infinity."""
    return math.inf if slopes(points)[-1] else points[-2][1]


def over_first(points: Points) -> Points:
    """Return the points over the deflection and the force of the first one."""
    x_first, force_first = points[0]
    return tuple((x / x_first, force / force_first) for x, force in points)


def first_corner(points_mm_kn: Points) -> tuple[float, float]:
    """Return stiffness [kN/m] and force [kN] up to the first corner of points of deflections [mm] and forces [kN]."""
    deflection, force = points_mm_kn[0]
    return 1000.0 * force / deflection, force


def wrong_points(points: Sequence[tuple[float, float]]) -> str:
    """Return what is wrong about the points of a backbone, and what to write; "" if nothing is."""
    if not all(map(_is_pair, points)):
        return "each point is a pair of numbers, its deflection and its force"
    if not 2 <= len(points) <= MOST_POINTS:
        return (
            f"a backbone has 2 to {MOST_POINTS} points, not {len(points)}: its corners, and one more that gives the slope beyond "
            "the last corner" + ("; leave out those nearest to a straight line" if len(points) > MOST_POINTS else "")
        )
    if not (points[0][0] > 0.0 and points[0][1] > 0.0):
        return (
            f"its first point is {_shown(points[0])}, where deflection and force must be above 0; leave the origin out"
        )
    if not all(math.isfinite(number) for point in points for number in point):
        return "its deflections and forces must be finite numbers"
    steepest = points[0][1] / points[0][0]
    for before, point in pairwise(points):
        if not point[0] > before[0]:
            return f"{_shown(point)} follows {_shown(before)}: each deflection must be above the one before; sort the points"
        slope = (point[1] - before[1]) / (point[0] - before[0])
        if not slope >= 0.0:
            return (
                f"{_shown(point)} follows {_shown(before)}: the force falls, and softening is not "
                f"modelled; write {_exact(before[1])} there, from which on it is plastic"
            )
        if not slope <= steepest * (1.0 + COLLINEAR):
            return (
                f"between {_shown(before)} and {_shown(point)} it is steeper, {slope:.4g}, than before, {steepest:.4g}; "
                "a backbone is concave: leave out a point, or correct one"
            )
        steepest = min(slope, steepest)
    return ""


def _shown(point: tuple[float, float]) -> str:
    return f"[{_exact(point[0])}, {_exact(point[1])}]"


def _exact(number: float) -> str:
    """Return a number with all its digits, by which it is read back as it is."""
    return repr(float(number)).removesuffix(".0")


def _is_pair(point: object) -> bool:
    return (
        isinstance(point, tuple | list)
        and len(point) == 2
        and all(isinstance(number, Real) and not isinstance(number, bool) for number in point)
    )
