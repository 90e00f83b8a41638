"""Carry out the unfinished runs of a batch into its journal."""

from collections.abc import Collection

from rockbatch.batch.compiling import make_ready
from rockbatch.batch.execution import execute_runs, to_simulate
from rockbatch.batch.journal import Journal
from rockbatch.batch.listening import count
from rockbatch.batch.observers import observers_of
from rockbatch.batch.preparing import Batch
from rockbatch.batch.threads import Engine
from rockbatch.results.labelled import Row


def execute(batch: Batch, requested: Collection[int], journal: Journal, engine: Engine) -> Row:
    """Carry out the ``requested`` runs that the journal lacks; return ``jobs`` and ``kept``, those finished before."""
    runs, listener = batch.runs, batch.listener
    every, remaining = (len(to_simulate(runs, requested, finished)) for finished in ((), journal))
    n_finished = every - remaining
    if n_finished:
        listener.say(f"{n_finished} of them are finished already, {remaining} are left (--fresh starts over)")
    try:
        with listener.progress(remaining) as progress:
            observers, numerics = (*observers_of(batch.study.output), *batch.observers), batch.study.numerics
            make_ready(batch.study, listener, observers)
            execute_runs(runs, numerics, journal, engine, observers, among=requested, progress=progress)
    except KeyboardInterrupt:
        if n_done := every - len(to_simulate(runs, requested, journal)):
            listener.say(
                f"interrupted: {n_done} of {count(every, 'run')} are finished and kept in {journal.path}; "
                "the same command continues from there"
            )
        raise
    return {"jobs": engine.jobs, "kept": n_finished}
