"""What a rule chooses, held against what there is: cases, scales, polarity, and the other spring law."""

import fnmatch
import math
from collections.abc import Collection, Iterator

from rockbatch.checks.demands import DEMANDS
from rockbatch.checks.rules import Rule
from rockbatch.toml.kinds import closest, shown


def is_about(rule: Rule, case: str) -> bool:
    """Return whether the rule is about the case of this name."""
    return not rule.case or any(_fits(case, pattern) for pattern in rule.case)


def chooses(rule: Rule, case: str, scale: float) -> bool:
    """Return whether the rule is about the case of this name at this scale."""
    return is_about(rule, case) and (not rule.scale or any(math.isclose(scale, one) for one in rule.scale))


def unmet(
    rule: Rule,
    *,
    cases: Collection[str],
    scales: Collection[float],
    polarities: Collection[str],
    other_law: bool,
    output: Collection[str],
) -> Iterator[str]:
    """Return a message for each thing that the rule chooses and the study lacks, which starts with the name of its key.

    ``output`` are the keys of [output] whose columns are there.
    """
    for pattern in rule.case:
        if not any(_fits(name, pattern) for name in cases):
            meant = closest(pattern, cases)
            instead = f"did you mean {shown(meant)}?" if meant else f"there is {', '.join(map(shown, cases))}"
            yield f"case = {shown(pattern)}: there is no such case; {instead}"
    for scale in rule.scale:
        if not any(math.isclose(scale, one) for one in scales):
            yield f"scale = {scale:g}: the motions are scaled by {', '.join(f'{one:g}' for one in scales)} only"
    if rule.polarity and rule.polarity not in polarities:
        yield f"polarity = {shown(rule.polarity)}: the motions have {shown(next(iter(polarities)))} only; leave it out"
    if rule.other_law and not other_law:
        yield (
            "other_law: there is no settlement by the other law; write both_laws = true under [output] of the study "
            "and run it, or leave other_law out"
        )
    needs = DEMANDS[rule.demand].needs
    if needs and needs not in output:
        missing = f"there is no column of {needs}; write {needs} = true under [output] of the study and run it"
        yield f"demand = {shown(rule.demand)}: {missing}"


def _fits(name: str, pattern: str) -> bool:
    return name == pattern or fnmatch.fnmatchcase(name, pattern)
