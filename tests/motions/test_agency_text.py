"""Agencies' text files, written here by their layouts: values, directions, times, and honest refusals."""

import io
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from agency_files import (
    BBP,
    NPTS,
    A,
    B,
    C,
    cwa_text,
    dyna_text,
    emod3d_text,
    geonet_component,
    geonet_text,
    moment,
    renadic_channel,
    renadic_text,
    resorce_text,
)
from damaged_files import SAMPLES
from fixed_column_files import csmip_text, read
from national_files import (
    afad_text,
    bhrc_text,
    caltech_text,
    csmnc_text,
    unam_text,
    usc_channel,
    usc_corrected_text,
    usc_text,
)

from rockbatch.common.errors import InputError
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.formats import (
    RecordFile,
    afad,
    bhrc,
    columns,
    csmnc,
    cwa,
    dyna,
    geonet,
    read_record,
    unam,
    volumes,
)
from rockbatch.motions.unused import Unusable


@dataclass(frozen=True)
class Case:
    """A format, a whole file of it, and what must come out: labels, and values [m/s²] to their printed decimals."""

    name: str
    suffix: str
    text: str
    labels: tuple[str, ...]
    values: tuple[np.ndarray, ...]
    plugin: tuple[Callable, Callable]
    start: float | None


AFAD, BHRC, CSMNC, UNAM, USC = (
    (afad.is_afad_file, afad.read_afad_stream),
    (bhrc.is_bhrc_file, bhrc.read_bhrc_stream),
    (csmnc.is_csmnc_file, csmnc.read_csmnc_stream),
    (unam.is_unam_file, unam.read_unam_stream),
    (volumes.is_usc_file, volumes.read_usc_stream),
)
GEONET, DYNA, RENADIC, CWA, COLUMNS = (
    (geonet.is_geonet_file, geonet.read_geonet_stream),
    (dyna.is_dyna_file, dyna.read_dyna_stream),
    (volumes.is_renadic_file, volumes.read_renadic_stream),
    (cwa.is_cwa_file, cwa.read_cwa_stream),
    (columns.is_bbp_file, columns.read_bbp_stream),
)
UNSET = "1/1/1980 0:00:00.000"
RECORDED = moment(2016, 11, 13, 11, 2) + 19.715
CASES = [
    Case("GEONET", ".V1A", geonet_text(1), ("N28W", "S62W", "Up"), (A / 1e3, B / 1e3, C / 1e3), GEONET, RECORDED),
    Case(
        *("GEONET", ".V2A", geonet_text(2, pad=5.0), ("N28W", "S62W", "Up"), (A / 1e3, B / 1e3, C / 1e3)),
        *(GEONET, RECORDED - 5),
    ),
    Case("DYNA", ".ASC", dyna_text(), ("HNE",), (A / 100,), DYNA, moment(2009, 4, 6, 1, 32) + 40.87),
    Case(
        *("RENADIC", ".v1", renadic_text(), ("L", "V", "T"), tuple(x / 1000 * 9.81 for x in (A, C, B)), RENADIC),
        moment(2010, 2, 27, 6, 34) + 11.5,
    ),
    Case("CWA", ".txt", cwa_text(), ("U", "N", "E"), (C / 100, A / 100, B / 100), CWA, moment(1999, 9, 20, 17, 47, 2)),
    Case(
        *("AFAD", ".txt", afad_text(), ("NS", "EW", "UD"), (A / 100, B / 100, C / 100), AFAD),
        moment(2017, 7, 20, 22, 30) + 58.5,
    ),
    Case("BHRC", ".V1", bhrc_text(), ("L", "V", "T"), tuple(x / 1000 * 9.81 for x in (A, C, B)), BHRC, None),
    Case("CSMNC", ".dat", csmnc_text(), ("EW",), (A / 100,), CSMNC, None),
    Case(
        *("UNAM", ".191", unam_text(), ("N00E", "N90E", "V"), (A / 100, B / 100, C / 100), UNAM),
        moment(2017, 9, 19, 18, 14) + 44.5,
    ),
    Case("USC", ".s0a", usc_text(), ("N90E", "UP", "N00E"), tuple(x / 1000 * 9.81 for x in (A, C, B)), USC, None),
    Case("BBP", ".bbp", BBP, ("NS", "EW", "UD"), (A / 100, B / 100, C / 100), COLUMNS, None),
]
# m/s²: RENADIC and USC print 1e-3 g/10, so half of 1e-4 g, BHRC and CSMNC seven digits; the others all that there is
ROUGHLY = {"RENADIC": 5.1e-5 * 9.81, "USC": 5.1e-5 * 9.81, "BHRC": 1e-6, "CSMNC": 1e-5}
IDS = {
    "GEONET": "NZ.WTMC.20", "DYNA": "IT.AQK.", "RENADIC": ".VIADE.", "CWA": "TW.TCU068.", "AFAD": "TK.0921.", "BHRC": "I1.5522.",
    "CSMNC": "CN.51BXD.", "UNAM": "MG.CANA.", "USC": "LA.0016.", "BBP": "..",
}  # fmt: skip
"""Network, station and location by the headers, as ObsPy has them."""
every_format = pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.name}{case.suffix}")


