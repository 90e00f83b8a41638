"""Figures of a pier: its statics, and the pier to scale with its supports and devices."""

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from rockbatch.common.figures.description import (
    COLOURS,
    DASHES,
    Area,
    Axis,
    Figure,
    Look,
    Mark,
    Panel,
    Points,
    Polyline,
    Rule,
    Words,
    line_of,
)
from rockbatch.pier.bending import flexural_period
from rockbatch.pier.block import Pier
from rockbatch.pier.equilibrium import Equilibria
from rockbatch.pier.free_rocking import Swings
from rockbatch.pier.places import Place, places
from rockbatch.pier.restraints import Restraint

MOST_SHEETS = COLOURS * DASHES
"""Most cases that are drawn: colours times dashes."""
SHARES = {"weight": "weight and supports", "tendons": "tendons", "stops": "stops, deck springs", "dampers": "dampers"}

HEIGHT = 190.0
"""Height of the highest pier [px]."""
SIDE, ABOVE, BELOW = 30.0, 14.0, 48.0
"""Least room around a pier [px]."""
CAPTION = 176.0
"""Least width of a sketch with a caption [px]."""
LETTER = 6.5
"""Width of a letter of a label [px]."""
APART = 13.0
"""Least distance between labels of heights [px]."""
MOST_SECTIONS = 5
"""Most sections whose heights are written; of more only the lowest and the highest."""
SPRING = 20.0
"""Height of a support's spring [px]: not to scale, it has none."""
STRIPS = 5
"""Springs that stand for the strips of a footing's bed."""
ASIDE = 9.0
"""Distance of a damper outside its pivot [px]."""
MOST_PIERS = 4
"""Most piers that are drawn; more would show nothing new."""


class Sheet(NamedTuple):
    """Curves and marks of a statics sheet."""

    name: str
    pier: Pier
    equilibria: Equilibria
    swings: Swings
    pressed: np.ndarray | None = None  # share of a footing at the rotations of the equilibria


def statics(sheets: Sequence[Sheet]) -> Figure:
    """Return a figure of righting moment and steady acceleration over rotation, and of period over amplitude; of footings also
    the share that is pressed; for a single pier also the contributions to the moment, and its period fixed at the base.

    The first :data:`MOST_SHEETS` are drawn; moments are over the weight unless every pier has a mass.
    """
    sheets = sheets[:MOST_SHEETS]
    heavy = all(sheet.pier.mass_t is not None for sheet in sheets)
    moments, accelerations, periods, shares_pressed = [], [], [], []
    for place, (name, pier, at, swings, pressed) in enumerate(sheets):
        look, label = line_of(place), name if len(sheets) > 1 else ""
        size = 1e-3 * (pier.mass_t or 0.0) * pier.gravity if heavy else 1.0
        across = at.theta / pier.alpha
        moments.append(Polyline(across, size * at.moment, name, look=look, label=label))
        accelerations.append(Polyline(across, at.acceleration, name, look=look))
        periods.append(Polyline(swings.amplitude / pier.alpha, swings.period, name, look=look))
        if pressed is not None:
            shares_pressed.append(Polyline(across, pressed, name, look=look))
        shares = {words: getattr(at, share) for share, words in SHARES.items()} if len(sheets) == 1 else {}
        shown = [(words, values) for words, values in shares.items() if values.any()]
        if len(shown) > 1:
            for i, (words, values) in enumerate(shown, 1):
                moments.append(Polyline(across, size * values, words, look=line_of(i), label=words))
    flexural = flexural_period(sheets[0].pier) if len(sheets) == 1 else None
    fixed = []
    if flexural is not None:
        fixed = [Rule("y", np.array([flexural]), look=line_of(4), label="period fixed at its base")]
    panels = [
        _over("θ/α", "moment [MN m]" if heavy else "moment/weight [m]", moments, "righting moment"),
        _over("θ/α", "acceleration [g]", accelerations, "steady horizontal ground acceleration that holds the pier"),
        _over("amplitude/α", "period [s]", periods, "free rocking", fixed),
    ]
    if shares_pressed:
        panels.append(_over("θ/α", "share pressed", shares_pressed, "share of the footing that is pressed"))
    return Figure(panels, "Statics")


def _over(across: str, up: str, lines: Sequence[Polyline], caption: str, fixed: Sequence[Rule] = ()) -> Panel:
    """Return a panel of ``lines`` and ``fixed`` rules whose axes begin at 0."""
    right = max((float(line.x.max()) for line in lines if len(line.x)), default=1.0)
    tops = [float(np.nanmax(line.y, initial=0.0)) for line in lines] + [float(rule.at.max()) for rule in fixed]
    axes = Axis(across, 0.0, right or 1.0, about=8), Axis(up, 0.0, 1.06 * max(tops, default=1.0) or 1.0, about=6)
    return Panel(*axes, [*lines, *fixed], caption, width=300.0, height=150.0)


class PlacedDevice(NamedTuple):
    """A device as it is drawn: the name of its table in a study, which decides its symbol, its words, and its place."""

    what: str
    words: str
    place: Place


