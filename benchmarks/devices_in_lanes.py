"""What a batch of piers with dampers or a tendon costs, to its tolerance, over the same batch without them.

    python benchmarks/devices_in_lanes.py [--repeats 3] [--size 12] [--base springs]

Piers of several heights on several foundations under six recorded motions: by default 864 runs, in one thread. All batches
of a base are run in turn, so that all see the same machine. The trials are those that the step-halving error control asks
for, and the steps those of all trials, each over those of the plain batch. The last column is the cost of a step.
"""

import argparse
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

from interleaved import interleaved, machine, ratio
from tower import QUIET_S

from rockbatch.motions import Motion, read_motions
from rockbatch.pier import Damper, Pier, Restraint, RigidBase, Tendon, YieldingBase
from rockbatch.simulation import Run, Stop, error_control, run_all_to_tolerance
from rockbatch.simulation.runs import Trial

RECORDS = [("ERZ", 0.0), ("RRS", 228.0), ("SYL", 360.0), ("CPM", 0.0), ("LCN", 260.0), ("TCU065", 90.0)]
TOLERANCE = 1e-4
DEVICES: dict[str, tuple[Restraint, ...]] = {
    "none": (),
    "viscous": (Damper("viscous", nu=0.2),),
    "viscous, exponent 0.3": (Damper("viscous", nu=0.1, exponent=0.3),),
    "tendon": (Tendon(psi=0.1, lam=0.5),),
    "friction": (Damper("friction", f=0.05),),
    "hysteretic": (Damper("hysteretic", f=0.05, yield_m=0.005),),
}
"""Devices by the names of the rows; a damper is one at each pivot."""


def springs(share: float, restraints: tuple[Restraint, ...]) -> YieldingBase:
    """Return a foundation on elastic–perfectly plastic springs, stiffer and stronger with ``share`` from 0 to 1."""
    return YieldingBase(
        75.0 + 10.0 * share, 0.05, flight="guided", eta=2.3 + 0.4 * share, spring="epp", restraints=restraints
    )


def rigid(share: float, restraints: tuple[Restraint, ...]) -> RigidBase:
    """Return a foundation on rigid ground, whose restitution grows with ``share`` from 0 to 1."""
    return RigidBase(0.85 + 0.1 * share, restraints)


BASES: dict[str, Callable[[float, tuple[Restraint, ...]], YieldingBase | RigidBase]] = {
    "springs": springs,
    "rigid": rigid,
}


def batch(base: str, devices: str, motions: Sequence[Motion], size: int) -> list[Run]:
    """Return the runs of ``size`` piers on ``size`` foundations with ``devices`` under all ``motions``."""
    piers = [Pier(0.13, 0.38 + 0.2 * i / size) for i in range(size)]
    bases = [BASES[base](i / size, DEVICES[devices]) for i in range(size)]
    return [Run(pier, on, motion) for pier in piers for on in bases for motion in motions]


class Counted:
    """Counts the trials of a batch, and their steps."""

    def __init__(self) -> None:
        self.trials, self.steps = 0, 0.0

    def of(self, runs: Sequence[Run]) -> "Counted":
        """Return the counts of a batch to its tolerance."""
        try_all = error_control.try_all

        def counting(some: Sequence[Run], *rest: Any) -> list[Trial | None]:
            trials = try_all(some, *rest)
            self.trials += len(trials)
            ends = [(run, trial.outcome) for run, trial in zip(some, trials, strict=True) if trial is not None]
            self.steps += sum(outcome.t_end / run.motion.dt * outcome.substeps for run, outcome in ends)
            return trials

        error_control.try_all = counting
        run_all_to_tolerance(runs, TOLERANCE, QUIET_S, Stop())
        error_control.try_all = try_all
        return self


def measure(base: str, motions: Sequence[Motion], size: int, repeats: int) -> list[str]:
    """Return the lines of the table for a ``base``."""
    batches = {devices: batch(base, devices, motions, size) for devices in DEVICES}
    counts = {devices: Counted().of(runs) for devices, runs in batches.items()}
    tasks = {
        devices: partial(run_all_to_tolerance, runs, TOLERANCE, QUIET_S, Stop()) for devices, runs in batches.items()
    }
    times, plain = interleaved(tasks, repeats), counts["none"]
    lines = []
    for devices, count in counts.items():
        trials, steps = count.trials / plain.trials, count.steps / plain.steps
        step = ratio(times[devices], times["none"], 1.0 / steps).split(" | ")[0]
        milliseconds = 1e3 * min(times[devices]) / len(batches[devices])
        over = ratio(times[devices], times["none"])
        lines.append(f"| {base} | {devices} | {over} | {milliseconds:.3g} ms | {trials:.2f} | {steps:.2f} | {step} |")
    return lines


def main(repeats: int = 3, size: int = 12, base: str = "", seconds: float | None = None) -> list[str]:
    """Return the lines of the table; of the first ``seconds`` of the records only, if given."""
    motions = [
        motion if seconds is None else Motion(motion.name, motion.dt, motion.horizontal[: round(seconds / motion.dt)])
        for motion in read_motions([], fema=RECORDS).motions
    ]
    return [
        f"{size * size * len(motions)} runs to a tolerance of {TOLERANCE} α, one thread",
        "",
        "| base | devices | batch / plain batch: best | median | a run | trials / plain | steps / plain | step / plain step |",
        "| --- | --- | --- | --- | --- | --- | --- | --- |",
        *(line for name in BASES if base in ("", name) for line in measure(name, motions, size, repeats)),
    ]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--size", type=int, default=12)
    parser.add_argument("--base", choices=list(BASES), default="")
    arguments = parser.parse_args()
    print(machine())
    print("\n".join(main(arguments.repeats, arguments.size, arguments.base)))
