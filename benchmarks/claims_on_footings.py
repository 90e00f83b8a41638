"""Do claimed errors on footings hold? Random hard cases, each run again on 80 and 160 strips at half the step.

    python benchmarks/claims_on_footings.py [--cases 400] [--seed 0] [--csv FILE]

Runs every case as `rockbatch run` does at its default tolerance of 10⁻⁴, and again on 80 and on 160 strips, at half the step
that was kept. Of the rows that claim an error,

  beyond  the result is farther than it claims from that on 160 strips, or from what both say of endless strips by order 1

Motions are those of rigid_survey.py but for cases by a hair, feet those of piers that stand: elastic, or of a strength of 1.3 to
20 weights, with dashpots and without, by either kinematics.
"""

import argparse
import csv
import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import rigid_survey
from independent.pool import Rng, log_uniform, one_of

from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import FootingBase, Pier
from rockbatch.simulation import run_all_to_tolerance
from rockbatch.simulation.runs import Run, Stop, run_all_fixed
from rockbatch.simulation.steps import first_substeps

TOLERANCE = 1e-4  # of α
QUIET_S = 2.0
STRIPS = (80, 160)
RESULTS = ("theta_max", "theta_res", "settlement")


@dataclass(frozen=True)
class Row:
    """One case: what it claims, and how far it is from a finer run (angles over α, settlements over α and the half-width)."""

    id: str
    status: str
    finer_status: str
    halvings: int
    claimed: tuple[float, ...]  # of RESULTS; NaN where nothing is claimed
    off: tuple[float, ...]

    def beyond(self, result: int) -> bool:
        """Whether a claim is broken."""
        return self.off[result] > self.claimed[result]


def a_foot(rng: Rng, pier: Pier) -> FootingBase:
    """Return a footing that holds the pier, most of them 1.2 to 10 times as stiff as that takes."""
    least = math.sqrt(3.0 * pier.gravity * pier.height) / (pier.p * pier.half_width)
    safety = one_of(rng, None, log_uniform(rng, 1.3, 3.0), log_uniform(rng, 2.0, 20.0))
    kinematics = str(one_of(rng, "first-order", "finite"))
    zeta = float(one_of(rng, 0.0, 0.05, 0.05, 0.2))  # type: ignore[arg-type]
    return FootingBase(least * log_uniform(rng, 1.2, 10.0), safety, zeta=zeta, kinematics=kinematics)  # type: ignore[arg-type]


def cases(count: int, seed: int) -> Iterator[tuple[str, Run]]:
    """The cases, with motions of all kinds but those that are made by another solver."""
    for kind in [kind for kind in rigid_survey.KINDS if kind != "by a hair"]:
        for number, case in enumerate(rigid_survey.cases(count, seed, kind)):
            if case.kind == kind:
                rng = np.random.default_rng([seed, 71, number, len(kind)])
                yield case.id, Run(case.pier, a_foot(rng, case.pier), case.motion)


def _values(outcome: Outcome, run: Run, ending: str = "") -> np.ndarray:
    """Return RESULTS over their scales, or their errors; NaN for none."""
    alpha = run.pier.alpha
    values = [getattr(outcome, name + ending) for name in RESULTS]
    scales = (alpha, alpha, alpha * run.pier.half_width)
    return np.array([math.nan if each is None else each / scale for each, scale in zip(values, scales, strict=True)])


def _on(run: Run, strips: int) -> Run:
    """Return ``run`` on that many strips."""
    return replace(run, base=replace(run.base, strips=strips))  # type: ignore[type-var]


def survey(count: int, seed: int) -> Iterator[Row]:
    """Run all cases and judge them."""
    made = list(cases(count, seed))
    runs = [run for _, run in made]
    outcomes = run_all_to_tolerance(runs, TOLERANCE, QUIET_S, Stop())
    kept = [i for i, outcome in enumerate(outcomes) if outcome is not None and outcome.status in ("ok", "overturned")]
    steps = [2 * outcomes[i].substeps for i in kept]  # type: ignore[union-attr]
    finer = [[_on(runs[i], strips) for i in kept] for strips in STRIPS]
    probes = [run_all_fixed(some, steps, QUIET_S, Stop()) for some in finer]
    for i, near, finest in zip(kept, *probes, strict=True):
        outcome, run = outcomes[i], runs[i]
        assert outcome is not None
        assert near is not None
        assert finest is not None
        value, at, other = (_values(each, run) for each in (outcome, finest, near))
        off = np.maximum(abs(value - at), abs(value - (2.0 * at - other)))
        first = first_substeps(run.pier, run.base, run.motion.dt)
        halvings = round(math.log2(outcome.substeps / first))
        yield Row(
            made[i][0], outcome.status, finest.status, halvings, tuple(_values(outcome, run, "_error")), tuple(off)
        )


def summary(rows: Sequence[Row]) -> list[str]:
    """Return what is printed at the end."""
    lines = ["| result | claims | beyond | off over claim: median, 99 %, most |", "| --- | --- | --- | --- |"]
    for result, name in enumerate(RESULTS):
        claims = [row for row in rows if not math.isnan(row.claimed[result])]
        ratios = [row.off[result] / row.claimed[result] for row in claims] or [math.nan]
        beyond, parts = (
            sum(row.beyond(result) for row in claims),
            (np.median(ratios), np.quantile(ratios, 0.99), max(ratios)),
        )
        lines.append(f"| {name} | {len(claims)} | {beyond} | {', '.join(f'{part:.2f}' for part in parts)} |")
    other = [row.id for row in rows if row.status != row.finer_status]
    halvings = sorted(Counter(row.halvings for row in rows).items())
    return [
        *lines,
        f"another end on the finer bed: {len(other)} of {len(rows)}",
        "halvings: " + ", ".join(f"{number} of {times}" for times, number in halvings),
    ]


def main() -> None:
    """Print the table, and every broken claim."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=400)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--csv", default="")
    options = parser.parse_args()
    rows = list(survey(options.cases, options.seed))
    print("\n".join(summary(rows)))
    for row in rows:
        for result, name in enumerate(RESULTS):
            if row.beyond(result):
                print(f"{row.id}: {name} ± {row.claimed[result]:.2e} is off by {row.off[result]:.2e}")
    if options.csv:
        with open(options.csv, "w", newline="") as file:
            csv.writer(file).writerows([[row.id, row.status, *row.claimed, *row.off] for row in rows])


if __name__ == "__main__":
    main()
