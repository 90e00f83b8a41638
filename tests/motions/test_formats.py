"""MiniSEED and SAC files through ObsPy, and K-NET files: units, orientation, and refusals that say what to add."""

import contextlib
import io
import pickle
import struct
from pathlib import Path

import numpy as np
import pytest
from agency_files import knet_text, moment
from motion_files import wiggle
from obspy import UTCDateTime
from waveform_files import COUNTS, START, channel_xml, station_xml, trace, write_mseed

from rockbatch.common.errors import InputError
from rockbatch.motions import ReadOptions, read_motions
from rockbatch.motions.formats import FORMATS, RecordFile, read_record, with_obspy
from rockbatch.motions.manifest_draft import write_manifest
from rockbatch.motions.sources.source import file_of


def only_reason(found) -> str:
    assert not found.motions
    (unusable,) = found.unusable
    return unusable.reason


def test_miniseed_counts_become_m_s2_by_the_station_xml_beside_it(tmp_path):
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    write_mseed(tmp_path / "z.mseed", trace("HNZ", COUNTS * 2))
    station_xml(tmp_path, channel_xml("HNN", 0.0), channel_xml("HNZ", 0.0, -90.0, value=1e5))
    (motion,) = read_motions(tmp_path).motions
    expected = (COUNTS - COUNTS.mean()) / 2e5
    np.testing.assert_allclose(motion.horizontal, expected, atol=1e-12)
    np.testing.assert_allclose(motion.vertical, 4 * expected, atol=1e-12)
    assert (motion.name, motion.dt, motion.source, motion.vertical_source) == ("n", 0.01, "n.mseed", "z.mseed")
    assert any("from StationXML" in note for note in motion.notes)
    assert any("mean over the record" in note for note in motion.notes)


@pytest.mark.parametrize(
    ("unit", "per_m_s2"),
    [
        *(
            ("M/S**2", 1.0),
            ("m/s/s", 1.0),
            ("m/s^2", 1.0),
            ("M/S**2 - Acceleration in Meters Per Second Per Second", 1.0),
        ),
        *(("cm/s**2", 1e2), ("gal", 1e2), ("nm/s**2", 1e9), ("NM/S**2", 1e9), ("um/s**2", 1e6)),
    ],
)
def test_the_input_unit_of_a_station_xml_is_understood_in_its_spellings(tmp_path, unit, per_m_s2):
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    station_xml(tmp_path, channel_xml("HNN", unit=unit, value=2e5 / per_m_s2))
    (motion,) = read_motions(tmp_path).motions
    np.testing.assert_allclose(motion.horizontal, (COUNTS - COUNTS.mean()) / 2e5, rtol=1e-9, atol=1e-12)


def test_a_vertical_channel_with_positive_dip_points_down(tmp_path):
    write_mseed(tmp_path / "all.mseed", trace("HNN"), trace("HNZ", COUNTS * 2))
    station_xml(tmp_path, channel_xml("HNN"), channel_xml("HNZ", dip=90.0))
    (motion,) = read_motions(tmp_path).motions
    assert motion.vertical is not None
    np.testing.assert_allclose(motion.vertical, -2 * motion.horizontal)
    assert any("positive down" in note for note in motion.notes)


@pytest.mark.parametrize(
    ("channel", "azimuth"),
    [
        (channel_xml("HNE", 450.0), 90.0),
        (channel_xml("HNE", 328.0), 328.0),  # of a sensor that is turned
        (channel_xml("HNE").replace("<Azimuth>0.0</Azimuth>", ""), 90.0),
        (channel_xml("HNE").replace("<Dip>0.0</Dip>", ""), 90.0),
    ],
)
def test_a_direction_is_that_of_the_station_xml_else_that_of_the_channels_code(tmp_path, channel, azimuth):
    write_mseed(tmp_path / "e.mseed", trace("HNE"))
    station_xml(tmp_path, channel)
    assert [motion.azimuth for motion in read_motions(tmp_path)] == [azimuth]


