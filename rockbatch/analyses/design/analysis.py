"""The values of one key, or of two, with which a design passes: the analysis and its tables.

One key is scanned, and every change of verdict between two neighbouring values bisected; with a second key, at each value of
its scan.
"""

import math
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import product
from typing import TYPE_CHECKING, Any, ClassVar

from rockbatch.analyses.design.search import middles
from rockbatch.analyses.design.study import DesignSpec, read_design
from rockbatch.analyses.design.tables import (
    BESIDE,
    CHECKS,
    INTERVALS,
    RUNS,
    VALUES,
    intervals_table,
    refusals,
    values_table,
)
from rockbatch.analyses.design.trials import Trial, Trials, Written
from rockbatch.batch.compiling import make_ready
from rockbatch.batch.digests import digests
from rockbatch.batch.listening import Progress, count, once
from rockbatch.batch.observers import observers_beside
from rockbatch.batch.threads import Engine
from rockbatch.batch.waves import Waves, identity
from rockbatch.checks.coverage import stations_of
from rockbatch.checks.omissions import OMISSIONS
from rockbatch.checks.suite_target import suite_of, suite_verdicts
from rockbatch.checks.verdicts import PASS, Verdict, as_table
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import pd
from rockbatch.motions import MotionSet
from rockbatch.motions.suites.spectrum_target import SpectrumTarget
from rockbatch.results.columns import columns, read_cells
from rockbatch.results.run_json import describe, rocking_periods
from rockbatch.simulation.observing import Observer
from rockbatch.study import Case, Motions, Study
from rockbatch.workflow.analysis import Analysis, AnalysisFolder, run_analysis

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

