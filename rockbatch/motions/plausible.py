"""Whether a record can be believed: its peak, or a wrong unit is likelier, and that it swings about zero."""

from collections.abc import Sequence
from fnmatch import fnmatchcase

from rockbatch.motions.motion import Motion
from rockbatch.motions.zero_line import mean_far_from_zero, never_changes_sign

LOWEST, HIGHEST = 0.001, 5.0
"""PGA [g] beyond which a wrong unit is likelier than the record; the largest recorded ones reach 2 to 4 g."""

ANY = ("*",)
"""Confirms every record."""


def doubt(motion: Motion, gravity: float) -> str:
    """Why a record has to be confirmed, and how; empty where it is a likely one."""
    why = _unlikely_peak(motion, gravity) or never_changes_sign(motion) or mean_far_from_zero(motion)
    if not why:
        return ""
    return (
        f'{why}; if it is right, write confirm_pga = ["{motion.name}"] under [motions] in the study, or '
        "confirm_pga = true in motions.toml"
    )


def _unlikely_peak(motion: Motion, gravity: float) -> str:
    """What is said of a PGA that a wrong unit explains; empty where it is a likely one."""
    horizontal, vertical = motion.pga / gravity, (motion.pga_vertical or 0.0) / gravity
    if LOWEST <= horizontal <= HIGHEST >= vertical:
        return ""
    peak = f"PGA {horizontal:.3g} g"
    if vertical > HIGHEST:
        peak += f", vertical {vertical:.3g} g,"
    return f"{peak} outside {LOWEST:g}–{HIGHEST:g} g: check the unit"


def fits(name: str, patterns: Sequence[str]) -> bool:
    """Whether a record's name is one of ``patterns``, or matches one with ``*`` and ``?``."""
    return any(name == pattern or fnmatchcase(name, pattern) for pattern in patterns)