def devices(pier: Pier, restraints: Sequence[Restraint]) -> tuple[PlacedDevice, ...]:
    """Return every device at each of its places."""
    return tuple(PlacedDevice(own.what, own.words, place) for own in restraints for place in places(pier, own))


class _Shape(NamedTuple):
    """Dimensions [m] of a pier that is drawn: heights of its centre of mass, highest point, and deck (0 for none).

    ``drift`` and ``sections`` are the heights at which drift and forces are read; without ``labels`` only devices are shown.
    ``springs`` is the number of those on which it stands, 0 on rigid ground.
    """

    caption: str
    alpha: float
    half_width: float
    height: float
    top: float
    deck: float
    drift: float
    sections: Sequence[float]
    devices: Sequence[PlacedDevice]
    labels: bool
    springs: int

    @classmethod
    def of(cls, pier: Mapping[str, Any]) -> "_Shape":
        """Return the shape of a pier of run.json; it is as high as a uniform block if it does not say how high."""
        deck = float(pier.get("deck_m") or 0.0)
        top = max(float(pier.get("highest_m") or 2.0 * pier["height_m"]), deck)
        lengths = pier["alpha"], pier["half_width_m"], pier["height_m"]
        read = float(pier.get("top_m") or top), sorted(set(pier.get("sections_m", ())))
        more = pier.get("devices", ()), pier.get("labels", True), pier["springs"]
        return cls(pier.get("caption", ""), *lengths, top, deck, *read, *more)

    @property
    def possible(self) -> bool:
        """Return True if a pier can have these dimensions."""
        return (
            0.0 < self.alpha < 0.5 * math.pi
            and 0.0 < self.height < 1e6
            and 0.0 < 2.0 * self.half_width < 100.0 * self.height
            and 0.0 < self.top < 1e6
            and 0.0 < self.drift < 10.0 * self.top
            and all(0.0 <= height <= 1.01 * self.top for height in self.sections)
        )


def springs_below(bases: Collection[str]) -> int:
    """Return the number of springs on which a pier is drawn for its kinds of bases: 0 if all are "rigid", else two.

    Of footings alone they are the strips of a bed.
    """
    if all(base == "rigid" for base in bases):
        return 0
    return STRIPS if all(base == "footing" for base in bases) else 2


def sketches(piers: Sequence[Mapping[str, Any]]) -> list[Figure]:
    """Return sketches of the first four possible piers, at one scale; ``piers`` as in run.json, with their ``springs``.

    A pier with impossible values is left out, since run.json may come from anybody; [] if none is left. One whose ``labels``
    are False shows its devices alone, beside a labelled one of its shape.
    """
    shapes = [shape for shape in map(_Shape.of, piers) if shape.possible][:MOST_PIERS]
    if not shapes:
        return []
    scale = HEIGHT / max(max(shape.top, shape.drift) for shape in shapes)
    return [_sketch(shape, scale) for shape in shapes]


def _sketch(pier: _Shape, scale: float) -> Figure:
    """Return the sketch of a pier on its springs, in pixels from the middle of its base; ``scale`` is in px/m."""
    b, h, top = (scale * length for length in (pier.half_width, pier.height, pier.top))
    side, high = max(b, 30.0), max(top, h, scale * pier.drift * pier.labels) + ABOVE
    marks: list[Mark] = [
        Area(np.array([-b, -b, b, b]), np.array([0.0, top, top, 0.0]), look=Look("band")),
        _stroke("rigid", (-b, 0.0), (-b, top), (b, top), (b, 0.0), (-b, 0.0)),
        Points(np.zeros(1), np.array([h]), look=Look("peak", shape="dot")),
        *(mark for x in np.linspace(-b, b, max(pier.springs, 2)).tolist() for mark in _support(x, pier.springs > 0)),
        *_deck(pier, b, scale),
        *(mark for device in pier.devices for mark in _device(device, scale, top)),
    ]
    if pier.labels:
        marks += [*_dimensions(pier, b, h), *_heights(pier, b, scale)]
    support = {0: "rigid ground", 2: "two springs"}.get(pier.springs, "a bed of strips")
    words = (
        f"The pier to scale on {support}: {2.0 * pier.half_width:.3g} m between its pivots, centre of mass "
        f"{pier.height:.3g} m above them, slenderness {pier.alpha:.3g} rad, drift read at {pier.drift:.3g} m"
    )
    if pier.sections:
        words += f", sections at {', '.join(f'{height:.3g}' for height in pier.sections)} m"
    if kinds := dict.fromkeys(device.words for device in pier.devices):
        words += f", with {' and '.join(kinds)}"
    ends = [mark.x + mark.side * (7.0 + LETTER * len(mark.text)) for mark in marks if isinstance(mark, Words)]
    least = max(side + SIDE, 0.5 * CAPTION * bool(pier.caption))
    x = Axis("", min([-least, *ends]), max([least, *ends]), names={})
    y = Axis("", -BELOW, high, names={})
    panel = Panel(x, y, marks, pier.caption, width=x.high - x.low, height=y.high - y.low, framed=False)
    return Figure([panel], words)


