"""The tables of a study file, of a file of checks and of a manifest: the keys that are read, and what each of them means.

The keys are the reader's own; only their words are here. The reference in the documentation and the JSON schemas for
editors (:mod:`rockbatch.study.schema`) are made of both.
"""

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields
from typing import Any

from rockbatch.checks.reading import CHECK, SUITE
from rockbatch.checks.reading import TOP as CHECKS_TOP
from rockbatch.checks.rules import Rule
from rockbatch.motions.manifest import RECORD
from rockbatch.motions.scaling import Target
from rockbatch.motions.spectrum_target import SpectrumTarget
from rockbatch.pier import ElasticBase, Pier, YieldingBase
from rockbatch.study import words
from rockbatch.study.cases import BASE_KEYS, BASES, CASE
from rockbatch.study.fragility import FRAGILITY, FragilitySpec
from rockbatch.study.load import NUMERICS, OUTPUT, REFERENCE, SELECTING, TOP
from rockbatch.study.motions import FEMA, MOTIONS, PULSE
from rockbatch.study.piers import PART, PIER
from rockbatch.study.plausible import CONFIRM
from rockbatch.study.restraint_keys import DAMPER, RESTRAINTS, TENDON
from rockbatch.study.sensitivity import (
    CHOICE,
    LOG_UNIFORM,
    LOG_UNIFORM_OF,
    SENSITIVITY,
    UNIFORM,
    UNIFORM_OF,
    SensitivitySpec,
)
from rockbatch.study.spec import MotionSpec, Numerics, Output, Study
from rockbatch.study.spectrum import MAP, SPECTRUM, MapSpec
from rockbatch.study.suite_keys import _SELECT as SELECT
from rockbatch.study.target import TARGET
from rockbatch.toml.reader import Key


@dataclass(frozen=True)
class Section:
    """A table of a TOML file.

    Attributes
    ----------
    at : tuple of str
        Its name, such as ("motions", "pulse"); empty for the keys at the top of the file.
    about : str
        What it is for.
    keys : mapping of Key
        As the reader takes them.
    words : mapping of str
        What each key means.
    many : bool
        Whether there may be several, under double brackets.
    required : bool
    defaults : tuple of type
        Dataclasses whose fields have the values of keys that are not written.
    only_for : mapping
        The values of the key ``base`` for which a key is read, where that is not all of them.
    inner : mapping
        Tables within it of which there may be one or several, with the values of ``base`` for which they are read.
    free : str
        Pattern of further keys, numbers that :attr:`keys` cannot list because a study makes their names.
    numbered : bool
        Whether the same table may go with a number, too: damper_2.
    """

    at: tuple[str, ...]
    about: str
    keys: Mapping[str, Key]
    words: Mapping[str, str]
    many: bool = False
    required: bool = False
    defaults: tuple[type, ...] = ()
    only_for: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    inner: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    free: str = ""
    numbered: bool = False

    @property
    def header(self) -> str:
        """As the file has it: "[pier]", "[[motions.pulse]]"; empty for the top."""
        name = ".".join(self.at)
        return (f"[[{name}]]" if self.many else f"[{name}]") if name else ""

    def default(self, name: str) -> Any:
        """The value of a key that is not written; None where there is none, or it follows from others."""
        for spec in self.defaults:
            for each in fields(spec):
                if each.name == name and each.default not in (MISSING, None, (), ""):
                    return each.default
        return None


def _bases(name: str) -> tuple[str, ...]:
    return tuple(base for base, keys in BASES.items() if name in keys)


