"""Whether a record can be believed to be one: its peak, and that it swings about zero."""

from collections.abc import Sequence
from fnmatch import fnmatchcase

import numpy as np

from rockbatch.motions.motion import Motion, Samples

LOWEST, HIGHEST = 0.001, 5.0
"""PGA [g] beyond which a wrong unit is likelier than the record; the largest recorded ones reach 2 to 4 g."""

FARTHEST_MEAN = 0.15
"""Mean over the peak, PGA, beyond which a series is hardly a record's: the ground would end with this share of PGA times
duration. Real records as they are used have 0.0003 at most; one cut at 1 m/s after 3 s of 3 m/s² would have 0.11."""

_ENOUGH = 8  # samples: fewer tell nothing about their mean

ANY = ("*",)
"""Confirms every record."""


def doubt(motion: Motion, gravity: float) -> str:
    """Why a record has to be confirmed, and how; empty where it is a likely one."""
    why = unlikely_peak(motion, gravity) or never_changes_sign(motion) or mean_far_from_zero(motion)
    if not why:
        return ""
    return (
        f'{why}; if it is right, write confirm_pga = ["{motion.name}"] under [motions] in the study, or '
        "confirm_pga = true in motions.toml"
    )


def unlikely_peak(motion: Motion, gravity: float) -> str:
    """What is said of a PGA that a wrong unit explains; empty where it is a likely one."""
    horizontal, vertical = motion.pga / gravity, (motion.pga_vertical or 0.0) / gravity
    if LOWEST <= horizontal <= HIGHEST >= vertical:
        return ""
    peak = f"PGA {horizontal:.3g} g"
    if vertical > HIGHEST:
        peak += f", vertical {vertical:.3g} g,"
    return f"{peak} outside {LOWEST:g}–{HIGHEST:g} g: check the unit"


def never_changes_sign(motion: Motion) -> str:
    """What is said of a series that is all above zero, or below, as spectra are; empty where it is not."""
    for what, samples in _series(motion):
        if samples.min() >= 0 or samples.max() <= 0:
            return f"{what}never changes sign, as spectra do and records do not"
    return ""


def mean_far_from_zero(motion: Motion) -> str:
    """What is said of a series whose mean is beyond ``FARTHEST_MEAN`` of its peak; empty where it is not."""
    for what, samples in _series(motion):
        share = abs(float(samples.mean())) / float(np.abs(samples).max())
        if share > FARTHEST_MEAN:
            return (
                f"{what}has a mean of {share:.0%} of its peak, where a record's is near 0: if an offset is in it, write "
                'offset = "mean" under [motions]'
            )
    return ""


def _series(motion: Motion) -> list[tuple[str, Samples]]:
    """The components that have any motion, and samples enough, with what they are called in messages."""
    both = [("", motion.horizontal), ("its vertical component ", motion.vertical)]
    return [(what, a) for what, a in both if a is not None and len(a) >= _ENOUGH and np.any(a)]


def fits(name: str, patterns: Sequence[str]) -> bool:
    """Whether a record's name is one of ``patterns``, or matches one with ``*`` and ``?``."""
    return any(name == pattern or fnmatchcase(name, pattern) for pattern in patterns)
