"""Its keys of [output]."""

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass

from rockbatch.common.errors import InputError
from rockbatch.pier import Pier
from rockbatch.pier.sections import section_heights
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
    """Note sections that some pier does not have, or that have no forces in kN."""
    if not settings.interaction_m:
        return
    wrong = dict[str, None]()
    for pier in piers:
        try:
            section_heights(pier, settings.interaction_m, "interaction_m")
        except InputError as error:
            wrong |= dict.fromkeys(error.messages)
        if pier.mass_t is None:
            wrong["interaction_m: its forces are in kN; write mass_t under [pier]"] = None
    for problem in wrong:
        file.complain(("output", "interaction_m"), f"[output]: {problem}")


def heights(settings: Interaction, piers: Iterable[Pier]) -> set[float]:
    """Return the heights [m] of the sections of all ``piers``; none of a pier that lacks some, which is noted."""
    found = set[float]()
    for pier in piers if settings.interaction_m else ():
        with suppress(InputError):
            found.update(section_heights(pier, settings.interaction_m, "interaction_m"))
    return found


COMPLAINS = (Interaction, complain)
HEIGHTS = ("interaction", Interaction, heights)
