"""Quantities of ``curves`` in fragility.json, as the terminal and the page show them: heads, formats and meanings."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from rockbatch.reporting.markup import Markup, interval
from rockbatch.reporting.table import Head

Curve = Mapping[str, Any]
"""One of ``curves`` of fragility.json."""

FEW = 3
"""Records beyond a limit, fewer of which leave the curve of a cloud an extrapolation."""


def level_of(info: Mapping[str, Any]) -> str:
    """Return the level of the intervals in words."""
    return f"{100 * info['confidence']:g} %"


def of_curves(info: Mapping[str, Any]) -> list[Head]:
    """Return the quantities of a fitted curve."""
    level = level_of(info)
    return [
        Head(f"median [{info['unit']}]", ".3g", f"θ: the {info['measure']} that half of the motions need", value="median"),
        Head(level, note="profile-likelihood interval of the median", value=_interval("median_interval")),
        Head(
            "undecided", note="the median with all undecided runs beyond the limit, and with all within it",
            value=_interval("median_undecided"),
        ),
        Head("dispersion", ".2f", "β: standard deviation of the logarithm", value="dispersion"),
        Head(level, note="profile-likelihood interval of the dispersion", value=_interval("dispersion_interval")),
        Head("of it drawn", ".2f", "what the drawn inputs contribute to β, as a root of squares",
             value=lambda curve: _drawn(curve).get("dispersion")),
        Head(level, note="interval of what the drawn inputs contribute, by the standard error of its square",
             value=lambda curve: _interval("dispersion_interval")(_drawn(curve))),
        Head("with added", ".2f", "β with the dispersions that the study adds, by the root of the squares",
             value="dispersion_total"),
        Head("by shares", ".3g", info.get("by_shares"), value=lambda curve: curve.get("windows", {}).get("median")),
        Head("apart [%]", "+.1f", "by shares, above that of the first exceedances [%]", value=_apart),
    ]  # fmt: skip


def of_rates(info: Mapping[str, Any], written: Callable[[float], str]) -> list[Head]:
    """Return the quantities of the annual rate of a curve, whose ``risk`` has the columns of fragility_risk.csv.

    ``written`` formats a rate.
    """
    level = level_of(info)
    return [
        Head("dispersion", ".2f", "β with what the study adds", value=lambda curve: curve["risk"]["dispersion_total"]),
        Head("rate [1/year]", note="mean annual rate of exceedance", value=lambda curve: written(curve["risk"]["rate_per_year"])),
        Head(level, note="what the fit leaves of the rate", value=_rates("rate_low", "rate_high", written)),
        Head("undecided", note="the rate with all undecided runs within the limit, and with all beyond it",
             value=_rates("rate_if_withstood", "rate_if_exceeded", written)),
        *(Head(f"in {years:g} years", note=f"probability of at least one exceedance, and what the fit leaves of it ({level})",
               value=_probability(f"p_in_{years:g}_years")) for years in info["hazard"]["years"]),
        Head(f"90 % come from [{info['unit']}]", note="intensities that contribute, but for 5 % at either end",
             value=_contributing),
    ]  # fmt: skip


def _drawn(curve: Curve) -> Mapping[str, Any]:
    """Return what drawn inputs contribute to a curve; empty if nothing is drawn, or that is not known."""
    contribution: Mapping[str, Any] = curve.get("drawn", {})
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


def _rates(low: str, high: str, written: Callable[[float], str]) -> Callable[[Curve], Markup]:
    def bounds(curve: Curve) -> Markup:
        rates = [curve["risk"][name] for name in (low, high)]
        if rates == [None, None]:
            return Markup("")
        return interval(*("∞" if rate is None else written(rate) for rate in rates))

    return bounds


def _probability(name: str) -> Callable[[Curve], Markup]:
    def written(curve: Curve) -> Markup:
        value, low, high = (percent(curve["risk"][key]) for key in (name, f"{name}_low", f"{name}_high"))
        return Markup(f"{value}\u00a0% ({interval(low, high)})")

    return written


def power(value: float) -> str:
    """Return a rate with a power of ten: "7.4·10⁻⁴"."""
    digits, exponent = f"{value:.1e}".split("e")
    return f"{digits}·10{str(int(exponent)).translate(_RAISED)}"


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def percent(p: float) -> str:
    """Return a probability in per cent with two digits, without exponent where it is all but certain."""
    return "100" if p >= 0.995 else f"{100.0 * p:.2g}"


def _contributing(curve: Curve) -> Markup:
    return interval(*(f"{curve['risk'][name]:.2g}" for name in ("contributing_from", "contributing_to")))
