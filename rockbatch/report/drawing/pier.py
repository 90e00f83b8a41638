"""The pier to scale: the pivots on which it steps, its centre of mass, its supports and its devices."""

import math
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from rockbatch.pier import Damper, Pier, Place, Restraint, places
from rockbatch.report.drawing.svg import line, lowered, rectangle, svg, text
from rockbatch.report.markup import Markup, number, tag

HEIGHT = 190.0
"""Height of the highest pier [px]."""

LEFT, RIGHT, ABOVE, BELOW = 30.0, 110.0, 14.0, 48.0
"""Room around a pier for its labels [px]."""

SPRING = 20.0
"""Height of a support's spring [px]: not to scale, it has none."""

ASIDE = 9.0
"""Distance of a damper outside its pivot [px]."""

MOST = 4
"""Most piers that are drawn; more would show nothing new."""


def piers(all_of_them: Sequence[Mapping[str, Any]], bases: Collection[str]) -> list[Markup]:
    """Draw each pier, at one scale; ``all_of_them`` as in run.json, ``bases`` the kinds of their bases.

    A pier with impossible values is left out, since run.json may come from anybody.
    """
    shown = [pier for pier in all_of_them if _can_be(pier)][:MOST]
    if not shown:
        return []
    scale = HEIGHT / max(_highest(pier) for pier in shown)
    return [_pier(pier, scale, any(base != "rigid" for base in bases)) for pier in shown]


def devices(pier: Pier, restraints: Sequence[Restraint]) -> tuple[tuple[str, Place], ...]:
    """Return kinds and places of devices."""
    return tuple(
        (f"{restraint.kind} damper" if isinstance(restraint, Damper) else restraint.what.replace("_", " "), place)
        for restraint in restraints
        for place in places(pier, restraint)
    )


def _can_be(pier: Mapping[str, Any]) -> bool:
    width, height = 2.0 * pier["half_width_m"], pier["height_m"]
    return (
        0.0 < pier["alpha"] < 0.5 * math.pi
        and 0.0 < height < 1e6
        and 0.0 < width < 100.0 * height
        and 0.0 < _top(pier) < 1e6
    )


def _top(pier: Mapping[str, Any]) -> float:
    """Return the height of the highest point of the shaft [m]; that of a uniform block if it is not given."""
    return float(pier.get("top_m") or 2.0 * pier["height_m"])


def _highest(pier: Mapping[str, Any]) -> float:
    return max(_top(pier), float(pier.get("deck_m") or 0.0))


def _pier(pier: Mapping[str, Any], scale: float, springs: bool) -> Markup:
    b, h, top = (scale * length for length in (pier["half_width_m"], pier["height_m"], _top(pier)))
    middle, ground = LEFT + max(b, 30.0), ABOVE + max(scale * _highest(pier), h)
    width, height = middle + max(b, 30.0) + RIGHT, ground + BELOW
    left, right, centre = middle - b, middle + b, ground - h
    arc = 0.45 * math.hypot(b, h)
    end = right - arc * math.sin(pier["alpha"]), ground - arc * math.cos(pier["alpha"])
    drawn = [
        rectangle(left, ground - top, 2.0 * b, top, "band"),
        tag("path", d=f"M{left:.1f} {ground:.1f}V{ground - top:.1f}H{right:.1f}V{ground:.1f}z", class_="rigid"),
        line(right, ground, middle, centre, "rigid d1"),
        line(right, ground, right, ground - 1.15 * arc, "edge"),
        tag(
            "path",
            d=f"M{right:.1f} {ground - arc:.1f}A{arc:.1f} {arc:.1f} 0 0 0 {end[0]:.1f} {end[1]:.1f}",
            class_="edge",
        ),
        text(right + 4.0, ground - arc + 4.0, "α", class_="q"),
        text(left - 6.0, 0.5 * (centre + ground), lowered("R", "0"), class_="e q"),
        tag("circle", cx=f"{middle:.1f}", cy=f"{centre:.1f}", r=2.6, class_="peak"),
        *_length(right + 26.0, ground, right + 26.0, centre, f"h = {number(pier['height_m'], '.3g')} m"),
        *(mark for x in (left, right) for mark in _support(x, ground, springs)),
        *_deck(pier, middle, b, ground, scale),
        *(mark for kind, place in pier.get("devices", ()) for mark in _device(kind, middle, place, scale, ground, top)),
        *_length(left, ground + 32.0, right, ground + 32.0, f"2b = {number(2.0 * pier['half_width_m'], '.3g')} m"),
    ]
    support = "two springs" if springs else "rigid ground"
    description = (
        f"The pier to scale on {support}: {2.0 * pier['half_width_m']:.3g} m between its pivots, centre of mass "
        f"{pier['height_m']:.3g} m above them, slenderness {pier['alpha']:.3g} rad"
    )
    if kinds := dict.fromkeys(kind for kind, _ in pier.get("devices", ())):
        description += f", with {' and '.join(kinds)}"
    named = tag("figcaption", pier["name"]) if pier.get("name") else ""
    return tag("figure", named, svg(width, height, *drawn, description=description), style=f"width:{width:.0f}px")


