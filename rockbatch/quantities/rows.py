"""Rows of peaks.csv: those of runs, those of each case at one scale, and the record as which each counts."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby, product

import numpy as np
import numpy.typing as npt

from rockbatch.common.lazy import pd
from rockbatch.quantities.arrays import MISSING, Rows, Texts
from rockbatch.quantities.cases import Case, of_pier
from rockbatch.quantities.catalogue import MIRROR_OF

PEAKS = "peaks.csv"
NOT_RUN = "not run"


def with_case(peaks: "pd.DataFrame") -> "pd.DataFrame":
    """Return the rows of runs, without those of unusable files; the same table if there are no unusable files."""
    of_runs = peaks["case"] != ""
    return peaks if of_runs.all() else peaks[of_runs]


def simulated(runs: "pd.DataFrame") -> "pd.DataFrame":
    """Return the rows of peaks.csv without mirror images, so that each run counts once."""
    return runs[runs[MIRROR_OF] == ""] if MIRROR_OF in runs else runs


def as_in_peaks(value: object) -> object:
    """Return a value as peaks.csv has it: a number as a float of ten digits, True as 1.0, "" for None and NaN, text as is."""
    if value is None or value != value:
        return ""
    return float(f"{value:.10g}") if isinstance(value, float | int) else value


def rows_of_cases(runs: "pd.DataFrame", cases: Sequence[Case]) -> Iterator[tuple[Case, npt.NDArray[np.intp]]]:
    """Yield every case with the places of its rows in ``runs``, ascending; an empty array for a case without runs."""
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


def rows_of_piers(runs: "pd.DataFrame", cases: Sequence[Case]) -> Iterator[list[tuple[Case, npt.NDArray[np.intp]]]]:
    """Yield the cases of each pier, along and across its axis or along it alone, with the places of their rows in ``runs``."""
    for _, of_axes in groupby(rows_of_cases(runs, cases), lambda pair: of_pier(pair[0])):
        yield list(of_axes)


def _fits(runs: "pd.DataFrame", columns: Mapping[str, float | str]) -> npt.NDArray[np.bool_]:
    """Return True for each row with these values of the varied keys, shape (n,); numbers may differ by a relative 1e-9."""
    fits = np.ones(len(runs), dtype=bool)
    for name, value in columns.items():
        if isinstance(value, str):
            fits &= (runs[name] == value).to_numpy()
        else:  # ten digits in peaks.csv
            fits &= np.isclose(runs[name].to_numpy(np.float64, na_value=np.nan), value, rtol=1e-9, atol=0.0)
    return fits


def complete(rows: Rows, stations: Mapping[str, str], polarities: Sequence[str]) -> Rows:
    """Return the rows of a case at one scale, sorted by record and polarity, with a failed one for each missing run.

    A row without a status, as an interrupt leaves it, is missing too. ``stations`` has that of every record, "" if unknown.
    """
    names = [*zip(rows.texts("record"), rows.texts("polarity"), strict=True)]
    missing = {*product(stations, polarities)}.difference(names)
    named = sorted([*zip(names, rows.places, strict=True), *((absent, MISSING) for absent in missing)])
    places = np.array([place for _, place in named], dtype=np.intp)
    places = np.where(rows.at(places).texts("status") == "", MISSING, places)
    status = rows.at(places).texts("status")
    return rows.at(
        places,
        record=np.array([record for (record, _), _ in named], dtype=object),
        polarity=np.array([polarity for (_, polarity), _ in named], dtype=object),
        station=np.array([stations.get(record) or "" for (record, _), _ in named], dtype=object),
        status=np.where(status == "", "failed", status),
    )


def counts_as(rows: Rows, count: str) -> tuple[Texts, str]:
    """Return what each run counts as, shape (n,): its record if ``count`` is "component", else its station; and a remark or "".

    If any station is unknown, all runs count as their records, and the remark says so.
    """
    if count == "component":
        return rows.texts("record"), ""
    stations_of_runs = rows.texts("station")
    if (stations_of_runs == "").any():
        return rows.texts("record"), (
            "these results do not say which components are of one station, so that each counts as a record: start "
            "`rockbatch run` again"
        )
    return stations_of_runs, ""
