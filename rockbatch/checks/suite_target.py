"""The check of a suite by its target spectrum: its mean over the target, and further conditions of the spectrum's code.

Each condition is a verdict without a case, at each scale at which the suite is run. What a code does not ask has none.
"""

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from rockbatch.checks.coverage import is_not_selected
from rockbatch.checks.suite import Suite
from rockbatch.checks.verdicts import FAIL, MEAN_OVER_TARGET, NOT_DECIDED, PASS, Verdict

NAMES = {"target": "suite to target", "vertical_target": "suite to vertical target"}
"""Names of the checks, by the entries of run.json on both targets."""

VERTICALS = "suite_verticals"
OF_STUDY = (MEAN_OVER_TARGET, VERTICALS)
"""Demands on a suite by the targets of the study, not by a code."""

DAMPING = 0.05
"""Damping of the spectra that codes compare, as a fraction of critical damping."""

_ROUNDING = 1e-4  # relative: run.json has five digits of either spectrum
Target = Mapping[str, Any]


class Code(NamedTuple):
    """Conditions of a code on a suite, by what is commonly said of its clauses; which of them could be confirmed is said on the
    page on spectra.
    """

    clause: str  # where it states them
    stations: int  # least number of motions
    pairs: str = ""  # measure of two components by which motions count; empty if single components will do
    # times the period of the pier: between which periods the mean has to reach the target; 0 if it does not say
    shortest: float = 0.0
    longest: float = 0.0
    zero: bool = False  # whether the mean at 0 s has to reach that of the target
    # share of the target that the mean has to reach, whatever the study asks for; 0 if it does not say
    share: float = 0.0
    level: str = ""  # what that share is, where the code's own target is above the spectrum of its keys; a remark
    # least and greatest factor of a record by least squares, and of all records besides; empty if it does not say
    record: tuple[float, ...] = ()
    family: tuple[float, ...] = ()


CODES = {
    "EN 1998-1": Code("EN 1998-1, 3.2.3.1.2 (4)", 3, shortest=0.2, longest=2.0, zero=True, share=0.9),
    "EN 1998-2": Code("EN 1998-2, 3.2.3", 3, "srss", 0.2, 1.5, share=1.3),
    "ASCE 7-16": Code(
        "ASCE 7-16, 16.2",
        11,
        "rotd100",
        0.2,
        2.0,
        share=1.35,
        level="0.9 of MCE_R, which is 1.5 times the design spectrum",
    ),
    "AASHTO": Code("AASHTO LRFD, 4.7.4.3.4b", 3),
    "NZS 1170.5": Code("NZS 1170.5, 5.5", 3, shortest=0.4, longest=1.3, record=(0.33, 3.0), family=(1.0, 1.3)),
}


class Condition(NamedTuple):
    """A condition on a suite: its demand and words, the value and the limit with its sense, unit, and remarks."""

    demand: str
    words: str
    value: float
    sense: str
    limit: float
    unit: str = ""
    remarks: tuple[str, ...] = ()
    scaled: bool = False
    """Whether its value depends on the scale."""


def suite_verdicts(info: Mapping[str, Any], scales: Iterable[float]) -> list[Verdict]:
    """Return the verdict on every condition on the suite, at each of the ``scales``, by the targets in run.json (``info``).

    A target that is only compared (``required`` false), or without a fitted record, has none. Without ``scales``, at scale 1.
    """
    targets = {name: info.get(key) for key, name in NAMES.items()}
    verdicts: list[Verdict] = []
    at_scales = sorted(set(scales)) or [1.0]
    for name, target in targets.items():
        if target is None or not _is_judged(target):
            continue
        for scale in at_scales:
            of_code = _verticals(info) if name == NAMES["vertical_target"] else _conditions(target, scale)
            verdicts += [_verdict(name, condition, scale, target) for condition in (_share(target, scale), *of_code)]
    return verdicts


def is_recorded(record: Mapping[str, Any]) -> bool:
    """Return whether a record of run.json is an earthquake's; of an earlier version by its source, as a pulse has no other."""
    return bool(record.get("recorded", record["source"] not in ("pulse", "still")))


