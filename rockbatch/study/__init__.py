"""The study file, checked as a whole before anything runs."""

from rockbatch.study.load import Study, given_study, load_study
from rockbatch.study.motions import Motions
from rockbatch.study.output import Output
from rockbatch.study.piers import PIER_KEYS
from rockbatch.study.spec import Case, FemaSpec, MotionSpec, Numerics, PulseSpec, Reference

__all__ = [
    "PIER_KEYS",
    "Case",
    "FemaSpec",
    "MotionSpec",
    "Motions",
    "Numerics",
    "Output",
    "PulseSpec",
    "Reference",
    "Study",
    "given_study",
    "load_study",
]