STUDY = (
    Section((), "", TOP, words.TOP),
    Section(("pier",), words.PIER_ABOUT, PIER | CONFIRM, words.PIER, required=True, defaults=(Pier,)),
    Section(("pier", "part"), words.PART_ABOUT, PART | CONFIRM, words.PART, many=True),
    Section(("motions",), words.MOTIONS_ABOUT, MOTIONS, words.MOTIONS, defaults=(MotionSpec,)),
    Section(("motions", "select"), words.SELECT_ABOUT, SELECT, words.SELECT),
    Section(
        ("motions", "target"), words.TARGET_ABOUT, TARGET | CONFIRM, words.TARGET, defaults=(Target, SpectrumTarget)
    ),
    Section(("motions", "pulse"), words.PULSE_ABOUT, PULSE | CONFIRM, words.PULSE, many=True),
    Section(("motions", "fema_p695"), words.FEMA_ABOUT, FEMA, words.FEMA, many=True),
    Section(
        ("case",),
        words.CASE_ABOUT,
        CASE | BASE_KEYS | CONFIRM,
        words.CASE,
        many=True,
        required=True,
        defaults=(YieldingBase, ElasticBase),
        only_for={name: _bases(name) for name in BASE_KEYS if len(_bases(name)) < len(BASES)},
        inner=dict.fromkeys(RESTRAINTS, tuple(BASES)),
    ),
    Section(("case", "damper"), words.DAMPER_ABOUT, DAMPER | CONFIRM, words.DAMPER, many=True),
    Section(("case", "tendon"), words.TENDON_ABOUT, TENDON | CONFIRM, words.TENDON, many=True),
    Section(("numerics",), words.NUMERICS_ABOUT, NUMERICS | CONFIRM, words.NUMERICS, defaults=(Numerics,)),
    Section(("output",), words.OUTPUT_ABOUT, OUTPUT, words.OUTPUT, defaults=(Output,)),
    Section(("suite",), words.SUITE_ABOUT, SUITE, words.SUITE, defaults=(Study,)),
    Section(("check",), words.CHECK_ABOUT, CHECK, words.CHECK, many=True, defaults=(Rule,)),
    Section(
        ("reference",),
        words.REFERENCE_ABOUT,
        REFERENCE | SELECTING,
        words.REFERENCE | dict.fromkeys(SELECTING, words.SELECTING),
        many=True,
        free=rf"^(part|damper|tendon)_[1-9][0-9]*_({'|'.join({**PART, **DAMPER, **TENDON})})$",
    ),
    Section(("fragility",), words.FRAGILITY_ABOUT, FRAGILITY, words.FRAGILITY, defaults=(FragilitySpec,)),
    Section(("spectrum",), words.SPECTRUM_ABOUT, SPECTRUM, words.SPECTRUM),
    Section(("spectrum", "map"), words.MAP_ABOUT, MAP, words.MAP, many=True, defaults=(MapSpec,)),
    Section(("sensitivity",), words.SENSITIVITY_ABOUT, SENSITIVITY, words.SENSITIVITY, defaults=(SensitivitySpec,)),
    Section(("sensitivity", "uniform"), words.UNIFORM_ABOUT, UNIFORM, words.RANGES),
    Section(("sensitivity", "log_uniform"), words.LOG_UNIFORM_ABOUT, LOG_UNIFORM, words.RANGES),
    *(
        Section(("sensitivity", spread, what), words.RANGES_WITHIN[what], keys, words.RANGES_OF[what], numbered=True)
        for spread, within in (("uniform", UNIFORM_OF), ("log_uniform", LOG_UNIFORM_OF))
        for what, keys in within.items()
    ),
    Section(("sensitivity", "choice"), words.CHOICE_ABOUT, CHOICE, words.CHOICE),
)
"""A study file."""

CHECKS = (
    Section((), "", CHECKS_TOP, words.TOP),
    Section(("suite",), words.SUITE_ABOUT, SUITE, words.SUITE, defaults=(Study,)),
    Section(("check",), words.CHECK_ABOUT, CHECK, words.CHECK, many=True, required=True, defaults=(Rule,)),
)
"""A file of checks, as ``rockbatch check --rules`` takes it."""

MANIFEST = (
    Section((), "", {}, {}),
    Section(("record",), words.RECORD_ABOUT, RECORD, words.RECORD, many=True),
)
"""``motions.toml``, beside the records."""

FILES = {"study": STUDY, "checks": CHECKS, "manifest": MANIFEST}
