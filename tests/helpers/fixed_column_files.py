"""COSMOS, CSMIP and SMC files, written by their specifications, for tests of their readers."""

from pathlib import Path

import numpy as np
from motion_files import wiggle

from rockbatch.motions.component import Component
from rockbatch.motions.formats import RecordFile, read_record
from rockbatch.motions.unused import Unusable

NPTS = 43  # no multiple of the values per line
A, B, C = (np.round(wiggle(NPTS, seed, 90.0), 3) for seed in (1, 2, 3))  # cm/s²


def read(text: str | bytes, name: str, gravity: float = 9.81) -> list[Component | Unusable]:
    """Read a file as the reader of folders does, by suffix and header."""
    data = text if isinstance(text, bytes) else text.encode("latin-1")
    return list(read_record(RecordFile(Path(name), name, data, gravity=gravity)))


def in_columns(values, form: str, per_line: int) -> list[str]:
    """Return lines of numbers that may touch."""
    fields = [format(value, form) for value in values]
    return ["".join(fields[i : i + per_line]) for i in range(0, len(fields), per_line)]


def one_digit_exponents(values, form: str, per_line: int) -> list[str]:
    """Return lines of numbers as in SMC files: `` 1.5057E+0-2.2223E+0``."""
    width = int(form.split(".")[0])
    mantissas = [format(float(value), f".{form.split('.')[1]}e").split("e") for value in values]
    fields = [f"{mantissa}E{int(power):+d}".rjust(width) for mantissa, power in mantissas]
    return ["".join(fields[i : i + per_line]) for i in range(0, len(fields), per_line)]


def peak_of(values) -> float:
    return float(values[np.abs(values).argmax()])


def time_of_peak(values, dt: float) -> float:
    return float(np.abs(values).argmax()) * dt


def cosmos_header(
    what: str,
    values,
    direction: str,
    *,
    version: str = "01.20",
    interval_ms: float = 5.0,
    unit_code: int = 4,
    azimuth_code: int = -999,
    scnl: str = "8040.HNE.NP.D0",
    location: str = "Building; ground level",
    clock: tuple[int, ...] = (2018, 11, 30, 17, 29),
    peak: float | None = None,
) -> list[str]:
    integers = [-999] * 100
    integers[:4] = [1, 1, unit_code, int(version.replace(".", ""))]
    integers[39], integers[40] = clock[0], 334
    integers[41:45] = clock[1:]
    integers[53] = azimuth_code
    reals = [-999.0] * 100
    reals[29], reals[33], reals[61] = 6.332, 0.02, interval_ms  # number 34 is the recorder's interval
    reals[62], reals[64] = len(values) * interval_ms / 1000, time_of_peak(values, interval_ms / 1000)
    reals[63] = peak_of(values) if peak is None else peak
    return [
        f"{what}  (Format v{version} with 13 text lines)",
        "Record of Señor Quake of Fri Nov 30, 2018 17:29 UTC",
        "Hypocenter: 61.34640 -149.95520 H= 46km Mw=7.0",
        "Origin: 2018/11/30 17:29:29    UTC",
        "Statn No: 02-008040 Code:NP-8040   USGS  AK:Anchorage;R B Atwood Bld",
        "Coords: 61.2135 -149.8933  Site geology:",
        "Recorder: Q330            ( 6 Chns of  53 at Sta) Sensor: Episensor        ",
        "Rcrd start time: 2018/11/30 17:29:06.332 UTC (Q=5) RcrdId: (see comment)",
        f"Sta Chan  35: {direction} (Rcrdr Chan  ?) Location:{location}",
        "Raw record length = 210.000 sec, Uncor max =    549145, at  43.360 sec.",
        "Processed:2019-09-18 04:03:25 GMT, USGS, Max = -249.021 cm/sec2 at   43.360 sec",
        "Record filtered below       Hz (periods over       secs), and above      Hz",
        "Values used when parameter or data value is unknown/unspecified:   -999, -999.00",
        " 100 Integer-header values follow on  10 lines, Format= (10I8)",
        *in_columns(integers, "8d", 10),
        " 100 Real-header values follow on  17 lines, Format= (6F13.6)",
        *in_columns(reals, "13.6f", 6),
        '   2 Comment line(s) follow, each starting with a "|":',
        "| a comment",
        f"|<SCNL>{scnl}    <AUTH> 2019/05/28 02:27:48.000",
    ]


