"""Annual rates at which limits are exceeded: fragility curves times the hazard of the site.

The mean annual rate is λ = ∫ P(x) |dν(x)| (Cornell, Jalayer, Hamburger & Foutch 2002, J. Struct. Eng. 128(4):526–533), and the
probability in T years 1 − exp(−λT), as of a Poisson process.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rockbatch.analyses.fragility.bounds import Interval, NoCurve, Values
from rockbatch.analyses.fragility.curves import Curve, Fitted
from rockbatch.analyses.fragility.study import FragilitySpec
from rockbatch.common.lazy import pd
from rockbatch.motions.suites.hazard import MOST_RATE, HazardCurve

RISK, DEAGGREGATION = "fragility_risk.csv", "fragility_deaggregation.csv"

NOTABLE = 0.05
"""Share of a rate from which a remark says what it rests on."""

MIDDLE = (0.05, 0.95)
"""Shares of a rate between which the intensities lie that are named as those that contribute."""

BY_MEDIAN = (
    "half of the rate of motions at the bound of the median: of these and stronger ones half or more exceed the limit"
)
BEYOND_HAZARD = (
    "what the points of the hazard contribute: with its first slope below them the rate would be more than that of its weakest "
    "motions, so that it has to begin at weaker ones"
)
"""Notes on bounds of a rate."""

BINS_PER_DECADE, POINTS_PER_BIN = 10, 50


@dataclass(frozen=True)
class Risk:
    """The mean annual rate at which a case exceeds a limit."""

    curve: Curve
    total: Fitted  # its curve with the added dispersion
    rate: float  # mean annual rate of exceedance
    # What the fit of the fragility leaves open; the upper bound may be infinite. The hazard is taken as known. None with fewer
    # than five stations.
    interval: Interval | None
    # the rates with all undecided runs counted as within the limit, and as beyond it; None without any
    undecided: tuple[float, float] | None
    # parts of the rate from intensities below and above the hazard's points, where its end slopes go on
    below: float
    above: float
    # the rate whatever the hazard is above its highest point: with the fragility there as it is at that point, and 1
    bounds: tuple[float, float]
    # parts from intensities below and above the levels that were run, where the curve is an extrapolation
    beyond_levels: tuple[float, float]
    contributing: tuple[float, float]  # intensities between which nine tenths of the rate come about


@dataclass(frozen=True)
class RiskBound:
    """The lower bound, ``least``, of the rate of a case whose median has a bound only, or whose rate is beyond the hazard.

    It has the confidence of the intervals. ``note`` says what it is.
    """

    curve: Curve
    least: float
    note: str


def risks(curves: Sequence[Curve], spec: FragilitySpec) -> tuple[list[Risk], list[RiskBound]]:
    """Return the annual rate of every fitted curve, and bounds if a median has an upper one or a rate is beyond the hazard.

    Both are empty without a hazard. A lower bound of a median bounds no rate: of weaker and more frequent motions, up to half
    may exceed the limit.
    """
    known: list[Risk] = []
    bounds: list[RiskBound] = []
    if spec.hazard is None:
        return known, bounds
    hazard = spec.hazard.curve
    x, rates = hazard.quadrature()
    for curve in curves:
        if isinstance(curve.fitted, NoCurve):
            if math.isfinite(below := _below(curve)):
                bounds.append(RiskBound(curve, 0.5 * float(hazard.rate([below])[0]), BY_MEDIAN))
            continue
        total = curve.fitted.widened(spec.added)
        if float(total.probability(x) @ rates) <= _meaningful(hazard):
            known.append(_risk(curve, total, spec, hazard, x, rates))
        elif (least := total.rate(*_of_points(hazard, x, rates))[1]) > 0:
            bounds.append(RiskBound(curve, least, BEYOND_HAZARD))
    return known, bounds


def _below(curve: Curve) -> float:
    """Return the bound of a median from above, also if undecided runs are within the limit; infinite if there is none."""
    readings = [curve.fitted, curve.readings.withstood] if curve.readings else [curve.fitted]
    return max(reading.below if isinstance(reading, NoCurve) else math.inf for reading in readings)


def _risk(curve: Curve, total: Fitted, spec: FragilitySpec, hazard: HazardCurve, x: Values, rates: Values) -> Risk:
    rate, least, most = total.rate(x, rates)
    if most > _meaningful(hazard):
        most = math.inf
    yearly = total.probability(x) * rates
    first, last = hazard.ends
    below, above = float(yearly[x < first].sum()), float(yearly[x > last].sum())
    points, weights = _of_points(hazard, x, rates)
    least_of_points = float(total.probability(points) @ weights)
    passed = (np.cumsum(yearly) - 0.5 * yearly) / rate if rate > 0 else np.linspace(0.0, 1.0, len(x))
    low, high = (float(np.exp(np.interp(share, passed, np.log(x)))) for share in MIDDLE)
    return Risk(
        curve,
        total,
        rate,
        None if math.isnan(least) else (least, most),
        _undecided(curve, spec.added, x, rates),
        below,
        above,
        (below + least_of_points, rate - above + float(hazard.rate([last])[0])),
        (float(yearly[x < spec.levels[0]].sum()), float(yearly[x > spec.levels[-1]].sum())),
        (low, high),
    )


def _of_points(hazard: HazardCurve, x: Values, rates: Values) -> tuple[Values, Values]:
    """Return intensities from the lowest point of the hazard on and the rates about them; stronger motions count at the highest.

    The rate is then a sum, as what is below the lowest point may be greater by many orders.
    """
    first, last = hazard.ends
    within = (first <= x) & (x <= last)
    return np.append(x[within], last), np.append(rates[within], hazard.rate([last]))


def _meaningful(hazard: HazardCurve) -> float:
    """Return the greatest meaningful rate: that of the lowest point, or 100 per year for a single point."""
    return hazard.rates[0] if len(hazard.rates) > 1 else MOST_RATE


def _undecided(curve: Curve, added: float, x: Values, rates: Values) -> tuple[float, float] | None:
    """Return annual rates, lower first, with undecided runs within and beyond the limit.

    0 or infinite for a reading without a curve; None if no run is undecided.
    """
    if curve.readings is None:
        return None
    bounds = []
    for reading, rate_of_tail in ((curve.readings.withstood, 0.0), (curve.readings.exceeded, math.inf)):
        bounds.append(rate_of_tail if isinstance(reading, NoCurve) else reading.widened(added).rate(x, rates)[0])
    return min(bounds), max(bounds)


def note(risk: Risk, spec: FragilitySpec) -> str:
    """Return remarks on a rate's validity, such as parts above NOTABLE, 5 %, from beyond the hazard or the levels; "" if none."""
    assert spec.hazard is not None
    notes, points = [], spec.hazard.curve.levels
    if risk.interval is not None and math.isinf(risk.interval[1]):
        notes.append(
            "the records leave the upper bound of the rate open: more often than the weakest motions of the hazard"
        )
    if len(points) == 1:
        notes.append("all of the rate rests on the slope through one point of the hazard")
    elif risk.above > NOTABLE * risk.rate:
        low, high = risk.bounds
        notes.append(
            f"{_share(risk.above, risk)} of the rate comes from above the hazard's highest point, where its last slope goes on: "
            f"whatever the hazard is there, the fit has a rate between {low:.3g} and {high:.3g}"
        )
    if len(points) > 1 and risk.below > NOTABLE * risk.rate:
        notes.append(
            f"{_share(risk.below, risk)} comes from below its lowest point, extrapolated by its first slope, though "
            f"hazard curves flatten there: the rate is rather too high"
        )
    weaker, stronger = risk.beyond_levels
    if weaker > NOTABLE * risk.rate:
        notes.append(
            f"{_share(weaker, risk)} comes from below the lowest intensity that was run, {spec.levels[0]:.3g} {spec.unit}: "
            "from the tail of the fitted curve, where nothing was run"
        )
    if stronger > NOTABLE * risk.rate:
        notes.append(
            f"{_share(stronger, risk)} comes from above the highest that was run, {spec.levels[-1]:.3g} {spec.unit}"
        )
    if risk.rate * max(spec.hazard.years) > 3.0:
        notes.append("several exceedances in the longest of the periods: the probability is close to 1 for any pier")
    return "; ".join(notes)


