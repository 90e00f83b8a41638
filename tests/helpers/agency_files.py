"""GeoNet, DYNA, RENADIC, CWA, BBP and K-NET files, written here by their layouts, for tests of their readers."""

from datetime import UTC, datetime

import numpy as np
from motion_files import wiggle

NPTS = 43  # no multiple of the values per line
A, B, C = (np.round(wiggle(NPTS, seed, 900.0), 1) for seed in (1, 2, 3))


def moment(*when: int) -> float:
    return datetime(*when, tzinfo=UTC).timestamp()


def in_columns(values, form: str, per_line: int) -> list[str]:
    fields = [format(float(value), form) for value in values]
    return ["".join(fields[i : i + per_line]) for i in range(0, len(fields), per_line)]


def geonet_component(label: str, values, *, volume: int = 1, dt: float = 0.005, pad: float = 0.0) -> list[str]:
    """Return one component of a V1A (1) or V2A (2) file; ``values`` in mm/s²."""
    npts = len(values)
    ints = [2016, 11, 13, 11, 2, 560, 0, 0, 2016, 11, *[0] * 8, 13, 11, *[0] * 10]
    ints += [npts, 0, 0, npts, *[npts if volume == 2 else 0] * 2, 0, 0, 2, 19715]
    reals = [*[0.0] * 20, npts * dt, pad, pad, npts * dt, 0.005, dt, 0.0, 0.0, 0.0, 9806.6, *[0.0] * 30]
    place = np.abs(values).argmax()
    peak = values[place]
    lines = [
        f"{'Unc' if volume == 1 else 'C'}orrected accelerogram 20161113_110256_WTMC_20 GNS Science",
        "Site WTMC      42 37 10S  173 03 13E     Cusp file:  20161113_110259_WTMC",
        "Te Mara Farm Waiau",
        "Instrument Cusp_10462",
        "Resolution: 18-bit   Instr Period: 0.0050 s   Damping: 0.700",
        "Accelerogram 20161113_110256_WTMC_20                 Processed 2016 December 09",
        "5 km south-west of Waiau",
        "2016 November 13         11:02:56 UT",
        "Epicentre  42 41 33S 173 01 19E  Bearing S18W  Dist    9km  Depth   15km Mw 7.82",
        f"Number of points  {npts}    Duration {npts * dt:.2f} s",
        f"Raw readings in units of 1.00 mm/s/s  at intervals of {dt:.3f} s"
        if volume == 1
        else f"Instrument corrected data at {dt:.3f} sec intervals",
        "Data is unfiltered",
        f"Component {label}",
        f"Acceleration:  Peak   {peak:.1f} mm/s/s at {place * dt - pad:6.3f} s     RMS   209.89 mm/s/s",
        "Velocity record unevaluated",
        "Displacement record unevaluated",
        *in_columns(ints, "8.0f", 10),
        *in_columns(reals, "8.2f", 10),
    ]
    lines[22] = "".join(f"{value:8.4f}" if i in (4, 5) else f"{value:8.2f}" for i, value in enumerate(reals[20:30]))
    lines += in_columns(values, "8.1f", 10)
    if volume == 2:
        lines += in_columns(values, "8.2f", 10) + in_columns(values, "8.3f", 10)
    return lines


def geonet_text(volume: int = 1, **header) -> str:
    parts = [geonet_component(*pair, volume=volume, **header) for pair in (("N28W", A), ("S62W", B), ("Up", C))]
    return "\n".join(line for part in parts for line in part) + "\n"


def dyna_text(values=A, stream: str = "HNE", **changed: str | None) -> str:
    """Return a DYNA file; ``changed`` replaces a key's value, ``None`` leaves the key out."""
    header: dict[str, str | None] = {
        "EVENT_NAME": "MADE UP",
        "EVENT_ID": "X-1",
        "NETWORK": "IT",
        "STATION_CODE": "AQK",
        "STATION_NAME": "L'Aquila: Aquil Park",
        "LOCATION": "",
        "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS": "20090406_013240.870",
        "SAMPLING_INTERVAL_S": "0.005000",
        "NDATA": str(len(values)),
        "DURATION_S": f"{len(values) * 0.005:.3f}",
        "STREAM": stream,
        "UNITS": "cm/s^2",
        "PGA_CM/S^2": f"{values[np.abs(values).argmax()]:.6f}",
        "TIME_PGA_S": f"{0.005 * np.abs(values).argmax():.6f}",
        "BASELINE_CORRECTION": "BASELINE REMOVED",
        "HEADER_FORMAT": "DYNA 1.2",
        "DATA_TYPE": "ACCELERATION",
        "PROCESSING": "manual",
        "USER1": "",
        **changed,
    }
    lines = [f"{key}: {value}" for key, value in header.items() if value is not None]
    return "\n".join([*lines, *(f"{value:.6f}" for value in values), ""])


