"""Rules checked against their study: choices that it does not offer, and limits that decide nothing."""

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import chain
from typing import NamedTuple

from rockbatch.checks.rules import Rule
from rockbatch.common.errors import MissingKey, Problem, UnknownKey, Unusual
from rockbatch.common.grouping import closest
from rockbatch.common.lazy import pd
from rockbatch.common.naming import chosen
from rockbatch.common.showing import shown
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import Case, name_along, weight
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.quantities.demands import AT_HEIGHTS, OF_BASE

FAR = 100.0
"""Greatest plausible ratio of a limit to its demand, or the reverse; beyond it a wrong unit is likelier."""

LEAST_SHARE = 1e-4
"""Least limit on a force over the pier's weight."""

LEAST_MM = 1.0
"""Limit of a length [mm] below which it is more probably in metres."""


class Available(NamedTuple):
    """Choices that a study offers to rules.

    ``cases`` are names, ``output`` the keys of [output] whose columns it has, ``sections`` the heights [m] of sections of any
    pier by the ``needs`` of demands. ``piers`` are the cases with which limits are compared, as in run.json, with ``case``,
    ``base``, ``pier`` and ``parameters`` at least; none if limits are not compared.
    """

    cases: Collection[str]
    scales: Collection[float]
    output: Collection[str]
    sections: Mapping[str, Collection[float]] = {}
    piers: Sequence[Case] = ()


class Fitted(NamedTuple):
    """A rule, the cases, scales and sections [m] of a study to which it applies, NaN for the base, and its problems there."""

    rule: Rule
    cases: frozenset[str]
    scales: list[float]
    sections: list[float]
    problems: list[Problem]


def fitted(rule: Rule, available: Available) -> Fitted:
    """Return a rule fitted to a study: what it chooses of what is ``available``, and a problem for each choice that is not.

    If piers are available, so is a problem of a limit or capacity that decides nothing on them.
    """
    matches = {pattern: chosen(pattern, available.cases) for pattern in rule.case}
    cases = frozenset(chain.from_iterable(matches.values()) if rule.case else available.cases)
    scales = [scale for scale in available.scales if not rule.scale or _is_among(scale, rule.scale)]
    heights = available.sections.get(DEMANDS[rule.demand].needs, ())
    at = [] if rule.at_m is None else [height for height in heights if is_height(height, rule.at_m)]
    if DEMANDS[rule.demand].needs == OF_BASE:
        at = [math.nan]
    problems = [*_unavailable(rule, matches, available), *_no_section(rule, at, heights)]
    piers = [case for case in available.piers if name_along(case) in cases]
    if available.piers:
        problems += _without_dead_load(rule, piers) if rule.curve else _implausible(rule, piers)
    return Fitted(rule, cases, scales, at, problems)


def _is_among(scale: float, scales: Iterable[float]) -> bool:
    """Return whether a scale is one of these, up to rounding."""
    return any(math.isclose(scale, factor) for factor in scales)


def is_height(height: float, other: float) -> bool:
    """Return whether two heights [m] are the same, up to rounding."""
    return math.isclose(height, other, rel_tol=1e-6, abs_tol=1e-9)


def _unavailable(rule: Rule, matches: Mapping[str, Collection[str]], available: Available) -> Iterator[Problem]:
    """Yield a problem for each case, scale and column of the rule, and the other law, that is not ``available``.

    ``matches`` has the names of cases by the rule's patterns.
    """
    cases, scales = available.cases, available.scales
    for pattern, names in matches.items():
        if not names:
            nearest = closest(pattern, cases)
            instead = f"did you mean {shown(nearest)}?" if nearest else f"there is {', '.join(map(shown, cases))}"
            yield Problem("case", pattern, f"there is no such case; {instead}", kind=UnknownKey)
    for scale in rule.scale:
        if not _is_among(scale, scales):
            text = f"the motions are scaled by {', '.join(f'{factor:g}' for factor in scales)} only"
            yield Problem("scale", scale, text, kind=UnknownKey)
    needs, end = DEMANDS[rule.demand].needs, DEMANDS[rule.demand].other_end
    if end and getattr(rule, end.asked_by) and end.needs not in available.output:
        text = (
            f"there is no {rule.demand} by the other {end.model}; write {end.needs} = true under [output] of the study and run "
            f"it, or leave {end.asked_by} out"
        )
        yield Problem(end.asked_by, None, text, kind=MissingKey)
    if needs and needs not in AT_HEIGHTS and needs not in available.output:
        text = f"there is no column of {needs}; write {needs} = true under [output] of the study and run it"
        yield Problem("demand", rule.demand, text, kind=MissingKey)


