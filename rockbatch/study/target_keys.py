"""Keys of [motions.target] and [motions.vertical_target]: of one measure, and of the spectrum of each code."""

from dataclasses import replace

from rockbatch.common.units import Usual
from rockbatch.motions.intensity.pairs import TWO_COMPONENT_RULES
from rockbatch.motions.suites.design_spectra import EUROCODE, NZS_1170_5
from rockbatch.motions.suites.scaling import Target
from rockbatch.motions.suites.spectrum_target import FACTORS, PAIRS, SpectrumTarget
from rockbatch.toml.kinds import Choice, KindError, Number, Other, choice, not_negative, positive, text
from rockbatch.toml.meant import names
from rockbatch.toml.section import CONFIRM, Key, Section

VERTICAL = "EN 1998-1 vertical"
"""The only code here with a spectrum of vertical components."""
CODES = ("EN 1998-1", "ASCE 7", "AASHTO", "NZS 1170.5", VERTICAL)


def _spectrum_entry(value: object) -> str | tuple[float, float]:
    """Return the name of a code or file, or a pair of period [s] and acceleration [g]; raise ``KindError`` for others."""
    if isinstance(value, list):
        if len(value) != 2:
            raise KindError(_PAIRS)
        return not_negative(value[0]), positive(value[1])
    if not isinstance(value, str):
        raise KindError(_ENTRY.words)
    return text(value)


_PAIRS = "pairs of a period [s] and a spectral acceleration [g]"
_PAIR_SCHEMA = {"type": "array", "items": [not_negative.schema(), positive.schema()], "minItems": 2, "maxItems": 2}
_ENTRY = Other(
    f"the name of a code or of a file, or {_PAIRS}", _spectrum_entry, {"anyOf": [text.schema(), _PAIR_SCHEMA]}
)
PERIOD = Usual(50.0, "s: spectra have 0.01 to 10", 0.005)
"""Usual periods of spectra."""

