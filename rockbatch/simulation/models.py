"""The core's numbers for piers, bases and motions, and the steps that these need."""

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from rockbatch.core.block import lanes as block_lanes
from rockbatch.core.block.model import Block
from rockbatch.core.devices.laws import CONTACT, DAMPERS, HYSTERETIC, MAXWELL, SPRING, TENDON, VISCOUS, Element
from rockbatch.core.flexure import lanes as flexible_lanes
from rockbatch.core.flexure.model import FlexibleBlock, Shaft
from rockbatch.core.flexure.modes import PerMode
from rockbatch.core.footing import lanes as footing_lanes
from rockbatch.core.footing.model import BEDS, Footing
from rockbatch.core.ground import ground_rows
from rockbatch.core.powers import LARGEST_WHOLE
from rockbatch.core.springs import lanes as spring_lanes
from rockbatch.core.springs.laws import CODES
from rockbatch.core.springs.model import IMPACTS, Springs
from rockbatch.core.system import System
from rockbatch.motions.motion import Motion, Samples
from rockbatch.pier import (
    LAWS,
    Base,
    Damper,
    DeckSpring,
    ElasticBase,
    FootingBase,
    Modes,
    Pier,
    Place,
    Restraint,
    RigidBase,
    Tendon,
    YieldingBase,
    fastest,
    places,
    rocking_frequency,
    vertical_frequency,
    yield_deflection,
)

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

ROUNDING = 1e-12
"""Velocity of a pivot that counts as 0, over g/ω_v on springs and R0 α p on a rigid base."""

STEEP = 100.0
"""Greatest decay rate, in units of p, by a viscous damper of exponent < 1 on a slow block on rigid ground."""

READ_AFTER = 5.0
"""Periods 2π/ω_v of vertical vibration between the end of the record and the reading of residuals."""


IDLE = Element(
    kind=VISCOUS,
    strength=0.0,
    stiffness=0.0,
    coefficient=0.0,
    exponent=1.0,
    prestress=0.0,
    offset=0.0,
    linear_below=0.0,
    slope=0.0,
    give=0.0,
    start=0.0,
    returned=1.0,
    quickest=0.0,
    height=0.0,
    swing=0.0,
    way=1.0,
)
"""A forceless element in the middle of the base, from which others are made."""


if unknown := set(CODES) ^ {"elastic", *LAWS}:
    raise TypeError(
        f"laws of springs stand in one of core/springs/laws.py and pier/laws.py only: {', '.join(sorted(unknown))}"
    )


Line = Any
"""The core's numbers for a run: a NamedTuple whose class depends on the system."""


class Start(NamedTuple):
    """State in which a pier is held before its release; all 0 for a pier at rest.

    ``v`` of the centre of mass above unstressed springs [m], ``theta`` [rad], forces of the springs over F_y, states of all
    devices, ``level``, v of the pier before it was pulled [m], NaN for a pier at rest, and the ``unstressed`` position of its
    supports then [m].
    """

    v: float = 0.0
    theta: float = 0.0
    z_left: float = 0.0
    z_right: float = 0.0
    states: tuple[float, ...] = ()
    level: float = math.nan
    unstressed: float = 0.0


@lru_cache(maxsize=4096)
def springs(pier: Pier, base: ElasticBase) -> Springs:
    """Return the core's numbers for ``pier`` on springs, per unit mass."""
    exponent: float | int | None = None
    eta, law, creep = base.reference_eta, "elastic", 0.0
    if isinstance(base, YieldingBase):
        law = base.spring
        exponent = _exponent(base.n) if base.has_exponent else None
        creep = 0.0 if base.law.creep is None else float(base.law.creep.exponent(base.n))
    omega_v = vertical_frequency(pier, base)
    deflection, force = float(yield_deflection(pier, base)), float(0.5 * eta * pier.gravity)
    static = 0.5 * (float(pier.gravity) + prestress(pier, base)) / force
    return Springs(
        half_width=float(pier.half_width),
        height=float(pier.height),
        inertia=float(pier.inertia),
        gravity=float(pier.gravity),
        yield_deflection=deflection,
        stiffness=float(omega_v**2 / (eta * pier.gravity)),
        yield_force=force,
        epsilon=float(base.epsilon if base.zeta is None else 1.0),
        impact=IMPACTS[base.impact],
        restitution=float(pier.restitution),
        damping=float((base.zeta or 0.0) * omega_v),
        law=CODES[law],
        level=float(-deflection * base.first_loading.deflection(static)),
        creep=creep,
        guided=float(base.flight == "guided"),
        rest=float(ROUNDING * pier.gravity * math.sqrt(deflection / force) * math.sqrt(0.5)),
        exponent=exponent,
        finite=True if base.kinematics == "finite" else None,
        damped=True if base.zeta else None,
        shaft=_shaft(pier, base),
    )