def suite_of(info: Mapping[str, Any]) -> Suite:
    """Return the :class:`Suite` of motions that run.json (``info``) describes."""
    records, target = info["records"], info.get("target")
    return Suite(
        stations={record["record"]: record.get("station", "") for record in records},
        events={record["record"]: record.get("event") or "" for record in records},
        shocks={record["record"]: record["stations_of_shocks"] for record in records if "stations_of_shocks" in record},
        unrecorded={record["record"] for record in records if not is_recorded(record)},
        without_vertical=info.get("without_vertical", ()),
        not_selected=Counter(file["station"] for file in info.get("left_out", ()) if is_not_selected(file)),
        code=str(target.get("code") or "") if target and _is_judged(target) else "",
    )


def _is_judged(target: Target) -> bool:
    """Return whether the suite has to reach a target, and is not only compared with it; False without a fitted record."""
    return bool(target.get("required", target["factors"] != "none")) and any(target["mean_sa_g"])


def _share(target: Target, scale: float) -> Condition:
    """Return the condition that the study sets on the least ratio of the mean spectrum to the target."""
    words = "mean spectrum of the suite over its target"
    return _reached(MEAN_OVER_TARGET, words, target, scale, float(target["at_least"]))


def _reached(demand: str, words: str, target: Target, scale: float, share: float, level: str = "") -> Condition:
    """Return the condition that the mean spectrum reaches a share of the target; a ratio within 10⁻⁴ of it meets it."""
    least, period = least_over_target(target)
    value = share if math.isclose(scale * least, share, rel_tol=_ROUNDING) else scale * least
    remarks = (f"least at T = {period:.3g} s", *filter(None, [level]))
    return Condition(demand, words, value, "at least", share, "", remarks, True)


def _verticals(info: Mapping[str, Any]) -> Iterator[Condition]:
    """Yield the condition that all recorded stations have the vertical component: their number, at least that of stations."""
    recorded = [record for record in info["records"] if is_recorded(record)]
    stations = {str(record.get("station") or record["record"]): False for record in recorded}
    stations |= {
        str(record.get("station") or record["record"]): True for record in recorded if record.get("pga_v_g") is not None
    }
    words = "stations with a vertical component"
    yield Condition(VERTICALS, words, sum(stations.values()), "at least", len(stations))


def _conditions(target: Target, scale: float) -> Iterator[Condition]:
    """Yield the conditions of a target's code, beside that on the mean spectrum; nothing for a target without a known code."""
    code = CODES.get(str(target.get("code")))
    if code is None or "stations" not in target:
        return
    stations, events = int(target["stations"]), int(target.get("events", 0))
    of_events = f"of {events} event{'s' * (events > 1)}" if events else "of some the event is not known"
    yield Condition("suite_stations", "stations", stations, "at least", code.stations, remarks=(of_events,))
    if code.pairs:
        paired = stations - int(target["alone"]) if target["pairs"] == code.pairs else 0
        other = f'pairs = "{target["pairs"]}", and the code\'s is "{code.pairs}"'
        remarks = () if target["pairs"] == code.pairs else (other,)
        words = "stations with the measure of a pair"
        yield Condition("suite_pairs", words, paired, "at least", stations, remarks=remarks)
    if float(target["at_least"]) < code.share:
        level = f"{code.level}: {_remedy(target, code.share)}" if code.level else ""
        yield _reached("suite_share", "mean over target by the code", target, scale, code.share, level)
    if not math.isclose(damping := float(target["damping"]), DAMPING):
        sense = "at most" if damping > DAMPING else "at least"
        remarks = ("codes compare spectra of 5 % damping: leave it out",)
        yield Condition("suite_damping", "damping of the target", damping, sense, DAMPING, remarks=remarks)
    yield from _periods(target, code)
    at_zero, mean = _two(target, "zero_sa_g")
    if code.zero and at_zero > 0.0:
        value = 1.0 if math.isclose(scale * mean, at_zero, rel_tol=_ROUNDING) else scale * mean / at_zero
        yield Condition("suite_zero_period", "mean over target at 0 s", value, "at least", 1.0, scaled=True)
    yield from _factors("record", target, code.record, 1.0)
    yield from _factors("family", target, code.family, scale)