def cosmos_series(
    what: str,
    values,
    *,
    unit: str = "cm/sec2(04)",
    layout: str = "8F10.5",
    seconds: int = 0,
    count: int | None = None,
) -> list[str]:
    form, per_line = {"8F10.5": ("10.5f", 8), "1E15.6": ("15.6e", 1), "1PE15.6": ("15.6e", 1)}.get(layout, ("10.5f", 8))
    return [
        f"   {len(values) if count is None else count} {what} pts, approx {seconds:4d} secs, units={unit},Format=({layout})",
        *in_columns(values, form, per_line),
        f"End-of-data for Chan 35 {what}",
    ]


def cosmos_text(
    values=A, direction: str = "90 Deg", *, stage: str = "Uncorrected", series: dict | None = None, **header
) -> str:
    """Return one channel of accelerations in cm/s²."""
    lines = cosmos_header(f"{stage} acceleration", values, direction, **header)
    return "\n".join([*lines, *cosmos_series("acceleration", values, **(series or {})), ""])


def csmip_channel(
    label: str,
    values,
    *,
    volume: int,
    modern: bool = True,
    number: int = 1,
    place: str = "",
    record: str = "38457511.CI.CCC.--.HN",
    station: str = "CCC",
    unit: str = "",
) -> list[str]:
    """Return one channel of Volume 1, ``values`` in g, or 2, in cm/s²; as CGS writes it today, or as CDMG did."""
    npts = len(values)
    where = f" Location: {place}" if place else ""
    peak = peak_of(values)
    clock = "Start time:  7/06/19, 03:19:37.5 UTC (GPS)" if modern else "TRIGGER TIME: 06/28/92, 15:05:37.4 UTC"
    lines = [
        "Uncorrected Accelerogram Data             Processed: 07/06/19, CGS  ciccc--y    ",
        "Rcrd of Fri Jul  5, 2019 20:19:37.0 PDT               (Avol1 v2.0, 4/18 CSMIP)  ",
        "                                        (Origin:  To be determined)             ",
        f"{record}                {clock}",
        f"Station {'Id.' if modern else 'No.'} {station}     35.525N, 117.365W    Q330    s/n 4114  (3 Chns of  3 at Sta)",
        "Peñón Blanco                             SCSN   Data: Acceleration              ",
        f"Chan {number:2d}: {label}      (Sta Chn: {number}){where}",
        "Rcrd of Fri Jul  5, 2019 20:19:37.0 PDT    Fri Jul  5, 2019 20:19:37.0 PDT      ",
        "Hypocenter:  To be determined.               ML:  To be determined.             ",
        "Instr Period =  .0050 sec,  Damping =  .707,  Sensitivity = 4.99 v/g  (Nominal) ",
        f"No. of Points = {npts:6d}  Record Length ={npts * 0.01:7.3f} sec   at 100 Samples/sec",
        f"Units of uncor data are sec and g.         Max  ={peak:7.3f} g, at {time_of_peak(values, 0.01):8.3f} sec.    ",
        "RMS calc for complete record =        .   Chn. metadata effective date:         ",
    ]
    if volume == 2:
        lines[10:12] = [
            f"                        Record length ={npts * 0.01:7.3f} sec.",
            "                                     Uncor Max  =  -.567 g , at  39.410 sec.    ",
        ]
        lines = [
            f"Corrected accelerogram   {record}      Chan {number:2d}: {label}     from   ",
            *lines,
            "Accelerogram bandpass filtered with 3 dB pts at   .10 and 40.00 cyc/sec         ",
            f"{npts:6d} points of instrument- and baseline-corrected accel, veloc and displ data ",
            "At equally-spaced intervals of    .010  sec.                                    ",
            f"Peak acceleration ={peak:10.3f}    cm/sec/sec  at {time_of_peak(values, 0.01):8.3f}   sec.               ",
            "Peak   velocity   =    -6.863      cm/sec    at   14.680   sec.                 ",
            "Peak displacement =     -.836        cm      at   17.580   sec.                 ",
            "Initial velocity  =      .000   cm/sec;   Initial displacement =    -.003   cm  ",
            "Rcrd of Fri Jul  5, 2019 20:19:37.0 PDT    Fri Jul  5, 2019 20:19:37.0 PDT      ",
            "",
            f"{record}     Peñón Blanco    Chan {number:2d}: {label}",
            "",
        ]
    lines += in_columns([0, 100, -999, 13043, *[0] * 96], "5d", 16)
    lines += in_columns([0.0] * (50 * volume), "10.3f", 8)
    series = [("accel", values, unit or ("g" if volume == 1 else "cm/sec2"))]
    if volume == 2:
        series += [("veloc", values / 10, "cm/sec"), ("displ", values / 100, "cm")]
    for what, numbers, its_unit in series:
        form = "9.6f" if volume == 1 else "10.6f" if modern else "10.3f"
        if not modern:
            declared = f"{npts:6d} points of {what} data equally spaced at  .010 sec.  (units: {its_unit})"
        elif volume == 1:
            declared = f"{npts:6d} Accelerogram points at 100 pts/sec in units of {its_unit}.       Format: (8f9.6)  "
        else:
            declared = f"{npts:6d} points of {what} data equally spaced at  .010 sec, in {its_unit}. (8f10.6)    "
        lines += [declared, *in_columns(numbers, form, 8)]
    lines.append(f"/&  ----------  End of Data for Station Channel   {number}  ----------")
    return lines if modern else [line.upper() for line in lines]


