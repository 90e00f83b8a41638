"""Fragility of a study: the analysis and its tables."""

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, ClassVar

from rockbatch.analyses.fragility.cloud_tables import CLOUD, cloud_table
from rockbatch.analyses.fragility.clusters import clusters
from rockbatch.analyses.fragility.curves import Curve, assess
from rockbatch.analyses.fragility.hazard import YEARS, Dispersion, Hazard
from rockbatch.analyses.fragility.risk import (
    DEAGGREGATION,
    RISK,
    Risk,
    RiskBound,
    deaggregation_table,
    risk_table,
    risks,
)
from rockbatch.analyses.fragility.runs import first_intensities, level_plans, output
from rockbatch.analyses.fragility.scale_factors import SCALES, described_scales, scales
from rockbatch.analyses.fragility.study import FragilitySpec, read_fragility
from rockbatch.analyses.fragility.tables import CAPACITIES, POINTS, RUNS, capacities, described, points
from rockbatch.batch.compiling import make_ready
from rockbatch.batch.digests import digests
from rockbatch.batch.listening import Progress, count, once
from rockbatch.batch.threads import Engine
from rockbatch.batch.waves import Waves
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.motions.suites.hazard import HazardCurve
from rockbatch.results.columns import columns
from rockbatch.study import Motions, Study
from rockbatch.workflow.analysis import Analysis, AnalysisFolder, run_analysis

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Fragility(Analysis):
    """Fragility of every case for overturning and every limit; see also :class:`rockbatch.workflow.analysis.Analysis`.

    Attributes
    ----------
    fragility : DataFrame
        A row for each limit, case and level of the intensity measure: how many records count, exceed the limit, or are
        undecided; P(limit | level) by the curve, and what it lies between; of incremental dynamic analysis also the share of
        the scales about the level that exceed the limit, and P by these shares.
    fragility_capacities : DataFrame or None
        Of incremental dynamic analysis: a row for each limit, case and record, with the least intensity that exceeds
        the limit, in the unit of the levels and as a scale of the record, and the relative width below which nothing was
        looked at.
    fragility_runs : DataFrame
        All runs, as rows of peaks.csv.
    fragility_scales : DataFrame
        A row for each record and level, with the factor on the record, and whether it is within the limits of the study.
    fragility_cloud : DataFrame or None
        Of cloud analysis: a row for each limit, case and run, with its demand, and how it counts.
    fragility_risk : DataFrame or None
        Of a study with [fragility.hazard]: a row for each curve, with the mean annual rate of exceedance, its interval, and the
        probability in the years asked about.
    fragility_deaggregation : DataFrame or None
        Likewise: which intensities these rates come from.
    curves : tuple of Curve
        Medians, dispersions and their intervals, or why there are none.
    spec : FragilitySpec
        The settings in [fragility] of the study.
    """

    NAME: ClassVar[str] = "fragility"
    TABLES: ClassVar[tuple[str, ...]] = (
        "fragility_scales",
        "fragility",
        "fragility_cloud",
        "fragility_capacities",
        "fragility_risk",
        "fragility_deaggregation",
        "fragility_runs",
    )
    RUNS: ClassVar[tuple[str, ...]] = ("fragility_runs",)

    fragility: "pd.DataFrame"
    fragility_capacities: "pd.DataFrame | None"
    fragility_runs: "pd.DataFrame"
    fragility_scales: "pd.DataFrame"
    fragility_cloud: "pd.DataFrame | None" = None
    fragility_risk: "pd.DataFrame | None" = None
    fragility_deaggregation: "pd.DataFrame | None" = None
    curves: tuple[Curve, ...]
    spec: FragilitySpec

    def plot(self, width_mm: float = 160.0, ax: "Axes | None" = None) -> "Figure":
        """Draw the share of records that exceed each limit, and the fitted curves: a matplotlib Figure, ``width_mm`` wide
        or in the place of ``ax``."""
        from rockbatch.analyses.fragility.figures import curves
        from rockbatch.common.figures.paper import drawn

        return drawn(curves(self.info), width_mm, ax)

    @checked
    def plot_fragility(self, ax: "Axes | None" = None, limit: str = "") -> "Axes":
        """Draw the curves of one limit into ``ax``, by default in a figure of one column of a paper, 88 mm; return the axes.

        ``limit`` is the name of the limit, by default the first; raises ``InputError`` for an unknown one.
        """
        from rockbatch.analyses.fragility.figures import curves
        from rockbatch.common.figures.paper import panel_in

        return panel_in(curves(self.info), ax, limit)

    @checked
    def risk(
        self, hazard: HazardCurve | None = None, *, years: Sequence[float] | None = None, added: float | None = None
    ) -> "pd.DataFrame":
        """Return annual rates and probabilities as ``fragility_risk`` has them, under another hazard; nothing is run.

        Parameters
        ----------
        hazard : HazardCurve, optional
            In the unit of the levels; that of the study if it is not given.
        years : list of float, optional
            Periods for the probabilities; those of the study, or 50.
        added : float, optional
            Dispersion added to that of the records; what the study adds if it is not given.

        Raises ``InputError`` without any hazard, for periods that are not above 0, for a negative dispersion, and for either if
        it is not finite.
        """
        of_study = self.spec.hazard
        if hazard is None and of_study is None:
            raise InputError("hazard: the study has no hazard; give a HazardCurve, or write [fragility.hazard]")
        wrong = [f"years = {t:g}: must be above 0" for t in years or () if not 0 < t < math.inf]
        if added is not None and not 0 <= added < math.inf:
            wrong.append(f"added = {added:g}: must be 0 or above")
        if wrong:
            raise InputError(*wrong)
        periods = tuple(years) if years else of_study.years if of_study else YEARS
        curve = hazard or (of_study.curve if of_study else None)
        spec = replace(self.spec, hazard=Hazard(curve, periods)) if curve else self.spec
        if added is not None:
            spec = replace(spec, dispersions=(Dispersion("added", added),) if added else ())
        return risk_table(self.curves, *risks(self.curves, spec), spec, self.study.varied)


