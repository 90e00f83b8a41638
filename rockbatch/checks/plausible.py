"""Limits that say nothing about the pier they are held against, probably for a wrong unit: refused until they are confirmed."""

import math
from collections.abc import Iterator, Sequence

from rockbatch.checks.choices import is_about
from rockbatch.checks.demands import DEMANDS, Case
from rockbatch.checks.rules import Rule


def implausible(rule: Rule, cases: Sequence[Case]) -> Iterator[str]:
    """What is odd about the limit of ``rule``, in a message that starts with its key.

    Of ``cases``, as in run.json, ``case``, ``base`` and ``pier`` are looked at; the limit is odd where it is so for all that the
    rule is about.
    """
    key = "above" if rule.statistic == "count" else rule.sense.replace(" ", "_")
    demand, value = DEMANDS[rule.demand], rule.above if rule.statistic == "count" else rule.limit
    if value is None or key in rule.confirm:
        return
    if value < 0:
        yield (
            f"{key} = {value:g}: {rule.demand} is counted without its sign, so that {'nothing' if key == 'at_most' else 'all'} "
            f'passes; check the sign; if it is right, write confirm = ["{key}"] in this table'
        )
    if demand.most is None:
        return
    mine = [case for case in cases if demand.on(case) and is_about(rule, str(case["case"]))]
    most = max((demand.most.of(case) for case in mine), default=math.inf)
    if value > most:
        yield (
            f"{key} = {value:g}: {rule.demand} above {most:.4g} {demand.most.told}, so the limit decides nothing; check the "
            f'unit; if it is right, write confirm = ["{key}"] in this table'
        )
