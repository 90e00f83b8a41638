"""Fragility curves as output: points and capacities as tables, fits and bands for fragility.json."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from rockbatch.analyses.fragility.bounds import STATIONS_OF_INTERVAL, NoCurve, Values, is_among
from rockbatch.analyses.fragility.cloud_tables import described_cloud, note_on_cloud
from rockbatch.analyses.fragility.curves import Curve, Fitted
from rockbatch.analyses.fragility.ida import Capacity
from rockbatch.analyses.fragility.limit_states import words
from rockbatch.analyses.fragility.lognormal import Contribution, Lognormal
from rockbatch.analyses.fragility.quantities import bound_in_words
from rockbatch.analyses.fragility.risk import (
    Risk,
    RiskBound,
    described_bound,
    described_hazard,
    finite_or_nan,
)
from rockbatch.analyses.fragility.risk import described as described_risk
from rockbatch.analyses.fragility.runs import LevelPlan
from rockbatch.analyses.fragility.study import FragilitySpec
from rockbatch.analyses.fragility.windows import Windows
from rockbatch.batch.listening import count
from rockbatch.common.lazy import pd
from rockbatch.study import Case, Study

POINTS, CAPACITIES, RUNS = "fragility.csv", "fragility_capacities.csv", "fragility_runs.csv"
SAMPLES = 80
"""Points of a curve and its band."""


def points(curves: Sequence[Curve], spec: FragilitySpec, varied: Sequence[str]) -> "pd.DataFrame":
    """Return fragility.csv: a row for each curve and level, with the counts of :class:`Stripe` as columns, ``records`` as ``n``.

    ``p`` is the curve there; it is between ``p_low`` and ``p_high``, whatever the undecided runs of all levels come to.
    ``p_total`` is the curve with the dispersion that the study adds, if it does. Of incremental dynamic analysis
    ``window_share`` is the share of the scales about the level that exceed the limit, the mean of ``window_n`` records, in which
    ``window_undecided`` runs are not; ``window_p`` is the curve through these shares.
    """
    rows: list[dict[str, object]] = []
    for curve in curves:
        units = {"measure": spec.label, "unit": spec.unit}
        x = np.array([stripe.level for stripe in curve.stripes])  # of a cloud, several runs may have the same
        p = _probabilities(curve, x)
        if spec.added:
            p["p_total"] = (
                p["p"] if isinstance(curve.fitted, NoCurve) else curve.fitted.widened(spec.added).probability(x)
            )
        if spec.method == "ida":
            p |= _of_windows(curve.windows, spec)
        rows += [
            curve.identity(varied) | units | stripe._asdict() | {name: values[i].item() for name, values in p.items()}
            for i, stripe in enumerate(curve.stripes)
        ]
    return pd.DataFrame(rows).rename(columns={"records": "n"})


def _probabilities(curve: Curve, x: Values) -> dict[str, Values]:
    """Return p, P(x) of a curve, NaN without one, and p_low and p_high, between which undecided runs leave it, p without any."""
    p = np.full(len(x), np.nan) if isinstance(curve.fitted, NoCurve) else curve.fitted.probability(x)
    low, high = curve.readings.probability(x) if curve.readings else (p, p)
    return {"p": p, "p_low": np.fmin(low, p), "p_high": np.fmax(high, p)}


def _of_windows(windows: Windows | None, spec: FragilitySpec) -> dict[str, npt.NDArray[Any]]:
    """Return window_share, window_n, window_undecided and window_p, each with a value for every level.

    All are NaN without windows, and window_p without a fitted curve.
    """
    nothing = np.full(len(spec.levels), np.nan)
    if windows is None:
        return dict.fromkeys(("window_share", "window_n", "window_undecided", "window_p"), nothing)
    fitted = windows.fitted
    p = nothing if isinstance(fitted, NoCurve) else fitted.probability(np.array(spec.levels))
    counts = {"window_n": np.array(windows.records), "window_undecided": np.array(windows.undecided)}
    return {"window_share": np.array(windows.shares), **counts, "window_p": p}


def capacities(
    curves: Sequence[Curve],
    spec: FragilitySpec,
    varied: Sequence[str],
    names: Sequence[str],
    plans: Sequence[LevelPlan],
    cases: Sequence[Case],
) -> "pd.DataFrame":
    """Return fragility_capacities.csv: a row for each curve and record that counts.

    A capacity is above ``above`` and at most ``at_most`` by the runs that are decided, in the unit of the levels; the same as
    scales of the record; the latter is empty if no run exceeds it. ``found`` is "exceeded", "below the lowest level", "beyond the
    highest level", or "undecided" if some runs below it are, ``undecided`` in number: if they exceed the limit it is at most
    ``if_exceeded``, if they withstand it above ``if_withstood``. ``widest_step`` is the greatest relative step between runs
    below it: an island of exceedance that is narrower may have been missed.
    ``names`` are those of the motions; ``plans`` have the intensities of the ``cases``, of which each record has its own.
    """
    rows: list[dict[str, object]] = []
    for curve in curves:
        for (number, motion), cap in curve.capacities:
            of_pier = {"case": cases[number].name} | {name: cases[number].columns.get(name) for name in varied}
            bounds = {"above": cap.decided.low, "at_most": finite_or_nan(cap.decided.high)}
            otherwise = {
                "if_exceeded": finite_or_nan(cap.if_exceeded.high) if cap.undecided else math.nan,
                "if_withstood": cap.if_withstood.low if cap.undecided else math.nan,
            }
            rows.append(
                {"record": names[motion], **curve.identity(varied), **of_pier, "measure": spec.label, "unit": spec.unit}
                | {"found": _state(cap), **bounds}
                | {f"scale_{name}": plans[number].scale(motion, bound) for name, bound in bounds.items()}
                | {"undecided": cap.undecided, **otherwise, "returns": cap.returns, "widest_step": cap.widest_step}
            )
    return pd.DataFrame(rows)


def _state(cap: Capacity) -> str:
    if cap.undecided:
        return "undecided"
    if math.isinf(cap.decided.high):
        return "beyond the highest level"
    return "below the lowest level" if cap.decided.low == 0 else "exceeded"


def described(
    curves: Sequence[Curve],
    spec: FragilitySpec,
    study: Study,
    records: int,
    known: Sequence[Risk] = (),
    bounds: Sequence[RiskBound] = (),
) -> dict[str, object]:
    """Return the content of fragility.json: the settings and every curve; an infinite bound of an interval is null."""
    of_curves = {id(risk.curve): described_risk(risk, spec) for risk in known}
    of_curves |= {id(risk.curve): described_bound(risk, spec) for risk in bounds}
    return {
        "method": spec.method,
        "measure": spec.label,
        "unit": spec.unit,
        "levels": spec.levels,
        "tolerance": spec.tolerance if spec.method == "ida" else None,
        "confidence": spec.confidence,
        "records": records,
        "polarities": study.motions.polarity,
        "looked_at": looked_at(curves, spec),
        "by_shares": by_shares(curves),
        "dispersions": [asdict(dispersion) for dispersion in spec.dispersions],
        "drawn": drawn(spec),
        "hazard": described_hazard(spec),
        "curves": [_described(curve, spec) | {"risk": of_curves.get(id(curve))} for curve in curves],
    }


def drawn(spec: FragilitySpec) -> str:
    """Return how often inputs are drawn, and which: "drawn once for each record: alpha lognormal 0.1 (seed 1)"; or ""."""
    often = {"ida": "once for each record", "cloud": "once for each run"}.get(
        spec.method, "once for each record and level"
    )
    return f"drawn {often}: {spec.uncertain.words}" if spec.uncertain.inputs else ""


def looked_at(curves: Sequence[Curve], spec: FragilitySpec) -> str:
    """Return where first exceedances were sought, "first exceedances were looked for in steps of 0.25 % …".

    Cases with runs between the levels come first, then those with runs at the levels alone, by their names. Empty unless the
    method is "ida".
    """
    if spec.method != "ida":
        return ""
    hunted = {curve.case.name: step for curve in curves if (step := spec.step_on(curve.case.base)) is not None}
    not_hunted = list(dict.fromkeys(curve.case.name for curve in curves if curve.case.name not in hunted))
    parts = []
    if hunted:
        width = f"{100 * next(iter(hunted.values())):g} %"
        parts.append(
            f"in steps of {width} from the lowest level up ({', '.join(hunted)}): narrower islands of exceedance may lie below"
        )
    if not_hunted:
        apart = max(high / low - 1.0 for low, high in pairwise(spec.levels))
        parts.append(
            f"at the levels alone, up to {100 * apart:.0f} % apart ({', '.join(not_hunted)}): an exceedance between two of them, "
            "below the first on the levels, is missed, and the median may be too high; hunt_step in [fragility] looks there too"
        )
    return "first exceedances were looked for " + "; ".join(parts)


def _looked(curve: Curve, spec: FragilitySpec) -> list[tuple[float, float]]:
    """Return the intervals of intensity in which runs are close: from the lowest level to the greatest first exceedance, or to
    the highest level; where nothing is run between the levels, the window about each, of no width if it has none.
    """
    if spec.step_on(curve.case.base) is None:
        width = spec.window_on(curve.case.base) or 0.0
        return [(level * (1.0 - width), level * (1.0 + width)) for level in spec.levels]
    return [(spec.levels[0], min(spec.levels[-1], max((cap.decided.high for _, cap in curve.capacities), default=0.0)))]


def _described(curve: Curve, spec: FragilitySpec) -> dict[str, object]:
    fitted, readings = curve.fitted, curve.readings
    content: dict[str, object] = {
        "case": curve.case.name,
        "columns": curve.case.columns,
        "limit_state": curve.limit.name,
        "words": words(curve.limit),
        "piers": curve.cases,
        "reason": curve.limit.reason,
        "counting": curve.limit.counting,
        "median": None,
        "median_bound": _bound(fitted, spec.confidence),
        "median_interval": None,
        "dispersion": None,
        "dispersion_interval": None,
        "no_curve": fitted.reason if isinstance(fitted, NoCurve) else None,
        "stations": None if isinstance(fitted, NoCurve) else fitted.stations,
        "note": note(curve, spec),
        "undecided": curve.undecided._asdict(),
        "says_little": curve.inconclusive,
        "median_undecided": _finite(readings.medians) if readings else None,
        "points": [stripe._asdict() for stripe in curve.stripes],
        "capacities": [_finite(cap.decided) for _, cap in curve.capacities],
        "looked": _looked(curve, spec) if spec.method == "ida" else [],
    }
    x = np.linspace(0.0, 1.1 * spec.levels[-1], SAMPLES + 1)[1:]
    if isinstance(curve.drawn_share, Contribution):
        each = zip(curve.drawn_share.effects, curve.drawn_share.errors, strict=True)
        effects = {name: {"effect": s, "error": error} for name, (s, error) in zip(curve.drawn, each, strict=True)}
        share = {"dispersion": curve.drawn_share.dispersion, "dispersion_interval": curve.drawn_share.interval}
        content["drawn"] = share | {"inputs": effects}
    if curve.cloud:
        content["cloud"] = described_cloud(curve, spec)
    if curve.windows:
        content["windows"] = _described_windows(curve.windows, fitted, x)
    if readings:
        p = _probabilities(curve, x)
        content["open"] = _rounded({"x": x, "low": p["p_low"], "high": p["p_high"]})
    if not isinstance(fitted, NoCurve):
        drawn, band = {"x": x, "p": fitted.probability(x)}, fitted.band(x)
        if band is not None:
            drawn |= {"low": band[0], "high": band[1]}
        content |= {
            "median": _or_none(fitted.median),
            "median_interval": _finite_or_none(fitted.median_interval),
            "dispersion": _or_none(fitted.dispersion),
            "dispersion_interval": _finite_or_none(fitted.dispersion_interval),
            "curve": _rounded(drawn),
        }
        if isinstance(fitted, Lognormal):
            content["most_likely_dispersion"] = fitted.most_likely_dispersion
        if spec.added:
            total = fitted.widened(spec.added)
            content["dispersion_total"] = _or_none(total.dispersion)
            content["total"] = _rounded({"x": x, "p": total.probability(x)})
    return content


def _described_windows(windows: Windows, first: object, x: Values) -> dict[str, object]:
    """Return width, shares and records of the windows and, of the curve through the shares, median, interval, dispersion and
    points.

    ``above`` is its median relative to that of ``first``, less 1. Without a curve the median is None, and the others of it are
    missing.
    """
    shares = [_or_none(share) for share in windows.shares]
    content: dict[str, object] = {"width": windows.width, "shares": shares, "records": windows.records, "median": None}
    if not isinstance(fitted := windows.fitted, NoCurve):
        content |= {
            "median": _or_none(fitted.median),
            "median_interval": _finite_or_none(fitted.median_interval),
            "dispersion": _or_none(fitted.dispersion),
            "above": windows.above(first),
            "curve": _rounded({"x": x, "p": fitted.probability(x)}),
        }
    return content


def by_shares(curves: Sequence[Curve]) -> str:
    """Return an explanation of the median by shares; empty without windows."""
    widths = [f"{100 * curve.windows.width:g} %" for curve in curves if curve.windows]
    if not widths:
        return ""
    return (
        f"by shares: the median of a curve through the share of the scales within ±{widths[0]} of each level that exceed the "
        "limit, which does not depend on the search"
    )


def _rounded(drawn: dict[str, Values]) -> dict[str, list[float]]:
    return {name: [round(float(value), 6) for value in values] for name, values in drawn.items()}


def _or_none(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _bound(fitted: Fitted | NoCurve, confidence: float) -> dict[str, object] | None:
    """Return the bound of an unknown median, "below", "above" or "between", with its intensities and confidence; None without."""
    if not isinstance(fitted, NoCurve) or not fitted.is_bound:
        return None
    low, high = fitted.above or None, _or_none(fitted.below)
    kind = "above" if high is None else "below" if low is None else "between"
    return {"is": kind, "above": low, "below": high, "confidence": confidence}


def _finite_or_none(bounds: tuple[float, float] | None) -> list[float | None] | None:
    return None if bounds is None else _finite(bounds)


def _finite(bounds: tuple[float, float]) -> list[float | None]:
    """Return ``bounds`` with None for infinity, which JSON does not have."""
    return [bound if math.isfinite(bound) else None for bound in bounds]


def note(curve: Curve, spec: FragilitySpec) -> str:
    """Return the remarks on a curve, parted by semicolons, with the bound of a median that has no value, or why; "" for none."""
    fitted = curve.fitted
    notes = [_about_undecided(curve)]
    if isinstance(fitted, NoCurve):
        bound = _bound(fitted, spec.confidence)
        median = f"the median is {bound_in_words(bound, spec.label, spec.unit)}: " if bound else ""
        notes.append(median + fitted.reason)
    else:
        if not is_among(fitted.median, spec.levels[0], spec.levels[-1]):  # of a cloud, whose line goes on
            notes.append("the median is extrapolated beyond the intensities that were run")
        if fitted.median_interval is None:
            stations = count(fitted.stations, "station")
            notes.append(
                f"no intervals: records of {stations}, and {STATIONS_OF_INTERVAL} are needed to estimate their scatter"
            )
        ends = [bound for interval in (fitted.median_interval, fitted.dispersion_interval) for bound in interval or ()]
        if any(map(math.isinf, ends)):
            notes.append("the records leave the intervals open: more of them, or other levels, would close them")
    if curve.cases > 1:
        notes.append(f"shared by {curve.cases} piers, each axis counted as one")
    if curve.cloud:
        notes += note_on_cloud(curve, spec)
    notes.append(_about_drawn(curve))
    if curve.windows and isinstance(curve.windows.fitted, NoCurve) and curve.windows.fitted != fitted:
        notes.append(f"no median by shares: {curve.windows.fitted.reason}")
    if returning := sum(cap.returns > 0 for _, cap in curve.capacities):
        words = "withstands a level above its" if returning == 1 else "withstand a level above their"
        notes.append(f"{returning} of {len(curve.capacities)} records {words} first exceedance")
    return "; ".join(filter(None, notes))


def _about_undecided(curve: Curve) -> str:
    """Return the number of undecided runs and the medians with them beyond and within the limit; empty without any.

    If all of them are above the first exceedance of their record, it says that they change nothing.
    """
    remark = curve.undecided.words
    if not remark:
        return ""
    if curve.readings is None:
        return f"{remark}, above the first exceedance of their records, where they change nothing"
    beyond, within = (
        f"no curve ({fit.reason})" if isinstance(fit, NoCurve) else f"a median of {fit.median:.4g}"
        for fit in curve.readings
    )
    ways = f"if beyond the limit they would give {beyond}, if within it {within}"
    remark += f"; they are left out: {ways if beyond != within else f'either way they would give {beyond}'}"
    return f"says little: {remark}" if curve.inconclusive else remark


def _about_drawn(curve: Curve) -> str:
    """Return the effect of each drawn input on the capacity, "… by alpha +5.0 ± 1.2 %, eta -2.0 ± 0.8 %", or why it is unknown.

    Empty if none is drawn, or if there is no curve for that same reason.
    """
    share = curve.drawn_share
    if share is None or share == curve.fitted:  # there is no curve, for the same reason
        return ""
    if isinstance(share, NoCurve):
        return f"what the drawn inputs contribute is not known: {share.reason}"
    effects = ", ".join(
        f"{name} {100 * effect:+.1f} ± {100 * error:.1f} %"
        for name, effect, error in zip(curve.drawn, share.effects, share.errors, strict=True)
    )
    return f"a standard deviation of a drawn input changes the capacity by {effects}"
