"""Dampers and tendons of a case: [[case.damper]], and [case.tendon] or [[case.tendon]]."""

from collections.abc import Mapping, Sequence
from typing import Any, get_args

from rockbatch.pier import Damper, DamperKind, Pier, Restraint, Tendon, doubt, remedy
from rockbatch.study.lists import Chosen, listed
from rockbatch.study.piers import has_mass
from rockbatch.study.plausible import CONFIRM, confirmed
from rockbatch.toml.kinds import KindError, choice, not_negative, number, positive, shown
from rockbatch.toml.reader import Key, Setting, Table


def _place(value: Any) -> float | str:
    if isinstance(value, str) and value in ("left", "right"):
        return value
    if isinstance(value, str):
        raise KindError('"left", "right" or an offset from the middle of the base in m')
    return number(value)


DAMPER = {
    "kind": Key(choice(*get_args(DamperKind)), '"friction"', required=True),
    "force_kN": Key(positive, "450.0", many=True),
    "f": Key(not_negative, "0.02", many=True),
    "yield_mm": Key(positive, "5.0", many=True),
    "coefficient_kN_s_m": Key(not_negative, "900.0", many=True),
    "nu": Key(not_negative, "0.5", many=True),
    "exponent": Key(positive, "0.5", many=True),
    "at": Key(_place, '"left"'),
}
TENDON = {
    "prestress_kN": Key(not_negative, "5000.0", many=True),
    "psi": Key(not_negative, "0.5", many=True),
    "stiffness_kN_m": Key(not_negative, "40000.0", many=True),
    "lambda": Key(not_negative, "1.0", many=True),
    "yield_kN": Key(positive, "9000.0", many=True),
    "at": Key(_place, "0.0"),
}
RESTRAINTS = ("damper", "tendon")

IN_KN = ("force_kN", "coefficient_kN_s_m", "prestress_kN", "stiffness_kN_m", "yield_kN")
_PULLS = (("prestress_kN", "psi"), ("stiffness_kN_m", "lambda"))
_FIELDS = {
    "coefficient_kN_s_m": "nu", "yield_mm": "yield_m", "prestress_kN": "psi", "stiffness_kN_m": "lam", "lambda": "lam",
}  # fmt: skip
_BELONG = {  # keys of a damper of each kind: those of which one is needed, then the others
    "friction": (("force_kN", "f"), ()),
    "hysteretic": (("force_kN", "f"), ("yield_mm",)),
    "viscous": (("coefficient_kN_s_m", "nu"), ("exponent",)),
}
KEYS_OF = {kind: (*either, *others) for kind, (either, others) in _BELONG.items()} | {
    "tendon": tuple(name for name in TENDON if name != "at")
}
"""Keys with numbers of a damper of each kind, and of a tendon."""


def fields_of(pier: Pier) -> dict[str, tuple[str, float]]:
    """The field of Damper or Tendon that each key gives, and the key's value over the field's; in kN where the mass is known."""
    found = {name: (name, 1.0) for name in ("f", "nu", "exponent", "psi")}
    found |= {"yield_mm": ("yield_m", 1000.0), "lambda": ("lam", 1.0)}
    if pier.mass_t is not None:
        weight = pier.mass_t * pier.gravity
        found |= {
            "force_kN": ("f", weight),
            "coefficient_kN_s_m": ("nu", weight * pier.p / pier.gravity),
            "prestress_kN": ("psi", weight),
            "stiffness_kN_m": ("lam", weight * pier.size / pier.half_width**2),
            "yield_kN": ("strength", weight),
        }
    return found


