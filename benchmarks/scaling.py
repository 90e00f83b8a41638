"""How the time of a run depends on threads, on the number and the length of runs, and on what runs beside it.

    python benchmarks/scaling.py [--repeats 3]

The tower of Palmeri & Makris (2007), Fig. 7, on foundations that differ a little, under the record RRS 228 (20 s,
0.01 s), to a tolerance of 1e-4 of α. Every table says what its ratios are over; 1 would be perfect, but for threads,
where their number would be.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from interleaved import interleaved, machine, ratio
from tower import TOWER, foundations, record

from rockbatch.batch.groups import outcomes_of
from rockbatch.batch.threads import Threads, cores
from rockbatch.motions import Motion
from rockbatch.pier import Pier
from rockbatch.results.columns import StudyRun
from rockbatch.study import Case, Numerics

SMALL = Pier(alpha=0.13, p=2.5)  # some 2 m high: overturns within 4 s of the same record
TO_TOLERANCE = Numerics(tolerance=1e-4)
FIXED = Numerics(tolerance=None, substeps=2)  # where a longer record shall not ask for smaller steps


def many(runs: int, motion: Motion, pier: Pier = TOWER) -> list[StudyRun]:
    """``runs`` foundations under one motion; springs as stiff, in frequency, for every pier."""
    same = TOWER.p / pier.p
    bases = [replace(base, beta=base.beta * same) for base in foundations(runs)]
    return [StudyRun(motion, "+", 1.0, Case("", pier, base, {})) for base in bases]


def all_of(runs: list[StudyRun], jobs: int) -> list[str]:
    """Run them in ``jobs`` threads; how each ended."""
    return [run.outcome.status for group in Threads(jobs).outcomes(runs, TO_TOLERANCE) for run in group.values()]


def one_group(runs: list[StudyRun], numerics: Numerics = TO_TOLERANCE) -> list[str]:
    """Run them side by side in this thread; how each ended."""
    return ["stopped" if outcome is None else outcome.status for outcome in outcomes_of(runs, numerics)]


def table(first: str, unit: str, rows: list[str]) -> list[str]:
    """Lines of a table whose ratios are over ``unit``."""
    return ["", f"| {first} | {unit}: best | median |", "| --- | --- | --- |", *rows]


def threads(motion: Motion, repeats: int, most_runs: int) -> list[str]:
    """Runs per second over those of one thread."""
    runs = many(most_runs, motion)
    counts = sorted({1, *(2**i for i in range(1, cores().bit_length()) if 2**i <= cores()), cores()})
    tasks = {str(jobs): partial(all_of, runs, jobs) for jobs in counts}
    times = interleaved(tasks, repeats, time.perf_counter)
    rows = [f"| {jobs} | {ratio(times['1'], times[str(jobs)])} |" for jobs in counts]
    per_second = len(runs) / min(times["1"])
    title = f"threads ({len(runs)} runs; one thread: {per_second:.0f} a second)"
    return table(title, "runs per second / those of one thread", rows)


def number_of_runs(motion: Motion, repeats: int, most_runs: int) -> list[str]:
    """Time per run over that of the most runs."""
    counts = [4**i for i in range(2, 8) if 4**i < most_runs] + [most_runs]
    tasks = {str(n): partial(all_of, many(n, motion), 1) for n in counts}
    times = interleaved(tasks, repeats, time.process_time)  # the work is done in a thread of its own
    rows = [f"| {n} | {ratio(times[str(n)], times[str(most_runs)], most_runs / n)} |" for n in counts]
    return table("runs, one thread", f"time per run / that of {most_runs} runs", rows)


def record_length(motion: Motion, repeats: int, runs: int) -> list[str]:
    """Time per sample, quiet time included, over that of the record itself, which is cut or repeated."""
    lengths = {0.25: "a quarter", 0.5: "half", 1.0: "whole", 2.0: "twice", 4.0: "four times"}
    moved = {
        name: Motion(motion.name, motion.dt, np.resize(motion.horizontal, round(factor * motion.npts)))
        for factor, name in lengths.items()
    }
    times = interleaved({name: partial(one_group, many(runs, one), FIXED) for name, one in moved.items()}, repeats)
    samples = {name: one.npts + FIXED.quiet_s / one.dt for name, one in moved.items()}
    rows = [f"| {name} | {ratio(times[name], times['whole'], samples['whole'] / samples[name])} |" for name in moved]
    return table(f"record ({runs} runs, 2 steps per sample)", "time per sample / that of the whole record", rows)


def mixed(motion: Motion, repeats: int, runs: int) -> list[str]:
    """A group of different runs over the same runs, each kind in a group of its own."""
    half = Motion("half", motion.dt, motion.horizontal[: motion.npts // 2])
    finer = Motion(
        "finer", motion.dt / 2, np.interp(np.arange(2 * motion.npts - 1) / 2, np.arange(motion.npts), motion.horizontal)
    )
    kinds = {
        "the record and half of it": [many(runs, motion), many(runs, half)],
        "samples of 10 and 5 ms": [many(runs, motion), many(runs, finer)],
        "a half of the piers overturns early": [many(runs, motion), many(runs, motion, SMALL)],
        "all of these": [many(runs, motion), many(runs, half), many(runs, finer), many(runs, motion, SMALL)],
    }

    def apart(groups: list[list[StudyRun]]) -> None:
        for group in groups:
            one_group(group)

    tasks: dict[str, Callable[[], object]] = {}
    for name, groups in kinds.items():
        tasks[name] = partial(one_group, [run for turn in zip(*groups, strict=True) for run in turn])
        tasks[f"{name}, apart"] = partial(apart, groups)
    times = interleaved(tasks, repeats)
    rows = [f"| {name} | {ratio(times[name], times[f'{name}, apart'])} |" for name in kinds]
    return table(f"mixed ({runs} of each kind)", "time / that of each kind in a group of its own", rows)


def main(repeats: int = 3, most_runs: int = 4096, runs: int = 256, seconds: float | None = None) -> list[str]:
    """Lines of all tables; of the first ``seconds`` of the record only, if given."""
    motion = record(seconds)
    return [
        *threads(motion, repeats, most_runs // 4),
        *number_of_runs(motion, repeats, most_runs),
        *record_length(motion, repeats, runs),
        *mixed(motion, repeats, runs),
    ]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    print(machine())
    print("\n".join(main(arguments.repeats)))
