"""Match the runs of two studies: same record, polarity and scale, and cases that are paired."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

from rockbatch.common.errors import refuse
from rockbatch.common.grouping import closest, grouped
from rockbatch.common.lazy import pd
from rockbatch.common.showing import shown
from rockbatch.quantities.cases import is_across, name_along
from rockbatch.quantities.design import BOUND
from rockbatch.quantities.labels import titled, values_in_words
from rockbatch.reporting.differing import Place, case_values
from rockbatch.reporting.finished import Finished
from rockbatch.results.labelled import Item
from rockbatch.study import PIER_KEYS

SIDES = ("A", "B")
_UNPAIRED = "\x00"
"""Name of cases of B without a counterpart, which no case has."""


@dataclass(frozen=True, eq=False)
class Pair:
    """Two studies, A and B, with their runs matched."""

    studies: tuple[Finished, Finished]  # results of both studies
    # matched runs of A and of B, row by row; those of B have A's ``series`` and ``pier``
    runs: "tuple[pd.DataFrame, pd.DataFrame]"
    only: "tuple[pd.DataFrame, pd.DataFrame]"  # runs without a unique counterpart in the other study
    keys: list[str]  # the matched columns
    named: Finished  # A with series labelled by the matched keys only: others may differ in B
    names: dict[str, str]  # the name of the case of A for each case of B that is paired with one


def pair(a: Finished, b: Finished, asked: Mapping[str, str] | None = None) -> Pair:
    """Match the runs of two studies by record, polarity, scale, case and the values of the keys that both vary.

    Cases are paired as ``asked``, by name of A and of B, then by equal names, and the others by the inputs that differ least.
    If only one study has bounds, its nominal design is matched. Runs with a vertical component are matched with such runs, if
    both studies say which have it. Runs alike in all of these are not matched. Raises ``InputError`` for ``asked`` as
    :func:`paired_cases`.
    """
    names = paired_cases(a, b, asked or {})
    in_both = [key for key in a.info["varied"] if key in b.info["varied"] and key != "vertical"]
    keys = ["record", "polarity", "scale", "case", *in_both]
    if "" not in {*a.runs["with_vertical"], *b.runs["with_vertical"]}:
        keys.append("with_vertical")

    def keyed_places(study: Finished, name: str) -> "pd.DataFrame":
        keyed = study.runs[keys].astype({key: object for key in in_both}).fillna({key: "" for key in in_both})
        keyed[name] = range(len(keyed))
        if BOUND in study.runs and BOUND not in in_both:
            keyed = keyed[(study.runs[BOUND] == "").to_numpy()]
        if study is b:
            keyed["case"] = [names.get(case, _UNPAIRED) for case in keyed["case"]]
        return keyed.drop_duplicates(keys, keep=False)

    pairs = keyed_places(a, "a").merge(keyed_places(b, "b"), on=keys).sort_values("a", kind="stable")
    first, second = a.runs.iloc[pairs["a"]], b.runs.iloc[pairs["b"]]
    shared = {name: first[name].to_numpy() for name in ("series", "pier", "with_vertical")}
    unmatched = a.runs.drop(index=first.index), b.runs.drop(index=second.index)
    return Pair((a, b), (first, second.assign(**shared)), unmatched, keys, _labelled_by(a, keys), names)


def paired_cases(a: Finished, b: Finished, asked: Mapping[str, str]) -> dict[str, str]:
    """Return the name of the case of A for each case of B that is paired with one; ``asked`` are those of B by those of A.

    Raises ``InputError`` for a name of ``asked`` that is not there, or a case of B that is asked for twice.
    """
    left, right = ([name for name, case in _firsts(study).items() if not is_across(case)] for study in (a, b))
    wrong = [_no_case(name, "A", left) for name in asked if name not in left]
    wrong += [_no_case(name, "B", right) for name in asked.values() if name not in right]
    twice = [name for name, n in Counter(asked.values()).items() if n > 1]
    refuse([*wrong, *(f"case {shown(name)} of B is paired twice; pair it once" for name in twice)])
    pairs = dict(asked)
    pairs |= {name: name for name in left if name in right and name not in pairs and name not in pairs.values()}
    rest = [name for name in left if name not in pairs], [name for name in right if name not in pairs.values()]
    values = [
        {name: case_values(study.study, name) for name in names} for study, names in zip((a, b), rest, strict=True)
    ]
    while rest[0] and rest[1]:
        first, second = min(product(*rest), key=lambda of: _distance(values[0][of[0]], values[1][of[1]]))
        pairs[first] = second
        rest[0].remove(first)
        rest[1].remove(second)
    across = [{name_along(case): name for name, case in _firsts(study).items() if is_across(case)} for study in (a, b)]
    pairs |= {across[0][x]: across[1][y] for x, y in list(pairs.items()) if x in across[0] and y in across[1]}
    order = [*_firsts(a)]
    return {second: first for first, second in sorted(pairs.items(), key=lambda names: order.index(names[0]))}


def _firsts(study: Finished) -> dict[str, Item]:
    """Return the first entry of run.json of each name of a case."""
    return {name: cases[0] for name, cases in grouped(study.info["cases"], lambda case: str(case["case"])).items()}


def _no_case(name: str, side: str, names: Sequence[str]) -> str:
    """Return the message about a case that a study does not have: "B has no case "pads"; did you mean "pad"?"."""
    near = closest(name, names)
    hint = f"did you mean {shown(near)}?" if near else f"there is {', '.join(map(shown, names))}"
    return f"{side} has no case {shown(name)}; {hint}"


def _distance(first: Mapping[Place, object], second: Mapping[Place, object]) -> int:
    """Return the number of keys whose values differ between two cases; a key that only one of them has counts."""
    return sum(first.get(place) != second.get(place) for place in {*first, *second})


def _labelled_by(study: Finished, keys: list[str]) -> Finished:
    """Return the study with its series labelled by the varied values of ``keys`` only."""
    varied = [key for key in study.info["varied"] if key not in PIER_KEYS and key != "vertical"]
    entries = {place: entry for (place, _), entry in study.cases.items()}
    series = []
    for (case, *values), place in study.places.items():
        columns = {name: value for name, value in zip(varied, values, strict=True) if name in keys}
        words = values_in_words(columns, entries.get(place))
        label = titled(str(case), words)
        series.append(replace(study.series[place], label=label, has_values=bool(words)))
    return replace(study, series=series)
