"""Parameters of devices as inputs of a sensitivity study: damper.f, or damper_2.f where several have one."""

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from rockbatch.common.errors import Problem
from rockbatch.common.showing import shown
from rockbatch.pier import Damper, Pier, Restraint, fields_of
from rockbatch.study.restraint_keys import FIELD_OF, IN_KN, KEYS_OF, RESTRAINTS
from rockbatch.study.spec import Case

IN_KILONEWTONS = {"stiffness_kN_m": "beta", "yield_kN": "eta"}
"""Inputs that a pier of known mass turns into ratios, and which."""

TABLE = re.compile(rf"({'|'.join(RESTRAINTS)})(?:_([1-9][0-9]*))?")
"""Name of a table of such inputs: of the only device of its kind, or with its number in the case."""


class Parameter(NamedTuple):
    """Place of a parameter: the number of the base's device, its field, and the key's value over the field's."""

    place: int
    field: str
    divisor: float


def is_of_restraint(name: str) -> bool:
    """Return whether an input is one of a device."""
    return "." in name


def numbered(pier: Pier, restraints: Sequence[Restraint]) -> dict[str, Parameter]:
    """Return all parameters of devices that have a value, by names with numbers: "damper_1.f"."""
    parameters_by_name: dict[str, Parameter] = {}
    counts: Counter[str] = Counter()
    given_by = fields_of(pier)
    for place, device in enumerate(restraints):
        table, kind = device.what, device.kind if isinstance(device, Damper) else device.what
        counts[table] += 1
        for key in KEYS_OF[kind]:
            if key in given_by and getattr(device, given_by[key][0]) != math.inf:
                parameters_by_name[f"{table}_{counts[table]}.{key}"] = Parameter(place, *given_by[key])
    return parameters_by_name


def parameters(pier: Pier, restraints: Sequence[Restraint]) -> dict[str, Parameter]:
    """Return :func:`numbered` ones; those that only one damper or tendon has go without a number, too."""
    by_number = numbered(pier, restraints)
    counts = Counter(map(_plain, by_number))
    return by_number | {_plain(name): place for name, place in by_number.items() if counts[_plain(name)] == 1}


def _plain(name: str) -> str:
    return re.sub(r"_[0-9]+\.", ".", name)


def values_of_devices(pier: Pier, restraints: Sequence[Restraint]) -> dict[str, float]:
    """Return the values of all :func:`parameters`."""
    return {
        name: getattr(restraints[place], field) * divisor
        for name, (place, field, divisor) in parameters(pier, restraints).items()
    }


def with_values(pier: Pier, restraints: Sequence[Restraint], values: Mapping[str, float]) -> tuple[Restraint, ...]:
    """Return the devices with other values of such parameters, under the pier as it is at that point."""
    places, changed = parameters(pier, restraints), list(restraints)
    for name, value in values.items():
        place, field, divisor = places[name]
        change: dict[str, Any] = {field: value / divisor}
        changed[place] = replace(changed[place], **change)
    return tuple(changed)


def unclear(names: Iterable[str], case: Case) -> dict[str, str]:
    """Return by name what is ambiguous about inputs of devices in this case, and what to write instead."""
    numbers = numbered(case.pier, case.base.restraints)
    problems: dict[str, str] = {}
    fixed: dict[tuple[int, str], str] = {}
    for name in filter(is_of_restraint, names):
        fitting = [number for number in numbers if name in (number, _plain(number))]
        if len(fitting) > 1:
            problems[name] = f"{name}: case {shown(case.name)} has {len(fitting)} of them; write {' or '.join(fitting)}"
        elif fitting and (first := fixed.setdefault(numbers[fitting[0]][:2], name)) != name:
            problems[name] = f"{first} and {name} are given, which fix the same; keep one"
    return problems


def why_none(name: str, cases: Iterable[Case]) -> str:
    """Return why no case has this parameter of a device."""
    table, key = name.split(".")
    match = TABLE.fullmatch(table)
    what, number = match.groups() if match else (table, None)
    most, kinds, heavy = 0, set(), False
    for case in cases:
        devices = [device for device in case.base.restraints if device.what == what]
        most, heavy = max(most, len(devices)), heavy or case.pier.mass_t is not None
        kinds |= {device.kind for device in devices if isinstance(device, Damper)}
    if not most:
        return f"no case of the study has a {what}"
    if number is not None and int(number) > most:
        return f"no case of the study has a {what} {number}"
    if key in IN_KN and not heavy:
        return "it goes with a pier of known mass (mass_t)"
    if what == "damper" and not any(key in KEYS_OF[kind] for kind in kinds):
        return "it goes with kind = " + " or ".join(shown(kind) for kind, keys in KEYS_OF.items() if key in keys)
    if key == "yield_kN":
        return "it goes with a tendon that yields; give its yield_kN in the case"
    return f"no {what} of that number has it"


def in_words(problem: Problem, values: Mapping[str, Any]) -> tuple[str, str]:
    """Return a problem of a base or of a device in terms of the input that it is about, and the input's name."""
    symbol = problem.key
    mine = [name for name in values if problem.place and name.startswith(problem.place)]
    if name := next((name for name in mine if name.endswith(f".{symbol}")), ""):
        return str(replace(problem, key=name, place="")), name
    symbols = IN_KILONEWTONS | {name: FIELD_OF[name.partition(".")[2]].replace("lam", "lambda") for name in mine}
    fitting = [name for name in mine or values if symbols.get(name) == symbol]
    name = next(iter(fitting or mine), symbol)
    return (str(problem) if name == symbol else f"{name} = {values[name]:g} means {problem}"), name