def renadic_channel(label: str, values, times=None, *, number: int = 1, trigger: str = "2/27/2010 6:34:11.500"):
    """Return one channel; ``values`` in g/10."""
    times = 0.005 * np.arange(len(values)) if times is None else times
    pairs = np.column_stack([times, values]).ravel()
    place = np.abs(values).argmax()
    peak = values[place] / 10
    return [
        "UNCORRECTED ACCELEROGRAM DATA              PROCESSED: 06/01/2010",
        "MAULE 2010",
        "02/27/2010 6:34:00 (GMT)                (ORIGIN: 02/27/2010 6:34:00 GMT)",
        f"                                   TRIGGER TIME: {trigger} GMT",
        "STATION NO.          0.000N    0.000E  SMA       S/N  0   (3  CHNS OF 3  AT STA)",
        "VIÑA DEL MAR CENTRO S/N 675",
        f"CHAN  {number}: {label}        (STA CHN:  {number})               ",
        "UNIVERSIDAD DE CHILE - RENADIC",
        "HYPOCENTER:   0.000N    0.000E  H=   0.0KM   MW= 8.8",
        "INSTR PERIOD = 0.0250 SEC,  DAMPING =0.6000,  SENSITIVITY =1.000 VDC/G",
        f"NO. OF POINTS = {len(values):6d}  RECORD LENGTH = {times[-1] - times[0] + 0.005:.3f} SEC",
        f"UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = {peak:6.3f} G, AT  {times[place]:6.3f} SEC",
        "RMS ACCEL OF COMPLETE RECORD = 0.045 G",
        *in_columns([0] * 100, "5.0f", 16),
        *in_columns([0.0] * 50, "10.3f", 8),
        *in_columns(pairs, "7.3f", 10),
        f"/&  ----------  END OF DATA FOR CHANNEL {number}  ----------",
    ]


def renadic_text(**header) -> str:
    parts = [renadic_channel(label, x / 100, **header) for label, x in (("L", A), ("V", C), ("T", B))]
    return "\n".join(line for part in parts for line in part) + "\n"


def cwa_text(start: str = "#StartTime: 1999/09/20-17:47:02.000", unit: str = "gal. DCoffset(corr)", **changed) -> str:
    header = {
        "RecordLength(sec)": "   0.215",
        "SampleRate(Hz)": " 200",
        **{f"AmplitudeMAX. {label}": f" {max(x):8.3f}~ {min(x):8.3f}" for label, x in (("U", C), ("N", A), ("E", B))},
        "DataSequence": " Time U(+); N(+); E(+)",
        **changed,
    }
    rows = [f"{0.005 * i:10.3f}{C[i]:10.3f}{A[i]:10.3f}{B[i]:10.3f}" for i in range(NPTS)]
    keys = [f"#{key}:{value}" for key, value in header.items()]
    return "\n".join(["#StationCode: TCU068", start, f"#AmplitudeUnit:  {unit}", *keys, "#Data: 4F10.3 ", *rows, ""])


def resorce_text(values=A / 100, **changed: str | None) -> str:
    """Return a RESORCE file, ``values`` in m/s²; ``changed`` replaces a key's value, ``None`` leaves the key out."""
    header: dict[str, str | None] = {
        "Event Date & Time": "1980-05-23 12:26:24",
        "Station Code / Name": "3202 / Made Up-Post Office",
        "Network": "A network",
        "Orientation": "N",
        "Processing Info": "Instrument correction and acausal bandpass filtering",
        "Filter Cut-off Frequency (Hz)": "0.800 - 25.000",
        "Time Increment (s)": "0.005",
        "Number of Data": str(len(values)),
        "PGA (m/s/s)": f"{np.abs(values).max():.7E}",
        **changed,
    }
    lines = [f"{key:30}: {value}" for key, value in header.items() if value is not None]
    return "\n".join([*lines, "Accelaration time series in m/s/s", *in_columns(values, "14.7E", 5), ""])


BBP = "\n".join(
    [
        "#    time(sec)      N-S(cm/s/s)      E-W(cm/s/s)      U-D(cm/s/s)",
        *(f"{0.005 * i:.6e} {A[i]:.6e} {B[i]:.6e} {C[i]:.6e}" for i in range(NPTS)),
        "",
    ]
)


def knet_text(direction: str = "E-W", seconds: int = 2, offset: int = 4000, seed: int = 1) -> tuple[str, np.ndarray]:
    counts = np.round(wiggle(200, seed) * 1e5).astype(int) + offset
    rows = "\n".join("".join(f"{value:8d} " for value in counts[i : i + 8]) for i in range(0, 200, 8))
    header = (
        "Origin Time       2018/01/24 19:51:00\nLat.              41.0\nLong.             142.5\n"
        "Depth. (km)       30\nMag.              6.2\nStation Code      TST003\nStation Lat.      41.4053\n"
        "Station Long.     141.1691\nStation Height(m) 4\nRecord Time       2018/01/24 19:51:38\n"
        f"Sampling Freq(Hz) 100Hz\nDuration Time(s)  {seconds}\nDir.              {direction}\n"
        f"Scale Factor      7845(gal)/8223790\nMax. Acc. (gal)   {np.abs(counts - counts.mean()).max() * 7845 / 8223790:.3f}\n"
        "Last Correction   2018/01/24 19:51:38\nMemo.             \n"
    )
    return header + rows + "\n", counts


def emod3d_text(label: str = "090", values=A, *, count: int | None = None, title: str = "") -> str:
    """Return a file of EMOD3D as qcore writes it; ``values`` in whatever unit."""
    npts = len(values) if count is None else count
    fields = [f"{value:13.5e}" for value in values]
    return "\n".join(
        [
            f"{'HALS':10} {label:>3} {title}",
            f"{npts:d} {0.005:12.5e} 0 0 {-1.0:12.5e} {33.9338:12.5e} {0.0:12.5e} {0.0:12.5e}",
            *(" ".join(fields[i : i + 6]) for i in range(0, len(fields), 6)),
            "",
        ]
    )
