"""The table of forces in sections, on request: each run is repeated, recorded at every step, and its motion read."""

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from rockbatch.batch.groups import MOST_STEPS_OF_FORCES
from rockbatch.batch.listening import Advance
from rockbatch.batch.plan import simulations
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.pier.sections import section_heights
from rockbatch.results.columns import StudyRun
from rockbatch.results.sections import section_rows
from rockbatch.simulation.histories import forces_in_sections
from rockbatch.simulation.runs import run_fixed, steps_of
from rockbatch.study import Study


def rows_of_sections(
    study: Study, runs: Sequence[StudyRun], peaks: "pd.DataFrame", jobs: int, progress: Advance
) -> Iterator[dict[str, Any]]:
    """Yield the rows of sections.csv of finished ``runs``, whose rows of peaks.csv are the first of ``peaks``.

    Mirror images, whose forces are the same, runs that failed and those that are too long to be held in memory have none.
    """
    quiet_s, error, requested = study.numerics.quiet_s, study.numerics.substeps is None, study.output.requested_sections
    assert requested is not None

    def rows_of(number: int) -> list[dict[str, Any]]:
        (run,), row = simulations([runs[number]]), peaks.iloc[number]
        if row["status"] == "failed" or steps_of(run.motion, int(row["substeps"]), quiet_s) > MOST_STEPS_OF_FORCES:
            return []
        names = {name: row[name] for name in ("record", "case", "polarity", "scale", *study.varied)}
        outcome = run_fixed(run.pier, run.base, run.motion, int(row["substeps"]), quiet_s).noted(row["note"])
        try:
            sections = forces_in_sections(run, outcome, quiet_s, section_heights(run.pier, requested), error=error)
        except InputError:  # too many impacts to be written down
            return []
        return [names | section for section in section_rows(run.pier, sections)]

    pool = ThreadPoolExecutor(max(1, jobs))
    try:
        for rows in pool.map(rows_of, [number for number, run in enumerate(runs) if not run.mirror_of]):
            yield from rows
            progress(1)
    finally:
        pool.shutdown(cancel_futures=True)  # an interrupt does not wait for the others
