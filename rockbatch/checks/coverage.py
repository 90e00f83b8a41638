"""Coverage of the verdicts: every case at every scale with how its runs ended, and the stations of the suite."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.quantities.cases import Case
from rockbatch.quantities.rows import NOT_RUN, rows_of_piers

ENDED = {"overturned": "overturned", "flight": "ended by flight", "failed": "failed", NOT_RUN: NOT_RUN}
"""Words for runs that do not end standing."""

File = Mapping[str, object]
"""Entry of run.json on a file that was not used."""


class CaseRuns(NamedTuple):
    """A case at one scale: its planned runs, and how many of them do not end standing, by the keys of :data:`ENDED`."""

    case: str
    columns: Mapping[str, float | str]
    scale: float
    runs: int
    ended: Mapping[str, int]

    @property
    def none_stands(self) -> bool:
        """Return whether no run ends standing; True also for a case without runs."""
        return sum(self.ended.values()) >= self.runs

    @property
    def in_words(self) -> str:
        """Number of runs that do not end standing, in words: "2 of 10 runs overturned, 1 failed"; empty for 0."""
        of_runs = (f" of {self.runs} runs", *[""] * len(self.ended))
        return ", ".join(
            f"{n}{of} {ENDED[status]}" for (status, n), of in zip(self.ended.items(), of_runs, strict=False)
        )


def joined(cases: Sequence[CaseRuns]) -> CaseRuns:
    """Return one entry for several of the same case, under all bounds of its design: their runs and endings added up."""
    ended = {status: sum(case.ended.get(status, 0) for case in cases) for status in ENDED}
    return cases[0]._replace(
        runs=sum(case.runs for case in cases), ended={status: n for status, n in ended.items() if n}
    )


class Stations(NamedTuple):
    """Stations with a ground motion, by station the files that could not be used and those left out by name, and stations of
    which the study selects no record.
    """

    used: Sequence[str] = ()
    unusable: Mapping[str, Sequence[File]] = {}
    left_out: Mapping[str, Sequence[File]] = {}
    known: bool = True
    """Whether the stations of files that could not be used are known, which an earlier version did not write."""
    not_selected: Sequence[str] = ()

    @property
    def total(self) -> int:
        """Number of stations, those that are left out by name not counted."""
        return len({*self.used, *self.unusable})


ALL_STATIONS = Stations()
"""No station is missing."""


def runs_of_cases(runs: "pd.DataFrame", cases: Sequence[Case], records: int) -> list[CaseRuns]:
    """Return every case at every scale, scales ascending; one of both axes of a pier has the runs of both.

    ``runs`` are simulated rows of peaks.csv, ``cases`` as run.json has them. Runs short of one for each of the ``records``,
    motions that every case should meet, and each polarity are "not run".
    """
    scales, scale_of = np.unique(runs["scale"].to_numpy(np.float64), return_inverse=True)
    statuses = [status for status in ENDED if status != NOT_RUN]
    kind_of = pd.Index(statuses).get_indexer(pd.Index(runs["status"])) + 1  # 0 of those that end standing
    planned = records * runs["polarity"].nunique()
    counted = []
    for axes in rows_of_piers(runs, cases):
        (case, _), rows = axes[0], np.concatenate([rows for _, rows in axes])
        every, width = planned * len(axes), len(statuses) + 1
        kinds = np.bincount(scale_of[rows] * width + kind_of[rows], minlength=len(scales) * width)
        for scale, (stood, *ended) in zip(scales.tolist(), kinds.reshape(-1, width).tolist(), strict=True):
            present = stood + sum(ended)
            ends = zip((*statuses, NOT_RUN), (*ended, max(every - present, 0)), strict=True)
            counts = {status: n for status, n in ends if n}
            counted.append(CaseRuns(str(case["case"]), case["columns"], scale, max(every, present), counts))
    return counted


def is_not_selected(file: File) -> bool:
    """Return whether a file left out is of a station of which the study does not select this record."""
    return bool(file.get("station")) and not (file.get("named") or file.get("of"))


def stations_of(info: Mapping[str, Any]) -> Stations:
    """Return the stations of the suite in run.json (``info``); a record or file without a known station is one by itself.

    A station that is left out by name and has unusable files besides is unusable only.
    """
    used = [str(record.get("station") or record["record"]) for record in info["records"]]

    def station(file: File) -> str:
        return str(file.get("station") or file["name"])

    unusable = grouped(info["unusable"], station)
    named = grouped((file for file in info.get("left_out", ()) if file.get("named")), station)
    left_out = {name: files for name, files in named.items() if name not in unusable}
    not_selected = dict.fromkeys(map(station, filter(is_not_selected, info.get("left_out", ()))))
    missing = tuple(name for name in not_selected if name not in {*used, *unusable, *left_out})
    known = all(file.get("station") for file in info["unusable"])
    return Stations(list(dict.fromkeys(used)), unusable, left_out, known, missing)
