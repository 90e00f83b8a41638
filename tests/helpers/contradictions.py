"""Whole files of every format, and what each states of its samples, made wrong one by one.

``docs/layouts.py`` writes what comes of them into the documentation.
"""

import io
import re
import struct
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from agency_files import cwa_text, dyna_text, emod3d_text, geonet_text, knet_text, renadic_text, resorce_text
from fixed_column_files import cosmos_text, csmip_text, film_text, smc_text
from motion_files import at2_text, wiggle
from national_files import afad_text, bhrc_text, caltech_text, csmnc_text, unam_text, usc_text
from obspy import Stream, Trace
from waveform_files import START

from rockbatch.motions import MotionSet, ReadOptions, read_motions

STATEMENTS = ("count", "step", "duration", "peak", "time of the peak")
"""Those that many headers make; others are called by what they are."""
ONCE = "once"
"""Stated, and nothing else in the file tells it."""

Change = Callable[[bytes], bytes]


def text(pattern: str, replacement: str | Callable[[re.Match[str]], str]) -> Change:
    """Return the change of the first match of a pattern."""

    def change(data: bytes) -> bytes:
        changed, times = re.subn(pattern, replacement, data.decode("latin-1"), count=1)
        assert times == 1, pattern
        return changed.encode("latin-1")

    return change


def factor(pattern: str, by: float) -> Change:
    """Return the change of the number between the two groups of a pattern, which keeps its columns."""

    def replacement(match: re.Match[str]) -> str:
        before, number, after = match.groups()
        form = f".{len(number.partition('.')[2])}f" if "." in number else ".0f"
        return f"{before}{by * float(number):{form}}".rjust(len(before + number)) + after

    return text(pattern, replacement)


def word(place: int, form: str, change: Callable[[float], float]) -> Change:
    """Return the change of a number of a binary header."""

    def changed(data: bytes) -> bytes:
        old = struct.unpack_from(form, data, place)[0]
        new = struct.pack(form, change(old))
        return data[:place] + new + data[place + len(new) :]

    return changed


def bit(place: int, mask: int) -> Change:
    """Return the change of bits of a byte."""
    return word(place, "B", lambda byte: byte ^ mask)


@dataclass(frozen=True)
class Header:
    """A file of a format, and what its header states: how to make it wrong, or that it stands there ``ONCE``."""

    format: str
    file: str
    data: bytes
    statements: dict[str, Change | str]
    stated: ReadOptions = field(default_factory=ReadOptions)


def _traced(form: str) -> bytes:
    """Return a file of ObsPy's, of MiniSEED several blocks."""
    samples = (1e5 * wiggle(3000)).astype(np.int32 if form == "MSEED" else np.float32)
    header = {"network": "CI", "station": "LRL", "channel": "HNE", "sampling_rate": 100.0, "starttime": START}
    target = io.BytesIO()
    Stream([Trace(samples, header)]).write(target, format=form, **({"reclen": 512} if form == "MSEED" else {}))
    return target.getvalue()


def _table() -> str:
    rows = (f"{0.01 * i:.2f},{value:.5f}\n" for i, value in enumerate(wiggle(120)))
    return "npts: 120\ndt: 0.01 s\nduration: 1.2 s\nPGA: 0.09 g\ntime [s],acc [g]\n" + "".join(rows)


