"""Pairs of horizontal components turned to other directions.

With a₁ and a₂ the accelerations along two azimuths that are square to each other, the one along azimuth φ is
a₁ cos(φ − φ₁) + a₂ cos(φ − φ₂), whichever of the two lies to the right of the other.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from rockbatch.motions.component import Component
from rockbatch.motions.identity.common_span import Common, on_common_samples, overlap, too_unlike
from rockbatch.motions.intensity.measures import state_at
from rockbatch.motions.labels.orientation import Orientation, not_square, same_azimuth, split_stem
from rockbatch.motions.motion import Initial, Samples
from rockbatch.motions.unused import Unusable


def along_azimuth(first: Samples, azimuth1: float, second: Samples, azimuth2: float, azimuth: float) -> Samples:
    """Return the acceleration along ``azimuth`` [degrees] of two components square to each other, shape (npts,)."""
    return first * math.cos(math.radians(azimuth - azimuth1)) + second * math.cos(math.radians(azimuth - azimuth2))


def azimuths_every(step: float) -> tuple[float, ...]:
    """Return azimuths 0, step, 2 step … [degrees] below 180°, since half a turn only reverses a component (see polarity)."""
    return tuple(i * step for i in range(math.ceil(180.0 / step - 1e-9)))


def components_along(
    horizontals: Sequence[Component], azimuths: Sequence[float]
) -> tuple[list[Component], list[Unusable]]:
    """Return a station's motion along ``azimuths`` [degrees], and as unusable the components that cannot be turned.

    Exactly two components square to each other with a time in common are turned. Otherwise a component stays only if
    ``azimuths`` is its own azimuth alone.
    """
    obstacle = _rotation_obstacle(horizontals)
    if not obstacle:
        return [_turned_component(horizontals[0], horizontals[1], azimuth) for azimuth in azimuths], []
    kept: list[Component] = []
    refused: list[Unusable] = []
    for c in horizontals:
        if len(azimuths) == 1 and same_azimuth(c.orientation.azimuth, azimuths[0]):
            kept.append(c)
        else:
            refused.append(Unusable(c.name, c.sources, f"cannot be turned: {obstacle}"))
    return kept, refused


def _rotation_obstacle(horizontals: Sequence[Component]) -> str:
    """Return why a station's horizontals cannot be turned; "" for two with known azimuths at a right angle and common samples."""
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


def _initial_along(first: Component, second: Component, common: Common, azimuth: float) -> Initial | None:
    """Return velocity [m/s] and displacement [m] along ``azimuth`` at the first common sample; ``None`` if either is unknown."""
    if first.initial is None or second.initial is None:
        return None
    velocity = displacement = 0.0
    for part, begin in zip((first, second), common.begins, strict=True):
        assert part.initial is not None
        state = state_at(part.acceleration, part.dt, part.initial, begin)
        share = math.cos(math.radians(azimuth - _azimuth(part)))
        velocity, displacement = velocity + state.velocity * share, displacement + state.displacement * share
    return Initial(velocity, displacement)


def _turned_component(first: Component, second: Component, azimuth: float) -> Component:
    """Return the component along ``azimuth`` [degrees] over the common time of two that are square to each other."""
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
        acceleration=along_azimuth(common.first, _azimuth(first), common.second, _azimuth(second), azimuth),
        orientation=Orientation(f"{azimuth:g}", azimuth=azimuth % 360.0),
        turned=True,
        sources=(*first.sources, *second.sources),
        start=max(starts) if len(starts) == 2 else None,
        confirmed=tuple(key for key in first.confirmed if key in second.confirmed),
        processed=first.processed if first.processed == second.processed else None,
        initial=_initial_along(first, second, common, azimuth),
        findings=(*first.findings, *second.findings),
        notes=(*notes, *common.notes, f"turned to {azimuth:g}° from {first.name} and {second.name}"),
    )
