"""Statics of a pier before it moves: the ground acceleration and rotation at which it lifts off, and where it loses its balance.

All quasi-static, THEORY.md (10), (14), (15) and (17). Viscous and hysteretic dampers bear nothing at rest and are left out.
"""

import math

from rockbatch.pier.block import Pier
from rockbatch.pier.restraints import Damper, Restraint, Stop, Tendon, offsets, prestress_over_weight, static_force

POINTS = 900
"""Rotations up to a right angle among which a loss of balance is sought."""


def lift_off_rotation(pier: Pier, restraints: tuple[Restraint, ...], static_deflection: float) -> float:
    """Return the rotation at which elastic supports let go of the first pivot [rad]; 0 on rigid ground.

    ``static_deflection`` is that under the weight alone [m]; prestress adds to it.
    """
    return static_deflection * (1.0 + prestress_over_weight(pier, restraints)) / pier.half_width


def lift_off_acceleration(pier: Pier, restraints: tuple[Restraint, ...] = (), static_deflection: float = 0.0) -> float:
    """Return the least steady horizontal ground acceleration that lifts a pivot [g], without a vertical one.

    Weight and tendons right the pier about the pivot that stays, friction holds it, and the lean at lift-off takes its share.
    Where devices stand unsymmetrically, the weaker direction counts.
    """
    on_springs = static_deflection > 0.0
    lean = lift_off_rotation(pier, restraints, static_deflection)
    least = math.inf
    for pivot in (-pier.half_width, pier.half_width):
        moment = 0.0
        for device in restraints:
            for offset in offsets(pier, device):
                if isinstance(device, Tendon):
                    moment += device.psi * abs(offset - pivot)
                elif (
                    isinstance(device, Damper) and device.kind == "friction"
                ):  # on springs the pier turns about its middle
                    moment += device.f * abs(offset if on_springs else offset - pivot)
        least = min(least, math.tan(pier.alpha) + moment / pier.height)
    return least - lean


def unstable_equilibrium(pier: Pier, restraints: tuple[Restraint, ...] = ()) -> float | None:
    """Return the rotation beyond which weight, tendons and stops do not bring the pier back [rad].

    Of a pier that rocks about a pivot on rigid ground: α without them. None where they hold it at any rotation.
    """
    holding = [
        (device, offset)
        for device in restraints
        if isinstance(device, Tendon | Stop)
        for offset in offsets(pier, device)
    ]
    rotations = [_loses_balance(pier, holding, side) for side in ((1.0, -1.0) if holding else (1.0,))]
    return min((theta for theta in rotations if theta is not None), default=None)


def _loses_balance(pier: Pier, holding: list[tuple[Tendon | Stop, float]], side: float) -> float | None:
    def righting(theta: float) -> float:
        """Return the moment about the pivot over M g R0."""
        moment = math.sin(pier.alpha - theta)
        for device, offset in holding:
            arm = pier.half_width + side * offset
            stretch = 2.0 * arm * math.sin(0.5 * theta)
            moment += static_force(pier, device, stretch) * arm * math.cos(0.5 * theta) / pier.size
        return moment

    step = 0.5 * math.pi / POINTS
    first = next((i for i in range(1, POINTS + 1) if righting(i * step) < 0.0), None)
    if first is None:
        return None
    low, high = (first - 1) * step, first * step
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if righting(middle) < 0.0 else (middle, high)
    return low