def _shaft(pier: Pier, base: ElasticBase | FootingBase) -> Shaft | None:
    """Return the core's numbers for the modes of ``pier``; None if its shaft is rigid."""
    if not base.bends:
        return None
    modes = base.modes(pier)
    return Shaft(
        share=per_mode(modes.share),
        lever=per_mode(modes.coupling - pier.height * modes.share),
        frequency=per_mode(modes.frequency, float(modes.frequency[-1])),
        damping=per_mode(2.0 * base.damping_ratios(pier) * modes.frequency),
        end_shape=per_mode(modes.at(pier.highest)),
        top_shape=per_mode(modes.at(pier.top)),
        deck_shape=per_mode(modes.at(pier.deck)),
        top=float(pier.top),
    )


def _exponent(n: float) -> float | int | None:
    """Return n as None for 5, int for 1 to LARGEST_WHOLE = 10 if whole, else float: the type selects the compiled code."""
    if n == 5:
        return None
    return int(n) if n in range(1, LARGEST_WHOLE + 1) else float(n)


@lru_cache(maxsize=4096)
def block(pier: Pier, base: RigidBase) -> Block:
    """Return the core's numbers for a rigid ``pier`` on a rigid base, per unit mass."""
    restitution = pier.restitution if base.restitution is None else base.restitution
    half_width, height = float(pier.size * math.sin(pier.alpha)), float(pier.size * math.cos(pier.alpha))
    return Block(
        half_width=half_width,  # R0 sin α, also for a frame, whose pier.half_width is a column's
        height=height,
        inertia=float(pier.inertia),
        gravity=float(pier.gravity),
        alpha=float(pier.alpha),
        p=float(pier.p),
        restitution=float(restitution),
        epsilon=0.0,
        guided=float(base.flies),
        quickness=float(1.0 / pier.inertia_about_pivot),
        rest=float(ROUNDING * pier.alpha * pier.p * math.sqrt(half_width * half_width + height * height)),
        deck=0.0
        if pier.deck_over_columns is None
        else float(pier.deck_over_columns / (1 + 2 * pier.deck_over_columns)),
    )


@lru_cache(maxsize=4096)
def flexible_block(pier: Pier, base: RigidBase) -> FlexibleBlock:
    """Return the core's numbers for ``pier`` with an elastic shaft on a rigid base, per unit mass."""
    rigid, modes = block(pier, base), base.modes(pier)
    return FlexibleBlock(
        half_width=rigid.half_width,
        height=rigid.height,
        inertia=rigid.inertia,
        gravity=rigid.gravity,
        alpha=rigid.alpha,
        p=rigid.p,
        guided=rigid.guided,
        rest=rigid.rest,
        deck=0.0,
        top=float(pier.top),
        tipping=_tipping(rigid, modes),
        flight_step=0.5 * FREQUENCY_STEP / _vibration(pier, base, rigid.inertia + rigid.height**2),
        share=per_mode(modes.share),
        coupling=per_mode(modes.coupling),
        frequency=per_mode(modes.frequency, float(modes.frequency[-1])),
        damping=per_mode(2.0 * base.damping_ratios(pier) * modes.frequency),
        end_shape=per_mode(modes.at(pier.highest)),
        top_shape=per_mode(modes.at(pier.top)),
    )


def per_mode(values: Samples, absent: float = 0.0) -> PerMode:
    """Return numbers of modes, shape (n,), as the core has them: for four modes, ``absent`` for those a pier lacks."""
    lacking = len(PerMode._fields) - len(values)
    return PerMode(*map(float, values), *[absent] * lacking)


def _tipping(m: Block, modes: Modes) -> float:
    """Return the unstable equilibrium [rad] on one pivot with the shaft bent by the weight; it is below α."""
    leans = m.gravity * float(((modes.share / modes.frequency) ** 2).sum())
    low, high = 0.0, m.alpha
    for _ in range(60):
        middle = 0.5 * (low + high)
        back = m.half_width * math.cos(middle) - (m.height + leans * math.cos(middle)) * math.sin(middle)
        low, high = (middle, high) if back > 0.0 else (low, middle)
    return low


