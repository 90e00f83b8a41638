"""PEER AT2 files: header dialects, exact counts, and nothing but a clear error for damaged ones."""

import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motion_files import at2_text, wiggle, write_at2

from rockbatch.common.errors import InputError
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.formats import RecordFile, read_record
from rockbatch.motions.formats.at2 import read_at2

VALUES = wiggle(12)


def read(text: str):
    return read_at2(io.BytesIO(text.encode("latin-1")))[0]


@pytest.mark.parametrize(
    ("count", "dt"),
    [
        ("NPTS=     12, DT=   .0100 SEC", 0.01),
        ("NPTS=  12, DT= .02000 SEC", 0.02),
        ("NPTS=     12, DT=   .0050 SEC,                     ", 0.005),
        ("NPTS=   12  DT=   .0050 SEC,", 0.005),
        ("NPTS=     12, DT=   .0100 SEC,  -5 POLE @      .03000 HZ,   0 POLE @      .00000", 0.01),
        ("    12    0.0100    NPTS, DT", 0.01),
        ("12 .005 NPTS, DT", 0.005),
        ("npts= 12, dt= 0.00390625 sec", 0.00390625),
        ("NPTS=12,DT=.01SEC", 0.01),
        ("NPTS= 12, DT= 5.0E-03 SEC", 0.005),
        ("NPTS, DT = 12, .0024", 0.0024),
    ],
)
def test_every_dialect_of_the_count_line_gives_count_and_step(count, dt):
    trace = read(at2_text(VALUES, count=count))
    assert trace.stats.npts == 12
    # ObsPy keeps 1/dt as well; the step that it gives back is off by rounding at most
    assert trace.stats.delta == pytest.approx(dt, rel=1e-15)
    np.testing.assert_allclose(trace.data, VALUES, rtol=1e-6)  # seven digits in the file


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_line_ends_and_latin_1_do_not_matter(newline):
    trace = read(at2_text(VALUES, title="Düzce, 11/12/1999, Göynük, E", newline=newline))
    assert trace.stats.at2.station == "Göynük"
    assert trace.stats.npts == 12


@pytest.mark.parametrize(
    ("title", "event", "date", "station", "component"),
    [
        ("Duzce Turkey, 11/12/1999, Lamont 362, E", "Duzce Turkey", "11/12/1999", "Lamont 362", "E"),
        ("San Simeon CA, 12/22/2003, Dam - Toe, UP", "San Simeon CA", "12/22/2003", "Dam - Toe", "UP"),
        (
            "CAPE MENDOCINO 04/25/92 1806, CAPE MENDOCINO, 000 (CDMG STATION 89005)",
            "CAPE MENDOCINO",
            "04/25/92 1806",
            "CAPE MENDOCINO",
            "000",
        ),
        ("Erzincan, 3/13/1992, Erzincan, NS (rotated)", "Erzincan", "3/13/1992", "Erzincan", "NS"),
        ("no commas at all", "", "", "", ""),
    ],
)
def test_event_date_station_and_component_come_from_line_2(title, event, date, station, component):
    at2 = read(at2_text(VALUES, title=title)).stats.at2
    assert (at2.event, at2.date, at2.station, at2.component) == (event, date, station, component)


def test_values_that_touch_in_fortran_columns_are_separated():
    values = -np.abs(wiggle(13))
    columns = at2_text(values, number=lambda v: f"{v:14.7E}"[:14].rjust(14))
    assert "E-02-" in columns  # they do touch
    np.testing.assert_allclose(read(columns).data, values, rtol=1e-6)


def test_columns_of_numbers_without_any_blank_between_positive_ones_follow_the_count():
    text = at2_text(range(7), number=lambda v: f"{v:4.2f}")
    assert "0.001.002.003.004.00" in text
    np.testing.assert_array_equal(read(text).data, range(7))


