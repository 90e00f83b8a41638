"""Impossible and implausible devices.

Implausible ones, as of a wrong unit, are refused until their ``confirm`` names the value.
"""

import math
from typing import NamedTuple, get_args

from rockbatch.common.errors import remedy
from rockbatch.common.units import POSITIVE
from rockbatch.pier.block import HIGHEST, Pier
from rockbatch.pier.places import WAYS, offsets, symmetric
from rockbatch.pier.restraints import (
    BOUNDS,
    DAMPERS,
    FIELDS,
    HEIGHT,
    Damper,
    DamperKind,
    DeckSpring,
    Restraint,
    Stop,
    Tendon,
)

SPEED = 0.1
"""Speed of a viscous damper [m/s] at which it has less than the pier's weight; heels of piers that step reach 0.1 to 1 m/s."""

THINNEST, WIDEST = 2.5e-5, 0.5
"""Yield deflection of a hysteretic damper [m]; steel ones have 1 to 20 mm."""

FIRMEST = 2e-5
"""Least deflection of a stop under the weight of the whole pier [m]: a steel block of a metre gives way by a tenth of a
millimetre."""

QUICKEST = 1e4
"""Rate [1/s] at which a damper on a brace relaxes, about that force which it has at SPEED: beyond it the brace might as well be
rigid, and takes steps without number."""

MOST_LAMBDA = 100.0
"""Greatest λ of a tendon, by which it adds the pier's weight at a hundredth of α; strands have 0.1 to 10."""


def wrong_on_springs(pier: Pier, restraints: tuple[Restraint, ...]) -> list[str]:
    """Return what is impossible about dampers and tendons of a pier on springs: one sentence each; empty if nothing."""
    if symmetric(pier, tuple(device for device in restraints if isinstance(device, Tendon))):
        return []
    return [
        "tendon: on springs a tendon off the axis needs its like on the other side, or it leans the pier before any "
        "earthquake; write a second one with the opposite at, or leave at out"
    ]


def wrong_restraints(pier: Pier, restraints: tuple[Restraint, ...]) -> list[str]:
    """Return what is impossible about devices under ``pier``: one sentence each; empty if nothing."""
    wrong = []
    at_deck = any(isinstance(device, DeckSpring) or device.at == "deck" for device in restraints)
    if at_deck and pier.deck_over_columns is not None:
        wrong.append(
            "columns: devices at the deck of a rocking frame are not solved, those at the feet of its columns are; leave "
            'deck_spring and dampers with at = "deck" out, or columns'
        )
    for device in restraints:
        wrong += wrong_device(pier, device)
    return wrong + ([] if wrong else _wrong_friction(pier, restraints))


def wrong_device(pier: Pier, device: Restraint) -> list[str]:
    """Return what is impossible about one device under ``pier``, a sentence each; empty if nothing is."""
    wrong = _wrong_place(pier, device)
    if isinstance(device, Damper) and device.kind not in DAMPERS:
        wrong.append(f'kind = "{device.kind}": must be ' + " or ".join(f'"{kind}"' for kind in get_args(DamperKind)))
    for field_ in DAMPERS.get(device.kind, ()) if isinstance(device, Damper) else FIELDS[device.what]:
        wrong += BOUNDS[field_].problems(field_.replace("lam", "lambda"), getattr(device, field_))
    if isinstance(device, Damper):
        wrong += _wrong_brace(device)
    if isinstance(device, Tendon) and not device.strength > device.psi:
        strength = f"its yield force over the weight, {device.strength:g}"
        wrong.append(f"{strength}, must be above its prestress, {device.psi:g}")
    return [f"{device.what}: {problem}" for problem in wrong]


def _wrong_brace(damper: Damper) -> list[str]:
    if damper.brace == math.inf:
        return []
    if damper.kind == "friction":
        return [
            f'brace = {damper.brace:g}: friction on a brace is a hysteretic damper; write kind = "hysteretic" with the '
            "deflection of the brace under the damper's force as yield_mm"
        ]
    if damper.kind == "viscous" and damper.exponent > 1.0:
        return [f"brace = {damper.brace:g}: with one the exponent must be 1 at most; leave the brace out"]
    return POSITIVE.problems("brace", damper.brace)