def footing(pier: Pier, base: FootingBase) -> Footing:
    """Return the core's numbers for ``pier`` on a footing, on a bed of its own that is not laid yet."""
    omega_v = vertical_frequency(pier, base)
    return Footing(
        half_width=float(pier.half_width),
        height=float(pier.height),
        inertia=float(pier.inertia),
        gravity=float(pier.gravity),
        stiffness=float(omega_v**2),
        strength=math.inf if base.safety_factor is None else float(base.safety_factor * pier.gravity),
        damping=float(2.0 * base.zeta * omega_v),
        strips=float(base.strips),
        gap=0.0,
        guided=1.0,
        rest=float(ROUNDING * pier.gravity / omega_v),
        finite=True if base.kinematics == "finite" else None,
        shifting=None,
        bed=np.zeros(BEDS),
        shaft=_shaft(pier, base),
    )


Model = Block | FlexibleBlock | Springs | Footing
"""The core's numbers for a pier."""


def model(pier: Pier, base: Base) -> Model:
    """Return the core's numbers for ``pier`` on ``base``, of the class of its system."""
    if isinstance(base, FootingBase):
        return footing(pier, base)
    if base.on_springs:
        return springs(pier, base)
    return flexible_block(pier, base) if base.bends else block(pier, base)


def system_of(m: Model) -> System:
    """Return the system of a model; runs of equal systems share compiled code."""
    if isinstance(m, Block):
        return block_lanes.system_of(m)
    if isinstance(m, FlexibleBlock):
        return flexible_lanes.system_of(m)
    if isinstance(m, Footing):
        return footing_lanes.system_of(m)
    system = spring_lanes.system_of(m)
    if m.exponent is None:
        return system
    alike = 1 if isinstance(m.exponent, int) else 0.5  # numbers that differ: 1 == 1.0
    return system._replace(traits=system.traits._replace(exponent=alike))


def line_of(
    m: Model,
    timing: tuple[float, ...],
    readings: tuple[float, ...],
    prestress: float,
    start: Start,
) -> Line:
    """Return the core's line of a run: the model's numbers, the initial state, and ``timing`` from ``dt`` to ``patience``."""
    if isinstance(m, Block):
        return block_lanes.line_of(m, start.theta, 0.0, *timing)
    if isinstance(m, FlexibleBlock):
        return flexible_lanes.line_of(m, start.theta, *timing)
    if isinstance(m, Footing):
        return footing_lanes.line_of(m, prestress, start.theta, *timing)
    return spring_lanes.line_of(m, *timing, *readings, prestress, start.v, start.theta, start.z_left, start.z_right)


def elements(pier: Pier, base: Base) -> list[Element]:
    """Return the core's numbers for the devices of ``base``, one Element for each place, per unit mass."""
    return [_element(pier, base, device, place) for device in base.restraints for place in places(pier, device)]


def _element(pier: Pier, base: Base, device: Restraint, place: Place) -> Element:
    """Return the Element of a device at a place."""
    element = IDLE._replace(offset=float(place.offset))
    if place.height != 0.0:
        swing = 0.0 if base.on_springs else pier.half_width
        element = IDLE._replace(height=float(place.height), swing=float(swing), way=float(place.way or 1.0))
    if isinstance(device, Damper):
        return _damper(pier, base, device, element)
    stiffness = float(device.lam * pier.gravity * pier.size / pier.half_width**2)
    if isinstance(device, Tendon):
        strength, prestress = float(pier.gravity * device.strength), float(pier.gravity * device.psi)
        return element._replace(kind=TENDON, strength=strength, stiffness=stiffness, prestress=prestress)
    if isinstance(device, DeckSpring) and device.linear:
        return element._replace(kind=SPRING, stiffness=stiffness, linear_below=math.inf)
    returned = float(device.restitution**2)
    quickest = math.sqrt(_accelerance(pier, base, element) * stiffness / returned)
    return element._replace(
        kind=CONTACT, stiffness=stiffness, start=float(device.gap_m), returned=returned, quickest=quickest
    )


