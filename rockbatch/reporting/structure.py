"""The pier, base and devices of a case, rebuilt from run.json, and devices in words."""

import math
from collections.abc import Iterable
from dataclasses import fields, replace
from functools import lru_cache
from typing import Any

from rockbatch.common.errors import InputError
from rockbatch.pier import (
    Base,
    DeckSpring,
    Pier,
    Restraint,
    RigidBase,
    fields_of,
    problems,
    restraint_of,
)
from rockbatch.pier.bases import BASES
from rockbatch.pier.first_loading import STEEL_EXPONENT
from rockbatch.pier.plausibility import wrong_restraints
from rockbatch.pier.sizes import USUAL as OF_PIER
from rockbatch.pier.traits import USUAL as OF_BASE
from rockbatch.quantities.cases import Case
from rockbatch.quantities.design import BOUND
from rockbatch.quantities.labels import DEVICE_SYMBOLS, assigned, titled, unit_with_exponent
from rockbatch.study.restraint_keys import KEYS_OF

_PIER = (
    "alpha",
    "p",
    "mu",
    "gravity",
    "mass_t",
    "top_m",
    "deck_over_columns",
    "deck_height_m",
    "flexural_period_s",
    "initial_rotation_rad",
)
_PREFERRED = {
    "brace": "brace_kN_m",
    "f": "force_kN",
    "nu": "coefficient_kN_s_m",
    "psi": "prestress_kN",
    "lambda": "stiffness_kN_m",
}
"""Keys without units, and the equivalent ones with units, for a pier whose mass is known."""
_STOPS = ("stop", "deck_spring")
_OF_STOP = {"stiffness_kN_m": ("k", "kN/m")}


def names_of(cases: Iterable[Case]) -> list[str]:
    """Return the names of cases that share something, in order; with its bound if the nominal design is not among them."""
    bounds: dict[str, dict[str, None]] = {}
    for case in cases:
        bounds.setdefault(str(case["case"]), {})[str(case["columns"].get(BOUND, ""))] = None
    return [titled(name, [] if "" in of_case else of_case) for name, of_case in bounds.items()]


def pier_of(case: Case) -> Pier | None:
    """Return the pier of a case; None for impossible values, since run.json is untrusted."""
    values = {name: case["pier"][name] for name in _PIER if case["pier"].get(name) is not None}
    if "highest_m" in case["pier"]:  # the deck may be the highest point; parts are not in run.json
        values.setdefault("deck_height_m", case["pier"]["highest_m"])
    try:
        return _pier(**values)
    except (InputError, TypeError, ValueError):
        return None


@lru_cache(maxsize=1024, typed=True)  # many sections ask for the pier of every case
def _pier(**values: Any) -> Pier:
    return Pier(**values, confirm=tuple(OF_PIER))


def restraints_of(case: Case) -> tuple[Restraint, ...]:
    """Return the devices of a case; () without any, and for impossible values of the pier or of any device."""
    entries, pier = case["parameters"].get("restraints"), pier_of(case)
    if not isinstance(entries, list) or pier is None:
        return ()
    try:
        restraints = tuple(map(restraint_of, entries))
        return () if wrong_restraints(pier, restraints) else restraints
    except (KeyError, TypeError, ValueError):
        return ()


def base_of(case: Case, pier: Pier) -> Base | None:
    """Return the base of a case with its devices; None for values that are impossible under ``pier``."""
    kind: type[Base] = BASES[case["base"]]
    values = case["parameters"]
    names = [field.name for field in fields(kind) if field.name not in ("restraints", "confirm")]
    try:
        base = kind(**{name: values[name] for name in names if values.get(name) is not None}, confirm=tuple(OF_BASE))
        base = replace(base, restraints=restraints_of(case))
    except (InputError, TypeError, ValueError):
        return None
    # Check as if the shaft were rigid: run.json lacks the mass distribution that an elastic one needs
    rigid = replace(base, shaft="rigid") if isinstance(base, RigidBase) else base
    return None if problems(pier, rigid) else base


def device_in_words(pier: Pier, restraint: Restraint, digits: int = 4) -> str:
    """Describe a device: "friction damper at each pivot, F = 450 kN"; over the weight if the pier's mass is not known.

    Infinite values are left out. A hysteretic damper ends with the exponent n of its law.
    """
    fields = fields_of(pier)
    values = {}
    for key in KEYS_OF[restraint.law]:
        if key in fields and _PREFERRED.get(key) not in fields:
            field, divisor = fields[key]
            values[key] = getattr(restraint, field) * divisor
    power = values.pop("exponent", 1.0) if "coefficient_kN_s_m" in values else 1.0
    names = DEVICE_SYMBOLS | _OF_STOP if restraint.what in _STOPS else DEVICE_SYMBOLS
    numbers = [
        assigned(names[key][0], value, unit_with_exponent(names[key][1], power), digits)
        for key, value in values.items()
        if value < math.inf
    ]
    numbers += [f"n\u00a0=\u00a0{STEEL_EXPONENT:g}"] if restraint.law == "hysteretic" else []
    return ", ".join([f"{restraint.words} {_place(restraint)}", *numbers])


def devices_in_words(case: Case, digits: int = 4) -> list[str]:
    """Return the devices of a case in words, one text each; [] without devices or for impossible values."""
    pier = pier_of(case)
    return [device_in_words(pier, device, digits) for device in restraints_of(case)] if pier else []


def _place(restraint: Restraint) -> str:
    """Return where a device acts: "at each pivot", "0.4 m right of the axis", "on the left, 3 m high"."""
    if isinstance(restraint, DeckSpring):
        height = "" if restraint.height_m is None else f", {restraint.height_m:g} m high"
        return ("on both sides" if restraint.side == "both" else f"on the {restraint.side}") + height
    if restraint.at is None:
        return "at each pivot"
    if restraint.at == "deck":
        return "at the deck"
    if isinstance(restraint.at, str):
        return f"at the {restraint.at} pivot"
    if restraint.at == 0:
        return "on the axis"
    return f"{abs(restraint.at):g} m {'right' if restraint.at > 0 else 'left'} of the axis"
