"""Rules checked against their study: choices that it does not offer, and limits that decide nothing."""

import fnmatch
import math
from collections.abc import Collection, Iterable, Iterator, Sequence

from rockbatch.checks.rules import Rule
from rockbatch.common.errors import MissingKey, Problem, UnknownKey, Unusual
from rockbatch.common.grouping import closest
from rockbatch.common.lazy import pd
from rockbatch.common.showing import shown
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import Case, weight
from rockbatch.quantities.catalogue import DEMANDS

FAR = 100.0
"""How many times a limit may be what is limited, or the reverse; beyond it a wrong unit is likelier."""

LEAST_SHARE = 1e-4
"""Least limit on a force over the pier's weight."""

LEAST_MM = 1.0
"""Limit of a length [mm] below which metres are likelier meant."""


def is_about(rule: Rule, case: str) -> bool:
    """Return whether the rule is about the case of this name."""
    return not rule.case or any(_fits(case, pattern) for pattern in rule.case)


def chooses(rule: Rule, case: str, scale: float) -> bool:
    """Return whether the rule is about the case of this name at this scale."""
    return is_about(rule, case) and (not rule.scale or any(math.isclose(scale, factor) for factor in rule.scale))


def unmet(
    rule: Rule,
    *,
    cases: Collection[str],
    scales: Collection[float],
    other_law: bool,
    output: Collection[str],
    sections: Collection[float] = (),
) -> Iterator[Problem]:
    """Return a problem for each choice of the rule that the study lacks.

    ``output`` are the keys of [output] whose columns are there, ``sections`` the heights [m] of sections of any pier.
    """
    for pattern in rule.case:
        if not any(_fits(name, pattern) for name in cases):
            nearest = closest(pattern, cases)
            instead = f"did you mean {shown(nearest)}?" if nearest else f"there is {', '.join(map(shown, cases))}"
            yield Problem("case", pattern, f"there is no such case; {instead}", kind=UnknownKey)
    for scale in rule.scale:
        if not any(math.isclose(scale, factor) for factor in scales):
            text = f"the motions are scaled by {', '.join(f'{factor:g}' for factor in scales)} only"
            yield Problem("scale", scale, text, kind=UnknownKey)
    if rule.other_law and not other_law:
        text = (
            "there is no settlement by the other law; write both_laws = true under [output] of the study and run it, or leave "
            "other_law out"
        )
        yield Problem("other_law", None, text, kind=MissingKey)
    needs = DEMANDS[rule.demand].needs
    if needs == "sections":
        yield from _no_section(rule, sections)
    elif needs and needs not in output:
        text = f"there is no column of {needs}; write {needs} = true under [output] of the study and run it"
        yield Problem("demand", rule.demand, text, kind=MissingKey)


def has_section(rule: Rule, sections: Iterable[float]) -> bool:
    """Return whether a section at one of these heights [m] is the one that the rule is about."""
    return any(math.isclose(height, rule.at_m or 0.0, rel_tol=1e-6, abs_tol=1e-9) for height in sections)


def _no_section(rule: Rule, sections: Collection[float]) -> Iterator[Problem]:
    if not sections:
        text = (
            "there are no forces in sections; write sections = 5 under [output] of the study and check the folder that it is "
            "run into"
        )
        yield Problem("demand", rule.demand, text, kind=MissingKey)
    elif not has_section(rule, sections):
        text = f"there is no section at this height; there are {', '.join(f'{x:g}' for x in sorted(sections))}"
        yield Problem("at_m", rule.at_m, text, kind=UnknownKey)


def _fits(name: str, pattern: str) -> bool:
    return name == pattern or fnmatch.fnmatchcase(name, pattern)


def implausible(rule: Rule, cases: Sequence[Case]) -> Iterator[Problem]:
    """Yield what is odd about a limit that says nothing about the pier, probably for a wrong unit.

    It is refused unless confirmed. ``cases`` are as in run.json, with ``case``, ``base``, ``pier`` and ``parameters`` at least; a
    limit is implausible if it is so for all that the rule is about.
    """
    key = "above" if rule.statistic == "count" else limit_key(rule)
    demand, value = DEMANDS[rule.demand], rule.above if rule.statistic == "count" else rule.limit
    if value is None or key in rule.confirm:
        return

    def odd(text: str, what: str = "unit") -> Problem:
        remedy = f'check the {what}; if it is right, write confirm = ["{key}"] in this table'
        return Problem(key, float(value), f"{text}; {remedy}", kind=Unusual)

    if value < 0:
        passing = "nothing" if key == "at_most" else "all"
        yield odd(f"{rule.demand} is counted without its sign, so that {passing} passes", "sign")
    mine = [case for case in cases if demand.applies_to(case) and is_about(rule, str(case["case"]))]
    most = max((demand.ceiling.value(case) for case in mine if demand.ceiling), default=math.inf)
    shown = 1e-3 * most if rule.demand in ("top_drift_mm", "heel_uplift_mm") and math.isfinite(most) else 0.0
    if demand.unit == "mm" and 0 < value < max(LEAST_MM, shown):
        yield odd(f"in mm, as {rule.demand} is, hardly more than nothing; {value:g} m are {1000 * value:g} mm")
    if demand.ceiling is not None and value > most:
        yield odd(f"{rule.demand} above {most:.4g} {demand.ceiling.beyond}, so the limit decides nothing")
    elif value > 0 and (text := _far_from(rule.demand, value, mine)):
        yield odd(text)


def limit_key(rule: Rule) -> str:
    """Return the key of its limit: at_most or at_least."""
    return rule.sense.replace(" ", "_")


def _far_from(name: str, value: float, cases: Sequence[Case]) -> str:
    """Return that a limit is far from the parameter of every case, or as a force from the weight; empty if it is not."""
    demand = DEMANDS[name]
    if demand.per_case:
        sizes, least, most = (
            [float(demand.evaluate(Rows(pd.DataFrame()), case).value[0]) for case in cases],
            1 / FAR,
            FAR,
        )
        words = "is {:.4g} here, {:.2g} times the limit, so that it decides nothing"
    elif demand.unit == "kN":
        sizes, least, most = [weight(case) for case in cases if "mass_t" in case["pier"]], LEAST_SHARE, FAR
        words = "is a force, and the pier's weight, {:.4g} kN, is {:.2g} times the limit"
    else:
        return ""

    if not sizes or any(
        not least * size > value and not value > most * size for size in sizes
    ):  # a size may be unknown
        return ""
    nearest = min(sizes, key=lambda size: abs(math.log(size / value)))
    return f"{name} {words.format(nearest, nearest / value)}"
