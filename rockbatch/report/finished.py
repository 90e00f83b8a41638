"""Finished results as the report reads them: every run with its pier, its foundation and its ground motion."""

import math
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rockbatch.checks import Verdict, read_verdicts
from rockbatch.checks.coverage import CaseRuns, runs_of_cases
from rockbatch.checks.responses import Worst, worst_of_cases
from rockbatch.common.lazy import pd
from rockbatch.errors import InputError
from rockbatch.report.finished_analysis import Contents
from rockbatch.report.labels import Key, Series, counted, digits_that_tell, named, quantity
from rockbatch.report.markup import Markup, join, number, tag
from rockbatch.results.opened import Results, open_results
from rockbatch.results.reading import Saved
from rockbatch.results.rows import NOT_RUN, counts_as, simulated, with_case
from rockbatch.simulation.response import Response
from rockbatch.study import PIER_KEYS

if TYPE_CHECKING:
    from pandas.core.groupby import DataFrameGroupBy


@dataclass(frozen=True, eq=False)
class Finished(Contents):
    """Contents of a folder of results.

    Attributes
    ----------
    saved : Saved
        Contents of ``peaks.csv`` and ``run.json``.
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
    responses : sequence of Response
        Runs whose histories are shown.
    verdicts : sequence of Verdict
        Results of ``rockbatch check``.
    """

    saved: Saved
    runs: "pd.DataFrame"
    series: list[Series]
    piers: list[str]
    places: dict[Key, int]
    pier_places: dict[Key, int]
    cases: dict[tuple[int, int], dict[str, Any]]
    responses: Sequence[Response] = ()
    verdicts: Sequence[Verdict] = ()

    @property
    def info(self) -> dict[str, Any]:
        """Return the contents of ``run.json``."""
        return self.saved.info

    @cached_property
    def records(self) -> dict[str, dict[str, Any]]:
        """Return the entries of ``run.json`` on the ground motions, by their names."""
        return {record["record"]: record for record in self.info["records"]}

    @cached_property
    def pier_as_given(self) -> dict[str, Any]:
        """Return the table [pier] of the study file; empty if the text cannot be parsed."""
        try:
            pier = tomllib.loads(self.info["study"]["text"]).get("pier", {})
        except tomllib.TOMLDecodeError:
            return {}
        return pier if isinstance(pier, dict) else {}

    @property
    def count(self) -> str:
        """Return what counts as one record: "station", or "component"; the latter too if the stations are not known."""
        count = str(self.info.get("count", "station"))
        return "component" if counts_as(self.runs, count)[1] else count

    @cached_property
    def worst(self) -> list[Worst]:
        """Return the worst responses of every case."""
        return worst_of_cases(self.runs, [self.cases[places] for places in sorted(self.cases)])

    @cached_property
    def suites(self) -> list[CaseRuns]:
        """Return every case at every scale, with how many of its runs do not end standing."""
        return runs_of_cases(self.runs, self.info["cases"], len(self.info["records"]))

    @cached_property
    def not_run(self) -> int:
        """Return how many planned runs have no row in the table."""
        return sum(suite.ended.get(NOT_RUN, 0) for suite in self.suites)

    def of_all(self, runs: int, words: str) -> str:
        """Return a number of runs, and of how many if these are not all that were planned: "8 of 10 runs that end standing"."""
        planned = len(self.runs) + self.not_run
        return counted(runs, "run") if runs == planned else f"{runs:,} of {counted(planned, 'run')} that {words}"

    @cached_property
    def both_directions(self) -> bool:
        """Return whether motions were run in both polarities."""
        return bool(self.runs["polarity"].nunique() > 1)

    @cached_property
    def mirrored(self) -> bool:
        """Return whether the table holds mirror images besides the simulated runs."""
        return len(simulated(self.saved.peaks)) < len(self.saved.peaks)

    def place(self, case: str, columns: Mapping[str, Any]) -> tuple[int, int]:
        """Return the places in ``series`` and ``piers`` of a case with the given varied values."""
        varied = self.info["varied"]
        try:
            return self.places[foundation(case, columns, varied)], self.pier_places[_pier(columns, varied)]
        except KeyError:
            raise InputError(
                f"{self.saved.directory}: there is a history of case {case} that peaks.csv or run.json does not list; the "
                "files belong to different runs; start `rockbatch run` again"
            ) from None

    def by_pga(self, names: Sequence[str]) -> list[str]:
        """Return ``names`` of records in order of peak ground acceleration, the weakest first."""
        return sorted(names, key=lambda name: (self.records.get(name, {}).get("pga_g", math.inf), name))

    @cached_property
    def grouped(self) -> "DataFrameGroupBy":
        """Return the runs grouped by scale, pier and vertical component."""
        return self.runs.groupby(["scale", "pier", "with_vertical"])

    def groups(self) -> "Iterator[tuple[str, pd.DataFrame]]":
        """Yield each group of runs, with the words that identify it; one at a time, as together they are a second table."""
        rows: dict[Any, Any] = self.grouped.indices
        scaled = self.runs["scale"].nunique() > 1
        for group in sorted(rows):
            runs = self.runs.iloc[rows[group]] if len(rows) > 1 else self.runs
            first = runs.iloc[0]
            scale = f"motions scaled by {number(float(first['scale']))}" if scaled else ""
            words = [self.piers[first["pier"]], scale, first["with_vertical"]]
            yield ", ".join(filter(None, words)), runs

    def case_of(self, run: "pd.Series[Any] | dict[str, Any]") -> str:
        """Describe a run among those of the same record: its foundation, and whatever else identifies it."""
        also = [self.piers[run["pier"]], f"scale {number(float(run['scale']))}" if run["scale"] != 1 else ""]
        also += ["reversed" if run["polarity"] == "-" else "", run["with_vertical"]]
        details = ", ".join(filter(None, also))
        return self.series[run["series"]].label + (f" ({details})" if details else "")

    def label(self, record: str) -> str:
        """Return the readable name of a record: event, station and direction; its name if the header gives none."""
        return str(self.records.get(record, {}).get("label") or record)

    def named(self, record: str) -> str:
        """Return a record's label, with its name in tables in brackets if that differs."""
        label = self.label(record)
        return label if label == record else f"{label} ({record})"

    def shown(self, record: str) -> Markup:
        """Return a record's label as HTML, with its name in tables in paler words if that differs."""
        label = self.label(record)
        if label == record:
            return join(label)
        return tag("span", label, " ", tag("span", record, class_="muted path"), class_="record")

    def place_of(self, run: "pd.Series[Any] | dict[str, Any]") -> str:
        """Describe a run by its record and case."""
        return f"{self.named(run['record'])}, case {self.case_of(run)}"


