"""CSMNC, AFAD, UNAM, BHRC and USC files, written here by their layouts, for tests of their readers."""

import numpy as np
from agency_files import NPTS, A, B, C, in_columns


def peak_of(values) -> float:
    return float(values[np.abs(values).argmax()])


def one_digit(value: float) -> str:
    """Return a number as in CSMNC files: `` 3.888539E-2 ``."""
    mantissa, power = f"{value:.6e}".split("e")
    return f"{mantissa}E{int(power):+d}".rjust(12) + " "


def csmnc_text(values=A, label: str = "EW", *, kind: str = "UNCORRECTED ACCELERATION", count: int | None = None) -> str:
    fields = [one_digit(float(value)) for value in values]
    return "\n".join(
        [
            "051BXD130420080201",
            "0130420080246 2013-04-20 8:2:46 BTM",
            "MADE UP EARTHQUAKE, SOMEWHERE,CHN",
            "EPICENTER  30.300N 103.000E DEPTH 13 KM",
            "MAGNITUDE  7.0(Ms)",
            "STATION: 51BXD 30.400N 102.800E",
            "SITE CONDITION: ROCK",
            "INSTRUMENT TYPE: MR2002/SLJ-100",
            "OBSERVING POINT: GROUND",
            f"COMP. {label}",
            f"{kind}          UNIT: CM/SEC/SEC",
            f"NO. OF POINTS:  {len(values) if count is None else count}  EQUALLY SPACED INTERVALS OF:  0.005  SEC",
            f"PEAK VALUE:    {peak_of(values):.3f}   AT   {0.005 * np.abs(values).argmax():.3f} SEC    "
            f"DURATION:  {0.005 * len(values):.3f} SEC",
            "PRE-EVENT TIME:  20  SEC",
            "CSMNC",
            "",
            *("".join(fields[i : i + 8]) for i in range(0, len(fields), 8)),
            "",
        ]
    )


def afad_text(unit: str = "gal", scale: float = 1.0, **changed: str | None) -> str:
    columns = {"N-S": A, "E-W": B, "U-D": C}
    peaks = " ".join(f"({label}) {np.abs(x - x.mean()).max():.6f}" for label, x in columns.items())
    header: dict[str, str | None] = {
        "PLACE": "AYDIN GERMENCIK \xdd",
        "EARTHQUAKE DATE": "2017/07/20 22:31:09 (GMT)",
        "EPICENTER COORDINATES": "36.91980N-27.44350E",
        "EARTHQUAKE DEPTH (km)": "19.44",
        "EARTHQUAKE MAGNITUDE": "6.5 Mw",
        "STATION ID": "0921",
        "STATION COORDINATES": "37.87470N-27.59223E",
        "STATION ALTITUDE (m)": "66",
        "RECORDER TYPE": "Sara acebox",
        "RECORDER SERIAL NO": "1856",
        "RECORD TIME": "20/07/2017 22:30:58.500000 (GMT)",
        "NUMBER OF DATA": str(NPTS),
        "SAMPLING INTERVAL (sec)": "0.005",
        f"RAW PGA VALUES ({unit})": peaks,
        **changed,
    }
    lines = [f"{key:24}: {value}" for key, value in header.items() if value is not None]
    rows = [f"{scale * a:12.6f}  {scale * b:12.6f}  {scale * c:12.6f}" for a, b, c in zip(A, B, C, strict=True)]
    copyright_ = ["Copyright EARTHQUAKE DEPARTMENT", "DISASTER AND EMERGENCY MANAGEMENT PRESIDENCY"]
    title = "STRONG GROUND MOTION RECORDS OF TURKIYE"
    return "\n".join([title, *lines, *copyright_, "       N-S          E-W          U-D", *rows, ""])


