"""Inputs of a sensitivity study and their ranges: [sensitivity] of a study file."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import product
from typing import Any

from rockbatch.common.errors import InputError
from rockbatch.pier import beta_of, eta_of, in_kilonewtons, problems
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.study.cases import CASE
from rockbatch.study.load import Study
from rockbatch.study.motions import MOTIONS
from rockbatch.study.piers import PIER
from rockbatch.study.restraint_inputs import (
    IN_KILONEWTONS,
    TABLE,
    in_words,
    is_of_restraint,
    unclear,
    values_of_devices,
    why_none,
    with_values,
)
from rockbatch.study.restraint_keys import DEVICES, RESTRAINTS
from rockbatch.study.spec import Case
from rockbatch.toml.kinds import Choice, Kind, Number, boolean, choice, count, positive, shown
from rockbatch.toml.reader import Table, TomlFile
from rockbatch.toml.section import Key, Section

OF_PIER = ("alpha", "p", "mu")
OF_MOTION = ("vertical", "polarity")
"""Factors of the whole suite."""

Value = float | str | bool


@dataclass(frozen=True)
class Input:
    """Something that the answer may depend on.

    Attributes
    ----------
    name : str
        Key of the study file; of a device "damper.f", "tendon_2.psi".
    spread : "uniform", "log_uniform" or "choice"
    levels : tuple of two
        Ends of the range, or the two choices.
    """

    name: str
    spread: str
    levels: tuple[Any, Any]

    @property
    def at(self) -> tuple[str, ...]:
        """Return its place under [sensitivity]."""
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


SENSITIVITY = Section(("sensitivity",), (
    "Which inputs matter, by `rockbatch sensitivity`: one input at a time, and Sobol indices of all together."
), {
    "statistic": Key(choice(*(name for name, kind in STATISTICS.items() if kind.evaluate and not kind.code)), '"median"',
        "Statistic over the records."),
    "overturned": Key(positive, "1.0", "The θ_max/α as which a run counts that overturned; larger ones count so too."),
    "samples": Key(Choice(tuple(2**k for k in range(2, 31)), "a power of two from 4"), "64",
        "Size N of the design: N (d + 2) points for d inputs, each under every record."),
    "confidence": Key(Number("a number between 0 and 1", low=0.0, high=1.0, above=True, below=True), "0.95",
        "Level of the intervals of the indices."),
    "seed": Key(count, "1", "Seed of the design and of the intervals."),
}, homes=(SensitivitySpec,))  # fmt: skip


_RANGES: dict[str, tuple[Mapping[str, Key], dict[str, str]]] = {
    "": ({**PIER, **CASE}, {
        "alpha": "[0.12, 0.16]", "p": "[0.3, 0.5]", "mu": "[2.5, 3.5]", "restitution": "[0.85, 0.95]", "beta": "[30, 90]",
        "epsilon": "[0.05, 0.3]", "zeta": "[0.02, 0.1]", "eta": "[2.0, 4.0]", "n": "[2, 8]", "stiffness_kN_m": "[1e6, 4e6]",
        "yield_kN": "[3e4, 6e4]",
    }),
    "damper": (DEVICES["damper"], {
        "force_kN": "[300.0, 600.0]", "f": "[0.01, 0.05]", "yield_mm": "[3.0, 8.0]", "coefficient_kN_s_m": "[500.0, 2000.0]",
        "nu": "[0.2, 0.8]", "exponent": "[0.3, 1.0]", "brace_kN_m": "[1.0e5, 4.0e5]", "brace": "[2.0, 10.0]",
    }),
    "tendon": (DEVICES["tendon"], {
        "prestress_kN": "[3000.0, 6000.0]", "psi": "[0.2, 0.8]", "stiffness_kN_m": "[2.0e4, 8.0e4]",
        "yield_kN": "[8000.0, 1.2e4]", "lambda": "[0.5, 2.0]",
    }),
    "stop": (DEVICES["stop"], {
        "gap_mm": "[80.0, 120.0]", "stiffness_kN_m": "[2.0e5, 1.0e6]", "lambda": "[10.0, 40.0]", "restitution": "[0.4, 0.8]",
    }),
    "deck_spring": (DEVICES["deck_spring"], {
        "gap_mm": "[20.0, 60.0]", "stiffness_kN_m": "[2.0e4, 1.0e5]", "lambda": "[0.1, 0.5]", "restitution": "[0.4, 0.8]",
    }),
}  # fmt: skip
"""Keys of a pier and its case, and of its devices, that have ranges, with examples."""


def _ranges(what: str, kind: Kind | None = None) -> dict[str, Key]:
    """Return keys of the study as ranges, of their own kind or another."""
    keys, examples = _RANGES[what]
    return {
        name: Key(kind or keys[name].kind, example, keys[name].words, pair=True) for name, example in examples.items()
    }


def _choice(keys: Mapping[str, Key], name: str, example: str) -> dict[str, Key]:
    return {name: Key(keys[name].kind, example, keys[name].words, many=True)}


SPREADS = {
    "uniform": Section(("sensitivity", "uniform"),
        "Uniform inputs: the smallest and the largest value.", _ranges("")),
    "log_uniform": Section(("sensitivity", "log_uniform"),
        "Log-uniform inputs: the smallest and the largest value.", _ranges("", positive)),
    "choice": Section(("sensitivity", "choice"), "Inputs with two equally likely values.", {
        **_choice(CASE, "kinematics", '["first-order", "finite"]'),
        **_choice(CASE, "spring", '["bouc-wen", "epp"]'),
        "vertical": Key(boolean, "[true, false]", "With the records' vertical components, or without.", many=True),
        **_choice(MOTIONS, "polarity", '["+", "-"]'),
    }),
}  # fmt: skip
WITHIN: dict[str, dict[str, dict[str, Key]]] = {
    "uniform": {what: _ranges(what) for what in RESTRAINTS},
    "log_uniform": {what: _ranges(what, positive) for what in RESTRAINTS},
    "choice": {},
}
"""Keys of tables within, such as [sensitivity.uniform.damper], or damper.f = … in [sensitivity.uniform]."""
SECTIONS = (SENSITIVITY, *SPREADS.values(), *(
    Section(
        ("sensitivity", spread, what),
        f"Inputs of the {what} of a case, the least and the largest value; or write {what}.{first} = {keys[first].example} "
        f"above. Where several {what}s of a case have the key, {what}_1 is the first that the case has, {what}_2 the next.",
        keys,
        numbered=True,
    )
    for spread, within in WITHIN.items()
    for (what, keys), first in zip(within.items(), ("f", "psi", "gap_mm", "gap_mm"), strict=False)
))  # fmt: skip


def applying(inputs: Iterable[Input], case: Case) -> tuple[Input, ...]:
    """Return the inputs that a case has."""
    names = {*_variable_values(case), *OF_MOTION}
    return tuple(parameter for parameter in inputs if parameter.name in names)


def varied(case: Case, values: Mapping[str, Value]) -> Case:
    """Return the case with other values of its pier and its base. Raises :class:`InputError` where the pier cannot be."""
    arguments: dict[str, Any] = {name: value for name, value in values.items() if name not in OF_MOTION}
    pier = replace(case.pier, **{name: arguments.pop(name) for name in OF_PIER if name in arguments})
    for name, ratio in IN_KILONEWTONS.items():
        if name in arguments:
            arguments[ratio] = (beta_of if ratio == "beta" else eta_of)(pier, arguments.pop(name))
    of_restraints = {name: arguments.pop(name) for name in list(arguments) if is_of_restraint(name)}
    if of_restraints:
        arguments["restraints"] = with_values(pier, case.base.restraints, of_restraints)
    return replace(case, pier=pier, base=replace(case.base, **arguments))


def own_values(study: Study, case: Case) -> dict[str, Any]:
    """Return the study's own value of every input."""
    return _variable_values(case) | {"vertical": study.motions.vertical, "polarity": study.motions.polarity[0]}