@checked
def fragility(
    study: str | os.PathLike[str] | Study,
    out: str | os.PathLike[str] | None = None,
    *,
    motions: Motions = None,
    jobs: int | Engine | None = None,
    fresh: bool = False,
    progress: Progress = None,
    im: "Mapping[str, float] | pd.Series | str | os.PathLike[str] | None" = None,
) -> Fragility:
    """Compute the probability of overturning, and of exceeding the limit of a check, by intensity: [fragility] of a study.

    The limits are those of all checks of single records, or of the ``checks`` that [fragility] names. Every horizontal component
    is a record here, even if [suite] keeps one of a station: a probability is that of a motion along the pier. Components of
    one station are not independent: intervals count stations, or earthquakes if those of all records are known, and they are
    five or more and fewer than the stations.

    Parameters
    ----------
    study, motions, jobs, fresh, progress
        As for :func:`rockbatch.run`; the count starts anew for each wave of runs.
    im : mapping of str to float, Series or path, optional
        Intensity measure of your own, in place of that of the study: a value of each record as it was recorded, by its name; a
        Series has the name and unit of the measure as its name, "AvgSa [g]". Or a CSV file, as ``measure_file``.
    out : path, optional
        Folder for the files of ``rockbatch fragility``, continued if it was interrupted; without it nothing is kept on disk.

    Returns
    -------
    Fragility
        With the tables ``fragility``, ``fragility_capacities``, ``fragility_cloud``, ``fragility_runs``, ``fragility_scales``,
        ``fragility_risk`` and ``fragility_deaggregation``, as their CSV files have them; None if the method has none.

    Raises
    ------
    InputError
        With every mistake in the study; for a folder with finished runs of another state of the study.

    Examples
    --------
    >>> result = rb.fragility("pier4.toml")
    >>> result
    <fragility of 'Pier 4'>
      tables  fragility_scales (8 rows), fragility (16 rows), fragility_runs (16 rows)
    >>> [path.name for path in result.save("reports/fragility")]
    ['fragility_scales.csv', 'fragility.csv', 'fragility_runs.csv', 'fragility.json', 'analyses.html']
    """
    return run_analysis(
        Fragility,
        partial(read_fragility, im=im),
        _write_tables,
        study,
        out,
        motions,
        jobs,
        fresh,
        progress,
        lambda spec: spec.per_pier is not None,  # axes of a pier then share a curve, so that both are taken
    )


