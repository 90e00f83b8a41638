"""Selection of the records of a suite by PGA, PGV, length, significant duration and magnitude."""

from collections.abc import Callable
from dataclasses import dataclass

from rockbatch.common.units import GRAVITY
from rockbatch.motions.intensity import measures
from rockbatch.motions.motion import Motion
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.unused import LeftOut, Unusable

Range = tuple[float, float]


@dataclass(frozen=True)
class Selection:
    """Least and largest value of each measure, both included; ``None`` for no limit.

    PGA [g] and PGV [m/s] are of the horizontal component before scaling to a target; ``duration_s`` is the record's length
    from the first to the last sample, ``d5_95_s`` its significant duration, in which Arias intensity grows from 5 to 95 %;
    the magnitude comes from a manifest.
    """

    pga_g: Range | None = None
    pgv_m_s: Range | None = None
    duration_s: Range | None = None
    d5_95_s: Range | None = None
    magnitude: Range | None = None


_MEASURES: dict[str, Callable[[Motion, float], float | None]] = {
    "pga_g": lambda m, gravity: m.pga / gravity,
    "pgv_m_s": lambda m, _: measures.pgv(m.horizontal, m.dt, m.initial),
    "duration_s": lambda m, _: m.duration,
    "d5_95_s": lambda m, _: measures.significant_duration(m.horizontal, m.dt),
    "magnitude": lambda m, _: m.magnitude,
}


def selected(motion_set: MotionSet, selection: Selection, gravity: float = GRAVITY) -> MotionSet:
    """Return the motions within ``selection``, others left out; unknown magnitudes are unusable if magnitudes are selected.

    Another measure that is unknown does not exclude a motion.
    """
    chosen: list[Motion] = []
    unusable: list[Unusable] = []
    left_out: list[LeftOut] = []
    ranges = {key: limits for key in _MEASURES if (limits := getattr(selection, key)) is not None}
    for motion in motion_set.motions:
        if "magnitude" in ranges and motion.magnitude is None:
            reason = "selected by magnitude, which is not known; write magnitude in motions.toml"
            unusable.append(Unusable(motion.name, motion.sources, reason))
            continue
        outside = [
            f"{key} = {value:.4g} is not within {low:g}..{high:g}"
            for key, (low, high) in ranges.items()
            if (value := _MEASURES[key](motion, gravity)) is not None and not low <= value <= high
        ]
        if outside:
            reason = f"not selected: {', '.join(outside)}"
            left_out.append(LeftOut(motion.name, motion.sources, reason, motion.of_station))
        else:
            chosen.append(motion)
    return motion_set.reduced_to(chosen, unusable, left_out)