def _variable_values(case: Case) -> dict[str, Any]:
    """Return the values of all quantities that a case may vary; ε, or ζ if that is given instead."""
    pier = {name: getattr(case.pier, name) for name in OF_PIER}
    base = {field.name: getattr(case.base, field.name) for field in fields(case.base)}
    base.pop("zeta" if base.get("zeta") is None else "epsilon", None)
    derived = in_kilonewtons(case.pier, case.base) | values_of_devices(case.pier, case.base.restraints)
    # To the digits in which studies are written, so that a range may end at the study's own value
    return pier | base | {name: float(f"{value:.12g}") for name, value in derived.items()}


def read_sensitivity(study: Study) -> SensitivitySpec:
    """Return what the study file asks for in [sensitivity].

    Raises
    ------
    InputError
        With every mistake, or because there is no such table.
    """
    file = study.file()
    table = file.table("sensitivity", required="[sensitivity] and [sensitivity.uniform] with alpha = [0.12, 0.16]")
    read: dict[str, Any] = {}
    inputs: list[Input] = []
    if table is not None:
        read = table.read(SENSITIVITY, other=SPREADS)
        for spread, keys in SPREADS.items():
            inputs += _inputs(file, spread, keys)
        spreads: dict[str, list[str]] = {}
        for parameter in inputs:
            spreads.setdefault(parameter.name, []).append(parameter.spread)
        for name, ratio in IN_KILONEWTONS.items():
            if name in spreads and ratio in spreads:
                table.complain(f"{ratio} and {name} are given, which fix the same; keep one", spreads[name][-1], name)
        for name, places in spreads.items():
            if len(places) > 1:
                table.complain(f"{name} is given under {' and '.join(places)}; keep one", places[1], *name.split("."))
        if not table.data.keys() & SPREADS.keys():
            table.complain("nothing is varied; write [sensitivity.uniform] and under it alpha = [0.12, 0.16]")
        if not file.problems:
            _check(table, inputs, study)
    file.finish()
    return SensitivitySpec(tuple(inputs), **read)