def _share(part: float, risk: Risk) -> str:
    return f"{100 * part / risk.rate:.0f} %"


def risk_table(
    curves: Sequence[Curve],
    known: Sequence[Risk],
    bounds: Sequence[RiskBound],
    spec: FragilitySpec,
    varied: Sequence[str],
) -> "pd.DataFrame":
    """Return fragility_risk.csv: a row for each curve, with the fields of :class:`Risk`; an open bound is empty.

    ``bound`` is "at least" of a curve whose median or rate has a bound alone, with the confidence of the intervals, and else
    empty. There ``rate_per_year`` is empty, and ``rate_least`` is the bound. Without both there is the reason, as its ``note``.
    """
    of_curves = {id(risk.curve): _row(risk, spec, varied) for risk in known}
    of_curves |= {id(risk.curve): _row_of_bound(risk, spec, varied) for risk in bounds}
    rows = [of_curves.get(id(curve)) or curve.identity(varied) | {"note": _reason(curve)} for curve in curves]
    names = [name for name in _names(spec) if any(name in row for row in rows)]
    return pd.DataFrame(rows, columns=[*(curves[0].identity(varied) if curves else ()), *names])


def _reason(curve: Curve) -> str:
    return (
        curve.fitted.reason
        if isinstance(curve.fitted, NoCurve)
        else f"no bound of the rate: it would be {BEYOND_HAZARD}"
    )


