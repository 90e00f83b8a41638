"""Its keys of [output]."""

from collections.abc import Iterable
from dataclasses import dataclass

from rockbatch.pier import Pier
from rockbatch.pier.sections import heights_in_all, misfits
from rockbatch.toml.kinds import not_negative
from rockbatch.toml.reader import TomlFile
from rockbatch.toml.section import Key, Section


@dataclass(frozen=True)
class Interaction:
    """Heights [m] of the sections whose axial force and moment are kept together."""

    interaction_m: tuple[float, ...] = ()


OUTPUT = Section(
    ("output",),
    "",
    {
        "interaction_m": Key(
            not_negative,
            "[0.0, 7.5]",
            "Heights above the pivots of sections of which interaction.csv has the axial force and the moment of the same "
            "moment, for checks with a `capacity`.",
            many=True,
        ),
    },
    homes=(Interaction,),
)


def complain(file: TomlFile, settings: Interaction, piers: Iterable[Pier]) -> None:
    """Add a problem to ``file`` for each reason that some pier lacks a section, and if a pier has no mass for forces in kN."""
    if not settings.interaction_m:
        return
    reasons = misfits(piers, settings.interaction_m, "interaction_m")
    if any(pier.mass_t is None for pier in piers):
        reasons.append("interaction_m: its forces are in kN; write mass_t under [pier]")
    for reason in reasons:
        file.complain(("output", "interaction_m"), f"[output]: {reason}")


def heights(settings: Interaction, piers: Iterable[Pier]) -> set[float]:
    """Return the heights [m] of the sections of all ``piers``; a pier that lacks one, a problem by ``complain``, adds none."""
    return heights_in_all(piers, settings.interaction_m, "interaction_m") if settings.interaction_m else set()


COMPLAINS = (Interaction, complain)
HEIGHTS = ("interaction", Interaction, heights)
