"""The core's numbers for piers on their bases, and for motions."""

import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from rockbatch.core.block import lanes as block_lanes
from rockbatch.core.block.model import Block
from rockbatch.core.flexure import lanes as flexible_lanes
from rockbatch.core.flexure.model import FlexibleBlock, Shaft
from rockbatch.core.flexure.modes import PerMode
from rockbatch.core.footing import lanes as footing_lanes
from rockbatch.core.footing.model import BEDS, Footing
from rockbatch.core.ground import ground_rows
from rockbatch.core.powers import LARGEST_WHOLE
from rockbatch.core.springs import lanes as spring_lanes
from rockbatch.core.springs.backbone import MOST_CORNERS, Backbone, backbone_of
from rockbatch.core.springs.laws import CODES
from rockbatch.core.springs.model import IMPACTS, Springs
from rockbatch.core.system import System
from rockbatch.motions.motion import Motion, Samples
from rockbatch.pier import (
    LAWS,
    MOST_POINTS,
    Base,
    ElasticBase,
    FootingBase,
    Pier,
    RigidBase,
    YieldingBase,
    vertical_frequency,
    yield_deflection,
)
from rockbatch.pier.vibration import greatest_rate_of_shaft
from rockbatch.simulation.elements import prestress
from rockbatch.simulation.steps import FREQUENCY_STEP

ROUNDING = 1e-12
"""Velocity of a pivot that counts as 0, over g/ω_v on springs and R0 α p on a rigid base."""

if unknown := set(CODES) ^ {"elastic", *LAWS}:
    raise TypeError(
        f"laws of springs stand in one of core/springs/laws.py and pier/laws.py only: {', '.join(sorted(unknown))}"
    )

if MOST_POINTS != MOST_CORNERS + 1:
    raise TypeError("core/springs/backbone.py has another number of corners than the points of pier/backbones.py")


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
        backbone=_backbone(base),
    )


def _backbone(base: ElasticBase) -> Backbone | None:
    """Return the core's numbers for the backbone of the springs; None if they have none."""
    if not base.has_points:
        return None
    curve = base.first_loading
    beyond = curve.tangent(np.array(curve.kinks))
    return backbone_of(curve.kinks, [float(1.0 - stiff) for stiff in beyond])


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
        tipping=_tipping(rigid, base.overhang(pier)),
        flight_step=0.5 * FREQUENCY_STEP / greatest_rate_of_shaft(pier, base, rigid.inertia + rigid.height**2),
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


def _tipping(m: Block, overhang: float) -> float:
    """Return the unstable equilibrium [rad] on one pivot with the shaft bent by the weight, which hangs over; it is below α."""
    low, high = 0.0, m.alpha
    for _ in range(60):
        middle = 0.5 * (low + high)
        back = m.half_width * math.cos(middle) - (m.height + overhang * math.cos(middle)) * math.sin(middle)
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


def ground_of(motion: Motion) -> Samples:
    """Return the core's rows of a motion, shape (npts, 4); see :func:`rockbatch.core.ground.ground_rows`."""
    vertical = () if motion.vertical is None else motion.vertical
    return ground_rows(motion.horizontal, vertical, float(motion.dt))


def acceleration_at(samples: Samples, dt: float, t: Samples | float) -> Samples:
    """Return the ground acceleration at times ``t``: linear between ``samples``, zero from the sample after the last."""
    return np.interp(t, np.arange(len(samples) + 1) * dt, np.append(samples, 0.0))
