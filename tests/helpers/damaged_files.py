"""Whole files of every format, and ways to damage them."""

import io
import struct
from collections.abc import Callable

import numpy as np
from agency_files import BBP, cwa_text, dyna_text, emod3d_text, geonet_text, knet_text, renadic_text, resorce_text
from fixed_column_files import cosmos_text, csmip_text, smc_text
from motion_files import at2_text, wiggle
from national_files import afad_text, bhrc_text, caltech_text, csmnc_text, unam_text, usc_corrected_text, usc_text
from waveform_files import asdf_bytes, evt_bytes, trace

Damage = Callable[[bytearray, np.random.Generator], bytes | bytearray]


def traced(form: str) -> bytes:
    import obspy

    counts = np.random.default_rng(0).integers(-(2**20), 2**20, 700)
    data = counts.astype(np.int32 if form == "MSEED" else np.float32)
    header: dict[str, object] = {"network": "CI", "station": "LRL", "channel": "HNE", "sampling_rate": 100.0}
    if form == "SAC":  # with places, of which ObsPy takes the distance
        header["sac"] = {"stla": 35.5, "stlo": -117.6, "evla": 35.8, "evlo": -117.6, "lcalda": 1}
    target = io.BytesIO()
    obspy.Stream([obspy.Trace(data, header)]).write(target, format=form)
    return target.getvalue()


def samples() -> dict[str, list[tuple[str, bytes]]]:
    """Return whole files of each format, by its name: (file's name, content)."""
    table = "\n".join(f"{0.01 * i:.2f},{value:.5f}" for i, value in enumerate(wiggle(120)))
    texts = {
        "PEER AT2": [("x.AT2", at2_text(wiggle(120)))],
        "K-NET/KiK-net": [("TST.EW", knet_text()[0])],
        "GeoNet V1A/V2A": [("x.V1A", geonet_text(1)), ("x.V2A", geonet_text(2))],
        "DYNA (ESM, ITACA, AFAD)": [("x.ASC", dyna_text())],
        "COSMOS": [("x.V1c", cosmos_text())],
        "CSMIP": [("x.V1", csmip_text(1)), ("x.V2", csmip_text(2))],
        "USGS SMC": [("x.smc", smc_text())],
        "RENADIC": [("x.V1", renadic_text())],
        "USC": [("x.s0a", usc_text()), ("y.s0a", usc_corrected_text()), ("IIA001.V2", caltech_text(declared=False))],
        "BHRC Volume 1": [("x.V1", bhrc_text())],
        "CSMNC": [("x.dat", csmnc_text())],
        "AFAD text": [("x.txt", afad_text())],
        "UNAM": [("CANA1709.191", unam_text())],
        "RESORCE": [("x.cor.acc", resorce_text())],
        "CWA free field": [("x.dat", cwa_text())],
        "EMOD3D": [("x.090", emod3d_text())],
        "text columns": [("x.csv", f"time [s],acc [g]\n{table}\n"), ("x.bbp", BBP)],
    }
    encoded = {name: [(file, text.encode("latin-1")) for file, text in files] for name, files in texts.items()}
    return encoded | {
        "MiniSEED": [("x.mseed", traced("MSEED"))],
        "SAC": [("x.sac", traced("SAC"))],
        "ASDF": [("x.h5", asdf_bytes(trace("HNE"), trace("HNZ")))],
        "Kinemetrics EVT": [("x.evt", evt_bytes())],
    }


SAMPLES = samples()