def test_a_file_of_several_channels_names_them_by_channel_id(tmp_path):
    write_mseed(tmp_path / "all.mseed", trace("HNE"), trace("HNN"), trace("HNZ", COUNTS * 2))
    found = read_motions(tmp_path, options=ReadOptions(sensitivity=1e5))
    assert [motion.name for motion in found.motions] == ["CI.LRL..HNE", "CI.LRL..HNN"]
    assert all(motion.vertical is not None for motion in found.motions)
    assert {file_of(source) for motion in found for source in motion.sources} == {"all.mseed"}


def test_counts_without_sensitivity_are_refused_with_the_remedy(tmp_path):
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    reason = only_reason(read_motions(tmp_path))
    assert "StationXML of CI.LRL" in reason
    assert "sensitivity = " in reason


@pytest.mark.parametrize(
    ("channel", "message"),
    [
        (channel_xml("HNN", end="2018-01-01"), "no epoch that covers 2019"),
        (channel_xml("HNN", unit="M/S"), "measures M/S, not an acceleration"),
        (channel_xml("HNN", dip=-35.3), "inclined (dip -35.3°): neither horizontal nor vertical"),
        (channel_xml("HNN", value=0.0), "no sensitivity"),
        (channel_xml("HNN", value=float("inf")), "no sensitivity"),
        (channel_xml("HNE"), "counts without a sensitivity"),
    ],
)
def test_a_station_xml_that_does_not_serve_says_why(tmp_path, channel, message):
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    station_xml(tmp_path, channel)
    assert message in only_reason(read_motions(tmp_path))


def test_epochs_of_a_station_xml_may_be_those_of_another_time_zone(tmp_path):
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    station_xml(tmp_path, channel_xml("HNN").replace("2599-12-31T00:00:00", "2019-07-06T02:00:00-05:00"))
    assert len(read_motions(tmp_path).motions) == 1


def test_a_broken_xml_file_costs_only_the_sensitivity(tmp_path):
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    (tmp_path / "stations.xml").write_text("<unclosed")
    assert (
        len(read_motions(tmp_path, confirmed=["*"], options=ReadOptions(unit="cm/s2", sensitivity=10.0)).motions) == 1
    )


def test_unit_and_sensitivity_can_be_stated(tmp_path):
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    options = ReadOptions(unit="cm/s2", sensitivity=10.0)
    (motion,) = read_motions(tmp_path, confirmed=["*"], options=options).motions
    np.testing.assert_allclose(motion.horizontal, (COUNTS - COUNTS.mean()) / 1000, atol=1e-12)


def test_the_clock_of_a_miniseed_recorder_is_no_ground_motion_whatever_is_stated(tmp_path):
    write_mseed(tmp_path / "all.mseed", trace("HNE"), trace("LCQ"), trace("LCE"))
    found = read_motions(tmp_path, confirmed=["*"], options=ReadOptions(unit="cm/s2"))
    assert [motion.name for motion in found.motions] == ["CI.LRL..HNE"]
    assert not found.unusable
    assert [left.reason for left in found.left_out] == [
        f"no record: {code}, the recorder's clock" for code in ("LCQ", "LCE")
    ]


def test_a_gap_costs_that_channel_and_no_other(tmp_path):
    later = trace("HNN", start=START + 60)
    write_mseed(tmp_path / "all.mseed", trace("HNE"), trace("HNN"), later)
    found = read_motions(tmp_path, confirmed=["*"], options=ReadOptions(unit="cm/s2"))
    assert [motion.name for motion in found.motions] == ["CI.LRL..HNE"]
    assert [(u.name, "gaps" in u.reason) for u in found.unusable] == [("CI.LRL..HNN", True)]


