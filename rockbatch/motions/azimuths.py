"""Pairs of horizontal components turned to other directions.

With a₁ and a₂ the accelerations along two azimuths that are square to each other, the one along azimuth φ is
a₁ cos(φ − φ₁) + a₂ cos(φ − φ₂), whichever of the two lies to the right of the other.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from rockbatch.motions.common_span import Common, on_common_samples, overlap, too_unlike
from rockbatch.motions.component import Component
from rockbatch.motions.measures import state_at
from rockbatch.motions.motion import Initial, Samples, Unusable
from rockbatch.motions.orientation import Orientation, not_square, same_azimuth, split_stem


def resolved(first: Samples, azimuth1: float, second: Samples, azimuth2: float, azimuth: float) -> Samples:
    """Return the acceleration along ``azimuth`` [degrees] of two components square to each other, shape (npts,)."""
    return first * math.cos(math.radians(azimuth - azimuth1)) + second * math.cos(math.radians(azimuth - azimuth2))


def azimuths_every(step: float) -> tuple[float, ...]:
    """Return azimuths 0, step, 2 step … below 180°: half a turn reverses a component, which is what a polarity is for."""
    return tuple(i * step for i in range(math.ceil(180.0 / step - 1e-9)))


def rotated_to(horizontals: Sequence[Component], azimuths: Sequence[float]) -> tuple[list[Component], list[Unusable]]:
    """Return components along ``azimuths`` [degrees] in place of the horizontals of a station, and what cannot be turned.

    Two that are square to each other are turned; a single one goes on as it is if it points along the only azimuth asked for.
    """
    obstacle = _obstacle(horizontals)
    if not obstacle:
        return [_turned(horizontals[0], horizontals[1], azimuth) for azimuth in azimuths], []
    unchanged = [len(azimuths) == 1 and same_azimuth(c.orientation.azimuth, azimuths[0]) for c in horizontals]
    refused = [
        Unusable(c.name, c.source, f"cannot be turned: {obstacle}")
        for c, stays in zip(horizontals, unchanged, strict=True)
        if not stays
    ]
    return [c for c, stays in zip(horizontals, unchanged, strict=True) if stays], refused


def _obstacle(horizontals: Sequence[Component]) -> str:
    """Return why these components of one station are no pair that can be turned; empty where they are."""
    for component in horizontals:
        if component.orientation.azimuth is None:
            return f"the azimuth of {component.name} is not known; write it in motions.toml"
    if len(horizontals) != 2:
        count = "only one" if len(horizontals) == 1 else str(len(horizontals))
        return f"its station has {count} horizontal component{'s' * (len(horizontals) > 1)}, and two are needed"
    first, second = horizontals
    if askew := not_square(first.orientation.azimuth, second.orientation.azimuth, f"{first.name} and {second.name}"):
        return askew
    if not overlap(first, second):
        return f"{first.name} and {second.name} have no time in common"
    difference = too_unlike(first, second)
    return f"{second.name}: {difference}" if difference else ""


def _azimuth(component: Component) -> float:
    assert component.orientation.azimuth is not None
    return component.orientation.azimuth


def _initial(first: Component, second: Component, common: Common, azimuth: float) -> Initial | None:
    """State along ``azimuth`` at the first common sample; ``None`` where one of the two is not known."""
    if first.initial is None or second.initial is None:
        return None
    velocity = displacement = 0.0
    for part, begin in zip((first, second), common.begins, strict=True):
        assert part.initial is not None
        state = state_at(part.acceleration, part.dt, part.initial, begin)
        share = math.cos(math.radians(azimuth - _azimuth(part)))
        velocity, displacement = velocity + state.velocity * share, displacement + state.displacement * share
    return Initial(velocity, displacement)


def _turned(first: Component, second: Component, azimuth: float) -> Component:
    common = on_common_samples(first, second, (first.name, second.name))
    base = split_stem(first.name)[0]
    if base != split_stem(second.name)[0]:
        base = first.name
    notes = [f"{part.name}: {note}" for part in (first, second) for note in part.notes]
    starts = [part.start for part in (first, second) if part.start is not None]
    return replace(
        first,
        name=f"{base}_az{azimuth:03g}",
        dt=common.dt,
        acceleration=resolved(common.first, _azimuth(first), common.second, _azimuth(second), azimuth),
        orientation=Orientation(f"{azimuth:g}", azimuth=azimuth % 360.0),
        source=f"{first.source} + {second.source}",
        start=max(starts) if len(starts) == 2 else None,
        confirmed=tuple(key for key in first.confirmed if key in second.confirmed),
        processed=first.processed if first.processed == second.processed else None,
        initial=_initial(first, second, common, azimuth),
        findings=(*first.findings, *second.findings),
        notes=(*notes, *common.notes, f"turned to {azimuth:g}° from {first.name} and {second.name}"),
    )
