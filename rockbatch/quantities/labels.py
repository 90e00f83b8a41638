"""Words for cases, their varied values and records: the same in the terminal, on the page, in plots and messages."""

import re
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from rockbatch.pier.restraints import DEVICE
from rockbatch.quantities.cases import Case, backbone, devices
from rockbatch.quantities.design import BOUND

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
    "two_pi_over_p_s": ("2π/p", "s"),
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

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def in_full(case: str, columns: Mapping[str, object], entry: Case | None = None) -> str:
    """Return the name of a case and all its varied values: "pads: β = 40, damper 2: f = 0.05"; the name alone without any.

    ``entry``, that of the case in run.json, supplies the exponents in units.
    """
    return titled(case, values_in_words(columns, entry))


def titled(case: str, words: Iterable[str]) -> str:
    """Return the name of a case before the values that tell it from others: "pads: β = 40, η = 2"; the name alone without any."""
    values = ", ".join(words)
    return f"{case}: {values}" if values else case


def values_in_words(columns: Mapping[str, object], entry: Case | None = None) -> list[str]:
    """Return varied values in words, in their order, without NaN, None and "": ["β = 40", "kinematics finite"].

    A bound is its name alone.
    """
    given = {key: value for key, value in columns.items() if value == value and value not in ("", None)}
    return [str(value) if key == BOUND else quantity(key, value, case=entry) for key, value in given.items()]


def scaled_by(scale: float) -> str:
    """Return the words for runs whose motions are scaled: "motions scaled by 2"."""
    return f"motions scaled by {float(scale):.4g}"


def record_labels(info: Mapping[str, Any]) -> dict[str, str]:
    """Return event, station and direction of each record of run.json, by its name in tables; that name if no file states them."""
    return {record["record"]: str(record.get("label") or record["record"]) for record in info["records"]}


def quantity(key: str, value: object, digits: int = 10, case: Case | None = None) -> str:
    """Describe a value of a study key: "β = 40", "Fy = 45,000 kN", with no-break spaces, or "kinematics finite".

    ``case``, from run.json, supplies the exponent in a viscous damper's unit, "C = 900 kN (s/m)^0.3", and the points of a
    backbone: "spring backbone of 3 points to 40,000 kN at 200 mm".
    """
    symbol, unit = symbol_of(key, case)
    if not isinstance(value, float | int):
        points = _last_point(case) if key == "spring" and case is not None and backbone(case) else ""
        return f"{symbol} {value}{points}"
    return assigned(symbol, value, unit, digits)


def assigned(symbol: str, value: float, unit: str, digits: int) -> str:
    """Return a number with its symbol and unit, "Fy = 45,000 kN", with no-break spaces."""
    return f"{symbol} = {plain(value, digits)} {unit}".strip().replace(" ", "\u00a0")


def _last_point(case: Case) -> str:
    """Return the number of points of a backbone, and the last: " of 3 points to 40,000 kN at 200 mm"; without a mass in M g/2."""
    points, parameters = backbone(case), case["parameters"]
    deflection, force = points[-1]
    at_yield, unit = (parameters["yield_kN"], "kN") if "yield_kN" in parameters else (parameters["eta"], "M g/2")
    reached = f"{plain(force * at_yield, 4)}\u00a0{unit}"
    return f" of {len(points)} points to {reached} at {plain(1000.0 * deflection * parameters['delta_y_m'], 4)}\u00a0mm"


def symbol_of(key: str, case: Case | None = None) -> tuple[str, str]:
    """Return symbol and unit of a study key, numbered from a second device: "C", "damper 2: C"; else the key itself and "".

    ``case``, from run.json, supplies the exponent in a viscous damper's unit.
    """
    if key in SYMBOLS or not (device := of_device(key)):
        return SYMBOLS.get(key, (key, ""))
    symbol, unit = device.symbol(case)
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

    def symbol(self, case: Case | None) -> tuple[str, str]:
        """Return symbol and unit of the key in its table, the key itself and "" without one; ``case`` as in :func:`symbol_of`."""
        symbol, unit = DEVICE_SYMBOLS.get(self.key, (self.key, ""))
        return symbol, unit if case is None else unit_with_exponent(unit, _exponent(case, self))


def of_device(key: str) -> OfDevice | None:
    """Return kind and number of the device, and its key, of a varied key such as "damper_2_force_kN"; None for other keys."""
    device = _OF_DEVICE.fullmatch(key)
    return device and OfDevice(device[1], int(device[2]), device[3])


def unit_with_exponent(unit: str, exponent: float | None) -> str:
    """Return a unit with its exponent a replaced by a number: "kN (s/m)^0.3"; "kN s/m" for 1; unchanged for None."""
    if exponent is None:
        return unit
    return unit.replace("(s/m)^a", "s/m" if exponent == 1.0 else f"(s/m)^{exponent:g}")


def _exponent(case: Case, device: OfDevice) -> float | None:
    """Return the exponent of a device in a case of run.json, from the columns if it is varied; None if it has none."""
    of_kind = [values for values in devices(case) if values[DEVICE] == device.kind]
    fixed = next((values.get("exponent") for values in of_kind[device.number - 1 :]), None)
    return case["columns"].get(f"{device.kind}_{device.number}_exponent", fixed)


def plain(value: float, digits: int) -> str:
    """Format a number to ``digits`` significant digits without an "e": "0.35", "4500", "45,000", "2.5 × 10⁶".

    Up to six integer digits are kept in full, with a comma from five on; numbers that have more once rounded, or are below
    1e-4, are written with a power of ten.
    """
    whole = len(str(int(abs(value))))
    rounded = float(f"{value:.{max(digits, whole)}g}")
    if rounded == 0.0 or 1e-4 <= abs(rounded) < 1e6:
        return f"{rounded:,.10g}" if abs(rounded) >= 1e4 else f"{rounded:.10g}"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{float(mantissa):.10g} × 10{str(int(exponent)).translate(_RAISED)}"


def distinguishing_digits(values: Iterable[object], least: int = 3) -> int:
    """Return the fewest significant digits, from ``least`` to 10, that distinguish all numbers among ``values``."""
    numbers = {value for value in values if isinstance(value, float | int)}
    return next((n for n in range(least, 10) if len({f"{value:.{n}g}" for value in numbers}) == len(numbers)), 10)
