"""Do the errors of demands hold? A random pool with devices, each case held against runs with far smaller steps.

    python benchmarks/demand_claims.py [--base rigid|springs] [--cases 100] [--first 0] [--seed 67] [--tiny]

Case N of a seed has the generator (N, seed): a pier on rigid ground or on springs of any law, under three horizontal waves and
in two of three cases vertical ones, with one or two of a viscous, a rooted, a hysteretic and a friction damper, a tendon that may
yield and a stop; with --tiny the motion hardly lifts a pivot, or none. Each runs as `rockbatch run` does at its tolerance of
10⁻⁴, with forces, the work of devices and sections at three heights, and again with an eighth and a sixteenth of the step.

A claim is broken if a quantity differs from that of the finest run by more than the claimed share of it, of a hundredth of its
scale at least (`outcome.changes`), and by more than the two fine runs differ. Undecided are claims below what these differ by.
Claims of runs whose outcome or count of impacts the finest step changes are counted apart, as chaotic.
Ctrl-C ends the pool, and prints what has been counted.
"""

import argparse
import math
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np

import rockbatch as rb
from rockbatch.motions import Motion
from rockbatch.observers.devices_work.observe import OF_WORK, WorkOfDevices
from rockbatch.observers.forces.observe import PeaksOfForces
from rockbatch.observers.forces.peaks import OF_FORCES
from rockbatch.observers.sections.observe import ForcesInSections
from rockbatch.outcome.changes import FLOOR, OF_DEVICES, Sized, scales_of
from rockbatch.pier import Base, Pier, Restraint, problems
from rockbatch.simulation.error_control import CHANCE, run_to_tolerance
from rockbatch.simulation.observing import observed
from rockbatch.simulation.runs import Run, run_fixed
from rockbatch.simulation.sections import with_errors

DT, DURATION, QUIET_S = 0.01, 2.5, 0.5
TOLERANCE = 1e-4
REFINED = (8, 16)
HEIGHTS = (0.0, 0.4, 0.8)
"""Of sections, as shares of the height of the pier."""
ROUNDING = 1e-9
"""Share of a quantity that the finest run may be off by itself."""
SECTION = {
    name: Sized((name,), "moment" if name == "moment" else "force")
    for name in ("shear", "moment", "axial_least", "axial_greatest")
}
DEVICES = ("viscous", "root", "hysteretic", "friction", "tendon", "stop")
LAWS = ("elastic", "damped", "bouc-wen", "epp", "hardening")


class Claim(NamedTuple):
    """A quantity of one case: what is claimed, and what is true of it, as shares of its size."""

    name: str
    error: float  # that is claimed
    true: float
    doubt: float  # of the true one
    chaotic: bool

    def __str__(self) -> str:
        """Return the claim in words."""
        return f"{self.name} off by {self.true:.1e} ± {self.doubt:.0e}, claimed {self.error:.1e}"

    @property
    def verdict(self) -> str:
        """Return whether the claim holds, is broken or is undecided."""
        if self.true <= self.error + ROUNDING:
            return "holds"
        if self.true <= self.error + 2.0 * self.doubt + ROUNDING:
            return "undecided"
        return "chaotic" if self.chaotic else "broken"


def waves(rng: np.random.Generator, low: float, high: float) -> np.ndarray:
    """Return three waves of a peak of 1 that grow from nothing; their frequencies [Hz] are between ``low`` and ``high``."""
    t = np.arange(0.0, DURATION, DT)
    made = sum(
        rng.uniform(0.3, 1.0) * np.sin(2.0 * math.pi * rng.uniform(low, high) * t + rng.uniform(0.0, 6.28))
        for _ in range(3)
    )
    return np.minimum(1.0, t / 0.3) * made / np.abs(made).max()


