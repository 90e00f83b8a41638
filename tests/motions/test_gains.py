"""Which gain applies: all StationXML that covers a record is asked, and sensors side by side are compared."""

import math
import re
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np
import pytest
from motion_files import wiggle
from waveform_files import channel_xml, station_xml, trace, write_mseed

from rockbatch.common.errors import InputError, UnusableRecord
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.component import Component, Sensor
from rockbatch.motions.identity.colocated import with_gains_compared
from rockbatch.motions.labels.orientation import Orientation
from rockbatch.motions.manifest_draft import draft
from rockbatch.motions.sources.stationxml import Channel, contradiction

RECORD = "n.mseed"


def xml_in(path, *channels: str, attributes: str = "") -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    station_xml(path.parent, *channels)
    text = (path.parent / "stations.xml").read_text()
    (path.parent / "stations.xml").unlink()
    path.write_text(text.replace('<Station code="LRL"', f'<Station code="LRL" {attributes}'))


def pga(folder, **given) -> float:
    (motion,) = read_motions(folder, **given).motions
    return motion.pga


def reason(folder, **given) -> str:
    (unusable,) = read_motions(folder, **given).unusable
    return unusable.reason


def staged(value: float, *gains: float) -> str:
    stages = "".join(f"<Stage><StageGain><Value>{gain}</Value></StageGain></Stage>" for gain in gains)
    return channel_xml("HNN", value=value).replace("</Response>", f"{stages}</Response>")


@pytest.fixture
def folder(tmp_path):
    write_mseed(tmp_path / RECORD, trace("HNN"))
    return tmp_path


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (channel_xml("HNN"), channel_xml("HNN", value=5e5)),
        (channel_xml("HNN"), channel_xml("HNN", value=2e5, unit="CM/S**2")),
        (channel_xml("HNN"), channel_xml("HNN", value=-2e5)),
        (channel_xml("HNN"), channel_xml("HNN", unit="M/S")),
        (channel_xml("HNN", end="2020-01-01"), channel_xml("HNN", value=2.1e5)),
    ],
)
@pytest.mark.parametrize("files", [("one.xml", "one.xml"), ("a.xml", "b.xml"), ("a.xml", "below/b.xml")])
def test_two_gains_that_cover_a_record_hold_it_back_and_both_are_named(folder, first, second, files):
    if files[0] == files[1]:
        xml_in(folder / files[0], first, second)
    else:
        xml_in(folder / files[0], first)
        xml_in(folder / files[1], second)
    why = reason(folder)
    for words in ("200000 counts per M/S**2", *files, "epoch 2017-11-15T19:20:00 to"):
        assert words in why
    assert why.count("counts per") == 3


def test_equal_gains_of_several_epochs_and_files_are_one(folder):
    xml_in(folder / "a.xml", channel_xml("HNN"), channel_xml("HNN", value=2.0001e5))
    once = pga(folder)
    xml_in(folder / "b.xml", channel_xml("HNN", value=2e3, unit="CM/S**2"))
    assert pga(folder) == once


def test_an_epoch_that_begins_within_the_record_is_asked_too_and_one_after_it_is_not(folder):
    before = channel_xml("HNN")
    later = channel_xml("HNN", value=5e5).replace("2017-11-15T19:20:00", "2019-07-06T03:19:25")
    xml_in(folder / "a.xml", before, later.replace("03:19:25", "03:20:25"))
    assert pga(folder) > 0
    xml_in(folder / "a.xml", before, later)
    assert "epoch 2019-07-06T03:19:25 to now" in reason(folder)


def test_a_channel_without_dates_has_the_epoch_of_its_station(folder):
    undated = channel_xml("HNN", value=5e5).replace('startDate="2017-11-15T19:20:00" endDate="2599-12-31T00:00:00"', "")
    xml_in(folder / "old.xml", undated, attributes='startDate="2001-01-01" endDate="2016-01-01"')
    xml_in(folder / "new.xml", channel_xml("HNN"))
    assert pga(folder) == pytest.approx(np.abs(trace("HNN").data - trace("HNN").data.mean()).max() / 2e5)


