"""The answer of a fragility in sentences: the weakest case, for overturning and for the limit that is exceeded first."""

import math
from collections.abc import Iterable, Iterator, Sequence

from rockbatch.analyses.fragility.bounds import is_among
from rockbatch.analyses.fragility.figures import label
from rockbatch.analyses.fragility.quantities import FEW, Curve, bound_in_words, level_of, percent, power
from rockbatch.common.analyses import Entry
from rockbatch.common.grouping import grouped
from rockbatch.common.showing import capital
from rockbatch.quantities.labels import plain
from rockbatch.reporting.finished_analysis import answered, sentence
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, join

NOTABLE = 0.2
"""Share of a rate that rests on an extrapolation, from which the answer says so."""
APART = 0.1
"""Relative distance of the median by shares from which it stands beside the other in the first sentence."""
MOST_NAMES = 3
"""Most cases that a remark names."""

Info = Entry
"""Content of fragility.json."""
Interval = Sequence[float | None] | None
"""Two ends, the upper None if it is infinite; None without an interval."""


def of_curves(info: Info) -> Markup:
    """Return sentences on the weakest case for overturning and for the limit exceeded first, and remarks.

    The limit exceeded first is the other limit with the lowest median, if that is below the median of overturning or below all
    levels; while the median of a further one is unknown, that is the lowest median that is known. Otherwise the second sentence
    says that no other limit is exceeded, or that none has a lower median. There is none for a single limit, or if a median of
    another limit is unknown.
    """
    overturning, *others = grouped(info["curves"], lambda curve: curve["limit_state"]).values()
    sentences = [_of_limit(info, overturning, capital(overturning[0]["limit_state"]))]
    weakest = min(others, key=_lowest, default=None)
    if weakest is not None and (_lowest(weakest) < _lowest(overturning) or _lowest(weakest) == 0.0):
        words = f" ({weakest[0]['words']})" if weakest[0]["words"] else ""
        open_ = any(_has_no_median(curve) for curve in info["curves"] if curve not in weakest)
        known = "The limit of the lowest median that is known"
        rank = known if open_ and _lowest(weakest) > 0.0 else "The limit exceeded first"
        sentences.append(_of_limit(info, weakest, f"{rank}, {weakest[0]['limit_state']}{words},"))
    elif others and all(_never(curve) for curves in others for curve in curves):
        sentences.append(sentence(f"No other limit is exceeded up to {_intensity(info, info['levels'][-1])}"))
    elif others and not any(_has_no_median(curve) for curves in others for curve in curves):
        sentences.append(sentence("No other limit has a lower median"))
    return answered(join(*sentences, between=" "), remarks=_of_all(info))


def of_rates(info: Info) -> Markup:
    """Return sentences on the highest annual rates of overturning and of another limit if it is, or may be, exceeded more often.

    Remarks say what they rest on.
    """
    by_limit = grouped(info["curves"], lambda curve: curve["limit_state"])
    known = {name: [curve for curve in curves if curve["risk"]] for name, curves in by_limit.items()}
    overturning, *_ = known
    often = max(known, key=lambda name: max((_rates(curve)[::-1] for curve in known[name]), default=(0.0, 0.0)))
    subjects = {name: capital(name) for name in (overturning, often)}
    if info["hazard"]["source"]:
        subjects[overturning] = f"With the hazard “{info['hazard']['source']}” {overturning}"
    sentences = [_of_rate(info, known[name], subject) for name, subject in subjects.items()]
    curves, remarks = info["curves"], list(_shared(info))
    if lost := sum(not curve["risk"] for curve in curves):
        remarks.insert(0, f"{lost} of {len(curves)} curves without a rate: their limits may be exceeded more often.")
    return answered(join(*sentences, between=" "), remarks=remarks)


