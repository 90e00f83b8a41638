"""Checks for devices that are impossible under a pier."""

from rockbatch.common.errors import Contradiction, OutOfRange, Problem
from rockbatch.pier.block import Pier
from rockbatch.pier.places import offsets, symmetric
from rockbatch.pier.restraints import DeckSpring, Restraint, Tendon


def lopsided_tendons(pier: Pier, restraints: tuple[Restraint, ...]) -> list[Problem]:
    """Return the problem of tendons of a pier on springs that have no equal ones on its other side; [] if all have."""
    if symmetric(pier, tuple(device for device in restraints if isinstance(device, Tendon))):
        return []
    text = (
        "on springs a tendon off the axis needs an equal one on the other side, or the pier leans before any earthquake; "
        "write a second one with the opposite at, or leave at out"
    )
    return [Problem("", None, text, "tendon", kind=Contradiction)]


def wrong_restraints(pier: Pier, restraints: tuple[Restraint, ...]) -> list[Problem]:
    """Return the problems of devices impossible under ``pier``: at a frame's deck, or farther from the axis than its width.

    Without these, the problem of friction at more than two places, which is not solved; [] if all are possible.
    """
    wrong = []
    at_deck = any(isinstance(device, DeckSpring) or device.at == "deck" for device in restraints)
    if at_deck and pier.deck_over_columns is not None:
        text = (
            "devices at the deck of a rocking frame are not solved, only those at the feet of its columns; leave out "
            'deck_spring and dampers with at = "deck", or columns'
        )
        wrong.append(Problem("columns", None, text, kind=Contradiction))
    wrong += [problem for device in restraints for problem in wrong_device(pier, device)]
    return wrong or _wrong_friction(pier, restraints)


def wrong_device(pier: Pier, device: Restraint) -> list[Problem]:
    """Return the problem of a device farther from the axis than the base's width; [] otherwise, and for one at the deck."""
    if isinstance(device, DeckSpring) or not isinstance(device.at, float | int):
        return []
    if abs(device.at) <= 2.0 * pier.half_width:
        return []
    bound = f"must be within the base's width either side, {2 * pier.half_width:.4g} m"
    return [Problem("at", float(device.at), bound, device.what, kind=OutOfRange)]


def _wrong_friction(pier: Pier, restraints: tuple[Restraint, ...]) -> list[Problem]:
    rubbing = [device for device in restraints if device.law == "friction"]
    if sum(len(offsets(pier, device)) for device in rubbing) <= 2:
        return []
    text = (
        "two places of friction at most can be solved, for example one damper at both pivots; join their forces, or "
        'write kind = "hysteretic" with a small yield_mm, whose limit friction is'
    )
    return [Problem("", None, text, "damper")]
