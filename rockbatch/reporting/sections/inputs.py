"""Every constant of the study: piers and their parts, foundations and devices, as given and as derived from it."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rockbatch.common.units import unit_in_words, unit_of
from rockbatch.pier import Pier, Restraint
from rockbatch.pier.devices import FIELDS
from rockbatch.quantities.cases import Case
from rockbatch.quantities.labels import symbol_of
from rockbatch.reporting.drawings import drawings
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import heading
from rockbatch.reporting.markup import Markup, join, number, tag
from rockbatch.reporting.structure import device_in_words, names_of, pier_of, restraints_of
from rockbatch.reporting.table import WHOLE, Head, table
from rockbatch.results.labelled import Row

DIGITS = ".6g"
OF_PIER = {
    "size_m": ("R0", "m"),
    "half_width_m": ("half-width b", "m"),
    "height_m": ("centre of mass at", "m"),
    "highest_m": ("highest point", "m"),
    "top_m": ("drift read at", "m"),
    "mass_t": ("mass", "t"),
    "deck_height_m": ("deck at", "m"),
    "deck_over_columns": ("deck over columns", ""),
    "flexural_period_s": ("flexural period", "s"),
    "shaft_share": ("share of the shaft in the mass", ""),
}
"""Heads and units of values of a pier in run.json whose names mean something else in a study, or nothing."""
OF_FOUNDATION = {
    "omega_v": ("ω_v", "rad/s"),
    "delta_s_m": ("static deflection", "m"),
    "delta_y_m": ("yield deflection", "m"),
    "zeta_rocking": ("ζ of rocking", ""),
}
OF_DEVICE = {
    "f": ("F/(M g)", ""),
    "nu": ("C/(M p)", ""),
    "yield_m": ("yield displacement", "m"),
    "exponent": ("exponent", ""),
    "brace": ("brace λ", ""),
    "psi": ("P0/(M g)", ""),
    "lam": ("λ = k b²/(M g R0)", ""),
    "strength": ("Ty/(M g)", ""),
    "gap_m": ("gap", "m"),
    "restitution": ("restitution e", ""),
    "height_m": ("height", "m"),
}
"""Fields of devices, their heads and units, in the order of the table."""


def section(finished: Finished) -> Markup:
    """Return drawings of the piers, and tables: pier, parts and cases as given, piers as computed, foundations and devices.

    Empty tables are left out.
    """
    tables: tuple[tuple[str, list[Row], Mapping[str, tuple[str, str]]], ...] = (
        ("Pier as given", [finished.pier_as_given], {}),
        ("Parts of the pier", _parts(finished), {}),
        ("Cases as given", _cases(finished), {}),
        ("Pier as computed", _piers(finished), OF_PIER),
        ("Foundations", [_foundation(finished, case) for case in finished.info["cases"]], OF_FOUNDATION),
        ("Devices", list(_devices(finished)), OF_DEVICE),
    )
    shown = [join(tag("h3", name), of_rows(rows, name, heads)) for name, rows, heads in tables if any(rows)]
    return join(drawings(finished), *shown)


def of_rows(rows: Sequence[Mapping[str, object]], name: str, words: Mapping[str, tuple[str, str]]) -> Markup:
    """Return a table of constants with a column for each key that has a number or text in any row.

    A column is headed by the entry of its key in ``words``, or by symbol and unit.
    """
    keys = [
        key for key in dict.fromkeys(key for row in rows for key in row) if any(_single(row.get(key)) for row in rows)
    ]
    named = [(key, *(words.get(key) or symbol_and_unit(key))) for key in keys]
    heads = [Head(heading(symbol), _form(rows, key), unit=unit) for key, symbol, unit in named]
    cells = ([_written(row.get(key)) for key in keys] for row in rows)
    return table(heads, cells, name=name, prose=True)


def symbol_and_unit(key: str) -> tuple[str, str]:
    """Return symbol and unit of a key, ("p", "rad/s").

    Of a key without a symbol it is its words, and the unit at its end if any: ("toe level", "m") of "toe_level_m".
    """
    symbol, unit = symbol_of(key)
    if (symbol, unit) != (key, ""):
        return symbol, unit
    ending = unit_of(key)
    return key.removesuffix(f"_{ending}").replace("_", " "), unit_in_words(ending)


def _form(rows: Sequence[Mapping[str, object]], key: str) -> str:
    """Return the format of a column: six digits if a value is a float, else :data:`WHOLE`."""
    return DIGITS if any(isinstance(row.get(key), float) for row in rows) else WHOLE


def _single(value: object) -> bool:
    """Return whether a value is a number or a text, or a list, not empty, of only these, nested or not."""
    if isinstance(value, list):
        return bool(value) and all(map(_single, value))
    return isinstance(value, int | float | str)


def _written(value: object) -> object:
    """Return a value as a cell: a list as its values with commas, a single true or false in lower case; None for TOML tables."""
    if not _single(value):
        return None
    if isinstance(value, list):
        return ", ".join(number(item, DIGITS) if isinstance(item, float) else str(item) for item in value)
    return str(value).lower() if isinstance(value, bool) else value


def _parts(finished: Finished) -> list[Row]:
    """Return each [[pier.part]] of the study as its keys and values; [] if it has none."""
    parts = finished.pier_as_given.get("part")
    return [part for part in parts if isinstance(part, dict)] if isinstance(parts, list) else []


def _cases(finished: Finished) -> list[Row]:
    """Return each [[case]] of the study as its keys and values, its name first; devices have a table of their own."""
    return [
        {"case": case.get("name", "")} | {k: v for k, v in case.items() if k != "name"}
        for case in finished.cases_as_given
    ]


def _piers(finished: Finished) -> list[Row]:
    """Return each distinct pier as run.json has it, under ``case`` with the names of its cases if piers differ."""
    cases_of: dict[tuple[object, ...], list[Case]] = {}
    for case in finished.info["cases"]:
        cases_of.setdefault(tuple(case["pier"].items()), []).append(case)
    piers = []
    for of_pier in cases_of.values():
        names = ", ".join(names_of(of_pier))
        piers.append(({"case": names} if len(cases_of) > 1 else {}) | of_pier[0]["pier"])
    return piers


def _foundation(finished: Finished, case: Case) -> Row:
    """Return the name of a foundation as ``case``, its ``base``, and every parameter but its devices by its key."""
    parameters = {key: value for key, value in case["parameters"].items() if key != "restraints"}
    return {"case": _name(finished, case), "base": case["base"]} | parameters


def _devices(finished: Finished) -> Iterator[Row]:
    """Yield each device of each case: in words, in kN if the mass is known, and by its numbers over the weight."""
    for case in finished.info["cases"]:
        pier = pier_of(case)
        for device in restraints_of(case) if pier else ():
            yield {"case": _name(finished, case), "device": _in_words(pier, device)} | _numbers(device)


def _in_words(pier: Pier | None, device: Restraint) -> str:
    return device_in_words(pier, device) if pier else ""


def _numbers(device: Restraint) -> dict[str, Any]:
    """Return the fields that a device uses; those that are infinite or not given are left out."""
    used = {*FIELDS[device.law], "strength", "brace", "height_m"}
    values = {name: getattr(device, name, None) for name in OF_DEVICE if name in used}
    return {name: value for name, value in values.items() if value is not None and value < float("inf")}


def _name(finished: Finished, case: Case) -> str:
    """Return the name of a case with the values of it that are varied."""
    return finished.named_case(case["case"], case["columns"], finished.info["varied"])
