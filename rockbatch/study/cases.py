"""The piers and cases of a study file, with every combination of listed values: [pier] and [[case]]."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from itertools import product
from typing import Any, NamedTuple

from rockbatch.errors import InputError
from rockbatch.pier import Base, ElasticBase, Pier, RigidBase, YieldingBase, least_beta, problems
from rockbatch.toml.kinds import choice, number, positive, shown, text
from rockbatch.toml.reader import Key, Setting, Table, TomlFile

PIER = {
    "alpha": Key(positive, "0.13", many=True),
    "mu": Key(positive, "3.0", many=True),
    "gravity": Key(positive, "9.81"),  # one for all: motions given in g are turned into m/s² with it
    "p": Key(positive, "0.38", many=True),
    "size_m": Key(positive, "60.1", many=True),
    "width_m": Key(positive, "4.0", many=True),
    "height_m": Key(positive, "30.0", many=True),
}
PIER_KEYS = tuple(PIER)
_RIGID = {"restitution": Key(number, "0.9", many=True)}
_ELASTIC = {
    "beta": Key(number, "40.0", many=True),
    "stiffness_kN_m": Key(positive, "2.0e6", many=True),
    "mass_t": Key(positive, "3000.0", many=True),
    "epsilon": Key(number, "0.05", many=True),
    "kinematics": Key(choice("first-order", "finite"), '"first-order"', many=True),
    "flight": Key(choice("stop", "guided"), '"stop"', many=True),
}
_YIELDING = _ELASTIC | {
    "eta": Key(number, "2.5", many=True),
    "yield_kN": Key(positive, "4.0e4", many=True),
    "spring": Key(choice("bouc-wen", "epp"), '"bouc-wen"', many=True),
    "n": Key(number, "5", many=True),
}
_BASES = {"rigid": _RIGID, "elastic": _ELASTIC, "yielding": _YIELDING}
BASE_KEYS = _RIGID | _YIELDING
CASE = {"name": Key(text, '"soft"'), "base": Key(choice(*_BASES), '"yielding"', required=True)}

Values = dict[str, float | str]
_ANY_PIER = Pier(alpha=1.0, p=1.0)
"""Stands in where no pier can be read, so that what does not depend on it is checked all the same."""


class Expanded(NamedTuple):
    """One pier on one base, and the values of all keys that apply, also of those not written."""

    name: str
    pier: Pier
    base: Base
    values: Values


def read_piers(file: TomlFile) -> tuple[list[tuple[Pier, Values]], tuple[str, ...]]:
    """The piers of [pier] with their keys' values (none if there are mistakes), and which keys are lists."""
    table = file.table("pier", required="[pier] with alpha = 0.13 and p = 0.38, or with width_m and height_m")
    if table is None:
        return [], ()
    before = len(file.problems)
    read = table.read(PIER)
    gravity = {"gravity": read.pop("gravity")} if "gravity" in read else {}
    _check_one_size(table)
    if len(file.problems) > before:
        return [], ()
    piers = []
    for chosen in _combinations(read):
        values = {name: setting.value for name, setting in chosen.items()} | gravity
        try:
            if "width_m" in values:
                pier = Pier.rectangle(**values)
            elif "size_m" in values:
                pier = Pier.from_size(**values)
            else:
                pier = Pier(**values)
        except InputError as error:
            for problem in error.problems:
                _complain_where_due(table, chosen, problem)
        else:
            piers.append((pier, values | asdict(pier)))
    return piers, _listed(table, PIER)


def read_cases(file: TomlFile, piers: Sequence[tuple[Pier, Values]]) -> tuple[list[Expanded], tuple[str, ...]]:
    """Every [[case]] on every pier, and which keys are lists in any of them."""
    tables = file.tables("case", title="name")
    if file.data.get("case", []) == []:
        file.complain(("case",), '[[case]] is missing; write at least one, for example with base = "rigid"')
    read = []
    varied: dict[str, None] = {}
    names: set[str] = set()
    for table in tables:
        own, settings = _case(table)
        name = own.get("name", own.get("base", ""))
        if len(tables) > 1 and "name" not in table.data:
            table.complain('name is missing; of several cases each needs its own, for example name = "soft"')
        elif name in names:
            table.complain(f"name = {shown(name)}: given twice; give each case its own name", "name")
        names |= {name} - {""}
        varied |= dict.fromkeys(_listed(table, BASE_KEYS))
        if "base" in own:
            read.append((table, name, own["base"], settings))
    expanded = [
        _expand(table, name, base, chosen, pier, pier_values)
        for pier, pier_values in piers or [(_ANY_PIER, {})]
        for table, name, base, settings in read
        for chosen in _without_repeats(_combinations(settings))
    ]
    return expanded, tuple(varied)


def _expand(
    table: Table, name: str, base_name: str, chosen: Mapping[str, Setting], pier: Pier, pier_values: Values
) -> Expanded:
    given = {key: setting.value for key, setting in chosen.items()}
    base = _base(base_name, given, pier)
    for problem in problems(pier, base):
        if pier is not _ANY_PIER or not problem.startswith("beta"):
            _complain_where_due(table, chosen, problem, pier, base)
    applying = {key: value for key, value in asdict(base).items() if value is not None} | given
    if applying.get("spring") == "epp":
        del applying["n"]
    return Expanded(name, pier, base, pier_values | applying)


