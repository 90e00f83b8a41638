"""MiniSEED: counts, converted to accelerations by StationXML in the same folder, or by the study."""

import re
from collections.abc import Container, Iterable
from dataclasses import replace

import numpy as np

from rockbatch.common.errors import InputError, Truncated, Unstated, UnusableRecord
from rockbatch.common.grouping import grouped
from rockbatch.common.lazy import obspy
from rockbatch.common.showing import shown
from rockbatch.common.units import acceleration_factor
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.formats.with_obspy import read_stream
from rockbatch.motions.labels.evidence import Kind, Statement, angles_statement, decided_orientation
from rockbatch.motions.labels.orientation import is_clock, not_acceleration, orientation_of
from rockbatch.motions.labels.origin import origin_of
from rockbatch.motions.motion import Finding
from rockbatch.motions.quality.places import Stand, depth_as_place, stand
from rockbatch.motions.sources import stationxml
from rockbatch.motions.sources.record_file import RecordFile, no_acceleration
from rockbatch.motions.sources.source import Source
from rockbatch.motions.unused import Unusable

_YEARS = 1900, 2100
_STATED = "sensitivity = … (counts per m/s²) in the study, or for this file in motions.toml"
_MOST_NAMED = 5  # of the .xml files that could not be read
_MOST_PIECES = 1000  # of channels in a file: a network of three hundred stations
_APART, _LEAST_APART = 3.0, 60.0  # times the longest piece of a channel, and seconds: longer gaps separate two events
_BROKEN_OFF = (
    Finding(
        "time of blocks",
        "a block follows the one before by its number, but not by its time: check whether the file holds two events",
        gross=True,
    ),
)
_REVERSED = Finding("gain", "its sensitivity is negative, which reverses its sign: check its polarity")


def is_miniseed(head: bytes) -> bool:
    """Return whether the first bytes are those of a MiniSEED 2 record, or of a SEED volume with control headers."""
    if re.match(rb"[0-9]{6}V 0(?:05|08|10)[0-9]{4}", head):
        return True
    if re.match(rb"[0-9 ]{6}[DRQM][ \x00][ -~]{12}", head) is None:  # sequence number, quality, codes
        return False
    days = ((int.from_bytes(head[20:22], order), int.from_bytes(head[22:24], order)) for order in ("big", "little"))
    return any(_YEARS[0] <= year <= _YEARS[1] and 1 <= day <= 366 for year, day in days)


def read_miniseed(file: RecordFile) -> list[Component | Unusable]:
    """Return a component per channel and event; an unusable channel becomes an ``Unusable`` beside the others.

    A gap longer than a minute, and than three times the longest piece of a channel, separates two events; a shorter one is
    a fault, as are overlaps. Raises ``InputError`` for a cut file, or one with too many pieces.
    """
    stream = read_stream(file.data, "MSEED")
    lengths = {trace.stats.mseed.record_length for trace in stream}
    if len(lengths) == 1 and len(file.data) % (length := lengths.pop()):  # ObsPy drops the rest unsaid
        raise Truncated(
            f"{len(file.data)} bytes are not a whole number of its records of {length} bytes: the file is cut"
        )
    if len(stream) > _MOST_PIECES:
        raise InputError(
            f"holds {len(stream)} pieces of channels; at most {_MOST_PIECES} are read: divide it by stations"
        )
    return components_of_traces(file, stream, _channels_broken_off(file.data, stream))


def components_of_traces(
    file: RecordFile, traces: "Iterable[obspy.Trace]", broken: Container[str] = ()
) -> list[Component | Unusable]:
    """Return a component per channel and event of traces in counts; those of ``broken`` channels have a finding."""
    segments = grouped(traces, lambda trace: str(trace.id))
    readings: list[Component | Unusable] = []
    for channel_id, of_channel in segments.items():
        events = _events(of_channel)
        for pieces in events:
            name = channel_id if len(segments) > 1 else file.stem
            source = file.source if len(segments) == 1 else Source(file.source, channel_id)
            if len(events) > 1:
                moment = pieces[0].stats.starttime.strftime("%Y%m%dT%H%M%S")
                name, source = f"{name}.{moment}", Source(file.source, f"{channel_id} {moment}")
            try:
                if len(pieces) > 1:
                    raise InputError(f"{channel_id} has gaps or overlaps: {len(pieces)} pieces; join them first")
                component = _component(name, source, file, pieces[0])
                findings = (*component.findings, *(_BROKEN_OFF if channel_id in broken else ()))
                readings.append(replace(component, findings=findings))
            except InputError as error:
                lacks, kind = (error.keys, type(error)) if isinstance(error, Unstated) else ((), UnusableRecord)
                label, station = channel_id.rpartition(".")[2], _station(pieces[0])
                readings.append(Unusable(name, (source,), str(error), label, lacks, station=station, kind=kind))
    return readings


