"""Rows of peaks.csv: those of runs, those of each case at one scale, and the record as which each counts."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from rockbatch.common.lazy import pd
from rockbatch.quantities.cases import Case
from rockbatch.quantities.catalogue import MIRROR_OF

NOT_RUN = "not run"


def with_case(peaks: "pd.DataFrame") -> "pd.DataFrame":
    """Return the rows of runs, without those of files that could not be used; no copy where there are none of these."""
    of_runs = peaks["case"] != ""
    return peaks if of_runs.all() else peaks[of_runs]


def simulated(runs: "pd.DataFrame") -> "pd.DataFrame":
    """Return the rows of peaks.csv without mirror images, which say nothing more: each run counts once."""
    return runs[runs[MIRROR_OF] == ""] if MIRROR_OF in runs else runs


def as_in_peaks(value: object) -> object:
    """Return a value as in peaks.csv: ten digits, and "" for a key that run.json omits."""
    if value is None or value != value:
        return ""
    return float(f"{value:.10g}") if isinstance(value, float | int) else value


def suites(runs: "pd.DataFrame", cases: Iterable[Case]) -> "Iterator[tuple[Case, pd.DataFrame]]":
    """Yield every case with its rows of peaks.csv."""
    return ((case, runs.iloc[rows]) for case, rows in rows_of_cases(runs, list(cases)))


def rows_of_cases(runs: "pd.DataFrame", cases: Sequence[Case]) -> Iterator[tuple[Case, npt.NDArray[np.intp]]]:
    """Yield every case with the places of its rows in ``runs``, in order."""
    keys = list(dict.fromkeys(["case", *(name for case in cases for name in case["columns"])]))
    kinds = runs.groupby(keys, sort=False, dropna=False).ngroup().to_numpy()
    order = np.argsort(kinds, kind="stable")
    ends = np.cumsum(np.bincount(kinds))
    rows = np.split(order, ends[:-1])
    firsts = runs[keys].iloc[[kind[0] for kind in rows if len(kind)]].reset_index(drop=True)
    by_name = dict(iter(firsts.groupby("case", sort=False)))
    for case in cases:
        firsts_of_case = by_name.get(case["case"], firsts[:0])
        of_case = [rows[kind] for kind in firsts_of_case.index[_fits(firsts_of_case, case["columns"])]]
        yield case, np.sort(np.concatenate(of_case)) if of_case else order[:0]


def _fits(runs: "pd.DataFrame", columns: Mapping[str, float | str]) -> npt.NDArray[np.bool_]:
    """Return True for each row with these values of the varied keys, shape (n,)."""
    fits = np.ones(len(runs), dtype=bool)
    for name, value in columns.items():
        if isinstance(value, str):
            fits &= (runs[name] == value).to_numpy()
        else:  # peaks.csv has ten digits of it
            fits &= np.isclose(runs[name].to_numpy(np.float64, na_value=np.nan), value, rtol=1e-9, atol=0.0)
    return fits


def complete(runs: "pd.DataFrame", stations: Mapping[str, str], polarities: Sequence[str]) -> "pd.DataFrame":
    """Return ``runs`` of a case at one scale, and a failed one for each that is missing, as after an interrupt.

    ``stations`` has all records, each with its station, empty if it is not known.
    """
    planned = pd.MultiIndex.from_product([list(stations), polarities], names=["record", "polarity"]).to_frame(
        index=False
    )
    all_of_them = planned.merge(runs, how="outer", on=["record", "polarity"])
    missing = all_of_them["status"].isna()
    all_of_them.loc[missing, ["status", "reason"]] = ["failed", NOT_RUN]
    all_of_them["station"] = all_of_them["record"].map(stations)
    return all_of_them


def counts_as(runs: "pd.DataFrame", count: str) -> "tuple[pd.Series[str], str]":
    """Return the record as which each run counts, by ``count`` of ``COUNTS``; and why that is not its station if it should be."""
    if count == "component":
        return runs["record"], ""
    stations_of_runs = runs["station"].fillna("").astype(str)
    if (stations_of_runs == "").any():
        return runs["record"], (
            "these results do not say which components are of one station, so that each counts as a record; start "
            "`rockbatch run` again"
        )
    return stations_of_runs, ""