def test_fortran_double_precision_exponents_are_numbers():
    values = wiggle(12)
    np.testing.assert_allclose(
        read(at2_text(values, number=lambda v: f"{v:15.6e}".replace("e", "D"))).data, values, 1e-6
    )


def test_a_file_cut_within_its_last_number_is_an_error_though_the_count_is_right():
    text = at2_text(wiggle(200)).rstrip()
    for cut in range(1, 10):
        with pytest.raises(InputError, match=r"cut|found"):
            read(text[:-cut])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no number of points and time step"),
        ("<html>\n<body>please log in</body>\n", "no number of points and time step"),
        (at2_text(VALUES).replace("E-0", "X-0", 1), r"line \d+: found"),
        (at2_text([*VALUES[:5], np.nan, *VALUES[5:]], number=lambda v: f" {v:.7e}"), 'value 6 of 13 is "nan"'),
        (at2_text([*VALUES[:5], np.inf, *VALUES[5:]], number=lambda v: f" {v:.7e}"), 'value 6 of 13 is "inf"'),
        (at2_text(VALUES, count="NPTS= 12, DT= 0.0 SEC"), "line 4.*time step of 1e-05 to 1 s"),
        (at2_text(VALUES, unit="VELOCITY TIME SERIES IN UNITS OF CM/S"), "VELOCITY TIME.*accelerations"),
        (at2_text(range(12), number=lambda v: f" 1_{v:.0f}"), r'line 5: found "1_0"'),
    ],
)
def test_what_cannot_be_used_is_refused_with_place_and_finding(text, message):
    with pytest.raises(InputError, match=message):
        read(text)


def test_the_error_names_the_file(tmp_path):
    path = tmp_path / "short.AT2"
    path.write_text(at2_text(VALUES, count="NPTS= 11, DT= .01 SEC"))
    with pytest.raises(InputError, match=r"short\.AT2: the header says NPTS = 11.*holds 12 values"):
        read_at2(str(path))


def test_obspy_reads_at2_without_a_format(tmp_path):
    obspy = pytest.importorskip("obspy")
    path = tmp_path / "x.AT2"
    path.write_text(at2_text(VALUES))
    stream = obspy.read(str(path))
    assert stream[0].stats._format == "AT2"
    assert stream[0].stats.channel == "228"
    np.testing.assert_allclose(obspy.read(io.BytesIO(path.read_bytes()))[0].data, VALUES, rtol=1e-6)


numbers = st.floats(-10, 10, allow_subnormal=False).map(lambda v: 0.0 if abs(v) < 1e-30 else v)


@settings(max_examples=60, deadline=None)
@given(st.lists(numbers, min_size=1, max_size=60), st.sampled_from([".0100", "0.005", ".02000"]))
def test_what_is_written_is_read_back(values, dt):
    trace = read(at2_text(values, dt=dt))
    assert trace.stats.npts == len(values)
    np.testing.assert_allclose(trace.data, values, rtol=1e-6, atol=0)  # E15.7 has seven digits


@pytest.mark.parametrize(
    ("title", "azimuth"),
    [
        ("Made-up, 1/17/1994, Test Station, 228", 228.0),  # what the header says goes before the file's name
        ("Made-up, 1/17/1994, Test Station", 90.0),
        ("N", 90.0),  # a title of one word is no direction
        ("Made-up, N", 0.0),
    ],
)
def test_the_direction_is_that_of_the_header_else_that_of_the_name(title, azimuth):
    data = at2_text(wiggle(), title=title).encode()
    (component,) = read_record(RecordFile(Path("x_090.AT2"), "x_090.AT2", data))
    assert component.orientation.azimuth == azimuth


