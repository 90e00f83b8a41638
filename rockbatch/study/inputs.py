"""Inputs of analyses that vary a case: quantities of its pier, its base and its devices, by the keys of a study file."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, replace

from rockbatch.common.errors import InputError, Problem
from rockbatch.common.showing import shown
from rockbatch.pier import beta_of, eta_of, in_kilonewtons, problems
from rockbatch.study.case_keys import CASE
from rockbatch.study.load import Study
from rockbatch.study.piers import PIER
from rockbatch.study.restraint_inputs import (
    IN_KILONEWTONS,
    in_words,
    is_of_restraint,
    values_of_devices,
    why_none,
    with_values,
)
from rockbatch.study.restraint_keys import DEVICES
from rockbatch.study.spec import Case
from rockbatch.toml.kinds import KeyValues, Kind
from rockbatch.toml.section import Key

OF_PIER = ("alpha", "p", "mu")

_RANGES: dict[str, tuple[Mapping[str, Key], dict[str, str]]] = {
    "": (
        {**PIER, **CASE},
        {
            "alpha": "[0.12, 0.16]",
            "p": "[0.3, 0.5]",
            "mu": "[2.5, 3.5]",
            "restitution": "[0.85, 0.95]",
            "beta": "[30, 90]",
            "epsilon": "[0.05, 0.3]",
            "zeta": "[0.02, 0.1]",
            "eta": "[2.0, 4.0]",
            "n": "[2, 8]",
            "stiffness_kN_m": "[1e6, 4e6]",
            "yield_kN": "[3e4, 6e4]",
        },
    ),
    "damper": (
        DEVICES["damper"],
        {
            "force_kN": "[300.0, 600.0]",
            "f": "[0.01, 0.05]",
            "yield_mm": "[3.0, 8.0]",
            "coefficient_kN_s_m": "[500.0, 2000.0]",
            "nu": "[0.2, 0.8]",
            "exponent": "[0.3, 1.0]",
            "brace_kN_m": "[1.0e5, 4.0e5]",
            "brace": "[2.0, 10.0]",
        },
    ),
    "tendon": (
        DEVICES["tendon"],
        {
            "prestress_kN": "[3000.0, 6000.0]",
            "psi": "[0.2, 0.8]",
            "stiffness_kN_m": "[2.0e4, 8.0e4]",
            "yield_kN": "[8000.0, 1.2e4]",
            "lambda": "[0.5, 2.0]",
        },
    ),
    "stop": (
        DEVICES["stop"],
        {
            "gap_mm": "[80.0, 120.0]",
            "stiffness_kN_m": "[2.0e5, 1.0e6]",
            "lambda": "[10.0, 40.0]",
            "restitution": "[0.4, 0.8]",
        },
    ),
    "deck_spring": (
        DEVICES["deck_spring"],
        {
            "gap_mm": "[20.0, 60.0]",
            "stiffness_kN_m": "[2.0e4, 1.0e5]",
            "lambda": "[0.1, 0.5]",
            "restitution": "[0.4, 0.8]",
        },
    ),
}
"""Keys of a pier and its case, and of its devices, that have ranges, with examples."""


def ranges(of: str = "", kind: Kind | None = None) -> dict[str, Key]:
    """Return the keys that analyses may vary, each as a pair of ends: those of a case, or ``of`` a device such as "damper".

    Their values are of the ``kind`` given, or of that of the study.
    """
    keys, examples = _RANGES[of]
    return {
        name: Key(kind or keys[name].kind, example, keys[name].words, pair=True) for name, example in examples.items()
    }


def varied(case: Case, values: KeyValues) -> Case:
    """Return the case with other ``values`` of its pier, base and devices, by names of :func:`values_of`; unusual ones pass.

    Raises :class:`InputError` for impossible ones.
    """
    arguments = dict(values)
    of_pier = {name: arguments.pop(name) for name in OF_PIER if name in arguments}
    # The author of the study means its ranges: none of their values needs to be confirmed
    pier = replace(case.pier, **of_pier, confirm=(*case.pier.confirm, *of_pier, "mass_t"))
    for name, ratio in IN_KILONEWTONS.items():
        if name in arguments:
            arguments[ratio] = (beta_of if ratio == "beta" else eta_of)(pier, arguments.pop(name))
    of_restraints = {name: arguments.pop(name) for name in list(arguments) if is_of_restraint(name)}
    if of_restraints:
        arguments["restraints"] = with_values(pier, case.base.restraints, of_restraints)
    return replace(case, pier=pier, base=replace(case.base, **arguments, confirm=(*case.base.confirm, *arguments)))


def values_of(case: Case) -> KeyValues:
    """Return α, p and μ, all fields of the base and, to twelve digits, the parameters of its devices, by key.

    Without ε where it does not apply and ζ if not given; with stiffness and strength in kN if the mass is known.
    """
    pier = {name: getattr(case.pier, name) for name in OF_PIER}
    base = {field.name: getattr(case.base, field.name) for field in fields(case.base)}
    if base.get("zeta") is None:
        base.pop("zeta", None)
    if not case.base.has_epsilon:
        base.pop("epsilon", None)
    derived = in_kilonewtons(case.pier, case.base) | values_of_devices(case.pier, case.base.restraints)
    # To the digits in which studies are written, so that a range may end at the study's own value
    return pier | base | {name: float(f"{value:.12g}") for name, value in derived.items()}


def impossible(case: Case, values: KeyValues) -> list[tuple[str, str]]:
    """Return the problems of the case with other values, each a sentence and the name of its input; [] if they are possible."""
    try:
        changed = varied(case, values)
        wrong: Sequence[Problem] = problems(changed.pier, changed.base)
    except InputError as error:
        wrong = error.problems
    return [in_words(problem, values) for problem in wrong]


def _outwards(value: float, side: int) -> float:
    """Return an end of a range with four digits at most: rounded down if ``side`` is −1, that of the lower end, up if it is 1."""
    nearest = float(f"{value:.4g}")
    if side * nearest >= side * value:
        return nearest
    return float(f"{nearest + side * 10.0 ** (math.floor(math.log10(abs(value))) - 3):.4g}")


def outside(name: str, ends: Sequence[float], values: Iterable[tuple[str, float | None]]) -> str:
    """Return a message with a wider range if a case, of these names and ``values``, is outside the range ``ends``; "" if none is.

    A value of None is in any range.
    """
    low, high = ends
    missed = [(case, value) for case, value in values if value is not None and not low <= value <= high]
    if not missed:
        return ""
    (case, value), *others = missed
    least, most = (end(value for _, value in missed) for end in (min, max))
    wider = [low if low <= least else _outwards(least, -1), high if high >= most else _outwards(most, 1)]
    beside = f", and {len(others)} more" if others else ""
    return f'{name} = {shown([low, high])}: does not hold the {value:g} of case "{case}"{beside}; write {name} = {shown(wider)}'


def why_no_case(name: str, study: Study) -> str:
    """Return the reason why no case of the study has this input, without asking whether one has."""
    if is_of_restraint(name):
        return why_none(name, study.cases)
    if name in IN_KILONEWTONS:
        return "it goes with a pier of known mass (mass_t) on springs"
    if name in ("epsilon", "zeta") and any(case.base.on_springs for case in study.cases):
        if name == "zeta":
            return "it goes with springs that have one; write zeta in the case"
        return 'zeta or impact = "housner" takes its place'
    return "no case of the study has it"
