"""Error against time of a study on this machine: the analysis and its table."""

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from rockbatch.analyses.accuracy import RUNS, SECONDS
from rockbatch.analyses.accuracy.error_and_time import Clock, measure, references
from rockbatch.batch.compiling import make_ready
from rockbatch.batch.listening import Progress, listener_of
from rockbatch.common.arguments import checked
from rockbatch.common.errors import InputError
from rockbatch.common.files import made_folder, write_whole
from rockbatch.common.lazy import pd
from rockbatch.reporting import write_report
from rockbatch.results.run_json import is_of
from rockbatch.study import Motions, Study, given_study
from rockbatch.study.suite import ground_motions
from rockbatch.workflow.analysis import Analysis

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Accuracy(Analysis):
    """Error against time per run; see also :class:`rockbatch.workflow.analysis.Analysis`.

    Attributes
    ----------
    accuracy : DataFrame
        A row for each method and setting, with the fields of
        :class:`rockbatch.analyses.accuracy.levels.Level` and the SHA-256 of the study as columns.
    records : tuple of str
        Names of the motions.
    """

    NAME: ClassVar[str] = "accuracy"
    TABLES: ClassVar[tuple[str, ...]] = ("accuracy",)

    accuracy: "pd.DataFrame"
    records: tuple[str, ...]

    def plot(self, width_mm: float = 160.0, ax: "Axes | None" = None) -> "Figure":
        """Draw the largest error, that of 95 % of the runs and the median over the time of a run: a matplotlib
        Figure, ``width_mm`` wide or in the place of ``ax``."""
        from rockbatch.analyses.accuracy.figures import error_and_time
        from rockbatch.analyses.accuracy.levels import of_table
        from rockbatch.common.figures.paper import drawn

        return drawn(error_and_time(of_table(self.accuracy)), width_mm, ax)

    def save(self, folder: str | os.PathLike[str]) -> tuple[Path, ...]:
        """Write ``accuracy.csv``, and the report again where the folder holds results of this very study.

        Returns the paths written. Raises ``InputError`` if the disk is full.
        """
        directory = made_folder(Path(folder))
        path = directory / "accuracy.csv"
        write_whole(path, self.accuracy.to_csv(index=False, float_format="%.6g", lineterminator="\n"))
        shown = is_of(directory, self.accuracy["study"].iloc[0], list(self.records))
        return (path, write_report(directory)) if shown else (path,)


@checked
def accuracy(
    study: str | os.PathLike[str] | Study,
    out: str | os.PathLike[str] | None = None,
    *,
    runs: int = RUNS,
    seconds: float = SECONDS,
    scipy: bool = False,
    motions: Motions = None,
    progress: Progress = None,
) -> Accuracy:
    """Measure the error of θ_max/α against time per run, for this study on this machine.

    Parameters
    ----------
    study, motions, progress
        As for :func:`rockbatch.run`.
    out : path, optional
        Folder for ``accuracy.csv``; if it holds results of the study, their report shows it. Without it nothing is
        written.
    runs : int
        Number of runs measured, spread over the study; fewer if there is no time for more.
    seconds : float
        Time allowed [s], once the kernels are compiled. What does not fit is left out: runs, the longest of
        the fixed steps, repetitions.
    scipy : bool
        Without effect, for earlier scripts: ``benchmarks/solvers.py`` compares SciPy's solvers.

    Returns
    -------
    Accuracy
        With the table ``accuracy``.

    Raises
    ------
    InputError
        With every mistake in the study; for ``runs`` below 1 or ``seconds`` not above 0; if no run converges under step halving,
        so that there is no error to measure.

    Examples
    --------
    >>> result = rb.accuracy("pier4.toml", runs=2)
    >>> result
    <accuracy of 'Pier 4'>
      tables  accuracy (13 rows)
    >>> result.accuracy[["method", "substeps", "runs"]].head(3)
        method  substeps  runs
    0  located         1     2
    1  located         2     2
    2  located         4     2
    """
    if runs < 1:
        raise InputError(f"runs = {runs}: must be at least 1")
    if not seconds > 0:
        raise InputError(f"seconds = {seconds:g}: must be above 0")
    loaded, listener = given_study(study, motions), listener_of(progress)
    if out is not None:
        Accuracy.refuse_irregular(Path(out))
    suite = ground_motions(loaded)
    make_ready(loaded, listener)
    clock = Clock(seconds)
    chosen = references(loaded, suite, runs, listener, clock)
    measured = Accuracy(
        study=loaded,
        info={},
        unusable=tuple(suite.unusable),
        accuracy=measure(loaded, chosen, listener, clock),
        records=tuple(motion.name for motion in suite.motions),
    )
    return measured if out is None else replace(measured, files=measured.save(out))