def _wrong_place(pier: Pier, device: Restraint) -> list[str]:
    if isinstance(device, DeckSpring):
        wrong = HEIGHT.problems("height_m", device.height_m)
        if device.side not in WAYS:
            wrong.append(f'side = "{device.side}": must be ' + " or ".join(f'"{side}"' for side in WAYS))
        return wrong
    place, on_deck = device.at, isinstance(device, Damper)
    if place == "deck" and isinstance(device, Damper) and device.kind == "friction":
        return [
            'at = "deck": friction at the deck is not solved; write kind = "hysteretic" with a small yield_mm, whose limit '
            "friction is"
        ]
    if isinstance(place, str) and place not in ("left", "right", *(("deck",) if on_deck else ())):
        return [
            f'at = "{place}": must be "left", "right"{", " + chr(34) + "deck" + chr(34) if on_deck else ""} or an offset in m'
        ]
    if isinstance(place, float | int) and not abs(place) <= 2.0 * pier.half_width:
        return [f"at = {place:g}: must be within the base's width either side, {2 * pier.half_width:.4g} m"]
    return []


def _wrong_friction(pier: Pier, restraints: tuple[Restraint, ...]) -> list[str]:
    rubbing = [damper for damper in restraints if isinstance(damper, Damper) and damper.kind == "friction"]
    if sum(len(offsets(pier, damper)) for damper in rubbing) <= 2:
        return []
    return [
        "damper: two places of friction at most can be solved, for example one damper at both pivots; join their forces, or "
        'write kind = "hysteretic" with a small yield_mm, whose limit friction is'
    ]


class Doubt(NamedTuple):
    """A value of the field ``name`` that is probably wrong, and what it would mean."""

    name: str
    meaning: str


def doubt(pier: Pier, device: Restraint) -> Doubt | None:
    """Return what is odd about a device of ``pier``; None if nothing is, or if it is confirmed."""
    if isinstance(device, Damper):
        doubts = _of_damper(pier, device)
    else:
        doubts = _of_tendon(pier, device) if isinstance(device, Tendon) else _of_contact(pier, device)
    return None if doubts is None or doubts.name in device.confirm else doubts


def unlikely_devices(pier: Pier, devices: tuple[Restraint, ...]) -> list[str]:
    """Return what is odd about devices of ``pier``, a sentence each, except what they confirm."""
    doubts = [(device, doubt(pier, device)) for device in devices]
    return [
        f"{device.what}: {odd.name} = {getattr(device, odd.name):g}: {odd.meaning}; {remedy(odd.name)}"
        for device, odd in doubts
        if odd is not None
    ]


def _of_brace(pier: Pier, damper: Damper) -> Doubt | None:
    if damper.brace == math.inf:
        return None
    stiffness = damper.brace * pier.gravity * pier.size / pier.half_width**2
    deflection = pier.gravity / stiffness
    if deflection < FIRMEST:
        message = f"the brace gives by {1000.0 * deflection:.2g} mm under the pier's weight"
        return Doubt("brace", f"{message}; leave out one that is rigid")
    if damper.kind == "viscous" and damper.nu > 0.0:
        rate = stiffness / (damper.exponent * damper.nu * pier.p) * SPEED ** (1.0 - damper.exponent)
        if rate > QUICKEST:
            return Doubt(
                "brace", f"beside this damper it is rigid, it follows within {1000.0 / rate:.2g} ms; leave it out"
            )
    return None


def _of_damper(pier: Pier, damper: Damper) -> Doubt | None:
    if of_brace := _of_brace(pier, damper):
        return of_brace
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


def _of_contact(pier: Pier, stop: Stop | DeckSpring) -> Doubt | None:
    name = "stop" if isinstance(stop, Stop) else "spring"
    if stop.lam == 0.0:
        return Doubt("lam", f"with no stiffness the {name} is not there; give one, or leave the {name} out")
    deflection = pier.half_width**2 / (stop.lam * pier.size)  # under the weight
    if deflection < FIRMEST:
        return Doubt("lam", f"it bears the pier's weight at a deflection of {1000.0 * deflection:.2g} mm")
    if 0.0 < stop.gap_m < 5e-4:
        return Doubt("gap_m", f"it is met after {1000.0 * stop.gap_m:.2g} mm already")
    if isinstance(stop, Stop):
        if stop.gap_m > 2.0 * pier.half_width:
            return Doubt("gap_m", f"it is met at a rise of {stop.gap_m:.3g} m, more than the pier is wide")
        return None
    height = pier.deck if stop.height_m is None else stop.height_m
    if height > HIGHEST * 2.0 * pier.height:
        return Doubt(
            "height_m", f"{0.5 * height / pier.height:.3g} times the height of the pier, {2 * pier.height:.3g} m"
        )
    if stop.gap_m > height * math.tan(pier.alpha):
        return Doubt(
            "gap_m", f"the deck is only there, {stop.gap_m:.3g} m away, when the pier leans by more than alpha"
        )
    return None
