"""Its keys of [output]."""

from dataclasses import dataclass

from rockbatch.toml.kinds import boolean
from rockbatch.toml.section import Key, Section


@dataclass(frozen=True)
class BothLaws:
    """Whether settlements are found by both spring laws."""

    both_laws: bool = False


OUTPUT = Section(
    ("output",),
    "",
    {
        "both_laws": Key(
            boolean,
            "true",
            "Whether the settlement of Bouc–Wen springs is found by the elastic–perfectly plastic law too, which takes two more "
            "runs or more; of others it is not a range. A check of a settlement, which takes the worse, has it found too.",
        ),
    },
    homes=(BothLaws,),
)
