"""The table of half cycles, on request: each run is repeated, and its history read."""

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from rockbatch.batch.listening import Advance
from rockbatch.batch.plan import simulations
from rockbatch.common.errors import InputError
from rockbatch.common.lazy import pd
from rockbatch.results.columns import StudyRun
from rockbatch.simulation.half_cycles import HALF_CYCLE_COLUMNS, apparent_restitution
from rockbatch.simulation.histories import cycles_of, written
from rockbatch.simulation.runs import run_fixed
from rockbatch.study import Study

HALF_CYCLES = "half_cycles.csv"


def rows_of_half_cycles(
    study: Study, runs: Sequence[StudyRun], peaks: "pd.DataFrame", jobs: int, progress: Advance
) -> Iterator[dict[str, Any]]:
    """Yield the rows of half_cycles.csv of finished ``runs``, whose rows of peaks.csv are the first of ``peaks``.

    Mirror images, runs that failed and those that are too long to be held in memory have none.
    """
    quiet_s = study.numerics.quiet_s

    def rows_of(number: int) -> list[dict[str, Any]]:
        row = peaks.iloc[number]
        if row["status"] == "failed":
            return []
        (run,) = simulations([runs[number]])
        outcome = run_fixed(run.pier, run.base, run.motion, int(row["substeps"]), quiet_s)
        try:
            cycles = cycles_of(run.base, written(run, outcome, quiet_s, every_step=False))
        except InputError:
            return []
        columns = (*cycles, apparent_restitution(run.pier, cycles.amplitude))
        names = {name: row[name] for name in ("record", "case", "polarity", "scale", *study.varied)}
        return [
            names | {"half_cycle": n} | dict(zip(HALF_CYCLE_COLUMNS, map(float, values), strict=True))
            for n, values in enumerate(zip(*columns, strict=True))
        ]

    numbers = [number for number, run in enumerate(runs) if not run.mirror_of]
    with ThreadPoolExecutor(max(1, jobs)) as pool:
        for rows in pool.map(rows_of, numbers):
            yield from rows
            progress(1)
