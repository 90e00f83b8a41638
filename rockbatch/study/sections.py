"""All tables of a study file, of a file of checks and of a manifest, for the reference and the JSON schemas."""

from dataclasses import replace

from rockbatch.checks.reading import SUITE
from rockbatch.checks.reading import TOP as CHECKS_TOP
from rockbatch.checks.rules import CHECK
from rockbatch.motions.manifest import RECORD
from rockbatch.study import load, sensitivity
from rockbatch.study.fragility import FRAGILITY
from rockbatch.study.spectrum import MAP, SPECTRUM
from rockbatch.toml.section import Section

STUDY = (*load.SECTIONS, FRAGILITY, SPECTRUM, MAP, *sensitivity.SECTIONS)
"""A study file."""

CHECKS = (CHECKS_TOP, SUITE, replace(CHECK, required=True))
"""A file of checks, as ``rockbatch check --rules`` takes it."""

MANIFEST = (Section((), "", {}), RECORD)
"""``motions.toml``, beside the records."""

FILES = {"study": STUDY, "checks": CHECKS, "manifest": MANIFEST}
