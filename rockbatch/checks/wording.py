"""Verdicts in words and numbers with their units, for the terminal and the report."""

import math
from collections import Counter
from collections.abc import Iterable, Sequence

from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, MEAN_OVER_TARGET, NOT_DECIDED, PASS, Verdict
from rockbatch.common.grouping import grouped
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.labels import plain
from rockbatch.quantities.statistics import STATISTICS

WAYS = (PASS, FAIL, NOT_DECIDED, DOES_NOT_APPLY)
SIGNS = {PASS: "✓", FAIL: "✗", NOT_DECIDED: "?", DOES_NOT_APPLY: "–"}
SUITE = "the suite"
"""Name of the case in a verdict on the suite."""
REPEATED = 3
ROUNDING = 1e-6
"""Share of a limit below which demands are shown as zero."""
MOST = 30
"""Greatest number of verdicts that are all printed; of more only the worst are, below their counts."""


def name_of(verdict: Verdict) -> str:
    """Return the name of the check; of a condition on the suite, but for its mean, with that: "suite to target (stations)"."""
    if verdict.case or verdict.demand == MEAN_OVER_TARGET:
        return verdict.check
    return f"{verdict.check} ({verdict.words})"


def worst_first(verdicts: Iterable[Verdict]) -> list[Verdict]:
    """Return failing verdicts, those on the suite first, then undecided ones, each by falling ratio, NaN last; no others."""
    order = (FAIL, NOT_DECIDED)

    def key(verdict: Verdict) -> tuple[int, bool, float]:
        ratio = math.inf if math.isnan(verdict.ratio) else -verdict.ratio
        return order.index(verdict.verdict), bool(verdict.case), ratio

    return sorted((verdict for verdict in verdicts if verdict.verdict in order), key=key)


def scaled(verdicts: Iterable[Verdict]) -> bool:
    """Return whether cases were run at several scales, so that each verdict needs its scale in words."""
    return len({verdict.scale for verdict in verdicts if verdict.case}) > 1


def count_of(verdicts: Iterable[Verdict]) -> dict[str, int]:
    """Return the number of verdicts of each kind, 0 included, in the order of ``WAYS``: {"pass": 3, "fail": 0, …}."""
    count = Counter(verdict.verdict for verdict in verdicts)
    return {kind: count[kind] for kind in WAYS}


def count_by_check(verdicts: Iterable[Verdict]) -> dict[str, dict[str, int]]:
    """Return the number of verdicts of each kind by the name of their check."""
    return {name: count_of(same) for name, same in grouped(verdicts, lambda verdict: verdict.check).items()}


def number(value: float, neighbour: float = math.nan, least: int = 4) -> str:
    """Return a value with ``least`` significant digits, or up to ten, until it differs from its ``neighbour``: "1,234".

    "∞" or "-∞" if it is infinite, "" for NaN; with a power of ten below 10⁻⁴ and from 10⁶ on, as :func:`plain`.
    """
    if math.isnan(value):
        return ""
    if math.isinf(value):
        return "∞" if value > 0 else "-∞"
    digits = next((n for n in range(least, 10) if value == neighbour or f"{value:.{n}g}" != f"{neighbour:.{n}g}"), 10)
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:,.10g}" if 1e3 <= abs(rounded) < 1e4 else plain(rounded, digits)


def compared(value: float, limit: float, least: int = 4) -> str:
    """Return a demand, or a bound of it, with ``least`` digits, or more if they tell it from its limit; "0" if it is nothing."""
    return "0" if is_nothing(value, limit) else number(value, limit, least)


def is_nothing(value: float, limit: float) -> bool:
    """Return whether a demand is below 10⁻⁶ of the size of its limit, as rounding is; False for a limit of 0."""
    return abs(value) < ROUNDING * abs(limit)


def against(verdict: Verdict) -> str:
    """Return demand and limit with unit and the sign of the value, whatever its bounds: "1.486 m > 0.5 m".

    A demand known as a lower bound keeps its own sign: "≥ 1.2 m > 0.5 m".
    """
    at_most = verdict.sense == "at most"
    signs, met = ("≤>", verdict.value <= verdict.limit) if at_most else ("≥<", verdict.value >= verdict.limit)
    words = f"{demanded(verdict)} {verdict.unit}".strip(), f"{number(verdict.limit)} {verdict.unit}".strip()
    return f" {signs[not met]} ".join(words).replace(" ", "\u00a0")


def demanded(verdict: Verdict) -> str:
    """Return the demand without its unit, "≥ 1.2" for a lower bound, "" for NaN; of a ban "some", "none" or "not known"."""
    value = verdict.value
    if math.isnan(value):
        return ""
    if not verdict.is_ban:
        return f"≥\u00a0{number(value)}" if verdict.is_lower_bound else compared(value, verdict.limit)
    if value > 0:
        return "some"
    return "none" if verdict.high <= 0 else "not known"