def _remedy(target: Target, share: float) -> str:
    """Return advice by which the mean spectrum reaches a share of the target: ``at_least`` if it scales the suite."""
    if target["factors"] in ("both", "suite"):
        return f"at_least = {share:g} scales to it"
    least, _ = least_over_target(target)
    return f"with scale = {share / least if least else math.inf:.5g} under [motions] the suite reaches it"


def _factors(kind: str, target: Target, bounds: tuple[float, ...], scale: float) -> Iterator[Condition]:
    """Yield the conditions on the least and greatest factor of a kind; none without ``bounds`` or factors of the target."""
    least, greatest = (scale * float(f"{factor:.4g}") for factor in _two(target, f"{kind}_factors"))
    if not bounds or math.isnan(least):
        return
    scaled = kind == "family"
    yield Condition(f"suite_least_{kind}_factor", f"least {kind} factor", least, "at least", bounds[0], scaled=scaled)
    yield Condition(
        f"suite_greatest_{kind}_factor", f"greatest {kind} factor", greatest, "at most", bounds[1], scaled=scaled
    )


def _two(target: Target, name: str) -> tuple[float, float]:
    """Return the pair of numbers that a target has by this name; (NaN, NaN) if it has no pair."""
    values = target.get(name, ())
    return (float(values[0]), float(values[1])) if len(values) == 2 else (math.nan, math.nan)


def _periods(target: Target, code: Code) -> Iterator[Condition]:
    """Yield the conditions on both ends of the period range, in periods of the piers at 0.1 α; nothing if the code has no range.

    The longest period asked for is no longer than the spectrum is defined; without a period of the piers the limits are NaN.
    """
    if not code.longest:
        return
    low, high = target["range_s"]
    shortest, longest = _two(target, "rocking_s")
    asked = min(code.longest * longest, float(target.get("defined_to_s", math.inf)))
    for demand, words, value, sense, limit, times, period in (
        (
            "suite_shortest_period",
            "shortest period of the range",
            low,
            "at most",
            code.shortest * shortest,
            code.shortest,
            shortest,
        ),
        ("suite_longest_period", "longest period of the range", high, "at least", asked, code.longest, longest),
    ):
        remarks = [f"{times:g} times {period:.3g} s, a pier's period of rocking at 0.1 α"]
        if sense == "at least" and asked < code.longest * longest:
            remarks.insert(0, "where the spectrum ends")
        if math.isnan(period):
            remarks = ["no pier has a period of rocking"]
        yield Condition(demand, words, value, sense, limit, "s", tuple(remarks))


def _verdict(name: str, condition: Condition, scale: float, target: Target) -> Verdict:
    """Return the verdict on a condition; not decided if its limit is NaN."""
    value, limit = float(condition.value), float(condition.limit)
    more = condition.sense == "at least"
    met = value >= limit if more else value <= limit
    numerator, denominator = (limit, value) if more else (value, limit)
    low, high = target["range_s"]
    basis, reason = "study", f"{target['spectrum']}, between {low:g} s and {high:g} s"
    if condition.demand not in OF_STUDY:
        basis, reason = "code", CODES[target["code"]].clause
    at_scale = f"at scale {scale:g}" if condition.scaled and scale != 1.0 else ""
    return Verdict(
        check=name,
        case="",
        columns={},
        scale=scale,
        demand=condition.demand,
        statistic="",
        words=condition.words,
        records=0,
        runs=0,
        value=value,
        low=value,
        high=value,
        sense=condition.sense,
        limit=limit,
        ratio=numerator / denominator if denominator else math.inf,
        margin=value - limit if more else limit - value,
        verdict=NOT_DECIDED if math.isnan(limit) else PASS if met else FAIL,
        basis=basis,
        reason=reason,
        counting="",
        counted="",
        remarks=(*condition.remarks, at_scale) if at_scale else condition.remarks,
        unit=condition.unit,
        least=0,
        per_event=0,
    )


def least_over_target(target: Target) -> tuple[float, float]:
    """Return the least ratio of the mean spectrum to the target, and its period [s]; 0 and NaN without values."""
    rows = zip(target["period_s"], target["sa_g"], target["mean_sa_g"], strict=False)
    return min(((mean / sa, period) for period, sa, mean in rows if sa > 0.0), default=(0.0, math.nan))
