"""MiniSEED files and the StationXML beside them, for tests of ObsPy's readers."""

import io
from collections.abc import Sequence
from itertools import product
from pathlib import Path

import numpy as np
from motion_files import wiggle
from obspy import Stream, Trace, UTCDateTime

START = UTCDateTime(2019, 7, 6, 3, 19, 23)
COUNTS = (wiggle(500) * 1e6).astype(np.int32)


def trace(channel: str, data=COUNTS, start=START, rate: float = 100.0) -> Trace:
    header = {"network": "CI", "station": "LRL", "channel": channel, "starttime": start, "sampling_rate": rate}
    return Trace(np.array(data), header)


def write_mseed(path: Path, *traces: Trace) -> None:
    Stream(list(traces)).write(str(path), format="MSEED")


def asdf_bytes(*traces: Trace, xml: str = "", tags: Sequence[str] = ("raw",), **attributes: float) -> bytes:
    """Return an ASDF file of traces, with the StationXML of each station; ``attributes`` are instead of those of the traces.

    Traces are stored once with each of ``tags``.
    """
    import h5py

    held = io.BytesIO()
    with h5py.File(held, "w") as store:
        for one, tag in product(traces, tags):
            station = store.require_group(f"Waveforms/{one.stats.network}.{one.stats.station}")
            own = station.create_dataset(f"{one.id}__{one.stats.starttime}__{one.stats.endtime}__{tag}", data=one.data)
            own.attrs["starttime"] = one.stats.starttime.ns
            own.attrs["sampling_rate"] = one.stats.sampling_rate
            own.attrs.update(attributes)
            if xml and "StationXML" not in station:
                station["StationXML"] = np.frombuffer(xml.encode(), dtype=np.byte)
    return held.getvalue()


def evt_bytes() -> bytes:
    """Return a file of a Kinemetrics recorder that comes with ObsPy's tests."""
    import obspy

    data = Path(obspy.__file__).parent / "io" / "kinemetrics" / "tests" / "data"
    return (data / "BI008_MEMA-04823.evt").read_bytes()


def station_xml(folder: Path, *channels: str) -> None:
    (folder / "stations.xml").write_text(
        '<?xml version="1.0"?><FDSNStationXML xmlns="http://www.fdsn.org/xml/station/1"><Network code="CI">'
        f'<Station code="LRL">{"".join(channels)}</Station></Network></FDSNStationXML>'
    )


def channel_xml(
    code: str, azimuth: float = 0.0, dip: float = 0.0, unit: str = "M/S**2", value: float = 2e5, end: str = "2599-12-31"
) -> str:
    return (
        f'<Channel code="{code}" locationCode="" startDate="2017-11-15T19:20:00" endDate="{end}T00:00:00">'
        f"<Azimuth>{azimuth}</Azimuth><Dip>{dip}</Dip><Response><InstrumentSensitivity><Value>{value}</Value>"
        f"<InputUnits><Name>{unit}</Name></InputUnits></InstrumentSensitivity></Response></Channel>"
    )
