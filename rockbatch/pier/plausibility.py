"""Devices that are impossible under a pier."""

from rockbatch.common.errors import Contradiction, OutOfRange, Problem
from rockbatch.pier.block import Pier
from rockbatch.pier.dampers import Damper
from rockbatch.pier.places import offsets, symmetric
from rockbatch.pier.restraints import DeckSpring, Restraint, Tendon


def wrong_on_springs(pier: Pier, restraints: tuple[Restraint, ...]) -> list[Problem]:
    """Return what is impossible about dampers and tendons of a pier on springs; empty if nothing."""
    if symmetric(pier, tuple(device for device in restraints if isinstance(device, Tendon))):
        return []
    text = (
        "on springs a tendon off the axis needs its like on the other side, or it leans the pier before any earthquake; "
        "write a second one with the opposite at, or leave at out"
    )
    return [Problem("", None, text, "tendon", kind=Contradiction)]


def wrong_restraints(pier: Pier, restraints: tuple[Restraint, ...]) -> list[Problem]:
    """Return what is impossible about devices under ``pier``; empty if nothing."""
    wrong = []
    at_deck = any(isinstance(device, DeckSpring) or device.at == "deck" for device in restraints)
    if at_deck and pier.deck_over_columns is not None:
        text = (
            "devices at the deck of a rocking frame are not solved, those at the feet of its columns are; leave deck_spring "
            'and dampers with at = "deck" out, or columns'
        )
        wrong.append(Problem("columns", None, text, kind=Contradiction))
    wrong += [problem for device in restraints for problem in wrong_device(pier, device)]
    return wrong or _wrong_friction(pier, restraints)


def wrong_device(pier: Pier, device: Restraint) -> list[Problem]:
    """Return what is impossible about the place of a device under ``pier``; empty if nothing is."""
    if isinstance(device, DeckSpring) or not isinstance(device.at, float | int):
        return []
    if abs(device.at) <= 2.0 * pier.half_width:
        return []
    bound = f"must be within the base's width either side, {2 * pier.half_width:.4g} m"
    return [Problem("at", float(device.at), bound, device.what, kind=OutOfRange)]


def _wrong_friction(pier: Pier, restraints: tuple[Restraint, ...]) -> list[Problem]:
    rubbing = [damper for damper in restraints if isinstance(damper, Damper) and damper.kind == "friction"]
    if sum(len(offsets(pier, damper)) for damper in rubbing) <= 2:
        return []
    text = (
        "two places of friction at most can be solved, for example one damper at both pivots; join their forces, or "
        'write kind = "hysteretic" with a small yield_mm, whose limit friction is'
    )
    return [Problem("", None, text, "damper")]