_N = r"(-?[\d.]+)"
_G = ReadOptions(unit="g", dt=0.01)
HEADERS = [
    Header("PEER AT2", "x.AT2", at2_text(wiggle(120)).encode(), {"count": factor(r"(NPTS= *)(\d+)(,)", 1.1), "step": ONCE}),
    Header(
        *("MiniSEED", "x.mseed", _traced("MSEED")),
        {
            "count": bit(512 + 31, 2),
            "step": bit(512 + 33, 2),
            "times and numbers of blocks": bit(25, 32),
            "last sample of each block": bit(512 + 64 + 11, 1),
        },
        ReadOptions(sensitivity=1e4),
    ),
    Header(
        *("SAC", "x.sac", _traced("SAC")),
        {
            "count": word(4 * 79, "<i", lambda npts: npts - 1),
            "step": word(0, "<f", lambda dt: dt / 4),
            "duration": word(4 * 6, "<f", lambda end: end + 3.0),
            "DEPMIN, DEPMAX": word(4 * 2, "<f", lambda largest: largest / 10),
        },
        ReadOptions(sensitivity=1e5),
    ),
    Header(
        *("K-NET/KiK-net", "TST.EW", knet_text()[0].encode()),
        {
            "step": text("100Hz", "200Hz"),
            "duration": factor(r"(Duration Time\(s\) +)(\d+)(\n)", 2),
            "peak": factor(rf"(Max\. Acc\. \(gal\) +){_N}(\n)", 2),
            "columns of the last count": lambda data: data[:-4],
        },
    ),
    *(
        Header(
            *(f"GeoNet V{volume}A", f"x.V{volume}A", geonet_text(volume).encode()),
            {
                "count": factor(r"(Number of points +)(\d+)( )", 1.1),
                "step": text(r"  0\.0050(?=(?: +[-\d.]+){4}\n)", "  0.0100"),
                "duration": factor(rf"(Duration ){_N}( s)", 2),
                "peak": factor(rf"(Peak +){_N}( mm)", 2),
                "time of the peak": factor(rf"(mm/s/s at +){_N}( s)", 2),
            },
        )
        for volume in (1, 2)
    ),
    Header(
        *("DYNA", "x.ASC", dyna_text().encode()),
        {
            "count": factor(r"(NDATA: )(\d+)(\n)", 1.1),
            "step": factor(rf"(SAMPLING_INTERVAL_S: ){_N}(\n)", 2),
            "duration": factor(rf"(DURATION_S: ){_N}(\n)", 2),
            "peak": factor(rf"(PGA_CM/S\^2: ){_N}(\n)", 2),
            "time of the peak": factor(rf"(TIME_PGA_S: ){_N}(\n)", 2),
        },
    ),
    Header(
        *("COSMOS", "x.V1c", cosmos_text().encode("latin-1")),
        {
            "count": factor(r"( +)(\d+)( acceleration pts)", 1.1),
            "step": text(" 5.000000", "10.000000"),
            "duration": text(r"approx +0 secs", "approx    9 secs"),
            "peak": lambda _: cosmos_text(peak=300.0).encode("latin-1"),
            "time of the peak": factor(rf"(0\.215000 +-?[\d.]+ +){_N}( |\n)", 2),
        },
    ),
    Header(
        *("CSMIP Volume 1", "x.V1", csmip_text(1).encode("latin-1")),
        {
            "count": factor(r"(No\. of Points = +)(\d+)( )", 1.1),
            "step": text("at 100 pts/sec", "at 200 pts/sec"),
            "rate": text("at 100 Samples/sec", "at 200 Samples/sec"),
            "duration": factor(rf"(Record Length = *){_N}( sec)", 3),
            "peak": factor(rf"(Max  = *){_N}( g)", 3),
            "time of the peak": factor(rf"(g, at +){_N}( sec)", 3),
        },
    ),
    Header(
        *("CSMIP Volume 2", "x.V2", csmip_text(2).encode("latin-1")),
        {
            "count": factor(r"( +)(\d+)( points of instr)", 1.1),
            "step": text(r"spaced at  \.010", "spaced at  .020"),
            "duration": factor(rf"(Record length = *){_N}( sec)", 3),
            "peak": factor(rf"(Peak acceleration = *){_N}( )", 3),
            "time of the peak": factor(rf"(cm/sec/sec  at +){_N}( )", 3),
        },
    ),
    Header(
        *("USGS SMC", "x.smc", smc_text().encode("latin-1")),
        {
            "count": factor(r"(101 +2 *\n? +)(43)( )", 1.1),
            "step": text(r"2\.0000000E\+02", "2.2000000E+02"),
            "peak": lambda _: smc_text(peak=300.0).encode("latin-1"),
            "time of the peak": lambda _: smc_text(at=0.02).encode("latin-1"),
        },
    ),
    Header(
        *("USGS SMC, from film", "x.smc", film_text().encode("latin-1")),
        {
            "count": factor(r"(101 +2 *\n? +)(86)( )", 1.1),
            "peak": lambda _: film_text(peak=300.0).encode("latin-1"),
            "time of the peak": lambda _: film_text(at=0.01).encode("latin-1"),
        },
    ),
    Header(
        *("RENADIC", "x.V1", renadic_text().encode("latin-1")),
        {
            "count": factor(r"(NO\. OF POINTS = +)(\d+)( )", 1.1),
            "duration": factor(rf"(RECORD LENGTH = ){_N}( SEC)", 2),
            "peak": factor(rf"(MAX  = *){_N}( G)", 2),
            "time of the peak": factor(rf"(G, AT +){_N}( SEC)", 2),
        },
    ),
    Header(
        *("USC Volume I", "x.s0a", usc_text().encode("latin-1")),
        {
            "count": factor(r"(NO\. OF POINTS = +)(\d+)( )", 1.1),
            "duration": factor(rf"(DURATION = +){_N}( SEC)", 2),
        },
    ),
    *(
        Header(
            *(f"USC, Caltech Volume II{how}", "x.V2", caltech_text(declared=declared).encode("latin-1")),
            {
                "count": factor(r"(\n +)(\d+)( +INSTRUMENT AND)", 1.1),
                "step": factor(rf"(INTERVALS OF +){_N}( +SEC)", 2),
                "duration": factor(rf"(DURATION = +){_N}( SEC)", 2),
                "peak": factor(rf"(PEAK ACCELERATION = +){_N}( )", 2),
                "time of the peak": factor(rf"(CMS/SEC/SEC AT +){_N}( )", 2),
            },
        )
        for how, declared in (("", True), (", series not declared", False))
    ),
    Header(
        *("BHRC", "x.V1", bhrc_text().encode("latin-1")),
        {
            "count": factor(r"(NO\. OF POINTS = +)(\d+)( )", 1.1),
            "step": text("2.000000E\\+02", "1.000000E+02"),
            "duration": factor(rf"(DURATION = +){_N}(\n)", 2),
        },
    ),
    Header(
        *("CSMNC", "x.dat", csmnc_text().encode("latin-1")),
        {
            "count": factor(r"(NO\. OF POINTS: +)(\d+)( )", 1.1),
            "step": factor(rf"(INTERVALS OF: +){_N}( )", 2),
            "duration": factor(rf"(DURATION: +){_N}( )", 2),
            "peak": factor(rf"(PEAK VALUE: +){_N}( )", 2),
            "time of the peak": factor(rf"(AT +){_N}( SEC)", 2),
        },
    ),
    Header(
        *("AFAD text", "x.txt", afad_text().encode("latin-1")),
        {
            "count": factor(r"(NUMBER OF DATA +: )(\d+)(\n)", 1.1),
            "step": ONCE,
            "peak": factor(rf"(\(N-S\) ){_N}( )", 2),
        },
    ),
    Header(
        *("UNAM, RA-UAM, CICESE", "x.191", unam_text().encode("latin-1")),
        {
            "count": text("/43/43/43", "/45/45/45"),
            "step": text(r"/0\.005/0\.005/0\.005", "/0.01/0.01/0.01"),
            "peak": factor(rf"(\(Gal\), C1-C6 +: /){_N}(/)", 2),
            "time of the peak": factor(r"(EN LA MUESTRA +: /)(\d+)(/)", 2),
        },
    ),
    Header(
        *("RESORCE", "x.cor.acc", resorce_text().encode("latin-1")),
        {
            "count": factor(r"(Number of Data +: )(\d+)(\n)", 1.1),
            "step": ONCE,
            "peak": text(r"(PGA \(m/s/s\) +: )\d", r"\g<1>4"),
        },
    ),
    Header(
        *("CWA", "x.dat", cwa_text().encode()),
        {
            "step": factor(r"(SampleRate\(Hz\): +)(\d+)(\n)", 2),
            "duration": factor(rf"(RecordLength\(sec\): +){_N}(\n)", 2),
            "peak": text(r"(AmplitudeMAX. N: +)\d", r"\g<1>99"),
        },
    ),
    Header(
        *("EMOD3D (ucgmsim)", "x.090", emod3d_text().encode()),
        {"count": lambda _: emod3d_text(count=47).encode(), "step": ONCE},
        ReadOptions(unit="mm/s2"),
    ),
    Header(
        *("text columns", "x_000.csv", _table().encode()),
        {
            "count": factor(r"(npts: )(\d+)(\n)", 1.1),
            "step": factor(rf"(dt: ){_N}( s)", 2),
            "duration": factor(rf"(duration: ){_N}( s)", 2),
            "peak": factor(rf"(PGA: ){_N}( g)", 2),
        },
    ),
]  # fmt: skip


@dataclass(frozen=True)
class Contradiction:
    """A file whose header makes a statement that its samples contradict."""

    header: Header
    statement: str

    @property
    def data(self) -> bytes:
        change = self.header.statements[self.statement]
        assert callable(change)
        return change(self.header.data)

    def consequence(self) -> str:
        """Return what comes of it: "error", "waits", "warning", "note", or "read in silence"."""
        sound, wrong = (read_as(self.header, data) for data in (self.header.data, self.data))
        if wrong.unusable:
            return "waits" if "if it is right" in wrong.unusable[0].reason else "error"
        before, after = ({finding.what for m in found for finding in m.findings} for found in (sound, wrong))
        if after - before:
            return "warning"
        return "note" if [m.notes for m in sound] != [m.notes for m in wrong] else "read in silence"


def read_as(header: Header, data: bytes) -> MotionSet:
    """Return the motions of a file like that of a header, with these bytes."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / header.file).write_bytes(data)
        return read_motions(folder, options=header.stated)


CONTRADICTIONS = [
    Contradiction(header, statement)
    for header in HEADERS
    for statement, change in header.statements.items()
    if change != ONCE
]
