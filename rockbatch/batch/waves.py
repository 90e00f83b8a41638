"""Runs in waves, each of which depends on the results of the one before; all of them in one journal."""

from collections.abc import Sequence
from contextlib import nullcontext

from rockbatch.batch.beside import Rows, rows_beside
from rockbatch.batch.execution import InMemory, execute_runs
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Listener, silent
from rockbatch.batch.observers import observers_of
from rockbatch.batch.plan import Runs
from rockbatch.batch.threads import Engine
from rockbatch.common.lazy import pd
from rockbatch.results.columns import as_table, read_cells
from rockbatch.simulation.observing import Observer
from rockbatch.study import Study


class Waves:
    """Runner of waves of runs, each returned as its rows of peaks.csv, in the order of its runs.

    The numbers of the runs go on from wave to wave: as long as a wave follows from the rows before it alone, a search that
    was killed goes on where it stopped. Rows always come from the journal, with its ten digits, so that nothing depends on
    whether they were there already.

    The ``listener`` follows the progress of each wave that has runs left. ``tables`` collects the rows of those of the
    ``observers`` that write tables beside peaks.csv.
    """

    def __init__(
        self,
        study: Study,
        journal: Journal | InMemory,
        engine: Engine,
        listener: Listener | None = None,
        observers: Sequence[Observer] = (),
    ) -> None:
        self.study, self.journal, self.engine, self.listener = study, journal, engine, listener or Listener()
        self.finished, self.observers = 0, observers
        self.tables: dict[str, Rows] = {observer.table: [] for observer in observers}

    def __call__(self, runs: Runs) -> "pd.DataFrame":
        first, self.finished = self.finished, self.finished + len(runs)
        pending = sum(number not in self.journal for number in range(first, self.finished))
        with self.listener.progress(pending) if pending else nullcontext(silent) as progress:
            execute_runs(
                runs,
                self.study.numerics,
                self.journal,
                self.engine,
                (*observers_of(self.study.output), *self.observers),
                first=first,
                progress=progress,
            )
        texts = (self.journal[number].items() for number in range(first, self.finished))
        rows = (read_cells({name: str(text) for name, text in cells}) for cells in texts)
        table = as_table(rows, self.study)
        if self.observers and isinstance(self.journal, Journal):
            beside = rows_beside(
                self.observers, self.study, runs, table, self.journal, self.engine.jobs, self.listener, first
            )
            for name, more in beside.items():
                self.tables[name] += more
        return table