@every_format
def test_every_component_comes_out_in_m_s2_with_step_direction_and_time(case):
    found = read(case.text.replace("\n", "\r\n"), f"STA{case.suffix}")
    assert [component.orientation.label for component in found] == list(case.labels)
    for component, label, values in zip(found, case.labels, case.values, strict=True):
        assert component.name == (f"STA.{label}" if len(found) > 1 else "STA")
        assert component.dt == pytest.approx(0.005, rel=1e-12)
        np.testing.assert_allclose(component.acceleration, values, atol=ROUGHLY.get(case.name, 1e-9))
        assert component.orientation.vertical == (label in ("Up", "UP", "U", "V", "UD"))
        assert not component.orientation.down
        assert component.start == case.start
        assert component.notes == ()
    assert len({component.station for component in found}) == 1


@every_format
def test_obspy_gets_the_same_values_in_the_files_own_unit(case, tmp_path):
    is_format, read_format = case.plugin
    path = tmp_path / f"x{case.suffix}"
    path.write_bytes(case.text.encode("latin-1"))
    stream = read_format(str(path))
    assert is_format(str(path))
    assert is_format(path)
    assert [trace.stats[case.name.lower()].component for trace in stream] == list(case.labels)
    assert [trace.id for trace in stream] == [f"{IDS[case.name]}.{label.upper()}" for label in case.labels]
    factor = case.values[0][20] / stream[0].data[20]
    for trace, values in zip(stream, case.values, strict=True):
        assert trace.stats.npts == NPTS
        assert trace.stats.delta == pytest.approx(0.005, rel=1e-12)
        np.testing.assert_allclose(
            trace.data * factor, values, rtol=1e-2, atol=5.1e-4
        )  # RENADIC's decimals, and its factor
        if case.start is not None:
            assert trace.stats.starttime.timestamp == case.start
    buffer = io.BytesIO(path.read_bytes())
    assert is_format(buffer)
    assert buffer.tell() == 0  # other formats look at it next
    head = read_format(buffer, headonly=True)
    assert (head[0].stats.npts, len(head[0].data)) == (NPTS, 0)


def plugins() -> dict[str, dict[str, Callable]]:
    """Every plugin that pyproject registers, by its name: its ``isFormat`` and ``readFormat``."""
    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())["project"]
    groups = project["entry-points"]
    formats = groups.pop("obspy.plugin.waveform")
    assert {f"obspy.plugin.waveform.{name}" for name in formats} == set(groups)
    found = {}
    for group, functions in groups.items():
        targets = {role: target.split(":") for role, target in functions.items()}
        name = group.rpartition(".")[2]
        found[name] = {role: getattr(import_module(module), function) for role, (module, function) in targets.items()}
    return found