def read(directory: Path, responses: Sequence[Response] | None = None, saved: Results | None = None) -> Finished:
    """Return the results in a folder: every run with its pier, its foundation and its ground motion.

    ``responses`` are shown instead of those in ``histories.h5``; ``saved`` are the results if they were read already. Raises
    ``InputError`` if the results are missing, damaged or do not belong together.
    """
    saved = saved or open_results(directory)
    responses = saved.responses if responses is None else responses
    info, varied = saved.info, saved.info["varied"]
    grouped: dict[Key, list[dict[str, Any]]] = {}
    entries: dict[tuple[Key, Key], dict[str, Any]] = {}
    for case in info["cases"]:
        key = foundation(case["case"], case["columns"], varied)
        grouped.setdefault(key, []).append(case)
        entries[key, _pier(case["columns"], varied)] = case
    series = named(grouped, [key for key in varied if _of_foundation(key)], _given(info["study"]["text"]))
    places = {key: place for place, key in enumerate(series)}

    runs = simulated(with_case(saved.peaks)).copy(deep=False)
    kinds = runs.groupby(["case", *varied], sort=False, dropna=False).ngroup() if len(runs) else runs["scale"]
    piers: dict[Key, int] = {}
    facts: dict[int, tuple[int, int, float]] = {}
    cases: dict[tuple[int, int], dict[str, Any]] = {}
    unknown = set()
    for row in as_dicts(runs.assign(kind=kinds).drop_duplicates("kind")):
        pair = foundation(row["case"], row, varied), _pier(row, varied)
        if pair not in entries:
            unknown.add(str(row["case"]))
            continue
        place = places[pair[0]], piers.setdefault(pair[1], len(piers))
        cases[place] = entries[pair]
        facts[row["kind"]] = *place, float(entries[pair]["pier"]["alpha"])
    if unknown:
        raise InputError(
            f"{saved.directory}: peaks.csv has runs of case {', '.join(sorted(unknown))} that run.json does not list; "
            "the two files belong to different runs; start `rockbatch run` again"
        )
    for column, name in enumerate(("series", "pier", "alpha")):
        runs[name] = kinds.map({kind: fact[column] for kind, fact in facts.items()})
    pga = {record["record"]: record["pga_g"] for record in info["records"]}
    runs["pga"] = runs["record"].map(pga).astype("float64") * runs["scale"]
    runs["with_vertical"] = _with_vertical(runs)
    keys = [key for key in varied if key in PIER_KEYS]
    digits = [digits_that_tell(values) for values in zip(*piers, strict=True)]
    words = [", ".join(map(quantity, keys, values, digits)) for values in piers] or [""]
    return Finished(
        saved.directory, info["study"], saved, runs, list(series.values()), words, places, piers, cases,
        responses, read_verdicts(saved.directory),
    )  # fmt: skip


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


def worst_first(runs: "pd.DataFrame", most: int) -> "pd.DataFrame":
    """Return at most ``most`` runs: overturned, ended by flight, then by rotation; failed ones last."""
    place = runs["status"].map({"overturned": 0, "flight": 1, "failed": 3}).fillna(2)
    keys = place.to_frame("place").assign(theta=-runs["theta_max_over_alpha"])
    return runs.loc[keys.sort_values(["place", "theta"], kind="stable").index[:most]]


def foundation(case: str, columns: Mapping[str, Any], varied: Sequence[str]) -> Key:
    """Return the key that identifies a foundation; ``columns`` maps varied keys to values."""
    return (case, *(_plain(columns.get(key)) for key in varied if _of_foundation(key)))


def _of_foundation(key: str) -> bool:
    return key not in PIER_KEYS and key != "vertical"


def _pier(columns: Mapping[str, Any], varied: Sequence[str]) -> Key:
    return tuple(_plain(columns.get(key)) for key in varied if key in PIER_KEYS)


def _plain(value: object) -> object:
    """Return a value as in peaks.csv: ten digits, and "" for a key that run.json omits."""
    if value is None or value != value:
        return ""
    return float(f"{value:.10g}") if isinstance(value, float | int) else value


def _with_vertical(runs: "pd.DataFrame") -> "pd.Series[str] | str":
    """Return words for each run if the study was run with and without the vertical component; else ""."""
    if "vertical" not in runs or runs["vertical"].nunique() < 2:
        return ""
    yes = runs["vertical"].astype(str).str.lower().isin(["true", "1", "1.0", "yes", "with"])
    return yes.map({True: "with vertical", False: "without vertical"})