@pytest.mark.parametrize("together", [True, False])
def test_two_events_in_a_file_are_two_records_each_with_its_vertical(tmp_path, together):
    gap = 600.0  # s, between records of 5 s
    channels = {code: COUNTS * factor for code, factor in (("HNN", 1), ("HNE", 2), ("HNZ", 3))}
    traces = {
        code: [trace(code, data), trace(code, data[:400], START + gap + jitter)]
        for (code, data), jitter in zip(channels.items(), (0.0, 0.2, 0.1), strict=True)
    }
    if together:
        write_mseed(tmp_path / "all.mseed", *(one for pieces in traces.values() for one in pieces))
    else:
        for code, pieces in traces.items():
            write_mseed(tmp_path / f"{code}.mseed", *pieces)
    options = ReadOptions(unit="cm/s2", sensitivity=100.0)
    found = read_motions(tmp_path, confirmed=["*"], options=options)
    assert not found.unusable
    first, second = ("20190706T031923", "20190706T032923")
    names = [motion.name for motion in found.motions]
    assert sorted(name.rpartition(".")[2] for name in names) == [first, first, second, second]
    assert sorted(motion.npts for motion in found.motions) == [
        390,
        390,
        500,
        500,
    ]  # s: what horizontal and vertical share
    for motion in found.motions:
        assert motion.name.rpartition(".")[2] in motion.vertical_source
    turned = read_motions(tmp_path, confirmed=["*"], options=options, azimuths=(0.0, 90.0))
    assert len(turned.motions) == 4
    assert not turned.unusable
    draft = write_manifest(tmp_path, options)
    again = read_motions(tmp_path, confirmed=["*"], options=options)
    assert draft.read_text().count(f'{second}"') == 3
    assert [motion.name for motion in again.motions] == names


@pytest.mark.parametrize(("gap", "records"), [(14.0, 1), (61.0, 1), (100.0, 2)])
def test_only_a_gap_far_longer_than_the_record_lies_between_two_events(tmp_path, gap, records):
    """Records of 30 s and 10 s: three times the longer one are 90 s."""
    data = np.resize(COUNTS, 3001)
    write_mseed(tmp_path / "n.mseed", trace("HNN", data), trace("HNN", data[:1001], START + 30.0 + gap))
    found = read_motions(tmp_path, confirmed=["*"], options=ReadOptions(unit="cm/s2"))
    assert (len(found.motions), len(found.unusable)) == ((2, 0) if records == 2 else (0, 1))
    if records == 2:
        assert [motion.npts for motion in found.motions] == [3001, 1001]


def test_two_events_of_one_knet_station_are_turned_each_on_its_own(tmp_path):
    for event, minute, seed in (("A", "38", 1), ("B", "58", 2)):
        for direction, suffix in (("E-W", "EW"), ("N-S", "NS"), ("U-D", "UD")):
            text = knet_text(direction, seed=seed + 10 * (suffix == "UD"))[0].replace("19:51:38", f"19:{minute}:38")
            (tmp_path / f"TST{event}.{suffix}").write_text(text)
    found = read_motions(tmp_path, azimuths=(30.0,))
    assert [motion.name for motion in found.motions] == ["TSTA_az030", "TSTB_az030"]
    assert [motion.vertical_source for motion in found.motions] == ["TSTA.UD", "TSTB.UD"]
    assert not found.unusable


def test_a_truncated_miniseed_file_is_refused(tmp_path):
    write_mseed(tmp_path / "n.mseed", trace("HNN", np.random.default_rng(0).integers(-(2**27), 2**27, 5000)))
    whole = (tmp_path / "n.mseed").read_bytes()
    for cut, message in ((700, "the file is cut"), (4000, "damaged")):
        (tmp_path / "n.mseed").write_bytes(whole[: len(whole) - cut])
        assert message in only_reason(read_motions(tmp_path, options=ReadOptions(unit="cm/s2")))


def test_components_with_absolute_times_share_the_time_that_both_were_on(tmp_path):
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    write_mseed(tmp_path / "z.mseed", trace("HNZ", start=START + 0.5))
    (motion,) = read_motions(tmp_path, confirmed=["*"], options=ReadOptions(unit="cm/s2")).motions
    a = (COUNTS - COUNTS.mean()) / 100
    np.testing.assert_allclose(motion.horizontal, a[50:], atol=1e-12)
    np.testing.assert_allclose(motion.vertical, a[:-50], atol=1e-12)
    assert any("common span" in note for note in motion.notes)