def _write_tables(results: AnalysisFolder, spec: FragilitySpec) -> dict[str, object]:
    study = results.study = replace(results.study, output=output(spec, results.study.output))
    listener, records = results.listener, results.read_motions(study).motions
    plans = level_plans(study, spec, records)
    if spec.method == "cloud":
        spec = replace(
            spec, levels=tuple(sorted({x for plan in plans for intensities in plan.used for x in intensities}))
        )
    elif study.motions.scale != (1.0,):
        listener.say("scale of [motions] is not used: the levels of [fragility] take its place")
    digest = digests(
        records,
        cases=study.cases,
        polarity=study.motions.simulated,
        numerics=(study.numerics, study.output),
        fragility=spec.of_runs,
    )
    of_runs = replace(study, varied=(*study.varied, *spec.uncertain.columns))
    with results.journal(RUNS, columns(of_runs), digest) as journal:
        of_cases = [*zip(study.cases, plans, strict=True)]
        first = (len(first_intensities(spec, plan, m, case)) for m in range(len(records)) for case, plan in of_cases)
        runs = count(sum(first), "run")
        windowed = any(spec.window_on(case.base) is not None for case in study.cases)
        scaling = f"at {len(spec.levels)} levels of {spec.label}{' and in windows about them' if windowed else ''}"
        scaling = "as they are" if spec.method == "cloud" else scaling
        levels = f"{count(len(records), 'record')} {scaling}"
        search = (
            f"; then first exceedances are hunted for and bisected to {spec.tolerance:g}"
            if spec.method == "ida"
            else ""
        )
        listener.say(f"{levels}: {runs}{once(study)} on {results.engine}{search}")
        make_ready(study, listener)
        waves = Waves(of_runs, journal, results.engine, listener)
        curves = assess(study, spec, records, waves, plans)
        known, bounds = risks(curves, spec)
        results.info |= described(curves, spec, study, len(records), known, bounds)
        shared = clusters(records)
        results.info |= {"stations": shared.stations, "events": shared.events, "by": shared.kind}
        names = [motion.name for motion in records]
        results.keep_table(SCALES, scales(plans, spec, names, study.cases, study.varied))
        results.info["scales"] = described_scales(plans, spec, names)
        results.keep_table(POINTS, points(curves, spec, study.varied))
        if spec.method == "cloud":
            results.keep_table(CLOUD, cloud_table(curves, spec, study.varied, names))
        else:
            results.drop(CLOUD)
        if spec.method == "ida":
            results.keep_table(CAPACITIES, capacities(curves, spec, study.varied, names, plans, study.cases))
        else:
            results.drop(CAPACITIES)
        _keep_risk(results, spec, curves, known, bounds)
        journal.write_in_order(results.directory / RUNS)
        results.keep(RUNS, digest)
        results.info["runs"] = waves.finished
    return {"curves": tuple(curves), "spec": spec}


def _keep_risk(
    results: AnalysisFolder, spec: FragilitySpec, curves: list[Curve], known: list[Risk], bounds: list[RiskBound]
) -> None:
    """Write the tables of annual rates, and remove those of earlier results; without a hazard there are none."""
    for file in (RISK, DEAGGREGATION):
        results.drop(file)
    if spec.hazard is not None:
        results.keep_table(RISK, risk_table(curves, known, bounds, spec, results.study.varied))
    if known:
        results.keep_table(DEAGGREGATION, deaggregation_table(known, spec, results.study.varied))
