"""The table of shocks in the sequences of a study: each sequence is run again, and read shock by shock."""

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from rockbatch.batch.listening import Advance
from rockbatch.batch.plan import simulations
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.results.columns import StudyRun
from rockbatch.results.shocks import shock_rows
from rockbatch.simulation.outcome import ShockOutcome
from rockbatch.simulation.runs import run_fixed
from rockbatch.simulation.shocks import by_shock
from rockbatch.study import Study


def sequences_of(runs: Sequence[StudyRun]) -> list[int]:
    """Return the numbers of the runs under a sequence, without mirror images."""
    return [number for number, run in enumerate(runs) if run.record.shocks and not run.mirror_of]


def rows_by_shock(
    study: Study, runs: Sequence[StudyRun], peaks: "pd.DataFrame", jobs: int, progress: Advance
) -> Iterator[dict[str, Any]]:
    """Yield the rows of shocks.csv of finished ``runs``, whose rows of peaks.csv are the first of ``peaks``."""
    quiet_s, error = study.numerics.quiet_s, study.numerics.substeps is None

    def rows_of(number: int) -> list[dict[str, Any]]:
        (run,), row = simulations([runs[number]]), peaks.iloc[number]
        names = {name: row[name] for name in ("record", "case", "polarity", "scale", *study.varied)}
        outcomes = [ShockOutcome("failed")] * len(run.motion.shocks)
        if row["status"] != "failed":  # with the same steps it comes to the same bits
            outcome = run_fixed(run.pier, run.base, run.motion, int(row["substeps"]), quiet_s)
            try:
                outcomes = by_shock(run, outcome, quiet_s, error=error)
            except InputError:  # too long to be held in memory
                outcomes = [ShockOutcome("not read")] * len(run.motion.shocks)
        return [names | shock_row for shock_row in shock_rows(run.motion, run.pier, outcomes)]

    pool = ThreadPoolExecutor(max(1, jobs))
    try:
        for rows in pool.map(rows_of, sequences_of(runs)):
            yield from rows
            progress(1)
    finally:
        pool.shutdown(cancel_futures=True)  # an interrupt does not wait for the others
