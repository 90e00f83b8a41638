"""Do claimed errors hold? Pools of random hard cases, each run again under motions that differ by less than a record resolves.

    python benchmarks/claims.py [--base rigid|springs] [--cases 2000] [--seed 0] [--repeats 0] [--csv FILE]

Runs every case as `rockbatch run` does at its default tolerance of 10⁻⁴, and again at the step that was kept under motions
±10⁻⁸ and ±3·10⁻⁹ stronger. Of the rows that claim an error:

  beyond    the result moves by more than the claimed error and the tolerance together, or the outcome changes

θ_max and θ_res are held to the tolerance times α, settlements to that times the half-width. Rows that claim an error of
residuals on yielding springs are run with zeros behind the motion, too, as long as the interval between two readings: what
that changes is to be within the errors of both.

With --repeats 3 the time of the whole pool with and without the error control's own changed motions is measured, in turn.
The cases are those of rigid_survey.py, or the springs of outcomes.py, but for those that a reference scales to overturning.
"""

import argparse
import csv
import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

import numpy as np
import rigid_survey
from independent import pool

from rockbatch.motions import Motion
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Base, Pier
from rockbatch.simulation import chaos, run_all_to_tolerance
from rockbatch.simulation.runs import Run, Stop, run_all_fixed
from rockbatch.simulation.steps import readings

TOLERANCE = 1e-4
CHANGES = (1e-8, -1e-8, 3e-9, -3e-9)
QUIET_S = 2.0
GROUP = 256
RESULTS = ("theta_max", "theta_res", "settlement")


@dataclass(frozen=True)
class Row:
    """One case: what it claims, and what changed motions move it by (angles over α, settlements over α and the half-width)."""

    id: str
    status: str
    theta_max: float
    claimed: tuple[float, float, float]  # of RESULTS; NaN where nothing is claimed
    moved: tuple[float, float, float]  # at most
    overturns: bool
    zeros: tuple[float, float]  # change of θ_res and settlement by zeros behind the motion, over the errors of both
    substeps: int
    note: str

    def beyond(self, result: int) -> bool:
        """Whether a claim is broken by more than the tolerance."""
        return not self.moved[result] <= self.claimed[result] + TOLERANCE and not math.isnan(self.claimed[result])


def cases(base: str, count: int, seed: int) -> Iterator[tuple[str, Pier, Base, Motion]]:
    """The pool, without the cases that are scaled by a reference."""
    if base == "rigid":
        made = rigid_survey.KINDS.items()
        for kind in [kind for kind, _ in made if kind != "by a hair"]:
            yield from (
                (c.id, c.pier, c.base, c.motion) for c in rigid_survey.cases(count, seed, kind) if c.kind == kind
            )
        return
    for case in pool.cases(count, seed):
        if case.hair is None and case.base.on_springs:
            yield case.id, case.pier, case.base, case.motion


def _scales(pier: Pier) -> tuple[float, float, float]:
    return pier.alpha, pier.alpha, pier.alpha * pier.half_width


def _value(outcome: Outcome, name: str) -> float:
    value = getattr(outcome, name)
    return math.nan if value is None else value


def judge(case_id: str, pier: Pier, outcome: Outcome, probes: Sequence[Outcome], padded: Outcome | None) -> Row:
    """Return the row of a case."""

    def of(name: str, scale: float) -> float:
        return max(abs(_value(probe, name) - _value(outcome, name)) for probe in probes) / scale

    def over_errors(name: str) -> float:
        if padded is None or _value(padded, f"{name}_error") != _value(padded, f"{name}_error"):
            return math.nan
        errors = _value(outcome, f"{name}_error") + _value(padded, f"{name}_error")
        return abs(_value(padded, name) - _value(outcome, name)) / errors

    scales = _scales(pier)
    return Row(
        case_id, outcome.status, outcome.theta_max / pier.alpha,
        tuple(_value(outcome, f"{name}_error") / scale for name, scale in zip(RESULTS, scales, strict=True)),  # type: ignore[arg-type]
        tuple(of(name, scale) for name, scale in zip(RESULTS, scales, strict=True)),  # type: ignore[arg-type]
        any(probe.status != outcome.status for probe in probes),
        (over_errors("theta_res"), over_errors("settlement")), outcome.substeps, outcome.reason or outcome.note,
    )  # fmt: skip


