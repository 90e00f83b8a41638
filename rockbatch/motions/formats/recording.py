"""One channel of a file in its own unit, and its conversion to a component in m/s²."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from rockbatch.common.errors import InputError
from rockbatch.common.showing import shown
from rockbatch.common.units import acceleration_factor, length_factor
from rockbatch.motions.component import UNKNOWN_SENSOR, Component, Sensor
from rockbatch.motions.formats.stated import Sampled, Stated, contradictions
from rockbatch.motions.intensity.measures import initial_of
from rockbatch.motions.labels.evidence import Kind, Statement, decided_orientation
from rockbatch.motions.labels.orientation import Orientation, is_clock, orientation_of, unknown
from rockbatch.motions.labels.origin import UNKNOWN_ORIGIN, Origin
from rockbatch.motions.motion import Finding, Initial, Samples
from rockbatch.motions.sources.record_file import RecordFile
from rockbatch.motions.sources.source import Source
from rockbatch.motions.unused import Unusable

Series = tuple[Samples, str]
"""Values, shape (npts,), and their unit."""


@dataclass(frozen=True)
class Recording:
    """One channel of a file."""

    label: str  # its direction, as in the file: "N10E", "Up", "HNZ"
    dt: float  # sampling interval [s]
    values: Samples  # accelerations in unit, shape (npts,)
    unit: str  # as understood by units.acceleration_factor
    station: str = ""  # key shared by the channels of one station, but not by other versions of the same record
    orientation: Orientation | None = None  # if it differs from that of the label
    stated_by: Kind = Kind.HEADER  # source of the label
    statements: tuple[Statement, ...] = ()  # of its direction by lines of the header; may include that by the label
    codes: tuple[str, str, str, str] | None = None  # network, station, location, channel for ObsPy; else of the sensor
    start: float | None = None  # time of the first sample [s since 1970, UTC]
    processed: bool | None = None  # whether the agency has corrected it; None if the file does not say
    raw: bool | None = None  # whether the instrument's offset may still be in it; None: if it is not processed
    sensor: Sensor = UNKNOWN_SENSOR  # by the header
    event: str = ""  # by the header
    initial: Initial | None = None  # the ground's state at the first sample, by the header
    velocities: Series | None = None  # in the same file
    displacements: Series | None = None  # in the same file
    stated: tuple[Stated, ...] = ()  # the header's statements about the samples
    counts: bool = False  # whether the file has counts with a scale, and so no unit of its own
    as_read: Samples | None = None  # accelerations before interpolation, with the stated peak and count
    notes: tuple[str, ...] = ()  # on processing
    findings: tuple[Finding, ...] = ()  # contradictions within the header
    origin: Origin = UNKNOWN_ORIGIN  # event and station in words, by the header
    header: dict[str, str] = field(default_factory=dict)  # further facts, for ObsPy


def reader(parse: Callable[[str], Sequence[Recording]]) -> Callable[[RecordFile], list[Component | Unusable]]:
    """Return the reader of a text format whose files ``parse`` turns into recordings: it returns components in m/s²."""
    return lambda file: to_components(file, parse(file.text))


def letters(text: str, most: int = 5) -> str:
    """Return the first ``most`` ASCII letters and digits of a text, without other characters: a SEED code."""
    return "".join(c for c in text if c.isascii() and c.isalnum())[:most]


def to_components(file: RecordFile, recordings: Sequence[Recording]) -> list[Component | Unusable]:
    """Return the channels of ``file`` in m/s², named by its stem and, if there are several, their labels.

    A channel in an unknown unit, and the recorder's clock, become an ``Unusable`` beside the others.
    """
    readings: list[Component | Unusable] = []
    for recording in recordings:
        several = len(recordings) > 1
        name = f"{file.stem}.{recording.label}" if several else file.stem
        source = Source(file.source, recording.label) if several else file.source
        try:
            readings.append(_component(file, recording, name, source))
        except InputError as error:
            readings.append(Unusable(name, (source,), str(error), recording.label, kind=type(error)))
    return readings


def _component(file: RecordFile, recording: Recording, name: str, source: str) -> Component:
    """Return one channel as a component; raise ``InputError`` for the recorder's clock, and for an unknown unit."""
    if is_clock(recording.label):
        raise InputError(f'component "{recording.label}": the recorder\'s clock, no ground motion')
    orientation = recording.orientation or orientation_of(recording.label) or unknown(recording.label)
    try:
        factor = acceleration_factor(recording.unit, file.gravity)
    except ValueError as error:
        raise InputError(f'component "{recording.label}": {error}') from None
    words = "it is stated to be" if recording.stated_by is Kind.USER else "its header says"
    own = Statement(recording.stated_by, f"{words} {shown(recording.label)}", orientation)
    others = [s for s in recording.statements if s.words != own.words or s.kind is Kind.ANGLES]
    statements = ((own,) if orientation.known and own.words not in {s.words for s in others} else ()) + tuple(others)
    acceleration = recording.values * factor
    series = [
        None if samples is None or (metres := length_factor(samples[1])) is None else samples[0] * metres
        for samples in (recording.velocities, recording.displacements)
    ]
    findings, differences = contradictions_of(recording, factor, file.gravity)
    return Component(
        name=name,
        dt=recording.dt,
        acceleration=acceleration,
        orientation=decided_orientation(statements, orientation.label),
        statements=statements,
        station=recording.station,
        sources=(source,),
        start=recording.start,
        unit="" if recording.counts else recording.unit,
        raw=recording.processed is False if recording.raw is None else recording.raw,
        sensor=recording.sensor,
        event=" ".join(recording.event.upper().split()),
        processed=recording.processed,
        origin=recording.origin,
        initial=initial_of(acceleration, recording.dt, *series) or recording.initial,
        notes=(*recording.notes, *differences),
        findings=(*recording.findings, *findings),
    )


def other_direction(label: str, other: str, place: str) -> tuple[Finding, ...]:
    """Return a finding in a tuple if a header states an ``other`` direction at a ``place`` than its ``label``, which counts.

    () if they agree, or one is unknown.
    """
    way, another = orientation_of(label), orientation_of(other)
    if not way or not another or not Statement(Kind.HEADER, "", way).contradicts(Statement(Kind.HEADER, "", another)):
        return ()
    text = f"its header says {shown(label)}, but {place} {shown(other)}; decided by: the first; check which is right"
    return (Finding("direction", text),)


def contradictions_of(
    recording: Recording, factor: float, gravity: float
) -> tuple[tuple[Finding, ...], tuple[str, ...]]:
    """Return findings and notes on samples, times ``factor`` in m/s², that differ from their header's statements."""
    as_read = recording.values if recording.as_read is None else recording.as_read
    sampled = Sampled(recording.values, recording.dt, recording.unit, factor, as_read)
    return contradictions(recording.stated, sampled, gravity)
