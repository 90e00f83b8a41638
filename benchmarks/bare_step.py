"""What a step of whole runs costs, side by side, over the bare step of the model.

    python benchmarks/bare_step.py [--repeats 7]

Bare is one step of Runge–Kutta 4 and the rates at its end, of one run in full contact, in a compiled loop that does
nothing else: no events, no extremes, one run at a time. Whole runs are those of a study: tests for events, their
location, landings and separations, peaks and plastic work. On the rigid base bare is a step of a block about one corner.
"""

import argparse
import math
from collections.abc import Mapping
from dataclasses import replace

import numba
import numpy as np
from interleaved import Times, interleaved, machine, ratio
from tower import QUIET_S, TOWER, foundations, record

from rockbatch.core.equations import rates, step
from rockbatch.core.lanes import table
from rockbatch.core.one_pass import one_pass
from rockbatch.core.recording import LINE, ROW
from rockbatch.core.records import LANES
from rockbatch.core.rigid import runs as rigid
from rockbatch.core.rigid.equations import acceleration, rocking_step
from rockbatch.core.two_springs import (
    begin,
    rock_on_springs,
    rock_side_by_side,
    run_line,
    spring_run,
    static_state,
)
from rockbatch.core.types import BOUC_WEN, RIGHT, SURVIVED, Contact, Ground, Rocking, Traits
from rockbatch.motions import Motion
from rockbatch.pier import ElasticBase, Pier, RigidBase, YieldingBase
from rockbatch.simulation import block, ground_of, springs

BARE_STEPS = 200_000
BARE_ROCKING = 1e-6  # [s]: of a bare step on the rigid base, so that the block stays on its corner
PASSES = 10_000
PLAIN = Traits(None, None, None)  # n = 5, first-order kinematics, undamped


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


@numba.njit(error_model="numpy")
def bare_rocking(m, y, ground, h, steps):
    """The rotation after ``steps`` steps of ``h`` [s] about one corner of a rigid base and nothing else."""
    k = acceleration(m, y.theta, y.side, ground[0, 0], ground[0, 2])
    for i in range(steps):
        row = ground[i % len(ground)]
        y = rocking_step(m, y, k, Ground(row[0], row[1], row[2], row[3]), h)
        k = acceleration(m, y.theta, y.side, row[0] + h * row[1], row[2] + h * row[3])
    return y.theta


@numba.njit(error_model="numpy", _nrt=False)
def passes(lanes_table, lines, ground, count):
    """All lanes from the start, ``count`` passes of tiny steps: no sample is reached, and nothing happens."""
    lanes = lanes_table[0]
    for i in range(len(lines)):
        begin(lanes, i, i, lines, ground, PLAIN, True)
    for _ in range(count):
        one_pass(lanes, len(lines), PLAIN)


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
    lines = [run_line(m, dt, substeps, quiet, 0, len(ground)) for m in models]
    stop = np.zeros(1, np.uint8)
    ends = [spring_run(line) for line in rock_side_by_side(PLAIN, lines, ground, stop)]
    if any(end.status != SURVIVED for end in ends):
        raise SystemExit(f"{law}: a run ended early; its steps are no measure")
    steps = sum(round(end.t_end / dt * substeps) for end in ends)

    # An event is two rows of a history, a sample one
    vertical = () if motion.vertical is None else motion.vertical
    counted = rock_on_springs(
        models[runs // 2], motion.horizontal, vertical, dt, substeps, quiet, np.recarray(1, ROW), True
    )
    samples = round(counted.t_end / dt) + 1
    events = (counted.rows - samples) // 2

    m = models[runs // 2]
    branch = 1.0 if m.law == BOUC_WEN else 0.0
    alone = (m, static_state(m, m.gravity), Contact(1.0, 1.0, branch, branch, 0.0), ground, dt / substeps, BARE_STEPS)
    times = interleaved(
        {
            "whole": lambda: rock_side_by_side(PLAIN, lines, ground, stop),
            "bare": lambda: bare(*alone),
        },
        repeats,
    )
    return row(law, motion, substeps, times, steps, events / (samples - 1) / substeps)


def row(law: str, motion: Motion, substeps: int, times: Mapping[str, Times], steps: int, events: float) -> str:
    """Line of the table, by the times of whole runs of so many ``steps`` and of the bare ones; ``events`` in each."""
    over = ratio(times["whole"], times["bare"], BARE_STEPS / steps)
    nanoseconds = 1e9 * min(times["bare"]) / BARE_STEPS
    up = "no" if motion.vertical is None else "yes"
    return f"| {law} | {up} | {substeps} | {over} | {events:.4f} | {nanoseconds:.0f} ns |"


def measure_rigid(motion: Motion, substeps: int, runs: int, repeats: int) -> str:
    """Line of the table for the rigid base: piers of p = 0.38 … 0.5 rad/s."""
    ground, dt = ground_of(motion), float(motion.dt)
    quiet = math.ceil(QUIET_S / dt - 1e-9)
    piers = [Pier(TOWER.alpha, TOWER.p + 0.12 * i / runs) for i in range(runs)]
    models = [block(pier, RigidBase()) for pier in piers]
    lines = [rigid.run_line(m, 0.0, 0.0, dt, substeps, quiet, 0, len(ground)) for m in models]
    stop = np.zeros(1, np.uint8)
    ends = rigid.rock_side_by_side(lines, ground, stop)
    if (ends.status != SURVIVED).any():
        raise SystemExit("rigid: a run ended early; its steps are no measure")
    steps = int(np.rint(ends.t_end / dt * substeps).sum())
    alone = (models[0], Rocking(0.1 * TOWER.alpha, 0.0, RIGHT), ground, BARE_ROCKING, BARE_STEPS)
    times = interleaved(
        {
            "whole": lambda: rigid.rock_side_by_side(lines, ground, stop),
            "bare": lambda: bare_rocking(*alone),
        },
        repeats,
    )
    return row("rigid", motion, substeps, times, steps, (ends.impacts + ends.lift_offs).sum() / steps)


def pass_alone(motion: Motion, repeats: int) -> str:
    """What the lanes' pass takes without any event or sample, a lane, over the bare step."""
    ground, dt = ground_of(motion), float(motion.dt)
    models = [springs(TOWER, of_law("bouc-wen", base)) for base in foundations(LANES)]
    lines = np.array([run_line(m, dt, 100 * PASSES, 0, 0, len(ground)) for m in models], LINE)
    alone = (
        models[0],
        static_state(models[0], models[0].gravity),
        Contact(1.0, 1.0, 1.0, 1.0, 0.0),
        ground,
        dt,
        BARE_STEPS,
    )
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
        *(
            measure_rigid(moved, substeps, runs, repeats)
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
