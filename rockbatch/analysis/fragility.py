"""Fragility of a study: the analysis and its tables."""

import os
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

from rockbatch.analysis.folder import Analysis, AnalysisFolder, analysed
from rockbatch.analysis.fragility_curves import Curve, assess, intensities, output
from rockbatch.analysis.fragility_tables import CAPACITIES, POINTS, RUNS, capacities, described, points
from rockbatch.analysis.waves import Waves
from rockbatch.arguments import checked
from rockbatch.batch.compiling import make_ready
from rockbatch.batch.digests import digests
from rockbatch.batch.listening import Progress, count, once
from rockbatch.batch.threads import Engine
from rockbatch.lazy import pd
from rockbatch.results.columns import columns
from rockbatch.study import Motions, Study
from rockbatch.study.fragility import FragilitySpec, read_fragility

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Fragility(Analysis):
    """Fragility of every case for overturning and every limit; see also :class:`rockbatch.analysis.folder.Analysis`.

    Attributes
    ----------
    fragility : DataFrame
        A row for each limit, case and level of the intensity measure: how many records count, exceed the limit, or are
        undecided; P(limit | level) by the curve, and what it lies between.
    fragility_capacities : DataFrame or None
        Of incremental dynamic analysis: a row for each limit, case and record, with the least intensity that exceeds
        the limit, in the unit of the levels and as a scale of the record.
    fragility_runs : DataFrame
        All runs, as rows of peaks.csv.
    curves : tuple of Curve
        Medians, dispersions and their intervals, or why there are none.
    spec : FragilitySpec
        The settings in [fragility] of the study.
    """

    NAME: ClassVar[str] = "fragility"
    TABLES: ClassVar[tuple[str, ...]] = ("fragility", "fragility_capacities", "fragility_runs")

    fragility: "pd.DataFrame"
    fragility_capacities: "pd.DataFrame | None"
    fragility_runs: "pd.DataFrame"
    curves: tuple[Curve, ...]
    spec: FragilitySpec

    def plot(self, width_mm: float = 160.0) -> "Figure":
        """Draw the share of records that exceed each limit, and the fitted curves: a matplotlib Figure of this width."""
        from rockbatch.analysis import plots

        return plots.fragility(self.fragility, self.curves, width_mm)


@checked
def fragility(
    study: str | os.PathLike[str] | Study,
    out: str | os.PathLike[str] | None = None,
    *,
    motions: Motions = None,
    jobs: int | Engine | None = None,
    fresh: bool = False,
    progress: Progress = None,
) -> Fragility:
    """Compute how probable overturning, and every limit of a check, is at a given intensity: [fragility] of a study.

    Every horizontal component is a record here, whatever [suite] says: a probability is that of a motion along the pier. Those
    of one station are not independent, so that the bands are then too narrow.

    Parameters
    ----------
    study, motions, jobs, fresh, progress
        As for :func:`rockbatch.run`; the count starts anew for each wave of runs.
    out : path, optional
        Folder for the files of ``rockbatch fragility``, continued if it was interrupted; without it nothing is kept on disk.

    Returns
    -------
    Fragility
        With the tables ``fragility``, ``fragility_capacities`` and ``fragility_runs``, as their CSV files have them.

    Raises
    ------
    InputError
        With every mistake in the study; for a folder with finished runs of another state of the study.

    Examples
    --------
    >>> result = rb.fragility("pier4.toml")
    >>> result
    <fragility of 'Pier 4'>
      tables  fragility (16 rows), fragility_runs (16 rows)
    >>> [path.name for path in result.save("reports/fragility")]
    ['fragility.csv', 'fragility_runs.csv', 'fragility.json', 'analyses.html']
    """
    return analysed(Fragility, read_fragility, _carry_out, study, out, motions, jobs, fresh, progress)


def _carry_out(results: AnalysisFolder, spec: FragilitySpec) -> dict[str, Any]:
    asked = results.study = replace(results.study, output=output(spec, results.study.output))
    listener, records = results.listener, results.read_motions(asked).motions
    unscaled = intensities(records, spec, asked.cases[0].pier.gravity)
    if asked.motions.scale != (1.0,):
        listener.say("scale of [motions] is not used: the levels of [fragility] take its place")
    digest = digests(
        records,
        cases=asked.cases,
        polarity=asked.motions.simulated,
        numerics=(asked.numerics, asked.output),
        fragility=replace(spec, confidence=0.0),  # which no run depends on
    )
    with results.journal(RUNS, columns(asked), digest) as journal:
        runs = count(len(records) * len(spec.levels) * len(asked.cases), "run")
        levels = f"{count(len(records), 'record')} at {len(spec.levels)} levels of {spec.label}"
        search = (
            f"; then first exceedances are hunted for and bisected to {spec.tolerance:g}"
            if spec.method == "ida"
            else ""
        )
        listener.say(f"{levels}: {runs}{once(asked)} on {results.engine}{search}")
        make_ready(asked, listener)
        waves = Waves(asked, journal, results.engine, listener)
        curves = assess(asked, spec, records, waves)
        results.info |= described(curves, spec, asked, len(records))
        results.info["stations"] = len({motion.of_station for motion in records})
        results.keep_table(POINTS, points(curves, spec, asked.varied))
        if spec.method == "ida":
            names = [motion.name for motion in records]
            results.keep_table(CAPACITIES, capacities(curves, spec, asked.varied, names, unscaled))
        else:
            results.drop(CAPACITIES)
        journal.write_in_order(results.directory / RUNS)
        results.keep(RUNS, digest)
        results.info["runs"] = waves.finished
    return {"curves": tuple(curves), "spec": spec}
