"""Impossible and implausible devices.

Implausible ones, as of a wrong unit, are refused until their ``confirm`` names the value.
"""

import math
from collections.abc import Iterator
from typing import NamedTuple, get_args

from rockbatch.common.errors import remedy
from rockbatch.common.units import POSITIVE
from rockbatch.pier.block import Pier
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
from rockbatch.pier.sizes import HIGHEST, LOWEST

SPEED = 0.1
"""Speed of a viscous damper [m/s] at which it has less than the pier's weight; heels of piers that step reach 0.1 to 1 m/s."""

THINNEST, WIDEST = 2.5e-5, 0.5
"""Yield deflection of a hysteretic damper [m]; steel ones have 1 to 20 mm."""

FIRMEST = {"stop": 1e-4, "deck_spring": 1e-3, "damper": 1e-3}
"""Least deflection under the weight of the whole pier [m] of a stop, deck spring or damper's brace: a steel block of a
metre gives way by a tenth of a millimetre, abutments and braces by 5 to 500 mm."""

LEAST_FORCE = 1e-3
"""Force over the weight below which a damper, at 1 m/s if it is viscous, or a tendon might as well not be there."""

MOST_STRENGTH = 10.0
"""Greatest yield force of a tendon over the weight."""

SOFTEST = {"tendon": 0.01, "stop": 0.05, "deck_spring": 0.05, "damper": 0.05}
"""Least force of a device, or of a damper's brace, that yields by as much as a rotation of α asks, over the weight."""

QUICKEST = 1e4
"""Rate [1/s] at which a damper on a brace relaxes, about that force which it has at SPEED: beyond it the brace might as well be
rigid, and takes steps without number."""

MOST_LAMBDA = 100.0
"""Greatest λ of a tendon, by which it adds the pier's weight at a hundredth of α; strands have 0.03 to 10."""


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
        wrong += _of_other_kinds(device) + _wrong_brace(device)
    if isinstance(device, Tendon) and not device.strength > device.psi:
        strength = f"its yield force over the weight, {device.strength:g}"
        wrong.append(f"{strength}, must be above its prestress, {device.psi:g}")
    return [f"{device.what}: {problem}" for problem in wrong]


def _of_other_kinds(damper: Damper) -> list[str]:
    own = DAMPERS.get(damper.kind, ())
    others = {name for names in DAMPERS.values() for name in names if own and name not in own}
    given = {name: value for name in sorted(others) if (value := getattr(damper, name)) != getattr(Damper, name)}
    return [f"{name} = {value:g}: is not of a {damper.kind} damper; leave it out" for name, value in given.items()]


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
    return next((doubt for doubt in doubts if doubt.name not in device.confirm), None)


def unlikely_devices(pier: Pier, devices: tuple[Restraint, ...]) -> list[str]:
    """Return what is odd about devices of ``pier``, a sentence each, except what they confirm."""
    doubts = [(device, doubt(pier, device)) for device in devices]
    return [
        f"{device.what}: {odd.name} = {getattr(device, odd.name):g}: {odd.meaning}; {remedy(odd.name)}"
        for device, odd in doubts
        if odd is not None
    ]


def _of_brace(pier: Pier, damper: Damper) -> Iterator[Doubt]:
    if damper.brace == math.inf:
        return
    stiffness = damper.brace * pier.gravity * pier.size / pier.half_width**2
    deflection = pier.gravity / stiffness
    if deflection < FIRMEST[damper.what]:
        message = f"the brace gives by {1000.0 * deflection:.2g} mm under the pier's weight"
        yield Doubt("brace", f"{message}; leave out one that is rigid")
    elif 2.0 * damper.brace < SOFTEST[damper.what]:
        share = f"{200.0 * damper.brace:.2g} % of the pier's weight"
        yield Doubt("brace", f"it bears {share} at a rotation of α, so that the damper hardly moves")
    elif damper.kind == "viscous" and damper.nu > 0.0:
        rate = stiffness / (damper.exponent * damper.nu * pier.p) * SPEED ** (1.0 - damper.exponent)
        if rate > QUICKEST:
            yield Doubt(
                "brace", f"beside this damper it is rigid, it follows within {1000.0 / rate:.2g} ms; leave it out"
            )