def _deck(pier: Mapping[str, Any], middle: float, b: float, ground: float, scale: float) -> list[Markup]:
    """Draw the deck at its height: a slab of no particular size, since none is given."""
    if not pier.get("deck_m"):
        return []
    y = ground - scale * float(pier["deck_m"])
    half = max(b, 24.0) + 6.0
    return [
        rectangle(middle - half, y - 3.0, 2.0 * half, 6.0, "deck"),
        text(middle + half + 4.0, y + 4.0, f"deck, {number(float(pier['deck_m']), '.3g')} m"),
    ]


def _device(kind: str, middle: float, place: Place, scale: float, ground: float, top: float) -> list[Markup]:
    """Draw a tendon up to the top, a stop above the base, or a damper between it and the ground, outside the support there.

    Beside the deck, a wall that the deck meets, or to which it is tied, on the side on which it is.
    """
    if place.height:
        y, side = ground - scale * place.height, place.way or 1.0
        near, far = (middle + side * reach for reach in (30.0, 30.0 + SPRING))
        bar = line(near, y, far, y, "tendon s3", kind)
        return [bar, line(far, y - ASIDE, far, y + ASIDE, "rigid")]
    offset = scale * place.offset
    if kind == "tendon":
        return [line(middle + offset, ground + SPRING, middle + offset, ground - top, "tendon s2", kind)]
    x = middle + offset + math.copysign(ASIDE, offset)
    if kind == "stop":
        end = ground - ASIDE
        return [line(x, ground + SPRING, x, end, "rigid", kind), line(x, end, middle + offset, end, "rigid")]
    body = rectangle(x - 3.0, ground + 5.0, 6.0, 9.0, "damper s3")
    return [
        line(middle + offset, ground, x, ground, "tendon s3"),
        line(x, ground, x, ground + SPRING, "tendon s3", kind),
        body,
    ]


def _support(x: float, ground: float, spring: bool) -> list[Markup]:
    """Draw the support of a pivot: a spring on the ground, or the ground."""
    below = ground + (SPRING if spring else 0.0)
    parts = [line(x - 9.0, below, x + 9.0, below, "rigid")]
    parts += [line(x + offset, below, x + offset - 4.0, below + 5.0, "edge") for offset in (-5.0, 0.0, 5.0, 9.0)]
    if spring:
        turns = "".join(
            f"L{x + side:.1f} {ground + (i + 1) * SPRING / 6:.1f}" for i, side in enumerate((4, -4, 4, -4, 4))
        )
        parts.append(tag("path", d=f"M{x:.1f} {ground:.1f}{turns}L{x:.1f} {below:.1f}", class_="rigid"))
    return parts


def _length(x1: float, y1: float, x2: float, y2: float, words: str) -> list[Markup]:
    """Draw a dimension line, with its text below or beside it."""
    flat = y1 == y2
    ends = [
        line(x, y - 3.0, x, y + 3.0, "edge") if flat else line(x - 3.0, y, x + 3.0, y, "edge")
        for x, y in ((x1, y1), (x2, y2))
    ]
    note = text(0.5 * (x1 + x2), y1 + 14.0, words, class_="m") if flat else text(x1 + 4.0, 0.5 * (y1 + y2) + 4.0, words)
    return [line(x1, y1, x2, y2, "edge"), *ends, note]
