"""Match the runs of two studies: same record, polarity, scale and case by name."""

from dataclasses import dataclass, replace

from rockbatch.common.lazy import pd
from rockbatch.reporting.finished import Finished
from rockbatch.results.labels import quantity
from rockbatch.study import PIER_KEYS

SIDES = ("A", "B")


@dataclass(frozen=True, eq=False)
class Pair:
    """Two studies, A and B, with their runs matched.

    Attributes
    ----------
    studies : tuple of Finished
        Results of both studies.
    runs : tuple of DataFrame
        Matched runs of A and of B, row by row; those of B have A's ``series`` and ``pier``.
    only : tuple of DataFrame
        Runs without a unique counterpart in the other study.
    keys : list of str
        The matched columns.
    named : Finished
        A with series labelled by the matched keys only: others may differ in B.
    """

    studies: tuple[Finished, Finished]
    runs: "tuple[pd.DataFrame, pd.DataFrame]"
    only: "tuple[pd.DataFrame, pd.DataFrame]"
    keys: list[str]
    named: Finished


def pair(a: Finished, b: Finished) -> Pair:
    """Match the runs of two studies by record, polarity, scale, case and the values of the keys that both vary."""
    in_both = [key for key in a.info["varied"] if key in b.info["varied"] and key != "vertical"]
    keys = ["record", "polarity", "scale", "case", *in_both]
    if "" not in {*a.runs["with_vertical"], *b.runs["with_vertical"]}:
        keys.append("with_vertical")

    def keyed_places(study: Finished, name: str) -> "pd.DataFrame":
        keyed = study.runs[keys].astype({key: object for key in in_both}).fillna({key: "" for key in in_both})
        keyed[name] = range(len(keyed))
        return keyed.drop_duplicates(keys, keep=False)

    pairs = keyed_places(a, "a").merge(keyed_places(b, "b"), on=keys).sort_values("a", kind="stable")
    first, second = a.runs.iloc[pairs["a"]], b.runs.iloc[pairs["b"]]
    shared = {name: first[name].to_numpy() for name in ("series", "pier", "with_vertical")}
    unmatched = a.runs.drop(index=first.index), b.runs.drop(index=second.index)
    return Pair((a, b), (first, second.assign(**shared)), unmatched, keys, _labelled_by(a, keys))


def _labelled_by(study: Finished, keys: list[str]) -> Finished:
    """Return the study with its series labelled by the varied values of ``keys`` only."""
    varied = [key for key in study.info["varied"] if key not in PIER_KEYS and key != "vertical"]
    series = []
    for (case, *values), place in study.places.items():
        pairs = [(name, value) for name, value in zip(varied, values, strict=True) if name in keys and value != ""]
        words = ", ".join(quantity(name, value) for name, value in pairs)
        series.append(replace(study.series[place], label=f"{case}: {words}" if words else str(case)))
    return replace(study, series=series)