def test_a_vertical_of_another_day_is_no_partner(tmp_path):
    write_mseed(tmp_path / "n.mseed", trace("HNN"))
    write_mseed(tmp_path / "z.mseed", trace("HNZ", start=START + 86400))
    found = read_motions(tmp_path, confirmed=["*"], options=ReadOptions(unit="cm/s2"))
    assert found.motions[0].vertical is None
    assert "without a usable horizontal" in found.unusable[0].reason


@pytest.mark.parametrize("byteorder", ["<", ">"])
def test_sac_files_are_read_in_the_stated_unit(tmp_path, byteorder):
    data = wiggle(300) + 0.02
    trace("HNE", data.astype(np.float32), rate=50.0).write(str(tmp_path / "e.sac"), format="SAC", byteorder=byteorder)
    (motion,) = read_motions(tmp_path, options=ReadOptions(unit="g"), gravity=10.0).motions
    assert motion.dt == 0.02  # not the single precision 0.0199999996 of its header
    np.testing.assert_allclose(motion.horizontal, (data - data.mean()) * 10.0, atol=1e-6)  # single precision


@pytest.mark.parametrize("start", ["2019-07-06T03:19:25.437", "1999-12-31T23:59:59.999", "2000-03-01T00:00:00.001"])
@pytest.mark.parametrize("begins", [0.0, -12.5, 3600.25])
def test_a_sac_file_starts_at_its_day_and_clock_and_b(tmp_path, start, begins):
    sent = trace("HNE", wiggle(300).astype(np.float32), UTCDateTime(start) + begins)
    sent.stats.sac = {"b": begins}  # by which its day and clock are those of ``start``
    sent.write(str(tmp_path / "e.sac"), format="SAC")
    (read,) = read_record(
        RecordFile(tmp_path / "e.sac", "e.sac", (tmp_path / "e.sac").read_bytes(), ReadOptions(unit="g"))
    )
    assert read.start == pytest.approx(UTCDateTime(start).timestamp + begins, abs=1e-5)


def test_a_number_where_sac_has_its_version_makes_no_sac_file_of_another_name(tmp_path):
    trace("HNE", wiggle(300).astype(np.float32)).write(str(tmp_path / "e.sac"), format="SAC")
    (tmp_path / "e.sac").rename(tmp_path / "e.bin")
    (unusable,) = read_motions(tmp_path, options=ReadOptions(unit="g")).unusable
    assert "not a format that rockbatch reads" in unusable.reason


@pytest.mark.parametrize(("vertical", "partner"), [("HNZ", True), ("HLZ", False), ("BNZ", False)])
def test_sac_files_of_another_instrument_of_the_station_are_no_partners(tmp_path, vertical, partner):
    for channel in ("HNE", vertical):
        trace(channel, wiggle(300).astype(np.float32)).write(str(tmp_path / f"{channel}.sac"), format="SAC")
    found = read_motions(tmp_path, confirmed=["*"], options=ReadOptions(unit="g"))
    assert [motion.vertical is not None for motion in found.motions] == [partner]


@pytest.mark.parametrize("unit", [None, "g"])
def test_the_clock_in_a_sac_file_needs_no_unit_and_no_direction(tmp_path, unit):
    trace("LCQ", wiggle(300).astype(np.float32)).write(str(tmp_path / "e.sac"), format="SAC")
    found = read_motions(tmp_path, options=ReadOptions(unit=unit))
    assert not found.unusable
    assert [left.reason for left in found.left_out] == ["no record: LCQ, the recorder's clock"]


@pytest.mark.parametrize("change", [-4, 4, -2])
def test_a_sac_file_has_as_many_samples_as_its_header_says(tmp_path, change):
    trace("HNE", wiggle(300).astype(np.float32)).write(str(tmp_path / "e.sac"), format="SAC")
    whole = (tmp_path / "e.sac").read_bytes()
    (tmp_path / "e.sac").write_bytes(whole[:change] if change < 0 else whole + b"\0" * change)
    reason = only_reason(read_motions(tmp_path, options=ReadOptions(unit="g")))
    assert f"holds {300 + change / 4:g} samples behind its header, which says 300" in reason