def _names(spec: FragilitySpec) -> list[str]:
    """Return the columns of fragility_risk.csv after those that identify a curve, in order, whether or not any row has them."""
    assert spec.hazard is not None
    periods = [f"p_in_{years:g}_years{end}" for years in spec.hazard.years for end in ("", "_low", "_high")]
    rates = ["rate_per_year", "bound", "rate_low", "rate_high", "rate_if_withstood", "rate_if_exceeded"]
    parts = [
        "rate_below_points",
        "rate_above_points",
        "rate_least",
        "rate_most",
        "rate_below_levels",
        "rate_above_levels",
    ]
    about = ["measure", "unit", "median", "dispersion", "dispersion_added", "dispersion_total"]
    return [*about, *rates, *parts, "contributing_from", "contributing_to", *periods, "note"]


def _row_of_bound(risk: RiskBound, spec: FragilitySpec, varied: Sequence[str]) -> dict[str, object]:
    assert spec.hazard is not None
    row: dict[str, object] = risk.curve.identity(varied) | {"measure": spec.label, "unit": spec.unit}
    row |= {"bound": "at least", "rate_least": risk.least, "rate_most": math.nan}
    for years in spec.hazard.years:
        row |= {f"p_in_{years:g}_years_low": _probability(risk.least, years), f"p_in_{years:g}_years_high": 1.0}
    return row | {"note": risk.note}


def _probability(rate: float, years: float) -> float:
    return -math.expm1(-rate * years)


def _row(risk: Risk, spec: FragilitySpec, varied: Sequence[str]) -> dict[str, object]:
    curve, hazard = risk.curve, spec.hazard
    assert hazard is not None
    assert not isinstance(curve.fitted, NoCurve)
    row = curve.identity(varied) | {"measure": spec.label, "unit": spec.unit, "median": risk.total.median}
    row |= {
        "dispersion": curve.fitted.dispersion,
        "dispersion_added": spec.added,
        "dispersion_total": risk.total.dispersion,
    }
    ends = risk.interval or (math.nan, math.nan)
    low, high = map(finite_or_nan, ends)
    within, beyond = map(finite_or_nan, risk.undecided or (math.nan, math.nan))
    row |= {"rate_per_year": risk.rate, "bound": math.nan, "rate_low": low, "rate_high": high}
    row |= {"rate_if_withstood": within, "rate_if_exceeded": beyond}
    row |= {"rate_below_points": risk.below, "rate_above_points": risk.above}
    row |= {"rate_least": risk.bounds[0], "rate_most": risk.bounds[1]}
    row |= {"rate_below_levels": risk.beyond_levels[0], "rate_above_levels": risk.beyond_levels[1]}
    row |= {"contributing_from": risk.contributing[0], "contributing_to": risk.contributing[1]}
    for years in hazard.years:
        for end, rate in zip(("", "_low", "_high"), (risk.rate, *ends), strict=True):
            row[f"p_in_{years:g}_years{end}"] = _probability(rate, years)
    return row | {"note": note(risk, spec)}


def finite_or_nan(bound: float) -> float:
    """Return a bound for a CSV file, NaN (an empty cell) if it is infinite."""
    return bound if math.isfinite(bound) else math.nan


