"""The study file: what is asked, checked as a whole before anything runs."""

from rockbatch.study.load import given_study, load_study
from rockbatch.study.piers import PIER_KEYS
from rockbatch.study.spec import Case, FemaSpec, MotionSpec, Numerics, Output, PulseSpec, Reference, Study

__all__ = [
    "PIER_KEYS",
    "Case",
    "FemaSpec",
    "MotionSpec",
    "Numerics",
    "Output",
    "PulseSpec",
    "Reference",
    "Study",
    "given_study",
    "load_study",
]
