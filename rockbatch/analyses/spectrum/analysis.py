"""Rocking spectra and overturning maps of a study: the analysis and its tables."""

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

from rockbatch.analyses.spectrum import overturning_map, rocking_spectrum
from rockbatch.analyses.spectrum.study import AXES, SELF_SIMILAR, MapSpec, SpectrumSpec, read_spectrum
from rockbatch.batch.compiling import make_ready
from rockbatch.batch.digests import digests
from rockbatch.batch.listening import Progress, count, once
from rockbatch.batch.threads import Engine
from rockbatch.batch.waves import Waves
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.files import is_plain, read_table
from rockbatch.common.grouping import joined
from rockbatch.common.lazy import pd
from rockbatch.results.columns import columns
from rockbatch.study import Motions, Output, Study
from rockbatch.workflow.analysis import Analysis, AnalysisFolder, run_analysis

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Spectrum(Analysis):
    """Rocking spectra and overturning maps; see also :class:`rockbatch.workflow.analysis.Analysis`.

    Attributes
    ----------
    spectrum : DataFrame or None
        A row for each motion, slenderness, size and base: θ_max/α and how the run ended.
    spectrum_suite : DataFrame or None
        A row for each slenderness, size and base: 16, 50 and 84 % quantiles of θ_max/α over the motions, infinite where
        the pier overturns. In a self-similar spectrum the size and the scale are the record's own, and a row has their ends.
    overturning_map : DataFrame or None
        A row for each region of amplitudes a_p/(g tan α) with one outcome, at each frequency ω_p/p of each map.
    overturning_runs : DataFrame or None
        The runs of the maps, as rows of peaks.csv.
    spectra, maps : SpectrumSpec or None, tuple of MapSpec
        The settings in [spectrum] of the study.
    """

    NAME: ClassVar[str] = "spectrum"
    TABLES: ClassVar[tuple[str, ...]] = ("spectrum", "spectrum_suite", "overturning_map", "overturning_runs")
    RUNS: ClassVar[tuple[str, ...]] = ("spectrum", "overturning_runs")

    spectrum: "pd.DataFrame | None"
    spectrum_suite: "pd.DataFrame | None"
    overturning_map: "pd.DataFrame | None"
    overturning_runs: "pd.DataFrame | None"
    spectra: SpectrumSpec | None
    maps: tuple[MapSpec, ...]

    @checked
    def plot(self, width_mm: float = 160.0, axis: str | None = None, ax: "Axes | None" = None) -> "Figure":
        """Draw the spectrum of each case, with its median over the records, and the maps: a matplotlib Figure,
        ``width_mm`` wide or in the place of ``ax``.

        ``axis`` is "two_pi_over_p_s", which it is unless given, "p" or "size_m"; a self-similar spectrum has "omega_g_over_p"
        alone, over which all its slendernesses share a panel. Raises ``InputError`` for another.
        """
        from rockbatch.analyses.spectrum.figures import maps, spectra
        from rockbatch.common.figures.description import Figure as Description
        from rockbatch.common.figures.paper import drawn

        self_similar = self.spectra is not None and self.spectra.axis == SELF_SIMILAR
        axes = (SELF_SIMILAR,) if self_similar else tuple(name for name in AXES if name != SELF_SIMILAR)
        if axis is not None and axis not in axes:
            remedy = f"; for {SELF_SIMILAR} write it as the range in [spectrum]" if axis == SELF_SIMILAR else ""
            raise InputError(f'axis = "{axis}": must be {" or ".join(axes)} in this spectrum{remedy}')
        of_suite, of_maps = self.spectrum_suite, self.overturning_map
        figures = [] if of_suite is None else [spectra(of_suite, self.spectrum, self.info, axis or axes[0])]
        figures += [] if of_maps is None else [maps(of_maps, self.info)]
        return drawn(Description([panel for figure in figures for panel in figure.panels], ""), width_mm, ax)


