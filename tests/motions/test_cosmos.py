"""COSMOS V1 and V2: declared formats, unit codes, the right interval, directions, and honest refusals."""

import io
from datetime import UTC, datetime

import numpy as np
import pytest
from fixed_column_files import (
    NPTS,
    A,
    B,
    C,
    cosmos_header,
    cosmos_series,
    cosmos_text,
    read,
)

from rockbatch.common.errors import InputError
from rockbatch.motions import read_motions
from rockbatch.motions.formats.cosmos import is_cosmos_file, read_cosmos_stream

START = datetime(2018, 11, 30, 17, 29, tzinfo=UTC).timestamp() + 6.332


def three_channels(stage: str = "Uncorrected") -> str:
    return "".join(
        cosmos_text(values, direction, scnl="", stage=stage)
        for values, direction in ((A, "90 Deg"), (C, "Up"), (B, "360 Deg"))
    )


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize("layout", ["8F10.5", "1E15.6", "1PE15.6"])
@pytest.mark.parametrize("version", ["01.00", "01.20"])
def test_one_channel_comes_out_in_m_s2_with_step_direction_and_time(version, layout, newline):
    text = cosmos_text(version=version, series={"layout": layout}).replace("\n", newline)
    (component,) = read(text, "NP8040.HNE.V1c")
    np.testing.assert_allclose(component.acceleration, A / 100, atol=1e-12)  # three decimals, all printed
    assert (component.name, component.dt, component.start) == ("NP8040.HNE", 0.005, START)
    assert component.orientation.azimuth == 90
    assert component.raw
    assert component.notes == ("location: Building; ground level",)


@pytest.mark.parametrize(
    "end", ["/&  --- End of data", "/&  ----------  End-of-data for Chan  1  ---", "End-of-data for Chan  1"]
)
def test_a_v1c_file_of_cgs_is_read_with_its_unit_line_and_its_end_mark(end):
    values = np.round(A / 981, 6)
    lines = cosmos_header("Uncorrected acceleration", values, "360 deg", unit_code=2, interval_ms=5.0)
    rows = ["".join(f"{value:9.6f}" for value in values[i : i + 8]).ljust(80) for i in range(0, NPTS, 8)]
    declared = f"   {NPTS} acceleration pts, approx   0 secs, units=g.     (02)Format=(8f9.6)   "
    channel = "\n".join([*lines, declared, *rows, end])
    first, second = read(f"{channel}\n{channel.replace('360 deg', '90 deg').replace('HNE', 'HNN')}\n", "CE23837.V1C")
    for component in (first, second):
        np.testing.assert_allclose(component.acceleration, values * 9.81, atol=1e-12)
        assert (component.dt, component.unit, component.raw) == (0.005, "g", True)


def test_several_channels_of_one_file_are_one_station_and_named_by_their_directions(tmp_path):
    (tmp_path / "STA.v2").write_bytes(three_channels("Corrected").encode("latin-1"))
    found = read_motions(tmp_path)
    assert not found.unusable
    assert [motion.name for motion in found.motions] == ["STA.90", "STA.360"]
    for motion, values in zip(found.motions, (A, B), strict=True):
        np.testing.assert_allclose(motion.horizontal, values / 100, atol=1e-12)
        np.testing.assert_allclose(motion.vertical, C / 100, atol=1e-12)


def test_blank_lines_between_channels_and_the_order_of_comments_change_nothing():
    channels = [
        cosmos_text(values, direction, scnl="8040.HNE.NP.D0") for values, direction in ((A, "90 Deg"), (B, "360 Deg"))
    ]
    plain = read("".join(channels), "x.v1c")
    assert len(plain) == 2
    code = "|<SCNL>8040.HNE.NP.D0    <AUTH> 2019/05/28 02:27:48.000"
    other_order = [text.replace(f"| a comment\n{code}", f"{code}\n| a comment") for text in channels]
    for text in ("\n \n".join(channels), "".join(other_order)):
        assert text != "".join(channels)
        for component, expected in zip(read(text, "x.v1c"), plain, strict=True):
            np.testing.assert_array_equal(component.acceleration, expected.acceleration)
            assert (component.station, component.name, component.notes) == (
                expected.station,
                expected.name,
                expected.notes,
            )


