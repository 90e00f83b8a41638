"""MiniSEED files and the StationXML beside them, for tests of ObsPy's readers."""

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
