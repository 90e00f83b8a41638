"""Carry out runs that a journal lacks, and add their rows to it."""

from array import array
from collections.abc import Callable, Collection, Container, Iterator, Mapping, Sequence
from contextlib import closing

from rockbatch.batch.beside import packed
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Advance, silent
from rockbatch.batch.plan import MOST_RUNS, Runs, some_of
from rockbatch.batch.threads import Engine
from rockbatch.common.errors import InputError
from rockbatch.results.columns import StudyRun, cells
from rockbatch.simulation.observing import Observer
from rockbatch.study import Numerics

Values = Mapping[str, object]
"""A row of a table, by column."""

RowOf = Callable[[StudyRun], Values]
"""Makes the row of a table from a finished run."""


class InMemory(dict[int, Values]):
    """Rows of finished runs by number, with ``columns``: replaces a journal if nothing is written to disk."""

    beside: Sequence[str] = ()

    def __init__(self, columns: Sequence[str]) -> None:
        self.columns = columns

    def add_all(self, rows: Mapping[int, Values]) -> None:
        """Add rows by the numbers of their runs, as they are."""
        self.update(rows)

    def add_columns(self, numbers: Sequence[int], columns: Mapping[str, Sequence[object]]) -> None:
        """Add rows as :meth:`Journal.add_columns`; missing columns stay missing."""
        rows = zip(*columns.values(), strict=True)
        self.update((number, dict(zip(columns, row, strict=True))) for number, row in zip(numbers, rows, strict=True))


def execute_runs(
    runs: Runs,
    numerics: Numerics,
    journal: Journal | InMemory,
    engine: Engine,
    observers: Sequence[Observer] = (),
    *,
    numbers: Sequence[int] | None = None,
    among: Collection[int] | None = None,
    row: RowOf | None = None,
    progress: Advance = silent,
) -> None:
    """Carry out the runs that ``journal`` lacks, and add the rows of each group when it is finished.

    One of two mirror images is simulated, both are added. Rows of ``observers``' tables are kept with those of the peaks.
    ``numbers`` are those of the runs in the journal, by default their indices; ``among`` restricts the indices of runs; ``row``
    makes the row of a finished run, by default that of peaks.csv; ``progress`` is called with the number of simulations of each
    finished group.
    """
    every = range(len(runs))
    requested, numbers = every if among is None else among, every if numbers is None else numbers
    remaining = to_simulate(runs, requested, journal, numbers)
    with closing(engine.outcomes(some_of(runs, remaining), numerics, observers)) as groups:
        for group in groups:
            finished = _with_images(runs, {remaining[place]: run for place, run in group.items()})
            missing = {numbers[i]: run for i, run in finished if i in requested and numbers[i] not in journal}
            if row is not None:
                journal.add_all({number: row(run) for number, run in missing.items()})
            elif missing:
                ended = list(missing.values())
                tables = {name: [packed(run, name) for run in ended] for name in journal.beside}
                journal.add_columns(list(missing), cells(ended, journal.columns) | tables)
            progress(len(group))


def to_simulate(
    runs: Runs, requested: Collection[int], journal: Container[int] = (), numbers: Sequence[int] | None = None
) -> "array[int]":
    """Return the indices of the runs to simulate for all that are ``requested`` and not in ``journal``.

    ``numbers`` are those of the runs in the journal, by default their indices. Of two mirror images it is the index of the one
    that is simulated for both, once, requested itself or not. Raises ``InputError`` if ``runs`` are more than
    :data:`MOST_RUNS`, however many are requested.
    """
    if len(runs) > MOST_RUNS:
        raise InputError(
            f"{len(runs):,} runs, more than {MOST_RUNS:,}: records × polarities × scales × cases; split the study, by its "
            "records for example"
        )

    def is_left(index: int) -> bool:
        return index in requested and (index if numbers is None else numbers[index]) not in journal

    if not runs.mirrored:
        return array("q", filter(is_left, requested))
    pairs = ((index, runs.images(index)[0]) for index in filter(is_left, requested))
    # An image whose simulated twin is requested, too, is covered when the twin's index comes
    return array("q", (twin for index, twin in pairs if twin == index or not is_left(twin)))


def _with_images(runs: Runs, simulated: Mapping[int, StudyRun]) -> Iterator[tuple[int, StudyRun]]:
    """Yield indices in ``runs`` and finished runs: each ``simulated`` one, followed by its mirror image, if any."""
    for index, run in simulated.items():
        yield index, run
        for image in runs.images(index):
            if image != index:
                assert run.outcome is not None
                yield image, runs[image]._replace(outcome=run.outcome.mirrored())
