"""Speed against error of a study on this machine: from what it asks to its table."""

import json
import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from rockbatch.analysis.error_and_time import measure, references
from rockbatch.analysis.folder import Analysis
from rockbatch.batch.listening import Progress, listener_of
from rockbatch.errors import InputError
from rockbatch.files import write_whole
from rockbatch.report import write_report
from rockbatch.results.columns import PEAKS
from rockbatch.results.run_json import INFO
from rockbatch.study import Study, given_study
from rockbatch.study.suite import ground_motions

if TYPE_CHECKING:
    import pandas as pd

RUNS = 24
"""That are measured, unless another number is asked for."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Accuracy(Analysis):
    """Error against time per run; see also :class:`rockbatch.analysis.folder.Analysis`.

    Attributes
    ----------
    accuracy : DataFrame
        A row for each method and setting, with the columns :data:`rockbatch.analysis.error_and_time.COLUMNS`: errors of
        θ_max/α, times per run [s].
    records : tuple of str
        Names of the motions.
    """

    NAME: ClassVar[str] = "accuracy"
    TABLES: ClassVar[tuple[str, ...]] = ("accuracy",)

    accuracy: "pd.DataFrame"
    records: tuple[str, ...]

    def save(self, folder: str | os.PathLike[str]) -> tuple[Path, ...]:
        """Write ``accuracy.csv``, and the report again where the folder holds results of this very study.

        Returns the paths of what was written. Raises ``InputError`` if the disk is full.
        """
        directory = Path(folder)
        directory.mkdir(parents=True, exist_ok=True)
        path = directory / "accuracy.csv"
        write_whole(path, self.accuracy.to_csv(index=False, float_format="%.6g", lineterminator="\n"))
        return (path, write_report(directory)) if self._has_results(directory) else (path,)

    def _has_results(self, directory: Path) -> bool:
        """Whether the folder holds results of this very study with these motions, whose report can show the table."""
        try:
            info = json.loads((directory / INFO).read_text(encoding="utf-8"))
            records = tuple(record["record"] for record in info["records"])
            same = info["study"]["sha256"] == self.accuracy["study"].iloc[0] and records == self.records
        except (OSError, ValueError, KeyError, TypeError):
            return False
        return same and (directory / PEAKS).exists()


def accuracy(
    study: str | os.PathLike[str] | Study,
    out: str | os.PathLike[str] | None = None,
    *,
    runs: int = RUNS,
    motions: str | os.PathLike[str] | None = None,
    progress: Progress = None,
) -> Accuracy:
    """Error of θ_max/α against time per run, for this study on this machine, beside SciPy's solvers.

    Parameters
    ----------
    study, motions, progress
        As for :func:`rockbatch.run`.
    out : path, optional
        Folder for ``accuracy.csv``; where it holds results of the study, their report shows it. Without it nothing is
        written.
    runs : int
        How many runs are measured, spread over the study.

    Returns
    -------
    Accuracy
        With the table ``accuracy``.

    Raises
    ------
    InputError
        With every mistake in the study; if no run settles with ever smaller steps, so that there is no error to measure.

    Examples
    --------
    >>> found = rb.accuracy("pier4.toml", runs=2, scipy=False)
    >>> found
    >>> found.accuracy[["method", "substeps", "runs"]].head(3)
    """
    if runs < 1:
        raise InputError(f"runs = {runs}: must be at least 1")
    asked, listener = given_study(study, motions), listener_of(progress)
    found = ground_motions(asked)
    measured = Accuracy(
        study=asked,
        info={},
        unusable=tuple(found.unusable),
        accuracy=measure(asked, references(asked, found, runs, listener)),
        records=tuple(motion.name for motion in found.motions),
    )
    return measured if out is None else replace(measured, files=measured.save(out))