def device(kind: str, rng: np.random.Generator) -> Restraint:
    """Return a device of random size."""
    if kind == "hysteretic":
        return rb.Damper(kind, f=rng.uniform(0.02, 0.3), yield_m=rng.uniform(0.001, 0.01), confirm=("f", "yield_m"))
    if kind == "friction":
        return rb.Damper(kind, f=rng.uniform(0.02, 0.2), confirm=("f",))
    if kind == "tendon":
        psi = rng.uniform(0.0, 0.4)
        strength = psi + rng.uniform(0.05, 0.6) if rng.random() < 0.5 else math.inf
        return rb.Tendon(psi=psi, lam=rng.uniform(0.03, 1.0), strength=strength)
    if kind == "stop":
        gap = math.exp(rng.uniform(math.log(0.0005), math.log(0.1)))
        return rb.Stop(gap_m=gap, lam=rng.uniform(1.0, 20.0), restitution=rng.uniform(0.3, 1.0))
    strong, exponent = (0.6, 1.0) if kind == "viscous" else (0.3, 0.5)
    return rb.Damper("viscous", nu=rng.uniform(0.05, strong), exponent=exponent, confirm=("nu",))


def base_of(kind: str, rng: np.random.Generator, pier: Pier) -> Base:
    """Return a base with devices."""
    kinds = rng.choice(DEVICES, size=rng.integers(1, 3), replace=False)
    common: dict[str, Any] = {"flight": "guided", "restraints": tuple(device(str(each), rng) for each in kinds)}
    if kind == "rigid":
        return rb.RigidBase(**common)
    law, epsilon = str(rng.choice(LAWS)), float(rng.choice([0.0, 0.1, 0.3]))
    beta = max(math.exp(rng.uniform(math.log(5.0), math.log(60.0))), 1.5 * pier.least_beta)
    common["kinematics"] = str(rng.choice(["first-order", "finite"]))
    if law == "damped":
        return rb.ElasticBase(beta, zeta=rng.uniform(0.02, 0.2), **common)
    if law == "elastic":
        return rb.ElasticBase(beta, epsilon=epsilon, **common)
    return rb.YieldingBase(beta, epsilon=epsilon, eta=rng.uniform(1.8, 5.0), spring=law, **common)


def case(kind: str, number: int, seed: int, tiny: bool) -> Run:
    """Return the case of this number."""
    rng = np.random.default_rng([number, seed])
    pier = rb.Pier(alpha=rng.uniform(0.1, 0.35), p=rng.uniform(0.5, 1.5))
    base = base_of(kind, rng, pier)
    lifts = 9.81 * math.tan(pier.alpha)
    share = (1.0 + math.exp(rng.uniform(math.log(1e-3), math.log(0.3)))) if tiny else rng.uniform(1.2, 3.0)
    if tiny and kind != "rigid":
        share = math.exp(rng.uniform(math.log(0.02), math.log(1.2)))
    across, up = waves(rng, 0.4, 3.0), waves(rng, 1.5, 9.0)
    vertical = None if rng.random() < 1.0 / 3.0 else rng.uniform(0.1, 0.9) * 9.81 * up * (0.2 if tiny else 1.0)
    return Run(pier, base, Motion(f"waves {number}", DT, share * lifts * across, vertical))


class SectionsAlone(ForcesInSections):
    """Forces in sections as they are, not as rows of a table."""

    def add(self, run: Run, outcome: Any, fine: Any, coarse: Any) -> Any:
        """See :class:`Observer`."""
        return outcome.with_table(self.table, fine if coarse is None else with_errors(fine, coarse, run.pier, CHANCE))


def demands(run: Run, outcome: Any, error: bool) -> tuple[Any, list[Any]]:
    """Return the outcome with forces and the work of devices, and the forces in sections."""
    heights = tuple(share * 2.0 * run.pier.height for share in HEIGHTS)
    observers = (PeaksOfForces(0.1), WorkOfDevices(0.02), SectionsAlone(heights))
    (found,) = observed([run], [outcome], observers, QUIET_S, error=error)
    return found, found.tables[SectionsAlone.table]


def sizes(of: Any, quantities: Mapping[str, Sized]) -> Iterator[tuple[str, str, tuple[float, ...]]]:
    """Yield the name, the scale and the fields of each quantity that ``of`` has."""
    for name, (fields, scale) in quantities.items():
        values = [getattr(of, field) for field in fields]
        if any(value is not None for value in values):
            yield name, scale, tuple(value or 0.0 for value in values)


