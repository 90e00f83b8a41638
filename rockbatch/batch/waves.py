"""Runs in waves, each of which depends on the results of the one before; all of them in one journal."""

from array import array
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from itertools import count

from rockbatch.batch.beside import Rows, rows_beside
from rockbatch.batch.execution import execute_runs
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Listener, silent
from rockbatch.batch.observers import observers_of
from rockbatch.batch.plan import Runs
from rockbatch.batch.threads import Engine
from rockbatch.common.lazy import pd
from rockbatch.quantities.rows import as_in_peaks
from rockbatch.results.beside_peaks import NAMING
from rockbatch.results.columns import StudyRun, as_table, read_cells
from rockbatch.simulation.observing import Observer
from rockbatch.study import Study

Identity = tuple[object, ...]
"""Key of a run in its study: record, case, polarity, scale and varied values, as written in peaks.csv."""


def identity(cells: Mapping[str, object], varied: Sequence[str]) -> Identity:
    """Return the identity of the run in a row, with numbers for its cells as :func:`read_cells` makes them."""
    return tuple(as_in_peaks(cells.get(name)) for name in (*NAMING, *varied))


def identity_of(run: StudyRun, varied: Sequence[str]) -> Identity:
    """Return the identity that the row of a run will have."""
    naming = dict(zip(NAMING, (run.record.name, run.case.name, run.polarity, run.scale), strict=True))
    return identity(naming | run.case.columns, varied)


class Waves:
    """Runner of waves of runs, each returned as its rows of peaks.csv, in the order of its runs.

    The numbers of the runs go on from wave to wave: as long as a wave follows from the rows before it alone, a search that
    was killed goes on where it stopped. With ``known``, numbers of finished runs by :func:`identity`, a search finds them in
    whatever order it asks for them. Rows always come from the journal, with its ten digits, so that nothing depends on
    whether they were there already. ``numbers`` are those of all runs asked for, in their order.

    The ``listener`` follows the progress of each wave that has runs left. ``tables`` collects the rows of those of the
    ``observers`` that write tables beside peaks.csv.
    """

    def __init__(
        self,
        study: Study,
        journal: Journal,
        engine: Engine,
        listener: Listener | None = None,
        observers: Sequence[Observer] = (),
        known: Mapping[Identity, int] | None = None,
    ) -> None:
        self.study, self.journal, self.engine, self.listener = study, journal, engine, listener or Listener()
        self.observers, self.numbers = observers, array("q")
        self._known = None if known is None else dict(known)
        self._free = count(max((known or {}).values(), default=-1) + 1)
        self.tables: dict[str, Rows] = {observer.table: [] for observer in observers}

    @property
    def finished(self) -> int:
        """Return the number of runs asked for so far, all of which are finished."""
        return len(self.numbers)

    def lacking(self, runs: Runs) -> int:
        """Return how many of the ``runs`` are not known."""
        known = self._known or ()
        return sum(identity_of(run, self.study.varied) not in known for run in runs)

    def _numbered(self, runs: Runs) -> Sequence[int]:
        """Return the numbers of ``runs`` in the journal: those known, and new ones."""
        known = self._known
        if known is None:
            return range(self.finished, self.finished + len(runs))
        names = [identity_of(run, self.study.varied) for run in runs]
        return [known[name] if name in known else known.setdefault(name, next(self._free)) for name in names]

    def __call__(self, runs: Runs) -> "pd.DataFrame":
        numbers = self._numbered(runs)
        self.numbers.extend(numbers)
        pending = sum(number not in self.journal for number in numbers)
        with self.listener.progress(pending) if pending else nullcontext(silent) as progress:
            execute_runs(
                runs,
                self.study.numerics,
                self.journal,
                self.engine,
                (*observers_of(self.study.output), *self.observers),
                numbers=numbers,
                progress=progress,
            )
        texts = (self.journal[number].items() for number in numbers)
        rows = (read_cells({name: str(text) for name, text in cells}) for cells in texts)
        table = as_table(rows, self.study)
        beside = rows_beside(
            self.observers, self.study, runs, table, self.journal, self.engine.jobs, self.listener, numbers
        )
        for name, more in beside.items():
            self.tables[name] += more
        return table
