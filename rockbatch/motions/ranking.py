"""The records of a set in the order in which to look at them: doubtful ones first, then the strongest."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import cached_property

import numpy as np

from rockbatch.common.errors import Contradiction, InputError, NoDirection
from rockbatch.common.grouping import grouped
from rockbatch.common.units import GRAVITY
from rockbatch.motions.intensity import velocity_pulses
from rockbatch.motions.motion import Motion
from rockbatch.motions.motion_set import Cell, MotionSet, row
from rockbatch.motions.unused import LeftOut, Unusable


class Use(Enum):
    """The use made of a record, or of a file without one."""

    HELD_BACK = "held back"
    """Until the user states the facts."""

    NOT_READ = "not used"
    USED = "used"
    COPY = "copy"
    LEFT_OUT = "left out"


_DOUBTS: dict[type[InputError], str] = {NoDirection: "direction", Contradiction: "contradiction"}

COLUMNS = (
    "record",
    "event",
    "station_name",
    "use",
    "check",
    "pga_h_g",
    "pga_h2_g",
    "pga_v_g",
    "pgv_h_m_s",
    "dt_s",
    "duration_s",
    "d5_95_s",
    "pulse_period_s",
    "magnitude",
    "distance_km",
    "vs30_m_s",
)
"""Keys of :attr:`RankedRecord.values`; ``rockbatch motions --csv`` has them, too."""

ADDED = ("pga_h2_g", "pulse_period_s", "use")
"""Columns that :meth:`MotionSet.table` does not have."""


@dataclass(frozen=True, eq=False)
class RankedRecord:
    """A record: the components of a station, or the files that could not be read as such.

    Attributes
    ----------
    use : Use
        Whether it is used, held back, not read, a copy, or left out.
    name, files : str
        Name of the stronger component, or of the first file; its files, of all components if they are not used.
    motions : sequence of Motion
        Its horizontal components, the stronger first; empty if none was read.
    doubts : sequence of str
        Its doubtful features, in a word or two each.
    reasons : sequence of str
        Why it is not used.
    station : str
        Name shared by its components; empty if unknown.
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
        """Return whether it needs a look: it is held back, or used with doubts."""
        return self.use is Use.HELD_BACK or (self.use is Use.USED and bool(self.doubts))

    @property
    def label(self) -> str:
        """Return the short name of its station by the header, else the name shared by its components, else its own."""
        return (self.motions[0].origin.short_station if self.motions else "") or self.station or self.name

    @cached_property
    def values(self) -> dict[str, Cell]:
        """Return :data:`COLUMNS` for the stronger component, with the other's PGA [g] and doubts about both; None if unknown.

        The pulse period is of the first component that has a pulse.
        """
        known: dict[str, Cell] = dict.fromkeys(COLUMNS)
        known["record"] = self.name
        if self.motions:
            periods = filter(None, map(pulse_period, self.motions))
            known |= row(self.motions[0]) | {
                "pga_h2_g": _other_pga_g(self.motions[0], self.motions),
                "pulse_period_s": next(periods, None),
            }
        known |= {"use": self.use.value, "check": ", ".join(self.doubts) or None}
        return {name: known[name] for name in COLUMNS}


def ranked_records(motions: MotionSet) -> list[RankedRecord]:
    """Return the records of a set: held back, not read, doubtful, other used ones, copies; the strongest first in each group.

    Of the files left out, only copies are in it.
    """
    records = [*_unused_records(motions.unusable), *map(_used_record, motions.stations().values())]
    records += [
        RankedRecord(Use.COPY, file.name, file.source, reasons=[file.reason]) for file in motions.left_out if file.of
    ]
    return sorted(records, key=_sort_key)


def _sort_key(record: RankedRecord) -> tuple[int, float]:
    """Return the sort key of a record: its group, as :func:`ranked_records` lists them, and the negative PGA [m/s²]."""
    groups = (Use.HELD_BACK, Use.NOT_READ, None, Use.USED, Use.COPY)
    odd = record.use is Use.USED and record.doubtful
    return groups.index(None if odd else record.use), -record.motions[0].pga if record.motions else 0.0


