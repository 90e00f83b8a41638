"""What a step of whole runs costs, side by side, over the bare step of the model.

    python benchmarks/bare_step.py [--repeats 7]

Bare is one step of Runge–Kutta 4 and the rates at its end, of one run in full contact, in a compiled loop that does
nothing else: no events, no extremes, one run at a time. Whole runs are those of a study: tests for events, their
location, landings and separations, peaks and plastic work.
"""

import argparse
import math
from dataclasses import replace

import numba
import numpy as np
from interleaved import interleaved, machine, ratio
from tower import QUIET_S, TOWER, foundations, record

from rockbatch.core.equations import rates, step
from rockbatch.core.lanes import LANES, table
from rockbatch.core.one_pass import one_pass
from rockbatch.core.recording import HISTORY_COLUMNS
from rockbatch.core.two_springs import (
    begin,
    rock_on_springs,
    rock_side_by_side,
    run_line,
    spring_run,
    static_state,
)
from rockbatch.core.types import BOUC_WEN, SURVIVED, Contact, Ground
from rockbatch.motions import Motion
from rockbatch.simulation import ground_of, springs
from rockbatch.structure import ElasticBase, YieldingBase

BARE_STEPS = 200_000
PASSES = 10_000


@numba.njit(error_model="numpy")
def bare(m, y, contact, ground, h, steps):
    """The rotation after ``steps`` steps of ``h`` [s] and nothing else."""
    k = rates(m, y, contact, ground[0, 0], ground[0, 2])
    for i in range(steps):
        row = ground[i % len(ground)]
        under = Ground(row[0], row[1], row[2], row[3])
        y = step(m, y, k, contact, under, h)
        k = rates(m, y, contact, row[0] + h * row[1], row[2] + h * row[3])
    return y.theta


@numba.njit(error_model="numpy", _nrt=False)
def passes(lanes_table, lines, ground, count):
    """All lanes from the start, ``count`` passes of tiny steps: no sample is reached, and nothing happens."""
    lanes = lanes_table[0]
    for i in range(len(lines)):
        begin(lanes, i, i, lines, ground, None, None, True)
    for _ in range(count):
        one_pass(lanes, len(lines), None, None)


def of_law(law: str, base: YieldingBase) -> ElasticBase:
    """``base`` with springs of ``law``; a flight goes on, so that no run ends early."""
    if law == "elastic":
        return ElasticBase(base.beta, base.epsilon, flight="guided")
    return replace(base, spring="epp" if law == "epp" else "bouc-wen", flight="guided")


def with_vertical(motion: Motion) -> Motion:
    """``motion`` with a third of its horizontal component, reversed in time, as a vertical one."""
    vertical = 1.0 / 3.0 * np.ascontiguousarray(motion.horizontal[::-1])
    return Motion(motion.name, motion.dt, motion.horizontal, vertical)


def measure(law: str, motion: Motion, substeps: int, runs: int, repeats: int) -> str:
    """Line of the table."""
    ground, dt = ground_of(motion), float(motion.dt)
    quiet = math.ceil(QUIET_S / dt - 1e-9)
    models = [springs(TOWER, of_law(law, base)) for base in foundations(runs)]
    lines = np.array([run_line(m, dt, substeps, quiet, 0, len(ground)) for m in models])
    stop = np.zeros(1, np.uint8)
    ends = [spring_run(line) for line in rock_side_by_side(None, None, lines, ground, stop)]
    if any(end.status != SURVIVED for end in ends):
        raise SystemExit(f"{law}: a run ended early; its steps are no measure")
    steps = sum(round(end.t_end / dt * substeps) for end in ends)

    # An event is two rows of a history, a sample one
    vertical = () if motion.vertical is None else motion.vertical
    counted = rock_on_springs(
        models[runs // 2], motion.horizontal, vertical, dt, substeps, quiet, np.empty((1, HISTORY_COLUMNS)), True
    )
    samples = round(counted.t_end / dt) + 1
    events = (counted.rows - samples) // 2

    m = models[runs // 2]
    branch = 1.0 if m.law == BOUC_WEN else 0.0
    alone = (m, static_state(m), Contact(1.0, 1.0, branch, branch, 0.0), ground, dt / substeps, BARE_STEPS)
    times = interleaved(
        {
            "whole": lambda: rock_side_by_side(None, None, lines, ground, stop),
            "bare": lambda: bare(*alone),
        },
        repeats,
    )
    over = ratio(times["whole"], times["bare"], BARE_STEPS / steps)
    nanoseconds = 1e9 * min(times["bare"]) / BARE_STEPS
    up = "no" if motion.vertical is None else "yes"
    return f"| {law} | {up} | {substeps} | {over} | {events / (samples - 1) / substeps:.4f} | {nanoseconds:.0f} ns |"


def pass_alone(motion: Motion, repeats: int) -> str:
    """What the lanes' pass takes without any event or sample, a lane, over the bare step."""
    ground, dt = ground_of(motion), float(motion.dt)
    models = [springs(TOWER, of_law("bouc-wen", base)) for base in foundations(LANES)]
    lines = np.array([run_line(m, dt, 100 * PASSES, 0, 0, len(ground)) for m in models])
    alone = (models[0], static_state(models[0]), Contact(1.0, 1.0, 1.0, 1.0, 0.0), ground, dt, BARE_STEPS)
    tasks = {
        "pass": lambda: passes(table()[0], lines, ground, PASSES),
        "bare": lambda: bare(*alone),
    }
    times = interleaved(tasks, repeats)
    best, median = ratio(times["pass"], times["bare"], BARE_STEPS / (PASSES * LANES)).split(" | ")
    return f"The lanes' pass alone, bouc-wen, a lane / bare step: best {best}, median {median}"


def main(repeats: int = 7, runs: int = 64, seconds: float | None = None) -> list[str]:
    """Lines of the table; of the first ``seconds`` of the record only, if given."""
    motion = record(seconds)
    return [
        f"{runs} runs side by side under {motion.name}, {motion.npts} samples",
        "",
        "| law | vertical | steps per sample | step of whole runs / bare step: best | median | events per step | bare |",
        "| --- | --- | --- | --- | --- | --- | --- |",
        *(
            measure(law, moved, substeps, runs, repeats)
            for law in ("bouc-wen", "elastic", "epp")
            for moved in (motion, with_vertical(motion))
            for substeps in (1, 2, 4)
        ),
        "",
        pass_alone(motion, repeats),
    ]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=7)
    arguments = parser.parse_args()
    print(machine())
    print("\n".join(main(arguments.repeats)))