WITH_A_PLUGIN = {"PEER AT2": "AT2", "COSMOS": "COSMOS", "CSMIP": "CSMIP", "USGS SMC": "SMC"}
FILES = [(case.name, case.text.encode("latin-1")) for case in CASES]
FILES += [(name, data) for known, name in WITH_A_PLUGIN.items() for _, data in SAMPLES[known]]
FILES.append(("CSMIP", csmip_text(1, modern=False).encode("latin-1")))  # in units of "SEC AND G", as RENADIC's are


@pytest.mark.parametrize(("name", "data"), FILES, ids=[name for name, _ in FILES])
def test_one_registered_plugin_and_no_other_takes_a_file_for_its_own(name, data):
    takers = {plugin for plugin, functions in plugins().items() if functions["isFormat"](io.BytesIO(data))}
    assert takers == {name}
    made = [case.plugin for case in CASES if case.name == name]
    assert all(dict(zip(("isFormat", "readFormat"), pair, strict=True)) == plugins()[name] for pair in made)


def test_no_plugin_takes_anything_else_nor_minds_it(tmp_path):
    strangers = [
        None,
        7,
        tmp_path,
        tmp_path / "missing",
        io.StringIO("text"),
        io.BytesIO(b""),
        io.BytesIO(b"\x00\xff" * 900),
        *(
            io.BytesIO(line * 20)
            for line in (b"2 CORRECTED ACCELEROGRAM\n", b"1 2 3\n", b"NPTS= 4, DT= .1\n", b"Origin Time  2018\n")
        ),
        *(io.BytesIO(data) for name in ("K-NET/KiK-net", "RESORCE", "MiniSEED", "SAC") for _, data in SAMPLES[name]),
    ]
    for functions in plugins().values():
        assert not any(functions["isFormat"](stranger) for stranger in strangers)


def test_values_that_touch_are_separated_by_their_columns():
    values = -11024.7 + np.arange(NPTS)  # 8 characters each: GeoNet's own V2A of Waiau has -11024.7
    text = "\n".join(geonet_component("N28W", values))
    assert "-11024.7-11023.7" in text
    np.testing.assert_allclose(read(text, "x.V1A")[0].acceleration, values / 1000)
    values = np.tile([-12.345, 12.345], 20)  # 1.2 g, at times of 100 s and more: "100.000-12.345100.005 12.345"
    text = "\n".join(renadic_channel("L", values, 100 + 0.005 * np.arange(40)))
    assert "100.000-12.345100.005" in text
    np.testing.assert_allclose(read(text, "x.v1")[0].acceleration, values * 0.981)
    columns = tuple(-1000.0 - np.abs(x) for x in (A, B, C))  # F10.4
    for component, values in zip(read(unam_text(columns=columns), "x.191"), columns, strict=True):
        np.testing.assert_allclose(component.acceleration, values / 100)


def test_only_raw_records_say_that_the_instruments_zero_is_in_them():
    raw = {case.name + case.suffix: read(case.text, f"x{case.suffix}")[0].raw for case in CASES}
    assert raw == {
        "GEONET.V1A": True,
        "GEONET.V2A": False,
        "DYNA.ASC": False,
        "RENADIC.v1": True,
        "CWA.txt": False,
        "AFAD.txt": True,
        "BHRC.V1": True,
        "CSMNC.dat": True,
        "UNAM.191": True,
        "USC.s0a": True,
        "BBP.bbp": False,
    }
    assert read(dyna_text(BASELINE_CORRECTION="BASELINE NOT REMOVED"), "x.ASC")[0].raw
    assert read(cwa_text(unit="gal."), "x.txt")[0].raw


@pytest.mark.parametrize("text", ["00000000_000000", "", "2009", "20091399_013240"])
def test_a_clock_that_was_not_set_gives_no_start(text):
    assert read(dyna_text(DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS=text), "x.ASC")[0].start is None
    assert read(renadic_text(trigger="1/1/1980 0:00:00.000"), "x.v1")[0].start is None


def test_afads_way_of_writing_times_and_components_is_read():
    text = dyna_text(DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS="2023/02/06 01:17:20.500", stream="U", NETWORK="TK")
    (up,) = read(text, "20230206011704_4614_ap_Acc_U.asc")
    assert up.orientation.vertical
    assert up.start == moment(2023, 2, 6, 1, 17) + 20.5