def test_sac_without_a_stated_unit_is_refused_with_the_remedy(tmp_path):
    trace("HNE", wiggle(300).astype(np.float32)).write(str(tmp_path / "e.sac"), format="SAC")
    assert 'unit = "g"' in only_reason(read_motions(tmp_path))


def test_knet_counts_times_scale_without_their_offset_are_m_s2(tmp_path):
    counts = knet_text()[1]
    for seed, (direction, suffix) in enumerate((("E-W", "EW"), ("U-D", "UD")), start=1):
        text = knet_text(direction, seed=seed)[0]
        (tmp_path / f"TST0031801241951.{suffix}").write_text(text)
    (motion,) = read_motions(tmp_path).motions
    expected = (counts - counts.mean()) * 7845 / 8223790 / 100
    np.testing.assert_allclose(motion.horizontal, expected, atol=1e-12)
    assert (motion.name, motion.dt) == ("TST0031801241951", 0.01)
    assert motion.start == moment(2018, 1, 24, 10, 51, 23)  # 19:51:38 in Japan, less the recorder's delay
    assert motion.vertical_source == "TST0031801241951.UD"
    assert any(note.startswith("offset 0.03") for note in motion.notes)


def test_kiknet_borehole_and_surface_are_two_stations(tmp_path):
    for direction, suffix in ((2, "EW1"), (3, "UD1"), (5, "EW2"), (6, "UD2")):
        (tmp_path / f"TST.{suffix}").write_text(knet_text(str(direction), seed=direction)[0])
    found = read_motions(tmp_path)
    assert [(m.name, m.vertical_source) for m in found.motions] == [("TST", "TST.UD2")]
    assert {left.source: left.reason.partition(",")[0] for left in found.left_out} == dict.fromkeys(
        ("TST.EW1", "TST.UD1"), "in a borehole below TST.EW2"
    )
    for suffix in ("EW2", "UD2"):
        (tmp_path / f"TST.{suffix}").unlink()
    (alone,) = read_motions(tmp_path).unusable
    assert alone.reason.startswith('"borehole" is in a borehole, and not at the surface; if it is right')
    assert "surface" in found.motions[0].notes[0]


@pytest.mark.parametrize("name", ["TST.EW.txt", "AOM003", "20180124.asc", "TST.ew.90"])
def test_knet_is_recognised_by_its_content_in_a_file_of_any_name(tmp_path, name):
    text, counts = knet_text("E-W")
    (tmp_path / name).write_text(text)
    (motion,) = read_motions(tmp_path).motions
    np.testing.assert_allclose(motion.horizontal, (counts - counts.mean()) * 7845 / 8223790 / 100, atol=1e-12)
    assert motion.azimuth == 90.0


@pytest.mark.parametrize("name", ["x.seed", "x.msd", "CI.LRL..HNN.D.2019.187", "x", "x.dat"])
def test_miniseed_is_recognised_by_its_content_in_a_file_of_any_name(tmp_path, name):
    write_mseed(tmp_path / name, trace("HNN"))
    (motion,) = read_motions(tmp_path, confirmed=["*"], options=ReadOptions(unit="cm/s2")).motions
    np.testing.assert_allclose(motion.horizontal, (COUNTS - COUNTS.mean()) / 100, atol=1e-12)
    assert "counts without a sensitivity" in only_reason(read_motions(tmp_path))


@pytest.mark.parametrize(
    "content", [b"000001D nothing else in it but digits and codes\n", b"123456M AAAAA00HNZCI \xff\xff\xff\xff"]
)
def test_what_only_begins_like_miniseed_is_not_taken_for_it(tmp_path, content):
    (tmp_path / "x").write_bytes(content * 20)
    assert only_reason(read_motions(tmp_path)).startswith("not a format that rockbatch reads")


