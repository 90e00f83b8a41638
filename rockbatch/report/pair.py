"""Two studies side by side: runs of the same record, direction, scale and case are matched by name."""

from dataclasses import dataclass, replace

from rockbatch.lazy import pd
from rockbatch.report.finished import Finished
from rockbatch.report.labels import quantity
from rockbatch.study import PIER_KEYS

SIDES = ("A", "B")


@dataclass(frozen=True, eq=False)
class Matched:
    """Runs of two studies that belong together.

    ``runs`` are of A and of B, row by row; those of B have A's places of series and pier. ``only`` are those that the
    other study lacks, or has more than once. ``keys`` are the matched columns.
    """

    runs: "tuple[pd.DataFrame, pd.DataFrame]"
    only: "tuple[pd.DataFrame, pd.DataFrame]"
    keys: list[str]


@dataclass(frozen=True, eq=False)
class Pair:
    """Everything that the page of two studies can show, A first.

    Attributes
    ----------
    studies : tuple of Finished
        Results of both studies.
    matched : Matched
        Runs that belong together.
    named : Finished
        A, with series named after the matched keys only, since the others may differ in B.
    """

    studies: tuple[Finished, Finished]
    matched: Matched
    named: Finished


def pair(*studies: Finished) -> Pair:
    """Match the runs of two studies."""
    a, b = studies
    matched = match(a, b)
    return Pair((a, b), matched, _named(a, matched.keys))


def match(a: Finished, b: Finished) -> Matched:
    """Match runs by record, polarity, scale, case and the values of the keys that both studies vary."""

    both = [key for key in a.info["varied"] if key in b.info["varied"] and key != "vertical"]
    keys = ["record", "polarity", "scale", "case", *both]
    if "" not in {*a.runs["with_vertical"], *b.runs["with_vertical"]}:
        keys.append("with_vertical")

    def places(study: Finished, name: str) -> "pd.DataFrame":
        keyed = study.runs[keys].astype({key: object for key in both}).fillna({key: "" for key in both})
        keyed[name] = range(len(keyed))
        return keyed.drop_duplicates(keys, keep=False)

    pairs = places(a, "a").merge(places(b, "b"), on=keys).sort_values("a", kind="stable")
    first, second = a.runs.iloc[pairs["a"]], b.runs.iloc[pairs["b"]]
    shared = {name: first[name].to_numpy() for name in ("series", "pier", "with_vertical")}
    unmatched = a.runs.drop(index=first.index), b.runs.drop(index=second.index)
    return Matched((first, second.assign(**shared)), unmatched, keys)


def _named(study: Finished, keys: list[str]) -> Finished:
    varied = study.info["varied"]
    of_foundation = [key for key in varied if key not in PIER_KEYS and key != "vertical"]
    series = []
    for key, place in study.places.items():
        words = [
            quantity(name, value)
            for name, value in zip(of_foundation, key[1:], strict=True)
            if name in keys and value != ""
        ]
        series.append(replace(study.series[place], label=f"{key[0]}: {', '.join(words)}" if words else str(key[0])))
    return replace(study, series=series)
