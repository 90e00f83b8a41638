"""The cases of a study file, with every combination of listed values: [[case]]."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any, NamedTuple, get_args

from rockbatch.pier import (
    EPSILON_AND_ZETA,
    WITH_EXPONENT,
    Base,
    ElasticBase,
    Flight,
    Kinematics,
    Pier,
    RigidBase,
    SpringLaw,
    YieldingBase,
    beta_of,
    eta_of,
    least_beta,
    problems,
)
from rockbatch.study.lists import Chosen, combinations, how_many, listed, too_many
from rockbatch.study.piers import Values, has_mass
from rockbatch.study.plausible import CONFIRM, MASSES, complain_unless_usual, complain_unless_usual_support, confirmed
from rockbatch.study.restraint_keys import RESTRAINTS, complain_of_unlikely, read_restraints, restraints_of
from rockbatch.toml.kinds import choice, number, positive, shown, text
from rockbatch.toml.reader import Key, Setting, Table, TomlFile

_EVERY = {
    "flight": Key(choice(*get_args(Flight)), '"stop"', many=True),
    "flight_limit_mm": Key(positive, "20.0", many=True),
    "friction": Key(positive, "0.5", many=True),
}
"""Keys that apply on every base."""
_RIGID = {"restitution": Key(number, "0.9", many=True), **_EVERY}
_ELASTIC = {
    "beta": Key(number, "40.0", many=True),
    "stiffness_kN_m": Key(positive, "2.0e6", many=True),
    "mass_t": Key(positive, "3000.0", many=True),
    "epsilon": Key(number, "0.05", many=True),
    "zeta": Key(number, "0.05", many=True),
    "kinematics": Key(choice(*get_args(Kinematics)), '"first-order"', many=True),
    **_EVERY,
}
_YIELDING = _ELASTIC | {
    "eta": Key(number, "2.5", many=True),
    "yield_kN": Key(positive, "4.0e4", many=True),
    "spring": Key(choice(*get_args(SpringLaw)), '"bouc-wen"', many=True),
    "n": Key(number, "5", many=True),
}
BASES = {"rigid": _RIGID, "elastic": _ELASTIC, "yielding": _YIELDING}
BASE_KEYS = _RIGID | _YIELDING
CASE = {"name": Key(text, '"soft"'), "base": Key(choice(*BASES), '"yielding"', required=True)}

_ANY_PIER = Pier(alpha=1.0, p=1.0)
"""Stands in where no pier can be read, so that what does not depend on it is checked all the same."""


class _Read(NamedTuple):
    """A [[case]] as it is written, with the keys whose values it confirms."""

    table: Table
    name: str
    base: str
    believed: Collection[str]


class Expanded(NamedTuple):
    """One pier on one base, and the values of all keys that apply, also of those not written."""

    name: str
    pier: Pier
    base: Base
    values: Values


def read_cases(file: TomlFile, piers: Sequence[tuple[Pier, Values]]) -> tuple[list[Expanded], tuple[str, ...]]:
    """Every [[case]] on every pier, and which keys are lists in any of them."""
    tables = file.tables("case", title="name")
    if file.data.get("case", []) == []:
        file.complain(("case",), '[[case]] is missing; write at least one, for example with base = "rigid"')
    read = []
    varied: dict[str, None] = {}
    names: set[str] = set()
    for table in tables:
        own, settings, believed, of_restraints = _case(table)
        name = own.get("name", own.get("base", ""))
        if len(tables) > 1 and "name" not in table.data:
            table.complain('name is missing; of several cases each needs its own, for example name = "soft"')
        elif name in names:
            table.complain(f"name = {shown(name)}: given twice; give each case its own name", "name")
        names |= {name} - {""}
        varied |= dict.fromkeys((*listed(table, BASE_KEYS), *of_restraints))
        if "base" in own:
            read.append((_Read(table, name, own["base"], believed), settings))
    if told := too_many(max(len(piers), 1) * sum(how_many(settings) for _, settings in read), "cases"):
        file.complain(("case",), told)
        return [], tuple(varied)
    expanded = [
        _expand(case, chosen, pier, pier_values)
        for pier, pier_values in piers or [(_ANY_PIER, {})]
        for case, settings in read
        for chosen in _without_repeats(combinations(settings))
    ]
    return expanded, tuple(varied)


def _expand(case: _Read, chosen: Chosen, pier: Pier, pier_values: Values) -> Expanded:
    given = {key: setting.value for key, setting in chosen.items()}
    any_pier = pier is _ANY_PIER
    if "mass_t" in given:
        pier = replace(pier, mass_t=given["mass_t"])
    base = _base(case.base, given, pier)
    wrong = problems(pier, base)
    for problem in wrong:
        if EPSILON_AND_ZETA in problem:  # told once, of the table
            continue
        if not (any_pier and problem.startswith("beta")):
            _complain_where_due(case.table, chosen, problem, pier, base)
    if not (wrong or any_pier):
        complain_of_unlikely(case.table, chosen, pier, base.restraints)
    if not wrong and pier.mass_t is not None:
        complain_unless_usual_support(case.table, chosen, pier, base, case.believed)
    applying = {key: value for key, value in asdict(base).items() if value is not None} | given
    applying.pop("restraints", None)  # their own keys say them
    if "zeta" in applying:
        applying.pop("epsilon", None)
    if not base.has_exponent:
        applying.pop("n", None)
    return Expanded(case.name, pier, base, pier_values | applying)


def _base(name: str, given: Mapping[str, Any], pier: Pier) -> Base:
    """The base; K [kN/m] and F_y [kN] become β and η by the mass of the pier.

    Where β or η is missing, which is noted already, a possible value lets the rest be checked.
    """
    if name == "rigid":
        rigid = dict(given)
        return RigidBase(restraints=restraints_of(pier, rigid), **rigid)
    own: dict[str, Any] = {"beta": 2 * pier.least_beta, **given}
    own["restraints"] = restraints_of(pier, own)
    stiffness, strength, _ = (own.pop(key, None) for key in ("stiffness_kN_m", "yield_kN", "mass_t"))
    if stiffness and pier.mass_t:
        own["beta"] = beta_of(pier, stiffness)
    if name == "elastic":
        return ElasticBase(**own)
    if strength and pier.mass_t:
        own["eta"] = eta_of(pier, strength)
    own.setdefault("eta", 2.0)
    return YieldingBase(**own)


def _without_repeats(all_of_them: Iterable[Chosen]) -> Iterator[Chosen]:
    """Without n where the spring has none; what is then alike comes once."""
    seen = set()
    for chosen in all_of_them:
        if "spring" in chosen and chosen["spring"].value not in WITH_EXPONENT:
            chosen.pop("n", None)
        identity = tuple(chosen.items())
        if identity not in seen:
            seen.add(identity)
            yield chosen


# Mistakes that take more than one key to see


def _case(table: Table) -> tuple[dict[str, Any], dict[str, list[Setting]], Collection[str], Collection[str]]:
    """Name and base, the settings of that base, the keys that are confirmed, and those of restraints that are lists."""
    base = table.data.get("base")
    keys = BASES.get(base, BASE_KEYS) if isinstance(base, str) else BASE_KEYS
    unfit = {
        name: f"does not apply to base = {shown(base)}; leave it out, or write "
        + " or ".join(f'base = "{other}"' for other in BASES if name in BASES[other])
        for name in BASE_KEYS.keys() - keys.keys()
    }
    if (sharp := _without_exponent(table)) and "n" in keys:
        keys = {name: key for name, key in keys.items() if name != "n"}
        unfit["n"] = f"does not apply to spring = {sharp} (sharp corner); leave it out, or write " + " or ".join(
            f'spring = "{law}"' for law in WITH_EXPONENT
        )
    if has_mass(table.file) and "mass_t" in keys:
        keys = {name: key for name, key in keys.items() if name != "mass_t"}
        unfit["mass_t"] = "[pier] says already what the pier weighs; leave it out"
    read = table.read(CASE | keys | CONFIRM, unfit=unfit, other=RESTRAINTS)
    believed = confirmed(table, read, keys)
    complain_unless_usual(table, "mass_t", read.get("mass_t", ()), MASSES["mass_t"], believed)
    if "epsilon" in table.data and "zeta" in read:
        table.complain(f"epsilon = {shown(table.data['epsilon'])}: {EPSILON_AND_ZETA}", "epsilon")
    if base in ("elastic", "yielding"):
        _check_one_of(table, "beta", "stiffness_kN_m")
    if base == "yielding":
        _check_one_of(table, "eta", "yield_kN")
    if "mass_t" in table.data and "mass_t" in keys and not {"stiffness_kN_m", "yield_kN"} & table.data.keys():
        table.complain("mass_t is for use with stiffness_kN_m or yield_kN; leave it out", "mass_t")
    settings = {name: value for name, value in read.items() if name not in CASE}
    of_each, of_restraints = read_restraints(table)
    return read, settings | of_each, believed, of_restraints


def _without_exponent(table: Table) -> str:
    """The laws that are written, as they are shown, if none of them has an exponent."""
    written = table.data.get("spring")
    laws = written if isinstance(written, list) else [written]
    sharp = [law for law in laws if law in get_args(SpringLaw) and law not in WITH_EXPONENT]
    return " or ".join(map(shown, sharp)) if sharp == laws else ""


def _check_one_of(table: Table, ratio: str, absolute: str) -> None:
    """Either the dimensionless parameter or its absolute counterpart, which takes the mass too."""
    if ratio in table.data and absolute in table.data:
        table.complain(f"{ratio} and {absolute} are given, which fix the same; keep one", absolute)
    elif absolute in table.data and "mass_t" not in table.data and not has_mass(table.file):
        example = BASE_KEYS["mass_t"].example
        table.complain(
            f"mass_t is missing beside {absolute}; write for example mass_t = {example}, here or in [pier]", absolute
        )
    elif ratio not in table.data and absolute not in table.data:
        table.complain(
            f"{ratio} is missing; write for example {ratio} = {BASE_KEYS[ratio].example}, or {absolute} = "
            f"{BASE_KEYS[absolute].example} with mass_t"
        )


def _complain_where_due(table: Table, chosen: Chosen, problem: str, pier: Pier, base: Base) -> None:
    """Place a problem of the structure, "key = …", at that key or at the one it was derived from, with its limit."""
    name = problem.split(" = ")[0]
    source = {"beta": "stiffness_kN_m", "eta": "yield_kN"}.get(name, "")
    mass = pier.mass_t
    if source in chosen and mass is not None:
        least_omega_v = least_beta(pier, base) * pier.p
        least = least_omega_v * least_omega_v * mass / 2 if name == "beta" else mass * pier.gravity / 2
        name = source
        weighing = f"mass_t = {mass:g}" if "mass_t" in chosen else f"the {mass:g} t of [pier]"
        derived = f"{source} = {chosen[source].value:g} with {weighing}"
        problem = f"{derived} means {problem}; write {source} above {least:.4g}"
    if name in chosen:
        table.complain_about(chosen[name], problem)
    else:
        table.complain(problem)
