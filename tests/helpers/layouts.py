"""Layouts of every format that are tried on readers, written here: a name, the file, and what has to be stated of it.

``docs/layouts.py`` writes what comes of them into the documentation.
"""

import io
from dataclasses import dataclass, field

import numpy as np
from agency_files import BBP, cwa_text, dyna_text, emod3d_text, geonet_text, knet_text, renadic_text, resorce_text
from fixed_column_files import cosmos_text, csmip_channel, csmip_text, film_text, smc_text
from motion_files import at2_text, wiggle
from national_files import afad_text, bhrc_text, caltech_text, csmnc_text, unam_text, usc_corrected_text, usc_text
from obspy import Stream, Trace
from waveform_files import asdf_bytes, evt_bytes, trace

from rockbatch.motions import ReadOptions


@dataclass(frozen=True)
class Layout:
    """A layout of a format, as a file."""

    format: str
    what: str
    file: str
    data: bytes
    stated: ReadOptions = field(default_factory=ReadOptions)


def _traced(form: str, channel: str = "HNE", rate: float = 100.0, idep: int | None = None) -> bytes:
    values = 1e5 * wiggle(700)
    trace = Trace(values.astype(np.int32 if form == "MSEED" else np.float32))
    trace.stats.update({"network": "CI", "station": "LRL", "channel": channel, "sampling_rate": rate})
    if idep is not None:
        trace.stats.sac = {"idep": idep}
    target = io.BytesIO()
    Stream([trace]).write(target, format=form)
    return target.getvalue()


def _table(head: str, per_line: int = 1, between: str = " ", time: bool = False, npts: int = 120) -> str:
    values = wiggle(npts)
    cells = [f"{value:.6f}" for value in values]
    if time:
        return head + "".join(f"{0.01 * i:.2f}{between}{cell}\n" for i, cell in enumerate(cells))
    return head + "".join(between.join(cells[i : i + per_line]) + "\n" for i in range(0, npts, per_line))


def _pairs() -> str:
    cells = [f"{0.01 * i:.2f} {value:.6f}" for i, value in enumerate(wiggle(122))]
    return "".join(" ".join(cells[i : i + 4]) + "\n" for i in range(0, len(cells), 4))


def _indexed() -> str:
    rows = (f"{i},2023-02-06T01:17:{35 + i // 100}.{i % 100:02d}Z,{value:.6f}\n" for i, value in enumerate(wiggle(120)))
    return ",time,acc (g)\n" + "".join(rows)


def _shake() -> str:
    cells = [f"{value:9.6f}" for value in wiggle(123)]
    title = "MADE UP EARTHQUAKE\nSOMEWHERE, 90 DEG\n\n"
    return title + "".join("".join(cells[i : i + 8]) + "\n" for i in range(0, len(cells), 8))


def _unam_in_exponents() -> str:
    samples = np.array([wiggle(43, i, 50.0) for i in (1, 2, 3)]).T
    text = unam_text(columns=samples.T, **{"FORMATO DATOS (FORTRAN,10 campos/dato)": "3E16.7"})
    rows = "".join("".join(f"{value:16.7E}" for value in row) + "\n" for row in samples)
    head = text[: text.index("DATOS DE ACELERACION")].replace("ACEL. MAX.(Gal)", "ACEL. MAX. (Gal)")
    return f"{head}DATOS DE ACELERACION:\n-----\nCANAL-1 CANAL-2 CANAL-3\nN00E; N90E; V;+\n-----\n{rows}"


