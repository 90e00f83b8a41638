"""Label the runs of finished results with their foundation, pier and ground motion, for figures and the report."""

import math
import tomllib
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.quantities.cases import Case, is_across, name_along, names_across
from rockbatch.quantities.design import BOUND, of_design, under
from rockbatch.quantities.labels import distinguishing_digits, quantity, scaled_by, titled, values_in_words
from rockbatch.quantities.rows import as_in_peaks, simulated, with_case
from rockbatch.results.labels import Key, Series, named, under_bounds
from rockbatch.study import PIER_KEYS

Item = Mapping[str, Any]
"""An object of run.json: the whole, or one of its entries."""

Row = dict[str, Any]
"""A row of a table, by column names."""


@dataclass(frozen=True, eq=False)
class Names:
    """Names of the cases of a study, made of the values that distinguish them."""

    series: list[Series]  # the foundations
    piers: list[str]  # descriptions of the varied values of each pier; [""] if none varies
    # index of each foundation in ``series``, and of each pier's varied values in ``piers``
    places: dict[Key, int]
    pier_places: dict[Key, int]

    def named_case(self, case: str, columns: Mapping[str, object], varied: Sequence[str], *also: str) -> str:
        """Return the name of a case on its pier, with ``also``, words on its runs: "pads: β = 40, p = 1 rad/s, reversed".

        ``columns`` maps the ``varied`` keys to values. A case that is not among the named ones is called by its name and all
        values of ``columns``.
        """
        key, pier = foundation_key(case, columns, varied), pier_key(columns, varied)
        if key in self.places and pier in self.pier_places:
            return self.named_place(self.places[key], self.pier_places[pier], *also)
        return titled(case, filter(None, (*values_in_words(columns), *also)))

    def named_place(self, series: int, pier: int, *also: str) -> str:
        """Return "pads: β = 40, p = 1 rad/s, reversed": a foundation and a pier, by index, and ``also``, words on its runs.

        Empty words are left out.
        """
        return self.series[series].with_values(filter(None, (self.piers[pier], *also)))


@dataclass(frozen=True, eq=False)
class Labelled(Names):
    """Runs with labels that distinguish them."""

    # The simulated rows of ``peaks.csv``, without mirror images, with further columns: ``series`` and ``pier``, indices into
    # the lists of names; ``alpha`` [rad]; ``pga`` of the scaled motion [g]; ``with_vertical``, "" unless the study ran with and
    # without the vertical component. Piers are those with a run.
    runs: "pd.DataFrame"
    cases: dict[tuple[int, int], Case]  # entries of run.json by the indices (series, pier) of their runs

    @cached_property
    def many_scales(self) -> bool:
        """Return whether several scales were run."""
        return bool(self.runs["scale"].nunique() > 1)

    def named_runs(
        self, case: str, columns: Mapping[str, object], varied: Sequence[str], scale: float | None = None
    ) -> str:
        """Return the name of a case, with the ``scale`` of its motions if given and if there are several.

        It is made once: each check has a verdict on the same case.
        """
        key = (case, scale, *columns.items(), *varied)
        if key not in self._made:
            scaled = scaled_by(scale) if self.many_scales and scale is not None else ""
            self._made[key] = self.named_case(case, columns, varied, scaled)
        return self._made[key]

    @cached_property
    def _made(self) -> dict[tuple[object, ...], str]:
        """Names of cases at scales, as :meth:`named_runs` makes them."""
        return {}

    def named_design(
        self, case: str, columns: Mapping[str, object], varied: Sequence[str], scale: float | None = None
    ) -> str:
        """Return the name of a case as :meth:`named_runs`, without the bound under which it ran."""
        return self.named_runs(case, of_design(columns), varied, scale)

    def case_of(self, run: "pd.Series[Any] | Row") -> str:
        """Return the name of a run without its record: "pads: β = 40, motions scaled by 2, reversed".

        Whether it is with or without the vertical component follows, if the study ran both.
        """
        scaled = scaled_by(run["scale"]) if run["scale"] != 1 else ""
        turned = "reversed" if run["polarity"] == "-" else ""
        return self.named_place(run["series"], run["pier"], scaled, turned, run["with_vertical"])


def names_of(cases: Iterable[Case], varied: Sequence[str], text: str) -> Names:
    """Return the names of ``cases``, entries of run.json, of a study with this ``text`` and these ``varied`` keys."""
    grouped: dict[Key, list[Case]] = {}
    piers: dict[Key, int] = {}
    given = _keys_given(text)
    for case in cases:
        grouped.setdefault(foundation_key(case["case"], case["columns"], varied), []).append(case)
        piers.setdefault(pier_key(case["columns"], varied), len(piers))
        if is_across(case):
            given[case["case"]] = given.get(name_along(case), set())
    nominal = {key: entries for key, entries in grouped.items() if not under(entries[0]["columns"])}
    series = named(nominal, [key for key in varied if _of_foundation(key)], given)
    series = under_bounds(series, grouped) if BOUND in varied else series
    places = {key: place for place, key in enumerate(series)}
    return Names(list(series.values()), _words_of(piers, varied), places, piers)


def _words_of(piers: Collection[Key], varied: Sequence[str]) -> list[str]:
    """Return the varied values of each pier in words; [""] without piers."""
    keys = [key for key in varied if key in PIER_KEYS]
    digits = [distinguishing_digits(values) for values in zip(*piers, strict=True)]
    return [", ".join(map(quantity, keys, values, digits)) for values in piers] or [""]


