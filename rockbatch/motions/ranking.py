"""The records of a set in the order in which somebody should look at them: the doubtful first, then the strongest."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property
from typing import Any

import numpy as np

from rockbatch.common.errors import Contradiction, InputError, NoDirection
from rockbatch.common.grouping import grouped
from rockbatch.common.units import GRAVITY
from rockbatch.motions import velocity_pulses
from rockbatch.motions.motion import LeftOut, Motion, Unusable
from rockbatch.motions.motion_set import MotionSet, row


class Use(Enum):
    """What becomes of a record, or of a file without one."""

    HELD_BACK = "held back"
    """Until somebody says what is right."""

    NOT_READ = "not used"
    USED = "used"
    COPY = "copy"
    LEFT_OUT = "left out"


_DOUBTS: dict[type[InputError], str] = {NoDirection: "direction", Contradiction: "contradiction"}

COLUMNS = (
    "record", "event", "station_name", "use", "check", "pga_h_g", "pga_h2_g", "pga_v_g", "pgv_h_m_s", "dt_s", "duration_s",
    "d5_95_s", "pulse_period_s", "magnitude", "distance_km", "vs30_m_s",
)  # fmt: skip
"""Of :attr:`RankedRecord.values`; ``rockbatch motions --csv`` has them, too."""

ADDED = ("pga_h2_g", "pulse_period_s", "use")
"""Columns that :meth:`MotionSet.table` does not have."""


@dataclass(frozen=True, eq=False)
class RankedRecord:
    """A record: the components of a station, or what was found in its place.

    Attributes
    ----------
    use : Use
        What becomes of it.
    name, files : str
        Name of the stronger component, or of the first file; and all files, where it was not read.
    motions : sequence of Motion
        Its horizontal components, the stronger first; none of what was not read.
    doubts : sequence of str
        What is doubtful about it, in a word or two each.
    reasons : sequence of str
        Why it is not used.
    station : str
        What its components share, if that is known.
    """

    use: Use
    name: str
    files: str
    motions: Sequence[Motion] = ()
    doubts: Sequence[str] = ()
    reasons: Sequence[str] = ()
    station: str = ""

    @property
    def doubtful(self) -> bool:
        """Return whether somebody should look at it: it is held back, or something about it is odd."""
        return self.use is Use.HELD_BACK or (self.use is Use.USED and bool(self.doubts))

    @property
    def label(self) -> str:
        """Return the short name of its station; what its components share, or its own name, if its header has none."""
        return (self.motions[0].origin.short_station if self.motions else "") or self.station or self.name

    @cached_property
    def values(self) -> dict[str, Any]:
        """Return the values under :data:`COLUMNS`, None where they are not known: those of the stronger component, with the PGA
        of the other and the doubts of both."""
        known = dict.fromkeys(COLUMNS) | {"record": self.name, "event": None}
        if self.motions:
            periods = filter(None, map(pulse_period, self.motions))
            known |= row(self.motions[0]) | {
                "pga_h2_g": _second(self.motions[0], self.motions),
                "pulse_period_s": next(periods, None),
            }
        known |= {"use": self.use.value, "check": ", ".join(self.doubts) or None}
        return {name: known[name] for name in COLUMNS}


def ranked(motions: MotionSet) -> list[RankedRecord]:
    """Return every record: those held back, files that are not read, records that are odd, all others, and copies; in each
    group the strongest first. Files that are no record are not among them."""
    records = [*_not_used(motions.unusable), *map(_used, motions.stations().values())]
    records += [
        RankedRecord(Use.COPY, file.name, file.source, reasons=[file.reason]) for file in motions.left_out if file.of
    ]
    return sorted(records, key=_order)


def _order(record: RankedRecord) -> tuple[int, float]:
    groups = (Use.HELD_BACK, Use.NOT_READ, None, Use.USED, Use.COPY)
    odd = record.use is Use.USED and record.doubtful
    return groups.index(None if odd else record.use), -record.motions[0].pga if record.motions else 0.0


def _used(components: Sequence[Motion]) -> RankedRecord:
    by_strength = sorted(components, key=lambda motion: -motion.pga)
    first = by_strength[0]
    return RankedRecord(Use.USED, first.name, first.files, by_strength, _whats(by_strength), station=first.of_station)


def _not_used(unusable: Iterable[Unusable]) -> Iterator[RankedRecord]:
    """Yield a record for the components of each station that are not used for reasons of one kind."""
    for files in grouped(unusable, lambda file: (use_of(file), file.station or file.source)).values():
        held = sorted((file.motion for file in files if file.motion), key=lambda motion: -motion.pga)
        yield RankedRecord(
            use_of(files[0]),
            held[0].name if held else files[0].name,
            ", ".join(dict.fromkeys(file.source for file in files)),
            held,
            list(dict.fromkeys(doubt for file in files for doubt in doubts(file))),
            list(dict.fromkeys(file.reason for file in files)),
            files[0].station,
        )


def use_of(file: Unusable | LeftOut) -> Use:
    """Return what becomes of a file without a motion in the set."""
    if isinstance(file, LeftOut):
        return Use.COPY if file.of else Use.LEFT_OUT
    return Use.HELD_BACK if file.motion or file.kind in _DOUBTS or file.lacks else Use.NOT_READ


def doubts(file: Unusable | LeftOut) -> list[str]:
    """Return what has to be said of a file before it is used, in a word or two each."""
    if isinstance(file, LeftOut):
        return []
    words = [_DOUBTS[file.kind]] if file.kind in _DOUBTS else []
    return [*words, *(f"no {key}" for key in file.lacks), *_whats([file.motion] if file.motion else [])]


def _whats(motions: Sequence[Motion]) -> list[str]:
    return list(dict.fromkeys(finding.what for motion in motions for finding in motion.findings))


def _second(motion: Motion, others: Iterable[Motion]) -> float | None:
    """Return the PGA across a motion [g]: of its strongest other horizontal component, which may be no motion of its own."""
    across = max((other.pga for other in others if other is not motion), default=None)
    if across is None and motion.across is not None:
        across = float(np.abs(motion.across).max())
    return None if across is None else across / GRAVITY


def pulse_period(motion: Motion) -> float | None:
    """Return the period of the pulse [s] by the list beside the record, else by Baker (2007); None without a pulse."""
    listed = motion.listed.pulse_period_s
    return velocity_pulses.pulse_period(motion) if listed is None else listed


def rows(motions: MotionSet) -> list[dict[str, Any]]:
    """Return the rows of ``rockbatch motions --csv``: one for each component in the order of the set, then one for each file
    that is not used, with the ``reason``."""
    stations = motions.stations()
    not_used: list[Unusable | LeftOut] = [*motions.unusable, *motions.left_out]
    used = [_row(motion, stations[motion.of_station]) | {"use": Use.USED.value} for motion in motions]
    return used + [
        _named(file) | {"use": use_of(file).value, "check": ", ".join(doubts(file)) or None, "reason": file.reason}
        for file in not_used
    ]


def _row(motion: Motion, components: Sequence[Motion]) -> dict[str, Any]:
    return row(motion) | {"pga_h2_g": _second(motion, components), "pulse_period_s": pulse_period(motion)}


def _named(file: Unusable | LeftOut) -> dict[str, Any]:
    """Return what is known of a file that is not used: the measures of a motion that is held back."""
    held = file.motion if isinstance(file, Unusable) else None
    return _row(held, ()) if held else {"record": file.name, "file_h": file.source}