def deaggregation_table(risks: Sequence[Risk], spec: FragilitySpec, varied: Sequence[str]) -> "pd.DataFrame":
    """Return fragility_deaggregation.csv: for each curve the part of the rate from motions ``above`` one intensity up to another.

    ``hazard`` says whether they are between the points of the hazard, "within", or "below" or "above" them.
    """
    rows: list[dict[str, object]] = []
    for risk in risks:
        identity = risk.curve.identity(varied)
        for low, high, position, part in deaggregated(risk, spec):
            share = part / risk.rate if risk.rate > 0 else math.nan
            bin_ = {"above": low, "up_to": high, "unit": spec.unit, "hazard": position}
            rows.append(identity | bin_ | {"rate_per_year": part, "share": share})
    return pd.DataFrame(rows)


def deaggregated(risk: Risk, spec: FragilitySpec) -> list[tuple[float, float, str, float]]:
    """Return bins of intensity: low and high, "below", "within" or "above" the hazard's points, and the rate from each.

    There are ten a decade, cut at the ends of the hazard. The first and the last include what lies beyond them, a thousandth of
    the rate or less, so that the bins add up to the rate.
    """
    assert spec.hazard is not None
    x, rates = spec.hazard.curve.quadrature()
    passed = np.cumsum(risk.total.probability(x) * rates)
    ends = spec.hazard.curve.ends
    low, high = (float(np.exp(np.interp(share * risk.rate, passed, np.log(x)))) for share in (1e-3, 1.0 - 1e-3))
    first = math.floor(BINS_PER_DECADE * math.log10(low))
    last = max(math.ceil(BINS_PER_DECADE * math.log10(high)), first + 1)
    grid = 10.0 ** (np.arange(first, last + 1) / BINS_PER_DECADE)
    edges = np.unique(np.concatenate((grid, [end for end in ends if grid[0] < end < grid[-1]])))
    parts = []
    for points in (np.geomspace(*between, POINTS_PER_BIN) for between in pairwise(edges)):
        probability = risk.total.probability(np.sqrt(points[1:] * points[:-1]))
        parts.append(float(probability @ -np.diff(spec.hazard.curve.rate(points))))
    parts[0] += float(np.interp(math.log(edges[0]), np.log(x), passed))
    parts[-1] = risk.rate - sum(parts[:-1])
    middles = np.sqrt(edges[1:] * edges[:-1])
    positions = ("below" if m < ends[0] else "above" if m > ends[1] else "within" for m in middles)
    return list(zip(edges[:-1].tolist(), edges[1:].tolist(), positions, parts, strict=True))


def described_hazard(spec: FragilitySpec) -> dict[str, object] | None:
    """Return the hazard's entry in fragility.json: its points as ``levels`` and ``rates``, its settings, and ``drawn``.

    That is the curve through them, 60 points ``x`` and ``rate`` over levels of hazard and fragility; None without a hazard.
    """
    if spec.hazard is None:
        return None
    curve = spec.hazard.curve
    low, high = min(curve.ends[0], spec.levels[0]), max(curve.ends[1], spec.levels[-1])
    x = np.geomspace(low / 1.2, high * 1.2, 60)
    return {
        "levels": curve.levels,
        "rates": curve.rates,
        "slope": curve.slope,
        "shape": curve.shape,
        "misfit": curve.misfit,
        "years": spec.hazard.years,
        "source": spec.hazard.source,
        "file": spec.hazard.file,
        "drawn": {"x": x.tolist(), "rate": curve.rate(x).tolist()},
    }


def described_bound(risk: RiskBound, spec: FragilitySpec) -> dict[str, object]:
    """Return the bounds of a rate for fragility.json, under the names of a rate, None for what is not known."""
    return dict.fromkeys(_names(spec)) | _without_nan(_row_of_bound(risk, spec, ()))


def _without_nan(row: Mapping[str, object]) -> dict[str, object]:
    """Return a row without its case and limit state, None for NaN and infinite numbers."""
    named = {name: value for name, value in row.items() if name not in ("case", "limit_state")}
    return {
        name: None if isinstance(value, float) and not math.isfinite(value) else value for name, value in named.items()
    }


def described(risk: Risk, spec: FragilitySpec) -> dict[str, object]:
    """Return the entry of a curve's risk in fragility.json, with the share of the rate per unit of ln x unless the rate is 0."""
    content = _without_nan(_row(risk, spec, ()))
    if spec.hazard is not None and risk.rate > 0:
        curve, (low, high) = spec.hazard.curve, risk.contributing
        x = np.geomspace(low / 2.0, high * 2.0, 80)
        density = risk.total.probability(x) * curve.log_slope(x) * curve.rate(x) / risk.rate
        content["density"] = {"x": x.tolist(), "share": density.tolist()}
    return content
