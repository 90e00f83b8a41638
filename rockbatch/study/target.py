"""The target of records in a study file, one measure or a whole spectrum: [motions.target]."""

from dataclasses import replace
from pathlib import Path
from typing import Any

from rockbatch.common.errors import InputError
from rockbatch.common.grouping import closest
from rockbatch.common.showing import shown
from rockbatch.common.units import Usual
from rockbatch.motions.design_spectra import (
    EUROCODE,
    NZS_1170_5,
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
from rockbatch.motions.pairs import TWO_COMPONENT_RULES
from rockbatch.motions.scaling import Target
from rockbatch.motions.spectrum_target import FACTORS, PAIRS, SpectrumTarget
from rockbatch.toml.kinds import Choice, KindError, Number, Other, choice, not_negative, positive, text
from rockbatch.toml.meant import names
from rockbatch.toml.reader import Table
from rockbatch.toml.section import CONFIRM, Key, Section

CODES = ("EN 1998-1", "ASCE 7", "AASHTO", "NZS 1170.5", "EN 1998-1 vertical")
_ALSO_CALLED = {
    "ec8": CODES[0], "en1998": CODES[0], "eurocode": CODES[0], "asce": CODES[1], "aashto": CODES[2], "nzs": CODES[3],
}  # fmt: skip


def _entry(value: Any) -> Any:
    """Return the name of a code or file, or one pair of a table."""
    if isinstance(value, list):
        if len(value) != 2:
            raise KindError(_PAIRS)
        return not_negative(value[0]), positive(value[1])
    if not isinstance(value, str):
        raise KindError(_ENTRY.words)
    return text(value)


_PAIRS = "pairs of a period [s] and a spectral acceleration [g]"
_PAIR_SCHEMA = {"type": "array", "items": [not_negative.schema(), positive.schema()], "minItems": 2, "maxItems": 2}
_ENTRY = Other(f"the name of a code or of a file, or {_PAIRS}", _entry, {"anyOf": [text.schema(), _PAIR_SCHEMA]})
PERIOD = Usual(50.0, "s: spectra have 0.01 to 10", 0.005)
"""Usual periods of spectra."""

_MEASURE = {
    "pga_g": Key(positive, "0.4", "Peak ground acceleration of the horizontal component.",
        usual=Usual(5.0, "g: the strongest earthquakes had 2 to 4 g", 0.005)),
    "pgv_m_s": Key(positive, "0.5", "Peak ground velocity of the horizontal component.",
        usual=Usual(5.0, "m/s: the strongest earthquakes had some 3 m/s", 0.005)),
    "sa_g": Key(positive, "0.8", "Pseudo-spectral acceleration at `period_s`.",
        usual=Usual(10.0, "g: the strongest earthquakes had 5 to 8 g", 0.001)),
    "period_s": Key(positive, "1.0", "Period of the oscillator of `sa_g`.", usual=PERIOD),
    "damping": Key(Number("a fraction of critical damping, within 0..1", low=0.0, high=1.0, below=True), "0.05",
        "Damping of the oscillators, as a fraction of critical damping."),
}  # fmt: skip
_PAIRS_OF_SA = {"pairs": Key(choice("apart", *TWO_COMPONENT_RULES), '"rotd100"', "")}
_EUROCODE = {
    "type": Key(Choice((1, 2), "1 or 2, the type of spectrum"), "1", "Type of the spectrum of EN 1998-1."),
    "ground": Key(choice(*EUROCODE[1]), '"B"', "Ground type of EN 1998-1."),
    "ag_g": Key(positive, "0.25", "Design ground acceleration on ground A, with the importance factor, of EN 1998-1.",
        required=True, usual=Usual(2.0, "g: codes have 0.05 to 0.6 g", 0.005)),
    "soil_factor": Key(positive, "1.2", "Soil factor S of EN 1998-1; default: that of the ground type."),
    "tb_s": Key(positive, "0.15", "Period T_B of EN 1998-1; default: that of the ground type.", usual=PERIOD),
    "tc_s": Key(positive, "0.5", "Period T_C of EN 1998-1; default: that of the ground type.", usual=PERIOD),
    "td_s": Key(positive, "2.0", "Period T_D of EN 1998-1; default: that of the ground type.", usual=PERIOD),
}  # fmt: skip
_SHORT_AND_1_S = {
    "sds_g": Key(positive, "1.0", "Design spectral acceleration S_DS of ASCE 7 or AASHTO, at short periods.",
        required=True, usual=Usual(5.0, "g: codes have 0.1 to 3 g", 0.005)),
    "sd1_g": Key(positive, "0.6", "Design spectral acceleration S_D1 of ASCE 7 or AASHTO, at 1 s.",
        required=True, usual=Usual(5.0, "g: codes have 0.05 to 2 g", 0.002)),
}  # fmt: skip
_ASCE = {
    **_SHORT_AND_1_S,
    "tl_s": Key(positive, "8.0", "Long-period transition period T_L of ASCE 7.", required=True, usual=PERIOD),
}
_AASHTO = {
    "as_g": Key(positive, "0.4", "Acceleration A_s of AASHTO at 0 s; this spectrum has not been checked against its articles.",
        required=True, usual=Usual(2.0, "g: codes have 0.05 to 1 g", 0.005)),
    **_SHORT_AND_1_S,
}  # fmt: skip
_NZS = {
    "subsoil": Key(choice(*NZS_1170_5), '"C"',
        "Site subsoil class of NZS 1170.5; this spectrum has not been checked against the standard.", required=True),
    "hazard_factor": Key(positive, "0.4", "Hazard factor Z of NZS 1170.5.", required=True,
        usual=Usual(1.0, "(New Zealand has 0.13 to 0.6)", 0.01)),
    "return_period_factor": Key(positive, "1.3", "Return period factor R of NZS 1170.5, 1 at 500 years.",
        usual=Usual(2.0, "(2,500 years have 1.8)", 0.1), default=1.0),
    "fault_km": Key(not_negative, "8.0",
        "Distance from the nearest major fault of NZS 1170.5, for its near-fault factor; default: beyond 20 km.",
        usual=Usual(1000.0, "km: beyond 20 km the factor is 1", 0.05)),
}  # fmt: skip
_VERTICAL = {name: _EUROCODE[name] for name in ("type", "ag_g")} | {
    "avg_over_ag": Key(
        positive, "0.9", "Ratio a_vg/a_g of EN 1998-1 for its vertical spectrum; that of the type if not given."
    ),
}
_SPECTRUM = {
    "spectrum": Key(_ENTRY, '"EN 1998-1"',
        'Target spectrum: "EN 1998-1", "ASCE 7", "AASHTO", "NZS 1170.5", "EN 1998-1 vertical", a file with periods [s] and '
        "spectral accelerations [g], or a list of such pairs.", required=True, many=True, distinct=False),
    "period_range_s": Key(positive, "[0.4, 4.0]",
        "Periods between which the records are fitted to the spectrum.", required=True, pair=True,
        usual=PERIOD),
    "factors": Key(choice(*FACTORS), '"both"',
        'What is scaled to the spectrum: "each" record, the whole "suite" by one factor, "both", one after the other, or '
        '"none", only to compare.'),
    "pairs": Key(choice(*PAIRS), '"srss"',
        'Whether each component has its own spectrum, "apart", or each station one of both components: "srss" as in EN 1998-2, '
        '"geomean", "rotd50" (median direction), or "rotd100" (maximum direction, as in ASCE 7). With `sa_g`, what of a pair '
        "that is; not srss."),
    "at_least": Key(positive, "0.9",
        "Share of the target that the mean of the suite has to reach everywhere in the range: the check `suite to target`."),
    "damping": _MEASURE["damping"],
    "interpolation": Key(choice("logarithmic", "linear"), '"linear"',
        'How a table goes between its points: straight in logarithms, or "linear", as the spectra by 22 points of ASCE 7-22 and '
        "AASHTO do, from 0 s on.", default="logarithmic"),
}  # fmt: skip
_OWN = {"EN 1998-1": _EUROCODE, "ASCE 7": _ASCE, "AASHTO": _AASHTO, "NZS 1170.5": _NZS, "EN 1998-1 vertical": _VERTICAL}
_OF_ANY_CODE = _VERTICAL | _NZS | _AASHTO | _ASCE | _EUROCODE
_OF_ANY_SPECTRUM = {name: replace(key, required=False) for name, key in (_SPECTRUM | _OF_ANY_CODE).items()}
_ALSO = names({
    "spectrum": "code standard designspectrum",
    ("ground", "subsoil"): "soil soiltype soilclass siteclass groundtype subsoilclass",
    "damping": "zeta xi dampingratio", "hazard_factor": "z hazard", "return_period_factor": "r", "ag_g": "ag",
    "soil_factor": "s", "period_range_s": "range periods", "fault_km": "faultdistance distance",
})  # fmt: skip
TARGET = Section(("motions", "target"), (
    "What records are scaled to, by one factor on all components of each: one measure (`pga_g`, `pgv_m_s`, or `sa_g` with "
    "`period_s`), or a `spectrum` over `period_range_s`. The keys of a code's spectrum go with that code only."
), {
    **_MEASURE, **_OF_ANY_SPECTRUM, **CONFIRM,
}, homes=(Target, SpectrumTarget), also=_ALSO)  # fmt: skip
"""Every key that a target may have, of one measure or of a spectrum."""

VERTICAL_TARGET = Section(("motions", "vertical_target"), (
    "What the vertical component of each record is scaled to by a factor of its own, in place of that of its horizontal one, "
    "with the keys of `[motions.target]` but for `pairs`."
), {
    name: replace(key, words=key.words.replace("horizontal component", "vertical component"))
    for name, key in TARGET.items() if name != "pairs"
}, homes=(Target, SpectrumTarget), also=_ALSO)  # fmt: skip
_NO_PAIR = {"pairs": "is for horizontal components; leave it out"}

_UNFIT_FOR_SPECTRUM = dict.fromkeys(
    ("pga_g", "pgv_m_s", "sa_g", "period_s"), "is for a target of one measure, not for a spectrum; leave it out"
)


def read_target(table: Table, vertical: bool = False) -> Target | SpectrumTarget | None:
    """Return the target of [motions], for horizontal or ``vertical`` components; None, with the mistakes noted, if it is none."""
    if any(TARGET.known_as(name, ("spectrum",)) for name in table.data):
        return _read_spectrum(table, vertical)
    return _read_measure(table, vertical)


def _read_measure(table: Table, vertical: bool) -> Target | None:
    problems_before = len(table.file.problems)
    unfit = dict.fromkeys((*_SPECTRUM, *_OF_ANY_CODE), "is for a target with spectrum = …")
    read = table.read(
        _MEASURE | CONFIRM if vertical else _MEASURE | _PAIRS_OF_SA | CONFIRM,
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
    problems_before = len(table.file.problems)
    written = table.data.get("spectrum", "")
    code = _code(written)
    of_code = _OWN.get(code, {})
    if not code and isinstance(written, str) and not _is_there(table.file.path.parent / written):
        of_code = _OF_ANY_SPECTRUM | _SPECTRUM  # the name is what is wrong
    unfit = {
        name: f"is for spectrum = {' or '.join(shown(c) for c, keys in _OWN.items() if name in keys)}; leave it out"
        for name in _OF_ANY_CODE.keys() - of_code.keys()
    }
    keys = _SPECTRUM | of_code | CONFIRM
    if vertical:
        keys, unfit = {name: key for name, key in keys.items() if name != "pairs"}, unfit | _NO_PAIR
    elif code.endswith("vertical"):
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


def _code(value: Any) -> str:
    """Return the name of the code, from any spelling; empty for a table."""
    if not isinstance(value, str):
        return ""
    plain = {name.replace(" ", "").lower(): name for name in CODES}
    return plain.get(value.replace(" ", "").lower(), "")


def _spectrum(table: Table, code: str, read: dict[str, Any]) -> Spectrum | None:
    damping, linear = read.get("damping", 0.05), read.get("interpolation") == "linear"
    if code and "interpolation" in read:
        table.complain(f"interpolation: is for tables, and {code} is none; leave it out", "interpolation")
    if code == "EN 1998-1":
        return _eurocode(table, read, damping)
    if code == "EN 1998-1 vertical":
        return _vertical(table, read, damping)
    if code:
        if damping != 0.05:
            table.complain(f"damping: the spectrum of {code} is for 5 %; leave it out", "damping")
        return {"ASCE 7": _asce, "AASHTO": _aashto, "NZS 1170.5": _nzs}[code](table, read)
    entries = read["spectrum"]
    with table.noting("spectrum"):
        if len(entries) == 1 and isinstance(entries[0], str):
            return _of_file(table, entries[0], damping, linear)
        if any(isinstance(entry, str) for entry in entries):
            raise InputError("spectrum: expected one name, or pairs of a period [s] and a spectral acceleration [g]")
        periods, values = zip(*entries, strict=True)
        return TableSpectrum(periods, values, damping, "given by the study", linear)
    return None


def _is_there(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # a name that no file can have
        return False


def _of_file(table: Table, written: str, damping: float, linear: bool) -> TableSpectrum:
    path = table.file.path.parent / written
    if not _is_there(path):
        plain = "".join(filter(str.isalnum, written.lower()))
        near = next((code for start, code in _ALSO_CALLED.items() if plain.startswith(start)), closest(written, CODES))
        hint = f"did you mean {shown(near)}?" if near else f"write {' or '.join(map(shown, CODES))}, or a file"
        raise InputError(f"spectrum = {shown(written)}: no such file ({path.resolve()}); {hint}")
    return read_spectrum(path, damping, linear)


def _eurocode(table: Table, read: dict[str, Any], damping: float) -> EurocodeSpectrum | None:
    written = {name: read[name] for name in ("soil_factor", "tb_s", "tc_s", "td_s") if name in read}
    needed = ("type", "ground") if len(written) < 4 else ()
    for name in needed:
        if not table.has(name):
            table.complain(f"{name} is missing; write for example {name} = {_EUROCODE[name].example}")
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


def _asce(table: Table, read: dict[str, Any]) -> AsceSpectrum | None:
    if not _ASCE.keys() <= read.keys():
        return None
    values = {name: read[name] for name in _ASCE}
    if not values["sd1_g"] / values["sds_g"] < values["tl_s"]:
        table.complain("tl_s must be above sd1_g/sds_g, where the plateau ends", "tl_s")
        return None
    return AsceSpectrum(**values)


def _aashto(table: Table, read: dict[str, Any]) -> AashtoSpectrum | None:
    if not _AASHTO.keys() <= read.keys():
        return None
    values = {name: read[name] for name in _AASHTO}
    if not values["as_g"] <= values["sds_g"]:
        table.complain("as_g must not be above sds_g, that of the plateau", "as_g")
        return None
    return AashtoSpectrum(**values)


def _nzs(table: Table, read: dict[str, Any]) -> NzsSpectrum | None:
    if not {"subsoil", "hazard_factor"} <= read.keys():
        return None
    return NzsSpectrum(**{name: read[name] for name in _NZS if name in read})


def _vertical(table: Table, read: dict[str, Any], damping: float) -> EurocodeSpectrum | None:
    if "type" not in table.data and "avg_over_ag" not in table.data:
        table.complain("type is missing; write for example type = 1, or avg_over_ag = 0.9")
    if "ag_g" not in read or not {"type", "avg_over_ag"} & read.keys():
        return None
    ratio = read.get("avg_over_ag") or VERTICAL_RATIO[read["type"]]
    return EurocodeSpectrum(ratio * read["ag_g"], VERTICAL_SHAPE, damping, "EN 1998-1 vertical", amplification=3.0)
