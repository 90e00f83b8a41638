"""Whether the pier passes: the answer in a sentence, every check in every case at a glance, and what the checks ask."""

import math
from collections.abc import Sequence

from rockbatch.checks import Verdict
from rockbatch.report.contents import Contents
from rockbatch.report.document import Section
from rockbatch.report.labels import quantity
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.report.table import Head, alarm, table

SIGNS = {"pass": "✓", "fail": "✗", "not decided": "?", "does not apply": "–"}
BASIS = {"code": "code clause", "literature": "literature", "judgement": "engineering judgement"}
MOST_NAMES = 6


def section(contents: Contents) -> Section | None:
    """Every check in every case, what the checks ask, and what does not pass; None where nothing was checked."""
    verdicts = contents.verdicts
    if not verdicts:
        return None
    parts = [legend(), matrix(verdicts), tag("h3", "What the checks ask"), _asked(verdicts)]
    if any(one.verdict in ("fail", "not decided") for one in verdicts):
        parts += [tag("h3", "What does not pass"), _shortfalls(verdicts)]
    return Section("Every check", "checks", join(*parts))


def answer(verdicts: Sequence[Verdict]) -> Markup:
    """Which cases meet all checks, in a sentence."""
    if not verdicts:
        return join(
            "No limits were set: nothing here passes or fails. ", tag("code", "rockbatch check"),
            " judges finished results by rules.",
        )  # fmt: skip
    cases = _by_case(verdicts)
    kinds = {case: {one.verdict for one in same} for case, same in cases.items()}
    failing = [case for case, found in kinds.items() if "fail" in found]
    undecided = [case for case, found in kinds.items() if "not decided" in found and "fail" not in found]
    passing = [case for case in kinds if case not in failing and case not in undecided]
    if len(passing) == len(cases):
        return join(tag("strong", "✓ Every check passes"), f" in {_among(len(cases), len(cases))}.")
    parts = []
    if passing:
        words = f"✓ {_among(len(passing), len(cases))} pass{'es' * (len(passing) == 1)} every check"
        parts.append(join(tag("strong", words), f": {_listed(passing)}."))
    if failing:
        words = f"✗ {_among(len(failing), len(cases))} fail{'s' * (len(failing) == 1)}"
        parts.append(join(alarm(words), f": {_listed(failing)}."))
    if undecided:
        words = f"? {_among(len(undecided), len(cases))} cannot be decided"
        parts.append(join(alarm(words), f": {_listed(undecided)}."))
    return tag("ul", *(tag("li", part) for part in parts), class_="answer")


def _among(some: int, all_: int) -> str:
    if some == all_:
        return "the only case" if all_ == 1 else f"all {all_} cases"
    return f"{some} of {all_} cases"


def _listed(cases: Sequence[str]) -> str:
    more = len(cases) - MOST_NAMES
    return "; ".join(cases[:MOST_NAMES]) + (f"; and {more} more" if more > 0 else "")


def _by_case(verdicts: Sequence[Verdict]) -> dict[str, list[Verdict]]:
    scaled = len({one.scale for one in verdicts}) > 1
    cases: dict[str, list[Verdict]] = {}
    for one in verdicts:
        words = [quantity(key, value) for key, value in one.columns.items()]
        words += [f"motions scaled by {one.scale:g}"] if scaled else []
        cases.setdefault(one.case + (f" ({', '.join(words)})" if words else ""), []).append(one)
    return cases


def legend() -> Markup:
    """What :func:`matrix` shows."""
    words = (
        "Demand over limit; above 1 is too much. ✓ passes, ✗ fails, ? not decided: the bounds of the demand straddle the "
        "limit, or records are missing; – does not apply."
    )
    return tag("p", words, class_="legend")


def matrix(verdicts: Sequence[Verdict]) -> Markup:
    """A row for each case, a column for each check: demand over limit, and the verdict."""
    checks = list(dict.fromkeys(one.check for one in verdicts))
    rows = []
    for case, same in _by_case(verdicts).items():
        found = {one.check: one for one in same}
        rows.append([case, *(_cell(found[name]) if name in found else "" for name in checks)])
    return table([Head("case"), *(Head(name) for name in checks)], rows, name="Checks of every case")


def _cell(one: Verdict) -> Markup:
    ratio = "" if math.isnan(one.ratio) else "∞" if math.isinf(one.ratio) else f"{one.ratio:.2f}"
    if ratio == "1.00" and one.ratio != 1:
        ratio = f"{one.ratio:.4f}"  # beside its limit: on which side?
    shown = f"{SIGNS[one.verdict]}\u00a0{ratio}".strip()
    return alarm(shown) if one.verdict in ("fail", "not decided") else tag("span", shown)


def _asked(verdicts: Sequence[Verdict]) -> Markup:
    heads = [
        Head("check"),
        Head("demand"),
        Head("limit"),
        Head("limit from"),
        Head("reason"),
        Head("how runs count that did not go through"),
    ]
    first = {one.check: one for one in reversed(verdicts)}
    names = dict.fromkeys(one.check for one in verdicts)
    asked = [first[name] for name in names]
    rows = [
        [one.check, one.words, _limit(one), BASIS.get(one.basis, one.basis), one.reason, one.counting] for one in asked
    ]
    return table(heads, rows, prose=True, name="What the checks ask")


def _shortfalls(verdicts: Sequence[Verdict]) -> Markup:
    bounds = "bounds left by errors, by the other spring law and by runs without an outcome"
    heads = [
        Head("check"),
        Head("case"),
        Head("demand"),
        Head("between", note=bounds),
        Head("limit"),
        Head("records"),
        Head("verdict"),
        Head("note"),
    ]
    rows: list[list[object]] = []
    for case, same in _by_case(verdicts).items():
        for one in same:
            if one.verdict not in ("fail", "not decided"):
                continue
            low, high = _short(one.low), _short(one.high)
            between = f"{low} – {high}" if low != high else ""
            note = "; ".join(filter(None, (one.counted, one.note)))
            verdict = alarm(f"{SIGNS[one.verdict]} {one.verdict}")
            rows.append([one.check, case, _short(one.value), between, _limit(one), one.records or None, verdict, note])
    rows.sort(key=lambda row: "fail" not in str(row[6]))
    return table(heads, rows, sortable=True, prose=True, name="What does not pass")


def _limit(one: Verdict) -> str:
    return f"{'≤' if one.sense == 'at most' else '≥'}\u00a0{one.limit:.4g}"


def _short(value: float) -> str:
    return "∞" if math.isinf(value) else number(value)