def _of_limit(info: Info, curves: Sequence[Curve], subject: str) -> Markup:
    """Return the sentence about a limit: the case with the lowest median, or bound of it, and what leaves it in doubt.

    The case is called the lowest unless a median is unknown, or another one below all levels. Without a median and a bound the
    sentence says that no run decides, that no record reaches the limit, or why there is no curve.
    """
    curve = min(curves, key=_strength)
    decided = _decided(curve)
    total = sum(point["records"] - point["undecided"] for point in decided)
    unknown = any(map(_has_no_median, curves)) or any(_strength(other) == 0.0 for other in curves if other is not curve)
    rank = "one" if unknown else "the lowest"
    lowest = f"{label(info, curve)}, {rank} of {len(curves)} cases" if len(curves) > 1 else ""
    case = f" for {lowest}" if lowest else ""
    if curve["median"] is not None:
        said = f"has a median of {_median(info, curve)}{case}"
        said += _among(curve["median_interval"], [each["median_interval"] for each in curves if each is not curve])
    elif not total:
        said = "is decided by no run" + (f" in any of {len(curves)} cases" if case else "")
    elif _withstood(decided, curve):
        said = f"is not reached up to {_intensity(info, decided[-1]['level'])} by any of {_records(curve)}"
        said += f", in any of {len(curves)} cases" if case else ""
    elif curve.get("median_bound"):
        said = f"has a median {bound_in_words(curve['median_bound'], info['measure'], info['unit'])}"
        said += f", for {lowest}" if lowest else ""
        said += f": {curve['no_curve']}"
    else:
        said = f"has no median{case}: {curve.get('no_curve') or 'no curve could be fitted'}"
    return sentence(f"{subject} {said}", _left_open(info, curve, curves))


def _median(info: Info, curve: Curve) -> str:
    """Return the median: "PGV 0.62 m/s (95 % from 40 records: 0.5 to 0.7) and a dispersion of 0.40".

    The median by shares stands before the dispersion if it is APART, a tenth, or more from it.
    """
    if curve["median_interval"] is None:
        interval = f"from {_records(curve)}, no interval: {counted(curve['stations'], 'station')}"
    else:
        interval = f"{level_of(info)} from {_records(curve)}: {_bounds(curve['median_interval'])}"
    said = f"{_intensity(info, curve['median'])} ({interval})"
    windows = curve.get("windows", {})
    if windows.get("above") is not None and abs(windows["above"]) >= APART:
        said += f", by shares {_intensity(info, windows['median'])} ({100 * windows['above']:+.0f}\u00a0%),"
    return said if curve["dispersion"] is None else f"{said} and a dispersion of {curve['dispersion']:.2f}"


def _never(curve: Curve) -> bool:
    """Return whether every run at the levels is decided, and no run, there or between them, exceeds the limit."""
    points = curve["points"]
    return _withstood(points, curve) and not any(point["undecided"] for point in points)


def _left_open(info: Info, curve: Curve, curves: Sequence[Curve]) -> Iterator[str]:
    """Yield doubts about ``curve``, the lowest of ``curves``: undecided runs, extrapolation, a case that may be weaker."""
    undecided = sum(curve["undecided"][kind] for kind in ("flight", "failed", "other", "lower"))
    runs = f"{undecided} of {counted(curve['undecided']['runs'], 'run')}"
    if curve["says_little"]:
        bounds = _bounds(curve["median_undecided"])
        yield f"too many runs are undecided to say much, {runs}: with these on either side the median is {bounds}"
    elif curve["median"] is None and undecided:
        yield f"{runs} undecided"
    if curve["median"] is not None:
        if not is_among(curve["median"], info["levels"][0], info["levels"][-1]):
            ends = " to ".join(plain(info["levels"][end], 3) for end in (0, -1))
            yield f"an extrapolation, as runs are at {ends} {info['unit']}"
        if "cloud" in curve and (beyond := sum(point["exceeded"] for point in curve["points"])) < FEW:
            yield f"only {counted(beyond, 'record')} beyond the limit"
    doubtful = [other for other in curves if other is not curve and other["median_undecided"]]
    least = min(doubtful, key=lambda other: other["median_undecided"][0] or 0.0, default=None)
    if least is not None and (low := least["median_undecided"][0] or 0.0) < _strength(curve):
        yield f"{label(info, least)} may be weaker, down to {plain(low, 3)}, as runs of it are undecided"


