"""Parameters of devices as inputs of a sensitivity study: damper.f, or damper_2.f where several have one."""

import math
import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from rockbatch.common.errors import InputError, Problem, refuse
from rockbatch.common.showing import shown
from rockbatch.pier import Pier, Restraint, fields_of
from rockbatch.study.restraint_keys import FIELD_OF, IN_KN, KEYS_OF, RESTRAINTS
from rockbatch.study.spec import Case
from rockbatch.toml.section import fix_the_same

IN_KILONEWTONS = {"stiffness_kN_m": "beta", "yield_kN": "eta"}
"""Inputs in kN, of a pier of known mass, and the ratio of the base that each becomes."""

TABLE = re.compile(rf"({'|'.join(RESTRAINTS)})(?:_([1-9][0-9]*))?")
"""Table of an input: "damper" for the only one of its kind, "damper_2" for the second of the case."""


class Parameter(NamedTuple):
    """A parameter of a device: the device's index in the base, its field, and the ratio of the key's value to the field's."""

    place: int
    field: str
    divisor: float


def is_of_restraint(name: str) -> bool:
    """Return whether the name of an input is that of a device's parameter, as "damper.f": it has a dot."""
    return "." in name


def numbered(pier: Pier, restraints: Sequence[Restraint]) -> dict[str, Parameter]:
    """Return all parameters of devices that are finite, with their places and fields, by names with numbers: "damper_1.f".

    Those in kN are of a pier of known mass only.
    """
    parameters_by_name: dict[str, Parameter] = {}
    counts: Counter[str] = Counter()
    given_by = fields_of(pier)
    for place, device in enumerate(restraints):
        table = device.what
        counts[table] += 1
        for key in KEYS_OF[device.law]:
            if key in given_by and getattr(device, given_by[key][0]) != math.inf:
                parameters_by_name[f"{table}_{counts[table]}.{key}"] = Parameter(place, *given_by[key])
    return parameters_by_name


def parameters(pier: Pier, restraints: Sequence[Restraint]) -> dict[str, Parameter]:
    """Return the :func:`numbered` parameters, and those that only one device has also without its number: "damper.f"."""
    by_number = numbered(pier, restraints)
    counts = Counter(map(_without_number, by_number))
    return by_number | {
        _without_number(name): place for name, place in by_number.items() if counts[_without_number(name)] == 1
    }


def _without_number(name: str) -> str:
    """Return "damper.f" for "damper_2.f"."""
    return re.sub(r"_[0-9]+\.", ".", name)


def _tables(name: str) -> tuple[str, str]:
    """Return the table of an input with its number and without: "damper_2" and "damper" for "damper_2.f"."""
    return name.partition(".")[0], _without_number(name).partition(".")[0]


def values_of_devices(pier: Pier, restraints: Sequence[Restraint]) -> dict[str, float]:
    """Return the values of all :func:`parameters` by name, in the units of their keys."""
    return {
        name: getattr(restraints[place], field) * divisor
        for name, (place, field, divisor) in parameters(pier, restraints).items()
    }


def with_values(pier: Pier, restraints: Sequence[Restraint], values: Mapping[str, float]) -> tuple[Restraint, ...]:
    """Return the devices with ``values`` by names of :func:`parameters`, in the units of their keys; ``pier`` converts kN.

    Raises ``InputError`` for an impossible value, with the table of its name, such as "damper_2", as the place.
    """
    places, changed = parameters(pier, restraints), list(restraints)
    for name, value in values.items():
        place, field, divisor = places[name]
        change: dict[str, Any] = {field: value / divisor}
        try:
            changed[place] = replace(changed[place], **change)
        except InputError as error:
            refuse(replace(problem, place=_tables(name)[0]) for problem in error.problems)
    return tuple(changed)


def unclear(names: Iterable[str], case: Case) -> dict[str, str]:
    """Return, by name, a message for each input of devices that is ambiguous in this case, or fixes what an earlier one does."""
    numbers = numbered(case.pier, case.base.restraints)
    problems: dict[str, str] = {}
    fixed: dict[tuple[int, str], str] = {}
    for name in filter(is_of_restraint, names):
        fitting = [number for number in numbers if name in (number, _without_number(number))]
        if len(fitting) > 1:
            problems[name] = f"{name}: case {shown(case.name)} has {len(fitting)} of them; write {' or '.join(fitting)}"
        elif fitting and (first := fixed.setdefault(numbers[fitting[0]][:2], name)) != name:
            problems[name] = fix_the_same(first, name)
    return problems


def why_none(name: str, cases: Iterable[Case]) -> str:
    """Return the reason why no case has this parameter of a device, "damper_2.f", without asking whether one has."""
    table, key = name.split(".")
    ((what, number),) = TABLE.findall(table)
    most, kinds, heavy = 0, set(), False
    for case in cases:
        devices = [device for device in case.base.restraints if device.what == what]
        most, heavy = max(most, len(devices)), heavy or case.pier.mass_t is not None
        kinds |= {device.law for device in devices}
    if not most:
        return f"no case of the study has a {what}"
    if number and int(number) > most:
        return f"no case of the study has a {what} {number}"
    if key in IN_KN and not heavy:
        return "it goes with a pier of known mass (mass_t)"
    if what == "damper" and not any(key in KEYS_OF[kind] for kind in kinds):
        return "it goes with kind = " + " or ".join(shown(kind) for kind, keys in KEYS_OF.items() if key in keys)
    if key == "yield_kN":
        return "it goes with a tendon that yields; give its yield_kN in the case"
    return f"no {what} of that number has it"


def in_words(problem: Problem, values: Mapping[str, float]) -> tuple[str, str]:
    """Return a problem of a base or a device in terms of the input in ``values`` that caused it, and the input's name.

    The name is the problem's own key if no input became it.
    """
    symbol = problem.key
    mine = [name for name in values if is_of_restraint(name) and problem.place in _tables(name)]
    if name := next((name for name in mine if name.endswith(f".{symbol}")), ""):
        return str(replace(problem, key=name, place="")), name
    symbols = IN_KILONEWTONS | {name: FIELD_OF[name.partition(".")[2]].replace("lam", "lambda") for name in mine}
    fitting = [name for name in mine or values if symbols.get(name) == symbol]
    name = next(iter(fitting or mine), symbol)
    return (str(problem) if name == symbol else f"{name} = {values[name]:g} means {problem}"), name