def _damper(pier: Pier, base: Base, damper: Damper, element: Element) -> Element:
    """Return the Element of a damper at the place of ``element``."""
    if damper.brace < math.inf:
        return _braced(pier, damper, element)
    force, coefficient = float(pier.gravity * damper.f), float(damper.nu * pier.p)
    soft = float(1.0 / damper.yield_m) if damper.kind == "hysteretic" else 0.0
    linear_below, slope = _linear_part(pier, base, element, coefficient, float(damper.exponent))
    return element._replace(
        kind=DAMPERS[damper.kind],
        strength=force,
        stiffness=soft,
        coefficient=coefficient,
        exponent=float(damper.exponent),
        linear_below=linear_below,
        slope=slope,
    )


def _braced(pier: Pier, damper: Damper, element: Element) -> Element:
    """Return the Element of a damper on a brace at the place of ``element``; an idle one for a viscous damper without force."""
    stiffness = float(damper.brace * pier.gravity * pier.size / pier.half_width**2)
    if damper.kind == "hysteretic":
        force, soft = float(pier.gravity * damper.f), float(1.0 / damper.yield_m)
        return element._replace(kind=HYSTERETIC, strength=force, stiffness=soft, give=force * soft / stiffness)
    coefficient, exponent = float(damper.nu * pier.p), float(damper.exponent)
    if coefficient == 0.0:
        return element._replace(linear_below=math.inf)
    linear_below, quickest = math.inf if exponent == 1.0 else 0.0, stiffness / (exponent * coefficient)
    element = element._replace(kind=MAXWELL, stiffness=stiffness, linear_below=linear_below, quickest=quickest)
    return element._replace(coefficient=coefficient, exponent=exponent)


def _linear_part(pier: Pier, base: Base, element: Element, coefficient: float, exponent: float) -> tuple[float, float]:
    """Return the speed [m/s] below which a viscous damper is linear, and the slope [1/s] of its force there.

    For a < 1 the damping rate is unbounded at low speed, and would stop small motions faster than any step resolves. Infinite and
    the coefficient for a = 1; 0 and 0 for a > 1 and without a coefficient.
    """
    if exponent > 1.0 or coefficient == 0.0:
        return 0.0, 0.0
    if exponent == 1.0:
        return math.inf, coefficient
    speed = (coefficient * _accelerance(pier, base, element) / _fastest(pier, base)) ** (1.0 / (1.0 - exponent))
    return speed, coefficient * speed ** (exponent - 1.0)


def _fastest(pier: Pier, base: Base) -> float:
    """Return the greatest frequency or decay rate [1/s] on ground that gives, without devices; else the bound STEEP p."""
    if not base.on_springs:
        return STEEP * pier.p
    if not base.bends:
        return fastest(pier, base)
    if isinstance(base, FootingBase):
        return _fastest_bending(footing(pier, base), _parts_of_bed(pier, base))
    m = springs(pier, base)
    both = [Support(side * m.half_width, m.yield_force * m.stiffness, m.damping) for side in (-1.0, 1.0)]
    return _fastest_bending(m, (both, both[1:], []))


class Support(NamedTuple):
    """A spring with a dashpot under a pier, per unit mass."""

    place: float  # to the right of the middle of the base [m]
    stiffness: float  # [1/s²]
    damping: float  # [1/s]


PRESSED = (1.0, 0.8, 0.6, 0.4, 0.2, 0.1, 0.05, 0.0)
"""Shares of a bed, from an edge on, for which the greatest rate of a pier whose shaft bends is looked for."""


def _parts_of_bed(pier: Pier, base: FootingBase) -> Iterator[list[Support]]:
    """Yield, for each share of a bed (:data:`PRESSED`), two supports with its stiffness and damping, vertical and in rocking."""
    omega_v, b = vertical_frequency(pier, base), pier.half_width
    for share in PRESSED:
        middle, apart = b * (1.0 - share), b * share / math.sqrt(3.0)
        stiffness, damping = 0.5 * share * omega_v**2, share * base.zeta * omega_v
        yield [Support(float(middle + side * apart), float(stiffness), float(damping)) for side in (-1.0, 1.0)]