def _channels_broken_off(data: bytes, stream: "obspy.Stream") -> set[str]:
    """Return the channels in which a block follows the one before by its number, but not by its time.

    Between two events numbers are skipped, or begin anew. Files with blocks of several lengths, or without a channel in pieces,
    are not checked: set().
    """
    lengths = {trace.stats.mseed.record_length for trace in stream}
    rates = {trace.id: trace.stats.sampling_rate for trace in stream}
    if len(lengths) > 1 or len(rates) == len(stream):
        return set()
    block = np.dtype(
        {
            "names": ["number", "quality", "codes", "year", "day", "hour", "minute", "second", "fraction", "npts"],
            "formats": ["S6", "S1", "S12", "u2", "u2", "u1", "u1", "u1", "u2", "u2"],
            "offsets": [0, 6, 8, 20, 22, 24, 25, 26, 28, 30],  # bytes, in its fixed header
            "itemsize": lengths.pop(),
        }
    )
    blocks = np.frombuffer(data, block.newbyteorder(stream[0].stats.mseed.byteorder))
    blocks = blocks[np.isin(blocks["quality"], [b"D", b"R", b"Q", b"M"]) & np.char.isdigit(blocks["number"])]
    broken = set[str]()
    for codes in np.unique(blocks["codes"]):
        text = codes.decode("latin-1").ljust(12)
        station, location, channel, network = (text[i:j].strip() for i, j in ((0, 5), (5, 7), (7, 10), (10, 12)))
        of_channel = blocks[blocks["codes"] == codes]
        channel_id = f"{network}.{station}.{location}.{channel}"
        year, day = of_channel["year"].astype(int) - 1970, of_channel["day"].astype(int)
        midnight = 86400.0 * (year.astype("M8[Y]").astype("M8[D]") + day).astype(float)  # [s since 1969-12-31]
        clock = 3600.0 * of_channel["hour"] + 60.0 * of_channel["minute"] + of_channel["second"]
        times = midnight + clock + 1e-4 * of_channel["fraction"]
        between = rates.get(channel_id, 0.0) * np.diff(times)  # samples; 0 for a channel of text
        goes_on = np.diff(of_channel["number"].astype(int)) == 1
        if (goes_on & (np.abs(between - of_channel["npts"][:-1]) > 1.0)).any():
            broken.add(channel_id)
    return broken


def _events(traces: "list[obspy.Trace]") -> "list[list[obspy.Trace]]":
    """Return the pieces of a channel by event, in time; gaps over a minute and three times the longest piece separate events."""
    ordered = sorted(traces, key=lambda trace: trace.stats.starttime.timestamp)
    longest = max(trace.stats.endtime - trace.stats.starttime for trace in ordered)
    events = [[ordered[0]]]
    end = ordered[0].stats.endtime
    for trace in ordered[1:]:
        if trace.stats.starttime - end > max(_APART * longest, _LEAST_APART):
            events.append([])
        events[-1].append(trace)
        end = max(end, trace.stats.endtime)
    return events