def _of_all(info: Info) -> Iterator[str]:
    """Yield remarks that may change a decision: curves without a median, undecided runs, what records share, unsearched gaps.

    Of a single curve the first two are in its sentence.
    """
    curves = info["curves"]
    if len(curves) > 1:  # else the sentence has said it
        if lost := sum(map(_has_no_median, curves)):
            have = "has" if lost == 1 else "have"
            yield f"{lost} of {len(curves)} curves {have} no median within the levels: the table says why."
        if little := sum(curve["says_little"] for curve in curves):
            yield f"{little} of {len(curves)} curves {'says' if little == 1 else 'say'} little: too many runs are undecided."
    yield from _shared(info)
    if gaps := [curve for curve in curves if len(curve.get("looked", ())) > 1]:
        cases = _cases(info, gaps)
        yield f"Between the levels nothing was run in {cases}: a first exceedance there is missed, and medians may be too high."


def _shared(info: Info) -> Iterator[str]:
    """Yield the basis of intervals if records share a station or an earthquake; nothing if each has its own."""
    stations, events = info.get("stations", info["records"]), info.get("events", 0)
    if info.get("by") == "event":
        yield f"Intervals are by earthquake: the records come from {counted(events, 'earthquake')}."
        return
    if stations < info["records"]:
        yield f"Intervals are by station: the {info['records']} records are components of {counted(stations, 'station')}."
    if 0 < events < stations:
        alone = counted(events, "earthquake")
        yield f"The stations recorded {alone}: what differs from one to another is not in the intervals."


def _of_rate(info: Info, curves: Sequence[Curve], subject: str) -> Markup:
    """Return the sentence about a limit: the case with the greatest known rate, by the shortest period, and what leaves it open.

    It is called the greatest if no bound of it or of another case leaves that open. Without any rate the sentence says so.
    """
    if not curves:
        return sentence(f"{subject} has no rate: it needs a curve, or an upper bound of the median")
    curve = max(curves, key=_rates)
    risk, years = curve["risk"], min(info["hazard"]["years"])
    least, most = _rates(curve)
    others = [other for other in curves if other is not curve]
    greater = [other for other in others if _rates(other)[1] > least]
    rank = "one" if greater or math.isinf(most) else "the greatest"
    case = f" for {label(info, curve)}, {rank} of {len(curves)} cases" if others else ""
    case += _among(_interval_of_rate(curve), map(_interval_of_rate, others))
    doubts = (
        [f"{_cases(info, greater)} may exceed it more often, as only bounds of the rate are known"] if greater else []
    )
    p, low, high = (risk[f"p_in_{years:g}_years{end}"] for end in ("", "_low", "_high"))
    if bound := risk["bound"]:
        said = (
            f"{subject} has a probability of {bound} {percent(low)}\u00a0% in {years:g} years ({level_of(info)}){case}"
        )
        return sentence(f"{said}, a mean rate of {bound} {power(least)} a year", doubts)
    interval = "" if low is None else f" ({level_of(info)}: {percent(low)} to {percent(high)}\u00a0%)"
    said = f"{subject} has a probability of {percent(p)}\u00a0% in {years:g} years{interval}{case}"
    return sentence(f"{said}, a mean rate of {power(least)} a year", [*_rate_left_open(curve), *doubts])


def _rate_left_open(curve: Curve) -> Iterator[str]:
    risk, rate = curve["risk"], curve["risk"]["rate_per_year"]
    if risk["rate_high"] is None and risk["rate_low"] is not None:
        yield "the records leave its upper bound open"
    if curve["says_little"]:
        ends = (
            "no bound" if (end := risk[f"rate_if_{way}"]) is None else power(end) for way in ("withstood", "exceeded")
        )
        yield f"undecided runs leave it between {' and '.join(ends)} a year"
    for what, where in (("points", "an extrapolated hazard"), ("levels", "intensities that were not run")):
        share = sum(risk[f"rate_{side}_{what}"] for side in ("below", "above")) / rate if rate > 0 else 0.0
        if share > NOTABLE:
            yield f"{100 * share:.0f}\u00a0% of it from {where}"


