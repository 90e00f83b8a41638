"""The steps of a run that a model needs, by its greatest rate, and the times for which it is followed."""

import math
from functools import lru_cache

from rockbatch.core.devices.laws import HYSTERETIC, MAXWELL, SPRING, TENDON, VISCOUS
from rockbatch.pier import Base, Pier, YieldingBase, rocking_frequency, vertical_frequency
from rockbatch.pier.vibration import greatest_rate, greatest_rate_of_shaft
from rockbatch.simulation.elements import STEEP, accelerance, elements

FREQUENCY_STEP = 0.2
"""Largest ω h of a first run; the second, with half the step, has at most 0.1, where outcomes were never wrong."""

FIRST_ON_ROCK = 2
"""Least steps per sample of a first run on a rigid base. With one, that run and the next may take the same sub-steps, since
both restart at every impact, and agree by chance."""

STABLE_STEP = 2.0
"""Largest ω h that is run at all: Runge–Kutta 4 is unstable for an oscillator beyond 2√2."""

PATIENCE = 40.0
"""Longest time after the record, in 1/p, for which a run continues while its energy allows a greater rotation or overturning.
By then it has left any unstable equilibrium that rounding can hold."""

READ_AFTER = 5.0
"""Periods 2π/ω_v of vertical vibration between the end of the record and the reading of residuals."""


@lru_cache(maxsize=4096)
def fastest_rate(pier: Pier, base: Base) -> float:
    """Return the greatest rate [1/s] of a model: of springs, vibration against devices, or decay by linear dampers.

    On rigid ground with a viscous damper of exponent < 1 it is at least STEEP p.
    """
    stiff, slows, relaxes, steep = 0.0, 0.0, 0.0, False
    for law in elements(pier, base):
        lever = accelerance(pier, base, law)
        steel = law.strength / (1.0 + law.give) if law.kind == HYSTERETIC else 0.0
        stiff += lever * law.stiffness * (steel or law.kind in (TENDON, SPRING, MAXWELL))
        slows += lever * law.coefficient if law.kind == VISCOUS else 0.0
        steep = steep or (law.kind == VISCOUS and law.exponent < 1.0)
        relaxes = max(relaxes, law.quickest if law.kind == MAXWELL and law.exponent == 1.0 else 0.0)
    if base.on_springs:
        return max(math.hypot(greatest_rate(pier, base), math.sqrt(stiff)), 2.0 * slows, relaxes)
    if base.bends:
        stiff += greatest_rate_of_shaft(pier, base, pier.inertia_about_pivot) ** 2
    return max(math.sqrt(stiff), STEEP * pier.p if steep else slows, relaxes)


def first_substeps(pier: Pier, base: Base, dt: float) -> int:
    """Return the steps per sample of ``dt`` [s] of a first run: with the model's fastest rate ω, ω h ≤ :data:`FREQUENCY_STEP`.

    One at least, on a rigid base two.
    """
    return max(_substeps_for(FREQUENCY_STEP, pier, base, dt), 1 if base.on_springs else FIRST_ON_ROCK)


def least_substeps(pier: Pier, base: Base, dt: float) -> int:
    """Return the least steps per sample of ``dt`` [s] with which the integration is stable, ω h ≤ :data:`STABLE_STEP`."""
    return _substeps_for(STABLE_STEP, pier, base, dt)


def _substeps_for(largest: float, pier: Pier, base: Base, dt: float) -> int:
    return max(1, math.ceil(fastest_rate(pier, base) * dt / largest - 1e-9))


def patience(pier: Pier, dt: float) -> int:
    """Return the greatest number of samples of ``dt`` [s] after the record: those of 40/p (:data:`PATIENCE`), and one more."""
    return int(PATIENCE / (pier.p * dt)) + 1


@lru_cache(maxsize=4096)
def readings(pier: Pier, base: Base, dt: float) -> tuple[int, int]:
    """Return the samples of ``dt`` [s] from the record's end to the first reading of residuals, and from that to the second.

    The first comes :data:`READ_AFTER` periods of vertical vibration after the record; the second, at least as long after the
    first, gives their drift over whole periods of full-contact rocking. 0 and 0 on other bases than yielding springs.
    """
    if not isinstance(base, YieldingBase):
        return 0, 0
    interval = READ_AFTER * 2.0 * math.pi / vertical_frequency(pier, base)
    rocking = 2.0 * math.pi / rocking_frequency(pier, base)
    return math.ceil(interval / dt), math.ceil(math.ceil(interval / rocking) * rocking / dt)
