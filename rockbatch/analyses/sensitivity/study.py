"""Inputs of a sensitivity study and their ranges: [sensitivity] of a study file."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

from rockbatch.common.showing import shown
from rockbatch.pier.laws import WITHOUT_POINTS
from rockbatch.study.case_keys import CASE
from rockbatch.study.inputs import OF_PIER, impossible, outside, ranges, values_of, why_no_case
from rockbatch.study.load import Study
from rockbatch.study.motions import MOTIONS
from rockbatch.study.restraint_inputs import IN_KILONEWTONS, TABLE, unclear
from rockbatch.study.restraint_keys import RESTRAINTS
from rockbatch.study.spec import Case
from rockbatch.toml.kinds import Choice, boolean, choice, count, positive, share
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import Key, Section, fix_the_same

OF_MOTION = ("vertical", "polarity")
"""Factors of the whole suite."""

Value = float | str | bool


@dataclass(frozen=True)
class Input:
    """Something that the answer may depend on."""

    name: str  # key of the study file; of a device "damper.f", "tendon_2.psi"
    spread: str  # "uniform", "log_uniform" or "choice"
    levels: tuple[Any, Any]  # ends of the range, or the two choices

    @property
    def at(self) -> tuple[str, ...]:
        """Return its place under [sensitivity]: ("uniform", "damper", "f")."""
        return self.spread, *self.name.split(".")


@dataclass(frozen=True)
class SensitivitySpec:
    """[sensitivity]: what is varied, and how it is sampled. :data:`SENSITIVITY` says what each key means."""

    inputs: tuple[Input, ...]
    statistic: str = "median"
    overturned: float = 1.0
    samples: int = 64
    confidence: float = 0.95
    seed: int = 1


SENSITIVITY = Section(
    ("sensitivity",),
    ("Which inputs matter, by `rockbatch sensitivity`: one input at a time, and Sobol indices of all together."),
    {
        "statistic": Key(choice("max", "mean", "median", "p84"), '"median"', "Statistic over the records."),
        "overturned": Key(
            positive, "1.0", "The θ_max/α as which a run counts that overturned; larger ones count so too."
        ),
        "samples": Key(
            Choice(tuple(2**k for k in range(2, 31)), "a power of two from 4"),
            "64",
            "Size N of the design: N (d + 2) points for d inputs, each under every record.",
        ),
        "confidence": Key(share, "0.95", "Level of the intervals of the indices."),
        "seed": Key(count, "1", "Seed of the design and of the intervals."),
    },
    homes=(SensitivitySpec,),
)


def _choice(keys: Mapping[str, Key], name: str, example: str) -> dict[str, Key]:
    return {name: Key(keys[name].kind, example, keys[name].words, many=True)}


SPREADS = {
    "uniform": Section(("sensitivity", "uniform"), "Uniform inputs: the smallest and the largest value.", ranges()),
    "log_uniform": Section(
        ("sensitivity", "log_uniform"), "Log-uniform inputs: the smallest and the largest value.", ranges(kind=positive)
    ),
    "choice": Section(
        ("sensitivity", "choice"),
        "Inputs with two equally likely values.",
        {
            **_choice(CASE, "kinematics", '["first-order", "finite"]'),
            "spring": Key(choice(*WITHOUT_POINTS), '["bouc-wen", "epp"]', CASE["spring"].words, many=True),
            "vertical": Key(boolean, "[true, false]", "With the records' vertical components, or without.", many=True),
            **_choice(MOTIONS, "polarity", '["+", "-"]'),
        },
    ),
}
WITHIN: dict[str, dict[str, dict[str, Key]]] = {
    "uniform": {what: ranges(what) for what in RESTRAINTS},
    "log_uniform": {what: ranges(what, positive) for what in RESTRAINTS},
    "choice": {},
}
"""Keys of tables within, such as [sensitivity.uniform.damper], or damper.f = … in [sensitivity.uniform]."""

_SHOWN = dict(zip(RESTRAINTS, ("f", "psi", "gap_mm", "gap_mm"), strict=True))
"""Key of each kind of device that is shown as an example."""


def _within(spread: str, what: str, keys: dict[str, Key]) -> Section:
    """Return the section of the inputs of one kind of device, such as [sensitivity.uniform.damper]."""
    key = _SHOWN[what]
    return Section(
        ("sensitivity", spread, what),
        f"Inputs of the {what} of a case, the least and the largest value; or write {what}.{key} = {keys[key].example} "
        f"above. Where several {what}s of a case have the key, {what}_1 is the first that the case has, {what}_2 the next.",
        keys,
        numbered=True,
    )


SECTIONS = (
    SENSITIVITY,
    *SPREADS.values(),
    *(_within(spread, what, keys) for spread, within in WITHIN.items() for what, keys in within.items()),
)


def applying(inputs: Iterable[Input], case: Case) -> tuple[Input, ...]:
    """Return the inputs that a case has; ``vertical`` and ``polarity`` are of every case."""
    names = {*values_of(case), *OF_MOTION}
    return tuple(parameter for parameter in inputs if parameter.name in names)


def own_values(study: Study, case: Case) -> dict[str, Any]:
    """Return the values of a case by input, with the study's ``vertical`` and the first ``polarity``."""
    return values_of(case) | {"vertical": study.motions.vertical, "polarity": study.motions.polarity[0]}