def compared(
    group: str, results: tuple[Any, ...], quantities: Mapping[str, Sized], error: float | None, about: tuple
) -> Iterator[Claim]:
    """Yield the claims of one ``error``: of the first of ``results``, by the other two."""
    pier, chaotic = about
    if error is None:
        return
    found, fine, finest = (dict((name, rest) for name, *rest in sizes(of, quantities)) for of in results)
    for name, (scale, values) in found.items():
        if name not in finest or name not in fine:
            yield Claim(f"{group}{name}", error, math.inf, 0.0, chaotic)
            continue
        size = max(*map(abs, values), FLOOR * scales_of(pier)[scale])

        def away(first: tuple[float, ...], second: tuple[float, ...], size: float = size) -> float:
            return max(abs(a - b) for a, b in zip(first, second, strict=True)) / size

        yield Claim(
            f"{group}{name}", error, away(values, finest[name][1]), away(fine[name][1], finest[name][1]), chaotic
        )


def judge(run: Run) -> list[Claim]:
    """Return the claims of a case."""
    outcome = run_to_tolerance(run.pier, run.base, run.motion, TOLERANCE, QUIET_S)
    if outcome.status not in ("ok", "flight"):
        return []
    found, sections = demands(run, outcome, True)
    fine = [run_fixed(run.pier, run.base, run.motion, factor * outcome.substeps, QUIET_S) for factor in REFINED]
    refined = [demands(run, each, False) for each in fine]
    last = refined[-1][0]
    chaotic = (last.status, last.impacts) != (found.status, found.impacts)
    chaotic = chaotic or abs(last.theta_max - found.theta_max) > TOLERANCE * run.pier.alpha
    about = (run.pier, chaotic)
    outcomes = (found, *(each for each, _ in refined))
    claims = list(compared("", outcomes, OF_DEVICES, found.devices_error, about))
    work, forces = ([each.observed.get(name) for each in outcomes] for name in ("devices_work", "forces"))
    claims += compared("", tuple(work), OF_WORK, found.devices_error, about)
    claims += compared("", tuple(forces), OF_FORCES, forces[0].error, about)
    for share, *section in zip(HEIGHTS, sections, *(each for _, each in refined), strict=True):
        claims += compared(f"section {share:g} ", tuple(section), SECTION, section[0].error, about)
    return claims


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--base", choices=("rigid", "springs"), default="rigid")
    parser.add_argument("--cases", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=67)
    parser.add_argument("--tiny", action="store_true", help="motions that hardly lift a pivot")
    arguments = parser.parse_args()
    counts, most, rows, tried = Counter[tuple[str, str]](), dict[str, float](), 0, 0
    with suppress(KeyboardInterrupt):
        for number in range(arguments.first, arguments.first + arguments.cases):
            run = case(arguments.base, number, arguments.seed, arguments.tiny)
            claims = [] if problems(run.pier, run.base) else judge(run)
            tried, rows = tried + 1, rows + bool(claims)
            counts.update((claim.name, claim.verdict) for claim in claims)
            for claim in claims:
                if claim.verdict in ("holds", "broken"):
                    most[claim.name] = max(most.get(claim.name, 0.0), claim.true / (claim.error + ROUNDING))
                if claim.verdict == "broken":
                    print(f"{number}: {claim}", flush=True)
    print(f"{rows} of {tried} cases claim errors")
    print("| quantity | claims | broken | undecided | chaotic | greatest true over claimed |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name in dict.fromkeys(name for name, _ in counts):
        verdicts = [counts[name, verdict] for verdict in ("holds", "broken", "undecided", "chaotic")]
        print(
            f"| {name} | {sum(verdicts)} | {verdicts[1]} | {verdicts[2]} | {verdicts[3]} | {most.get(name, 0.0):.2g} |"
        )


if __name__ == "__main__":
    main()
