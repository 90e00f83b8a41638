"""What a sensitivity study varies, and over which ranges: [sensitivity] of a study file."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import product
from typing import Any, get_args

from rockbatch.checks.statistics import STATISTICS
from rockbatch.errors import InputError
from rockbatch.pier import ElasticBase, Kinematics, SpringLaw, beta_of, eta_of, in_kilonewtons, problems
from rockbatch.study.ranges import range_of
from rockbatch.study.spec import Case, Study
from rockbatch.toml.kinds import KindError, boolean, choice, count, number, positive, shown
from rockbatch.toml.reader import Key, Table, TomlFile

OF_PIER = ("alpha", "p", "mu")
OF_MOTION = ("vertical", "polarity")
"""Factors of the whole suite."""

IN_KILONEWTONS = {"stiffness_kN_m": "beta", "yield_kN": "eta"}
"""Inputs that a pier of known mass turns into ratios, and which."""

Value = float | str | bool


def _power_of_two(value: Any) -> int:
    """As Sobol's sequence needs it to be balanced."""
    if count(value) & (value - 1) or value < 4:
        raise KindError("a power of two from 4")
    return int(value)


def _share(value: Any) -> float:
    if not 0 < number(value) < 1:
        raise KindError("a number between 0 and 1")
    return float(value)


SENSITIVITY = {
    "statistic": Key(choice(*(name for name, each in STATISTICS.items() if each.of and not each.code)), '"median"'),
    "overturned": Key(positive, "1.0"),
    "samples": Key(_power_of_two, "64"),
    "confidence": Key(_share, "0.95"),
    "seed": Key(count, "1"),
}
_RANGES = {
    name: Key(positive if name in (*OF_PIER, *IN_KILONEWTONS) else number, example, many=True)
    for name, example in (
        ("alpha", "[0.12, 0.16]"),
        ("p", "[0.3, 0.5]"),
        ("mu", "[2.5, 3.5]"),
        ("restitution", "[0.85, 0.95]"),
        ("beta", "[30, 90]"),
        ("epsilon", "[0.05, 0.3]"),
        ("eta", "[2.0, 4.0]"),
        ("n", "[2, 8]"),
        ("stiffness_kN_m", "[1e6, 4e6]"),
        ("yield_kN", "[3e4, 6e4]"),
    )
}
UNIFORM = _RANGES
LOG_UNIFORM = {name: replace(key, kind=positive) for name, key in _RANGES.items()}
CHOICE = {
    "kinematics": Key(choice(*get_args(Kinematics)), '["first-order", "finite"]', many=True),
    "spring": Key(choice(*get_args(SpringLaw)), '["bouc-wen", "epp"]', many=True),
    "vertical": Key(boolean, "[true, false]", many=True),
    "polarity": Key(choice("+", "-"), '["+", "-"]', many=True),
}
SPREADS = {"uniform": UNIFORM, "log_uniform": LOG_UNIFORM, "choice": CHOICE}


@dataclass(frozen=True)
class Input:
    """Something that the answer may depend on.

    Attributes
    ----------
    name : str
        Key of the study file.
    spread : "uniform", "log_uniform" or "choice"
    levels : tuple of two
        Ends of the range, or the two choices.
    """

    name: str
    spread: str
    levels: tuple[Any, Any]


@dataclass(frozen=True)
class SensitivitySpec:
    """A sensitivity study.

    Attributes
    ----------
    inputs : tuple of Input
    statistic : str
        Of the suite, a name in :data:`rockbatch.checks.statistics.STATISTICS`.
    overturned : float
        The θ_max/α as which a run counts that overturned or was ended by flight; larger ones are cut there too.
    samples : int
        N of Saltelli's design: N (d + 2) points for d inputs.
    confidence : float
        Level of the intervals of Sobol indices.
    seed : int
    """

    inputs: tuple[Input, ...]
    statistic: str = "median"
    overturned: float = 1.0
    samples: int = 64
    confidence: float = 0.95
    seed: int = 1


def applying(inputs: Iterable[Input], case: Case) -> tuple[Input, ...]:
    """The inputs that a case has."""
    own = {each.name for each in fields(case.base)} | {*OF_PIER, *OF_MOTION, *_in_kilonewtons(case)}
    return tuple(each for each in inputs if each.name in own)


def varied(case: Case, values: Mapping[str, Value]) -> Case:
    """The case with other values of its pier and its base. Raises :class:`InputError` where the pier cannot be."""
    given: dict[str, Any] = {name: value for name, value in values.items() if name not in OF_MOTION}
    pier = replace(case.pier, **{name: given.pop(name) for name in OF_PIER if name in given})
    for name, ratio in IN_KILONEWTONS.items():
        if name in given:
            given[ratio] = (beta_of if ratio == "beta" else eta_of)(pier, given.pop(name))
    return replace(case, pier=pier, base=replace(case.base, **given))


