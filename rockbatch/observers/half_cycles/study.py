"""Its keys of [output]."""

from dataclasses import dataclass

from rockbatch.toml.kinds import boolean
from rockbatch.toml.section import Key, Section


@dataclass(frozen=True)
class Cycles:
    """Whether half_cycles.csv is written."""

    half_cycles: bool = False


OUTPUT = Section(
    ("output",),
    "",
    {
        "half_cycles": Key(
            boolean,
            "true",
            "Whether half_cycles.csv is written: of every run the times of impacts, the angular velocities around them and the "
            "amplitudes in between; half_cycle 0 begins with the run, such as a release, and not with an impact.",
        ),
    },
    homes=(Cycles,),
)
