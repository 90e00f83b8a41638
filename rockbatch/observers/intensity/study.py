"""Its keys of [output]."""

from dataclasses import dataclass

from rockbatch.motions.intensity.pairs import TWO_COMPONENT_RULES
from rockbatch.toml.kinds import boolean, choice, positive
from rockbatch.toml.meant import names
from rockbatch.toml.section import Key, Section


@dataclass(frozen=True)
class Measures:
    """Whether intensity measures are written, and their spectral accelerations: periods [s], and rules for pairs."""

    intensity: bool = False
    sa_periods_s: tuple[float, ...] = (0.5, 1.0, 2.0, 4.0)
    sa_pairs: tuple[str, ...] = ()


OUTPUT = Section(
    ("output",),
    "",
    {
        "intensity": Key(
            boolean,
            "true",
            "Whether intensity measures of each motion are written, and which of them orders the peaks best.",
        ),
        "sa_periods_s": Key(
            positive,
            "[0.5, 1.0, 2.0]",
            "Periods of the spectral accelerations among the intensity measures.",
            many=True,
            only={"intensity": (True,)},
        ),
        "sa_pairs": Key(
            choice(*TWO_COMPONENT_RULES),
            '["rotd50", "rotd100"]',
            "Spectral accelerations of both components of a station, beside those of each: their geometric mean, and the "
            "median and the greatest over all directions.",
            many=True,
            only={"intensity": (True,)},
        ),
    },
    homes=(Measures,),
    also=names({"intensity": "intensitymeasures"}),
)
