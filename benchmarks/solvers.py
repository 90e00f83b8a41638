"""One stepping tower, one record, one accuracy: rockbatch beside general ODE solvers.

    python benchmarks/solvers.py [--repeats 3]

The tower of Palmeri & Makris (2007), Fig. 7, on springs under the record RRS 228 (20 s, 0.01 s, and 2 s of quiet).
Every solver has the loosest tolerance, by powers of ten, from which on its error of θ_max/α is at most 1e-4, against a
run of rockbatch with a step so fine that halving it changes nothing any more. Compilation is not timed. Solvers that
are not installed say so: pip install scikit-sundae heyoka
"""

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec

from interleaved import Times, interleaved, machine, ratio
from peers import Rocking, Solve, cvode, heyoka, scipy
from tower import QUIET_S, TOWER, foundations, record

from rockbatch.analyses.accuracy.error_and_time import reference
from rockbatch.motions import Motion
from rockbatch.outcome.outcome import Outcome
from rockbatch.pier import YieldingBase
from rockbatch.results.columns import StudyRun
from rockbatch.simulation import Run, Stop, run_all_fixed, run_all_to_tolerance
from rockbatch.study import Case

BASE = YieldingBase(80.0, 0.05, flight="stop", eta=2.5)
ACCURACY = 1e-4  # of α
LADDER = [10.0**-i for i in range(3, 13)]
REFERENCES = 16  # of the runs side by side

UNIT = "rockbatch, one run to its tolerance"


@dataclass(frozen=True)
class Contender:
    """A solver ready to run, how many runs that is, and its largest error of θ_max/α."""

    setting: str
    task: Callable[[], object]
    runs: int
    error: float


def truth(motion: Motion, base: YieldingBase) -> float:
    """θ_max [rad] of the pier on ``base``, converged."""
    found = reference(StudyRun(motion, "+", 1.0, Case("", TOWER, base, {})), QUIET_S)
    if found is None or found.outcome.status != "ok":
        raise SystemExit("this run does not converge: there is nothing to measure errors against")
    return found.outcome.theta_max


def loosest(make: Callable[[float], Solve], theta_max: float) -> Contender | None:
    """The solver with the loosest tolerance that is accurate enough, and still is with a tenth of it."""
    before: Contender | None = None
    for tolerance in LADDER:
        task = make(tolerance)
        status, found = task()
        error = abs(found - theta_max) / TOWER.alpha
        good = status == "ok" and error <= ACCURACY
        if good and before is not None:
            return before
        before = Contender(f"rtol {tolerance:.0e}", task, 1, error) if good else None
    return before


def rockbatch_contenders(motion: Motion, theta_max: float, side_by_side: int) -> dict[str, Contender]:
    """rockbatch: one run, and many side by side, to the tolerance and with one step per sample."""
    bases = foundations(side_by_side)
    runs = [Run(TOWER, base, motion) for base in bases]
    chosen = range(0, side_by_side, max(1, side_by_side // REFERENCES))
    truths = [truth(motion, bases[i]) for i in chosen]

    def to_tolerance(runs: list[Run]) -> list[Outcome | None]:
        return run_all_to_tolerance(runs, ACCURACY, QUIET_S, Stop())

    def fixed(runs: list[Run]) -> list[Outcome | None]:
        return run_all_fixed(runs, [1] * len(runs), QUIET_S, Stop())

    def largest(outcomes: list[Outcome | None]) -> float:
        found = [outcomes[i].theta_max for i in chosen]  # type: ignore[union-attr]
        return max(abs(a - b) for a, b in zip(found, truths, strict=True)) / TOWER.alpha

    tower = [Run(TOWER, BASE, motion)]
    one_error = abs(to_tolerance(tower)[0].theta_max - theta_max) / TOWER.alpha  # type: ignore[union-attr]
    together = f"rockbatch, {side_by_side} side by side"
    return {
        UNIT: Contender(f"tolerance {ACCURACY:.0e}", partial(to_tolerance, tower), 1, one_error),
        f"{together}, to their tolerance": Contender(
            f"tolerance {ACCURACY:.0e}", partial(to_tolerance, runs), side_by_side, largest(to_tolerance(runs))
        ),
        f"{together}, fixed step": Contender("1 per sample", partial(fixed, runs), side_by_side, largest(fixed(runs))),
    }


def row(name: str, contender: Contender | None, times: dict[str, Times], missing: str) -> str:
    """Line of the table."""
    if contender is None:
        return f"| {name} | {missing} | | | | |"
    per_run = min(times[name]) / contender.runs
    over = ratio(times[name], times[UNIT], 1.0 / contender.runs)
    return f"| {name} | {contender.setting} | {1e3 * per_run:.3g} ms | {contender.error:.1e} | {over} |"


def main(repeats: int = 3, side_by_side: int = 256, seconds: float | None = None) -> list[str]:
    """Lines of the table; of the first ``seconds`` of the record only, if given."""
    motion = record(seconds)
    theta_max = truth(motion, BASE)
    rocking = Rocking(TOWER, BASE, motion, QUIET_S)

    peers: dict[str, tuple[str, Callable[[float], Solve]]] = {
        "SciPy DOP853": ("scipy", lambda tolerance: scipy(rocking, tolerance, "DOP853")),
        "SciPy LSODA": ("scipy", lambda tolerance: scipy(rocking, tolerance, "LSODA")),
        "SUNDIALS CVODE, Adams": ("sksundae", lambda tolerance: cvode(rocking, tolerance, "Adams")),
        "SUNDIALS CVODE, BDF": ("sksundae", lambda tolerance: cvode(rocking, tolerance, "BDF")),
        "heyoka, Taylor": ("heyoka", lambda tolerance: heyoka(rocking, tolerance)),
    }
    contenders: dict[str, Contender | None] = dict(rockbatch_contenders(motion, theta_max, side_by_side))
    for name, (module, make) in peers.items():
        contenders[name] = loosest(make, theta_max) if find_spec(module) else None
    times = interleaved({name: one.task for name, one in contenders.items() if one is not None}, repeats)
    missing = {
        name: "not accurate enough" if find_spec(module) else "not installed" for name, (module, _) in peers.items()
    }
    return [
        "| solver | setting | per run | error of θ_max/α | ratio to one run of rockbatch: best | median |",
        "| --- | --- | --- | --- | --- | --- |",
        *(row(name, one, times, missing.get(name, "")) for name, one in contenders.items()),
    ]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=3)
    arguments = parser.parse_args()
    print(machine("scipy", "scikit-sundae", "heyoka"))
    print("\n".join(main(arguments.repeats)))