def _lowest(curves: Sequence[Curve]) -> float:
    return min(map(_strength, curves))


def _strength(curve: Curve) -> float:
    """Return the median of a curve; of a bound of it 0 for "below", infinity for "above", and the upper end for "between".

    Without either it is the lowest level at which half of the decided records exceed the limit: 0 if more than half do at the
    lowest, infinity if there is no such level.
    """
    if curve["median"] is not None:
        return float(curve["median"])
    if bound := curve.get("median_bound"):
        return 0.0 if bound["is"] == "below" else float("inf") if bound["is"] == "above" else float(bound["below"])
    over = {point["level"]: point["exceeded"] / (point["records"] - point["undecided"]) for point in _decided(curve)}
    half = min((level for level, share in over.items() if share >= 0.5), default=float("inf"))
    return 0.0 if half == min(over, default=None) and over[half] > 0.5 else half


def _decided(curve: Curve) -> list[Entry]:
    return [point for point in curve["points"] if point["records"] > point["undecided"]]


def _withstood(points: Sequence[Entry], curve: Curve) -> bool:
    """Return whether no record exceeds the limit, at ``points`` or between the levels, as far as runs are decided."""
    return not any(point["exceeded"] for point in points) and all(high is None for _, high in curve["capacities"])


def _has_no_median(curve: Curve) -> bool:
    """Return whether a curve has neither a median nor a bound of it, unless every run is decided and withstood the limit.

    Without any record it is True.
    """
    points = curve["points"]
    return (
        curve["median"] is None
        and not curve.get("median_bound")
        and not (
            _withstood(points, curve)
            and any(point["records"] for point in points)
            and not any(point["undecided"] for point in points)
        )
    )


def _among(interval: Interval, others: Iterable[Interval]) -> str:
    """Return " (difference not significant)" if one of the ``others`` overlaps an interval, "" if none does, or it is None."""
    return " (difference not significant)" if any(_overlap(interval, other) for other in others) else ""


def _overlap(first: Interval, second: Interval) -> bool:
    """Return whether two intervals share a value; False if one is None."""
    if first is None or second is None:
        return False
    (low, high), (least, most) = first, second
    return (high is None or (least or 0.0) <= high) and (most is None or (low or 0.0) <= most)


def _interval_of_rate(curve: Curve) -> Interval:
    """Return the interval of an annual rate; None without one."""
    low, high = (curve["risk"][name] for name in ("rate_low", "rate_high"))
    return None if low is None else (low, high)


def _records(curve: Curve) -> str:
    """Return the number of records in words, or its range over levels: "38 to 40 records a level"; of piers that share a curve
    "12 stations on 3 piers", since the runs of one record on several piers are not independent.
    """
    if curve.get("piers", 1) > 1:
        return f"{counted(curve['stations'], 'station')} on {curve['piers']} piers"
    numbers = [point["records"] for point in curve["points"]]
    least, most = (sum(numbers),) * 2 if "cloud" in curve else (min(numbers), max(numbers))
    return counted(most, "record") if least == most else f"{least} to {most} records a level"


def _bounds(interval: Sequence[float | None]) -> str:
    low, high = interval
    if high is None:
        return f"{plain(low, 3)} or more" if low else "open"
    return f"{plain(low, 3)} to {plain(high, 3)}" if low else f"{plain(high, 3)} or less"


def _intensity(info: Info, value: float) -> str:
    return f"{info['measure']} {plain(value, 3)} {info['unit']}".strip().replace(" ", "\u00a0")


def _rates(curve: Curve) -> tuple[float, float]:
    """Return the lower and the upper bound of a curve's annual rate: a known rate twice, infinity above a lower bound alone."""
    risk = curve["risk"]
    return (risk["rate_least"], math.inf) if risk["bound"] else (risk["rate_per_year"], risk["rate_per_year"])


def _cases(info: Info, curves: Sequence[Curve]) -> str:
    """Return the names of the cases, each once, or their number if they are more than MOST_NAMES."""
    names = dict.fromkeys(label(info, curve) for curve in curves)
    return ", ".join(names) if len(names) <= MOST_NAMES else f"{len(names)} cases"