def csmip_text(volume: int = 1, **header) -> str:
    """Return three channels, of A, C and B in cm/s² or g/1000."""
    parts = [("90 Deg", A), ("Up", C), ("360 Deg", B)]
    scale = 1e-3 if volume == 1 else 1.0
    channels = [
        csmip_channel(label, values * scale, volume=volume, number=i, **header)
        for i, (label, values) in enumerate(parts, start=1)
    ]
    return "\n".join(line for channel in channels for line in channel) + "\n"


def smc_text(
    values=A,
    *,
    title: str = "2 CORRECTED ACCELEROGRAM",
    vertical: int = 90,
    azimuth: int = 135,
    label: str = "135",
    clock: tuple[int, ...] = (1989, 291, 0, 4, 15, 250),
    rate: float = 200.0,
    comments: int = 2,
    count: int | None = None,
    digits: int = -32768,
    flag: int = -32768,
    peak: float | None = None,
    at: float | None = None,
) -> str:
    """Return an SMC file in cm/s²; unknown integers are -32768, unknown real numbers 1.7E38."""
    integers = [-32768] * 48
    integers[1:7] = clock
    integers[8:10] = [1, 3]
    integers[12:14] = [vertical, azimuth]
    integers[14:18] = [101, comments, len(values) if count is None else count, flag]
    integers[29], integers[46] = 1675, digits
    reals = [1.7e38] * 50
    reals[1], reals[28] = rate, time_of_peak(values, 1 / rate) if at is None else at
    reals[29] = abs(peak_of(values)) if peak is None else peak
    layout = ("14.7", 5) if digits == 8 else ("10.4", 8)
    lines = [
        title,
        "*",
        "SAF0A",
        "     1989  10  18    0004 Loma Prieta, CA",
        "Moment Mag=      7.1 Ms=      7.1 Ml=      7.0",
        f"station = San José, 1295 Shafter, 42n    component=  {label:>5}",
        "epicentral dist =     89.0       pk     =    104.4",
        "inst type=SMA-1      data source = USGS",
        *["*"] * 3,
        *in_columns(integers, "10d", 8),
        *in_columns(reals, "15.7E", 5),
        *["|ref - R. Maley, A. Acosta, F. Ellis, E. Etheredge"] * 2,
        *one_digit_exponents(values, *layout),
        "",
    ]
    return "\n".join(lines)


def film_text(values=A, times=None, **header) -> str:
    """Return an SMC file as digitised from film: pairs of time [s] and value, and no rate."""
    times = np.cumsum(np.r_[0.0, np.resize([0.00137, 0.00147], len(values) - 1)]) if times is None else times
    pairs = np.column_stack([times, values]).ravel()
    return smc_text(
        pairs,
        **{
            "title": "1 UNCORRECTED ACCELEROGRAM",
            "rate": 1.7e38,
            "peak": np.abs(values).max(),
            "at": times[np.abs(values).argmax()],
            **header,
        },
    )
