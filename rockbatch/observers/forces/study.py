"""Its keys of [output]."""

from collections.abc import Iterable
from dataclasses import dataclass

from rockbatch.outcome.outcome import LEAST_NORMAL_SHARE
from rockbatch.pier import Pier
from rockbatch.toml.kinds import boolean, share
from rockbatch.toml.reader import TomlFile
from rockbatch.toml.section import Key, Section


@dataclass(frozen=True)
class Forces:
    """Whether forces are computed, and from which share of the weight friction counts."""

    forces: bool = False
    least_normal_share: float = LEAST_NORMAL_SHARE


OUTPUT = Section(
    ("output",),
    "",
    {
        "forces": Key(
            boolean,
            "true",
            "Whether what designers size is added: base shear, friction, forces of the supports, gaps, impacts, accelerations.",
        ),
        "least_normal_share": Key(
            share,
            "0.1",
            "Share of the weight that the normal force has to exceed for the friction demand to count: below it, as in a hop, "
            "shear keys carry the base shear, which is a column of its own.",
            only={"forces": (True,)},
        ),
    },
    homes=(Forces,),
)


_OF_FORCES = {
    "friction": "is compared only with the friction demand; write forces = true under [output], which computes it",
    "contact_stiffness_kN_m": "is of the force of a landing; write forces = true under [output], which computes it",
}
"""Keys of a [[case]] that only forces use, each with its problem without forces."""


def complain(file: TomlFile, settings: Forces, piers: Iterable[Pier]) -> None:
    """Add a problem to ``file`` for each key of a [[case]] that only forces use, unless the study has forces."""
    if settings.forces:
        return
    for table in file.tables("case", title="name"):
        for key, problem in _OF_FORCES.items():
            if key in table.data:
                table.complain(f"{key}: {problem}, or leave it out", key)


COMPLAINS = (Forces, complain)