@pytest.mark.parametrize("turn", [1, -1])
def test_each_gain_stands_beside_the_file_that_states_it(folder, turn):
    for file, value in zip(("a.xml", "b.xml")[::turn], (2e5, 5e5), strict=True):
        xml_in(folder / file, channel_xml("HNN", value=value))
    stated = re.findall(r"(\d+) counts per M/S\*\*2 \((.)\.xml, epoch", reason(folder))
    assert sorted(stated) == [("200000", "ab"[::turn][0]), ("500000", "ab"[::turn][1])]


@pytest.mark.parametrize("turn", [1, -1])
@pytest.mark.parametrize(
    ("first", "second", "agree"),
    [
        ({}, {"sensitivity": 2e5 * 1.0009}, True),
        ({}, {"sensitivity": 2e5 * 1.0012}, False),
        ({}, {"sensitivity": 2e3, "unit": "CM/S**2"}, True),
        ({"unit": "M/S"}, {"unit": "M/S"}, True),
        ({"unit": "M/S"}, {"unit": "M/S", "sensitivity": 2e5 * 1.0001}, False),
        ({}, {"stages": 2e5 * 1.049}, True),
        ({}, {"stages": 2e5 * 0.951}, True),
        ({}, {"stages": 2e5 * 1.051}, False),
        ({}, {"stages": 2e5 * 0.949}, False),
        ({}, {"dip": 0.9}, True),
        ({}, {"dip": -1.1}, False),
        ({}, {"dip": None, "azimuth": 90.0}, True),
        ({}, {"azimuth": None}, True),
        ({}, {"azimuth": 359.1}, True),
        ({}, {"azimuth": 358.9}, False),
        ({"dip": 79.0}, {"dip": 79.0, "azimuth": 90.0}, False),
        ({"dip": -81.0}, {"dip": -81.0, "azimuth": 90.0}, True),
    ],
)
def test_epochs_agree_within_the_limits_of_gains_and_directions(first, second, agree, turn):
    channel = Channel("CI.LRL..HNN", 0.0, math.inf, 2e5, "M/S**2", azimuth=0.0, dip=0.0)
    assert (contradiction([replace(channel, **first), replace(channel, **second)][::turn]) == "") == agree


@pytest.mark.parametrize(
    ("dates", "covers"),
    [
        ("", True),
        ('startDate="2019-07-06"', True),
        ('startDate="2019-07-07"', False),
        ('endDate="2019-07-07"', True),
        ('endDate="2019-07-06"', False),
        ('startDate="2019-07-06T05:19:00+02:00"', True),
        ('startDate="2019-07-05T21:00:00-08:00"', False),
    ],
)
def test_an_epoch_is_open_at_an_end_that_has_no_date(folder, dates, covers):
    dated = 'startDate="2017-11-15T19:20:00" endDate="2599-12-31T00:00:00"'
    xml_in(folder / "a.xml", channel_xml("HNN").replace(dated, dates))
    assert len(read_motions(folder)) == int(covers)


@pytest.mark.parametrize(
    ("start", "end", "epoch"),
    [
        (datetime(2010, 1, 2), datetime(2012, 3, 4, 5, 6, 7), "2010-01-02 to 2012-03-04T05:06:07"),
        (datetime(2010, 1, 2, 3), datetime(2599, 12, 31), "2010-01-02T03:00:00 to now"),
        (None, None, "… to now"),
    ],
)
def test_an_epoch_is_named_by_its_days_with_a_clock_where_it_is_not_midnight(start, end, epoch):
    first, last = (time.replace(tzinfo=UTC).timestamp() if time else math.inf for time in (start, end))
    assert Channel("", first, last, None, "", None, None, file="a.xml").named == f"a.xml, epoch {epoch}"


def test_epochs_that_point_elsewhere_contradict_each_other(folder):
    xml_in(folder / "a.xml", channel_xml("HNN", 0.0), channel_xml("HNN", 180.0))
    assert "azimuth 0°, dip 0° (a.xml" in reason(folder)
    assert "azimuth 180°" in reason(folder)


def test_a_sensitivity_that_its_own_stages_contradict_is_held_back(folder):
    xml_in(folder / "a.xml", staged(2e5, 0.5, 4e5, 1.0))
    assert pga(folder) > 0
    xml_in(folder / "a.xml", staged(2e5, 0.5, 1e5, 1.0))
    assert "50000 as the product of its stages' gains" in reason(folder)