def unam_text(ways=("N00E", "N90E", "V"), columns=(A, B, C), **changed: str | None) -> str:
    n = len(ways)

    def fields(*values) -> str:
        return "".join(f"/{value}" for value in values)

    header: dict[str, str | None] = {
        "VERSION DEL FORMATO": "2.0",
        "NOMBRE DEL ARCHIVO": "CANA1709.191",
        "NOMBRE DE LA ESTACION": "LAS CANAS",
        "CLAVE DE LA ESTACION": "CANA",
        "COORDENADAS DE LA ESTACION": "18.567007 LAT. N",
        "": "101.977162 LONG. W",
        "NUMERO DE CANALES": str(n),
        "ORIENTACION C1-C6 (rumbo;orientacion)": fields(*ways),
        "ORIENTACION C7-C12 (rumbo;orientacion)": "",
        "VEL. DE MUESTREO, C1-C6 (muestras/s)": fields(*[200] * n),
        "INTERVALO DE MUESTREO, C1-C6 (s)": fields(*[0.005] * n),
        "UMBRAL DE DISPARO, C1-C6 (Gal)": fields(*[0.5] * n),
        "FECHA DEL SISMO [GMT]": "2017/09/19",
        "HORA EPICENTRO (GMT)": "18:14:40",
        "HORA DE LA PRIMERA MUESTRA (GMT)": "18:14:44.500",
        "NUM. TOTAL DE MUESTRAS, C1-C6": fields(*map(len, columns)),
        "ACEL. MAX.(Gal), C1-C6": fields(*(f"{peak_of(x):.2f}" for x in columns)) + "      ",
        "ACEL. MAX., C1-C6, EN LA MUESTRA": fields(*(np.abs(x).argmax() + 1 for x in columns)),
        "UNIDADES DE LOS DATOS": "Gal (cm/s/s)",
        "FACTOR DE DECIMACION": "1",
        "FORMATO DATOS (FORTRAN,10 campos/dato)": f"{n}F10.4",
        **changed,
    }
    ruler = "---------+" * 7 + "---------"
    return "\n".join(
        [
            "*" * 86,
            "                       INSTITUTO DE INGENIERIA, UNAM",
            "*" * 86,
            "ARCHIVO ESTANDAR DE ACELERACION:",
            *(f"{key:39}: {value}" for key, value in header.items() if value is not None),
            "",
            "COMENTARIOS:",
            "",
            "=" * 80,
            "DATOS DE ACELERACION:",
            ruler,
            "".join(f"CANAL-{i + 1}".rjust(10) for i in range(n)),
            "".join(way.rjust(10) for way in ways),
            ruler,
            *("".join(f"{value:10.4f}" for value in row) for row in zip(*columns, strict=True)),
            "",
        ]
    )


def bhrc_channel(label: str, values, *, volume: int = 1, rate: float = 200.0) -> list[str]:
    """Return one channel; ``values`` in g/10."""
    reals = [0.0193, 0.64, len(values) / 200, 0.0, 0.1]
    return [
        f"* VOL{volume}DS FILE:  5522/01",
        "Inst Type = SSA-2",
        "Origin Time : 2012/08/11   12:23:16",
        "",
        label,
        " " * 70,
        f"COMP {label}1".ljust(70),
        "Ajab Shir                 Station   37.485 N 45.891 E   Altitude 1333m   Azimuth L 324   T 54 ",
        "Epicenter 38.520 N 46.860 E   FD 12 Km mb      Ms      Mw6.1   M        ML   (BHRC   )",
        "INSTR PERIOD =  .019 SEC   DAMPING =  .640                            ",
        f"NO. OF POINTS = {len(values):6d}      DURATION = {len(values) / 200:7.3f}",
        "UNITS ARE SECONDS AND G/10",
        " " * 70,
        *in_columns([0] * 98, "5.0f", 14),
        *(line + "  .00" for line in in_columns([*reals, rate, *[0.0] * 29], "13.6E", 5)),
        *in_columns(values, "13.6E", 10),
        "/&",
    ]


def bhrc_text(**header) -> str:
    parts = [bhrc_channel(label, x / 100, **header) for label, x in (("L", A), ("V", C), ("T", B))]
    return "\n".join(line for part in parts for line in part) + "\n"


def usc_channel(label: str, values, times=None, mark: tuple[str, ...] = ()) -> list[str]:
    """Return one channel; ``values`` in g/10."""
    times = 0.005 * np.arange(len(values)) if times is None else times
    pairs = np.column_stack([times, values]).ravel()
    return [
        "FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:                        ",
        "MADE UP EARTHQUAKE                                                      21      ",
        "JAN 17, 1994 -1230 GMT                                                  22      ",
        "IBB101  94.160.0 N                                                      18      ",
        "STATION USC# 0016   34 05 22N, 118 26 05N                               39      ",
        "700 N, FARING RD., LOS ANGELES, CA                                      34",
        f"COMP {label:67}9       ",
        "MADE UP EARTHQUAKE   JAN 17, 1994 -1230 GMT                             46      ",
        "EPICENTER -   34 12 48N, 118 32 13W                                     35      ",
        "INSTR PERIOD =  .038 SEC  DAMPING =   .558  SENSITIVITY =   1.75CM/G    69      ",
        f"NO. OF POINTS = {len(values):6d}      DURATION = {times[-1]:7.3f} SEC                      50      ",
        "UNITS ARE SEC AND G/10                                                  22      ",
        "RMS ACCLN. OF COMPLETE RECORD =     .400 G/10                           45      ",
        *in_columns([0] * 100, "5.0f", 16),
        *in_columns([0.0] * 50, "10.3f", 8),
        *(" " + line for line in in_columns(pairs, "7.3f", 10)),
        *mark,
    ]