def survey(base: str, count: int, seed: int) -> Iterator[Row]:
    """Run all cases in groups and judge them."""
    made = cases(base, count, seed)
    while group := list(islice(made, GROUP)):
        runs = [Run(pier, base, motion) for _, pier, base, motion in group]
        outcomes = run_all_to_tolerance(runs, TOLERANCE, QUIET_S, Stop())
        kept = [i for i, outcome in enumerate(outcomes) if outcome is not None and outcome.status in ("ok", "flight")]
        substeps = [outcomes[i].substeps for i in kept]  # type: ignore[union-attr]
        probes = [
            run_all_fixed(
                [replace(runs[i], motion=runs[i].motion.times(1.0 + change)) for i in kept], substeps, QUIET_S, Stop()
            )
            for change in CHANGES
        ]
        reads = [i for i in kept if runs[i].base.yields and outcomes[i].theta_res_error is not None]  # type: ignore[union-attr]
        longer = run_all_to_tolerance(
            [replace(runs[i], motion=_with_zeros(runs[i])) for i in reads], TOLERANCE, QUIET_S, Stop()
        )
        padded = dict(zip(reads, longer, strict=True))
        for place, i in enumerate(kept):
            yield judge(group[i][0], group[i][1], outcomes[i], [of[place] for of in probes], padded.get(i))  # type: ignore[arg-type,misc]


def _with_zeros(run: Run) -> Motion:
    """Return the motion of a run with zeros behind it, as long as the interval between two readings of residuals."""
    motion = run.motion
    zeros = np.zeros(readings(run.pier, run.base, motion.dt)[1])
    vertical = None if motion.vertical is None else np.append(motion.vertical, zeros)
    return Motion(motion.name, motion.dt, np.append(motion.horizontal, zeros), vertical)


def summary(rows: Sequence[Row]) -> list[str]:
    """Return what is printed at the end."""
    lines = [
        "| result | claims | beyond | greatest move within it | zeros beyond the errors |",
        "| --- | --- | --- | --- | --- |",
    ]
    for result, name in enumerate(RESULTS):
        claims = [row for row in rows if not math.isnan(row.claimed[result])]
        if not claims:
            continue
        beyond = [row for row in claims if row.beyond(result) or (result == 0 and row.overturns)]
        least = [row.moved[result] for row in claims if row not in beyond]
        zeros = [row.zeros[result - 1] for row in claims if result and not math.isnan(row.zeros[result - 1])]
        late = f"{sum(ratio > 1.0 for ratio in zeros)} of {len(zeros)}" if zeros else ""
        lines.append(f"| {name} | {len(claims)} | {len(beyond)} | {max(least, default=math.nan):.1e} | {late} |")
    return lines


def complaint(row: Row) -> str:
    """Return a row in a line."""
    numbers = "; ".join(
        f"{name} ± {claimed:.1e} moves by {moved:.1e}"
        for name, claimed, moved in zip(RESULTS, row.claimed, row.moved, strict=True)
    )
    return f"{row.id}: {row.status} {row.theta_max:.6g}, {numbers}; k = {row.substeps} {row.note}"


def cost(base: str, count: int, seed: int, repeats: int) -> str:
    """Return what the error control's changed motions add to the time of the pool."""
    runs = [Run(pier, base, motion) for _, pier, base, motion in cases(base, count, seed)]
    times: dict[bool, list[float]] = {True: [], False: []}
    changes = chaos.CHANGES
    for _ in range(repeats + 1):  # the first compiles
        for probed in (True, False):
            chaos.CHANGES = changes if probed else {}
            start = time.process_time()
            run_all_to_tolerance(runs, TOLERANCE, QUIET_S, Stop())
            times[probed].append(time.process_time() - start)
    chaos.CHANGES = changes
    whole, without = min(times[True][1:]), min(times[False][1:])
    return f"{whole:.2f} s with changed motions, {without:.2f} s without: {whole / without - 1.0:.1%}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--base", choices=("rigid", "springs"), default="rigid")
    parser.add_argument("--cases", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--repeats", type=int, default=0, help="of the measurement of time; 0 for none")
    parser.add_argument("--csv", type=Path, help="write every row to this file")
    arguments = parser.parse_args()
    rows = []
    for row in survey(arguments.base, arguments.cases, arguments.seed):
        rows.append(row)
        if row.overturns or any(row.beyond(result) for result in range(len(RESULTS))):
            print(complaint(row), flush=True)
    if arguments.csv:
        with open(arguments.csv, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(Row.__annotations__)
            writer.writerows(vars(row).values() for row in rows)
    print("\n".join(["", *summary(rows)]))
    if arguments.repeats:
        print(cost(arguments.base, arguments.cases, arguments.seed, arguments.repeats))


if __name__ == "__main__":
    main()
