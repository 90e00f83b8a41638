"""Zero offsets of records: their removal from the accelerations, and the note on it.

No other baseline correction is done anywhere: no filter, no fitted line.
"""

import math
from dataclasses import dataclass, replace

from rockbatch.common.errors import InputError
from rockbatch.motions.component import Component

RULES = ("as needed", "keep", "mean", "pre-event")


@dataclass(frozen=True)
class Offset:
    """Rule for the offset removed from every component.

    "as needed": the mean over the record where the format leaves the instrument's zero in it (K-NET, counts), nothing
    elsewhere; "keep": nothing; "mean": the mean over the record; "pre-event": the mean over ``window_s``. Raises ``InputError``
    for another rule, a window without "pre-event" or the reverse, and times out of order.
    """

    rule: str = "as needed"
    window_s: tuple[float, float] | None = None  # from and to [s from the first sample], for "pre-event" only

    def __post_init__(self) -> None:
        if self.rule not in RULES:
            raise InputError(f'offset = "{self.rule}": must be one of {", ".join(RULES)}')
        if (self.rule == "pre-event") != (self.window_s is not None):
            raise InputError('offset = "pre-event" takes offset_window_s = [start, end], and no other offset does')
        if self.window_s is not None and not 0 <= self.window_s[0] < self.window_s[1] < math.inf:
            raise InputError(f"offset_window_s = {list(self.window_s)}: must be two times in order, from 0 [s]")


def remove_offset(component: Component, offset: Offset) -> Component:
    """Return ``component`` less its offset by the rule, with a note, and no longer raw; itself if the rule removes nothing.

    Of a raw component, "keep" leaves the offset in, with a note. Raises ``InputError`` for a window outside the record.
    """
    if offset.rule == "keep":
        if not component.raw:
            return component
        note = f"offset {component.acceleration.mean():.4g} m/s² kept (mean over the record)"
        return replace(component, raw=False, notes=(*component.notes, note))
    if offset.rule == "as needed" and not component.raw:
        return component
    inside, span = component.acceleration, "over the record"  # needs no picking, and makes the final velocity zero
    if offset.window_s is not None:
        start, end = offset.window_s
        inside = inside[math.ceil(start / component.dt - 1e-9) : math.floor(end / component.dt + 1e-9) + 1]
        if end > component.duration or len(inside) == 0:
            raise InputError(f"offset_window_s = [{start:g}, {end:g}] is not within its {component.duration:g} s")
        span = f"from {start:g} to {end:g} s, before the event"
    mean = float(inside.mean())
    notes = (*component.notes, f"offset {mean:.4g} m/s² removed (mean {span})")
    return replace(component, acceleration=component.acceleration - mean, raw=False, notes=notes)
