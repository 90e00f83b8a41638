"""What a verdict says, in words and numbers with their units, for the terminal and the report."""

import math
from collections import Counter
from collections.abc import Iterable, Sequence

from rockbatch.checks.demands import DEMANDS
from rockbatch.checks.statistics import STATISTICS
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS, Verdict

WAYS = (PASS, FAIL, NOT_DECIDED, DOES_NOT_APPLY)
SIGNS = {PASS: "✓", FAIL: "✗", NOT_DECIDED: "?", DOES_NOT_APPLY: "–"}
REPEATED = 3
MOST = 30
"""Verdicts that are all told; more are summed up, and the worst of them told."""


def worst_first(verdicts: Iterable[Verdict]) -> list[Verdict]:
    """Those that fail, by their ratio, then those that are not decided; no others."""
    places = {FAIL: 0, NOT_DECIDED: 1}
    found = [one for one in verdicts if one.verdict in places]
    return sorted(found, key=lambda one: (places[one.verdict], -one.ratio if one.ratio == one.ratio else math.inf))


def count_of(verdicts: Iterable[Verdict]) -> dict[str, int]:
    """How many there are of each kind, in the order of ``WAYS``."""
    found = [one.verdict for one in verdicts]
    return {way: found.count(way) for way in WAYS}


def _is_open(one: Verdict) -> bool:
    """Whether the demand may be anything above its value."""
    return math.isinf(one.high) and math.isfinite(one.value)


def number(value: float, beside: float = math.nan) -> str:
    """A value in four significant digits, in more of them where it would look the same as a limit that it is not."""
    if not math.isfinite(value):
        return "∞" if value > 0 else "-∞"
    digits = next((n for n in range(4, 10) if value == beside or f"{value:.{n}g}" != f"{beside:.{n}g}"), 10)
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:,.10g}" if rounded == 0 or 1e-4 <= abs(rounded) < 1e7 else f"{rounded:.{digits}g}"


def against(one: Verdict) -> str:
    """Demand and limit with their sign and unit: "1.486 m > 0.5 m"."""
    sign = (
        ("≤" if one.value <= one.limit else ">") if one.sense == "at most" else "≥" if one.value >= one.limit else "<"
    )
    words = f"{demanded(one)} {one.unit}".strip(), f"{number(one.limit)} {one.unit}".strip()
    return f" {sign} ".join(words).replace(" ", "\u00a0")


def demanded(one: Verdict) -> str:
    """The demand as a number without its unit; of an event that no record may do, whether one does."""
    value = one.value
    if math.isnan(value):
        return ""
    if not one.is_ban:
        return f"≥\u00a0{number(value)}" if _is_open(one) else number(value, one.limit)
    if value > 0:
        return "some"
    return "none" if one.high <= 0 else "not known"


def limit(one: Verdict, signs: Sequence[str] = ("≤", "≥")) -> str:
    """The limit with its sign, without its unit."""
    if one.is_ban:
        return "none"
    return f"{signs[one.sense != 'at most']}\u00a0{number(one.limit)}"


def ratio(one: Verdict) -> str:
    """Demand over limit; beside 1 with as many digits as tell the side."""
    if math.isnan(one.ratio) or one.is_ban:
        return ""
    if math.isinf(one.ratio):
        return "∞"
    if _is_open(one):
        return f"≥\u00a0{one.ratio:.2f}"
    return f"{one.ratio:.4f}" if 0.995 <= one.ratio < 1.005 and one.ratio != 1 else f"{one.ratio:.2f}"


def margin(one: Verdict) -> str:
    """Distance to the limit, without its unit."""
    if math.isnan(one.margin) or one.is_ban:
        return ""
    if math.isinf(one.margin):
        return "-∞" if one.margin < 0 else "∞"
    return f"≤\u00a0{one.margin:.3g}" if _is_open(one) else f"{one.margin:.3g}"


class Notes:
    """Remarks on verdicts, each said once for all of them that it holds for.

    A part of a note is common if it holds for every verdict of some checks, and for :data:`REPEATED` verdicts or more.
    """

    def __init__(self, verdicts: Iterable[Verdict]) -> None:
        applied = [one for one in verdicts if one.verdict != DOES_NOT_APPLY]
        has: dict[str, Counter[str]] = {}
        for one in applied:
            for part in one.note.split("; ") if one.note else ():
                has.setdefault(part, Counter())[one.check] += 1
        every = Counter(one.check for one in applied)
        whole = {part: [check for check in own if own[check] == every[check]] for part, own in has.items()}
        self._common = {
            part: checks for part, checks in whole.items() if sum(every[check] for check in checks) >= REPEATED
        }
        self._counting: dict[str, dict[str, None]] = {}
        for one in applied:
            if one.counting:
                self._counting.setdefault(one.counting, {})[one.check] = None

    def of(self, one: Verdict) -> str:
        """Return the remark on this verdict alone."""
        parts = one.note.split("; ") if one.note else []
        return "; ".join(part for part in parts if one.check not in self._common.get(part, ()))

    def common(self) -> list[str]:
        """Return remarks on all verdicts of some checks, and how runs count that did not go through: a sentence each."""
        told = [f"{', '.join(checks)}: {part}." for part, checks in self._common.items()]
        ways = [
            f"{', '.join(checks)}: runs that do not end standing count so: {way}."
            for way, checks in self._counting.items()
        ]
        return told + ways


def records_of(verdicts: Iterable[Verdict]) -> str:
    """What they count as records: "stations", "components", or "records" where both occur."""
    found = {one.count for one in verdicts} - {""}
    return f"{found.pop()}s" if len(found) == 1 else "records"


def run(one: Verdict) -> str:
    """The run that governs, by station, component and polarity: "WTMC, 20161113_110259_WTMC_20.N28W (+)"."""
    station = f"{one.station}, " if one.station and one.station != one.record else ""
    return f"{station}{one.record} ({one.polarity})"


def governing(one: Verdict) -> str:
    """Which run governs, has the largest of several demands, or leaves open what the demand is, and what it demands."""
    if not one.record:
        return ""
    left_open = one.verdict == NOT_DECIDED and one.low <= one.limit < one.high
    alone = one.is_ban or one.governing == one.value
    told = f"{'left open by' if left_open else 'governs:' if alone else 'largest:'} {run(one)}"
    if one.is_ban:
        return told
    if math.isinf(one.governing):
        return f"{told}, beyond any limit"
    return f"{told}, {number(one.governing)} {_unit_of_demand(one)}".rstrip()


def _unit_of_demand(one: Verdict) -> str:
    return DEMANDS[one.demand].unit if one.demand in DEMANDS else one.unit


def asked(one: Verdict) -> str:
    """What the check asks: "design value by EN 1998-2 of top_drift_m at most 1.5 m"."""
    return one.words if one.is_ban else f"{one.words} {one.sense} {one.limit:g} {one.unit}".rstrip()


def unchecked(one: Verdict) -> str:
    """Of a code's own statistic: what it rests on, and that it is not the clause's own text; empty for others."""
    return STATISTICS[one.statistic].unchecked if one.statistic in STATISTICS else ""


def counting(verdicts: Iterable[Verdict]) -> list[str]:
    """What the suites count as a record, a sentence for each way."""
    ways = {
        "station": "A record is a station: its components, angles and polarities are its directions, and the worst counts.",
        "component": "A record is a horizontal component, with the worse of its polarities: those of one station count apart.",
    }
    found = {one.count for one in verdicts}
    return [told for way, told in ways.items() if way in found]
