"""Which records of a suite are used: by PGA, PGV, length, significant duration and magnitude."""

from dataclasses import dataclass, fields, replace

from rockbatch.motions import measures
from rockbatch.motions.motion import LeftOut, Motion, Unusable
from rockbatch.motions.motion_set import MotionSet

Range = tuple[float, float]


@dataclass(frozen=True)
class Selection:
    """Least and largest value of each measure, both of them included; ``None`` where it does not matter.

    PGA [g] and PGV [m/s] are those of the horizontal component before it is brought to a target; ``duration_s`` is the
    record's length from the first to the last sample, ``d5_95_s`` its significant duration, in which Arias intensity
    grows from 5 to 95 %; the magnitude is the one that a manifest has.
    """

    pga_g: Range | None = None
    pgv_m_s: Range | None = None
    duration_s: Range | None = None
    d5_95_s: Range | None = None
    magnitude: Range | None = None


def selected(found: MotionSet, selection: Selection, gravity: float) -> MotionSet:
    """The motions within ``selection``; others are left out, and those of unknown magnitude unusable, if it counts."""
    kept: list[Motion] = []
    unusable: list[Unusable] = []
    left_out: list[LeftOut] = []
    for motion in found.motions:
        if selection.magnitude is not None and motion.magnitude is None:
            reason = "selected by magnitude, which is not known; write magnitude in motions.toml"
            unusable.append(Unusable(motion.name, motion.files, reason))
        elif outside := _outside(motion, selection, gravity):
            left_out.append(LeftOut(motion.name, motion.files, f"not selected: {', '.join(outside)}"))
        else:
            kept.append(motion)
    return replace(found, motions=kept, unusable=[*found.unusable, *unusable], left_out=[*found.left_out, *left_out])


def _outside(motion: Motion, selection: Selection, gravity: float) -> list[str]:
    """Measures that lie outside their range, in words."""
    values = {
        "pga_g": motion.pga / gravity,
        "pgv_m_s": measures.pgv(motion.horizontal, motion.dt, motion.initial) if selection.pgv_m_s else None,
        "duration_s": motion.duration,
        "d5_95_s": measures.significant_duration(motion.horizontal, motion.dt) if selection.d5_95_s else None,
        "magnitude": motion.magnitude,
    }
    outside = []
    for key in fields(selection):
        limits, value = getattr(selection, key.name), values[key.name]
        if limits is not None and value is not None and not limits[0] <= value <= limits[1]:
            outside.append(f"{key.name} = {value:.4g} is not within {limits[0]:g}..{limits[1]:g}")
    return outside