def _used_record(components: Sequence[Motion]) -> RankedRecord:
    """Return the record of a station's used motions, the strongest first, with the names of their findings as doubts."""
    ordered = sorted(components, key=lambda motion: -motion.pga)
    first = ordered[0]
    return RankedRecord(Use.USED, first.name, first.files, ordered, _finding_names(ordered), station=first.of_station)


def _unused_records(unusable: Iterable[Unusable]) -> Iterator[RankedRecord]:
    """Yield a record for the unusable components of each station, and for each ``Use`` that they have."""
    for files in grouped(unusable, lambda file: (use_of(file), file.station or file.source)).values():
        held = sorted((file.motion for file in files if file.motion), key=lambda motion: -motion.pga)
        yield RankedRecord(
            use_of(files[0]),
            held[0].name if held else files[0].name,
            ", ".join(dict.fromkeys(file.source for file in files)),
            held,
            list(dict.fromkeys(doubt for file in files for doubt in doubts_about(file))),
            list(dict.fromkeys(file.reason for file in files)),
            files[0].station,
        )


def use_of(file: Unusable | LeftOut) -> Use:
    """Return the ``Use`` of a file not used: held back if the user can state or confirm what it lacks, else "not used".

    A file that was left out is a copy, or left out.
    """
    if isinstance(file, LeftOut):
        return Use.COPY if file.of else Use.LEFT_OUT
    return Use.HELD_BACK if file.motion or file.kind in _DOUBTS or file.lacks else Use.NOT_READ


def doubts_about(file: Unusable | LeftOut) -> list[str]:
    """Return the doubts about a file in a word or two each: unknown direction, missing keys, findings; [] if it is left out."""
    if isinstance(file, LeftOut):
        return []
    words = [_DOUBTS[file.kind]] if file.kind in _DOUBTS else []
    return [*words, *(f"no {key}" for key in file.lacks), *_finding_names([file.motion] if file.motion else [])]


def _finding_names(motions: Sequence[Motion]) -> list[str]:
    return list(dict.fromkeys(finding.what for motion in motions for finding in motion.findings))


def _other_pga_g(motion: Motion, others: Iterable[Motion]) -> float | None:
    """Return the PGA [g] of the strongest other component of a station, else of the one across ``motion``; None without both."""
    across = max((other.pga for other in others if other is not motion), default=None)
    if across is None and motion.across is not None:
        across = float(np.abs(motion.across).max())
    return None if across is None else across / GRAVITY


def pulse_period(motion: Motion) -> float | None:
    """Return the period of the pulse [s] by the list beside the record, else by Baker (2007); None without a pulse."""
    listed = motion.listed.pulse_period_s
    return velocity_pulses.pulse_period(motion) if listed is None else listed


def rows(motions: MotionSet) -> list[dict[str, Cell]]:
    """Return the rows of ``rockbatch motions --csv``: one per motion, then per unused or left-out file, with its ``reason``."""
    stations = motions.stations()
    not_used: list[Unusable | LeftOut] = [*motions.unusable, *motions.left_out]
    table = [_row(motion, stations[motion.of_station]) | {"use": Use.USED.value} for motion in motions]
    for file in not_used:
        held = file.motion if isinstance(file, Unusable) else None
        measured = _row(held, ()) if held else {"record": file.name, "file_h": file.source}
        doubts = ", ".join(doubts_about(file)) or None
        table.append({**measured, "use": use_of(file).value, "check": doubts, "reason": file.reason})
    return table


def _row(motion: Motion, components: Sequence[Motion]) -> dict[str, Cell]:
    """Return the row of a motion, with the PGA [g] of its station's strongest other component and the period of its pulse [s]."""
    return row(motion) | {"pga_h2_g": _other_pga_g(motion, components), "pulse_period_s": pulse_period(motion)}
