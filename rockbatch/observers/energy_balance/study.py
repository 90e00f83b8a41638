"""Its keys of [output]."""

from dataclasses import dataclass

from rockbatch.toml.kinds import boolean
from rockbatch.toml.meant import names
from rockbatch.toml.section import Key, Section


@dataclass(frozen=True)
class Ledger:
    """Whether the energy balance is kept."""

    ledger: bool = False


OUTPUT = Section(
    ("output",),
    "",
    {
        "ledger": Key(boolean, "true", "Whether the energy ledger of every run is added to the table."),
    },
    homes=(Ledger,),
    also=names({"ledger": "energy"}),
)