def _layouts() -> list[Layout]:
    spectra = "Response and Fourier Spectra\nCorrected accelerogram\n" + csmip_text(1)
    g = ReadOptions(unit="g", dt=0.01)
    counts = ReadOptions(sensitivity=1e4)
    wrapped = ReadOptions(unit="g", dt=0.01, layout="wrapped")
    midas = "*SGSw\n*TITLE, x\n*Y-AXIS, Ground Accel. (g)\n*UNIT&TYPE, GRAV, ACCEL\n*DATA\n"
    midas += f"{_table('', 1, ', ', time=True)}*ENDDATA\n"
    matched = (
        "Matched\nFile Type: Accelerations (g)\n#Identifier:  Final (Baseline Corrected)\nNPTS = 120 , DT = 0.01 SEC\n"
    )
    at2, values = "PEER AT2", wiggle(120)
    named: list[tuple[str, str, str, str | bytes, ReadOptions]] = [
        (at2, "`NPTS= …, DT= … SEC`", "x.AT2", at2_text(values), ReadOptions()),
        (at2, "the same without the comma", "x.AT2", at2_text(values, count="NPTS= 120 DT= .0100 SEC"), ReadOptions()),
        (at2, "`1991 0.0100 NPTS, DT`", "x.AT2", at2_text(values, count=" 120 0.0100 NPTS, DT"), ReadOptions()),
        (at2, "two lines, `(g)`", "x_000.at2", _table("El Centro NS (g)\nNPTS= 120, DT= .02\n", 5), ReadOptions()),
        (at2, "no unit in the header", "x_000.AT2", at2_text(values, unit="ACCELERATION"), ReadOptions()),
        (at2, "velocities", "x.AT2", at2_text(values, unit="VELOCITY TIME SERIES IN UNITS OF CM/S"), ReadOptions()),
        ("MiniSEED", "accelerometer (HN)", "x.mseed", _traced("MSEED"), counts),
        ("MiniSEED", "counts without a sensitivity", "x.mseed", _traced("MSEED"), ReadOptions()),
        ("MiniSEED", "seismometer (HH)", "x.mseed", _traced("MSEED", "HHE"), counts),
        *(
            ("SAC", f"{rate:g} Hz", "x.sac", _traced("SAC", rate=rate), ReadOptions(unit="mm/s2"))
            for rate in (100.0, 120.0, 128.0, 204.8, 250.0, 500.0)
        ),
        ("SAC", "velocities (IDEP 7)", "x.sac", _traced("SAC", idep=7), ReadOptions(unit="mm/s2")),
        ("SAC", "no unit stated", "x.sac", _traced("SAC"), ReadOptions()),
        ("K-NET/KiK-net", "K-NET", "x.EW", knet_text()[0], ReadOptions()),
        ("K-NET/KiK-net", "KiK-net, at the surface", "x.EW2", knet_text("5")[0], ReadOptions()),
        ("K-NET/KiK-net", "KiK-net, in the borehole", "x.EW1", knet_text("2")[0], ReadOptions()),
        ("GeoNet", "V1A", "x.V1A", geonet_text(1), ReadOptions()),
        ("GeoNet", "V2A", "x.V2A", geonet_text(2), ReadOptions()),
        ("DYNA", "1.2", "x.ASC", dyna_text(), ReadOptions()),
        ("DYNA", "velocities", "x.ASC", dyna_text(DATA_TYPE="VELOCITY"), ReadOptions()),
        ("DYNA", "a dam's crest", "x.ASC", dyna_text(STATION_NAME="KEBAN (KRET-CREST)"), ReadOptions()),
        ("COSMOS", "V1c, 8F10.5", "x.V1c", cosmos_text(), ReadOptions()),
        ("COSMOS", "V2c, 1E15.6", "x.V2c", cosmos_text(stage="Corrected", series={"layout": "1E15.6"}), ReadOptions()),
        ("COSMOS", "a roof", "x.V2c", cosmos_text(stage="Corrected", location="Roof"), ReadOptions()),
        ("CSMIP", "Volume 1, as CGS writes it", "x.V1", csmip_text(1), ReadOptions()),
        ("CSMIP", "Volume 1, as CDMG did", "x.V1", csmip_text(1, modern=False), ReadOptions()),
        ("CSMIP", "Volume 2", "x.V2", csmip_text(2), ReadOptions()),
        (
            "CSMIP",
            "`270 DegR`",
            "x.V2",
            "\n".join([*csmip_channel("270 DegR", wiggle(99, 1, 90.0), volume=2), ""]),
            ReadOptions(),
        ),
        ("CSMIP", "Volume 3, spectra", "x.V3", spectra, ReadOptions()),
        ("USGS SMC", "corrected, 8E10.4", "x.smc", smc_text(), ReadOptions()),
        ("USGS SMC", "corrected, 5E14.7", "x.smc", smc_text(digits=8), ReadOptions()),
        ("USGS SMC", "from film, pairs of time and value", "x.smc", film_text(), ReadOptions()),
        ("RENADIC", "pairs of time and value", "x.V1", renadic_text(), ReadOptions()),
        ("USC", "Volume I", "x.s0a", usc_text(), ReadOptions()),
        ("USC", "Volume II", "x.s0a", usc_corrected_text(), ReadOptions()),
        ("Caltech", "Volume II", "IIA001.V2", caltech_text(), ReadOptions()),
        ("Caltech", "Volume II, no line before the series", "IIA001.V2", caltech_text(declared=False), ReadOptions()),
        ("RESORCE", "`.cor.acc`, 5E14.7", "1_N.cor.acc", resorce_text(), ReadOptions()),
        ("BHRC", "Volume 1", "x.V1", bhrc_text(), ReadOptions()),
        ("BHRC", "Volume 2", "x.V2", bhrc_text(volume=2), ReadOptions()),
        ("CSMNC", "uncorrected", "x.dat", csmnc_text(), ReadOptions()),
        ("CSMNC", "corrected", "x.dat", csmnc_text(kind="CORRECTED ACCELERATION"), ReadOptions()),
        ("AFAD text", "gal", "x.txt", afad_text(), ReadOptions()),
        ("UNAM, RA-UAM, CICESE", "3F10.4", "x.191", unam_text(), ReadOptions()),
        (
            "UNAM, RA-UAM, CICESE",
            "3E16.7, `N00E;`, `V;+`, `ACEL. MAX. (Gal)`",
            "x.dat",
            _unam_in_exponents(),
            ReadOptions(),
        ),
        (
            *("UNAM, RA-UAM, CICESE", "a line more than declared", "x.191"),
            *(unam_text(**{"NUM. TOTAL DE MUESTRAS, C1-C6": "/42/42/42"}), ReadOptions()),
        ),
        ("CWA", "free field", "x.dat", cwa_text(), ReadOptions()),
        ("EMOD3D (ucgmsim)", "`.000`, `.090`, `.ver`", "x.090", emod3d_text(), ReadOptions(unit="mm/s2")),
        ("EMOD3D (ucgmsim)", "no unit stated", "x.090", emod3d_text(), ReadOptions()),
        (
            "text columns",
            "units in the header",
            "x_000.csv",
            _table("time [s],acc [g]\n", 1, ",", time=True),
            ReadOptions(),
        ),
        ("text columns", "SCEC Broadband Platform", "x.bbp", BBP, ReadOptions()),
        ("text columns", "one column", "x_000.txt", _table(""), g),
        ("text columns", "one column, nothing stated", "x_000.txt", _table(""), ReadOptions()),
        ("text columns", "five a line, `layout` stated", "x_000.txt", _table("", 5), wrapped),
        ("text columns", "five a line", "x_000.txt", _table("", 5), g),
        ("text columns", "time and values called `.AT2`", "x_000.AT2", _table("", time=True), ReadOptions(unit="g")),
        ("text columns", "OpenSees, `.g3`", "x_000.g3", _table("", 5), wrapped),
        ("text columns", "called `.smc`", "x_000.smc", _table("", time=True), ReadOptions(unit="g")),
        ("text columns", "SHAKE, 8F9.6", "x.ACC", _shake(), g),
        ("text columns", "SHAKE, 8F9.6, `layout` stated", "x_000.ACC", _shake(), wrapped),
        (
            *("text columns", "eight a line, count in the header", "x_000.acc"),
            *(_table("NPTS: 120\ndt: 0.01 s\nunits: g\n", 8), ReadOptions()),
        ),
        (
            *("text columns", "`components: E N Z`", "x.txt"),
            *(_table("units: g\ndt: 0.01 s\ncomponents: E N Z\n", 3), ReadOptions()),
        ),
        (
            "text columns",
            "four pairs of time and value a line (SAP2000, ETABS, Abaqus)",
            "x_000.txt",
            _pairs(),
            ReadOptions(),
        ),
        ("text columns", "the same, unit stated", "x_000.txt", _pairs(), g),
        ("text columns", "count and step above pairs (DEEPSOIL)", "x_000.txt", _table("120 0.01\n", time=True), g),
        ("text columns", "MIDAS", "x_000.sgs", midas, ReadOptions()),
        ("text columns", "RspMatch", "x_000.acc", _table(matched), ReadOptions()),
        ("text columns", "a row of units", "x_000.csv", _table("t,acc\ns,g\n", 1, ",", time=True), ReadOptions()),
        ("text columns", "pandas' index, clock times", "x_000.csv", _indexed(), ReadOptions()),
        ("text columns", "ft/s2", "x_000.csv", _table("t (s),acc (ft/s2)\n", 1, ",", time=True), ReadOptions()),
        ("ASDF", "counts without a sensitivity", "x.h5", asdf_bytes(trace("HNE")), ReadOptions()),
        ("ASDF", "sensitivity stated", "x.h5", asdf_bytes(trace("HNE")), ReadOptions(sensitivity=1e5)),
        ("Kinemetrics EVT", "K2, Etna", "x.evt", evt_bytes(), ReadOptions()),
        ("text columns", "a response spectrum", "x.txt", _table("Period(s) Sa(g)\n", 1, time=True), ReadOptions()),
    ]
    return [
        Layout(form, what, file, data if isinstance(data, bytes) else data.encode("latin-1"), stated)
        for form, what, file, data, stated in named
    ]


LAYOUTS = _layouts()
