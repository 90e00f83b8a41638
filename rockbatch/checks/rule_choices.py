"""Rules checked against their study: choices that it does not offer, and limits that decide nothing."""

import math
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import NamedTuple

from rockbatch.checks.rules import Rule
from rockbatch.common.errors import MissingKey, Problem, UnknownKey, Unusual
from rockbatch.common.grouping import closest
from rockbatch.common.lazy import pd
from rockbatch.common.naming import chosen, chosen_by
from rockbatch.common.showing import shown
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import Case, weight
from rockbatch.quantities.catalogue import DEMANDS

FAR = 100.0
"""Greatest plausible ratio of a limit to its demand, or the reverse; beyond it a wrong unit is likelier."""

LEAST_SHARE = 1e-4
"""Least limit on a force over the pier's weight."""

LEAST_MM = 1.0
"""Limit of a length [mm] below which it is more probably in metres."""


def is_about(rule: Rule, case: str, cases: frozenset[str]) -> bool:
    """Return whether the rule is about the case of this name, one of ``cases``."""
    return not rule.case or case in chosen_by(tuple(rule.case), cases)


def chooses(rule: Rule, case: str, scale: float, cases: frozenset[str]) -> bool:
    """Return whether the rule is about the case of this name, one of ``cases``, at this scale."""
    return is_about(rule, case, cases) and (not rule.scale or any(math.isclose(scale, factor) for factor in rule.scale))


class Available(NamedTuple):
    """Choices that a study offers to rules.

    ``cases`` are names, ``output`` the keys of [output] whose columns it has, ``sections`` the heights [m] of sections of any
    pier; ``other_law`` is True if it has the settlement by the other spring law.
    """

    cases: Collection[str]
    scales: Collection[float]
    other_law: bool
    output: Collection[str]
    sections: Collection[float] = ()


def unmet(rule: Rule, available: Available) -> Iterator[Problem]:
    """Yield a problem for each choice of the rule that is not ``available``."""
    cases, scales = available.cases, available.scales
    for pattern in rule.case:
        if not chosen(pattern, cases):
            nearest = closest(pattern, cases)
            instead = f"did you mean {shown(nearest)}?" if nearest else f"there is {', '.join(map(shown, cases))}"
            yield Problem("case", pattern, f"there is no such case; {instead}", kind=UnknownKey)
    for scale in rule.scale:
        if not any(math.isclose(scale, factor) for factor in scales):
            text = f"the motions are scaled by {', '.join(f'{factor:g}' for factor in scales)} only"
            yield Problem("scale", scale, text, kind=UnknownKey)
    if rule.other_law and not available.other_law:
        text = (
            "there is no settlement by the other law; write both_laws = true under [output] of the study and run it, or leave "
            "other_law out"
        )
        yield Problem("other_law", None, text, kind=MissingKey)
    needs = DEMANDS[rule.demand].needs
    if needs == "sections":
        yield from _no_section(rule, available.sections)
    elif needs and needs not in available.output:
        text = f"there is no column of {needs}; write {needs} = true under [output] of the study and run it"
        yield Problem("demand", rule.demand, text, kind=MissingKey)


def has_section(rule: Rule, sections: Iterable[float]) -> bool:
    """Return whether one of these heights [m] is that of the rule, up to rounding."""
    return any(math.isclose(height, rule.at_m or 0.0, rel_tol=1e-6, abs_tol=1e-9) for height in sections)


def _no_section(rule: Rule, sections: Collection[float]) -> Iterator[Problem]:
    """Yield the problem of a rule whose section is not there, or that there are none at all."""
    if not sections:
        text = (
            "there are no forces in sections; write sections = 5 under [output] of the study and check the folder that it is "
            "run into"
        )
        yield Problem("demand", rule.demand, text, kind=MissingKey)
    elif not has_section(rule, sections):
        text = f"there is no section at this height; there are {', '.join(f'{x:g}' for x in sorted(sections))}"
        yield Problem("at_m", rule.at_m, text, kind=UnknownKey)


def implausible(rule: Rule, cases: Sequence[Case]) -> Iterator[Problem]:
    """Yield the problem of a limit that is too far from possible values to decide anything, unless it is confirmed.

    ``cases`` are as in run.json, with ``case``, ``base``, ``pier`` and ``parameters`` at least; a limit is implausible if it is
    so for all cases that the rule is about.
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
    names = frozenset(str(case["case"]) for case in cases)
    mine = [case for case in cases if demand.applies_to(case) and is_about(rule, str(case["case"]), names)]
    most = max((demand.ceiling.value(case) for case in mine if demand.ceiling), default=math.inf)
    shown = 1e-3 * most if rule.demand in ("top_drift_mm", "heel_uplift_mm") and math.isfinite(most) else 0.0
    if demand.unit == "mm" and 0 < value < max(LEAST_MM, shown):
        yield odd(f"in mm, as {rule.demand} is, hardly more than nothing; {value:g} m are {1000 * value:g} mm")
    if demand.ceiling is not None and value > most:
        yield odd(f"{rule.demand} above {most:.4g} {demand.ceiling.beyond}, so the limit decides nothing")
    elif value > 0 and (text := _far_from(rule.demand, value, mine)):
        yield odd(text)


def limit_key(rule: Rule) -> str:
    """Return the key of the rule's limit: "at_most" or "at_least"."""
    return rule.sense.replace(" ", "_")


def _far_from(name: str, value: float, cases: Sequence[Case]) -> str:
    """Return a message about a limit far from the parameter of every case, or from the weight; empty if it is near one."""
    demand = DEMANDS[name]
    if demand.per_case:
        no_runs = Rows(pd.DataFrame())
        sizes, least, most = [float(demand.evaluate(no_runs, case).value[0]) for case in cases], 1 / FAR, FAR
        words = "is {:.4g} here, {:.2g} times the limit, so that it decides nothing"
    elif demand.unit == "kN":
        sizes, least, most = [weight(case) for case in cases if "mass_t" in case["pier"]], LEAST_SHARE, FAR
        words = "is a force, and the pier's weight, {:.4g} kN, is {:.2g} times the limit"
    else:
        return ""

    # Negated, so that an unknown size, NaN, counts as near
    if not sizes or any(not least * size > value and not value > most * size for size in sizes):
        return ""
    nearest = min(sizes, key=lambda size: abs(math.log(size / value)))
    return f"{name} {words.format(nearest, nearest / value)}"