def test_components_point_where_bhrc_and_csmnc_say():
    longitudinal, vertical, transverse = read(bhrc_text(), "5522-1.V1")
    assert (longitudinal.orientation.azimuth, transverse.orientation.azimuth) == (324.0, 54.0)
    assert vertical.orientation.vertical
    east, up = (read(csmnc_text(label=label), f"{label}.dat")[0] for label in ("EW", "UD"))
    assert (east.orientation.azimuth, up.orientation.vertical) == (90.0, True)
    assert east.station == up.station
    assert not read(csmnc_text(kind="CORRECTED ACCELERATION"), "x.dat")[0].raw


def test_csmncs_headers_of_other_years_are_read_too():
    """As its own description has them: a misspelt word, a place before the station's code, fewer lines, no zeros."""
    text = (
        csmnc_text(np.round(A / 1000, 3), "V")
        .replace("ACCELERATION  ", "ACCCELERATION  ")
        .replace("0.005  SEC", ".005 SEC")
    )
    text = text.replace("STATION: 51BXD", "STATION: ZHONGGUANCUN（91ZGC）").replace("SITE CONDITION: ROCK\n", "")
    text = text.replace("\nCSMNC\n", "\n").replace("TIME:  20  SEC", "TIME: 20 SEC SITE CONDITION: soil")
    (component,) = list(read_record(RecordFile(Path("x.dat"), "x.dat", text.encode("gb18030"))))
    np.testing.assert_allclose(component.acceleration, np.round(A / 1000, 3) / 100, atol=1e-8)
    assert component.orientation.vertical
    assert component.dt == 0.005


@pytest.mark.parametrize(
    ("origin", "first", "day"),
    [("23:58:02.7", "00:00:01", 20), ("00:00:10", "23:59:40", 18), ("12:00:00", "12:00:05", 19)],
)
def test_a_record_of_unam_begins_on_the_day_that_is_nearest_to_its_earthquake(origin, first, day):
    text = unam_text(**{"HORA EPICENTRO (GMT)": origin, "HORA DE LA PRIMERA MUESTRA (GMT)": first})
    hour, minute, second = map(int, first.split(":"))
    assert read(text, "x.012")[0].start == moment(2017, 9, day, hour, minute, second)


@pytest.mark.parametrize("key", ["HORA EPICENTRO (GMT)", "HORA DE LA PRIMERA MUESTRA (GMT)"])
def test_a_record_of_unam_with_an_impossible_time_begins_at_none(key):
    assert read(unam_text(), "x.012")[0].start is not None
    assert read(unam_text(**{key: "23:75:00"}), "x.012")[0].start is None


@pytest.mark.parametrize(("peaks", "doubted"), [("//9999/9999", "bc"), ("/9999/9999//", "ab"), ("/9999/9999/", "")])
def test_a_channel_of_unam_without_a_stated_peak_leaves_the_others_theirs(peaks, doubted):
    components = read(unam_text(**{"ACEL. MAX.(Gal), C1-C6": peaks}), "x.191")
    of_peak = [any("peak of 9999" in finding.text for finding in component.findings) for component in components]
    assert of_peak == [channel in doubted for channel in "abc"]


def test_usc_times_from_film_are_interpolated_across_marks():
    times = np.cumsum([0, *np.random.default_rng(1).integers(4, 7, NPTS - 1)]) / 1000
    channels = [usc_channel("N90E", A / 100, times, ("/& END",)), usc_channel("DOWN", C / 100, times)]
    east, down = read("\n".join(line for channel in channels for line in channel), "x.s0a")
    assert "uneven times" in east.notes[0]
    at = np.rint(times / east.dt).astype(int)
    np.testing.assert_allclose(east.acceleration[at], A / 1000 * 9.81, atol=ROUGHLY["USC"])
    assert down.orientation.down


