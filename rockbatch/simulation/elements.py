"""The core's numbers for the devices of a base."""

import math
from functools import lru_cache

import numpy as np

from rockbatch.core.devices.laws import CONTACT, DAMPERS, HYSTERETIC, MAXWELL, SPRING, TENDON, VISCOUS, Element
from rockbatch.pier import Base, Damper, DeckSpring, Pier, Place, Restraint, Tendon, places
from rockbatch.pier.vibration import greatest_rate

STEEP = 100.0
"""Greatest decay rate, in units of p, by a viscous damper of exponent < 1 on a slow block on rigid ground."""

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


@lru_cache(maxsize=4096)
def elements(pier: Pier, base: Base) -> tuple[Element, ...]:
    """Return the core's numbers for the devices of ``base``, one Element for each place, per unit mass."""
    return tuple(_element(pier, base, device, place) for device in base.restraints for place in places(pier, device))


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
    quickest = math.sqrt(accelerance(pier, base, element) * stiffness / returned)
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
    slope = _limit(pier, base) / accelerance(pier, base, element)
    with np.errstate(over="ignore", under="ignore"):  # an exponent near 1 leaves no such speed, or makes it infinite
        speed = float(np.float64(coefficient / slope) ** (1.0 / (1.0 - exponent)))
    return speed, slope


def _limit(pier: Pier, base: Base) -> float:
    """Return the greatest decay rate [1/s] by a viscous damper of exponent < 1: that of the ground, STEEP p on rigid ground."""
    return greatest_rate(pier, base) if base.on_springs else STEEP * pier.p


def accelerance(pier: Pier, base: Base, element: Element) -> float:
    """Return the acceleration at a device by a unit force there per unit mass.

    On a rigid base it is that about the farther pivot, else that in full contact.
    """
    if element.height != 0.0:
        inertia = pier.inertia + pier.height**2 if base.on_springs else pier.inertia_about_pivot
        return (element.height**2 + element.swing**2) / inertia
    if not base.on_springs:
        return (pier.half_width + abs(element.offset)) ** 2 / pier.inertia_about_pivot
    return 1.0 + element.offset**2 / (pier.inertia + pier.height**2)


def prestress(pier: Pier, base: Base) -> float:
    """Return Σ P0/M of all tendons [m/s²], counted at every place; 0 without any."""
    return sum(law.prestress for law in elements(pier, base))
