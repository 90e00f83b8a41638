"""Tables beside peaks.csv that are read from the motions of the runs, each of which is repeated for that."""

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from rockbatch.batch.groups import MOST_STEPS_OF_FORCES
from rockbatch.batch.listening import Listener
from rockbatch.batch.plan import simulations
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.pier.sections import section_heights
from rockbatch.results.beside_peaks import NAMING
from rockbatch.results.columns import StudyRun
from rockbatch.results.sections import SECTIONS, section_rows
from rockbatch.results.shocks import SHOCKS, shock_rows
from rockbatch.simulation.half_cycles import HALF_CYCLE_COLUMNS, apparent_restitution
from rockbatch.simulation.histories import cycles_of, forces_in_sections, written
from rockbatch.simulation.outcome import Outcome, ShockOutcome
from rockbatch.simulation.runs import Run, run_fixed, steps_of
from rockbatch.simulation.shocks import by_shock
from rockbatch.study import Study

HALF_CYCLES = "half_cycles.csv"


def rows_beside(
    table: str, study: Study, runs: Sequence[StudyRun], peaks: "pd.DataFrame", jobs: int, listener: Listener
) -> Iterator[dict[str, Any]]:
    """Yield the rows of a table of finished ``runs``, whose rows of peaks.csv are the first of ``peaks``.

    Mirror images have none; nor, but for shocks, have runs that failed and those that are too long to be held in memory.
    """
    rows_of = {SHOCKS: _shocks, HALF_CYCLES: _half_cycles, SECTIONS: _sections}[table]

    def named_rows(number: int) -> list[dict[str, Any]]:
        (run,), row = simulations([runs[number]]), peaks.iloc[number]
        names = {name: row[name] for name in (*NAMING, *study.varied)}
        return [names | of_run for of_run in rows_of(study, run, row)]

    numbers = [n for n, run in enumerate(runs) if not run.mirror_of and (run.record.shocks or table != SHOCKS)]
    pool = ThreadPoolExecutor(max(1, jobs))
    try:
        with listener.progress(len(numbers)) as progress:
            for rows in pool.map(named_rows, numbers):
                yield from rows
                progress(1)
    finally:
        pool.shutdown(cancel_futures=True)  # an interrupt does not wait for the others


def repeated(run: Run, row: "pd.Series", quiet_s: float) -> Outcome:
    """Return the outcome of a run that has a ``row`` of peaks.csv: with the same steps it comes to the same bits."""
    return run_fixed(run.pier, run.base, run.motion, int(row["substeps"]), quiet_s)


def _shocks(study: Study, run: Run, row: "pd.Series") -> list[dict[str, Any]]:
    quiet_s, outcomes = study.numerics.quiet_s, [ShockOutcome("failed")] * len(run.motion.shocks)
    if row["status"] != "failed":
        outcome = repeated(run, row, quiet_s)
        try:
            outcomes = by_shock(run, outcome, quiet_s, error=study.numerics.substeps is None)
        except InputError:  # too long to be held in memory
            outcomes = [ShockOutcome("not read")] * len(run.motion.shocks)
    return shock_rows(run.motion, run.pier, outcomes)


def _half_cycles(study: Study, run: Run, row: "pd.Series") -> list[dict[str, Any]]:
    if row["status"] == "failed":
        return []
    quiet_s = study.numerics.quiet_s
    outcome = repeated(run, row, quiet_s)
    try:
        cycles = cycles_of(run.base, written(run, outcome, quiet_s, every_step=False))
    except InputError:
        return []
    columns = (*cycles, apparent_restitution(run.pier, cycles.amplitude))
    return [
        {"half_cycle": n} | dict(zip(HALF_CYCLE_COLUMNS, map(float, values), strict=True))
        for n, values in enumerate(zip(*columns, strict=True))
    ]


def _sections(study: Study, run: Run, row: "pd.Series") -> list[dict[str, Any]]:
    quiet_s, error, requested = study.numerics.quiet_s, study.numerics.substeps is None, study.output.requested_sections
    assert requested is not None
    if row["status"] == "failed" or steps_of(run.motion, int(row["substeps"]), quiet_s) > MOST_STEPS_OF_FORCES:
        return []
    outcome = repeated(run, row, quiet_s).changed(chaotic=not pd.isna(row["chaotic"]) and bool(row["chaotic"]))
    try:
        sections = forces_in_sections(run, outcome, quiet_s, section_heights(run.pier, requested), error=error)
    except InputError:  # too many impacts to be written down
        return []
    return section_rows(run.pier, sections)