def limit(verdict: Verdict, signs: Sequence[str] = ("≤", "≥")) -> str:
    """Return the limit with its sign, without its unit: "≤ 0.5"; "none" for a ban, "not known" for NaN."""
    if verdict.is_ban:
        return "none"
    if math.isnan(verdict.limit):
        return "not known"
    return f"{signs[verdict.sense != 'at most']}\u00a0{number(verdict.limit)}"


def ratio(verdict: Verdict) -> str:
    """Return demand over limit, or limit over demand of an "at least": "0.87", "0.9987" near 1, "≥ 1.20" for a lower bound, "∞".

    Empty for NaN and for a ban.
    """
    if math.isnan(verdict.ratio) or verdict.is_ban:
        return ""
    if math.isinf(verdict.ratio):
        return "∞"
    if verdict.is_lower_bound:
        return f"≥\u00a0{verdict.ratio:.2f}"
    return f"{verdict.ratio:.4f}" if 0.995 <= verdict.ratio < 1.005 and verdict.ratio != 1 else f"{verdict.ratio:.2f}"


def percent(ratio: float) -> str:
    """Return a share of the limit as "115 %", with up to three decimals if it would look like 100 %; "∞", and "" for NaN."""
    if not math.isfinite(ratio):
        return "∞" if ratio > 0 else ""
    digits = next((n for n in range(3) if ratio == 1 or f"{100 * ratio:.{n}f}" != f"{100:.{n}f}"), 3)
    return f"{100 * ratio:,.{digits}f}\u00a0%"


def margin(verdict: Verdict) -> str:
    """Return the distance to the limit without its unit, "≤ 0.1" for a lower bound of the demand; "" for NaN and for a ban."""
    if math.isnan(verdict.margin) or verdict.is_ban:
        return ""
    shown = number(verdict.margin, least=3)
    return f"≤\u00a0{shown}" if verdict.is_lower_bound and math.isfinite(verdict.margin) else shown


class Notes:
    """Remarks on verdicts, each stated once for all verdicts to which it applies.

    A remark is common if it holds for every verdict of some checks, and for :data:`REPEATED` verdicts or more.
    """

    def __init__(self, verdicts: Iterable[Verdict]) -> None:
        applied = [verdict for verdict in verdicts if verdict.verdict != DOES_NOT_APPLY]
        counts: dict[str, Counter[str]] = {}
        for verdict in applied:
            for remark in verdict.remarks:
                counts.setdefault(remark, Counter())[verdict.check] += 1
        every = Counter(verdict.check for verdict in applied)
        self._common: dict[str, list[str]] = {}
        for remark, n in counts.items():
            checks = [check for check in n if n[check] == every[check]]
            if sum(every[check] for check in checks) >= REPEATED:
                self._common[remark] = checks
        self._counting: dict[str, dict[str, None]] = {}
        for verdict in applied:
            if verdict.counting:
                self._counting.setdefault(verdict.counting, {})[verdict.check] = None

    def about(self, verdict: Verdict) -> str:
        """Return the remarks on this verdict that are not common; empty without any."""
        return "; ".join(remark for remark in verdict.remarks if verdict.check not in self._common.get(remark, ()))

    def common(self) -> list[str]:
        """Return the common remarks with their checks, and how runs that do not end standing count: a sentence each."""
        notes = [f"{', '.join(checks)}: {remark}." for remark, checks in self._common.items()]
        sentences = [
            f"{', '.join(checks)}: runs that do not end standing count as follows: {kind}."
            for kind, checks in self._counting.items()
        ]
        return notes + sentences


def records_of(verdicts: Iterable[Verdict]) -> str:
    """Return what is counted: "stations", "components", or "records" if both or neither occur."""
    kinds = {verdict.count for verdict in verdicts} - {""}
    return f"{kinds.pop()}s" if len(kinds) == 1 else "records"


def run(verdict: Verdict, record: str) -> str:
    """Return the run that governs, by the label ``record`` of its motion, and polarity: "Waiau 2016, Te Mara Farm, N28W (+)".

    A motion without a label of its own follows its station if that is known, and not named as the motion.
    """
    known = verdict.station and record == verdict.record != verdict.station
    return f"{verdict.station}, {record} ({verdict.polarity})" if known else f"{record} ({verdict.polarity})"


def is_left_open(verdict: Verdict) -> bool:
    """Return whether a verdict is not decided because its demand may lie on either side of the limit."""
    low, high = verdict.low, verdict.high
    if verdict.sense == "at least":
        low, high = -high, -low
    limit = verdict.limit if verdict.sense == "at most" else -verdict.limit
    return verdict.verdict == NOT_DECIDED and low <= limit < high


