"""Rows of the tables beside peaks.csv: kept in the journal with the row of their run, or computed by repeating the run."""

import base64
import json
import zlib
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor

from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import Listener
from rockbatch.batch.plan import simulations
from rockbatch.common.lazy import pd
from rockbatch.results.beside_peaks import NAMING
from rockbatch.results.columns import StudyRun
from rockbatch.results.labelled import Row
from rockbatch.simulation.observing import Observer, observed
from rockbatch.simulation.runs import run_fixed
from rockbatch.study import Numerics, Study

MOST_OF_A_CELL = 1 << 18
"""Most characters of a run's rows in one table; with more, the run is repeated when the table is written."""

Rows = list[Row]


def packed(run: StudyRun, table: str) -> str:
    """Return the rows of a run in ``table`` as one cell without commas; "" without that table, or beyond MOST_OF_A_CELL."""
    rows = None if run.outcome is None else run.outcome.tables.get(table)
    return "" if rows is None else packed_rows(rows)


def packed_rows(rows: Sequence[Mapping[str, object]]) -> str:
    """Return rows as one cell without commas; "" beyond MOST_OF_A_CELL."""
    cell = base64.b64encode(zlib.compress(json.dumps(rows).encode())).decode()
    return cell if len(cell) <= MOST_OF_A_CELL else ""


def unpacked(cell: str) -> Rows:
    """Return the rows in a cell made by :func:`packed_rows`."""
    return list(json.loads(zlib.decompress(base64.b64decode(cell))))


def rows_beside(
    observers: Sequence[Observer],
    study: Study,
    runs: Sequence[StudyRun],
    peaks: "pd.DataFrame",
    journal: Journal,
    jobs: int,
    listener: Listener,
    in_journal: Sequence[int] | None = None,
) -> dict[str, Rows]:
    """Return the rows of each table of ``observers`` for finished ``runs``, whose rows in ``peaks`` come first.

    ``in_journal`` are the numbers of the runs in the journal, by default their indices. Each row begins with the columns that
    name its run. Mirror images have none. Runs whose rows the ``journal`` lacks, for example because they were finished before
    the table was requested, are repeated.
    """
    tables: dict[str, Rows] = {observer.table: [] for observer in observers}
    if not tables:
        return tables
    naming = {name: peaks[name].to_numpy() for name in (*NAMING, *study.varied)}
    in_journal = range(len(runs)) if in_journal is None else in_journal
    numbers = [number for number, run in enumerate(runs) if not run.mirror_of]
    kept = (journal.cells_beside(in_journal[number]) for number in numbers)
    lacking = [[o for o in observers if not cells.get(o.table)] for cells in kept]
    again = [(number, missing) for number, missing in zip(numbers, lacking, strict=True) if missing]

    def of_run(number: int, missing: Sequence[Observer]) -> Mapping[str, Rows]:
        return read_again(runs[number], peaks.iloc[number], missing, study.numerics)

    pool = ThreadPoolExecutor(max(1, jobs))
    try:
        with listener.progress(len(again)) as progress:
            of_again = pool.map(of_run, *zip(*again, strict=True)) if again else iter(())
            for number, missing in zip(numbers, lacking, strict=True):
                cells = journal.cells_beside(in_journal[number])
                of_tables = {name: unpacked(cell) for name, cell in cells.items() if cell}
                if missing:
                    of_tables |= next(of_again)
                    progress(1)
                names = {name: values[number] for name, values in naming.items()}
                for table, rows in tables.items():
                    rows += [names | row for row in of_tables.get(table, ())]
    finally:
        pool.shutdown(cancel_futures=True)  # an interrupt does not wait for pending runs
    return tables


def read_again(
    planned: StudyRun, row: "pd.Series", observers: Sequence[Observer], numerics: Numerics
) -> Mapping[str, Rows]:
    """Return the rows of each table of ``observers`` for a run, by name, repeated with the steps of its ``row`` of peaks.csv.

    The run's results are bitwise those of the row. An observer that does not read the run, as it is too long, gives no rows.
    """
    (run,) = simulations([planned])
    outcome = run_fixed(run.pier, run.base, run.motion, int(row["substeps"]), numerics.quiet_s)
    outcome = outcome.changed(status=row["status"], reason=row["reason"], note=row["note"])
    (outcome,) = observed([run], [outcome], observers, numerics.quiet_s, error=numerics.substeps is None)
    return outcome.tables