@checked
def spectrum(
    study: str | os.PathLike[str] | Study,
    out: str | os.PathLike[str] | None = None,
    *,
    motions: Motions = None,
    jobs: int | Engine | None = None,
    fresh: bool = False,
    progress: Progress = None,
) -> Spectrum:
    """Compute rocking spectra over the size of the pier, and maps of the pulses that overturn it: [spectrum] of a study.

    Parameters
    ----------
    study, motions, jobs, fresh, progress
        As for :func:`rockbatch.run`; the count starts anew for each wave of runs.
    out : path, optional
        Folder for the files of ``rockbatch spectrum``, continued if it was interrupted; without it nothing is kept on disk.

    Returns
    -------
    Spectrum
        With the tables ``spectrum`` and ``spectrum_suite``, ``overturning_map`` and ``overturning_runs``, as their CSV files
        have them; None if the study has no spectra, or no maps.

    Raises
    ------
    InputError
        With every mistake in the study; for a folder with finished runs of another state of the study.

    Examples
    --------
    >>> result = rb.spectrum("pier4.toml")
    >>> result
    <spectrum of 'Pier 4'>
      tables  spectrum (12 rows), spectrum_suite (6 rows)
    >>> result.spectrum_suite[["case", "two_pi_over_p_s", "overturned"]].head(3)
        case  two_pi_over_p_s  overturned
    0  rigid              3.0           2
    1   pads              3.0           2
    2  rigid              5.5           0
    """
    return run_analysis(Spectrum, read_spectrum, _write_tables, study, out, motions, jobs, fresh, progress)


def _write_tables(results: AnalysisFolder, spec: tuple[SpectrumSpec | None, tuple[MapSpec, ...]]) -> dict[str, object]:
    spectra, maps = spec
    if spectra is not None:
        _write_spectra(results, spectra)
    if maps:
        _write_maps(results, maps)
    results.info["engine"] = str(results.engine)
    return {"spectra": spectra, "maps": maps}


def _write_spectra(results: AnalysisFolder, spectra: SpectrumSpec) -> None:
    """Write the rocking spectra, unless they exist already, and the statistics of the suite."""
    study, file, motions = results.study, rocking_spectrum.FILE, results.read_motions(results.study)
    runs = rocking_spectrum.plan(study, spectra, motions)
    digest = digests(
        motions.motions,
        cases=spectra.cases,
        scales=(study.motions.polarity, study.motions.scale, *spectra.intensities),
        numerics=study.numerics,
    )
    many = f"{count(len(motions.motions), 'motion')}, {count(len(runs), 'run')}{once(study)}"
    results.listener.say(f"spectra: {many} on {results.engine}")
    results.info |= {"axis": spectra.axis, "varied": list(spectra.varied), "motions": len(motions.motions)}
    results.execute_runs(file, rocking_spectrum.columns(spectra), digest, runs, spectra.cases, rocking_spectrum.row_of)
    names = [motion.name for motion in motions.motions]
    stations = dict(zip(names, joined([motion.stations for motion in motions.motions]), strict=True))
    suite = rocking_spectrum.of_suite(read_table(results.directory / file), spectra.varied, stations)
    results.keep_table(rocking_spectrum.SUITE, suite)


def _write_maps(results: AnalysisFolder, maps: Sequence[MapSpec]) -> None:
    """Write the overturning maps, unless they exist already."""
    study, listener = replace(results.study, output=Output()), results.listener
    file, of_runs = overturning_map.FILE, overturning_map.RUNS
    results.info["varied_map"] = list(study.varied)
    fields = ("name", "shape", "tolerance", "width")
    results.info["maps"] = [{name: getattr(spec, name) for name in fields} for spec in maps]
    digest = digests([], maps=maps, cases=study.cases, numerics=study.numerics)
    if results.has(of_runs, digest) and is_plain(results.directory / file):
        results.keep(file)
        results.keep(of_runs, digest)
        return
    rows: list[Any] = []
    make_ready(study, listener)
    with results.journal(of_runs, columns(study), digest) as journal:
        waves = Waves(study, journal, results.engine, listener)
        for spec in maps:
            computed, finished = overturning_map.Maps(spec, study.cases), waves.finished
            grid = f"{spec.frequencies} frequencies × {spec.amplitudes} amplitudes"
            grid += f" × {count(len(study.cases), 'case')}" if len(study.cases) > 1 else ""
            listener.say(f"map {spec.name}: {grid} on {results.engine}; refined where the outcome changes")
            by_case = computed.find(waves)
            rows += computed.rows(by_case)
            listener.say(f"map {spec.name}: {sum(map(len, by_case))} frequencies, {waves.finished - finished} runs")
        results.keep_table(file, pd.DataFrame(rows, columns=overturning_map.columns(study.varied)))
        journal.write_in_order(results.directory / of_runs)
        results.keep(of_runs, digest)