def _component(name: str, source: str, file: RecordFile, trace: "obspy.Trace") -> Component:
    """Return one channel as a component, its sensitivity by StationXML or by the study."""
    stats = trace.stats
    if not np.issubdtype(trace.data.dtype, np.number):
        raise InputError(f"{trace.id} holds text, not samples")
    if is_clock(stats.channel):
        raise InputError(f"{trace.id} is the recorder's clock, no ground motion")
    start = stats.starttime.timestamp
    entry = None if "sensitivity" in file.options.instead else _epoch_with_sensitivity(file, trace)
    covering = (epoch for epoch in file.inventories.epochs_of(trace.id) if epoch.start <= start < epoch.end)
    described = entry or next(covering, None)
    statements = _directions(trace.id, described)
    if entry is not None:
        assert entry.sensitivity
        unit, sensitivity = entry.unit, entry.sensitivity
        origin = f"sensitivity {entry.gain} from StationXML {entry.named}"
    elif (kind := not_acceleration(stats.channel)) and "unit" not in file.options.instead:
        raise no_acceleration(trace.id, kind)
    elif file.options.unit is not None or file.options.sensitivity is not None:
        unit, sensitivity = file.options.unit or "m/s2", file.options.sensitivity or 1.0
        origin = f"sensitivity {sensitivity:g} counts per {unit} as stated"
    else:
        raise _without_sensitivity(file, trace)
    try:
        factor = acceleration_factor(unit, file.gravity)
    except ValueError:
        raise InputError(f"{trace.id} measures {unit or 'an unknown quantity'}, not an acceleration") from None
    return Component(
        name=name,
        dt=float(stats.delta),
        acceleration=trace.data * (factor / sensitivity),
        orientation=decided_orientation(statements, stats.channel),
        statements=statements,
        station=f"{stats.network}.{stats.station}.{stats.location}.{stats.channel[:-1]}",
        sources=(source,),
        start=start,
        unit="" if entry is not None else unit,
        raw=True,
        processed=False,
        origin=origin_of(date=stats.starttime.strftime("%Y-%m-%d"), station=_station(trace)),
        sensor=Sensor(stats.station, stats.network, stats.location, _place(described) if described else None),
        findings=(_REVERSED,) if entry is not None and sensitivity < 0 else (),
        notes=(origin,),
    )


def _place(channel: stationxml.Channel) -> str | None:
    """Return the depth of a sensor, or StationXML's words that place its channel or station on a structure or in a borehole.

    ``None`` for the ground: other words for it would only tell it apart from the same sensor in another format.
    """
    where, words = stand(channel.place, channel.site)
    return depth_as_place(channel.depth) or (words if where is not Stand.GROUND else None)


def _station(trace: "obspy.Trace") -> str:
    """Return the codes of network and station: "CI.LRL"."""
    return f"{trace.stats.network}.{trace.stats.station}".strip(".")


def _directions(channel_id: str, entry: stationxml.Channel | None) -> tuple[Statement, ...]:
    """Return the statements of a channel's direction: its code, and StationXML's azimuth and dip."""
    channel = channel_id.rpartition(".")[2]
    code = orientation_of(channel)
    statements = [Statement(Kind.CODE, f"channel {shown(channel)}", code)] if code else []
    if entry is not None:
        named = (("azimuth", entry.azimuth), ("dip", entry.dip))
        words = " and ".join(f"{name} {value:g}°" for name, value in named if value is not None)
        try:
            angles = angles_statement(channel, f"{words} in StationXML", entry.azimuth, entry.dip)
        except ValueError as error:
            raise InputError(f"{channel_id} is {error}") from None
        statements += [angles] if angles else []
    return tuple(statements)


def _epoch_with_sensitivity(file: RecordFile, trace: "obspy.Trace") -> stationxml.Channel | None:
    """Return the epoch of StationXML that has a channel's sensitivity at the time of the trace; ``None`` without one."""
    epochs = file.inventories.epochs_of(trace.id)
    start, end = trace.stats.starttime.timestamp, trace.stats.endtime.timestamp
    if not any(epoch.start <= start < epoch.end for epoch in epochs):
        return None
    asked = [epoch for epoch in epochs if epoch.sensitivity and epoch.start <= end and start < epoch.end]
    if asked and (statements := stationxml.contradiction(asked)):
        if file.options.sensitivity is not None:
            return None
        raise Unstated(
            f"{trace.id}: StationXML contradicts itself: {statements}; take out the wrong one, or state {_STATED}",
            keys=("sensitivity",),
        )
    return asked[0] if asked else None


def _without_sensitivity(file: RecordFile, trace: "obspy.Trace") -> Unstated:
    """Return the error for counts whose sensitivity no StationXML has, with the files of StationXML that were not read."""
    stats, epochs = trace.stats, file.inventories.epochs_of(trace.id)
    refused = ", ".join(file.inventories.refused[:_MOST_NAMED])
    unread = f" (not read: {refused})" if refused else ""
    if epochs:
        covered = any(epoch.start <= stats.starttime.timestamp < epoch.end for epoch in epochs)
        lack = "no sensitivity" if covered else f"no epoch that covers {stats.starttime}"
        reason = f"the StationXML beside it ({epochs[0].file}) has {lack} for {trace.id}; add it, or state {_STATED}"
    else:
        reason = (
            f"counts without a sensitivity: put the StationXML of {stats.network}.{stats.station} (an .xml with channel "
            f"{trace.id}) into the folder or one below it, or state {_STATED}"
        )
    return Unstated(f"{reason}{unread}", keys=("sensitivity",))