def _no_section(rule: Rule, own: Collection[float], sections: Collection[float]) -> Iterator[Problem]:
    """Yield the problem of a rule on a section if no ``sections`` [m] are known, or none is at its height (``own`` is empty)."""
    if not DEMANDS[rule.demand].in_section:
        return
    if not sections:
        text = (
            f"there are no forces in sections; write {AT_HEIGHTS[DEMANDS[rule.demand].needs]} under [output] of the study and "
            "check the folder that it is run into"
        )
        yield Problem("demand", rule.demand, text, kind=MissingKey)
    elif not own:
        text = f"there is no section at this height; there are {', '.join(f'{x:g}' for x in sorted(sections))}"
        yield Problem("at_m", rule.at_m, text, kind=UnknownKey)


def _without_dead_load(rule: Rule, cases: Sequence[Case]) -> Iterator[Problem]:
    """Yield the problem of a capacity whose curve has the axial force of the dead load in none of the ``cases``.

    That force is the weight at the base and in a section at the foot; above, any force from 0 to the weight will do. No problem
    if no mass is known.
    """
    ends = [axial for axial, _ in rule.curve or ()]
    weights, at_foot = [weight(case) for case in cases if "mass_t" in case["pier"]], not rule.at_m
    if any(ends[0] <= most and ends[-1] >= (most if at_foot else 0.0) for most in weights) or not weights:
        return
    at = "is" if at_foot else "is above 0 and at most"
    text = (
        f"capacity goes from N = {ends[0]:g} to {ends[-1]:g} kN, and that of the dead load {at} {max(weights):.4g} kN: "
        "write N in kN, positive in compression"
    )
    yield Problem("capacity", None, text, kind=Unusual, named=False)


def _implausible(rule: Rule, cases: Sequence[Case]) -> Iterator[Problem]:
    """Yield problems of a limit, or threshold of "count", that decides nothing; none if it is confirmed.

    It is negative, next to 0 in mm, not below 1 of an event, or in all ``cases`` above the greatest possible value or far from
    the size of the quantity.
    """
    key = "above" if rule.statistic == "count" else rule.limit_key
    demand, value = DEMANDS[rule.demand], rule.above if rule.statistic == "count" else rule.limit
    if value is None or key in rule.confirm:
        return
    given = rule.number_of_capacity or value

    def odd(text: str, remedy: str = "check the unit") -> Problem:
        confirmed = f'if it is right, write confirm = ["{key}"] in this table'
        return Problem(key, float(given), f"{text}; {remedy}; {confirmed}", kind=Unusual)

    if value < 0:
        passing = "nothing" if key == "at_most" else "all"
        yield odd(f"{rule.demand} is counted without its sign, so that {passing} passes", "check the sign")
    if demand.event and value >= 1:
        yield odd(f"{rule.demand} is 0 or 1 for every record, so that nothing exceeds {value:g}", "check the limit")
    mine = [case for case in cases if demand.applies_to(case)]
    most = max((demand.ceiling.value(case) for case in mine if demand.ceiling), default=math.inf)
    shown = 1e-3 * most if rule.demand in ("top_drift_mm", "heel_uplift_mm") and math.isfinite(most) else 0.0
    if demand.unit == "mm" and 0 < value < max(LEAST_MM, shown):
        yield odd(f"in mm, as {rule.demand} is, hardly more than nothing; {value:g} m are {1000 * value:g} mm")
    if demand.ceiling is not None and value > most:
        text = f"{rule.demand} above {most:.4g} {demand.ceiling.beyond}, so the limit decides nothing"
        yield odd(text, demand.ceiling.remedy)
    elif value > 0 and (text := _far_from(rule.demand, value, mine)):
        yield odd(text)


def _far_from(name: str, value: float, cases: Sequence[Case]) -> str:
    """Return a message on a limit far from the parameter of every case, or a force far from the weight; "" otherwise.

    Far is by a factor above 100, and below 10⁻⁴ of the weight; an unknown size (NaN), or no case, counts as near.
    """
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
