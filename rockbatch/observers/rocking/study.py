"""Its keys of [output]."""

from dataclasses import dataclass

from rockbatch.toml.kinds import boolean
from rockbatch.toml.section import Key, Section


@dataclass(frozen=True)
class Separation:
    """Whether rocking is separated from lean."""

    rocking: bool = False


OUTPUT = Section(
    ("output",),
    "",
    {
        "rocking": Key(
            boolean,
            "true",
            "Whether the rocking about a base that has yielded is separated from its lean in every run, which takes one more.",
        ),
    },
    homes=(Separation,),
)