def governing(verdict: Verdict, record: str) -> str:
    """Return the run that governs, of the motion called ``record``, with its own demand unless of a ban; empty if no run does.

    "governs: …", "largest: …" if the statistic differs from its demand, "left open by …" if it leaves the check undecided.
    """
    if not verdict.record:
        return ""
    left_open = is_left_open(verdict)
    text = f"{'left open by' if left_open else 'governs:' if is_alone(verdict) else 'largest:'} {run(verdict, record)}"
    if verdict.is_ban:
        return text
    return text + _demand_of_record(verdict)


def is_alone(verdict: Verdict) -> bool:
    """Return whether the run that governs sets the value of the check, and is not only the largest of a mean or a rank.

    True for a value that is not known.
    """
    return verdict.is_ban or verdict.governing == verdict.value or math.isnan(verdict.value)


def demanded_by(verdict: Verdict, record: str) -> str:
    """Return the run that governs, of the motion called ``record``, with its own demand: "Te Mara, N28W (+), 0.6 m"."""
    return run(verdict, record) + _demand_of_record(verdict)


def _demand_of_record(verdict: Verdict) -> str:
    """Return ", 0.6 m at 72 m", the demand of the run that governs, ", beyond any limit" if it is infinite; "" for NaN."""
    if math.isnan(verdict.governing):
        return ""
    if math.isinf(verdict.governing):
        return ", beyond any limit"
    return f", {number(verdict.governing)} {_unit_of_demand(verdict)}".rstrip() + at(verdict.at_m)


def is_passed_by_statistic(verdict: Verdict) -> bool:
    """Return whether a check of a quantity passes though the demand of one record, its governing one, is beyond the limit."""
    quantity = verdict.demand in DEMANDS and DEMANDS[verdict.demand].per_run and verdict.statistic != "count"
    return quantity and verdict.verdict == PASS and verdict.governing > verdict.limit


def are_of_one_motion(verdicts: Iterable[Verdict]) -> bool:
    """Return whether there are verdicts by a statistic, and none of them counts more than one record."""
    return max((verdict.records for verdict in verdicts if verdict.statistic), default=0) == 1


def _unit_of_demand(verdict: Verdict) -> str:
    """Return the unit of one record's demand, also if the verdict counts records."""
    return DEMANDS[verdict.demand].unit if verdict.demand in DEMANDS else verdict.unit


def at(height: float) -> str:
    """Return " at 72 m" for a height [m], to follow a name or a value; empty for NaN."""
    return "" if math.isnan(height) else f" at {height:.5g}\u00a0m"


def requirements(verdicts: Iterable[Verdict]) -> dict[str, list[str]]:
    """Return up to three requirements of each check, by name, one for each height of its demand; then "likewise at 5 more …"."""
    asked = {name: list(dict.fromkeys(map(requirement, same))) for name, same in grouped(verdicts, name_of).items()}
    return {name: _first_few(words) for name, words in asked.items()}


def _first_few(words: list[str]) -> list[str]:
    """Return the first REPEATED requirements of a check, and "likewise at 5 more heights" for the others."""
    others = len(words) - REPEATED
    return words if others <= 0 else [*words[:REPEATED], f"likewise at {others} more heights"]


def requirement(verdict: Verdict) -> str:
    """Return the requirement of the check: "design value by EN 1998-2 of top_drift_m at most 1.5 m"; "no record overturns"."""
    if verdict.is_ban:
        return verdict.words
    limit = "an unknown limit" if math.isnan(verdict.limit) else f"{verdict.limit:,g} {verdict.unit}".rstrip()
    return f"{verdict.words} {verdict.sense} {limit}"


def unchecked(verdict: Verdict) -> str:
    """Return the sources of a code's statistic, whose clause itself could not be checked; "" for other statistics."""
    return STATISTICS[verdict.statistic].unchecked if verdict.statistic in STATISTICS else ""


def both_axes(verdicts: Iterable[Verdict]) -> str:
    """Return the ways of combining both axes, each with its checks; empty for none.

    "Two planar models of each pier, one for each axis, combined: SRSS of both axes (drift)."
    """
    ways = {verdict.check: verdict.axes for verdict in verdicts if verdict.axes}
    by_way = grouped(ways, ways.__getitem__)
    listed = "; ".join(f"{way} ({', '.join(names)})" for way, names in by_way.items())
    return f"Two planar models of each pier, one for each axis, combined: {listed}." if listed else ""


def counting(verdicts: Iterable[Verdict]) -> list[str]:
    """Return a sentence for each way of counting records that the verdicts use: by station, by component."""
    sentences = {
        "station": "A record is a station: its components, angles and polarities are its directions, and the worst counts.",
        "component": "A record is a horizontal component, with the worse of its polarities; those of a station count separately.",
    }
    counts = {verdict.count for verdict in verdicts}
    return [sentence for kind, sentence in sentences.items() if kind in counts]
