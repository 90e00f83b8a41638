"""Every record in every case: runs to rows, those that are not there yet."""

from array import array
from collections.abc import Callable, Container, Iterator, Mapping, Sequence
from contextlib import closing
from typing import Any

from rockbatch.batch.beside import packed
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Advance, silent
from rockbatch.batch.plan import MOST_RUNS, Runs, some_of
from rockbatch.batch.threads import Engine
from rockbatch.common.errors import InputError
from rockbatch.results.columns import StudyRun, cells
from rockbatch.simulation.observing import Observer
from rockbatch.study import Numerics

RowOf = Callable[[StudyRun], Mapping[str, Any]]
"""From a finished run to its row of a table."""


class InMemory(dict[int, Mapping[str, Any]]):
    """Rows of finished runs by their numbers, with some ``columns``, in place of a journal where nothing is kept on disk."""

    beside: Sequence[str] = ()

    def __init__(self, columns: Sequence[str]) -> None:
        self.columns = columns

    def add_all(self, rows: Mapping[int, Mapping[str, Any]]) -> None:
        """Add rows as :meth:`Journal.add_all`."""
        self.update(rows)

    def add_columns(self, numbers: Sequence[int], columns: Mapping[str, Sequence[Any]]) -> None:
        """Add rows as :meth:`Journal.add_columns`."""
        rows = zip(*columns.values(), strict=True)
        self.update((number, dict(zip(columns, row, strict=True))) for number, row in zip(numbers, rows, strict=True))


def execute_runs(
    runs: Runs,
    numerics: Numerics,
    journal: Journal | InMemory,
    engine: Engine,
    observers: Sequence[Observer] = (),
    *,
    first: int = 0,
    among: range | None = None,
    row: RowOf | None = None,
    progress: Advance = silent,
) -> None:
    """Carry out those runs that are not in ``journal``, and write each into it as soon as its group is finished.

    Of mirror images one is simulated, and both are written. Rows of tables beside the peaks, which ``observers`` may give, stay
    with those of the peaks. ``first`` is the number of ``runs[0]`` in the journal, ``among`` the
    indices of the runs that are wanted, if not all; ``row`` makes the row of a finished run, where that is not one of peaks.csv,
    and ``progress`` is called with the number of simulations of each group that is finished.
    """
    requested = range(len(runs)) if among is None else among
    remaining = to_simulate(runs, requested, journal, first)
    with closing(engine.outcomes(some_of(runs, remaining), numerics, observers)) as groups:
        for group in groups:
            finished = _with_images(runs, {remaining[place]: run for place, run in group.items()})
            missing = {first + i: run for i, run in finished if i in requested and first + i not in journal}
            if row is not None:
                journal.add_all({number: row(run) for number, run in missing.items()})
            elif missing:
                ended = list(missing.values())
                tables = {name: [packed(run, name) for run in ended] for name in journal.beside}
                journal.add_columns(list(missing), cells(ended, journal.columns) | tables)
            progress(len(group))


def to_simulate(runs: Runs, requested: range, journal: Container[int] = (), first: int = 0) -> "array[int]":
    """Return the indices of the runs that give all that are ``requested`` and not in ``journal``, or mirror images of them.

    Raises ``InputError`` for more than :data:`MOST_RUNS`.
    """
    if len(runs) > MOST_RUNS:
        raise InputError(
            f"{len(runs):,} runs, more than {MOST_RUNS:,}: records × polarities × scales × cases; split the study, by its "
            "records for example"
        )

    def is_left(index: int) -> bool:
        return index in requested and first + index not in journal

    if not runs.mirrored:
        return array("q", filter(is_left, requested))
    firsts = ((index, runs.images(index)[0]) for index in filter(is_left, requested))
    return array(
        "q", (first for index, first in firsts if first == index or not is_left(first))
    )  # else in its own turn


def _with_images(runs: Runs, simulated: Mapping[int, StudyRun]) -> Iterator[tuple[int, StudyRun]]:
    """Yield the finished runs that were ``simulated``, by their indices in ``runs``, each followed by its mirror image."""
    for index, run in simulated.items():
        yield index, run
        for image in runs.images(index):
            if image != index:
                assert run.outcome is not None
                yield image, runs[image]._replace(outcome=run.outcome.mirrored())