def test_a_knet_file_shorter_than_its_header_says_is_refused_with_both_counts(tmp_path):
    (tmp_path / "TST.EW").write_text(knet_text(seconds=4)[0])
    reason = only_reason(read_motions(tmp_path))
    assert "400 values from line 18 on take 50 lines, but there are 25" in reason


SUFFIXES = sorted({suffix for known in FORMATS for suffix in known.suffixes})


@pytest.mark.parametrize("content", [b"", b"\x00" * 3000, b"hello\nworld\n", struct.pack("<400I", *range(400))])
def test_foreign_content_behind_any_suffix_is_one_line_with_a_reason(tmp_path, content):
    for suffix in SUFFIXES:
        (tmp_path / f"x{suffix}").write_bytes(content)
    found = read_motions(tmp_path, options=ReadOptions(unit="g", dt=0.01))
    assert not found.motions
    assert sorted(one.source for one in found.unusable) == sorted(f"x{suffix}" for suffix in SUFFIXES)
    assert all(one.reason and "reader failed" not in one.reason for one in found.unusable)


class _Trap:
    """Makes a file when it is unpickled."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self):
        return (Path.touch, (self.path,))


def test_a_pickle_is_never_opened_as_one_whatever_its_suffix(tmp_path):
    sprung = tmp_path / "sprung"
    # ObsPy, left to sniff, unpickles what has its module's name within the first hundred bytes
    payload = pickle.dumps(("obspy.core.stream", _Trap(sprung)), protocol=0)
    assert b"obspy.core.stream" in payload[:100]
    folder = tmp_path / "records"
    folder.mkdir()
    for suffix in (*SUFFIXES, ".pickle"):
        (folder / f"x{suffix}").write_bytes(payload)
    assert len(read_motions(folder, options=ReadOptions(unit="g", dt=0.01)).unusable) == len(SUFFIXES) + 1
    with contextlib.suppress(InputError):
        with_obspy.read_stream(payload, "MSEED")
    assert not sprung.exists()
    pickle.loads(payload)
    assert sprung.exists()  # the trap was set


def test_texts_of_a_sac_header_end_where_the_next_begins(tmp_path):
    path, sent = tmp_path / "e.sac", trace("HNE", wiggle(300).astype(np.float32))

    def read():
        sent.write(str(path), format="SAC")
        return read_record(RecordFile(path, "e.sac", path.read_bytes(), ReadOptions(unit="g")))[0]

    sent.stats.sac, sent.stats.location = {"kevnm": "SIXTEEN LETTERS."}, "10"
    found = read()
    assert found.origin.event == "Sixteen Letters. 2019"
    assert (found.sensor.network, found.sensor.location, found.station) == ("CI", "10", "CI.LRL.10.HN")
    sent.stats.station = ""
    assert read().station == ""


def test_a_blockette_beside_that_of_the_record_length_has_none(tmp_path):
    """Microseconds of the start are in a blockette of their own, whose seventh byte is no length."""
    sent = trace("HNE", (1e5 * wiggle(300)).astype(np.int32))
    sent.stats.starttime += 0.000123
    sent.write(str(tmp_path / "e.mseed"), format="MSEED")
    (motion,) = read_motions(tmp_path, options=ReadOptions(sensitivity=1e4)).motions
    assert motion.npts == 300


@pytest.mark.parametrize("exponent", [8, 12])
def test_a_seed_volume_is_read_from_its_first_data_record(exponent):
    record = io.BytesIO()
    trace("HNE", (1000 * wiggle(300)).astype(np.int32)).write(record, format="MSEED", reclen=512)
    header = f"000001V 0100094 2.4{exponent:02d}".encode().ljust(2**exponent)
    volume = header + b"000002A ".ljust(2**exponent) + record.getvalue()
    assert with_obspy.check_mseed(volume) == volume
    with pytest.raises(InputError, match="holds no whole data record"):
        with_obspy.check_mseed(header + header)
    with pytest.raises(InputError, match='records of 2\\^"31" bytes; expected 07 to 20'):
        with_obspy.check_mseed(header.replace(b"2.4" + f"{exponent:02d}".encode(), b"2.431"))
