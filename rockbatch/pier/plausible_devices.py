"""Implausible dampers and tendons, as of a wrong unit: refused until their ``confirm`` names the value."""

from typing import NamedTuple

from rockbatch.errors import remedy
from rockbatch.pier.block import Pier
from rockbatch.pier.restraints import Damper, Restraint, Tendon

SPEED = 0.1
"""Speed of a viscous damper [m/s] at which it has less than the pier's weight; heels of piers that step reach 0.1 to 1 m/s."""

THINNEST, WIDEST = 2.5e-5, 0.5
"""Yield deflection of a hysteretic damper [m]; steel ones have 1 to 20 mm."""

MOST_LAMBDA = 100.0
"""Greatest λ of a tendon, by which it adds the pier's weight at a hundredth of α; strands have 0.1 to 10."""


class Doubt(NamedTuple):
    """A value of the field ``name`` that is probably wrong, and what it would mean."""

    name: str
    meaning: str


def doubt(pier: Pier, device: Restraint) -> Doubt | None:
    """Return what is odd about a damper or tendon of ``pier``; None if nothing is, or if it is confirmed."""
    odd = _of_tendon(pier, device) if isinstance(device, Tendon) else _of_damper(pier, device)
    return None if odd is None or odd.name in device.confirm else odd


def unlikely_devices(pier: Pier, devices: tuple[Restraint, ...]) -> list[str]:
    """Return what is odd about dampers and tendons of ``pier``, a sentence each, except what they confirm."""
    doubts = [(device, doubt(pier, device)) for device in devices]
    return [
        f"{'tendon' if isinstance(device, Tendon) else 'damper'}: {odd.name} = {getattr(device, odd.name):g}: {odd.meaning}; "
        f"{remedy(odd.name)}"
        for device, odd in doubts
        if odd is not None
    ]


def _of_damper(pier: Pier, damper: Damper) -> Doubt | None:
    if damper.kind == "viscous":
        share = damper.nu * pier.p / pier.gravity  # of the weight, at 1 m/s
        if share * SPEED**damper.exponent > 1.0:
            speed = share ** (-1.0 / damper.exponent)
            return Doubt("nu", f"at {1000.0 * speed:.2g} mm/s one damper has the force of the pier's weight already")
    elif damper.kind == "hysteretic" and not THINNEST <= damper.yield_m <= WIDEST:
        return Doubt(
            "yield_m", f"the damper yields at {1000.0 * damper.yield_m:.2g} mm, where steel ones do at 1 to 20 mm"
        )
    return None


def _of_tendon(pier: Pier, tendon: Tendon) -> Doubt | None:
    if tendon.lam > MOST_LAMBDA:
        arm = pier.half_width  # a tendon on the axis: its force over the weight is λ R0 θ/b
        share = tendon.lam * pier.size * 0.01 * pier.alpha / arm
        return Doubt("lam", f"it adds {share:.3g} times the pier's weight at a rotation of 0.01 α already")
    if tendon.psi == 0.0 == tendon.lam:
        return Doubt(
            "psi", "with no prestress and no stiffness the tendon is not there; give one, or leave the tendon out"
        )
    return None
