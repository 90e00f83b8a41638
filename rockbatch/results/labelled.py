"""Runs of finished results with their foundation, pier and ground motion: what figures and the report are made of."""

import math
import tomllib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.quantities.rows import as_in_peaks, simulated, with_case
from rockbatch.results.labels import Key, Series, digits_that_tell, named, quantity
from rockbatch.study import PIER_KEYS


@dataclass(frozen=True, eq=False)
class Labelled:
    """Runs and what tells them apart.

    Attributes
    ----------
    runs : DataFrame
        The simulated rows of ``peaks.csv``, without mirror images, with further columns: ``series`` and ``pier``, places in
        the lists below; ``alpha`` [rad]; ``pga`` [g], that of the scaled motion; ``with_vertical``, "" unless the study
        has both.
    series : list of Series
        The foundations.
    piers : list of str
        Descriptions of the varied values of each pier; [""] if none varies.
    places, pier_places : dict
        Place of each foundation in ``series``, and of the varied values of each pier in ``piers``.
    cases : dict
        Entries of run.json for each foundation and pier that have runs, by their places.
    """

    runs: "pd.DataFrame"
    series: list[Series]
    piers: list[str]
    places: dict[Key, int]
    pier_places: dict[Key, int]
    cases: dict[tuple[int, int], dict[str, Any]]

    @cached_property
    def many_scales(self) -> bool:
        """Return whether motions of several scales were run."""
        return bool(self.runs["scale"].nunique() > 1)

    def named_case(
        self, case: str, columns: Mapping[str, Any], varied: Sequence[str], scale: float | None = None
    ) -> str:
        """Return the short name of a case on its pier, and the ``scale`` of its motions, if it is given and there are several.

        ``columns`` maps the ``varied`` keys to values.
        """
        key, pier = foundation(case, columns, varied), pier_of(columns, varied)
        if key in self.places and pier in self.pier_places:
            words = [self.series[self.places[key]].label, self.piers[self.pier_places[pier]]]
        else:  # without a run
            words = [case, *(quantity(name, value) for name, value in columns.items())]
        scaled = f"motions scaled by {scale:g}" if self.many_scales and scale is not None else ""
        return ", ".join(filter(None, (*words, scaled)))


def labelled(peaks: "pd.DataFrame", info: Mapping[str, Any], directory: Path) -> Labelled:
    """Return the runs of peaks.csv with their places among the foundations and piers of run.json.

    Raises ``InputError`` if the two do not belong together.
    """
    varied = info["varied"]
    grouped: dict[Key, list[dict[str, Any]]] = {}
    entries: dict[tuple[Key, Key], dict[str, Any]] = {}
    for case in info["cases"]:
        key = foundation(case["case"], case["columns"], varied)
        grouped.setdefault(key, []).append(case)
        entries[key, pier_of(case["columns"], varied)] = case
    given = _given(info["study"]["text"])
    given |= {case["case"]: given.get(case["across_of"], set()) for case in info["cases"] if case.get("across_of")}
    series = named(grouped, [key for key in varied if _of_foundation(key)], given)
    places = {key: place for place, key in enumerate(series)}

    runs = simulated(with_case(peaks)).copy(deep=False)
    kinds = runs.groupby(["case", *varied], sort=False, dropna=False).ngroup() if len(runs) else runs["scale"]
    piers: dict[Key, int] = {}
    facts: dict[int, tuple[int, int, float]] = {}
    cases: dict[tuple[int, int], dict[str, Any]] = {}
    unknown = set()
    for row in as_dicts(runs.assign(kind=kinds).drop_duplicates("kind")):
        pair = foundation(row["case"], row, varied), pier_of(row, varied)
        if pair not in entries:
            unknown.add(str(row["case"]))
            continue
        place = places[pair[0]], piers.setdefault(pair[1], len(piers))
        cases[place] = entries[pair]
        facts[row["kind"]] = *place, float(entries[pair]["pier"]["alpha"])
    if unknown:
        raise InputError(
            f"{directory}: peaks.csv has runs of case {', '.join(sorted(unknown))} that run.json does not list; "
            "the two files belong to different runs; start `rockbatch run` again"
        )
    for column, name in enumerate(("series", "pier", "alpha")):
        runs[name] = kinds.map({kind: fact[column] for kind, fact in facts.items()})
    pga = {record["record"]: record["pga_g"] for record in info["records"]}
    runs["pga"] = runs["record"].map(pga).astype("float64") * runs["scale"]
    if across := {case["case"] for case in info["cases"] if case.get("across_of")}:
        runs["pga"] = runs["pga"].where(~runs["case"].isin(across), runs["pga_g"])  # of the other component
    runs["with_vertical"] = _with_vertical(runs)
    keys = [key for key in varied if key in PIER_KEYS]
    digits = [digits_that_tell(values) for values in zip(*piers, strict=True)]
    words = [", ".join(map(quantity, keys, values, digits)) for values in piers] or [""]
    return Labelled(runs, list(series.values()), words, places, piers, cases)


