"""Where the steps of a batch to its tolerance go, by cause, over those of its first runs.

    python benchmarks/halvings.py [--size 8] [--base springs]

Piers of several heights on several foundations under six recorded motions, without devices, each to 10⁻⁴ α. A run and its
halved step are 3 times the first run. Beyond these are further halvings, by what the last two runs did not agree on, and runs
under changed motions, by why they were asked for. No times: steps are counted.
"""

import argparse
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from devices_in_lanes import BASES, RECORDS, TOLERANCE, batch
from tower import QUIET_S

from rockbatch.motions import Motion, read_motions
from rockbatch.simulation import Run, Stop, chaos, error_control, run_all_to_tolerance
from rockbatch.simulation.agreement import Agreement, agreement, same_counts, windows
from rockbatch.simulation.coarser import tolerances_beside
from rockbatch.simulation.runs import Trial


@dataclass
class Spent:
    """Steps and runs by cause."""

    steps: Counter[str] = field(default_factory=Counter)
    runs: Counter[str] = field(default_factory=Counter)

    def add(self, cause: str, run: Run, trial: Trial) -> None:
        """Add the steps of a trial."""
        self.steps[cause] += trial.outcome.t_end / run.motion.dt * trial.outcome.substeps
        self.runs[cause] += 1


def disagreement(levels: Sequence[Trial], run: Run) -> str:
    """Return what the last two trials of a run disagree on, so that a further one is needed."""
    if len(levels) == 1:
        return "halved"
    fine, coarse, tolerances = levels[-1], levels[-2], tolerances_beside(TOLERANCE * run.pier.alpha, None)
    if fine.outcome.status != coarse.outcome.status:
        return "further: another outcome"
    extent, changes = agreement(fine, coarse, tolerances, run.pier), windows(fine, coarse)[1]
    if extent == Agreement.APART and (changes <= tolerances.extremes).all():
        return "further: counts of events differ"
    moved = abs(fine.outcome.theta_max - coarse.outcome.theta_max) > tolerances.peak
    return "further: the peak" if moved else "further: residuals, lesser extremes or the time of the peak"


def spent(runs: Sequence[Run]) -> Spent:
    """Return what a batch to its tolerance spends."""
    found, levels, asked = Spent(), dict[int, list[Trial]](), dict[int, str]()
    number = {id(run): i for i, run in enumerate(runs)}
    try_all, magnifies, wanders = error_control.try_all, error_control.magnifies, error_control.residuals_wander
    look, lingers, reasons, latest = error_control.look_for_chaos, error_control.lingers, list[str](), 0

    def trying(some: Sequence[Run], *rest: Any) -> list[Trial | None]:
        trials = try_all(some, *rest)
        for run, trial in zip(some, trials, strict=True):
            if trial is not None:
                known = levels.setdefault(number[id(run)], [])
                found.add(disagreement(known, run) if known else "first", run, trial)
                known.append(trial)
        return trials

    def under_changes(some: Sequence[Run], *rest: Any) -> list[Trial | None]:
        trials = try_all(some, *rest)
        for j, (run, trial) in enumerate(zip(some, trials, strict=True)):
            if trial is not None:
                found.add(f"changed: {reasons[j // len(chaos.CHANGES)]}", run, trial)
        reasons.clear()
        return trials

    def magnifying(run: Run, *rest: Any) -> bool:
        nonlocal latest
        latest = number[id(run)]
        magnified = magnifies(run, *rest)
        asked[latest] = "it magnifies errors of steps" if magnified else "an extreme before the peak changes"
        return magnified

    def wandering(trials: Sequence[Trial], *rest: Any) -> bool:
        last, before = trials[-1].outcome, trials[-2].outcome
        asked[latest] = "residuals" + (", slowly" if same_counts(last, before) else ", with other counts of events")
        return wanders(trials, *rest)

    def lingering(run: Run, *rest: Any) -> bool:
        asked[latest] = "it lingers near its unstable equilibrium"
        return lingers(run, *rest)

    def looking(some: Sequence[Run], outcomes: Any, doubtful: Any, *rest: Any) -> None:
        reasons.extend(asked[i] for i in doubtful)
        look(some, outcomes, doubtful, *rest)

    control: Any = error_control
    changes: Any = chaos
    control.try_all, changes.try_all = trying, under_changes
    control.magnifies, control.residuals_wander = magnifying, wandering
    control.lingers, control.look_for_chaos = lingering, looking
    try:
        run_all_to_tolerance(runs, TOLERANCE, QUIET_S, Stop())
    finally:
        control.try_all = changes.try_all = try_all
        control.magnifies, control.residuals_wander = magnifies, wanders
        control.lingers, control.look_for_chaos = lingers, look
    return found


def main(size: int = 8, base: str = "", seconds: float | None = None) -> list[str]:
    """Return the lines of the table; of the first ``seconds`` of the records only, if given."""
    motions = [
        motion if seconds is None else Motion(motion.name, motion.dt, motion.horizontal[: round(seconds / motion.dt)])
        for motion in read_motions([], fema=RECORDS).motions
    ]
    lines = ["| base | cause | runs in a hundred | steps / first runs |", "| --- | --- | --- | --- |"]
    for name in BASES:
        if base in ("", name):
            found = spent(batch(name, "none", motions, size))
            whole, runs = found.steps["first"], found.runs["first"]
            rows = [(cause, found.runs[cause], steps) for cause, steps in found.steps.most_common()]
            lines += [f"| {name} | {cause} | {100 * n / runs:.1f} | {steps / whole:.3f} |" for cause, n, steps in rows]
            lines.append(f"| {name} | all | | {sum(found.steps.values()) / whole:.2f} |")
    return lines


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=8)
    parser.add_argument("--base", choices=list(BASES), default="")
    arguments = parser.parse_args()
    print("\n".join(main(arguments.size, arguments.base)))
