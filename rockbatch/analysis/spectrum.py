"""Rocking spectra and overturning maps of a study: the analysis and its tables."""

import os
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

from rockbatch.analysis import overturning_map, rocking_spectrum
from rockbatch.analysis.folder import Analysis, AnalysisFolder, analysis_folder
from rockbatch.analysis.waves import Waves
from rockbatch.arguments import checked
from rockbatch.batch.carrying_out import carry_out
from rockbatch.batch.compiling import make_ready
from rockbatch.batch.digests import digests
from rockbatch.batch.groups import NOTHING_MORE
from rockbatch.batch.listening import Progress, count, listener_of, once
from rockbatch.batch.threads import Engine, engine_of
from rockbatch.files import is_plain, read_table
from rockbatch.lazy import pd
from rockbatch.motions import MotionSet
from rockbatch.results.columns import columns
from rockbatch.study import Motions, Study, given_study
from rockbatch.study.spectrum import MapSpec, SpectrumSpec, read_spectrum
from rockbatch.study.suite import ground_motions

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Spectrum(Analysis):
    """Rocking spectra and overturning maps; see also :class:`rockbatch.analysis.folder.Analysis`.

    Attributes
    ----------
    spectrum : DataFrame or None
        A row for each motion, slenderness, size and base: θ_max/α and how the run ended.
    spectrum_suite : DataFrame or None
        A row for each slenderness, size and base: 16, 50 and 84 % quantiles of θ_max/α over the motions, infinite where
        the pier overturns.
    overturning_map : DataFrame or None
        A row for each region of amplitudes a_p/(g tan α) with one outcome, at each frequency ω_p/p of each map.
    overturning_runs : DataFrame or None
        The runs of the maps, as rows of peaks.csv.
    spectra, maps : SpectrumSpec or None, tuple of MapSpec
        The settings in [spectrum] of the study.
    """

    NAME: ClassVar[str] = "spectrum"
    TABLES: ClassVar[tuple[str, ...]] = ("spectrum", "spectrum_suite", "overturning_map", "overturning_runs")

    spectrum: "pd.DataFrame | None"
    spectrum_suite: "pd.DataFrame | None"
    overturning_map: "pd.DataFrame | None"
    overturning_runs: "pd.DataFrame | None"
    spectra: SpectrumSpec | None
    maps: tuple[MapSpec, ...]

    def plot(self, width_mm: float = 160.0) -> "Figure":
        """Draw the spectrum of each case, with its median over the records, and the maps: a matplotlib Figure of this width."""
        from rockbatch.analysis import plots

        return plots.spectrum(self.spectrum, self.spectrum_suite, self.overturning_map, width_mm)


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
    started = time.monotonic()
    asked, carrier = given_study(study, motions), engine_of(jobs)
    spectra, maps = read_spectrum(asked)
    listener = listener_of(progress)
    suite = MotionSet()
    with analysis_folder(out, Spectrum, asked, fresh, listener) as results, carrier:
        if spectra is not None:
            suite = ground_motions(asked)
            listener.motions(suite)
            results.under(suite.motions)
            _carry_out_spectra(results, spectra, suite, carrier)
        if maps:
            _carry_out_maps(results, maps, carrier)
        files = results.end(engine=str(carrier), wall_s=round(time.monotonic() - started, 3))
        return Spectrum(
            study=asked,
            info=results.info,
            unusable=tuple(suite.unusable),
            files=files,
            **results.tables(Spectrum.TABLES),
            spectra=spectra,
            maps=maps,
        )


def _carry_out_spectra(results: AnalysisFolder, spectra: SpectrumSpec, motions: MotionSet, carrier: Engine) -> None:
    """Write the rocking spectra, unless they exist already, and the statistics of the suite."""
    study, listener, file = results.study, results.listener, rocking_spectrum.FILE
    runs = rocking_spectrum.plan(study, spectra, motions)
    digest = digests(
        motions.motions,
        cases=spectra.cases,
        scales=(study.motions.polarity, study.motions.scale),
        numerics=study.numerics,
    )
    many = f"{count(len(motions.motions), 'motion')}, {count(len(runs), 'run')}{once(study)}"
    listener.say(f"spectra: {many} on {carrier}")
    results.info |= {"axis": spectra.axis, "varied": list(spectra.varied), "motions": len(motions.motions)}
    if results.has(file, digest):
        results.keep(file, digest)
    else:
        make_ready(replace(study, cases=spectra.cases), listener)
        with results.journal(file, rocking_spectrum.columns(spectra), digest) as journal:
            with listener.progress(len(runs) - len(journal)) as progress:
                carry_out(runs, study.numerics, journal, carrier, row=rocking_spectrum.row_of, progress=progress)
            journal.write_in_order(results.directory / file)
            results.keep(file, digest)
    suite = rocking_spectrum.of_suite(read_table(results.directory / file), spectra.varied)
    results.keep_table(rocking_spectrum.SUITE, suite)


def _carry_out_maps(results: AnalysisFolder, maps: Sequence[MapSpec], carrier: Engine) -> None:
    """Write the overturning maps, unless they exist already."""
    study, listener = replace(results.study, output=NOTHING_MORE), results.listener
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
        waves = Waves(study, journal, carrier, listener.progress)
        for spec in maps:
            own, before = overturning_map.Maps(spec, study.cases), waves.finished
            grid = _grid(spec, len(study.cases))
            listener.say(f"map {spec.name}: {grid} on {carrier}; then what changes is looked at more closely")
            by_case = own.find(waves)
            rows += own.rows(by_case)
            listener.say(f"map {spec.name}: {sum(map(len, by_case))} frequencies, {waves.finished - before} runs")
        results.keep_table(file, pd.DataFrame(rows, columns=overturning_map.columns(study.varied)))
        journal.write_in_order(results.directory / of_runs)
        results.keep(of_runs, digest)


def _grid(spec: MapSpec, cases: int) -> str:
    grid = f"{spec.frequencies} frequencies × {spec.amplitudes} amplitudes"
    return f"{grid} × {count(cases, 'case')}" if cases > 1 else grid
