"""USGS SMC: values that touch, angles, unknown numbers, and the kinds that are no accelerations."""

from datetime import UTC, datetime

import numpy as np
import pytest
from fixed_column_files import NPTS, A, B, C, film_text, read, smc_text

from rockbatch.common.errors import InputError
from rockbatch.motions import read_motions
from rockbatch.motions.formats.smc import is_smc_file, parse, read_smc_stream

START = datetime(1989, 10, 18, 0, 4, 15, tzinfo=UTC).timestamp() + 0.25


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
@pytest.mark.parametrize(("digits", "rtol"), [(-32768, 5e-5), (8, 5e-8)])  # decimals of the mantissa
def test_values_that_touch_become_m_s2_with_step_azimuth_and_time(digits, rtol, newline):
    text = smc_text(digits=digits).replace("\n", newline)
    assert digits == 8 or "E+0-" in text
    (component,) = read(text, "0111a.smc")
    np.testing.assert_allclose(component.acceleration, A / 100, rtol=rtol)
    assert (component.name, component.dt, component.start) == ("0111a", 0.005, START)
    assert component.orientation.azimuth == 135
    assert not component.raw
    assert component.notes == ()


@pytest.mark.parametrize(
    ("vertical", "azimuth", "label", "expected"),
    [
        (0, -32768, "up", (True, False, None)),
        (180, -32768, "down", (True, True, None)),
        (90, 360, "360", (False, False, 0.0)),
        (90, -32768, "S62W", (False, False, 242.0)),
        (-32768, -32768, "up", (True, False, None)),
        (-32768, -32768, "down", (True, True, None)),
        (-32768, 90, "up", (True, False, None)),
    ],
)
def test_direction_is_by_the_angles_and_else_by_the_text(vertical, azimuth, label, expected):
    (component,) = read(smc_text(vertical=vertical, azimuth=azimuth, label=label), "x.smc")
    way = component.orientation
    assert (way.vertical, way.down, way.azimuth) == expected


@pytest.mark.parametrize(
    ("vertical", "azimuth", "label", "said"),
    [
        (180, 0, "UP", "Down"),
        (90, 45, "UP", "45"),
        (90, 45, "135", "45"),
        (90, 45, "N45E", ""),
        (0, 0, "UP", ""),
        (0, 0, "V", ""),
    ],
)
def test_words_of_another_direction_than_the_angles_are_remarked(vertical, azimuth, label, said):
    (component,) = read(smc_text(vertical=vertical, azimuth=azimuth, label=label), "x.smc")
    words = [f'its header says "{said}", but in words "{label}"; decided by: the first; check which is right']
    assert [finding.text for finding in component.findings] == words * bool(said)


def test_three_files_of_a_station_are_two_motions_with_their_vertical(tmp_path):
    for name, values, angles in (("a", A, (90, 360)), ("b", C, (0, -32768)), ("c", B, (90, 270))):
        text = smc_text(values, vertical=angles[0], azimuth=angles[1], label=name)
        (tmp_path / f"0111{name}.smc").write_bytes(text.encode("latin-1"))
    found = read_motions(tmp_path)
    assert [(motion.name, motion.vertical_source) for motion in found.motions] == [
        ("0111a", "0111b.smc"),
        ("0111c", "0111b.smc"),
    ]


def test_another_event_or_the_uncorrected_version_is_another_station():
    stations = {
        read(text, "x.smc")[0].station
        for text in (
            smc_text(),
            smc_text(clock=(1989, 292, 0, 4, 15, 250)),
            smc_text(title="1 UNCORRECTED ACCELEROGRAM"),
        )
    }
    assert len(stations) == 3


def test_an_evenly_sampled_uncorrected_file_is_raw():
    assert read(smc_text(title="1 UNCORRECTED ACCELEROGRAM"), "x.smc")[0].raw


@pytest.mark.parametrize(
    "clock",
    [(1989, 291, 0, 4, 0, -32768), (1989, -32768, 0, 4, 15, 250), (0, 0, 0, 0, 0, 0), (1989, 291, 25, 4, 15, 0)],
)
def test_a_clock_of_which_a_part_is_not_known_gives_no_start(clock):
    assert read(smc_text(clock=clock), "x.smc")[0].start is None


