"""A check of one design in sentences: its value under the worst bound, the limit, what governs, and the remarks."""

import math
from collections.abc import Iterator, Sequence

from rockbatch.checks import Verdict, wording
from rockbatch.checks.scorecard import badness
from rockbatch.checks.verdicts import DOES_NOT_APPLY, FAIL, NOT_DECIDED, PASS
from rockbatch.common.files import legible
from rockbatch.common.grouping import grouped
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.design import BOUND, under
from rockbatch.quantities.statistics import STATISTICS
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.sections.verdicts import BASIS

VERBS = {PASS: "passes", FAIL: "fails", NOT_DECIDED: "is not decided", DOES_NOT_APPLY: "does not apply"}
LONGEST = 1000
"""Most characters of a name or a reason that are quoted."""


def quoted(text: object) -> str:
    """Return a text of the user in quotation marks, those inside as ', so that it cannot be taken for one of the statement.

    After :data:`LONGEST` characters it is cut, with "…".
    """
    inside = legible(str(text)).replace('"', "'")
    return f'"{inside if len(inside) <= LONGEST else f"{inside[:LONGEST]}…"}"'


def listed(names: Sequence[str]) -> str:
    """Return names in quotation marks, separated by commas, each once: '"drift", "uplift"'."""
    return ", ".join(map(quoted, dict.fromkeys(names)))


def worst_by_check(verdicts: Sequence[Verdict]) -> list[tuple[Verdict, Sequence[Verdict]]]:
    """Return the worst verdict of each check of a design and those under all its bounds, the worst check first."""
    checks = grouped(
        verdicts, lambda verdict: (verdict.check, verdict.demand, verdict.statistic, verdict.limit)
    ).values()
    pairs = [(max(same, key=badness), same) for same in checks]
    return sorted(pairs, key=lambda pair: badness(pair[0]), reverse=True)


def sentence(finished: Finished, worst: Verdict, same: Sequence[Verdict]) -> str:
    """Return the outcome of a check by its ``worst`` verdict; ``same`` are those under all bounds of the design."""
    said = f"it asks that {worst.words}, of {_records(worst)}"
    if not worst.is_ban:
        said = f"{_quantity(worst)} {_value_in_words(worst, at_worst=len(same) > 1)}{_limit(worst)}"
    parts = [
        f"{quoted(worst.check)} {VERBS[worst.verdict]}: {said}",
        _by_bound(same),
        _governing(finished, worst),
        f"runs that do not end standing: {worst.counted}" if worst.counted else "",
        f"limit by {BASIS.get(worst.basis, worst.basis)}: {quoted(worst.reason)}",
    ]
    return f"{'; '.join(filter(None, parts))}."


def remarks(verdicts: Sequence[Verdict]) -> Iterator[str]:
    """Yield the remarks on the verdicts of a design, each once with its checks: '"drift", "uplift" under "stiff": no error …'.

    A check has its bounds unless the remark is on all; remarks on checks that do not apply are left out.
    """
    of_checks = grouped((v for v in verdicts if v.verdict != DOES_NOT_APPLY), lambda verdict: verdict.check)
    places: dict[str, list[str]] = {}
    for check, same in of_checks.items():
        by_remark = grouped(((remark, v) for v in same for remark in v.remarks), lambda pair: pair[0])
        for remark, pairs in by_remark.items():
            bounds = ", ".join(_bound(verdict) for _, verdict in pairs) if len(pairs) < len(same) else ""
            places.setdefault(remark, []).append(f"{quoted(check)} {bounds}".rstrip())
    for remark, checks in places.items():
        yield f"{', '.join(checks)}: {remark}"


def _bound(verdict: Verdict) -> str:
    """Return the bound of a verdict in words, 'under "stiff ground"'; "nominally" for the nominal design."""
    return f"under {quoted(verdict.columns[BOUND])}" if under(verdict.columns) else "nominally"


def _by_bound(verdicts: Sequence[Verdict]) -> str:
    """Return the verdicts by bound, the worst first: 'it fails under "stiff", and passes nominally'; empty if all are alike."""
    kinds = grouped(sorted(verdicts, key=badness, reverse=True), lambda verdict: verdict.verdict)
    if len(kinds) == 1:
        return ""
    parts = [f"{VERBS[kind]} {', '.join(map(_bound, same))}" for kind, same in kinds.items()]
    return f"it {', and '.join(parts)}"


