"""The target of records in a study file, one measure or a whole spectrum: [motions.target]."""

from pathlib import Path

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import closest
from rockbatch.common.showing import shown
from rockbatch.motions.suites.design_spectra import (
    EUROCODE,
    VERTICAL_RATIO,
    VERTICAL_SHAPE,
    AashtoSpectrum,
    AsceSpectrum,
    EurocodeSpectrum,
    NzsSpectrum,
    Spectrum,
    TableSpectrum,
    read_spectrum,
)
from rockbatch.motions.suites.scaling import Target
from rockbatch.motions.suites.spectrum_target import SpectrumTarget
from rockbatch.study.target_keys import (
    AASHTO_KEYS,
    ASCE_KEYS,
    CODES,
    EUROCODE_KEYS,
    KEYS_OF_ANY_CODE,
    KEYS_OF_ANY_SPECTRUM,
    KEYS_OF_CODE,
    MEASURE,
    NZS_KEYS,
    PAIRS_OF_SA,
    SPECTRUM,
    TARGET,
    VERTICAL,
)
from rockbatch.toml.kinds import KeyValues
from rockbatch.toml.reader import Table
from rockbatch.toml.section import CONFIRM

_ALSO_CALLED = {
    "ec8": CODES[0],
    "en1998": CODES[0],
    "eurocode": CODES[0],
    "asce": CODES[1],
    "aashto": CODES[2],
    "nzs": CODES[3],
}
"""Codes by the beginnings of other names, letters and digits in lower case."""

_NO_PAIR = {"pairs": "is for horizontal components; leave it out"}

_UNFIT_FOR_SPECTRUM = dict.fromkeys(
    ("pga_g", "pgv_m_s", "sa_g", "period_s"), "is for a target of one measure, not for a spectrum; leave it out"
)


def read_target(table: Table, vertical: bool = False) -> Target | SpectrumTarget | None:
    """Return what records, or their ``vertical`` components, are scaled to; None for a mistake, which becomes a problem."""
    if any(TARGET.known_as(name, ("spectrum",)) for name in table.data):
        return _read_spectrum(table, vertical)
    return _read_measure(table, vertical)


def _read_measure(table: Table, vertical: bool) -> Target | None:
    """Return the target by the one of pga_g, pgv_m_s and sa_g that the table gives; None for a mistake, which becomes a problem.

    Of ``vertical`` components it takes no ``pairs``.
    """
    problems_before = len(table.file.problems)
    unfit = dict.fromkeys((*SPECTRUM, *KEYS_OF_ANY_CODE), "is for a target with spectrum = …")
    read = table.read(
        MEASURE | CONFIRM if vertical else MEASURE | PAIRS_OF_SA | CONFIRM,
        unfit=unfit | _NO_PAIR if vertical else unfit,
    )
    measures = [name for name in ("pga_g", "pgv_m_s", "sa_g") if table.has(name)]
    if len(measures) != 1:
        state = " and ".join(measures) + " are given" if measures else "the measure is missing"
        table.complain(f"{state}; write one of pga_g, pgv_m_s, sa_g with period_s, or spectrum", *measures[1:2])
    elif measures == ["sa_g"] and not table.has("period_s"):
        table.complain("period_s is missing beside sa_g; write for example period_s = 1.0", "sa_g")
    elif measures != ["sa_g"]:
        for name in ("period_s", "damping", "pairs"):
            if name in table.data:
                table.complain(f"{name}: is for sa_g only; leave it out", name)
    return Target(**read) if table.file.is_sound_since(problems_before) else None


def _read_spectrum(table: Table, vertical: bool) -> SpectrumTarget | None:
    """Return the target spectrum with its period range; None for a mistake, which becomes a problem of the table's file."""
    problems_before = len(table.file.problems)
    written = table.data.get("spectrum", "")
    code = _code_name(written)
    of_code = KEYS_OF_CODE.get(code, {})
    if not code and isinstance(written, str) and not _exists(table.file.path.parent / written):
        of_code = KEYS_OF_ANY_SPECTRUM | SPECTRUM  # the name is probably misspelt: report no key as unfit beside it
    unfit = {
        name: f"is for spectrum = {' or '.join(shown(c) for c, keys in KEYS_OF_CODE.items() if name in keys)}; leave it out"
        for name in KEYS_OF_ANY_CODE.keys() - of_code.keys()
    }
    keys = SPECTRUM | of_code | CONFIRM
    if vertical:
        keys, unfit = {name: key for name, key in keys.items() if name != "pairs"}, unfit | _NO_PAIR
    elif code == VERTICAL:
        table.complain(f"spectrum = {shown(code)}: is for [motions.vertical_target]", "spectrum")
    read = table.read(keys, unfit=unfit | _UNFIT_FOR_SPECTRUM)
    spectrum = _spectrum(table, code, read) if "spectrum" in read else None
    if not table.file.is_sound_since(problems_before):
        return None
    assert spectrum is not None  # or a mistake is noted
    with table.noting("period_range_s"):
        given = {name: read[name] for name in ("factors", "pairs", "at_least") if name in read}
        return SpectrumTarget(spectrum, read["period_range_s"], **given)
    return None


def _code_name(value: object) -> str:
    """Return the name in :data:`CODES` that ``value`` is but for capitals and blanks; "" for a file, pairs or other values."""
    if not isinstance(value, str):
        return ""
    plain = {name.replace(" ", "").lower(): name for name in CODES}
    return plain.get(value.replace(" ", "").lower(), "")