def _inputs(file: TomlFile, spread: str, keys: Mapping[str, Key]) -> list[Input]:
    table = file.table("sensitivity", spread)
    if table is None:
        return []
    unfit = {
        name: f"belongs under [sensitivity.{spread_of_other}]"
        for spread_of_other, names in SPREADS.items()
        for name in names.keys() - keys.keys()
    }
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


def _read(table: Table, spread: str, keys: Mapping[str, Key], **more: Any) -> list[Input]:
    inputs = []
    for name, levels in table.read(keys, **more).items():
        if len(levels) == 2:
            inputs.append(Input(name, spread, levels))
        else:
            table.complain(f"{name}: expected both choices; write {name} = {keys[name].example}", name)
    return inputs


def _check(table: Table, inputs: Sequence[Input], study: Study) -> None:
    """Check that every input belongs to some case, that its range holds the study's value, and that every corner is possible."""
    used: set[str] = set()
    places = {parameter.name: parameter.at for parameter in inputs}
    for case in study.cases:
        values_of_case = own_values(study, case)
        applicable = applying(inputs, case)
        wrong = unclear(places, case)
        used |= {parameter.name for parameter in applicable} | wrong.keys()
        for name, message in wrong.items():
            table.complain(message, *places[name])
        for parameter in applicable:
            name, (low, high), value = parameter.name, parameter.levels, values_of_case[parameter.name]
            if parameter.spread != "choice" and value is not None and not low <= value <= high:
                table.complain(
                    f'{name} = {shown([low, high])}: does not hold the {value:g} of case "{case.name}"; '
                    f"write {name} = {shown([min(low, value), max(high, value)])}",
                    *places[name],
                )
        if not wrong:
            _check_corners(table, applicable, case)
    for name in places.keys() - used:
        table.complain(f"{name}: {_why_none(name, study)}; leave it out", *places[name])


def _why_none(name: str, study: Study) -> str:
    """Return why no case of the study has this input."""
    if is_of_restraint(name):
        return why_none(name, study.cases)
    if name in IN_KILONEWTONS:
        return "it goes with a pier of known mass (mass_t) on springs"
    if name in ("epsilon", "zeta") and any(case.base.on_springs for case in study.cases):
        return (
            "it goes with springs that have one; write zeta in the case" if name == "zeta" else "zeta takes its place"
        )
    return "no case of the study has it"


def _check_corners(table: Table, inputs: Sequence[Input], case: Case) -> None:
    """Check the corners of all ranges: what is possible there is so between them, as no limit turns back within a range."""
    places = {parameter.name: parameter.at for parameter in inputs}
    reported: set[str] = set()
    for corner in product(*(parameter.levels for parameter in inputs)):
        values = dict(zip(places, corner, strict=True))
        try:
            case_at_corner = varied(case, values)
            wrong: Sequence[str] = problems(case_at_corner.pier, case_at_corner.base)
        except InputError as error:
            wrong = error.problems
        for problem in wrong:
            problem, name = in_words(problem, values)
            if name in reported:
                continue
            reported.add(name)
            named = name if name in places else next((size for size in OF_PIER if size in places), "")
            sizes = ", ".join(f"{key} = {shown(values[key])}" for key in OF_PIER if key in values)
            place = f" (at {sizes})" if sizes and name not in OF_PIER else ""
            table.complain(f'case "{case.name}"{place}: {problem}', *(places[named] if named else ()))