OF_NO_RUN = ("title", "check", "suite", "design", "reference")
"""Keys at the top of a study on which no run depends: with another limit, or another scan, finished runs are kept."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class DesignSearch(Analysis):
    """The values with which a design passes every check; see also :class:`rockbatch.workflow.analysis.Analysis`.

    Attributes
    ----------
    design : DataFrame
        A row for each interval of values of the key with one verdict, of each design and value of the second key: ``low`` and
        ``high`` were tried, ``below`` and ``above`` are the neighbours with another verdict, NaN where the scan ends, with the
        check, bound and record that govern there.
    design_values : DataFrame
        A row for each value that was tried: the verdict of all checks under all bounds, and the check that governs it.
    design_checks : DataFrame
        All verdicts, as rows of checks.csv.
    design_runs : DataFrame
        All runs, as rows of peaks.csv.
    design_sections, design_interaction : DataFrame or None
        If a check is about a section: the forces there, as rows of sections.csv and of interaction.csv.
    spec : DesignSpec
        The settings in [design] of the study.
    """

    NAME: ClassVar[str] = "design"
    TABLES: ClassVar[tuple[str, ...]] = (
        "design",
        "design_values",
        "design_checks",
        "design_sections",
        "design_interaction",
        "design_runs",
    )
    RUNS: ClassVar[tuple[str, ...]] = ("design_runs",)

    design: "pd.DataFrame"
    design_values: "pd.DataFrame"
    design_checks: "pd.DataFrame"
    design_sections: "pd.DataFrame | None"
    design_interaction: "pd.DataFrame | None"
    design_runs: "pd.DataFrame"
    spec: DesignSpec

    @property
    def answer(self) -> list[str]:
        """Return the answer in sentences, those of the command."""
        from rockbatch.analyses.design.answer import answer

        return [said for _, said in answer(self.info, self.design, self.design_values)]

    def plot(self, width_mm: float = 160.0, ax: "Axes | None" = None) -> "Figure":
        """Draw demand over limit of every check against the value, or the map of what passes for two keys: a matplotlib
        Figure, ``width_mm`` wide or in the place of ``ax``."""
        from rockbatch.analyses.design.figures import figure_of
        from rockbatch.common.figures.paper import drawn

        return drawn(figure_of(self.info, self.design, self.design_values, self.design_checks), width_mm, ax)


@checked
def design(
    study: str | os.PathLike[str] | Study,
    out: str | os.PathLike[str] | None = None,
    *,
    motions: Motions = None,
    jobs: int | Engine | None = None,
    fresh: bool = False,
    progress: Progress = None,
) -> DesignSearch:
    """Find the values of a key with which every check passes under every bound: [design] of a study.

    Parameters
    ----------
    study, motions, jobs, fresh, progress
        As for :func:`rockbatch.run`; the count starts anew for each wave of runs.
    out : path, optional
        Folder for the files of ``rockbatch design``, continued if it was interrupted; without it nothing is kept on disk.

    Returns
    -------
    DesignSearch
        With the tables ``design``, ``design_values``, ``design_checks`` and ``design_runs``, as their CSV files have them, and
        ``design_sections`` and ``design_interaction`` if a check is about a section.

    Raises
    ------
    InputError
        With every mistake in the study, or if it is refused with each of the values; for a folder with finished runs of
        another state of the study.

    Examples
    --------
    >>> result = rb.design("pier4.toml")
    >>> result
    <design of 'Pier 4'>
      tables  design (4 rows), design_values (9 rows), design_checks (9 rows), design_runs (18 rows)
    >>> result.design[["case", "verdict", "low", "high"]]
        case verdict   low  high
    0  rigid    pass  0.80   1.1
    1  rigid    fail  1.40   2.0
    2   pads    pass  0.80   1.4
    3   pads    fail  1.55   2.0
    """
    return run_analysis(
        DesignSearch, read_design, _write_tables, study, out, motions, jobs, fresh, progress, lambda spec: True
    )


def _write_tables(results: AnalysisFolder, spec: DesignSpec) -> dict[str, object]:
    study = results.study
    motions = results.read_motions(study)
    written = Written(study, spec)
    scan = [
        Trial(design, values[::-1])
        for design, values in product(written.designs, product(*(varied.values for varied in spec.vary[::-1])))
    ]
    if all(map(written.refusal, scan)):
        first_refused = f"with {_said(scan[0], spec)}: {written.refusal(scan[0])}"
        raise InputError(f"{study.path}: [design]: the study is refused with every value; {first_refused}")
    of_runs = replace(study, varied=(*written.varied, *spec.paths))
    observers = _observers_beside(study, motions)
    names = [observer.table for observer in observers]
    digest = digests(
        motions.motions,
        studies={name: table for name, table in written.tables.items() if name not in OF_NO_RUN},
        cases=study.cases,
        scales=(study.motions.vertical, study.motions.polarity, study.motions.scale),
        numerics=(study.numerics, study.output),
        columns=(columns(of_runs), names),
    )
    results.has(RUNS, digest)  # refuses an edited table; the journal has its runs, and those of earlier scans
    with results.journal(RUNS, columns(of_runs), digest, names, stays=True) as journal:
        known = {identity(read_cells(cells), of_runs.varied): number for number, cells in journal.rows()}
        waves = Waves(of_runs, journal, results.engine, results.listener, observers, known)
        info = describe(study, motions)
        trials = Trials(written, motions, waves, suite_of(info), _on_suite(study, info))
        first = tuple(case for trial in scan for case in written.cases(trial))
        if lacking := waves.lacking(trials.plan(scan)):
            _announce(results, spec, scan, len(first), motions, lacking)
            make_ready(replace(of_runs, cases=first), results.listener, waves.observers)
        requested = scan
        while requested:
            trials.execute(requested)
            requested = [*_bisected(trials, spec)]
        results.info |= _described(trials, spec, written, study)
        results.info["not_selected"] = list(stations_of(info).not_selected)
        results.keep_table(INTERVALS, intervals_table(trials.judged, spec, written.varied, written.designs))
        results.keep_table(VALUES, values_table(trials.judged, spec, written.varied))
        results.keep_table(CHECKS, as_table(trials.verdicts))
        for name, rows in waves.tables.items():
            results.keep_table(BESIDE[name], pd.DataFrame(rows))
        journal.write_in_order(results.directory / RUNS, numbers=waves.numbers)
        journal.renumber(waves.numbers)
    results.keep(RUNS, digest)
    results.info["runs"] = waves.finished
    return {"spec": spec}


def _said(trial: Trial, spec: DesignSpec) -> str:
    """Return the values of a trial in words: "case.damper.f = 0.1"."""
    return ", ".join(f"{path} = {value:.10g}" for path, value in zip(spec.paths, trial.values, strict=True))


def _observers_beside(study: Study, motions: MotionSet) -> list[Observer]:
    """Return the observers of the tables that the checks of ``study`` need; [] if none is about a section or a capacity."""
    of_one_moment = any(rule.at_m is not None or rule.curve is not None for rule in study.checks)
    requested = observers_beside(study.output, motions.motions) if of_one_moment else ()
    return [observer for observer in requested if observer.table in BESIDE]


def _announce(
    results: AnalysisFolder, spec: DesignSpec, scan: list[Trial], cases: int, motions: MotionSet, lacking: int
) -> None:
    """Say how many runs the scan takes that are not finished, and how many at most the bisection of a change of verdict."""
    study, designs = results.study, len({trial.design for trial in scan})
    of_case = len(motions.motions) * len(study.motions.scale)
    first = spec.vary[0]
    halvings = math.ceil(math.log2(first.step / spec.width))
    per_value = -(-cases * of_case // len(scan))
    values = " × ".join(f"{varied.points} values of {varied.path}" for varied in spec.vary)
    runs = f"{count(lacking, 'run')}{once(study)} on {results.engine}"
    narrowed = f"narrowed from {first.step:.4g} to {spec.width:g}, up to {count(halvings * per_value, 'run')} each"
    results.listener.say(f"{values} × {count(designs, 'design')}: {runs}; then each change of verdict is {narrowed}")


def _bisected(trials: Trials, spec: DesignSpec) -> Iterator[Trial]:
    """Yield the trials in the middle between neighbours with different verdicts that are further apart than the width."""
    lines = grouped(trials.judged, lambda trial: (trial.design, trial.values[1:]))
    for (design, others), of_line in lines.items():
        verdicts = {trial.values[0]: trials.judged[trial].verdict for trial in of_line}
        yield from (Trial(design, (middle, *others)) for middle in middles(verdicts, spec.width))


def _on_suite(study: Study, info: Mapping[str, Any]) -> Callable[[Sequence[Case]], list[Verdict]]:
    """Return a function from the cases of a trial to the verdicts on the suite by the study's targets, [] without any.

    ``info`` is what run.json says of study and motions.
    """
    target = study.motions.target

    def verdicts(cases: Sequence[Case]) -> list[Verdict]:
        own = info.get("target")
        if own is not None and isinstance(target, SpectrumTarget):  # a code's range is that of the piers
            own = own | rocking_periods(cases, target)
        return suite_verdicts({**info, "target": own}, study.motions.scale)

    return verdicts


def _described(trials: Trials, spec: DesignSpec, written: Written, study: Study) -> dict[str, Any]:
    """Return the entries of design.json beside those of every analysis: settings, designs, and numbers of values tried."""
    passing = [found for found in trials.judged.values() if found.verdict == PASS]
    refused = [*refusals(trials.judged)]
    return {
        "vary": [asdict(varied) | {"step": varied.step} for varied in spec.vary],
        "find": spec.find,
        "width": spec.width,
        "varied": [name for name in written.varied if name != "bound"],
        "designs": [{"case": design.case, "columns": dict(design.columns)} for design in written.designs],
        "lacking": list(spec.lacking),
        "bounds": [bound.as_in_run_json() for bound in study.bounds],
        "checks": [rule.name for rule in study.checks],
        "without_limit": list(trials.free),
        "omitted": [
            {"checks": list(checks), "remark": OMISSIONS[name].remark} for name, checks in trials.omitted.items()
        ],
        "beyond": list(trials.beyond),
        "cut_short": trials.cut_short,
        "of_one_motion": trials.of_one_motion,
        "tried": len(trials.judged),
        "passing": len(passing),
        "refused": refused,
        "unusable": len(trials.motions.unusable),
    }