def _dimensions(pier: _Shape, b: float, h: float) -> Iterator[Mark]:
    """Yield the width between the pivots, the height of the centre of mass, and α between it and the edge, with their names."""
    arc = 0.45 * math.hypot(b, h)
    turn = np.linspace(0.0, pier.alpha, 9)
    yield Polyline(np.array([b, 0.0]), np.array([0.0, h]), look=Look("rigid", dash=1))
    yield _stroke("edge", (b, 0.0), (b, 1.15 * arc))
    yield Polyline(b - arc * np.sin(turn), arc * np.cos(turn), look=Look("edge"))
    yield Words(b, arc, "α")
    yield from _length((b + 26.0, 0.0), (b + 26.0, h), f"h = {pier.height:.3g} m")
    yield from _length((-b, -32.0), (b, -32.0), f"2b = {2.0 * pier.half_width:.3g} m")


def _heights(pier: _Shape, b: float, scale: float) -> Iterator[Mark]:
    """Yield the heights at which drift and forces are read, left of the pier, with labels that do not overlap."""
    all_named = len(pier.sections) <= MOST_SECTIONS
    named = {height: "section" for height in (pier.sections if all_named else pier.sections[:: len(pier.sections) - 1])}
    named[pier.drift] = "drift and section" if pier.drift in pier.sections else "drift"
    lowest = -math.inf
    for height in sorted({*named, *pier.sections}):
        y = scale * height
        yield _stroke("edge", (-b - 8.0, y), (b, y) if height in pier.sections else (-b, y))
        if height in named:
            lowest = max(y, lowest + APART)
            yield _stroke("edge", (-b - 8.0, y), (-b - 14.0, lowest))
            yield Words(-b - 10.0, lowest, f"{named[height]} {height:.3g} m", -1)


def _stroke(kind: str, *points: tuple[float, float], title: str = "", colour: int = 0) -> Polyline:
    x, y = np.array(points).T
    return Polyline(x, y, look=Look(kind, colour), title=title)


def _deck(pier: _Shape, b: float, scale: float) -> Iterator[Mark]:
    """Yield the deck at its height, if the pier has one: a slab not to scale, whose size is not known."""
    if pier.deck:
        y, half = scale * pier.deck, max(b, 24.0) + 6.0
        yield _box(0.0, y, half, 3.0, Look("deck"))
        if pier.labels:
            yield Words(half, y, f"deck, {pier.deck:.3g} m")


def _box(x: float, y: float, half_width: float, half_height: float, look: Look) -> Area:
    across, up = np.array([-1.0, 1.0, 1.0, -1.0]), np.array([-1.0, -1.0, 1.0, 1.0])
    return Area(x + half_width * across, y + half_height * up, look=look)


def _device(device: PlacedDevice, scale: float, top: float) -> Iterator[Mark]:
    """Yield the marks of a device: a tendon up to the top, a stop above the base, a damper below it outside the support.

    At the deck it is a link to a wall on its side.
    """
    what, words, place = device
    offset = scale * place.offset
    x = offset + math.copysign(ASIDE, offset)
    if place.height:
        y, side = scale * place.height, place.way or 1.0
        near, far = side * 30.0, side * (30.0 + SPRING)
        yield _stroke("tendon", (near, y), (far, y), title=words, colour=3)
        yield _stroke("rigid", (far, y - ASIDE), (far, y + ASIDE))
    elif what == "tendon":
        yield _stroke("tendon", (offset, -SPRING), (offset, top), title=words, colour=2)
    elif what == "stop":
        yield _stroke("rigid", (x, -SPRING), (x, ASIDE), (offset, ASIDE), title=words)
    else:
        yield _stroke("tendon", (offset, 0.0), (x, 0.0), (x, -SPRING), title=words, colour=3)
        yield _box(x, -9.5, 3.0, 4.5, Look("damper", 3))


def _support(x: float, spring: bool) -> Iterator[Mark]:
    """Yield the support of a pivot: a spring on the ground, or the ground."""
    below = -SPRING if spring else 0.0
    yield _stroke("rigid", (x - 9.0, below), (x + 9.0, below))
    for offset in (-5.0, 0.0, 5.0, 9.0):
        yield _stroke("edge", (x + offset, below), (x + offset - 4.0, below - 5.0))
    if spring:
        turns = [(x + way, -(i + 1) * SPRING / 6) for i, way in enumerate((4, -4, 4, -4, 4))]
        yield _stroke("rigid", (x, 0.0), *turns, (x, below))


def _length(start: tuple[float, float], end: tuple[float, float], words: str) -> Iterator[Mark]:
    """Yield a dimension line, with its text below or beside it."""
    across, up = (0.0, 3.0) if start[1] == end[1] else (3.0, 0.0)
    yield _stroke("edge", start, end)
    for x, y in (start, end):
        yield _stroke("edge", (x - across, y - up), (x + across, y + up))
    middle = 0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])
    yield Words(middle[0], middle[1] - 10.0, words, 0) if across == 0.0 else Words(*middle, words)