def test_one_file_per_channel_is_one_station_but_not_another_location(tmp_path):
    for name, values, direction in (("HNE", A, "90 Deg"), ("HNZ", C, "Up")):
        text = cosmos_text(values, direction, scnl=f"8040.{name}.NP.D0")
        (tmp_path / f"NP8040.{name}.V1c").write_bytes(text.encode("latin-1"))
    (motion,) = read_motions(tmp_path).motions
    assert motion.vertical is not None
    stations = {
        read(text, "x.V1c")[0].station
        for text in (
            cosmos_text(),
            cosmos_text(stage="Corrected"),
            cosmos_text(location="Ground"),
            cosmos_text(scnl="8040.HNE.NP.D1"),
        )
    }
    assert len(stations) == 4


def test_velocities_and_displacements_after_the_accelerations_are_read_over():
    under_one_header = cosmos_text(stage="Corrected") + "\n".join(
        [*cosmos_series("velocity", A / 9, unit="cm/sec(05)"), *cosmos_series("displacement", A / 99, unit="cm(06)")]
    )
    own = cosmos_header("Corrected velocity", A / 9, "90 Deg", unit_code=5)
    under_their_own = cosmos_text(stage="Corrected") + "\n".join(
        [*own, *cosmos_series("velocity", A / 9, unit="cm/sec(05)")]
    )
    for text in (under_one_header, under_their_own):
        (component,) = read(text, "x.V2")
        np.testing.assert_allclose(component.acceleration, A / 100, atol=1e-12)
        assert not component.raw


@pytest.mark.parametrize(
    ("unit", "code", "factor"),
    [
        ("cm/sec2(04)", 4, 0.01),
        ("cm/sec2 (04)", -999, 0.01),
        ("g(02)", 2, 10.0),
        ("gal(10)", 10, 0.01),
        ("(04)", 4, 0.01),
    ],
)
def test_units_go_by_their_codes(unit, code, factor):
    (component,) = read(cosmos_text(unit_code=code, series={"unit": unit}), "x.V1", gravity=10.0)
    np.testing.assert_allclose(component.acceleration, A * factor, atol=1e-12)


@pytest.mark.parametrize(
    ("header", "expected"),
    [
        ({"direction": "Up"}, (True, False, None)),
        ({"direction": "Down", "scnl": "", "azimuth_code": 401}, (True, True, None)),
        ({"direction": "S62W"}, (False, False, 242.0)),
        ({"direction": "Other", "azimuth_code": 340}, (False, False, 340.0)),
        ({"direction": "North", "azimuth_code": 12}, (False, False, 0.0)),
        ({"direction": "Other", "azimuth_code": 401, "scnl": ""}, (True, True, None)),
        ({"direction": "Other", "azimuth_code": 402}, (True, False, None)),
        ({"direction": "Down", "azimuth_code": 401}, (True, True, None)),  # beside BNZ, which says no sign
        ({"direction": "Vert", "azimuth_code": 401}, (True, True, None)),
        ({"direction": "Up", "azimuth_code": 402}, (True, False, None)),
        ({"direction": "Other", "azimuth_code": 0, "scnl": "BMR.BNZ.AK.--"}, (True, False, None)),
        ({"direction": "Other", "azimuth_code": 700}, (False, False, None)),
    ],
)
def test_direction_is_by_the_text_else_by_the_sensors_code_else_by_the_seed_channel(header, expected):
    scnl = {} if "scnl" in header else {"scnl": "BMR.BNZ.AK.--" if expected[0] else "BMR.BNE.AK.--"}
    (component,) = read(cosmos_text(A, **header, **scnl), "x.V2c")
    way = component.orientation
    assert (way.vertical, way.down, way.azimuth) == expected


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        ("90 Deg", 360, "90"),
        ("S62W", 62, "S62W"),
        ("North", 12, "North"),
        ("S62W", 242, ""),
        ("North", 360, ""),
        ("N", 4, ""),
    ],
)
def test_another_azimuth_in_the_sensors_code_is_remarked_though_the_text_decides(text, code, said):
    (component,) = read(cosmos_text(direction=text, azimuth_code=code, scnl=""), "x.V2c")
    words = [f'its header says "{said}", but as integer 54 "{code}"; decided by: the first; check which is right']
    assert [finding.text for finding in component.findings] == words * bool(said)


def test_a_clock_that_was_not_set_gives_no_start():
    assert read(cosmos_text(clock=(-999,) * 5), "x.V1")[0].start is None
    assert read(cosmos_text(clock=(2018, 13, 30, 17, 29)), "x.V1")[0].start is None


