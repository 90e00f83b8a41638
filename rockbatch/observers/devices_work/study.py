"""Its keys of [output]."""

from dataclasses import dataclass

from rockbatch.toml.kinds import boolean, positive
from rockbatch.toml.section import Key, Section


@dataclass(frozen=True)
class DevicesWork:
    """Whether the work of devices is computed, and from which stroke half cycles count."""

    devices_work: bool = False
    least_stroke_mm: float = 10.0


OUTPUT = Section(
    ("output",),
    "",
    {
        "devices_work": Key(
            boolean,
            "true",
            "Whether the work of devices is added: travel, energy and half cycles of the damper that has most, and the strain of "
            "tendons over their yield strain.",
        ),
        "least_stroke_mm": Key(
            positive,
            "20.0",
            "Stroke, from end to end, from which half cycles of dampers count.",
            only={"devices_work": (True,)},
        ),
    },
    homes=(DevicesWork,),
)
