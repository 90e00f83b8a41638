"""Quantities of ``curves`` in fragility.json, as the terminal and the page show them: heads, formats and meanings."""

import math
from collections.abc import Callable

from rockbatch.analyses.fragility.figures import label
from rockbatch.common.analyses import Entry
from rockbatch.quantities.labels import plain
from rockbatch.reporting.markup import Markup, interval
from rockbatch.reporting.table import Head

Curve = Entry
"""One of ``curves`` of fragility.json."""

FEW = 3
"""Records beyond a limit, fewer of which leave the curve of a cloud an extrapolation."""


def level_of(info: Entry) -> str:
    """Return the level of the intervals: "95 %"."""
    return f"{100 * info['confidence']:g} %"


def names_of_curves(info: Entry) -> tuple[Head, Head]:
    """Return the heads of the columns that name a curve: its limit and its case."""
    return Head("limit", value="limit_state"), Head("case", key=True, value=lambda curve: label(info, curve))


def of_curves(info: Entry) -> list[Head]:
    """Return the heads of a table of curves: medians, dispersions and their intervals."""
    level = level_of(info)
    return [
        Head(
            "median",
            ".3g",
            f"θ: the {info['measure']} that half of the motions need; < and > are bounds ({level})",
            unit=info["unit"],
            value=_median,
        ),
        Head(level, note="interval of the median, by stations", value=_interval("median_interval")),
        Head(
            "undecided",
            note="the median with all undecided runs beyond the limit, and with all within it",
            value=_interval("median_undecided"),
        ),
        Head(
            "dispersion",
            ".2f",
            "β: standard deviation of the logarithm, of the sample: its square is unbiased, as with n − 1",
            value="dispersion",
        ),
        Head(level, note="interval of the dispersion, by stations", value=_interval("dispersion_interval")),
        Head(
            "of it drawn",
            ".2f",
            "contribution of the drawn inputs to β, combined by the root of the sum of squares",
            value=lambda curve: _drawn(curve).get("dispersion"),
        ),
        Head(
            level,
            note="interval of the contribution of the drawn inputs, by the standard error of its square",
            value=lambda curve: _interval("dispersion_interval")(_drawn(curve)),
        ),
        Head(
            "with added",
            ".2f",
            "β with the dispersions that the study adds, by the root of the squares",
            value="dispersion_total",
        ),
        Head("by shares", ".3g", info.get("by_shares"), value=lambda curve: curve.get("windows", {}).get("median")),
        Head("apart", "+.1f", "by shares, above that of the first exceedances [%]", value=_apart, unit="%"),
    ]


def bound_in_words(bound: Entry, measure: str, unit: str) -> str:
    """Return the bound of a median: "below PGV 1.5 m/s (95 %)", "above …", or "between … and … (95 %)"."""
    ends = [bound[end] for end in ("above", "below") if bound[end] is not None]
    intensities = " and ".join(f"{measure} {plain(end, 3)} {unit}".strip() for end in ends)
    return f"{bound['is']} {intensities} ({100 * bound['confidence']:g} %)"


def _median(curve: Curve) -> object:
    """Return the median of a curve, or its bound in signs: "< 1.5"; None without either."""
    bound = curve.get("median_bound")
    if not bound:
        return curve["median"]
    if bound["is"] == "between":
        return interval(f"{bound['above']:.3g}", f"{bound['below']:.3g}")
    return f"{'>' if bound['is'] == 'above' else '<'} {bound[bound['is']]:.3g}"


def _head_of_years(years: float, level: str) -> Head:
    """Return the head of the probability of exceedance in some years, with its interval."""
    note = f"probability of at least one exceedance, and its interval by the fit ({level})"
    return Head(f"in {years:g} years", note=note, value=_probability(f"p_in_{years:g}_years", level))


def of_rates(info: Entry, written: Callable[[float], str]) -> list[Head]:
    """Return the heads of a table of annual rates, of curves whose ``risk`` has the columns of fragility_risk.csv.

    ``written`` formats a rate.
    """
    level = level_of(info)
    return [
        Head("dispersion", ".2f", "β with the added dispersion", value=lambda curve: curve["risk"]["dispersion_total"]),
        Head("rate", note="mean annual rate of exceedance", value=_rate(written, level), unit="1/year"),
        Head(level, note="interval of the rate by the fit", value=_rates("rate_low", "rate_high", written)),
        Head(
            "undecided",
            note="the rate with all undecided runs within the limit, and with all beyond it",
            value=_rates("rate_if_withstood", "rate_if_exceeded", written),
        ),
        *(_head_of_years(years, level) for years in info["hazard"]["years"]),
        Head(
            "90 % come from",
            note="intensities that contribute, but for 5 % at either end",
            unit=info["unit"],
            value=_contributing,
        ),
    ]


def _drawn(curve: Curve) -> Entry:
    """Return the entry ``drawn`` of a curve, with ``dispersion`` and its interval; {} if nothing is drawn, or it is unknown."""
    contribution: Entry = curve.get("drawn", {})
    return contribution


def _apart(curve: Curve) -> float | None:
    above = curve.get("windows", {}).get("above")
    return None if above is None else 100.0 * above


def _interval(name: str) -> Callable[[Curve], Markup]:
    def written(curve: Curve) -> Markup:
        if curve.get(name) is None:
            return Markup("")
        low, high = ("∞" if bound in (None, math.inf) else f"{bound:.3g}" for bound in curve[name])
        return interval(low, high)

    return written


def _rate(written: Callable[[float], str], level: str) -> Callable[[Curve], str]:
    """Return a function from a curve to its rate as ``written``, or its bound: "at least 2.1e-04 (95 %)"."""

    def rate(curve: Curve) -> str:
        risk = curve["risk"]
        if risk["bound"]:
            return f"{risk['bound']} {written(risk['rate_least'])} ({level})"
        return written(risk["rate_per_year"])

    return rate


def _rates(low: str, high: str, written: Callable[[float], str]) -> Callable[[Curve], Markup]:
    def bounds(curve: Curve) -> Markup:
        rates = [curve["risk"][name] for name in (low, high)]
        if rates == [None, None]:
            return Markup("")
        return interval(*("∞" if rate is None else written(rate) for rate in rates))

    return bounds


def _probability(name: str, level: str) -> Callable[[Curve], Markup]:
    def written(curve: Curve) -> Markup:
        value, low, high = (curve["risk"][key] for key in (name, f"{name}_low", f"{name}_high"))
        if bound := curve["risk"]["bound"]:
            return Markup(f"{bound} {percent(low)}\u00a0% ({level})")
        between = "" if low is None else f" ({interval(percent(low), percent(high))})"
        return Markup(f"{percent(value)}\u00a0%{between}")

    return written


def power(value: float) -> str:
    """Return a rate with a power of ten: "7.4·10⁻⁴"."""
    digits, exponent = f"{value:.1e}".split("e")
    return f"{digits}·10{str(int(exponent)).translate(_RAISED)}"


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def percent(p: float) -> str:
    """Return a probability in per cent with two digits, without the sign: "4.2", "1e-05", and "100" from 0.995 on."""
    return "100" if p >= 0.995 else f"{100.0 * p:.2g}"


def _contributing(curve: Curve) -> Markup:
    if curve["risk"]["bound"]:
        return Markup("")
    return interval(*(f"{curve['risk'][name]:.2g}" for name in ("contributing_from", "contributing_to")))
