"""Finished results as the report reads them: every run with its pier, its foundation and its ground motion."""

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.checks import Verdict, read_verdicts
from rockbatch.checks.coverage import CaseRuns, runs_of_cases
from rockbatch.checks.responses import Worst, worst_of_cases
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.outcome.response import Response
from rockbatch.quantities.arrays import Rows
from rockbatch.quantities.rows import NOT_RUN, counts_as, simulated
from rockbatch.reporting.finished_analysis import Contents
from rockbatch.reporting.labels import counted
from rockbatch.reporting.markup import Markup, join, number, tag
from rockbatch.results.labelled import Labelled, by_pga, foundation, groups_of, labelled, pier_of
from rockbatch.results.opened import Results, open_results
from rockbatch.results.reading import Saved

if TYPE_CHECKING:
    from pandas.core.groupby import DataFrameGroupBy


@dataclass(frozen=True, eq=False)
class Finished(Contents, Labelled):
    """Contents of a folder of results, with its labelled runs.

    Attributes
    ----------
    saved : Saved
        Contents of ``peaks.csv`` and ``run.json``.
    responses : sequence of Response
        Runs whose histories are shown.
    verdicts : sequence of Verdict
        Results of ``rockbatch check``.
    """

    saved: Saved
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
        return "component" if counts_as(Rows(self.runs), count)[1] else count

    @cached_property
    def worst(self) -> list[Worst]:
        """Return the worst responses of every case."""
        return worst_of_cases(self.runs, [self.cases[places] for places in sorted(self.cases)])

    @cached_property
    def worst_at_scales(self) -> list[Worst]:
        """Return the worst responses of every case at each scale."""
        return worst_of_cases(self.runs, [self.cases[places] for places in sorted(self.cases)], at_each_scale=True)

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
            return self.places[foundation(case, columns, varied)], self.pier_places[pier_of(columns, varied)]
        except KeyError:
            raise InputError(
                f"{self.saved.directory}: there is a history of case {case} that peaks.csv or run.json does not list; the "
                "files belong to different runs; start `rockbatch run` again"
            ) from None

    def by_pga(self, names: Sequence[str]) -> list[str]:
        """Return ``names`` of records in order of peak ground acceleration, the weakest first."""
        return by_pga(names, self.info)

    @cached_property
    def grouped(self) -> "DataFrameGroupBy":
        """Return the runs grouped by scale, pier and vertical component."""
        return self.runs.groupby(["scale", "pier", "with_vertical"])

    def groups(self) -> "Iterator[tuple[str, pd.DataFrame]]":
        """Return each group of runs, with the words that identify it."""
        return groups_of(self.runs, self.piers)

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
        """Return a record's label as HTML, with its name in tables as a note if that differs."""
        label = self.label(record)
        return join(label) if label == record else tag("span", label, title=record)

    def place_of(self, run: "pd.Series[Any] | dict[str, Any]") -> str:
        """Describe a run by its record and case."""
        return f"{self.named(run['record'])}, case {self.case_of(run)}"


def read(directory: Path, responses: Sequence[Response] | None = None, saved: Results | None = None) -> Finished:
    """Return the results in a folder: every run with its pier, its foundation and its ground motion.

    ``responses`` are shown instead of those in ``histories.h5``; ``saved`` are the results if they were read already. Raises
    ``InputError`` if the results are missing, damaged or do not belong together.
    """
    saved = saved or open_results(directory)
    return Finished(
        **vars(labelled(saved.peaks, saved.info, saved.directory)), directory=saved.directory, study=saved.info["study"],
        saved=saved, responses=saved.responses if responses is None else responses, verdicts=read_verdicts(saved.directory),
    )  # fmt: skip


def worst_first(runs: "pd.DataFrame", most: int) -> "pd.DataFrame":
    """Return at most ``most`` runs: overturned, ended by flight, failed, then by rotation."""
    place = runs["status"].map({"overturned": 0, "flight": 1, "failed": 2}).fillna(3)
    keys = place.to_frame("place").assign(theta=-runs["theta_max_over_alpha"])
    return runs.loc[keys.sort_values(["place", "theta"], kind="stable").index[:most]]