def _fastest_bending(m: Springs | Footing, contacts: Iterable[Sequence[Support]]) -> float:
    """Return the greatest rate [1/s] of a pier whose shaft bends, on the supports of any of ``contacts``."""
    shaft, greatest = m.shaft, 0.0
    assert shaft is not None
    n = 2 + len(shaft.share)
    masses = np.diag([1.0, m.inertia + m.height**2, *np.ones(n - 2)])
    masses[1, 2:] = masses[2:, 1] = np.array(shaft.lever) + m.height * np.array(shaft.share)
    for supports in contacts:
        stiffness = np.diag([0.0, 0.0, *np.square(shaft.frequency)])
        damping = np.diag([0.0, 0.0, *shaft.damping])
        for support in supports:
            arm = np.array([1.0, -support.place, *np.zeros(n - 2)])
            stiffness += support.stiffness * np.outer(arm, arm)
            damping += support.damping * np.outer(arm, arm)
        rates = np.linalg.solve(masses, np.hstack((stiffness, damping)))
        system = np.vstack((np.hstack((np.zeros((n, n)), np.eye(n))), -rates))
        greatest = max(greatest, float(np.abs(np.linalg.eigvals(system)).max()))
    return greatest


def _accelerance(pier: Pier, base: Base, element: Element) -> float:
    """Return the acceleration at a device by a unit force there per unit mass.

    On a rigid base it is that about the farther pivot, else that in full contact.
    """
    if element.height != 0.0:
        inertia = pier.inertia + pier.height**2 if base.on_springs else pier.inertia_about_pivot
        return (element.height**2 + element.swing**2) / inertia
    if not base.on_springs:
        return (pier.half_width + abs(element.offset)) ** 2 / pier.inertia_about_pivot
    return 1.0 + element.offset**2 / (pier.inertia + pier.height**2)


@lru_cache(maxsize=4096)
def prestress(pier: Pier, base: Base) -> float:
    """Return Σ P0/M of all tendons [m/s²], counted at every place; 0 without any."""
    return sum(law.prestress for law in elements(pier, base))


def _vibration(pier: Pier, base: RigidBase, turning: float) -> float:
    """Return the greatest rate [1/s] of the shaft's modes coupled with a rotation of the inertia ``turning`` [m²]."""
    modes = base.modes(pier)
    n = len(modes.frequency)
    # Without the rotation, whose acceleration is −Σ λ_i ü_i/J
    masses = np.eye(n) - np.outer(modes.coupling, modes.coupling) / turning
    pulls = np.hstack((np.diag(modes.frequency**2), np.diag(2.0 * base.damping_ratios(pier) * modes.frequency)))
    system = np.vstack((np.hstack((np.zeros((n, n)), np.eye(n))), -np.linalg.solve(masses, pulls)))
    return float(np.abs(np.linalg.eigvals(system)).max())


@lru_cache(maxsize=4096)
def fastest_rate(pier: Pier, base: Base) -> float:
    """Return the greatest rate [1/s] of a model: of springs, vibration against devices, or decay by linear dampers.

    On rigid ground with a viscous damper of exponent < 1 it is at least STEEP p.
    """
    stiff, slows, relaxes, steep = 0.0, 0.0, 0.0, False
    for law in elements(pier, base):
        lever = _accelerance(pier, base, law)
        steel = law.strength / (1.0 + law.give) if law.kind == HYSTERETIC else 0.0
        stiff += lever * law.stiffness * (steel or law.kind in (TENDON, SPRING, MAXWELL))
        slows += lever * law.coefficient if law.kind == VISCOUS else 0.0
        steep = steep or (law.kind == VISCOUS and law.exponent < 1.0)
        relaxes = max(relaxes, law.quickest if law.kind == MAXWELL and law.exponent == 1.0 else 0.0)
    if base.on_springs:
        return max(math.hypot(_fastest(pier, base), math.sqrt(stiff)), 2.0 * slows, relaxes)
    if base.bends:
        stiff += _vibration(pier, base, pier.inertia_about_pivot) ** 2
    return max(math.sqrt(stiff), _fastest(pier, base) if steep else slows, relaxes)


def ground_of(motion: Motion) -> Samples:
    """Return the core's rows of a motion, shape (npts, 4); see :func:`rockbatch.core.ground.ground_rows`."""
    vertical = () if motion.vertical is None else motion.vertical
    return ground_rows(motion.horizontal, vertical, float(motion.dt))


def acceleration_at(samples: Samples, dt: float, t: Samples | float) -> Samples:
    """Return the ground acceleration at times ``t``: linear between ``samples``, zero from the sample after the last."""
    return np.interp(t, np.arange(len(samples) + 1) * dt, np.append(samples, 0.0))


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
