"""Rocking spectra: θ_max/α over the size of the pier, for given slendernesses, on every base of a study.

The peak rotation of a rocking block under a given motion is a function of α and p alone, as that of an oscillator is
one of damping and period (Makris & Konstantinidis 2003, Earthq. Eng. Struct. Dyn. 32, 265–289). On springs it is one of
their parameters too, which stay as the study has them.
"""

import math
from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import Any

from rockbatch.batch.plan import Plan, PlannedRun
from rockbatch.lazy import pd
from rockbatch.motions import MotionSet
from rockbatch.results.columns import row
from rockbatch.results.suite_statistics import suite
from rockbatch.simulation.outcome import Outcome
from rockbatch.study import Study
from rockbatch.study.spectrum import SpectrumSpec

FILE = "spectrum.csv"
SUITE = "spectrum_suite.csv"
GROUP = ("case", "scale")
"""Columns, beside the varied ones, that identify a point of a spectrum."""

SIZE = ("p", "two_pi_over_p_s", "size_m")
RESULTS = (
    "record",
    "polarity",
    "status",
    "theta_max_over_alpha",
    "theta_max_error",
    "t_max_s",
    "impacts",
    "flight_s",
    "substeps",
    "reason",
)


def plan(study: Study, spectrum: SpectrumSpec, motions: MotionSet) -> Plan:
    """Return the runs of a spectrum: those of the study that are simulated, on the piers of the spectrum."""
    once = replace(study.motions, polarity=(study.motions.simulated,))
    return Plan(replace(study, cases=spectrum.cases, motions=once), motions)


def columns(spectrum: SpectrumSpec) -> list[str]:
    """Return the columns of spectrum.csv: the point of the spectrum, and the results of one motion there."""
    return [*dict.fromkeys((*GROUP, *spectrum.varied, *SIZE, *RESULTS))]


def row_of(run: PlannedRun, outcome: Outcome) -> dict[str, Any]:
    """Return the row of spectrum.csv of a run that is finished."""
    pier = run.case.pier
    size = {"p": pier.p, "two_pi_over_p_s": 2 * math.pi / pier.p, "size_m": pier.size}
    return size | row(run.ran(outcome))


def of_suite(table: "pd.DataFrame", varied: tuple[str, ...]) -> "pd.DataFrame":
    """Return the statistics of the suite at every point of the spectrum.

    Parameters
    ----------
    table : DataFrame
        The rows of spectrum.csv.
    varied : tuple of str
        As in :class:`SpectrumSpec`.

    Returns
    -------
    DataFrame
        A row for each case, scale and pier: 16, 50 and 84 % quantiles of θ_max/α over the motions
        (``p16``, ``median``, ``p84``), and the greatest (``largest``). A run that overturned, or was ended by flight,
        counts as infinite; a failed one is unknown and only counted.
    """
    keys = [*GROUP, *varied]
    rows: list[Mapping[str, Any]] = []
    for names, runs in table.groupby(keys, sort=False, dropna=False):
        statistics = asdict(suite(runs["theta_max_over_alpha"].to_numpy(float), runs["status"].tolist()))
        statistics["p16"], statistics["p84"] = statistics.pop("low"), statistics.pop("high")
        size = {name: runs[name].iloc[0] for name in SIZE}
        rows.append(dict(zip(keys, names, strict=True)) | size | statistics)
    wanted = ("count", "p16", "median", "p84", "largest", "overturned", "flight", "failed")
    return pd.DataFrame(rows, columns=[*dict.fromkeys((*keys, *SIZE, *wanted))])