def read_sensitivity(study: Study) -> SensitivitySpec:
    """Return what the study file asks for in [sensitivity]; ``InputError`` with every mistake, or if there is no such table."""
    file = study.file()
    table = file.table("sensitivity", required="[sensitivity] and [sensitivity.uniform] with alpha = [0.12, 0.16]")
    inputs: list[Input] = []
    read = {} if table is None else table.read(SENSITIVITY, other=SPREADS)
    if table is not None:
        for spread, keys in SPREADS.items():
            inputs += _inputs(file, spread, keys)
        spreads: dict[str, list[str]] = {}
        for parameter in inputs:
            spreads.setdefault(parameter.name, []).append(parameter.spread)
        for name, ratio in IN_KILONEWTONS.items():
            if name in spreads and ratio in spreads:
                table.complain(fix_the_same(ratio, name), spreads[name][-1], name)
        for name, places in spreads.items():
            if len(places) > 1:
                table.complain(f"{name} is given under {' and '.join(places)}; keep one", places[1], *name.split("."))
        if not table.data.keys() & SPREADS.keys():
            table.complain("nothing is varied; write [sensitivity.uniform] and under it alpha = [0.12, 0.16]")
        if not file.problems:
            _check_inputs(table, inputs, study)
    file.finish()
    return SensitivitySpec(tuple(inputs), **read)


def _inputs(file: TomlFile, spread: str, keys: Mapping[str, Key]) -> list[Input]:
    """Return the inputs under [sensitivity.SPREAD], also of restraints in tables within; [] without that table."""
    table = file.table("sensitivity", spread)
    if table is None:
        return []
    unfit: dict[str, str] = {}
    for other, names in SPREADS.items():
        unfit |= dict.fromkeys(names.keys() - keys.keys(), f"belongs under [sensitivity.{other}]")
    tables = [name for name in table.data if TABLE.fullmatch(name)]
    if not WITHIN[spread]:
        unfit |= dict.fromkeys(tables, "belongs under [sensitivity.uniform]")
        return _read(table, spread, keys, unfit=unfit)
    inputs = _read(table, spread, keys, unfit=unfit, other=(*tables, *RESTRAINTS))
    for name in tables:
        if inner := file.table("sensitivity", spread, name):
            parameters = _read(inner, spread, WITHIN[spread][name.partition("_")[0]])
            inputs += [replace(parameter, name=f"{name}.{parameter.name}") for parameter in parameters]
    return inputs


def _read(
    table: Table,
    spread: str,
    keys: Mapping[str, Key],
    unfit: Mapping[str, str] | None = None,
    other: Sequence[str] = (),
) -> list[Input]:
    """Return the inputs in a table, a pair of values each; complain about others."""
    inputs = []
    for name, levels in table.read(keys, unfit=unfit, other=other).items():
        if len(levels) == 2:
            inputs.append(Input(name, spread, levels))
        else:
            table.complain(f"{name}: expected both choices; write {name} = {keys[name].example}", name)
    return inputs


def _check_inputs(table: Table, inputs: Sequence[Input], study: Study) -> None:
    """Complain about inputs that no case has, ranges without the study's value, and impossible corners of all ranges."""
    used: set[str] = set()
    places = {parameter.name: parameter.at for parameter in inputs}
    own: dict[str, list[tuple[str, float | None]]] = {}
    for case in study.cases:
        values_of_case = own_values(study, case)
        applicable = applying(inputs, case)
        wrong = unclear(places, case)
        used |= {parameter.name for parameter in applicable} | wrong.keys()
        for name, message in wrong.items():
            table.complain(message, *places[name])
        for parameter in applicable:
            own.setdefault(parameter.name, []).append((case.name, values_of_case[parameter.name]))
        if not wrong:
            _check_corners(table, applicable, case)
    for parameter in inputs:
        values = own.get(parameter.name, ())
        if parameter.spread != "choice" and (message := outside(parameter.name, parameter.levels, values)):
            table.complain(message, *parameter.at)
    for name in places.keys() - used:
        table.complain(f"{name}: {why_no_case(name, study)}; leave it out", *places[name])


def _check_corners(table: Table, inputs: Sequence[Input], case: Case) -> None:
    """Complain about impossible corners of all ranges, once for each key that is wrong.

    What is possible at the corners is so between them, as no limit turns back within a range.
    """
    inputs = [parameter for parameter in inputs if parameter.name not in OF_MOTION]
    places = {parameter.name: parameter.at for parameter in inputs}
    reported: set[str] = set()
    for corner in product(*(parameter.levels for parameter in inputs)):
        values = dict(zip(places, corner, strict=True))
        for problem, name in impossible(case, values):
            if name in reported:
                continue
            reported.add(name)
            named = name if name in places else next((size for size in OF_PIER if size in places), "")
            sizes = ", ".join(f"{key} = {shown(values[key])}" for key in OF_PIER if key in values)
            place = f" (at {sizes})" if sizes and name not in OF_PIER else ""
            table.complain(f'case "{case.name}"{place}: {problem}', *(places[named] if named else ()))
