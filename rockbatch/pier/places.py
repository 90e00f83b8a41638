"""Places of devices under a pier and beside its deck, and their symmetry."""

from collections import Counter
from dataclasses import replace
from typing import NamedTuple

from rockbatch.pier.block import Pier
from rockbatch.pier.restraints import Damper, DeckSpring, Restraint, Tendon

WAYS: dict[str, tuple[float, ...]] = {"both": (-1.0, 1.0), "left": (-1.0,), "right": (1.0,)}
"""Directions in which a deck meets its springs, by their side."""


class Place(NamedTuple):
    """Place of a device: an offset from the centre of the base [m], or the height of the deck [m].

    ``way`` is −1 or 1 for a spring that the deck meets moving left or right, 0 for a device that acts both ways.
    """

    offset: float = 0.0
    height: float = 0.0
    way: float = 0.0


def places(pier: Pier, restraint: Restraint) -> tuple[Place, ...]:
    """Return the places of ``restraint``, left before right: two if it acts at both pivots, or on both sides by the law of a
    stop; otherwise one.
    """
    if isinstance(restraint, DeckSpring):
        height = pier.deck if restraint.height_m is None else restraint.height_m
        if restraint.linear:
            return (Place(height=height),)
        return tuple(Place(0.0, height, direction) for direction in WAYS.get(restraint.side, ()))
    if restraint.at == "deck":
        return (Place(height=pier.deck),)
    b = pier.half_width
    if restraint.at is None:
        return Place(-b), Place(b)
    if isinstance(restraint.at, str):
        return (Place(-b if restraint.at == "left" else b),)
    return (Place(float(restraint.at)),)


def device_names(restraints: tuple[Restraint, ...]) -> list[str]:
    """Return the name of each device, numbered by its kind: "damper 1", "damper 2", "deck spring 1"."""
    counts = Counter[str]()
    names = []
    for device in restraints:
        counts[device.what] += 1
        names.append(f"{device.what.replace('_', ' ')} {counts[device.what]}")
    return names


def place_names(pier: Pier, restraints: tuple[Restraint, ...]) -> list[str]:
    """Return the name of the device at each place, of two with its side: "damper 1 left", "damper 1 right", "tendon 1"."""
    return [
        f"{name}{side}"
        for name, device in zip(device_names(restraints), restraints, strict=True)
        for side in ([""] if len(places(pier, device)) == 1 else [" left", " right"])
    ]


def offsets(pier: Pier, restraint: Restraint) -> tuple[float, ...]:
    """Return the offsets of ``restraint`` from the centre of the base [m], left before right; () for a device at the deck."""
    return tuple(place.offset for place in places(pier, restraint) if place.height == 0.0)


def prestress_over_weight(pier: Pier, restraints: tuple[Restraint, ...]) -> float:
    """Return Σψ of all tendons, each counted at every place."""
    return sum(tendon.psi * len(offsets(pier, tendon)) for tendon in restraints if isinstance(tendon, Tendon))


def holds_a_tilt(restraints: tuple[Restraint, ...]) -> bool:
    """Return True if a friction or hysteretic damper of f > 0 is among them, which keeps a force at rest and may hold a tilt."""
    return any(isinstance(device, Damper) and device.f > 0 for device in restraints)


def symmetric(pier: Pier, restraints: tuple[Restraint, ...]) -> bool:
    """Return True if the mirror image of the pier has equal devices at the same places; True without devices."""
    placed = [(place, _anywhere(device)) for device in restraints for place in places(pier, device)]
    return all(placed.count((_mirrored(place), device)) == placed.count((place, device)) for place, device in placed)


def _anywhere(device: Restraint) -> Restraint:
    """Return the device with a neutral place, for comparison."""
    return replace(device, side="both") if isinstance(device, DeckSpring) else replace(device, at=0.0)


def _mirrored(place: Place) -> Place:
    """Return the place in the mirror image."""
    return Place(-place.offset, place.height, -place.way)
