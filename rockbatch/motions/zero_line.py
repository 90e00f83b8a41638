"""Whether a series swings about zero as accelerations do: spectra, envelopes and uncorrected offsets do not."""

import numpy as np

from rockbatch.motions.motion import Motion, Samples

FARTHEST_MEAN = 0.15
"""Mean over the peak, PGA, beyond which a series is hardly a record's: the ground would end with this share of PGA times
duration. Real records as they are used have 0.0003 at most; one cut at 1 m/s after 3 s of 3 m/s² would have 0.11."""

_ENOUGH = 8  # samples: fewer tell nothing about their mean


def never_changes_sign(motion: Motion) -> str:
    """Return the remark on a series that is all above zero, or below, as spectra are; empty if it is not."""
    for what, samples in _series(motion):
        if samples.min() >= 0 or samples.max() <= 0:
            return f"{what}never changes sign, as spectra do and records do not"
    return ""


def mean_far_from_zero(motion: Motion) -> str:
    """Return the remark on a series whose mean is beyond ``FARTHEST_MEAN`` of its peak; empty if it is not."""
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
