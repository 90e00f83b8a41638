"""Every record in every case: a study from its motions to its table."""

import os
from array import array
from collections.abc import Callable, Container, Iterator, Mapping
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.batch.groups import NOTHING_MORE
from rockbatch.batch.journal import Journal
from rockbatch.batch.plan import Chosen, Plan, PlannedRun, Runs
from rockbatch.batch.threads import Engine, Threads, cores
from rockbatch.checks.suite import MIRROR_OF
from rockbatch.errors import InputError
from rockbatch.results.columns import as_table, row, unusable_rows
from rockbatch.results.outcome import Outcome
from rockbatch.study import Numerics, Output, Study, load_study
from rockbatch.study.suite import ground_motions

if TYPE_CHECKING:
    import pandas as pd


def carry_out(
    runs: Runs,
    numerics: Numerics,
    journal: Journal,
    engine: Engine,
    output: Output = NOTHING_MORE,
    *,
    first: int = 0,
    among: range | None = None,
    row: Callable[[PlannedRun, Outcome], Mapping[str, Any]] | None = None,
    progress: Callable[[int], object] | None = None,
) -> None:
    """Carry out those runs that are not in ``journal``, and write each into it as soon as its group is finished.

    Of mirror images one is simulated, and both are written.

    Parameters
    ----------
    first : int
        Number of ``runs[0]`` in the journal; the others follow.
    among : range, optional
        Indices of the runs that are wanted, if not all.
    row : function, optional
        What the journal is told of a run and its outcome; :func:`row_of` by default.
    progress : function, optional
        Called with the number of simulations of each group that is finished.
    """
    wanted = range(len(runs)) if among is None else among
    told = row or row_of
    left = to_simulate(runs, wanted, journal, first)
    with closing(engine.outcomes(Chosen(runs, left), numerics, output)) as groups:
        for group in groups:
            rows = (pair for i, outcome in group for pair in _images(runs, left[i], outcome, told))
            journal.add_all({first + i: cells for i, cells in rows if i in wanted and first + i not in journal})
            if progress is not None:
                progress(len(group))


def to_simulate(runs: Runs, wanted: range, journal: Container[int] = (), first: int = 0) -> "array[int]":
    """Indices of the runs that give all those that are ``wanted`` and not in ``journal``, themselves or their mirror images."""

    def is_left(index: int) -> bool:
        return index in wanted and first + index not in journal

    found = array("q")
    for index in filter(is_left, wanted):
        simulated = runs.images(index)[0]
        if simulated == index or not is_left(simulated):  # else it has its own turn
            found.append(simulated)
    return found


def _images(
    runs: Runs, index: int, outcome: Outcome, told: Callable[[PlannedRun, Outcome], Mapping[str, Any]]
) -> Iterator[tuple[int, Mapping[str, Any]]]:
    """Index and row of a run that was simulated, and of its mirror image."""
    for image in runs.images(index):
        run = runs[image]
        yield image, told(run, outcome.mirrored() if run.mirror_of else outcome)


def row_of(run: PlannedRun, outcome: Outcome) -> dict[str, Any]:
    """Row of peaks.csv of a run that is finished."""
    return row(run.motion.name, run.polarity, run.scale, run.case, outcome) | {MIRROR_OF: run.mirror_of}


def run(
    study: str | os.PathLike[str] | Study,
    *,
    motions: str | os.PathLike[str] | None = None,
    jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> "pd.DataFrame":
    """Run a study: the rows of peaks.csv.

    Parameters
    ----------
    study : path or Study
        A study file, or one that is loaded.
    motions : path, optional
        A file or folder that replaces all motions of a study file.
    jobs : int, optional
        Number of threads; all processors by default. The table does not depend on it.
    progress : function of two ints, optional
        Called with the number of finished simulations and of all.

    Raises
    ------
    InputError
        With every mistake in the study.
    """
    if jobs is not None and jobs < 1:
        raise InputError(f"jobs = {jobs}: must be at least 1, or left out for all processors")
    if not isinstance(study, Study):
        study = load_study(Path(study), motions=motions)
    found = ground_motions(study)
    runs = Plan(study, found)
    simulated = Chosen(runs, to_simulate(runs, range(len(runs))))
    rows: dict[int, Mapping[str, Any]] = {}
    finished = 0
    with closing(Threads(jobs or cores()).outcomes(simulated, study.numerics, study.output)) as groups:
        for group in groups:
            for i, outcome in group:
                rows |= _images(runs, simulated.indices[i], outcome, row_of)
                finished += 1
                if progress:
                    progress(finished, len(simulated))
    return as_table([*(rows[i] for i in sorted(rows)), *unusable_rows(found)], study)
