"""A support's backbone: points of deflection and force through which its first loading passes, and what is possible of them."""

import math
from collections.abc import Sequence
from itertools import pairwise

Points = tuple[tuple[float, float], ...]
"""Points (deflection, force), from the first corner on; the last one gives the slope that goes on."""

MOST_POINTS = 9
"""Greatest number of points of a backbone."""

COLLINEAR = 1e-9
"""Relative growth of a slope from one point to the next that is rounding."""


def slopes(points: Points) -> list[float]:
    """Return the slopes between the origin and the points, of force over deflection; none is above the one before."""
    least: list[float] = []
    for (x, force), (x_end, force_end) in pairwise(((0.0, 0.0), *points)):
        slope = (force_end - force) / (x_end - x)
        least.append(min([slope, *least[-1:]]))
    return least


def greatest(points: Points) -> float:
    """Return the greatest force: that at the last corner if the last slope is 0, else infinity."""
    return points[-2][1] if points[-1][1] == points[-2][1] else math.inf


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
    if not 2 <= len(points) <= MOST_POINTS:
        return (
            f"a backbone has 2 to {MOST_POINTS} points, not {len(points)}: its corners, and one more that gives the slope beyond "
            "the last corner"
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
                f"{_shown(point)} follows {_shown(before)}: the force falls, and a support that softens is not "
                f"followed; write {before[1]:g} there, from which on it is plastic"
            )
        if not slope <= steepest * (1.0 + COLLINEAR):
            return (
                f"between {_shown(before)} and {_shown(point)} it is steeper, {slope:.4g}, than before, {steepest:.4g}; "
                "a backbone is concave: leave out a point, or correct one"
            )
        steepest = min(slope, steepest)
    return ""


def _shown(point: tuple[float, float]) -> str:
    return f"[{point[0]:g}, {point[1]:g}]"
