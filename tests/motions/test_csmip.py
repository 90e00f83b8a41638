"""CSMIP Volumes 1 and 2, as CGS and as CDMG wrote them: several channels, declared layouts, honest refusals."""

import io
from datetime import UTC, datetime

import numpy as np
import pytest
from fixed_column_files import (
    NPTS,
    A,
    B,
    C,
    cosmos_text,
    csmip_channel,
    csmip_text,
    in_columns,
    read,
)

from rockbatch.common.errors import InputError
from rockbatch.motions import read_motions
from rockbatch.motions.formats import volumes
from rockbatch.motions.formats.volumes import read_csmip_stream
from rockbatch.motions.unused import Unusable

START = datetime(2019, 7, 6, 3, 19, 37, tzinfo=UTC).timestamp() + 0.5
TO_M_S2 = {1: 9.81e-3, 2: 0.01}  # of the values that csmip_text takes: g/1000, and cm/s²
PRINTED = {(1, True): 5e-6, (1, False): 5e-6, (2, True): 1e-12, (2, False): 1e-12}  # half of the last decimal [m/s²]


def one_channel(label: str = "90 Deg", values=A, volume: int = 2, **header) -> str:
    """A file of one channel; ``values`` in cm/s², or g/1000."""
    return "\n".join([*csmip_channel(label, values * (1e-3 if volume == 1 else 1.0), volume=volume, **header), ""])


def pairs_text(unit: str = "G/10") -> str:
    """Volume 1 as digitised from film: pairs of time [s] and value, without a line that declares them."""
    lines = csmip_channel("90 DEG", A / 98.1, volume=1, modern=False)
    lines[11] = f"UNITS OF UNCOR ACCEL ARE SEC AND {unit}.     MAX  =  -.200 G, AT  11.576 SEC."
    pairs = np.column_stack([0.01 * np.arange(NPTS), A / 98.1]).ravel()
    return "\n".join([*lines[:27], *in_columns(pairs, "7.3f", 10), "/&  ----------  END OF DATA", ""])


@pytest.mark.parametrize(("clock", "second"), [("03:19: 7.5", 7.5), ("03: 9:37.5", -600 + 37.5), (" 3:19: 7.5", 7.5)])
def test_a_time_is_read_with_the_blanks_that_fortran_writes(clock, second):
    text = csmip_text(2).replace("03:19:37.5", clock)
    found = read(text, "STA.V2")
    assert {component.start for component in found} == {START - 37.5 + second}


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize("modern", [True, False])
@pytest.mark.parametrize("volume", [1, 2])
def test_every_channel_comes_out_in_m_s2_with_step_direction_and_time(volume, modern, newline):
    text = csmip_text(volume, modern=modern).replace("\n", newline) + "\x1a" * 70
    found = read(text, "STA.V2" if volume == 2 else "STA.RAW")
    assert [component.name.upper() for component in found] == ["STA.90", "STA.UP", "STA.360"]
    assert [component.orientation.vertical for component in found] == [False, True, False]
    assert [component.orientation.azimuth for component in found] == [90, None, 0]
    for component, values in zip(found, (A, C, B), strict=True):
        np.testing.assert_allclose(
            component.acceleration, values * TO_M_S2[volume], rtol=0, atol=PRINTED[volume, modern]
        )
        assert component.dt == pytest.approx(0.01, rel=1e-12)
        assert component.start == (START if modern else None)  # old files have the time of triggering only
        assert component.raw == (volume == 1)
        assert component.notes == ()
    assert len({component.station for component in found}) == 1


def test_values_that_touch_are_separated_by_the_declared_format():
    values = -np.abs(A) - 10.5
    text = one_channel(values=values)
    assert "0-1" in text.split("(8f10.6)")[1][:80]
    np.testing.assert_allclose(read(text, "x.V2")[0].acceleration, values / 100, atol=1e-12)


@pytest.mark.parametrize(
    ("label", "expected"),
    [
        ("Up", (True, False, None)),
        ("Down", (True, True, None)),
        ("DWN", (True, True, None)),
        (" 90 DEG", (False, False, 90.0)),
        ("S45E", (False, False, 135.0)),
        ("LONG", (False, False, None)),
    ],
)
def test_direction_is_that_of_the_channels_line(label, expected):
    (component,) = read(one_channel(label), "x.V2")
    way = component.orientation
    assert (way.vertical, way.down, way.azimuth) == expected


def test_a_folder_of_both_volumes_pairs_each_with_its_own_vertical(tmp_path):
    for volume, name in ((1, "STA.RAW"), (2, "STA.V2")):
        (tmp_path / name).write_bytes(csmip_text(volume).encode("latin-1"))
    found = read_motions(tmp_path)
    assert not found.unusable
    assert [motion.vertical_source for motion in found.motions] == ["STA.V2 (Up)"] * 2
    (tmp_path / "motions.toml").write_text(
        '[[record]]\nfile = "STA.RAW"\nuse = true\n[[record]]\nfile = "STA.V2"\nuse = true'
    )
    both = read_motions(tmp_path).motions
    assert [motion.vertical_source for motion in both] == ["STA.RAW (Up)"] * 2 + ["STA.V2 (Up)"] * 2


