"""Its keys of [output]."""

from collections.abc import Iterable
from dataclasses import dataclass

from rockbatch.pier import Pier
from rockbatch.pier.sections import heights_in_all, misfits
from rockbatch.toml.kinds import Whole, not_negative
from rockbatch.toml.reader import TomlFile
from rockbatch.toml.section import Clash, Key, Section


@dataclass(frozen=True)
class Sections:
    """Sections of the shaft whose forces are computed: their number, or their heights [m]."""

    sections: int | None = None
    sections_m: tuple[float, ...] = ()

    @property
    def requested(self) -> int | tuple[float, ...] | None:
        """Return the number of the sections, or their heights [m]; None if none are requested."""
        return self.sections or self.sections_m or None


OUTPUT = Section(
    ("output",),
    "",
    {
        "sections": Key(
            Whole(2, "a whole number, 2 or above: foot and top of the pier are among them"),
            "5",
            "Number of sections of the pier, evenly from its foot to its highest point, in which shear, moment and axial force "
            "of every run are computed: `sections.csv`.",
        ),
        "sections_m": Key(
            not_negative, "[0.0, 7.5, 15.0]", "Heights of such sections above the pivots instead.", many=True
        ),
    },
    homes=(Sections,),
    clashes=(
        Clash(
            ("sections", "sections_m"),
            "sections and sections_m are given, which say the same; keep one",
            at="sections_m",
        ),
    ),
)


def complain(file: TomlFile, settings: Sections, piers: Iterable[Pier]) -> None:
    """Add a problem to ``file`` for each reason that some pier lacks the sections, or its masses are not known."""
    if settings.requested is None:
        return
    for problem in misfits(piers, settings.requested):
        file.complain(("output", "sections" if settings.sections else "sections_m"), f"[output]: {problem}")


def heights(settings: Sections, piers: Iterable[Pier]) -> set[float]:
    """Return the heights [m] of all sections of all ``piers``; a pier that lacks some, a problem by ``complain``, adds none."""
    return heights_in_all(piers, settings.requested) if settings.requested else set()


COMPLAINS = (Sections, complain)
HEIGHTS = ("sections", Sections, heights)