@pytest.mark.parametrize(
    ("title", "event", "date", "station", "component"),
    [
        ("Big One, 1/17/1994, Some Dam (upper left), 104", "Big One", "1/17/1994", "Some Dam (upper left)", "104"),
        ("BIG ONE 2/9/71 14:00, SOME DAM (LEFT, TOE), UP", "BIG ONE", "2/9/71 14:00", "SOME DAM (LEFT, TOE)", "UP"),
        ("BIG ONE 04/25/92 1806, STURNO (STN), 270, (ENEL)", "BIG ONE", "04/25/92 1806", "STURNO (STN)", "270"),
        ("AFTERSHOCK 09/20/99 2146, XYZ039, W, CWB", "AFTERSHOCK", "09/20/99 2146", "XYZ039", "W"),
        ("Big One, 1994/01/17, 12:31, Town Hall, 090 (cut off, as", "Big One", "1994/01/17 12:31", "Town Hall", "090"),
        ("Kobe, 1995.01.16, KJMA (JMA), DWN (JMA)", "Kobe", "1995.01.16", "KJMA (JMA)", "DWN"),
        ("Big One, 17 Jan 1994, 04:31:02 UTC, CEM, L", "Big One", "17 Jan 1994 04:31:02 UTC", "CEM", "L"),
        ("Big One, January 17, 1994, 0431, CEM, L", "Big One", "January 17, 1994 0431", "CEM", "L"),
        ("Big One, 10/29/83, 23:29 CEM, UP", "Big One", "10/29/83 23:29", "CEM", "UP"),
        ("Big One, 10/29/83, 1336, 000", "Big One", "10/29/83", "1336", "000"),  # four digits may be a station
        ("Big One, 19990921, Some Town", "Big One", "19990921", "Some Town", ""),
        ("BIG ONE 10/06/2000 13:30, XYZ015, NS [K-NET]", "BIG ONE", "10/06/2000 13:30", "XYZ015", "NS"),
        ("BIG ONE 10/18/89 00:05, ARRAY #3, 000 - CDMG 47381", "BIG ONE", "10/18/89 00:05", "ARRAY #3", "000"),
        ("Big One, 1/17/1994, South - Annex", "Big One", "1/17/1994", "South - Annex", ""),
        ("Big One, 1/17/1994, Town Hall, S - N", "Big One", "1/17/1994", "Town Hall", "S - N"),
        ("Big One 1/16/1995 20:46 (UTC), Town, 000", "Big One", "1/16/1995 20:46 (UTC)", "Town", "000"),
        ("Big One, 1/16/1995, 20h46, Town, 000", "Big One", "1/16/1995 20h46", "Town", "000"),
    ],
)
def test_parentheses_agencies_dates_and_clocks_of_a_title_stay_out_of_each_other(
    title, event, date, station, component
):
    at2 = read(at2_text(VALUES, title=title)).stats.at2
    assert (at2.event, at2.date, at2.station, at2.component) == (event, date, station, component)


@pytest.mark.parametrize(
    ("unit", "in_g"), [("0.001 G", 1e-3), ("G/1000", 1e-3), ("0.1 G", 0.1), ("G/10", 0.1), ("%G", 0.01)]
)
def test_a_share_of_g_is_a_unit(tmp_path, unit, in_g):
    values = wiggle(200)
    write_at2(tmp_path, "x_000.AT2", values / in_g, unit=f"ACCELERATION TIME SERIES IN UNITS OF {unit}")
    (motion,) = read_motions(tmp_path, gravity=1.0).motions
    assert np.allclose(motion.horizontal, values, atol=1e-6)


def test_an_unknown_unit_gives_way_to_a_statement_and_cm_s_to_a_manifest_only(tmp_path):
    for unit, study in (("FURLONGS", 1), ("CM/S", 0)):
        write_at2(tmp_path, "x_000.AT2", wiggle(200), unit=f"TIME SERIES IN UNITS OF {unit}")
        (refused,) = read_motions(tmp_path).unusable
        assert "write unit = " in refused.reason
        assert len(read_motions(tmp_path, options=ReadOptions(unit="g")).motions) == study
        (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x_000.AT2"\nunit = "g"\n')
        assert len(read_motions(tmp_path).motions) == 1
        (tmp_path / "motions.toml").unlink()