def somewhere(data: bytearray, rng: np.random.Generator) -> int:
    """Return a place, in the header more often than its length would have it."""
    return int(rng.integers(0, max(1, len(data) if rng.random() < 0.5 else len(data) // 5)))


def cut(data: bytearray, rng: np.random.Generator) -> bytearray:
    return data[: somewhere(data, rng)]


def hole(data: bytearray, rng: np.random.Generator) -> bytearray:
    place = somewhere(data, rng)
    return data[:place] + data[place + int(rng.integers(1, 400)) :]


def repeated(data: bytearray, rng: np.random.Generator) -> bytearray:
    place = somewhere(data, rng)
    return data[:place] + data[max(0, place - int(rng.integers(1, 400))) :]


def noise(data: bytearray, rng: np.random.Generator) -> bytearray:
    for _ in range(int(rng.integers(1, 8))):
        if data:
            data[somewhere(data, rng)] = int(rng.integers(0, 256))
    return data


def swapped(data: bytearray, rng: np.random.Generator) -> bytearray:
    i, j = somewhere(data, rng), somewhere(data, rng)
    if data:
        data[i], data[j] = data[j], data[i]
    return data


EXTREMES = (0.0, -1.0, 1e-30, 1e30, -1e30, np.inf, -np.inf, np.nan, 2**31 - 1, -(2**31), 720.0, 1e9)


def word(data: bytearray, rng: np.random.Generator) -> bytearray:
    """Replace four bytes, as in the headers of binary files, by a number that nothing there can be."""
    place = 4 * int(rng.integers(0, max(1, min(len(data), 700) // 4)))
    value, order = EXTREMES[int(rng.integers(len(EXTREMES)))], "<>"[int(rng.integers(2))]
    whole = np.isfinite(value) and abs(value) < 2**31 and rng.random() < 0.5
    return (
        data[:place]
        + bytearray(struct.pack(f"{order}{'i' if whole else 'f'}", int(value) if whole else value))
        + data[place + 4 :]
    )


WORDS = (
    b"nan", b"NaN", b"inf", b"-Infinity", b"1e308", b"-1e400", b"1e-320", b"0", b"-1", b"999999999", b"99999999999999999999",
    b"0.0000", b"1e9", b"-0.01", b"", b"****", b"\xe9\xff", b"\x00\x00\x00\x00", b"\xef\xbb\xbf", b"0x10", b"1_0", b"\xd9\xa1",
)  # fmt: skip


def number(data: bytearray, rng: np.random.Generator) -> bytearray:
    """Replace a number, or what stands in its place, by another: counts, intervals, values."""
    place = somewhere(data, rng)
    while place < len(data) and not chr(data[place]).isdigit():
        place += 1
    end = place
    while end < len(data) and chr(data[end]) in "0123456789.eE+-":
        end += 1
    return data[:place] + WORDS[int(rng.integers(len(WORDS)))] + data[end:]


def digit(data: bytearray, rng: np.random.Generator) -> bytearray:
    """Lose a digit, or a point, as of a scale factor or a peak: what is left is a number all the same."""
    place = somewhere(data, rng)
    while place < len(data) and chr(data[place]) not in "0123456789.":
        place += 1
    return data[:place] + data[place + 1 :]


def lines_lost(data: bytearray, rng: np.random.Generator) -> bytes:
    """Lose some whole lines, or have them twice."""
    lines = bytes(data).splitlines(keepends=True)
    first, count = int(rng.integers(0, len(lines) + 1)), int(rng.integers(1, 20))
    again = lines[first : first + count] * (2 * int(rng.integers(2)))
    return b"".join([*lines[:first], *again, *lines[first + count :]])


def line_ends(data: bytearray, rng: np.random.Generator) -> bytes:
    return bytes(data).replace(b"\n", (b"\r\n", b"\r", b"", b"\n\n", b"\x0c\n")[int(rng.integers(5))])


def other_content(data: bytearray, rng: np.random.Generator) -> bytes:
    tails = (
        b"",
        b"\x00" * 5000,
        rng.bytes(3000),
        b"\x80\x04obspy.core.stream",
        b"PK\x03\x04" + rng.bytes(500),
        b"<?xml",
    )
    start = bytes(data[:40]) if rng.random() < 0.5 else b""
    return start + tails[int(rng.integers(len(tails)))]


DAMAGES: tuple[Damage, ...] = (
    cut,
    hole,
    repeated,
    noise,
    noise,
    word,
    word,
    swapped,
    number,
    number,
    number,
    digit,
    lines_lost,
    line_ends,
    other_content,
)


def damaged(whole: bytes, rng: np.random.Generator) -> bytes:
    """Return a file with one to three kinds of damage, one upon the other; one in twenty is whole."""
    if rng.random() < 0.05:
        return whole
    data: bytes | bytearray = bytearray(whole)
    for _ in range(int(rng.integers(1, 4))):
        data = DAMAGES[int(rng.integers(len(DAMAGES)))](bytearray(data), rng)
    return bytes(data)
