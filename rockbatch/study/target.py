"""What records are scaled to: ``target`` in [motions], one measure or a whole spectrum."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from rockbatch.errors import InputError
from rockbatch.motions.design_spectra import (
    EUROCODE,
    AsceSpectrum,
    EurocodeSpectrum,
    Spectrum,
    TableSpectrum,
    read_spectrum,
)
from rockbatch.motions.scaling import Target
from rockbatch.motions.spectrum_target import FACTORS, PAIRS, SpectrumTarget
from rockbatch.study.plausible import CONFIRM, TARGETS, complain_unless_usual, confirmed
from rockbatch.study.ranges import range_of
from rockbatch.toml.kinds import KindError, choice, closest, number, positive, shown, text
from rockbatch.toml.reader import Key, Setting, Table

CODES = ("EN 1998-1", "ASCE 7")


def _fraction(value: Any) -> float:
    if not 0 <= number(value) < 1:
        raise KindError("a fraction of critical damping, within 0..1")
    return float(value)


def _entry(value: Any) -> Any:
    """The name of a code or file, or one pair of a table."""
    if isinstance(value, list):
        if len(value) != 2:
            raise KindError("pairs of a period [s] and a spectral acceleration [g]")
        return tuple(positive(each) for each in value)
    if not isinstance(value, str):
        raise KindError("the name of a code or of a file, or pairs of a period [s] and a spectral acceleration [g]")
    return text(value)


def _type(value: Any) -> int:
    if isinstance(value, bool) or value not in (1, 2):
        raise KindError("1 or 2, the type of spectrum")
    return int(value)


_MEASURE = {
    "pga_g": Key(positive, "0.4"),
    "pgv_m_s": Key(positive, "0.5"),
    "sa_g": Key(positive, "0.8"),
    "period_s": Key(positive, "1.0"),
    "damping": Key(_fraction, "0.05"),
}
_EUROCODE = {
    "type": Key(_type, "1"),
    "ground": Key(choice(*EUROCODE[1]), '"B"'),
    "ag_g": Key(positive, "0.25"),
    "soil_factor": Key(positive, "1.2"),
    "tb_s": Key(positive, "0.15"),
    "tc_s": Key(positive, "0.5"),
    "td_s": Key(positive, "2.0"),
}
_ASCE = {
    "sds_g": Key(positive, "1.0"),
    "sd1_g": Key(positive, "0.6"),
    "tl_s": Key(positive, "8.0"),
}
_SPECTRUM = {
    "spectrum": Key(_entry, '"EN 1998-1"', required=True, many=True, distinct=False),
    "period_range_s": Key(positive, "[0.4, 4.0]", required=True, many=True, distinct=False),
    "factors": Key(choice(*FACTORS), '"both"'),
    "pairs": Key(choice(*PAIRS), '"srss"'),
    "at_least": Key(positive, "0.9"),
    "damping": _MEASURE["damping"],
}
TARGET = _MEASURE | {name: replace(key, required=False) for name, key in (_SPECTRUM | _EUROCODE | _ASCE).items()}
"""Every key that a target may have, of one measure or of a spectrum."""

_OWN = {"EN 1998-1": _EUROCODE, "ASCE 7": _ASCE}
_UNFIT_FOR_SPECTRUM = dict.fromkeys(
    ("pga_g", "pgv_m_s", "sa_g", "period_s"), "is for a target of one measure, not for a spectrum; leave it out"
)


def read_target(table: Table) -> Target | SpectrumTarget | None:
    """The target of [motions]; None, with the mistakes noted, where it is no target."""
    return _read_spectrum(table) if "spectrum" in table.data else _read_measure(table)


def _read_measure(table: Table) -> Target | None:
    before = len(table.file.problems)
    read = table.read(
        _MEASURE | CONFIRM,
        unfit=dict.fromkeys((*_SPECTRUM, *_EUROCODE, *_ASCE), "is for a target with spectrum = …"),
    )
    _check_usual(table, read, _MEASURE)
    measures = [name for name in ("pga_g", "pgv_m_s", "sa_g") if name in table.data]
    if len(measures) != 1:
        found = " and ".join(measures) + " are given" if measures else "it is missing what to scale to"
        table.complain(f"{found}; write one of pga_g, pgv_m_s, sa_g with period_s, or spectrum", *measures[1:2])
    elif measures == ["sa_g"] and "period_s" not in table.data:
        table.complain("period_s is missing beside sa_g; write for example period_s = 1.0", "sa_g")
    elif measures != ["sa_g"]:
        for name in ("period_s", "damping"):
            if name in table.data:
                table.complain(f"{name}: is for sa_g only; leave it out", name)
    return Target(**read) if table.file.is_sound_since(before) else None


def _read_spectrum(table: Table) -> SpectrumTarget | None:
    before = len(table.file.problems)
    code = _code(table.data["spectrum"])
    own = _OWN.get(code, {})
    unfit = {
        name: f"is for spectrum = {shown(other)}; leave it out"
        for other, keys in _OWN.items()
        if other != code
        for name in keys
    }
    read = table.read(_SPECTRUM | own | CONFIRM, unfit=unfit | _UNFIT_FOR_SPECTRUM)
    _check_usual(table, read, _SPECTRUM | own)
    limits = range_of(table, "period_range_s", read.get("period_range_s"))
    spectrum = _spectrum(table, code, read) if "spectrum" in read else None
    if not table.file.is_sound_since(before) or spectrum is None or limits is None:
        return None
    own_keys = {name: read[name] for name in ("factors", "pairs", "at_least") if name in read}
    try:
        return SpectrumTarget(spectrum, limits, **own_keys)
    except InputError as error:
        for problem in error.problems:
            table.complain(problem, "period_range_s")
        return None


def _check_usual(table: Table, read: dict[str, Any], keys: Mapping[str, Key]) -> None:
    believed = confirmed(table, read, keys)
    for name in TARGETS.keys() & read.keys():
        complain_unless_usual(table, name, [Setting(read[name], (*table.at, name))], TARGETS[name], believed)


def _code(value: Any) -> str:
    """The code that is meant, however it is written; empty for a table."""
    if not isinstance(value, str):
        return ""
    plain = {name.replace(" ", "").lower(): name for name in CODES}
    return plain.get(value.replace(" ", "").lower(), "")


def _spectrum(table: Table, code: str, read: dict[str, Any]) -> Spectrum | None:
    damping = read.get("damping", 0.05)
    if code == "EN 1998-1":
        return _eurocode(table, read, damping)
    if code == "ASCE 7":
        if damping != 0.05:
            table.complain("damping: the spectrum of ASCE 7 is for 5 %; leave it out", "damping")
        return _asce(table, read)
    entries = [setting.value for setting in read["spectrum"]]
    try:
        if len(entries) == 1 and isinstance(entries[0], str):
            return _of_file(table, entries[0], damping)
        if any(isinstance(entry, str) for entry in entries):
            raise InputError("spectrum: expected one name, or pairs of a period [s] and a spectral acceleration [g]")
        periods, values = zip(*entries, strict=True)
        return TableSpectrum(periods, values, damping, "spectrum")
    except InputError as error:
        for problem in error.problems:
            table.complain(problem, "spectrum")
        return None


def _of_file(table: Table, written: str, damping: float) -> TableSpectrum:
    path = table.file.path.parent / written
    if not path.exists():
        meant = closest(written, CODES)
        hint = f"did you mean {shown(meant)}?" if meant else f"write {' or '.join(map(shown, CODES))}, or a file"
        raise InputError(f"spectrum = {shown(written)}: no such file ({path.resolve()}); {hint}")
    return read_spectrum(path, damping)


def _eurocode(table: Table, read: dict[str, Any], damping: float) -> EurocodeSpectrum | None:
    corners = ("soil_factor", "tb_s", "tc_s", "td_s")
    given = {name: read[name] for name in corners if name in read}
    missing = [name for name in ("ag_g",) if name not in table.data]
    if len(given) < len(corners):
        missing += [name for name in ("type", "ground") if name not in table.data]
    for name in missing:
        table.complain(f"{name} is missing; write for example {name} = {_EUROCODE[name].example}")
    if missing or "ag_g" not in read or (len(given) < len(corners) and not {"type", "ground"} <= read.keys()):
        return None
    name = "EN 1998-1"
    if {"type", "ground"} <= read.keys():
        shape = EUROCODE[read["type"]][read["ground"]]._replace(**given)
        name += f" type {read['type']}, ground {read['ground']}"
    else:
        shape = EUROCODE[1]["A"]._replace(**given)
    if given:
        name += ", S = {:g}, T_B = {:g} s, T_C = {:g} s, T_D = {:g} s".format(*shape)
    if not shape.tb_s < shape.tc_s < shape.td_s:
        table.complain("tb_s, tc_s and td_s must grow in this order", next(iter(given)))
        return None
    return EurocodeSpectrum(read["ag_g"], shape, damping, name)


def _asce(table: Table, read: dict[str, Any]) -> AsceSpectrum | None:
    for name in _ASCE:
        if name not in table.data:
            table.complain(f"{name} is missing; write for example {name} = {_ASCE[name].example}")
    if not _ASCE.keys() <= read.keys():
        return None
    values = {name: read[name] for name in _ASCE}
    if not values["sd1_g"] / values["sds_g"] < values["tl_s"]:
        table.complain("tl_s must be above sd1_g/sds_g, where the plateau ends", "tl_s")
        return None
    return AsceSpectrum(**values)
