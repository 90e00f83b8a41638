"""Every record in every case: a study from its motions to its table."""

import hashlib
import os
from array import array
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockbatch.engines import Engine, Threads, cores
from rockbatch.errors import InputError
from rockbatch.groups import NOTHING_MORE, program
from rockbatch.journal import Journal
from rockbatch.motions import Motion, MotionSet
from rockbatch.outcome import Outcome
from rockbatch.plan import Chosen, Plan, Run
from rockbatch.results import as_table, row, unusable_rows
from rockbatch.study import Numerics, Output, Study, load_study
from rockbatch.study.suite import ground_motions

if TYPE_CHECKING:
    import pandas as pd


def carry_out(
    runs: Sequence[Run],
    numerics: Numerics,
    journal: Journal,
    engine: Engine,
    output: Output = NOTHING_MORE,
    *,
    first: int = 0,
    among: Iterable[int] | None = None,
    row: Callable[[Run, Outcome], Mapping[str, Any]] | None = None,
    progress: Callable[[int], object] | None = None,
) -> None:
    """Carry out those runs that are not in ``journal``, and write each into it as soon as its group is finished.

    Parameters
    ----------
    first : int
        Number of ``runs[0]`` in the journal; the others follow.
    among : iterable of int, optional
        Indices of the runs that are wanted, if not all.
    row : function, optional
        What the journal is told of a run and its outcome; :func:`row_of` by default.
    progress : function, optional
        Called with the number of runs of each group that is finished.
    """
    wanted = range(len(runs)) if among is None else among
    told = row or row_of
    left = array("q", (index for index in wanted if first + index not in journal))
    with closing(engine.outcomes(Chosen(runs, left), numerics, output)) as groups:
        for group in groups:
            journal.add_all({first + left[i]: told(runs[left[i]], outcome) for i, outcome in group})
            if progress is not None:
                progress(len(group))


def row_of(run: Run, outcome: Outcome) -> dict[str, Any]:
    """Row of peaks.csv of a run that is finished."""
    return row(run.motion.name, run.polarity, run.scale, run.case, outcome)


def digests(motions: Iterable[Motion], **settings: object) -> dict[str, str]:
    """What rows depend on, as a :class:`Journal` wants it: motions, settings (by their ``repr``), and the program."""
    found = {name: hashlib.sha256(repr(value).encode()) for name, value in settings.items()}
    found["motions"] = hashlib.sha256()
    for motion in motions:
        found["motions"].update(repr((motion.name, motion.dt, motion.npts, motion.initial)).encode())
        for samples in (motion.horizontal, motion.vertical):
            found["motions"].update(b"none" if samples is None else samples.tobytes())
    return {name: each.hexdigest()[:16] for name, each in found.items()} | {"program": program()}


def study_digests(study: Study, motions: MotionSet) -> dict[str, str]:
    """What the rows of a study depend on; not its title, its checks or its comments."""
    return digests(
        motions.motions,
        cases=study.cases,
        scales=(study.motions.polarity, study.motions.scale),
        numerics=(study.numerics, study.output.both_laws, study.output.ledger),
    )


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
        Called with the number of finished runs and of all.

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
    rows: dict[int, dict[str, object]] = {}
    with closing(Threads(jobs or cores()).outcomes(runs, study.numerics, study.output)) as groups:
        for group in groups:
            for index, outcome in group:
                rows[index] = row_of(runs[index], outcome)
                if progress:
                    progress(len(rows), len(runs))
    return as_table([*(rows[i] for i in sorted(rows)), *unusable_rows(found)], study)