def test_what_a_study_or_manifest_states_decides_between_two_gains(folder):
    xml_in(folder / "a.xml", channel_xml("HNN"), channel_xml("HNN", value=5e5))
    assert "# sensitivity =   # counts per m/s²" in draft(folder)
    by_study = pga(folder, options=ReadOptions(sensitivity=5e5))
    (folder / "motions.toml").write_text(f'[[record]]\nfile = "{RECORD}"\nsensitivity = 5e5\n')
    assert pga(folder) == by_study
    (folder / "motions.toml").write_text(f'[[record]]\nfile = "{RECORD}"\nsensitivity = 1e5\n')
    assert pga(folder) == pytest.approx(5.0 * by_study)
    (folder / "a.xml").unlink()
    assert pga(folder) == pytest.approx(5.0 * by_study)


def test_a_sensitivity_for_a_file_that_has_no_counts_is_refused(tmp_path):
    (tmp_path / "x_N.txt").write_text("# t(s) N(g)\n0.00 0.1\n0.01 -0.1\n0.02 0.1\n")
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x_N.txt"\nsensitivity = 5e5\n')
    assert "write scale = … instead" in reason(tmp_path)
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "x_N.txt"\nsensitivity = 0\n')
    with pytest.raises(InputError, match="sensitivity"):
        read_motions(tmp_path)


def test_the_table_of_records_names_file_epoch_and_gain(folder):
    xml_in(folder / "meta" / "LRL.xml", channel_xml("HNN"))
    (row,) = read_motions(folder).table()["processing"]
    assert "200000 counts per M/S**2 from StationXML meta/LRL.xml, epoch 2017-11-15T19:20:00 to now" in row


@pytest.mark.parametrize("places", [("waveforms", "stations"), ("data/wave", "resp"), (".", "a/b"), ("x/y/z", ".")])
def test_station_xml_is_found_anywhere_in_the_folder_that_is_read(tmp_path, places):
    records = tmp_path / places[0]
    records.mkdir(parents=True, exist_ok=True)
    write_mseed(records / RECORD, trace("HNN"))
    xml_in(tmp_path / places[1] / "CI.LRL.xml", channel_xml("HNN"))
    assert len(read_motions(tmp_path)) == 1
    assert len(read_motions([records, tmp_path / places[1]])) == 1


def test_a_mass_download_is_read_by_the_names_that_its_files_have(tmp_path):
    (tmp_path / "waveforms").mkdir()
    for seed, channel in enumerate(("HNN", "HNE", "HNZ", "HHN")):
        counts = np.round(2e6 * wiggle(500, seed)).astype(np.int32)
        name = f"CI.LRL..{channel}__20190706T031923Z__20190706T032023Z.mseed"
        write_mseed(tmp_path / "waveforms" / name, trace(channel, counts))
    directions = (("HNN", 0.0, 0.0), ("HNE", 90.0, 0.0), ("HNZ", 0.0, -90.0))
    xml_in(tmp_path / "stations" / "CI.LRL.xml", *(channel_xml(*direction) for direction in directions))
    found = read_motions(tmp_path)
    assert [(motion.azimuth, motion.vertical is not None) for motion in found] == [(90.0, True), (0.0, True)]
    assert [(one.station, one.kind) for one in found.unusable] == [("LRL", UnusableRecord)]


def two_sensors(folder, factor: float, noise: float = 0.0, **changed) -> None:
    rng = np.random.default_rng(1)
    for location, times in (("00", 1.0), ("10", factor)):
        samples = wiggle(500)
        samples = times * (samples + noise * np.abs(samples).max() * rng.standard_normal(500))
        sensor = trace("HNN", (1e6 * samples).astype(np.int32))
        sensor.stats.location = location
        for key, value in changed.items() if location == "10" else ():
            setattr(sensor.stats, key, value)
        write_mseed(folder / f"{location}.mseed", sensor)