def test_one_file_per_channel_is_paired_within_its_location(tmp_path):
    for number, (label, place) in enumerate(
        [("Up", "Freefield"), ("360 Deg", "Freefield"), ("Up", "Basement"), ("90 Deg", "Basement")], start=1
    ):
        text = one_channel(label, A if number % 2 else B, number=number, place=place)
        (tmp_path / f"CHAN{number:02d}.V2").write_bytes(text.encode("latin-1"))
    found = read_motions(tmp_path)
    assert [(motion.name, motion.vertical_source) for motion in found.motions] == [
        ("CHAN02", "CHAN01.V2"),
        ("CHAN04", "CHAN03.V2"),
    ]
    assert "channel 2: Freefield" in found.motions[0].notes


def test_channels_may_differ_in_length():
    text = one_channel("90 Deg", A) + one_channel("Up", C[:-3])
    assert [len(component.acceleration) for component in read(text, "x.V2")] == [NPTS, NPTS - 3]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "Response and Fourier amplitude spectra (86 periods,  .04 - 10.0 sec)   for\n" + one_channel(),
            "line 1: Volume 3, spectra; expected accelerations: take the .V2 file",
        ),
        (one_channel().replace("43 points of accel", "42 points of accel"), "line 52: found .*expected 2 values"),
        (one_channel().replace("43 points of accel", "0 points of accel"), "line 46: found .*expected a count"),
        (one_channel(unit="?"), "line 46: found .*expected a count, an interval and a unit of accel"),
        (one_channel().replace("43 points of accel", "43 points of displ"), "line 46: found .*unit of accel"),
        (one_channel().replace("(8f10.6)", "(0f10.6)"), "line 47: found .*expected numbers in equal columns"),
        (one_channel().replace("(8f10.6)", "(8f1.0)"), "line 47: found .*expected numbers in equal columns"),
        (one_channel().replace("/&", "//"), 'line 67: found "// .*expected "/&" after the declared values'),
        (one_channel() + "1.0\n", 'line 68: found "1.0"; expected "Uncorrected accelerogram data"'),
        (one_channel().replace("Station Id.", "Somewhere"), "line 6: found"),
        (one_channel().replace(f"{A[20]:10.6f}", "**********", 1), r'line 49: found "\*+"; expected a number'),
    ],
)
def test_what_cannot_be_used_is_refused_with_place_and_finding(text, message):
    with pytest.raises(InputError, match=message):
        read(text, "x.V2")


def test_pairs_of_time_and_value_are_read_whatever_the_suffix():
    for name in ("x.RAW", "x.V1"):
        (component,) = read(pairs_text(), name)
        np.testing.assert_allclose(component.acceleration, A / 100, atol=5.1e-5 * 9.81)  # printed to 1e-3 g/10


@pytest.mark.parametrize("suffix", [".V1", ".v2", ".RAW"])
def test_the_header_decides_between_agencies_that_share_a_suffix(suffix):
    texts = [csmip_text(1), csmip_text(2)]
    if suffix != ".RAW":
        texts += [cosmos_text(stage="Uncorrected"), cosmos_text(stage="Corrected")]
    for text in texts:
        assert all(not isinstance(reading, Unusable) for reading in read(text, f"x{suffix}"))
    with pytest.raises(InputError, match=r"its suffix .* says .*CSMIP"):
        read("hello\nworld\n", f"x{suffix}")


def test_obspy_gets_the_files_own_unit_and_the_codes_of_its_record(tmp_path):
    path = tmp_path / "x.V2"
    path.write_bytes(csmip_text(2).encode("latin-1"))
    stream = read_csmip_stream(str(path))
    assert [trace.id for trace in stream] == ["CI.CCC..90", "CI.CCC..UP", "CI.CCC..360"]
    np.testing.assert_allclose(stream[1].data, C, atol=1e-12)
    assert stream[0].stats.csmip.unit == "cm/sec2"
    assert stream[0].stats.csmip.station.startswith("Peñón Blanco")
    assert stream[0].stats.starttime.timestamp == START
    numbered = one_channel(station="1336", record="01336-C0165-79290.04").encode("latin-1")
    assert read_csmip_stream(io.BytesIO(numbered))[0].id == ".1336..90"


def test_a_start_is_known_where_the_recorder_has_a_clock_with_a_year_of_four_digits():
    trigger = {
        "year": "1994",
        "month": "01",
        "day": "17",
        "hour": "12",
        "minute": "31",
        "second": "2",
        "began": "Trigger",
    }
    assert volumes._start(trigger, 1.0) == datetime(1994, 1, 17, 12, 31, 3, tzinfo=UTC).timestamp()
    assert volumes._start(trigger | {"year": "94"}, 1.0) is None
    assert volumes._start(trigger, None) is None