def usc_text(**header) -> str:
    parts = [usc_channel(label, x / 100, **header) for label, x in (("N90E", A), ("UP", C), ("N00E", B))]
    return "\n".join(line for part in parts for line in part) + "\n"


def usc_corrected_channel(label: str, values) -> list[str]:
    """Return one channel of Volume II; ``values`` in cm/s², on steps of 0.02 s."""
    npts = len(values)
    velocities, displacements = np.full(npts, 0.8344), np.full(npts, -0.1515)
    velocities[1:] += np.cumsum(values[1:] + values[:-1]) * 0.01
    displacements[1:] += np.cumsum(velocities[1:] + velocities[:-1]) * 0.01
    at = 0.02 * np.abs(values).argmax()
    spaced = f"EQUALLY SPACED AT {0.02:6.3f} SEC.  IN UNITS"
    return [
        f"CORRECTED ACCELEROGRAM  IIBB101  94.160.0 COMP {label:6} FILE   0  CORRESPONDING T ",
        *usc_channel(label, np.zeros(npts), 0.02 * np.arange(npts))[:13],
        "ACCELEROGRAM IS BAND-PASS FILTERED BETWEEN  .225- .325 AND 25.00-27.00 HZ.      ",
        f"{npts:6d}  INSTRUMENT AND BASELINE CORRECTED DATA                                  ",
        "AT EQUALLY-SPACED INTERVALS OF    .020  SEC.                                    ",
        f"PEAK ACCELERATION = {-np.abs(values).max():11.5f}  CMS/SEC/SEC AT {at:8.3f}   SEC.                 ",
        "PEAK   VELOCITY   =    12.05681    CMS/SEC   AT    4.500   SEC.                 ",
        "PEAK DISPLACEMENT =     1.42006      CMS     AT    4.580   SEC.                 ",
        "INITIAL VELOCITY  =      .8344  CMS/SEC;  INITIAL DISPLACEMENT =    -.1515  CMS ",
        "MADE UP EARTHQUAKE   JAN 17, 1994 -1230 GMT                                     ",
        "MAGNITUDE =  6.7    EPICENTRAL DISTANCE =  29.76 KM    M.M.I. =  8.             ",
        f"IIBB101  94.160.0   700 N, FARING RD., LOS ANGELES, CA                  COMP {label[:3]}",
        f"{label[3:]:80}",
        *in_columns([0] * 100, "5.0f", 16),
        *in_columns([0.0] * 100, "10.3f", 8),
        f"{npts:6d} POINTS OF ACC DATA {spaced} CM/SEC/SEC",
        *in_columns(values, "10.3f", 8),
        f"{npts:6d} POINTS OF VEL DATA {spaced} CM/SEC",
        *in_columns(velocities, "10.3f", 8),
        f"{npts:6d} POINTS OF DIS DATA {spaced} CM",
        *in_columns(displacements, "10.3f", 8),
    ]


def caltech_text(declared: bool = True, values=(A, C, B), *, unit: str = "CMS/SEC/SEC") -> str:
    """Return Volume II as Caltech wrote it, with or without the lines that declare the series."""
    parts = [usc_corrected_channel(label, x) for label, x in zip(("S00E", "UP", "S90W"), values, strict=True)]
    text = "\n".join(line for part in parts for line in part if declared or " POINTS OF " not in line) + "\n"
    station = "STATION NO. 117   32 47 43N,115 32 55W "
    return text.replace("STATION USC# 0016   34 05 22N, 118 26 05N", station).replace("CMS/SEC/SEC", unit)


def usc_corrected_text() -> str:
    parts = [usc_corrected_channel(label, x) for label, x in (("N90E", A), ("UP", C), ("N00E", B))]
    return "\n".join(line for part in parts for line in part) + "\n"
