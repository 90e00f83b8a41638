"""Rules checked against their study: choices that it does not offer, and limits that decide nothing."""

import fnmatch
import math
from collections.abc import Collection, Iterable, Iterator, Sequence

from rockbatch.checks.rules import Rule
from rockbatch.common.grouping import closest
from rockbatch.common.lazy import pd
from rockbatch.common.showing import shown
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import Case, weight
from rockbatch.quantities.catalogue import DEMANDS
from rockbatch.toml.meant import in_another_unit

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
) -> Iterator[str]:
    """Return a message for each choice of the rule that the study lacks; each starts with the name of its key.

    ``output`` are the keys of [output] whose columns are there, ``sections`` the heights [m] of sections of any pier.
    """
    for pattern in rule.case:
        if not any(_fits(name, pattern) for name in cases):
            nearest = closest(pattern, cases)
            instead = f"did you mean {shown(nearest)}?" if nearest else f"there is {', '.join(map(shown, cases))}"
            yield f"case = {shown(pattern)}: there is no such case; {instead}"
    for scale in rule.scale:
        if not any(math.isclose(scale, factor) for factor in scales):
            yield f"scale = {scale:g}: the motions are scaled by {', '.join(f'{factor:g}' for factor in scales)} only"
    if rule.other_law and not other_law:
        yield (
            "other_law: there is no settlement by the other law; write both_laws = true under [output] of the study "
            "and run it, or leave other_law out"
        )
    needs = DEMANDS[rule.demand].needs
    if needs == "sections":
        yield from _no_section(rule, sections)
    elif needs and needs not in output:
        missing = f"there is no column of {needs}; write {needs} = true under [output] of the study and run it"
        yield f"demand = {shown(rule.demand)}: {missing}"


def has_section(rule: Rule, sections: Iterable[float]) -> bool:
    """Return whether a section at one of these heights [m] is the one that the rule is about."""
    return any(math.isclose(height, rule.at_m or 0.0, rel_tol=1e-6, abs_tol=1e-9) for height in sections)


def _no_section(rule: Rule, sections: Collection[float]) -> Iterator[str]:
    if not sections:
        yield (
            f"demand = {shown(rule.demand)}: there are no forces in sections; write sections = 5 under [output] of the study and "
            "check the folder that it is run into"
        )
    elif not has_section(rule, sections):
        yield (
            f"at_m = {rule.at_m:g}: there is no section at this height; there are {', '.join(f'{x:g}' for x in sorted(sections))}"
        )


def _fits(name: str, pattern: str) -> bool:
    return name == pattern or fnmatch.fnmatchcase(name, pattern)


def implausible(rule: Rule, cases: Sequence[Case]) -> Iterator[str]:
    """Yield messages on a limit that says nothing about the pier, probably for a wrong unit; each starts with the limit's key.

    It is refused unless confirmed. ``cases`` are as in run.json, with ``case``, ``base``, ``pier`` and ``parameters`` at least; a
    limit is implausible if it is so for all that the rule is about.
    """
    key = "above" if rule.statistic == "count" else limit_key(rule)
    demand, value = DEMANDS[rule.demand], rule.above if rule.statistic == "count" else rule.limit
    if value is None or key in rule.confirm:
        return
    remedy = f'check the unit; if it is right, write confirm = ["{key}"] in this table'
    if value < 0:
        yield (
            f"{key} = {value:g}: {rule.demand} is counted without its sign, so that {'nothing' if key == 'at_most' else 'all'} "
            f"passes; {remedy.replace('unit', 'sign', 1)}"
        )
    mine = [case for case in cases if demand.applies_to(case) and is_about(rule, str(case["case"]))]
    most = max((demand.ceiling.value(case) for case in mine if demand.ceiling), default=math.inf)
    shown = 1e-3 * most if rule.demand in ("top_drift_mm", "heel_uplift_mm") and math.isfinite(most) else 0.0
    if demand.unit == "mm" and 0 < value < max(LEAST_MM, shown):
        yield (
            f"{key} = {value:g}: in mm, as {rule.demand} is, hardly more than nothing; {value:g} m are "
            f"{1000 * value:g} mm; {remedy}"
        )
    if demand.ceiling is not None and value > most:
        yield f"{key} = {value:g}: {rule.demand} above {most:.4g} {demand.ceiling.beyond}, so the limit decides nothing; {remedy}"
    elif value > 0 and (odd := _far_from(rule.demand, key, value, mine)):
        yield f"{odd}; {remedy}"


def limit_key(rule: Rule) -> str:
    """Return the key of its limit: at_most or at_least."""
    return rule.sense.replace(" ", "_")


def _far_from(name: str, key: str, value: float, cases: Sequence[Case]) -> str:
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

    def fits(limit: float) -> bool:
        return any(not least * size > limit and not limit > most * size for size in sizes)  # a size may be unknown

    if not sizes or fits(value):
        return ""
    nearest = min(sizes, key=lambda size: abs(math.log(size / value)))
    other = in_another_unit(name, value, fits, key)
    return f"{key} = {value:g}: {name} {words.format(nearest, nearest / value)}{other}"