@pytest.mark.parametrize("second", [0, 59, 60])
def test_every_second_of_a_minute_gives_a_start(second):
    assert read(smc_text(clock=(1989, 291, 0, 4, second, 250)), "x.smc")[0].start == START - 15 + second


@pytest.mark.parametrize("digits", [-32768, 8])
def test_film_without_a_rate_is_pairs_of_time_and_value_on_even_steps(digits):
    times = np.cumsum([0, *np.random.default_rng(1).integers(4, 7, NPTS - 1)]) / 1000
    (component,) = read(film_text(times=times, digits=digits), "x.smc")
    assert component.raw
    assert "uneven times" in component.notes[0]
    at = np.rint(times / component.dt).astype(int)
    np.testing.assert_allclose(component.acceleration[at], A / 100, atol=5.1e-5)


def test_what_the_header_flags_or_contradicts_is_said():
    assert "flags a problem" in read(smc_text(flag=1), "x.smc")[0].notes[0]
    assert "header states a peak of" in read(smc_text(peak=980.0), "x.smc")[0].findings[0].text


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            smc_text(rate=1.7e38),
            "no sampling rate, so digitised from film: found 43 numbers; .*take the corrected file",
        ),
        (film_text(times=np.r_[0:0.2:42j, 9.0]), "film: time does not grow evenly: .*a gap is not filled"),
        (smc_text(title="3 VELOCITY"), "3 VELOCITY.*expected accelerations"),
        (smc_text(title="3 VELOCITY").replace("station =", "nowhere ="), "3 VELOCITY.*expected accelerations"),
        (smc_text(vertical=45), "line 13: inclined, 45° from the vertical"),
        (smc_text(count=40), r"line 35: found .*after the 40 values that line 14 declares"),
        (smc_text(count=999999999), "take 125000000 lines, but the file ends with line 35: it is cut"),
        (smc_text(count=-32768), "expected counts"),
        (smc_text(comments=3), "line 3[15]: "),
        (smc_text(rate=-200.0), "line 18: found a sampling rate of -200 Hz"),
        (smc_text().replace("2.0000000E+02", "2.00_0000E+02"), "line 18"),
        (smc_text().replace("station =", "nowhere ="), "line 6: found"),
    ],
)
def test_what_cannot_be_used_is_refused_with_place_and_finding(text, message):
    with pytest.raises(InputError, match=message):
        read(text, "x.smc")


def test_a_cut_file_is_never_taken_for_a_whole_one():
    whole = smc_text().rstrip()
    for length in range(whole.index("|ref"), len(whole)):
        with pytest.raises(InputError):
            read(whole[:length], "x.smc")


def test_obspy_gets_cm_s2_with_what_the_header_says(tmp_path):
    path = tmp_path / "x.smc"
    path.write_bytes(smc_text().encode("latin-1"))
    assert is_smc_file(str(path))
    (trace,) = read_smc_stream(str(path))
    np.testing.assert_allclose(trace.data, A, rtol=5e-5)
    assert trace.stats.smc.unit == "cm/s2"
    assert trace.stats.smc.station == "San José, 1295 Shafter, 42n"
    assert trace.stats.smc.event == "Loma Prieta, CA"
    assert (trace.stats.station, trace.stats.delta, trace.stats.starttime.timestamp) == ("SAF0A", 0.005, START)
    path.write_bytes(smc_text(title="3 VELOCITY").encode("latin-1"))
    with pytest.raises(InputError, match=r"x\.smc: line 1: found"):
        read_smc_stream(path)


@pytest.mark.parametrize(("rate", "dt"), [(0.1, 10.0), (0.099, None), (1e5, 1e-5), (1.01e5, None)])
def test_rates_are_those_that_the_refusal_names(rate, dt):
    if dt is None:
        with pytest.raises(InputError, match=f"found a sampling rate of {rate:g} Hz; expected 0.1 to 100000"):
            parse(smc_text(rate=rate))
    else:
        assert parse(smc_text(rate=rate))[0].dt == dt


def test_a_file_without_comments_or_of_one_value_is_whole():
    text = smc_text(comments=0)
    bare = "\n".join(line for line in text.splitlines() if not line.startswith("|")) + "\n"
    np.testing.assert_allclose(read(bare, "x.smc")[0].acceleration, A / 100, rtol=5e-5)
    assert parse(smc_text(A[:1]))[0].values == pytest.approx(A[:1], rel=5e-5)