def test_the_reference_database_of_europe_is_read_in_its_own_layout():
    (north,) = read(resorce_text(), "15279_N.cor.acc")
    assert (north.name, north.dt, north.processed, north.orientation.azimuth) == ("15279_N.cor", 0.005, True, 0.0)
    assert (north.origin.station, north.notes) == ("Made Up-Post Office", ())
    np.testing.assert_allclose(north.acceleration, A / 100, rtol=1e-7)
    (up,) = read(resorce_text(C / 100, Orientation="Z"), "15279_V.cor.acc")
    assert (up.orientation.vertical, up.station) == (True, north.station)


def test_uscs_second_volume_has_the_peak_and_initial_velocity_of_its_series():
    east, up, north = read(usc_corrected_text(), "x.s0a")
    assert [c.orientation.label for c in (east, up, north)] == ["N90E", "UP", "N00E"]
    assert (east.dt, east.processed, east.raw, east.findings) == (0.02, True, False, ())
    for component, values in ((east, A), (up, C), (north, B)):
        np.testing.assert_allclose(component.acceleration, values / 100, atol=5.1e-6)
    assert east.initial.velocity == pytest.approx(0.008344, abs=6e-6)


@pytest.mark.parametrize("declared", [True, False])
def test_caltechs_second_volume_is_read_with_or_without_declared_series(declared):
    south, up, west = read(caltech_text(declared), "IIA001.V2")
    assert [(c.orientation.azimuth, c.orientation.vertical) for c in (south, up, west)] == [
        (180.0, False),
        (None, True),
        (270.0, False),
    ]
    assert (south.dt, south.processed, south.sensor.station, south.findings) == (0.02, True, "117", ())
    for component, values in ((south, A), (up, C), (west, B)):
        np.testing.assert_allclose(component.acceleration, values / 100, atol=5.1e-6)
    assert south.initial.velocity == pytest.approx(0.008344, abs=6e-6)


def test_caltechs_undeclared_series_in_another_unit_than_their_peak_are_not_used():
    (found, *_) = read(caltech_text(declared=False, unit="MMS/SEC/SEC"), "x.V2")
    np.testing.assert_allclose(found.acceleration, A / 1000, atol=5.1e-7)
    text = caltech_text(declared=False, values=(10 * A, 10 * C, 10 * B))
    peak = next(line for line in text.splitlines() if line.startswith("PEAK ACCELERATION"))
    in_mm = read(text.replace(peak, f"PEAK ACCELERATION = {np.abs(A).max():11.5f}  CMS/SEC/SEC AT"), "x.V2")[0]
    assert [finding.gross for finding in in_mm.findings] == [True]


@pytest.mark.parametrize("npts", [0, 1])
def test_undeclared_series_of_fewer_than_two_points_are_refused_with_the_line(npts):
    text = caltech_text(declared=False).replace(f"{NPTS:6d}  INSTRUMENT", f"{npts:6d}  INSTRUMENT", 1)
    with pytest.raises(InputError, match=f"^line 16: found {npts} points; expected at least two$"):
        read(text, "x.V2")


@pytest.mark.parametrize(
    ("case", "name"), list(zip(CASES[-6:-1], ["x.dat", "x.191", "STATION", "x.txt", "x.V1"], strict=True))
)
def test_national_files_are_recognised_by_their_content_in_a_file_of_any_name(case, name):
    assert [component.orientation.label for component in read(case.text, name)] == list(case.labels)


def test_taiwanese_local_time_is_eight_hours_ahead():
    (up, *_) = read(cwa_text(start="#StartTime(GMT+08): 2018/02/06-23:50:29.000"), "x.txt")
    assert up.start == moment(2018, 2, 6, 15, 50, 29)


