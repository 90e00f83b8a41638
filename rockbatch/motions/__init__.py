"""Ground motions: from files, packages and formulas to accelerations in m/s²."""

from rockbatch.motions.folder import read_motions
from rockbatch.motions.formats import ReadOptions
from rockbatch.motions.motion import LeftOut, Motion, Unusable
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.pairs import pair_spectrum
from rockbatch.motions.pulses import pulse
from rockbatch.motions.sequences import sequence

__all__ = [
    "LeftOut",
    "Motion",
    "MotionSet",
    "ReadOptions",
    "Unusable",
    "pair_spectrum",
    "pulse",
    "read_motions",
    "sequence",
]