def _of_damper(pier: Pier, damper: Damper) -> Iterator[Doubt]:
    if damper.kind == "viscous":
        share = damper.nu * pier.p / pier.gravity  # of the weight, at 1 m/s
        if share * SPEED**damper.exponent > 1.0:
            speed = share ** (-1.0 / damper.exponent)
            yield Doubt("nu", f"at {1000.0 * speed:.2g} mm/s one damper has the force of the pier's weight already")
        elif 0.0 < share < LEAST_FORCE:
            yield Doubt("nu", f"at 1 m/s it has {100.0 * share:.2g} % of the pier's weight, as good as nothing")
    elif damper.f > 1.0:
        yield Doubt("f", f"one damper has {damper.f:.3g} times the pier's weight")
    elif 0.0 < damper.f < LEAST_FORCE:
        yield Doubt("f", f"it has {100.0 * damper.f:.2g} % of the pier's weight, as good as nothing")
    if damper.kind == "hysteretic" and not THINNEST <= damper.yield_m <= WIDEST:
        yield Doubt(
            "yield_m", f"the damper yields at {1000.0 * damper.yield_m:.2g} mm, where steel ones do at 1 to 20 mm"
        )
    yield from _of_brace(pier, damper)


def _of_tendon(pier: Pier, tendon: Tendon) -> Iterator[Doubt]:
    for name, force, words in (("psi", tendon.psi, "its prestress is"), ("strength", tendon.strength, "it yields at")):
        if 0.0 < force < LEAST_FORCE:
            yield Doubt(name, f"{words} {100.0 * force:.2g} % of the pier's weight, as good as nothing")
    if MOST_STRENGTH < tendon.strength < math.inf:
        yield Doubt("strength", f"it yields at {tendon.strength:.3g} times the pier's weight")
    if tendon.lam > MOST_LAMBDA:
        arm = pier.half_width  # a tendon on the axis: its force over the weight is λ R0 θ/b
        share = tendon.lam * pier.size * 0.01 * pier.alpha / arm
        yield Doubt("lam", f"it adds {share:.3g} times the pier's weight at a rotation of 0.01 α already")
    elif 0.0 < tendon.lam < SOFTEST[tendon.what]:
        yield Doubt(
            "lam", f"it adds {100.0 * tendon.lam:.2g} % of the pier's weight at a rotation of α, as good as nothing"
        )
    if tendon.psi == 0.0 == tendon.lam:
        yield Doubt(
            "psi", "with no prestress and no stiffness the tendon is not there; give one, or leave the tendon out"
        )


def _of_contact(pier: Pier, stop: Stop | DeckSpring) -> Iterator[Doubt]:
    if 0.0 < stop.gap_m < 5e-4:
        yield Doubt("gap_m", f"it is met after {1000.0 * stop.gap_m:.2g} mm already")
    if isinstance(stop, Stop):
        if stop.gap_m > 2.0 * pier.half_width:
            yield Doubt("gap_m", f"it is met at a rise of {stop.gap_m:.3g} m, more than the pier is wide")
    else:
        yield from _of_deck_spring(pier, stop)
    yield from _of_stiffness(pier, stop)


def _of_deck_spring(pier: Pier, spring: DeckSpring) -> Iterator[Doubt]:
    height = pier.deck if spring.height_m is None else spring.height_m
    if not LOWEST * 2.0 * pier.height <= height <= HIGHEST * 2.0 * pier.height:
        yield Doubt(
            "height_m", f"{0.5 * height / pier.height:.3g} times the height of the pier, {2 * pier.height:.3g} m"
        )
    elif spring.gap_m > height * math.tan(pier.alpha):
        yield Doubt(
            "gap_m", f"the deck is only there, {spring.gap_m:.3g} m away, when the pier leans by more than alpha"
        )


def _of_stiffness(pier: Pier, stop: Stop | DeckSpring) -> Iterator[Doubt]:
    name = "stop" if isinstance(stop, Stop) else "spring"
    if stop.lam == 0.0:
        yield Doubt("lam", f"with no stiffness the {name} is not there; give one, or leave the {name} out")
        return
    stiffness = stop.lam * pier.size / pier.half_width**2  # over the weight [1/m]
    if 1.0 / stiffness < FIRMEST[stop.what]:
        yield Doubt("lam", f"it bears the pier's weight at a deflection of {1000.0 / stiffness:.2g} mm")
    travel = 2.0 * pier.half_width if isinstance(stop, Stop) else pier.deck if stop.height_m is None else stop.height_m
    if (share := stiffness * travel * pier.alpha) < SOFTEST[stop.what]:
        yield Doubt(
            "lam", f"it bears {100.0 * share:.2g} % of the pier's weight at a rotation of α, as good as nothing"
        )