def test_film_digitised_at_uneven_times_is_interpolated_and_it_is_said():
    times = np.cumsum([0, *np.random.default_rng(1).integers(5, 30, NPTS - 1)]) / 1000
    text = "\n".join(renadic_channel("UP", A / 100, times))
    (up,) = read(text, "x.v1")
    assert "uneven times" in up.notes[0]
    at = np.rint(times / up.dt).astype(int)
    np.testing.assert_allclose(up.acceleration[at], A / 1000 * 9.81, atol=5.1e-5 * 9.81)  # no sample is lost


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        (geonet_text().replace("mm/s/s at", "furlongs at").replace("1.00 mm", "1.00 fur"), "x.V1A", "fur/s/s"),
        (dyna_text(UNITS="cm/s"), "x.ASC", 'unknown acceleration unit "cm/s"'),
        (cwa_text(unit="count"), "x.txt", 'unknown acceleration unit "count"'),
    ],
)
def test_a_unit_that_is_not_understood_costs_its_channel_with_the_reason(text, name, message):
    unusable = [reading for reading in read(text, name) if isinstance(reading, Unusable)]
    assert unusable
    assert all(message in reading.reason for reading in unusable)


@pytest.mark.parametrize(
    ("text", "name", "message"),
    [
        (
            geonet_text().replace("points  43", "points  44", 1),
            "x.V1A",
            r"line 10 says 44 points, line 20 \[43, 0, 0\]",
        ),
        (
            geonet_text().replace("43       0       0       0", "43      -1       0       0", 1),
            "x.V1A",
            r"\[43, -1, 0\]",
        ),
        (geonet_text().replace(f"{A[20]:8.1f}", "    1_00", 1), "x.V1A", 'line 29: found "1_00"; expected a number'),
        (geonet_text() + "1.0\n", "x.V1A", r'line 94: found "1.0"; expected ".*after the last declared value"'),
        (dyna_text(NDATA="44", DURATION_S=None), "x.ASC", "44 values from line 19 on take 44 lines, but there are 43"),
        (dyna_text(NDATA="4.5"), "x.ASC", "expected a whole number"),
        (dyna_text(NDATA=None, UNITS=None), "x.ASC", "the header lacks NDATA, UNITS"),
        (dyna_text(DATA_TYPE="VELOCITY"), "x.ASC", "DATA_TYPE: VELOCITY; expected ACCELERATION"),
        (dyna_text(np.tile(A, 3)).rstrip()[:-1], "x.ASC", "line 148: .*the file is cut"),
        (renadic_text().replace("  0.055", "  0.050", 1), "x.v1", "channel L from line 1 on: time does not grow"),
        (csmnc_text(kind="UNCORRECTED VELOCITY"), "x.dat", 'line 11: found "VELOCITY"; expected accelerations'),
        (afad_text(**{"RAW PGA VALUES (gal)": None}), "x.txt", "which states the unit"),
        (resorce_text(**{"Number of Data": "40"}), "x.cor.acc", "line 19: found .* after the 40 declared values"),
        (emod3d_text(count=NPTS - 6), "HALS.090", f"{NPTS - 6} values from line "),
        (caltech_text(declared=False).replace(f"{NPTS:6d}  INS", f"{NPTS - 8:6d}  INS"), "x.V2", r"line \d+: found"),
        (bhrc_text().replace("/&", "//", 1), "x.V1", 'line 33: found "//"; expected "/&" after 43 values'),
        (resorce_text(**{"Number of Data": "many"}), "x.cor.acc", 'Number of Data: "many"; expected a number'),
        (unam_text(**{"NUM. TOTAL DE MUESTRAS, C1-C6": "/43/43/42"}), "x.191", "42, 43; expected the same for all"),
        (unam_text(**{"NUM. TOTAL DE MUESTRAS, C1-C6": "/44/44/44"}), "x.191", "44 samples from line .*it is cut"),
        (unam_text(**{"NUM. TOTAL DE MUESTRAS, C1-C6": "/40/40/40"}), "x.191", "after the 40 declared samples"),
        (unam_text(**{"FACTOR DE DECIMACION": "2"}), "x.191", "samples were left out"),
        (unam_text(**{"UNIDADES DE LOS DATOS": None}), "x.191", "the header lacks UNIDADES DE LOS DATOS"),
        (
            unam_text(**{"ORIENTACION C1-C6 (rumbo;orientacion)": "/V/N90E/N00E"}),
            "x.191",
            "expected the directions V N90E",
        ),
        (bhrc_text(volume=2), "x.V1", "Volume 2, whose layout is not known; take the .V1 file"),
        (bhrc_text(rate=0.0), "x.V1", "43 points, line 22 0 samples per second"),
        (usc_text().replace("\n   0.000", "\n0.000  ", 1), "x.s0a", "line 28: .*expected a blank and ten columns"),
        (usc_corrected_text().replace("POINTS OF ACC", "POINTS OF VEL", 1), "x.s0a", "line 46: .*unit of accel"),
        (resorce_text(**{"Time Increment (s)": "0"}), "x.cor.acc", "expected a whole number and an interval"),
        (
            resorce_text().replace("Accelaration time", "Velocity time"),
            "x.cor.acc",
            'no line "Acceleration time series',
        ),
        (cwa_text(DataSequence="Time U(+); N(+)"), "x.txt", "found 4 columns; the header says time and U, N"),
        (cwa_text(DataSequence="Time U(-); N(+); E(+)"), "x.txt", 'DataSequence: "Time U'),
    ],
)
def test_counts_and_units_that_contradict_each_other_are_refused_with_the_place(text, name, message):
    with pytest.raises(InputError, match=message):
        read(text, name)