MEASURE = {
    "pga_g": Key(
        positive,
        "0.4",
        "Peak ground acceleration of the horizontal component.",
        usual=Usual(2.0, "g: few records exceed 1 g, and the strongest had 2 to 4 g", 0.005),
    ),
    "pgv_m_s": Key(
        positive,
        "0.5",
        "Peak ground velocity of the horizontal component.",
        usual=Usual(5.0, "m/s: the strongest earthquakes had some 3 m/s", 0.005),
    ),
    "sa_g": Key(
        positive,
        "0.8",
        "Pseudo-spectral acceleration at `period_s`.",
        usual=Usual(10.0, "g: the strongest earthquakes had 5 to 8 g", 0.001),
    ),
    "period_s": Key(positive, "1.0", "Period of the oscillator of `sa_g`.", usual=PERIOD),
    "damping": Key(
        Number("a fraction of critical damping, 0 or above and below 1", low=0.0, high=1.0, below=True),
        "0.05",
        "Damping of the oscillators, as a fraction of critical damping.",
    ),
}
PAIRS_OF_SA = {"pairs": Key(choice("apart", *TWO_COMPONENT_RULES), '"rotd100"', "")}
EUROCODE_KEYS = {
    "type": Key(Choice((1, 2), "1 or 2, the type of spectrum"), "1", "Type of the spectrum of EN 1998-1."),
    "ground": Key(choice(*EUROCODE[1]), '"B"', "Ground type of EN 1998-1."),
    "ag_g": Key(
        positive,
        "0.25",
        "Design ground acceleration on ground A, with the importance factor, of EN 1998-1.",
        required=True,
        usual=Usual(2.0, "g: codes have 0.05 to 0.6 g", 0.005),
    ),
    "soil_factor": Key(positive, "1.2", "Soil factor S of EN 1998-1; default: that of the ground type."),
    "tb_s": Key(positive, "0.15", "Period T_B of EN 1998-1; default: that of the ground type.", usual=PERIOD),
    "tc_s": Key(positive, "0.5", "Period T_C of EN 1998-1; default: that of the ground type.", usual=PERIOD),
    "td_s": Key(positive, "2.0", "Period T_D of EN 1998-1; default: that of the ground type.", usual=PERIOD),
}
_SHORT_AND_1_S = {
    "sds_g": Key(
        positive,
        "1.0",
        "Design spectral acceleration S_DS of ASCE 7 or AASHTO, at short periods: of ASCE 7 two thirds of that of MCE_R.",
        required=True,
        usual=Usual(5.0, "g: codes have 0.1 to 3 g", 0.005),
    ),
    "sd1_g": Key(
        positive,
        "0.6",
        "Design spectral acceleration S_D1 of ASCE 7 or AASHTO, at 1 s: of ASCE 7 two thirds of that of MCE_R.",
        required=True,
        usual=Usual(5.0, "g: codes have 0.05 to 2 g", 0.002),
    ),
}
ASCE_KEYS = {
    **_SHORT_AND_1_S,
    "tl_s": Key(positive, "8.0", "Long-period transition period T_L of ASCE 7.", required=True, usual=PERIOD),
}
AASHTO_KEYS = {
    "as_g": Key(
        positive,
        "0.4",
        "Acceleration A_s of AASHTO at 0 s; this spectrum has not been checked against its articles.",
        required=True,
        usual=Usual(2.0, "g: codes have 0.05 to 1 g", 0.005),
    ),
    **_SHORT_AND_1_S,
}
NZS_KEYS = {
    "subsoil": Key(
        choice(*NZS_1170_5),
        '"C"',
        "Site subsoil class of NZS 1170.5; this spectrum has not been checked against the standard.",
        required=True,
    ),
    "hazard_factor": Key(
        positive,
        "0.4",
        "Hazard factor Z of NZS 1170.5.",
        required=True,
        usual=Usual(1.0, "(New Zealand has 0.13 to 0.6)", 0.01),
    ),
    "return_period_factor": Key(
        positive,
        "1.3",
        "Return period factor R of NZS 1170.5, 1 at 500 years.",
        usual=Usual(2.0, "(2,500 years have 1.8)", 0.1),
        default=1.0,
    ),
    "fault_km": Key(
        not_negative,
        "8.0",
        "Distance from the nearest major fault of NZS 1170.5, for its near-fault factor; default: beyond 20 km.",
        usual=Usual(1000.0, "km: beyond 20 km the factor is 1", 0.05),
    ),
}
_VERTICAL_KEYS = {name: EUROCODE_KEYS[name] for name in ("type", "ag_g")} | {
    "avg_over_ag": Key(
        positive, "0.9", "Ratio a_vg/a_g of EN 1998-1 for its vertical spectrum; that of the type if not given."
    ),
}
SPECTRUM = {
    "spectrum": Key(
        _ENTRY,
        '"EN 1998-1"',
        'Target spectrum: "EN 1998-1", "ASCE 7", "AASHTO", "NZS 1170.5", "EN 1998-1 vertical", a file with periods [s] and '
        "spectral accelerations [g], or a list of such pairs.",
        required=True,
        many=True,
        distinct=False,
    ),
    "period_range_s": Key(
        positive,
        "[0.4, 4.0]",
        "Periods between which the records are fitted to the spectrum.",
        required=True,
        pair=True,
        usual=PERIOD,
    ),
    "factors": Key(
        choice(*FACTORS),
        '"both"',
        'What is scaled to the spectrum: "each" record, the whole "suite" by one factor, "both", one after the other, or '
        '"none", only to compare.',
    ),
    "pairs": Key(
        choice(*PAIRS),
        '"srss"',
        'Whether each component has its own spectrum, "apart", or each station one of both components: "srss" as in EN 1998-2, '
        '"geomean", "rotd50" (median direction), or "rotd100" (maximum direction, as in ASCE 7). With `sa_g`, the measure '
        "of a pair; not srss.",
    ),
    "at_least": Key(
        positive,
        "0.9",
        "Share of the target that the mean of the suite has to reach everywhere in the range: the check `suite to target`.",
    ),
    "damping": MEASURE["damping"],
    "interpolation": Key(
        choice("logarithmic", "linear"),
        '"linear"',
        'How a table goes between its points: straight in logarithms, or "linear", as the spectra by 22 points of ASCE 7-22 and '
        "AASHTO do, from 0 s on.",
        default="logarithmic",
    ),
}
KEYS_OF_CODE = {
    "EN 1998-1": EUROCODE_KEYS,
    "ASCE 7": ASCE_KEYS,
    "AASHTO": AASHTO_KEYS,
    "NZS 1170.5": NZS_KEYS,
    VERTICAL: _VERTICAL_KEYS,
}
KEYS_OF_ANY_CODE = _VERTICAL_KEYS | NZS_KEYS | AASHTO_KEYS | ASCE_KEYS | EUROCODE_KEYS
KEYS_OF_ANY_SPECTRUM = {name: replace(key, required=False) for name, key in (SPECTRUM | KEYS_OF_ANY_CODE).items()}
_ALSO = names(
    {
        "spectrum": "code standard designspectrum",
        ("ground", "subsoil"): "soil soiltype soilclass siteclass groundtype subsoilclass category soilcategory",
        "damping": "zeta xi dampingratio",
        "hazard_factor": "z hazard",
        "return_period_factor": "r",
        "ag_g": "ag",
        "type": "spectrumtype",
        "soil_factor": "s",
        "period_range_s": "range periods trange periodrange",
        "fault_km": "faultdistance distance",
    }
)
_INSTEAD = names(
    {
        "write ground or subsoil, the class that has this velocity": "vs30 vs",
        "ag_g has the importance factor in it; leave it out": "importance importancefactor gammai",
        "the spectra are elastic; leave it out": "q behaviourfactor behaviorfactor rfactor",
        "write period_range_s = [least, greatest]": "periodmin periodmax tmin tmax",
    }
)
TARGET = Section(
    ("motions", "target"),
    (
        "What records are scaled to, by one factor on all components of each: one measure (`pga_g`, `pgv_m_s`, or `sa_g` with "
        "`period_s`), or a `spectrum` over `period_range_s`. The keys of a code's spectrum go with that code only."
    ),
    {**MEASURE, **KEYS_OF_ANY_SPECTRUM, **CONFIRM},
    homes=(Target, SpectrumTarget),
    also=_ALSO,
    instead=_INSTEAD,
)
"""Every key that a target may have, of one measure or of a spectrum."""

VERTICAL_TARGET = Section(
    ("motions", "vertical_target"),
    (
        "What the vertical component of each record is scaled to, by its own factor instead of that of the horizontal component, "
        "with the keys of `[motions.target]` but for `pairs`."
    ),
    {name: key for name, key in TARGET.items() if name != "pairs"}
    | {
        "pga_g": replace(MEASURE["pga_g"], words="Peak ground acceleration of the vertical component."),
        "pgv_m_s": replace(MEASURE["pgv_m_s"], words="Peak ground velocity of the vertical component."),
    },
    homes=(Target, SpectrumTarget),
    also=_ALSO,
    instead=_INSTEAD,
)
