"""Every record in every case: runs to rows, those that are not there yet."""

from array import array
from collections.abc import Callable, Container, Iterator, Mapping
from contextlib import closing
from typing import Any

from rockbatch.batch.groups import NOTHING_MORE
from rockbatch.batch.journal import Journal
from rockbatch.batch.plan import MOST_RUNS, Chosen, PlannedRun, Runs
from rockbatch.batch.threads import Engine
from rockbatch.checks.suite import MIRROR_OF
from rockbatch.errors import InputError
from rockbatch.results.columns import row
from rockbatch.results.outcome import Outcome
from rockbatch.study import Numerics, Output


class InMemory(dict[int, Mapping[str, Any]]):
    """Rows of finished runs by their numbers, in place of a journal where nothing is kept on disk."""

    def add_all(self, rows: Mapping[int, Mapping[str, Any]]) -> None:
        """As :meth:`Journal.add_all`."""
        self.update(rows)


def carry_out(
    runs: Runs,
    numerics: Numerics,
    journal: Journal | InMemory,
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
    """Indices of the runs that give all those that are ``wanted`` and not in ``journal``, themselves or their mirror images.

    Raises ``InputError`` for more than :data:`MOST_RUNS`.
    """
    if len(runs) > MOST_RUNS:
        raise InputError(
            f"{len(runs):,} runs, more than {MOST_RUNS:,}: records × polarities × scales × cases; split the study, by its "
            "records for example"
        )

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
    return row(run.motion, run.polarity, run.scale, run.case, outcome) | {MIRROR_OF: run.mirror_of}
