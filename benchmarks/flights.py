"""Are flights, impacts and separations counted right where devices act? A random pool, counted by solvers of the tests.

    python benchmarks/flights.py [--base rigid|springs] [--cases 60] [--first 0]

Case N has the seeds N, 67 and N, 68: a pier under three horizontal and three vertical waves, strong enough for it to fly, with
one or two of a viscous, a viscous with the exponent 0.5 and a hysteretic damper, a tendon and a stop; on springs also friction
dampers. The counters share nothing with the program (tests/helpers/flying_reference.py on rigid ground, restrained_reference.py
on springs).
Runs take eight times the least steps and end with the motion. Left out are runs whose peaks differ (chaos), and the impacts of
those that come to rest, of which either solver follows another number of the last ones.
"""

import argparse
import math
import sys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1] / "tests" / "helpers"))

from flying_reference import TiedBlock
from restrained_reference import TiedTwoSprings

import rockbatch as rb
from rockbatch.motions import Motion
from rockbatch.pier import Base, Pier, Restraint, problems
from rockbatch.simulation import run_fixed
from rockbatch.simulation.steps import first_substeps

DT, DURATION = 0.01, 3.0
REFINED = 8
SAME_PEAK = 1e-5  # of α
DEVICES = ("viscous", "root", "hysteretic", "tendon", "stop")
SPRINGS = ("elastic", "damped", "bouc-wen", "epp", "hardening")


@dataclass(frozen=True)
class Row:
    """A case, with what the program and the counter counted: flights, impacts, separations."""

    number: int
    devices: str
    found: tuple[int, int, int]
    true: tuple[int, int, int]
    same_peak: bool
    rested: bool

    @property
    def wrong(self) -> list[str]:
        """Return which counts differ."""
        names = ["flights"] if self.rested else ["flights", "impacts", "separations"]
        return [name for name, found, true in zip(names, self.found, self.true, strict=False) if found != true]


def motion_of(rng: np.random.Generator, alpha: float, number: int) -> Motion:
    """Return three horizontal and three vertical waves that tilt and lift a pier."""
    t = np.arange(0.0, DURATION, DT)

    def waves(low: float, high: float) -> np.ndarray:
        return sum(
            rng.uniform(0.3, 1.0) * np.sin(2 * math.pi * rng.uniform(low, high) * t + rng.uniform(0.0, 6.28))
            for _ in range(3)
        )

    across, up = waves(0.4, 3.0), waves(1.5, 9.0)
    across *= rng.uniform(1.2, 3.0) * 9.81 * math.tan(alpha) / abs(across).max()
    up *= rng.uniform(0.6, 1.6) * 9.81 / abs(up).max()
    shape = np.minimum(1.0, t / 0.3)
    return Motion(f"waves {number}", DT, across * shape, up * shape)


def device(kind: str, rng: np.random.Generator) -> Restraint:
    """Return a device of random size."""
    if kind == "hysteretic":
        return rb.Damper(kind, f=rng.uniform(0.02, 0.3), yield_m=rng.uniform(0.002, 0.01), confirm=("f", "yield_m"))
    if kind == "tendon":
        return rb.Tendon(psi=rng.uniform(0.0, 0.4), lam=rng.uniform(0.05, 1.0))
    if kind == "stop":
        return rb.Stop(gap_m=rng.uniform(0.02, 0.1), lam=rng.uniform(1.0, 20.0), restitution=rng.uniform(0.3, 1.0))
    strong, exponent = (0.6, 1.0) if kind == "viscous" else (0.3, 0.5)
    return rb.Damper("viscous", nu=rng.uniform(0.05, strong), exponent=exponent, confirm=("nu",))