def own_values(study: Study, case: Case) -> dict[str, Any]:
    """What the study itself says about every input."""
    of_motion = {"vertical": study.motions.vertical, "polarity": study.motions.polarity[0]}
    pier = {name: getattr(case.pier, name) for name in OF_PIER}
    base = {each.name: getattr(case.base, each.name) for each in fields(case.base)}
    return pier | base | _in_kilonewtons(case) | of_motion


def _in_kilonewtons(case: Case) -> dict[str, float]:
    """Stiffness [kN/m] and yield force [kN] of a case on springs, where the mass is known."""
    if not isinstance(case.base, ElasticBase):
        return {}
    # To the digits in which studies are written, so that a range may end at the study's own value
    return {name: float(f"{value:.12g}") for name, value in in_kilonewtons(case.pier, case.base).items()}


def read_sensitivity(study: Study) -> SensitivitySpec:
    """What the study file asks for in [sensitivity].

    Raises
    ------
    InputError
        With every mistake, or because there is no such table.
    """
    file = TomlFile.parse(study.path, study.text)
    table = file.table("sensitivity", required="[sensitivity] and [sensitivity.uniform] with alpha = [0.12, 0.16]")
    read: dict[str, Any] = {}
    inputs: list[Input] = []
    if table is not None:
        read = table.read(SENSITIVITY, other=SPREADS)
        for spread, keys in SPREADS.items():
            inputs += _inputs(file, spread, keys)
        for name, ratio in IN_KILONEWTONS.items():
            spreads = {each.name: each.spread for each in inputs}
            if name in spreads and ratio in spreads:
                table.complain(f"{ratio} and {name} are given, which fix the same; keep one", spreads[name], name)
        for name in {each.name for each in inputs}:
            places = [each.spread for each in inputs if each.name == name]
            if len(places) > 1:
                table.complain(f"{name} is given under {' and '.join(places)}; keep one", places[1], name)
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
    found = []
    unfit = {
        name: f"belongs under [sensitivity.{other}]"
        for other, names in SPREADS.items()
        for name in names.keys() - keys.keys()
    }
    for name, settings in table.read(keys, unfit=unfit).items():
        if spread != "choice":
            levels = range_of(table, name, settings)
        elif len(settings) == 2:
            levels = settings[0].value, settings[1].value
        else:
            levels = None
            table.complain(f"{name}: expected both choices; write {name} = {keys[name].example}", name)
        if levels is not None:
            found.append(Input(name, spread, levels))
    return found


def _check(table: Table, inputs: Sequence[Input], study: Study) -> None:
    """Every input belongs to some case, its range holds the study's value, and every corner is possible."""
    used: set[str] = set()
    for case in study.cases:
        own = own_values(study, case)
        mine = applying(inputs, case)
        used |= {each.name for each in mine}
        for each in mine:
            low, high = each.levels
            value = own[each.name]
            if each.spread != "choice" and value is not None and not low <= value <= high:
                table.complain(
                    f'{each.name} = {shown(list(each.levels))}: does not hold the {value:g} of case "{case.name}"; '
                    f"write {each.name} = {shown([min(low, value), max(high, value)])}",
                    each.spread,
                    each.name,
                )
        _check_corners(table, mine, case)
    for each in inputs:
        if each.name not in used:
            weighed = "a pier of known mass (mass_t) on " if each.name in IN_KILONEWTONS else ""
            has = f"it goes with {weighed}springs" if weighed else "no case of the study has it"
            table.complain(f"{each.name}: {has}; leave it out", each.spread, each.name)


def _check_corners(table: Table, inputs: Sequence[Input], case: Case) -> None:
    """What is possible at all corners is so between them: no limit turns back within a range."""
    places = {each.name: each.spread for each in inputs}
    told: set[str] = set()
    for corner in product(*(each.levels for each in inputs)):
        values = dict(zip(places, corner, strict=True))
        try:
            there = varied(case, values)
            wrong: Sequence[str] = problems(there.pier, there.base)
        except InputError as error:
            wrong = error.problems
        for problem in wrong:
            name = problem.split(" = ")[0]
            written = next((key for key, ratio in IN_KILONEWTONS.items() if ratio == name and key in places), name)
            if written != name:
                problem = f"{written} = {values[written]:g} means {problem}"
                name = written
            if name in told:
                continue
            told.add(name)
            at = name if name in places else next((other for other in OF_PIER if other in places), "")
            which = ", ".join(f"{key} = {shown(values[key])}" for key in OF_PIER if key in values)
            where = f" (at {which})" if which and name not in OF_PIER else ""
            table.complain(f'case "{case.name}"{where}: {problem}', *((places[at], at) if at else ()))