def groups_of(runs: "pd.DataFrame", piers: Sequence[str]) -> "Iterator[tuple[str, pd.DataFrame]]":
    """Yield the runs of each scale, pier and vertical component, with the words that identify them; one group at a time, as
    together they are a second table."""
    rows: dict[Any, Any] = runs.groupby(["scale", "pier", "with_vertical"]).indices
    scaled = runs["scale"].nunique() > 1
    for group in sorted(rows):
        of_group = runs.iloc[rows[group]] if len(rows) > 1 else runs
        first = of_group.iloc[0]
        scale = f"motions scaled by {float(first['scale']):.4g}" if scaled else ""
        words = [piers[first["pier"]], scale, first["with_vertical"]]
        yield ", ".join(filter(None, words)), of_group


def ceiling(runs: "pd.DataFrame") -> float:
    """Return the top of the axis [θ_max/α] that holds all of ``runs`` that stood."""
    stood = runs[runs["status"] == "ok"]
    highest = (stood["theta_max_over_alpha"] + stood["theta_max_error"].fillna(0)).max()
    return 1.1 * float(highest) if highest > 0 else 1.0


def by_pga(names: Iterable[str], info: Mapping[str, Any]) -> list[str]:
    """Return ``names`` of records in order of peak ground acceleration, the weakest first."""
    pga = {record["record"]: record["pga_g"] for record in info["records"]}
    return sorted(names, key=lambda name: (pga.get(name, math.inf), name))


def _given(text: str) -> dict[str, set[str]]:
    """Return the keys that a study's text gives for each case, by the case's name; empty if the text is no study."""
    try:
        cases = tomllib.loads(text).get("case", [])
        return {str(case.get("name", case.get("base"))): set(case) for case in cases}
    except (tomllib.TOMLDecodeError, AttributeError, TypeError):
        return {}


def as_dicts(runs: "pd.DataFrame") -> list[dict[str, Any]]:
    """Return the rows of ``runs``, each as a mapping from column names to values."""
    columns = {
        str(name): column.tolist()
        if isinstance(column.dtype, np.dtype) and column.dtype.kind in "fib"
        else column.to_numpy(object, na_value=math.nan).tolist()
        for name, column in runs.items()
    }
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def foundation(case: str, columns: Mapping[str, Any], varied: Sequence[str]) -> Key:
    """Return the key that identifies a foundation; ``columns`` maps varied keys to values."""
    return (case, *(as_in_peaks(columns.get(key)) for key in varied if _of_foundation(key)))


def _of_foundation(key: str) -> bool:
    return key not in PIER_KEYS and key != "vertical"


def pier_of(columns: Mapping[str, Any], varied: Sequence[str]) -> Key:
    """Return the key that identifies a pier; ``columns`` maps varied keys to values."""
    return tuple(as_in_peaks(columns.get(key)) for key in varied if key in PIER_KEYS)


def _with_vertical(runs: "pd.DataFrame") -> "pd.Series[str] | str":
    """Return words for each run if the study was run with and without the vertical component; else ""."""
    if "vertical" not in runs or runs["vertical"].nunique() < 2:
        return ""
    yes = runs["vertical"].astype(str).str.lower().isin(["true", "1", "1.0", "yes", "with"])
    return yes.map({True: "with vertical", False: "without vertical"})