def _base(name: str, given: Mapping[str, Any], pier: Pier) -> Base:
    """The base; K [kN/m], F_y [kN] and M [t] become β = sqrt(2K/M)/p and η = 2F_y/(Mg).

    Where β or η is missing, which is noted already, a possible value lets the rest be checked.
    """
    if name == "rigid":
        return RigidBase(**given)
    own: dict[str, Any] = {"beta": 2 * pier.least_beta, **given}
    stiffness, strength, mass = (own.pop(key, None) for key in ("stiffness_kN_m", "yield_kN", "mass_t"))
    if stiffness and mass:
        own["beta"] = math.sqrt(2 * stiffness / mass) / pier.p
    if name == "elastic":
        return ElasticBase(**own)
    if strength and mass:
        own["eta"] = 2 * strength / (mass * pier.gravity)
    own.setdefault("eta", 2.0)
    return YieldingBase(**own)


def _combinations(settings: Mapping[str, Sequence[Setting]]) -> Iterator[dict[str, Setting]]:
    """Every combination, the last key varying fastest."""
    for chosen in product(*settings.values()):
        yield dict(zip(settings, chosen, strict=True))


def _without_repeats(combinations: Iterable[dict[str, Setting]]) -> Iterator[dict[str, Setting]]:
    """Without n where the spring has none; what is then alike comes once."""
    seen = set()
    for chosen in combinations:
        if "spring" in chosen and chosen["spring"].value == "epp":
            chosen.pop("n", None)
        identity = tuple(chosen.items())
        if identity not in seen:
            seen.add(identity)
            yield chosen


def _listed(table: Table, names: Iterable[str]) -> tuple[str, ...]:
    """The keys of the table that are lists, in the order of the file."""
    names = set(names)
    return tuple(name for name, value in table.data.items() if name in names and isinstance(value, list))


# Mistakes that take more than one key to see


def _check_one_size(table: Table) -> None:
    """Exactly one way to give the pier's size, and α and μ only where they do not follow from it."""
    given = [name for name in table.data if name in ("p", "size_m", "width_m", "height_m")]
    sides = [name for name in given if name in ("width_m", "height_m")]
    ways = len(given) - len(sides) + bool(sides)
    if ways == 0:
        table.complain("its size is missing; write p = 0.38 (rad/s), size_m = 60.1, or width_m and height_m")
    elif ways > 1:
        table.complain(
            f"{', '.join(given[:-1])} and {given[-1]} are given, which fix the size more than once; keep p, "
            "or size_m, or width_m with height_m",
            given[-1],
        )
    elif len(sides) == 1:
        missing = "height_m" if sides == ["width_m"] else "width_m"
        example = PIER[missing].example
        table.complain(f"{missing} is missing beside {sides[0]}; write for example {missing} = {example}")
    if not sides and "alpha" not in table.data:
        table.complain("alpha is missing; write for example alpha = 0.13 (slenderness, rad)")
    if sides and ways == 1:
        for name in {"alpha", "mu"} & table.data.keys():
            table.complain(f"{name} follows from width_m and height_m (of a solid rectangle); leave it out", name)


def _case(table: Table) -> tuple[dict[str, Any], dict[str, list[Setting]]]:
    """Name and base, and the settings of that base."""
    base = table.data.get("base")
    keys = _BASES.get(base, BASE_KEYS) if isinstance(base, str) else BASE_KEYS
    unfit = {
        name: f"does not apply to base = {shown(base)}; leave it out, or write "
        + " or ".join(f'base = "{other}"' for other in _BASES if name in _BASES[other])
        for name in BASE_KEYS.keys() - keys.keys()
    }
    if table.data.get("spring") in ("epp", ["epp"]) and "n" in keys:
        keys = {name: key for name, key in keys.items() if name != "n"}
        unfit["n"] = 'does not apply to spring = "epp" (sharp corner); leave it out, or write spring = "bouc-wen"'
    read = table.read(CASE | keys, unfit=unfit)
    if base in ("elastic", "yielding"):
        _check_one_of(table, "beta", "stiffness_kN_m")
    if base == "yielding":
        _check_one_of(table, "eta", "yield_kN")
    if "mass_t" in table.data and "mass_t" in keys and not {"stiffness_kN_m", "yield_kN"} & table.data.keys():
        table.complain("mass_t is for use with stiffness_kN_m or yield_kN; leave it out", "mass_t")
    return read, {name: value for name, value in read.items() if name not in CASE}


def _check_one_of(table: Table, ratio: str, absolute: str) -> None:
    """Either the dimensionless parameter or its absolute counterpart, which takes the mass too."""
    if ratio in table.data and absolute in table.data:
        table.complain(f"{ratio} and {absolute} are given, which fix the same; keep one", absolute)
    elif absolute in table.data and "mass_t" not in table.data:
        example = BASE_KEYS["mass_t"].example
        table.complain(f"mass_t is missing beside {absolute}; write for example mass_t = {example}", absolute)
    elif ratio not in table.data and absolute not in table.data:
        table.complain(
            f"{ratio} is missing; write for example {ratio} = {BASE_KEYS[ratio].example}, or {absolute} = "
            f"{BASE_KEYS[absolute].example} with mass_t"
        )


def _complain_where_due(
    table: Table, chosen: Mapping[str, Setting], problem: str, pier: Pier | None = None, base: Base | None = None
) -> None:
    """Place a problem of the structure, "key = …", at that key or at the one it was derived from, with its limit."""
    name = problem.split(" = ")[0]
    source = {"beta": "stiffness_kN_m", "eta": "yield_kN"}.get(name, "")
    if pier is not None and isinstance(base, ElasticBase) and source in chosen and "mass_t" in chosen:
        mass = chosen["mass_t"].value
        least_omega_v = least_beta(pier, base) * pier.p
        least = least_omega_v * least_omega_v * mass / 2 if name == "beta" else mass * pier.gravity / 2
        name = source
        derived = f"{source} = {chosen[source].value:g} with mass_t = {mass:g}"
        problem = f"{derived} means {problem}; write {source} above {least:.4g}"
    if name in chosen:
        table.complain_about(chosen[name], problem)
    else:
        table.complain(problem)