@pytest.mark.parametrize(("factor", "noise"), [(0.25, 0.0), (2.0, 0.02), (-4.0, 0.01)])
def test_sensors_side_by_side_that_differ_by_a_factor_are_held_back(tmp_path, factor, noise):
    two_sensors(tmp_path, factor, noise)
    stated = ReadOptions(sensitivity=1e5)
    found = read_motions(tmp_path, options=stated)
    assert len(found.unusable) == 2
    assert all("one of their gains is wrong" in one.reason for one in found.unusable)
    assert "10.mseed, of another sensor" in found.unusable[0].reason
    assert "leave out the wrong one by use = false in motions.toml" in found.unusable[0].reason
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "10.mseed"\nuse = false\n')
    (motion,) = read_motions(tmp_path, options=stated).motions
    assert not motion.findings[1:]


@pytest.mark.parametrize(("azimuth", "factor", "wrong"), [(0.0, -1.0, True), (180.0, 1.0, True), (180.0, -1.0, False)])
def test_sensors_side_by_side_of_opposite_sign_are_held_back(tmp_path, azimuth, factor, wrong):
    two_sensors(tmp_path, factor, noise=0.01)
    channels = channel_xml("HNN"), channel_xml("HNN", azimuth)
    located = (
        c.replace('locationCode=""', f'locationCode="{code}"') for c, code in zip(channels, ("00", "10"), strict=True)
    )
    station_xml(tmp_path, *located)
    found = read_motions(tmp_path)
    assert ["one of their signs is wrong" in one.reason for one in found.unusable] == [True, True] * wrong
    assert len(found) == (0 if wrong else 2)


@pytest.mark.parametrize("factor", [1.0, -1.0, 4.0])
def test_sensors_side_by_side_with_one_motion_under_two_azimuths_are_held_back(tmp_path, factor):
    two_sensors(tmp_path, factor, noise=0.01, channel="HNE")
    found = read_motions(tmp_path, options=ReadOptions(sensitivity=1e5))
    assert ["one of their azimuths is wrong" in one.reason for one in found.unusable] == [True, True]


@pytest.mark.parametrize(
    ("down", "factor", "agree"), [(False, 1.0, True), (False, -1.0, False), (True, 1.0, False), (True, -1.0, True)]
)
def test_verticals_side_by_side_are_compared_as_positive_up(down, factor, agree):
    def sensor(location: str, samples: np.ndarray, down: bool) -> Component:
        way = Orientation("Z", vertical=True, down=down)
        return Component(location, 0.01, samples, way, start=1.5e9, sensor=Sensor("LRL", "CI", location))

    both = sensor("00", wiggle(500), False), sensor("10", factor * wiggle(500), down)
    assert [len(component.findings) for component in with_gains_compared(both)] == [int(not agree)] * 2


@pytest.mark.parametrize(
    ("factor", "noise", "changed"),
    [
        (1.05, 0.0, {}),
        (4.0, 0.5, {}),
        (4.0, 0.0, {"station": "OTHER"}),
        (4.0, 0.0, {"channel": "HN1"}),
        (4.0, 0.0, {"starttime": trace("HNN").stats.starttime + 3600}),
    ],
)
def test_sensors_that_agree_or_recorded_something_else_are_not(tmp_path, factor, noise, changed):
    two_sensors(tmp_path, factor, noise, **changed)
    assert len(read_motions(tmp_path, options=ReadOptions(sensitivity=1e5))) == 2


def test_a_negative_sensitivity_is_remarked(tmp_path):
    write_mseed(tmp_path / "x.mseed", *(trace(channel) for channel in ("HNN", "HNE")))
    station_xml(tmp_path, channel_xml("HNN", value=-2e5), channel_xml("HNE", 90.0))
    reversed_, upright = read_motions(tmp_path).motions
    np.testing.assert_allclose(reversed_.horizontal, -upright.horizontal)
    assert [any("negative" in finding.text for finding in motion.findings) for motion in (reversed_, upright)] == [
        True,
        False,
    ]


def test_a_negative_sensitivity_that_the_study_states_is_not(tmp_path):
    write_mseed(tmp_path / "x.mseed", *(trace(channel) for channel in ("HNN", "HNE")))
    found = read_motions(tmp_path, options=ReadOptions(sensitivity=-2e5))
    assert not any("negative" in finding.text for motion in found for finding in motion.findings)