def test_channels_that_begin_at_different_times_need_a_clock():
    late = renadic_channel("T", B / 100, 0.5 + 0.005 * np.arange(NPTS), trigger="1/1/1980 0:00:00.000")
    text = "\n".join([*renadic_channel("L", A / 100, trigger="1/1/1980 0:00:00.000"), *late])
    with pytest.raises(InputError, match=r"begin at different times \(0, 0.5 s\)"):
        read(text, "x.v1")
    first, second = read(text.replace("1/1/1980", "2/27/2010"), "x.v1")
    assert second.start - first.start == pytest.approx(0.5)


@pytest.mark.parametrize("trigger", [UNSET, "2/27/2010 3:55:43.000"])
def test_each_part_of_a_recording_in_two_files_is_paired_within_itself(tmp_path, trigger):
    """RENADIC's "parte1" and "parte2": one station, one time of triggering or none, and a vertical in each."""
    coda = [np.random.default_rng(seed).standard_normal(NPTS) for seed in range(3)]
    for part, series in ((1, (A / 100, C / 100, B / 100)), (2, coda)):
        channels = (renadic_channel(label, x, trigger=trigger) for label, x in zip("LVT", series, strict=True))
        text = "\n".join(line for channel in channels for line in channel)
        (tmp_path / f"angol1002271parte{part}.v1").write_bytes(text.encode("latin-1"))
    found = read_motions(tmp_path)
    assert not found.unusable
    assert [(motion.source, motion.vertical_source) for motion in found.motions] == [
        (f"angol1002271parte{part}.v1 ({label})", f"angol1002271parte{part}.v1 (V)")
        for part in (1, 2)
        for label in ("L", "T")
    ]


def with_a_clock(folder: Path, label: str = "INTC") -> None:
    late = 3.0 + 0.005 * np.arange(NPTS)
    channels = [renadic_channel(name, x / 100, trigger=UNSET) for name, x in (("L", A), ("V", C), ("T", B))]
    channels.append(renadic_channel(label, A / 100, late, number=4, trigger=UNSET))
    text = "\n".join(line for channel in channels for line in channel)
    (folder / "x.v1").write_bytes(text.encode("latin-1"))


@pytest.mark.parametrize("label", ["INTC", "IntC", "TIME CODE", "IRIG-E", "Ext Clock"])
def test_the_recorders_clock_is_no_ground_motion_and_nobody_misses_it(tmp_path, label):
    with_a_clock(tmp_path, label)
    found = read_motions(tmp_path)
    assert [motion.name for motion in found.motions] == ["x.L", "x.T"]
    assert not found.unusable
    assert [(left.source, left.reason) for left in found.left_out] == [
        (f"x.v1 ({label})", f"no record: {label}, the recorder's clock")
    ]