def _spectrum(table: Table, code: str, read: KeyValues) -> Spectrum | None:
    """Return the spectrum of ``code``, or of a file or pairs if that is ""; None for a mistake, which becomes a problem."""
    damping, linear = read.get("damping", 0.05), read.get("interpolation") == "linear"
    if code and "interpolation" in read:
        table.complain(f"interpolation: is for tables, and {code} is none; leave it out", "interpolation")
    if code == "EN 1998-1":
        return _eurocode_spectrum(table, read, damping)
    if code == VERTICAL:
        return _vertical_spectrum(table, read, damping)
    if code:
        if damping != 0.05:
            table.complain(f"damping: the spectrum of {code} is for 5 %; leave it out", "damping")
        return {"ASCE 7": _asce_spectrum, "AASHTO": _aashto_spectrum, "NZS 1170.5": _nzs_spectrum}[code](table, read)
    entries = read["spectrum"]
    with table.noting("spectrum"):
        if len(entries) == 1 and isinstance(entries[0], str):
            return _spectrum_of_file(table, entries[0], damping, linear)
        if any(isinstance(entry, str) for entry in entries):
            raise InputError("spectrum: expected one name, or pairs of a period [s] and a spectral acceleration [g]")
        periods, values = zip(*entries, strict=True)
        return TableSpectrum(periods, values, damping, "given by the study", linear)
    return None


def _exists(path: Path) -> bool:
    """Return whether a file exists; False for a name that no file can have."""
    try:
        return path.exists()
    except (OSError, ValueError):  # too long, or with a NUL
        return False


def _spectrum_of_file(table: Table, written: str, damping: float, linear: bool) -> TableSpectrum:
    """Return the spectrum in the file ``written`` in a study. Raises ``InputError`` with the code that may be meant instead."""
    path = table.file.path.parent / written
    if not _exists(path):
        plain = "".join(filter(str.isalnum, written.lower()))
        near = next((code for start, code in _ALSO_CALLED.items() if plain.startswith(start)), closest(written, CODES))
        hint = f"did you mean {shown(near)}?" if near else f"write {' or '.join(map(shown, CODES))}, or a file"
        raise InputError(f"spectrum = {shown(written)}: no such file ({path.resolve()}); {hint}")
    return read_spectrum(path, damping, linear)


def _eurocode_spectrum(table: Table, read: KeyValues, damping: float) -> EurocodeSpectrum | None:
    """Return the horizontal spectrum of EN 1998-1; None if a needed key is missing, or periods do not grow.

    Type and ground are needed unless S, T_B, T_C and T_D are all given, which take the place of theirs.
    """
    written = {name: read[name] for name in ("soil_factor", "tb_s", "tc_s", "td_s") if name in read}
    needed = ("type", "ground") if len(written) < 4 else ()
    for name in needed:
        if not table.has(name):
            table.complain(f"{name} is missing; write for example {name} = {EUROCODE_KEYS[name].example}")
    if not read.keys() >= {"ag_g", *needed}:
        return None
    name = "EN 1998-1"
    if {"type", "ground"} <= read.keys():
        shape = EUROCODE[read["type"]][read["ground"]]._replace(**written)
        name += f" type {read['type']}, ground {read['ground']}"
    else:
        shape = EUROCODE[1]["A"]._replace(**written)
    if written:
        name += ", S = {:g}, T_B = {:g} s, T_C = {:g} s, T_D = {:g} s".format(*shape)
    if not shape.tb_s < shape.tc_s < shape.td_s:
        table.complain("tb_s, tc_s and td_s must grow in this order", next(iter(written)))
        return None
    return EurocodeSpectrum(read["ag_g"], shape, damping, name)


def _asce_spectrum(table: Table, read: KeyValues) -> AsceSpectrum | None:
    """Return the spectrum of ASCE 7; None if a key is missing or T_L is within the plateau."""
    if not ASCE_KEYS.keys() <= read.keys():
        return None
    values = {name: read[name] for name in ASCE_KEYS}
    if not values["sd1_g"] / values["sds_g"] < values["tl_s"]:
        table.complain("tl_s must be above sd1_g/sds_g, where the plateau ends", "tl_s")
        return None
    return AsceSpectrum(**values)


def _aashto_spectrum(table: Table, read: KeyValues) -> AashtoSpectrum | None:
    """Return the spectrum of AASHTO; None if a key is missing or A_s is above the plateau."""
    if not AASHTO_KEYS.keys() <= read.keys():
        return None
    values = {name: read[name] for name in AASHTO_KEYS}
    if not values["as_g"] <= values["sds_g"]:
        table.complain("as_g must not be above sds_g, that of the plateau", "as_g")
        return None
    return AashtoSpectrum(**values)


def _nzs_spectrum(table: Table, read: KeyValues) -> NzsSpectrum | None:
    """Return the spectrum of NZS 1170.5; None if a key that it requires is missing."""
    if not {"subsoil", "hazard_factor"} <= read.keys():
        return None
    return NzsSpectrum(**{name: read[name] for name in NZS_KEYS if name in read})


def _vertical_spectrum(table: Table, read: KeyValues, damping: float) -> EurocodeSpectrum | None:
    """Return the vertical spectrum of EN 1998-1; None without its type or a_vg/a_g, or without a_g."""
    if "type" not in table.data and "avg_over_ag" not in table.data:
        table.complain("type is missing; write for example type = 1, or avg_over_ag = 0.9")
    if "ag_g" not in read or not {"type", "avg_over_ag"} & read.keys():
        return None
    ratio = read.get("avg_over_ag") or VERTICAL_RATIO[read["type"]]
    return EurocodeSpectrum(ratio * read["ag_g"], VERTICAL_SHAPE, damping, VERTICAL, amplification=3.0)