def test_a_header_peak_that_is_not_in_the_data_is_said_whatever_its_sign():
    peak = np.abs(A).max()
    assert read(cosmos_text(peak=peak, location=""), "x.V1")[0].notes == ()
    assert read(cosmos_text(peak=-peak, location=""), "x.V1")[0].notes == ()
    assert read(cosmos_text(peak=-999.0, location=""), "x.V1")[0].notes == ()
    assert "header states a peak of" in read(cosmos_text(peak=peak / 2, location=""), "x.V1")[0].findings[0].text


def test_the_mark_of_missing_values_is_no_acceleration_unless_the_peak_reaches_it():
    values = np.array([*A, -999.0, *A])
    with pytest.raises(InputError, match=r"1 of 87 values are -999, which marks those that are missing"):
        read(cosmos_text(values, peak=float(np.abs(A).max())), "x.V1")
    with pytest.raises(InputError, match="marks those that are missing"):
        read(cosmos_text(values, peak=-999.0), "x.V1")  # which stands for an unknown peak
    strong = np.array([*A, -999.0, 1200.0, *A])
    assert len(read(cosmos_text(strong), "x.V1")[0].acceleration) == len(strong)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (cosmos_text(series={"unit": "counts(50)"}), r'line 46: found the unit "counts\(50\)".*take the V1 or V2'),
        (cosmos_text(series={"unit": "g(04)"}), r'"g\(04\)", and code 4 as integer 3.*expected them to agree'),
        (cosmos_text(unit_code=2), r'"cm/sec2\(04\)", and code 2 as integer 3'),
        (cosmos_text(interval_ms=-999.0), "an interval of -999 ms"),
        (cosmos_text(series={"count": 40}), 'line 52: found .*expected "End-of-data'),
        (cosmos_text(series={"count": 0}), "found 0 values"),
        (cosmos_text(series={"layout": "free"}), r'line 46: found the format "\(free\)"; expected one such as'),
        (cosmos_text(series={"layout": "0F10.5"}), "found the format"),
        (cosmos_text().replace("100 Integer", " 90 Integer"), "line 14: found .*expected 100 Integer-header values"),
        (cosmos_text().replace("100 Integer", "100 Real"), "line 14: found .*expected 100 Integer-header values"),
        (cosmos_text().replace("with 13", "with 12"), 'line 13: found .*expected "100 Integer-header'),
        (cosmos_text().replace("2 Comment", "1 Comment"), 'line 45: found .*expected ".*acceleration pts'),
        (cosmos_text() + "1.0\n", "line 54: found "),
        (cosmos_text(direction="Up", scnl="8040.HNE.NP.D0"), "directions contradict each other: Up and HNE"),
        (
            cosmos_text(direction="Up", azimuth_code=401, scnl="8040.HNZ.NP.D0"),
            "contradict each other: Up and Down and HNZ",
        ),
        ("\n".join(cosmos_header("Response spectra", A, "Up")), "line 1: spectra; expected accelerations"),
        (
            "\n".join(
                [
                    *cosmos_header("Corrected velocity", A, "90 Deg", unit_code=5),
                    *cosmos_series("velocity", A, unit="cm/sec(05)"),
                ]
            ),
            "holds velocity; expected accelerations: take the file that has them",
        ),
        (cosmos_text().replace("-999, -999.00", "-999, -99.9.0"), 'line 13: found "-99.9.0"; expected a number'),
    ],
)
def test_what_cannot_be_used_is_refused_with_place_and_finding(text, message):
    with pytest.raises(InputError, match=message):
        read(text, "x.V1")


def test_obspy_gets_the_files_own_unit_and_the_channels_codes(tmp_path):
    path = tmp_path / "x.V1c"
    path.write_bytes(cosmos_text().encode("latin-1"))
    assert is_cosmos_file(str(path))
    (trace,) = read_cosmos_stream(str(path))
    np.testing.assert_allclose(trace.data, A, atol=1e-12)
    assert trace.id == "NP.8040.D0.HNE"
    assert (trace.stats.cosmos.unit, trace.stats.delta) == ("cm/s2", 0.005)
    assert trace.stats.starttime.timestamp == START
    assert [trace.stats.npts for trace in read_cosmos_stream(io.BytesIO(three_channels().encode("latin-1")))] == [
        NPTS
    ] * 3