def _records(verdict: Verdict) -> str:
    """Return the number of records: "5 stations"."""
    return f"{verdict.records} {verdict.count}{'s' * (verdict.records != 1)}"


def _quantity(verdict: Verdict) -> str:
    """Return what a check limits: "the maximum over 5 stations of the greatest drift at 25 m"; and how two axes combine."""
    meaning = f"{DEMANDS[verdict.demand].meaning}{wording.at(verdict.at_m)}".replace("\u00a0", " ")
    statistic = STATISTICS.get(verdict.statistic)
    words = f"the {meaning}"  # of a property of the case
    if statistic and statistic.evaluate is None:
        words = f"the {verdict.words}, of {_records(verdict)},"
    elif statistic:
        words = f"the {statistic.words} over {_records(verdict)} of the {meaning}"
    return f"{words}, {verdict.axes}," if verdict.axes else words


def _value_in_words(verdict: Verdict, *, at_worst: bool) -> str:
    """Return the value with its verb: "is 0.3 m (between 0.2 m and 0.4 m)", "is at least 0.3 m", "is beyond any limit".

    "has no value" if it is NaN, "is not known" if its upper bound is infinite, too. With ``at_worst`` the words "at worst"
    precede a number, and the bound of the design follows whatever is said.
    """
    bound = f", {_bound(verdict)}" if at_worst else ""
    if math.isnan(verdict.value):
        return f"{'is not known' if math.isinf(verdict.high) else 'has no value'}{bound}"
    if math.isinf(verdict.value):
        return f"is beyond any limit{bound}"
    low, value, high = (_number(number, verdict) for number in (verdict.low, verdict.value, verdict.high))
    least = "at least " * verdict.is_lower_bound
    between = f" (between {low} and {high})" if low != high and not verdict.is_lower_bound else ""
    return f"is {'at worst ' * at_worst}{least}{value}{between}{bound}"


def _number(value: float, verdict: Verdict) -> str:
    """Return a number with the unit of a verdict, in as many digits as tell it from the limit; "any value" if infinite."""
    if math.isinf(value):
        return "any value"
    return f"{wording.compared(value, verdict.limit)} {verdict.unit}".rstrip()


def _limit(verdict: Verdict) -> str:
    """Return the limit, with the share of it that is used and the margin to it in brackets if the share is finite.

    ", where at most 0.3 m is allowed (80 % of the limit, 0.06 m to spare)".
    """
    allowed = "allowed" if verdict.sense == "at most" else "required"
    said = f", where {verdict.sense} {wording.number(verdict.limit)} {verdict.unit}".rstrip() + f" is {allowed}"
    if math.isfinite(verdict.ratio):
        said += f" ({'at least ' * verdict.is_lower_bound}{wording.percent(verdict.ratio)} of the limit".replace(
            "\u00a0", " "
        )
        margin = f"{wording.number(abs(verdict.margin), least=3)} {verdict.unit}".rstrip()
        more = "at most " if verdict.margin >= 0.0 else "at least "
        said += f", {more * verdict.is_lower_bound}{margin} {'to spare' if verdict.margin >= 0.0 else 'beyond it'})"
    return said


def _governing(finished: Finished, verdict: Verdict) -> str:
    """Return the run that a verdict names: 'governed by "Te Mara"', or 'greatest in "Te Mara", reversed: 0.2 m'.

    The latter if its demand is not the value; 'left open by "Te Mara"' for an open check, 'one of these is "Te Mara"' for an
    event, "" if the verdict names no record.
    """
    if not verdict.record:
        return ""
    run = quoted(finished.named(verdict.record)) + ", reversed" * (verdict.polarity == "-")
    if wording.is_left_open(verdict):
        return f"left open by {run}"
    if DEMANDS[verdict.demand].event:
        return f"one of these is {run}"
    if verdict.governing == verdict.value:
        return f"governed by {run}"
    unit = DEMANDS[verdict.demand].unit
    of_run = (
        "beyond any limit" if math.isinf(verdict.governing) else f"{wording.number(verdict.governing)} {unit}".rstrip()
    )
    return f"greatest in {run}: {of_run}"
