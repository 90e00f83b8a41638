"""Finished results as the report uses them: every run with its pier, foundation and ground motion."""

import math
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rockbatch.checks import Verdict, read_verdicts
from rockbatch.checks.coverage import CaseRuns, runs_of_cases
from rockbatch.checks.responses import Worst, worst_of_cases
from rockbatch.common.errors import InputError
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.outcome.response import Response
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.cases import Case
from rockbatch.quantities.demands import OF_SECTIONS, SECTIONS
from rockbatch.quantities.labels import record_labels
from rockbatch.quantities.rows import NOT_RUN, counts_as, simulated
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.results.labelled import Labelled, Row, by_pga, foundation_key, groups_of, labelled, pier_key
from rockbatch.results.opened import Results, open_results
from rockbatch.results.reading import Saved
from rockbatch.results.sections import read_forces

if TYPE_CHECKING:
    from pandas.core.groupby import DataFrameGroupBy


@dataclass(frozen=True, eq=False)
class Finished(Contents, Labelled):
    """A folder of results: its contents and its labelled runs."""

    saved: Saved  # contents of ``peaks.csv`` and ``run.json``
    responses: Sequence[Response] = ()  # runs whose histories are shown
    verdicts: Sequence[Verdict] = ()  # results of ``rockbatch check``; empty if they are ``outdated``
    outdated: bool = False  # whether checks.csv has verdicts on another peaks.csv than is there now

    @property
    def info(self) -> Row:
        """Return the contents of ``run.json``."""
        return self.saved.info

    @cached_property
    def records(self) -> dict[str, Row]:
        """Return the ground motions' entries in ``run.json``, by record name."""
        return {record["record"]: record for record in self.info["records"]}

    @cached_property
    def pier_as_given(self) -> Row:
        """Return the [pier] table of the study file; empty if the text cannot be parsed."""
        pier = self._as_given.get("pier", {})
        return pier if isinstance(pier, dict) else {}

    @property
    def cases_as_given(self) -> list[Row]:
        """Return each [[case]] table of the study file; [] if the text cannot be parsed."""
        cases = self._as_given.get("case", [])
        return [case for case in cases if isinstance(case, dict)] if isinstance(cases, list) else []

    @cached_property
    def _as_given(self) -> dict[str, Any]:
        """Return the study file; empty if the text cannot be parsed."""
        try:
            return tomllib.loads(self.info["study"]["text"])
        except tomllib.TOMLDecodeError:
            return {}

    @cached_property
    def count(self) -> str:
        """Return the unit of counting, "station" or "component"; "component" as well if stations are unknown."""
        count = str(self.info.get("count", "station"))
        return "component" if counts_as(Rows(self.runs), count)[1] else count

    @cached_property
    def worst(self) -> list[Worst]:
        """Return the worst responses of each case over all scales."""
        return worst_of_cases(self.runs, [self.cases[places] for places in sorted(self.cases)])

    @cached_property
    def worst_at_scales(self) -> list[Worst]:
        """Return the worst responses of each case at each scale."""
        return worst_of_cases(self.runs, [self.cases[places] for places in sorted(self.cases)], at_each_scale=True)

    @cached_property
    def suites(self) -> list[CaseRuns]:
        """Return each case at each scale with its number of planned runs, and of those that do not end standing."""
        return runs_of_cases(self.runs, self.info["cases"], len(self.info["records"]))

    @cached_property
    def sections(self) -> "pd.DataFrame":
        """Return the rows of sections.csv; empty if the study asks for none."""
        path = self.directory / SECTIONS
        return read_forces(path, self.info["varied"], OF_SECTIONS) if path.exists() else pd.DataFrame()

    def section_heights(self, case: Case) -> tuple[float, ...]:
        """Return the heights [m] of a case's sections, of sections.csv and of its checks, ascending."""
        name, rows = case["case"], self.sections
        heights = self._checked_heights.get(name, frozenset())
        if len(rows):
            own = {"case": name} | case["columns"]
            alike = [rows[key] == value for key, value in own.items() if key in rows]
            heights |= set(rows.loc[np.logical_and.reduce(alike), "height_m"])
        return tuple(sorted(heights))

    @cached_property
    def _checked_heights(self) -> dict[str, frozenset[float]]:
        """Return the heights [m] that the checks of each case name."""
        with_height = (verdict for verdict in self.verdicts if not math.isnan(verdict.at_m))
        of_cases = grouped(with_height, attrgetter("case"))
        return {case: frozenset(verdict.at_m for verdict in verdicts) for case, verdicts in of_cases.items()}

    @cached_property
    def not_run(self) -> int:
        """Return the number of planned runs without a row in peaks.csv."""
        return sum(suite.ended.get(NOT_RUN, 0) for suite in self.suites)

    def of_all(self, runs: int, words: str) -> str:
        """Return "10 runs" if ``runs`` is the number planned, else "8 of 10 runs that WORDS"."""
        planned = len(self.runs) + self.not_run
        return counted(runs, "run") if runs == planned else f"{runs:,} of {counted(planned, 'run')} that {words}"

    @cached_property
    def both_directions(self) -> bool:
        """Return whether both polarities were run."""
        return bool(self.runs["polarity"].nunique() > 1)

    @cached_property
    def mirrored(self) -> bool:
        """Return whether peaks.csv has mirror images besides simulated runs."""
        return len(simulated(self.saved.peaks)) < len(self.saved.peaks)

    def place(self, case: str, columns: Mapping[str, object]) -> tuple[int, int]:
        """Return the indices into ``series`` and ``piers`` of a case; ``columns`` holds its varied values.

        Raises ``InputError`` for a case that has no run in peaks.csv.
        """
        varied = self.info["varied"]
        try:
            return self.places[foundation_key(case, columns, varied)], self.pier_places[pier_key(columns, varied)]
        except KeyError:
            raise InputError(
                f"{self.saved.directory}: there is a history of case {case} that peaks.csv or run.json does not list; the "
                "files belong to different runs; start `rockbatch run` again"
            ) from None

    def by_pga(self, names: Sequence[str]) -> list[str]:
        """Sort the record ``names`` by peak ground acceleration, weakest first."""
        return by_pga(names, self.info)

    @cached_property
    def grouped(self) -> "DataFrameGroupBy":
        """Return the runs grouped by scale, pier and vertical component."""
        return self.runs.groupby(["scale", "pier", "with_vertical"])

    def groups(self) -> "Iterator[tuple[str, pd.DataFrame]]":
        """Yield the runs of each scale, pier and vertical component, after a description such as "p = 1.2 rad/s"."""
        return groups_of(self.runs, self.piers)

    @cached_property
    def _labels(self) -> dict[str, str]:
        return record_labels(self.info)

    def label(self, record: str) -> str:
        """Return a record's event, station and direction, "Kobe, Takatori, 0°"; its name in tables if its header gives none."""
        return self._labels.get(record, record)

    def named(self, record: str) -> str:
        """Return a record's label, and its name in tables if different: "Kobe, Takatori, 0° (TAK000)"."""
        label = self.label(record)
        return label if label == record else f"{label} ({record})"

    def shown(self, record: str) -> Markup:
        """Return a record's label as HTML, with its name in tables as a tooltip if different."""
        label = self.label(record)
        return join(label) if label == record else tag("span", label, title=record)

    def place_of(self, run: "pd.Series | Row") -> str:
        """Describe a run: "Kobe, Takatori, 0° (TAK000), case pads"."""
        return f"{self.named(run['record'])}, case {self.case_of(run)}"


def read(directory: Path, responses: Sequence[Response] | None = None, saved: Results | None = None) -> Finished:
    """Read the results of a folder and label each run with its pier, foundation and ground motion.

    ``responses`` replace those in ``histories.h5``; pass ``saved`` if the results were read already. Raises
    ``InputError`` if the results are missing, damaged or do not belong together.
    """
    saved = saved or open_results(directory)
    verdicts = read_verdicts(saved.directory)
    return Finished(
        **vars(labelled(saved.peaks, saved.info, saved.directory)),
        directory=saved.directory,
        study=saved.info["study"],
        saved=saved,
        responses=saved.responses if responses is None else responses,
        verdicts=verdicts or (),
        outdated=verdicts is None,
    )


def worst_first(runs: "pd.DataFrame", most: int) -> "pd.DataFrame":
    """Return the worst ``most`` runs: overturned first, then ended by flight, failed, then by decreasing rotation."""
    rank = runs["status"].map({"overturned": 0, "flight": 1, "failed": 2}).fillna(3)
    keys = rank.to_frame("rank").assign(theta=-runs["theta_max_over_alpha"])
    return runs.loc[keys.sort_values(["rank", "theta"], kind="stable").index[:most]]