def read_restraints(case: Table) -> tuple[dict[str, Sequence[Setting]], tuple[str, ...]]:
    """Settings of all dampers and tendons of a case, by names that set them apart, and which of them are lists."""
    read: dict[str, Sequence[Setting]] = {}
    varied: tuple[str, ...] = ()
    for what, keys in (("damper", DAMPER), ("tendon", TENDON)):
        for n, table in enumerate(_tables(case, what), 1):
            found = table.read(keys | CONFIRM)
            believed = confirmed(table, found, keys)
            if believed:
                read[f"{what}_{n}_confirm"] = [Setting(tuple(_FIELDS.get(name, name) for name in believed), table.at)]
            for name, value in found.items():
                read[f"{what}_{n}_{name}"] = value if isinstance(value, list) else [Setting(value, (*table.at, name))]
            varied += tuple(f"{what}_{n}_{name}" for name in listed(table, keys))
            if what == "damper":
                _check_damper(table, found.get("kind"))
            else:
                _check_pairs(table, _PULLS)
                if not table.data.keys() & {name for pair in _PULLS for name in pair}:
                    table.complain(
                        "it has neither prestress nor stiffness, so that it is not there; write for example prestress_kN = "
                        f"{TENDON['prestress_kN'].example}, or leave the table out"
                    )
            _check_mass(table)
    return read, varied


def _tables(case: Table, what: str) -> list[Table]:
    """One table, or several."""
    if isinstance(case.data.get(what), dict):
        return [Table(case.file, (*case.at, what), f"[case.{what}]", case.data[what])]
    return case.file.tables(*case.at, what, title="kind")


def _check_damper(table: Table, kind: str | None) -> None:
    if kind is None:
        return
    either, others = _BELONG[kind]
    for name in table.data.keys() & DAMPER.keys() - {"kind", "at", *either, *others}:
        table.complain(f"{name}: does not apply to kind = {shown(kind)}; leave it out", name)
    if not table.data.keys() & set(either):
        table.complain(
            f"{either[0]} is missing; write for example {either[0]} = {DAMPER[either[0]].example}, or {either[1]}"
        )
    _check_pairs(table, (either,))
    if kind == "hysteretic" and "yield_mm" not in table.data:
        table.complain('yield_mm is missing; write for example yield_mm = 5.0, or kind = "friction", its limit')


def _check_pairs(table: Table, pairs: Sequence[Sequence[str]]) -> None:
    for one, other in pairs:
        if one in table.data and other in table.data:
            table.complain(f"{one} and {other} are given, which fix the same; keep one", other)


def _check_mass(table: Table) -> None:
    for name in IN_KN:
        if name in table.data and not has_mass(table.file):
            table.complain(f"{name}: kN are of a pier whose mass is known; write mass_t in [pier]", name)


def restraints_of(pier: Pier, given: dict[str, Any]) -> tuple[Restraint, ...]:
    """Dampers and tendons by the settings of :func:`read_restraints`, which are taken out of ``given``."""
    taken = _taken(given)
    for name in [name for name in given if name.startswith(tuple(f"{what}_" for what in RESTRAINTS))]:
        del given[name]
    return tuple(_restraint(values, pier) for values in taken.values())


def _taken(given: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The settings of each damper and tendon: those of the first damper under "damper_1"."""
    taken: dict[str, dict[str, Any]] = {}
    for name, value in given.items():
        if name.startswith(tuple(f"{what}_" for what in RESTRAINTS)):
            what, n, key = name.split("_", 2)
            taken.setdefault(f"{what}_{n}", {})[key] = value
    return {name: values for name, values in taken.items() if name.startswith("tendon") or "kind" in values}


def complain_of_unlikely(case: Table, chosen: Chosen, pier: Pier, restraints: Sequence[Restraint]) -> None:
    """Note every value of a damper or tendon that is far from usual and not confirmed, at its key."""
    for (name, values), each in zip(_taken(chosen).items(), restraints, strict=True):
        odd = doubt(pier, each)
        if odd is None:
            continue
        key = next((key for key in values if _FIELDS.get(key, key) == odd.name), "")
        if key:
            what, value = name.partition("_")[0], values[key]
            case.complain_about(
                value, f"{what}: {key} = {value.value:g}: {odd.meaning}; {remedy(key)} in [[case.{what}]]"
            )


def _restraint(values: Mapping[str, Any], pier: Pier) -> Restraint:
    own = {name: values[name] for name in ("kind", "at", "confirm") if name in values}
    own |= {field: values[key] / over for key, (field, over) in fields_of(pier).items() if key in values}
    if "kind" not in values:
        return Tendon(**own)
    if values["kind"] == "hysteretic":
        own.setdefault("yield_m", 0.001)  # missing, which is noted: a possible value lets the rest be checked
    return Damper(**own)