def springs(rng: np.random.Generator, pier: Pier, devices: tuple[Restraint, ...]) -> Base:
    """Return springs of a random law and size under a pier with ``devices``, and perhaps friction dampers."""
    kind, beta = str(rng.choice(SPRINGS)), max(rng.uniform(20.0, 80.0), 1.5 * pier.least_beta)
    common = {"kinematics": str(rng.choice(["first-order", "finite"])), "flight": "guided", "restraints": devices}
    base: Base
    if kind == "damped":
        base = rb.ElasticBase(beta, zeta=rng.uniform(0.02, 0.2), **common)
    elif kind == "elastic":
        base = rb.ElasticBase(beta, epsilon=float(rng.choice([0.0, 0.1, 0.3])), **common)
    else:
        epsilon = float(rng.choice([0.0, 0.1, 0.3]))
        base = rb.YieldingBase(beta, epsilon=epsilon, eta=rng.uniform(2.5, 5.0), spring=kind, **common)
    if rng.random() < 0.4:
        base = replace(base, restraints=(*devices, rb.Damper("friction", f=rng.uniform(0.02, 0.1), confirm=("f",))))
    return base


def case(number: int, on_springs: bool) -> tuple[Pier, Base, Motion]:
    """Return the case of this number."""
    rng = np.random.default_rng([number, 67])
    pier = rb.Pier(alpha=rng.uniform(0.1, 0.35), p=rng.uniform(0.5, 1.5))
    motion = motion_of(rng, pier.alpha, number)
    kinds = rng.choice(DEVICES, size=rng.integers(1, 3), replace=False)
    devices = tuple(device(str(kind), rng) for kind in kinds)
    base = (
        springs(np.random.default_rng([number, 68]), pier, devices) if on_springs else rb.RigidBase(restraints=devices)
    )
    return pier, base, motion


class CountingSprings(TiedTwoSprings):
    """A pier on springs that counts its flights."""

    flights, rested, is_up = 0, False, False

    def _fire(self, *event) -> None:
        super()._fire(*event)
        was_up, self.is_up = self.is_up, self.mode == ["free", "free"]
        self.flights += self.is_up and not was_up


def judge(number: int, on_springs: bool) -> Row:
    """Run a case and count its events."""
    pier, base, motion = case(number, on_springs)
    found = run_fixed(pier, base, motion, REFINED * first_substeps(pier, base, DT), quiet_s=0.0, wait=False)
    counter = CountingSprings(pier, base, motion, 0.0) if on_springs else TiedBlock(pier, base, motion)
    true = counter.run()
    flights = counter.flights if on_springs else len(counter.flights)
    return Row(
        number, ", ".join(getattr(each, "kind", type(each).__name__.lower()) for each in base.restraints),
        (found.flights, found.impacts, found.separations), (flights, true.impacts, true.separations),
        abs(found.theta_max - true.theta_max) < SAME_PEAK * pier.alpha, counter.rested,
    )  # fmt: skip


def survey(first: int, count: int, on_springs: bool) -> Iterator[Row]:
    """Judge the cases that are possible."""
    for number in range(first, first + count):
        pier, base, _ = case(number, on_springs)
        if not problems(pier, base):
            yield judge(number, on_springs)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--base", choices=("rigid", "springs"), default="rigid")
    parser.add_argument("--cases", type=int, default=60)
    parser.add_argument("--first", type=int, default=0)
    arguments = parser.parse_args()
    rows = []
    for row in survey(arguments.first, arguments.cases, arguments.base == "springs"):
        rows.append(row)
        if row.wrong and row.same_peak:
            print(f"{row.number} ({row.devices}): {', '.join(row.wrong)}: {row.found}, true {row.true}", flush=True)
    compared = [row for row in rows if row.same_peak]
    print(f"{len(compared)} of {len(rows)} compared, {sum(row.true[0] > 0 for row in compared)} of them fly")
    for name in ("flights", "impacts", "separations"):
        kept = compared if name == "flights" else [row for row in compared if not row.rested]
        print(f"{name} wrong in {sum(name in row.wrong for row in kept)} of {len(kept)}")


if __name__ == "__main__":
    main()