def test_one_component_that_is_not_understood_can_be_left_out_and_the_others_stay(tmp_path):
    with_a_clock(tmp_path, "TILT")
    text = (tmp_path / "x.v1").read_text(encoding="latin-1").replace("  3.", "  0.")
    (tmp_path / "x.v1").write_text(text, encoding="latin-1")
    (refused,) = read_motions(tmp_path).unusable
    assert refused.label == "TILT"
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x.v1"\ncomponent = "TILT"\nuse = false\n')
    found = read_motions(tmp_path)
    assert [motion.name for motion in found.motions] == ["x.L", "x.T"]
    assert [(left.name, left.reason) for left in found.left_out] == [("x.TILT", "use = false in motions.toml")]
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x.v1"\ncomponent = "X"\nuse = false\n')
    with pytest.raises(InputError, match='the file has "L", "V", "T", "TILT"'):
        read_motions(tmp_path)


def test_emod3d_files_are_one_station_whose_unit_is_stated(tmp_path):
    """The first line of a file of qcore's: 15738 samples of 5 ms at HALS, whose names say the direction."""
    for label, values in (("000", A), ("090", B), ("ver", C)):
        (tmp_path / f"HALS.{label}").write_text(emod3d_text(label, values))
    assert all("no unit in the header" in refused.reason for refused in read_motions(tmp_path).unusable)
    found = read_motions(tmp_path, options=ReadOptions(unit="cm/s2"), confirmed=["*"])
    assert [motion.name for motion in found.motions] == ["HALS.000", "HALS.090"]
    for motion, values in zip(found.motions, (A, B), strict=True):
        assert (motion.dt, motion.azimuth) == (0.005, float(motion.name[-3:]))
        np.testing.assert_allclose(motion.horizontal, values / 100, rtol=1e-5)
        np.testing.assert_allclose(motion.vertical, C / 100, rtol=1e-5)


def test_a_dyna_file_of_two_components_is_refused_where_the_second_begins():
    lines = dyna_text().splitlines()
    with pytest.raises(InputError, match='line 3: "EVENT_NAME" a second time'):
        read("\n".join([*lines[:2], lines[0], *lines[2:]]), "x.ASC")


@pytest.mark.parametrize(("sign", "down"), [("+", False), ("-", True)])
def test_a_vertical_of_unam_points_down_where_its_sign_says_so(sign, down):
    ways = {"ORIENTACION C1-C6 (rumbo;orientacion)": f"/N00E;+/N90E;+/V;{sign}"}
    *level, vertical = read(unam_text(**ways), "CANA1709.191")
    assert [part.orientation.azimuth for part in level] == [0.0, 90.0]
    assert (vertical.orientation.vertical, vertical.orientation.down) == (True, down)
    np.testing.assert_allclose(vertical.upward, (-1.0 if down else 1.0) * C / 100, rtol=1e-3, atol=1e-6)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"NUMERO DE CANALES": "7"}, "NUMERO DE CANALES: 7; expected 1 to 6"),
        ({"NUMERO DE CANALES": "0"}, "NUMERO DE CANALES: 0; expected 1 to 6"),
        ({"NUMERO DE CANALES": "2.5"}, "NUMERO DE CANALES: 2.5; expected 1 to 6"),
        ({"FORMATO DATOS (FORTRAN,10 campos/dato)": "2F10.4"}, r'"2F10.4"; expected one such as 3F10.4'),
        ({"FORMATO DATOS (FORTRAN,10 campos/dato)": "3F1.0"}, r'"3F1.0"; expected one such as 3F10.4'),
        ({"FORMATO DATOS (FORTRAN,10 campos/dato)": "free"}, r'"free"; expected one such as 3F10.4'),
    ],
)
def test_a_header_of_unam_that_cannot_be_is_refused(changed, message):
    with pytest.raises(InputError, match=message):
        read(unam_text(**changed), "x.191")


@pytest.mark.parametrize("count", [1, 6])
def test_a_file_of_unam_may_have_one_channel_and_six(count):
    ways = ("N00E", "N90E", "V", "N10E", "S80E", "N20E")[:count]
    found = read(unam_text(ways, (A, B, C, A, B, C)[:count]), "x.191")
    assert [component.orientation.label for component in found] == list(ways)
