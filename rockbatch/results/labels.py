"""Labels of foundations and piers, made of the values that distinguish them."""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from rockbatch.pier.restraints import what_of
from rockbatch.quantities.cases import Case, devices
from rockbatch.quantities.quantity import FOOTING
from rockbatch.study import PIER_KEYS

SYMBOLS = {
    "alpha": ("α", "rad"),
    "p": ("p", "rad/s"),
    "mu": ("μ", ""),
    "gravity": ("g", "m/s²"),
    "size_m": ("R0", "m"),
    "width_m": ("width", "m"),
    "height_m": ("height", "m"),
    "beta": ("β", ""),
    "eta": ("η", ""),
    "safety_factor": ("FS", ""),
    "epsilon": ("ε", ""),
    "zeta": ("ζ", ""),
    "n": ("n", ""),
    "restitution": ("e", ""),
    "stiffness_kN_m": ("K", "kN/m"),
    "yield_kN": ("Fy", "kN"),
    "flight_limit_mm": ("flight limit", "mm"),
    "mass_t": ("M", "t"),
    "deck_mass_t": ("deck mass", "t"),
    "deck_height_m": ("deck height", "m"),
    "deck_inertia_t_m2": ("deck inertia", "t m²"),
    "top_m": ("top", "m"),
    "omega_g_over_p": ("ω_g/p", ""),
    "pga_over_g_tan_alpha": ("PGA/(g tan α)", ""),
    "flexural_period_s": ("flexural period", "s"),
    "area_m2": ("area", "m²"),
}
"""Symbols and units of the keys of a study."""
DEVICE_SYMBOLS = {
    "f": ("f", ""),
    "force_kN": ("F", "kN"),
    "yield_mm": ("uy", "mm"),
    "nu": ("ν", ""),
    "coefficient_kN_s_m": ("C", "kN (s/m)^a"),
    "exponent": ("a", ""),
    "psi": ("ψ", ""),
    "prestress_kN": ("P0", "kN"),
    "lambda": ("λ", ""),
    "stiffness_kN_m": ("kt", "kN/m"),
    "yield_kN": ("Ty", "kN"),
    "gap_mm": ("gap", "mm"),
    "restitution": ("e", ""),
    "brace": ("λb", ""),
    "brace_kN_m": ("kb", "kN/m"),
}
"""Symbols and units of the keys of devices, which are varied under names such as damper_1_force_kN; a in a unit is the device's
exponent."""
_OF_DEVICE = re.compile(r"(damper|tendon|stop|deck_spring)_(\d+)_(.+)")

BASE_KEYS = (
    "beta",
    "stiffness_kN_m",
    "eta",
    "yield_kN",
    "safety_factor",
    "impact",
    "epsilon",
    "zeta",
    "spring",
    "n",
    "kinematics",
    "flight",
    "restitution",
    "flight_limit_mm",
    "friction",
    "area_m2",
)
SAME = {"beta": "stiffness_kN_m", "eta": "yield_kN"}
"""Equivalent keys, without and with units: labels use the one that the study gives."""

_RAISED = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")

Key = tuple[object, ...]
"""Identity of a foundation: case and varied values in the order of the study; of a pier: varied values."""


@dataclass(frozen=True)
class Series:
    """A foundation in figures: a marker, or a line for rigid ground without devices.

    ``tick`` is its short label on axes; ``index`` counts the rigid foundations, or the others, from 0.
    """

    label: str
    tick: str
    rigid: bool
    index: int

    @property
    def keyed(self) -> str:
        """Return the label for a legend after the tick, "a – pads: β = 40"; alone if rigid, or if its case is the tick."""
        return self.label if self.rigid or self.label.split(":")[0] == self.tick else f"{self.tick} – {self.label}"


def quantity(key: str, value: object, digits: int = 10, case: Case | None = None) -> str:
    """Describe a value of a study key without line breaks: "β = 40", "Fy = 45,000 kN", "kinematics finite".

    ``case``, from run.json, supplies the exponent in a viscous damper's unit: "C = 900 kN (s/m)^0.3".
    """
    symbol, unit = symbol_of(key)
    if not isinstance(value, float | int):
        return f"{symbol} {value}"
    if case is not None and (device := of_device(key)):
        unit = unit_with_exponent(unit, _exponent(case, device.kind, device.number))
    return f"{symbol} = {plain(value, digits)} {unit}".strip().replace(" ", "\u00a0")


def symbol_of(key: str) -> tuple[str, str]:
    """Return symbol and unit of a study key, numbered from a second device: "C", "damper 2: C"; else the key itself and ""."""
    if key in SYMBOLS or not (device := of_device(key)):
        return SYMBOLS.get(key, (key, ""))
    symbol, unit = DEVICE_SYMBOLS.get(device.key, (device.key, ""))
    return (symbol if device.number == 1 else f"{device.words}: {symbol}"), unit


class OfDevice(NamedTuple):
    """A key of a device: the kind of the device, its number among those of the kind, and the key in its table."""

    kind: str
    number: int
    key: str

    @property
    def words(self) -> str:
        """Kind and number in words: "damper", "deck spring 2"."""
        kind = self.kind.replace("_", " ")
        return kind if self.number == 1 else f"{kind} {self.number}"


def of_device(key: str) -> OfDevice | None:
    """Return kind and number of the device, and its key, of a varied key such as "damper_2_force_kN"; None for other keys."""
    device = _OF_DEVICE.fullmatch(key)
    return device and OfDevice(device[1], int(device[2]), device[3])


