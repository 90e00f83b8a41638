"""Its keys of [output]."""

from collections.abc import Iterable
from dataclasses import dataclass

from rockbatch.pier import Pier
from rockbatch.pier.sections import heights_in_all, misfits
from rockbatch.toml.kinds import boolean, not_negative
from rockbatch.toml.reader import TomlFile
from rockbatch.toml.section import Key, Section


@dataclass(frozen=True)
class Interaction:
    """Heights [m] of the sections whose axial force and moment are kept together, and whether shear and normal force of the base
    are."""

    interaction_m: tuple[float, ...] = ()
    interaction_base: bool = False

    @property
    def requested(self) -> tuple[float, ...]:
        """Return the heights [m] of the sections; () if none are requested."""
        return self.interaction_m


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
        "interaction_base": Key(
            boolean,
            "true",
            "Whether interaction.csv has the normal force of the base and its shear of the same moment. A check of "
            "`base_shear_over_capacity` keeps them, too; set it for checks to be written later.",
        ),
    },
    homes=(Interaction,),
)


def complain(file: TomlFile, settings: Interaction, piers: Iterable[Pier]) -> None:
    """Add a problem to ``file`` for each reason that some pier lacks a section, and for each key given if a pier has no mass."""
    asked = {"interaction_m": bool(settings.interaction_m), "interaction_base": settings.interaction_base}
    reasons = []
    if settings.interaction_m:
        reasons = [("interaction_m", reason) for reason in misfits(piers, settings.interaction_m, "interaction_m")]
    if any(pier.mass_t is None for pier in piers):
        text = "its forces are in kN; write mass_t under [pier]"
        reasons += [(key, f"{key}: {text}") for key, given in asked.items() if given]
    for key, reason in reasons:
        file.complain(("output", key), f"[output]: {reason}")


def heights(settings: Interaction, piers: Iterable[Pier]) -> set[float]:
    """Return the heights [m] of the sections of all ``piers``; a pier that lacks one, a problem by ``complain``, adds none."""
    return heights_in_all(piers, settings.interaction_m, "interaction_m") if settings.interaction_m else set()


COMPLAINS = (Interaction, complain)
HEIGHTS = ("interaction", Interaction, heights)
