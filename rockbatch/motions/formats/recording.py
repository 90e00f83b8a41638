"""One channel as its file has it, in its own unit, and the way from there to a component in m/s²."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from rockbatch.common.errors import InputError
from rockbatch.common.showing import shown
from rockbatch.common.units import acceleration_factor, length_factor
from rockbatch.motions.component import UNKNOWN_SENSOR, Component, Sensor
from rockbatch.motions.evidence import Kind, Statement
from rockbatch.motions.formats.stated import Sampled, Stated, contradictions
from rockbatch.motions.measures import initial_of
from rockbatch.motions.motion import Finding, Initial, Samples, Unusable
from rockbatch.motions.orientation import Orientation, is_clock, orientation_of, unknown
from rockbatch.motions.origin import UNKNOWN_ORIGIN, Origin
from rockbatch.motions.record_file import RecordFile

Series = tuple[Samples, str]
"""Values, shape (npts,), and their unit."""


@dataclass(frozen=True)
class Recording:
    """One channel of a file."""

    label: str  # its direction, as the file has it: "N10E", "Up", "HNZ"
    dt: float  # sampling interval [s]
    values: Samples  # accelerations in unit, shape (npts,)
    unit: str  # as units.acceleration_factor understands it
    station: str = ""  # what the channels of one station share, other versions of the same record not included
    orientation: Orientation | None = None  # where it is not what the label says
    stated_by: Kind = Kind.HEADER  # what the label is from
    codes: tuple[str, str, str, str] | None = None  # network, station, location, channel for ObsPy; else of the sensor
    start: float | None = None  # time of the first sample [s since 1970, UTC]
    processed: bool | None = None  # whether the agency has corrected it; None where the file does not say
    raw: bool | None = None  # whether the instrument's offset may still be in it; None: if it is not processed
    sensor: Sensor = UNKNOWN_SENSOR  # as the header states it
    event: str = ""  # what the header says of it
    initial: Initial | None = None  # the ground's state at the first sample, where the header has it
    velocities: Series | None = None  # beside the accelerations
    displacements: Series | None = None  # likewise
    stated: tuple[Stated, ...] = ()  # what else the header states of the samples
    counts: bool = False  # whether the file has counts, and their scale: no unit of its own
    as_read: Samples | None = None  # accelerations before they were interpolated, which have the stated peak and count
    notes: tuple[str, ...] = ()  # what was done to the data
    origin: Origin = UNKNOWN_ORIGIN  # what the header calls event and station
    header: dict[str, str] = field(default_factory=dict)  # what else it says, for ObsPy


def reader(parse: Callable[[str], Sequence[Recording]]) -> Callable[[RecordFile], list[Component | Unusable]]:
    """Return the reader of a format of text: the recordings that ``parse`` makes of it, as components."""

    def read(file: RecordFile) -> list[Component | Unusable]:
        """Return the components of a file in m/s², or ``InputError`` with the line where it is not whole."""
        return to_components(file, parse(file.text))

    return read


def letters(text: str, most: int = 5) -> str:
    """Return the first ASCII letters and digits of a text, as a code of SEED."""
    return "".join(c for c in text if c.isascii() and c.isalnum())[:most]


def to_components(file: RecordFile, recordings: Sequence[Recording]) -> list[Component | Unusable]:
    """Return the channels of ``file`` in m/s², named by its stem and, if there are several, their labels.

    A channel whose unit is not understood is an ``Unusable`` beside the others.
    """
    readings: list[Component | Unusable] = []
    for recording in recordings:
        several = len(recordings) > 1
        name = f"{file.stem}.{recording.label}" if several else file.stem
        source = f"{file.source} ({recording.label})" if several else file.source
        try:
            readings.append(_component(file, recording, name, source))
        except InputError as error:
            readings.append(Unusable(name, source, str(error), recording.label))
    return readings


def _component(file: RecordFile, recording: Recording, name: str, source: str) -> Component:
    """Return one channel as a component; ``InputError`` for a clock's, and for a unit that is not understood."""
    if is_clock(recording.label):
        raise InputError(f'component "{recording.label}": the recorder\'s clock, no ground motion')
    orientation = recording.orientation or orientation_of(recording.label) or unknown(recording.label)
    try:
        factor = acceleration_factor(recording.unit, file.gravity)
    except ValueError as error:
        raise InputError(f'component "{recording.label}": {error}') from None
    words = "it is stated to be" if recording.stated_by is Kind.USER else "its header says"
    acceleration = recording.values * factor
    series = [_in_metres(samples) for samples in (recording.velocities, recording.displacements)]
    findings = contradictions_of(recording, factor, file.gravity)
    return Component(
        name=name,
        dt=recording.dt,
        acceleration=acceleration,
        orientation=orientation,
        statements=(Statement(recording.stated_by, f"{words} {shown(recording.label)}", orientation),)
        if orientation.known
        else (),
        station=recording.station,
        source=source,
        start=recording.start,
        unit="" if recording.counts else recording.unit,
        raw=recording.processed is False if recording.raw is None else recording.raw,
        sensor=recording.sensor,
        event=" ".join(recording.event.upper().split()),
        processed=recording.processed,
        origin=recording.origin,
        initial=initial_of(acceleration, recording.dt, *series) or recording.initial,
        notes=(*recording.notes, *(finding.text for finding in findings if not finding.what)),
        findings=tuple(finding for finding in findings if finding.what),
    )


def contradictions_of(recording: Recording, factor: float, gravity: float) -> list[Finding]:
    """Return how a recording's samples, which ``factor`` brings into m/s², differ from what its header states."""
    as_read = recording.values if recording.as_read is None else recording.as_read
    sampled = Sampled(recording.values, recording.dt, recording.unit, factor, as_read)
    return contradictions(recording.stated, sampled, gravity)


def _in_metres(series: Series | None) -> Samples | None:
    """Return velocities in m/s, displacements in m; ``None`` if missing or in an unknown unit."""
    if series is None or (factor := length_factor(series[1])) is None:
        return None
    return series[0] * factor