def unit_with_exponent(unit: str, exponent: float) -> str:
    """Return a unit with its exponent a replaced by a number: "kN (s/m)^0.3"; "kN s/m" for 1."""
    return unit.replace("(s/m)^a", "s/m" if exponent == 1.0 else f"(s/m)^{exponent:g}")


def _exponent(case: Case, kind: str, number: int) -> float:
    """Return the exponent of the ``number``-th device of a kind in a case of run.json; 1 if it has none or is not there."""
    of_kind = [device for device in devices(case) if what_of(device) == kind]
    return next((device.get("exponent") for device in of_kind[number - 1 :]), None) or 1.0


def plain(value: float, digits: int) -> str:
    """Format a number to ``digits`` significant digits without an "e": "0.35", "4500", "45,000", "2.5 × 10⁶".

    Up to six integer digits are kept in full, with a comma from five on; numbers with more are written with a power of ten.
    """
    whole = len(str(int(abs(value))))
    if whole <= 6:
        written = f"{value:.{max(digits, whole)}g}"
        return f"{float(written):,.10g}" if whole > 4 else written
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{float(mantissa):.10g} × 10{str(int(exponent)).translate(_RAISED)}"


def digits_that_tell(values: Iterable[object], least: int = 3) -> int:
    """Return the fewest significant digits, from ``least`` to 10, that distinguish all numbers among ``values``."""
    numbers = {value for value in values if isinstance(value, float | int)}
    return next((n for n in range(least, 10) if len({f"{value:.{n}g}" for value in numbers}) == len(numbers)), 10)


def named(
    cases: Mapping[Key, Sequence[Case]], varied: Sequence[str], given: Mapping[str, Collection[str]]
) -> dict[Key, Series]:
    """Return a series for each foundation, labelled by its case and the values that distinguish it from others of its kind.

    The case is left out if all share it and values distinguish them. A tick is a letter, or the name of the case if all names are
    short and different. ``cases`` maps each foundation to its entries in run.json,
    one for each pier; ``given`` maps case names to the keys that the study gives.
    """
    constants = {key: _constants(of_foundation, given.get(str(key[0]), ())) for key, of_foundation in cases.items()}
    # The rocking block itself, drawn as a line to compare others with: on rigid ground and without devices
    firsts = {key: entries[0] for key, entries in cases.items()}
    rigid = {
        key for key, case in firsts.items() if case["base"] == "rigid" and not case["parameters"].get("restraints")
    }
    if 1 < len(cases) == len(rigid):
        rigid = set()  # without others to compare with, they get markers
    shown = dict.fromkeys((*BASE_KEYS, *varied))
    # Supports are compared with supports only: rigid ground lacks their keys
    kinds = {key: (key in rigid, case["base"] == "rigid") for key, case in firsts.items()}
    values = {kind: [constants[key] for key in cases if kinds[key] == kind] for kind in kinds.values()}
    differing = {kind: _differing(shown, of_kind) for kind, of_kind in values.items()}
    digits = {name: digits_that_tell(constants_of.get(name) for constants_of in constants.values()) for name in shown}
    names = [key[0] for key in cases if key not in rigid]
    short = len(set(names)) == len(names) and all(len(str(name)) <= 3 for name in names)
    alone = len({key[0] for key in cases}) == 1  # a name that all share distinguishes nothing
    series: dict[Key, Series] = {}
    count = {True: 0, False: 0}
    for key in cases:
        kind = key in rigid
        distinguishing = [name for name in differing[kinds[key]] if name in constants[key]]
        words = [quantity(name, constants[key][name], digits[name], cases[key][0]) for name in distinguishing]
        case, index = str(key[0]), count[kind]
        count[kind] += 1
        label = ", ".join(words) if words and alone else f"{case}: {', '.join(words)}" if words else case
        series[key] = Series(label, case if short else _tick(index), kind, index)
    return series


def under_bounds(designs: Mapping[Key, Series], keys: Iterable[Key]) -> dict[Key, Series]:
    """Return a series for each of the ``keys``, which end with a bound: the label of its design, and the bound after a comma.

    The nominal design, whose bound is "", keeps its label. Letters are given anew.
    """
    series: dict[Key, Series] = {}
    count = {True: 0, False: 0}
    for *design, bound in keys:
        of_design = designs[(*design, "")]
        kind, index = of_design.rigid, count[of_design.rigid]
        count[kind] += 1
        label = f"{of_design.label}, {bound}" if bound else of_design.label
        series[(*design, bound)] = Series(label, _tick(index), kind, index)
    return series


def _tick(index: int) -> str:
    """Return the short label of a series: a letter, or a number from the 27th on."""
    return chr(ord("a") + index) if index < 26 else str(index + 1)


def _differing(names: Iterable[str], values: Sequence[Mapping[str, object]]) -> list[str]:
    """Return the ``names`` whose values are not all equal."""
    return [name for name in names if len({str(of_foundation.get(name)) for of_foundation in values}) > 1]


def _constants(cases: Sequence[Case], given: Collection[str]) -> dict[str, object]:
    """Return the parameters and varied values of a foundation that are equal on every pier, except keys of the pier and None.

    Of β and the stiffness, and of η and the yield force, the one with units is kept if it is in ``given``, since the other then
    depends on the pier; else the one without. β of a footing is left out unless it is given.
    """
    first, *further = [case["parameters"] | case["columns"] for case in cases]
    omitted = {free if unit in given else unit for free, unit in SAME.items()}.union(PIER_KEYS)
    omitted |= {"beta"} if cases[0]["base"] in FOOTING and "beta" not in given else set()
    kept = {key: value for key, value in first.items() if key not in omitted and value is not None}
    return {key: value for key, value in kept.items() if all(values.get(key) == value for values in further)}