def labelled(peaks: "pd.DataFrame", info: Item, directory: Path) -> Labelled:
    """Label the simulated runs of peaks.csv with the foundations and piers of ``info``, which is run.json.

    Raises ``InputError`` if the two do not belong together.
    """
    varied = info["varied"]
    names = names_of(info["cases"], varied, info["study"]["text"])
    entries = {_pair(case["case"], case["columns"], varied): case for case in info["cases"]}
    runs = simulated(with_case(peaks)).copy(deep=False)
    kinds = runs.groupby(["case", *varied], sort=False, dropna=False).ngroup() if len(runs) else runs["scale"]
    piers: dict[Key, int] = {}
    facts: dict[int, tuple[int, int, float]] = {}
    cases: dict[tuple[int, int], Case] = {}
    unknown = set()
    for row in as_dicts(runs.assign(kind=kinds).drop_duplicates("kind")):
        pair = _pair(row["case"], row, varied)
        if pair not in entries:
            unknown.add(str(row["case"]))
            continue
        place = names.places[pair[0]], piers.setdefault(pair[1], len(piers))
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
    if across := names_across(info["cases"]):
        runs["pga"] = runs["pga"].where(
            ~runs["case"].isin(across), runs["pga_g"]
        )  # run.json has the PGA of the other component
    runs["with_vertical"] = _with_vertical(runs)
    return Labelled(names.series, _words_of(piers, varied), names.places, piers, runs, cases)


def _pair(case: str, columns: Mapping[str, object], varied: Sequence[str]) -> tuple[Key, Key]:
    """Return :func:`foundation_key` and :func:`pier_key` of a case: ("pads", 40.0) and (1.0,).

    They are ("pads",) and () if nothing varies.
    """
    return foundation_key(case, columns, varied), pier_key(columns, varied)


def groups_of(runs: "pd.DataFrame", piers: Sequence[str]) -> "Iterator[tuple[str, pd.DataFrame]]":
    """Yield a description and the runs of each group of one scale, pier and vertical component, ordered by these.

    The description names those of the three that differ in ``runs``; "" if none does. A generator, since all groups together
    take as much memory as ``runs``.
    """
    rows: dict[Any, Any] = runs.groupby(["scale", "pier", "with_vertical"]).indices
    scaled = runs["scale"].nunique() > 1
    for group in sorted(rows):
        of_group = runs.iloc[rows[group]] if len(rows) > 1 else runs
        first = of_group.iloc[0]
        scale = scaled_by(first["scale"]) if scaled else ""
        words = [piers[first["pier"]], scale, first["with_vertical"]]
        yield ", ".join(filter(None, words)), of_group


def ceiling(runs: "pd.DataFrame") -> float:
    """Return the top of a θ_max/α axis: 1.1 times the highest peak with its error of runs with status "ok"; 1 without any."""
    stood = runs[runs["status"] == "ok"]
    highest = (stood["theta_max_over_alpha"] + stood["theta_max_error"].fillna(0)).max()
    return 1.1 * float(highest) if highest > 0 else 1.0


def by_pga(names: Iterable[str], info: Item) -> list[str]:
    """Sort the record ``names`` by peak ground acceleration, weakest first, then by name; unknown records last."""
    pga = {record["record"]: record["pga_g"] for record in info["records"]}
    return sorted(names, key=lambda name: (pga.get(name, math.inf), name))


def _keys_given(text: str) -> dict[str, set[str]]:
    """Return the keys of each [[case]] in a study's text, by case name; empty if the text cannot be parsed."""
    try:
        cases = tomllib.loads(text).get("case", [])
        return {str(case.get("name", case.get("base"))): set(case) for case in cases}
    except (tomllib.TOMLDecodeError, AttributeError, TypeError):
        return {}


def as_dicts(runs: "pd.DataFrame") -> list[Row]:
    """Return the rows of ``runs`` as dictionaries by column name; missing values are NaN."""
    columns = {}
    for name, column in runs.items():
        is_plain = isinstance(column.dtype, np.dtype) and column.dtype.kind in "fib"
        columns[str(name)] = (column if is_plain else column.to_numpy(object, na_value=math.nan)).tolist()
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def foundation_key(case: str, columns: Mapping[str, object], varied: Sequence[str]) -> Key:
    """Return the key of a foundation: case name, and varied values but those of the pier and ``vertical``.

    ``columns`` maps varied keys to values; a key that it lacks is "".
    """
    return (case, *(as_in_peaks(columns.get(key)) for key in varied if _of_foundation(key)))


def _of_foundation(key: str) -> bool:
    return key not in PIER_KEYS and key != "vertical"


def pier_key(columns: Mapping[str, object], varied: Sequence[str]) -> Key:
    """Return the key of a pier: its varied values, "" for one that ``columns`` lacks; () if no key of the pier is varied."""
    return tuple(as_in_peaks(columns.get(key)) for key in varied if key in PIER_KEYS)


def _with_vertical(runs: "pd.DataFrame") -> "pd.Series[str] | str":
    """Return "with vertical" or "without vertical" for each run; "" if the study ran only one of them."""
    if "vertical" not in runs or runs["vertical"].nunique() < 2:
        return ""
    yes = runs["vertical"].astype(str).str.lower().isin(["true", "1", "1.0", "yes", "with"])
    return yes.map({True: "with vertical", False: "without vertical"})
