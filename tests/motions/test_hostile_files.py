"""Files that would cost their folder: for ever to read, more memory than there is, words that rule a terminal, links out."""

import re
import struct
import time
import tracemalloc

import numpy as np
import pytest
from bounds import bounds
from damaged_files import traced
from fixed_column_files import csmip_channel
from motion_files import at2_text, wiggle, write_at2
from waveform_files import START, channel_xml, station_xml, trace, write_mseed

from rockbatch.common.errors import InputError
from rockbatch.motions import read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.formats import columns, miniseed, with_obspy
from rockbatch.motions.formats.spelled_out import spelled_out
from rockbatch.motions.formats.with_obspy import CHECKS
from rockbatch.motions.identity.common_span import on_common_samples, too_unlike
from rockbatch.motions.sources.record_file import ReadOptions


def names(found) -> list[str]:
    return [motion.name for motion in found.motions]


def sac_with(word: int, value: float) -> bytes:
    """A SAC file with another float or integer as a word of its header."""
    data = bytearray(traced("SAC"))
    data[4 * word : 4 * word + 4] = struct.pack("<f" if word < 70 else "<i", value)
    return bytes(data)


@pytest.mark.sweep(fast=1)
@pytest.mark.parametrize("value", [-1e30, pytest.param(np.inf, marks=pytest.mark.slow), np.nan])
def test_no_word_of_a_sac_header_keeps_its_reader_for_ever(tmp_path, value):
    """As other readers bring the event's longitude below 180° by subtracting 360° as often as that takes."""
    for word in range(70):  # in folders of ten: each file is compared with all others in its folder
        (tmp_path / f"{word // 10}").mkdir(exist_ok=True)
        (tmp_path / f"{word // 10}" / f"w{word:02d}_HNE.sac").write_bytes(sac_with(word, value))
    with bounds(20, 500):
        folders = [
            read_motions(folder, options=ReadOptions(unit="m/s2"), confirmed=["*"]) for folder in tmp_path.iterdir()
        ]
    unusable = [one.source for found in folders for one in found.unusable]
    assert "w00_HNE.sac" in unusable  # DELTA
    # copies of one another: where the event was is nobody's concern
    used = [one.name for found in folders for one in (*found.motions, *found.left_out)]
    assert len(used) + len(unusable) == 70
    assert {"w35_HNE", "w36_HNE"} <= {*used}


def test_a_damaged_word_of_a_sac_header_is_refused_by_its_name(tmp_path):
    for word, value in ((0, -0.01), (71, 4000), (79, -1), (85, 2), (105, 0)):
        (tmp_path / f"w{word}.sac").write_bytes(sac_with(word, value))
    reasons = {one.name: one.reason for one in read_motions(tmp_path, options=ReadOptions(unit="g")).unusable}
    for name, said in {"w0": "DELTA", "w71": "NZJDAY = 4000", "w79": "NPTS", "w85": "IFTYPE", "w105": "LEVEN"}.items():
        assert said in reasons[name]


def test_a_control_header_whose_blockette_has_no_length_ends(tmp_path):
    """ObsPy goes on by the length that it reads there: by nothing, for ever."""
    (tmp_path / "x.seed").write_bytes(b"000001V 0110000" + b"0" * 500 + traced("MSEED"))
    (tmp_path / "y.seed").write_bytes(b"000001V 0100011 2.4990" + b"0" * 500)
    with pytest.raises(InputError, match="a blockette of 0 bytes"):
        CHECKS["MSEED"]((tmp_path / "x.seed").read_bytes())
    (tmp_path / "z.mseed").write_bytes(traced("MSEED"))
    with bounds(10, 500):
        found = read_motions(tmp_path, options=ReadOptions(unit="m/s2"), confirmed=["*"])
    assert names(found) == ["z"]


def test_a_blockette_that_leads_back_is_refused(tmp_path):
    data = bytearray(traced("MSEED"))
    at = int.from_bytes(data[46:48], "big")
    data[at + 2 : at + 4] = at.to_bytes(2, "big")
    (tmp_path / "x.mseed").write_bytes(data)
    with bounds(10, 500):
        (told,) = read_motions(tmp_path, options=ReadOptions(unit="m/s2")).unusable
    assert "blockette" in told.reason


def test_the_words_of_a_reader_are_the_same_each_time(tmp_path):
    """A finished folder is known again by the reasons for which files could not be used."""
    (tmp_path / "x.mseed").write_bytes(traced("MSEED")[:128])
    (file,) = read_motions(tmp_path).unusable
    assert "refuses it" in file.reason
    assert "0x" not in file.reason


def test_every_format_that_obspy_reads_has_a_check_before():
    with pytest.raises(KeyError):
        with_obspy.read_stream(b"", "PICKLE")
    assert set(CHECKS) == {"MSEED", "KINEMETRICS_EVT"}


LINES_OF_BLANKS = [
    "a" * 150 + " " * 148 + "b",
    "a(" + " " * 296 + "b",
    "column 1: a" + " " * 280 + "b",
    "dt" + " " * 297 + "b",
]


@pytest.mark.parametrize("line", [*LINES_OF_BLANKS, "a," * 150, "acc " * 75, "from " * 55 + "dt = 1"])
def test_no_line_of_a_header_is_tried_again_from_each_of_its_signs(tmp_path, line):
    """A pattern that is takes the cube of a line's length: ten seconds for such a header."""
    (tmp_path / "x_HNE.csv").write_text(f"{line}\n" * 50 + "0.1\n-0.2\n" * 50)
    with bounds(3, 300):
        assert names(read_motions(tmp_path, options=ReadOptions(unit="m/s2", dt=0.01), confirmed=["*"])) == ["x_HNE"]


@pytest.mark.parametrize("line", LINES_OF_BLANKS)
def test_obspy_asks_whether_a_file_is_bbp_at_no_cost(line):
    with bounds(2, 300):
        assert not columns.is_bbp(b"#" + line.replace(" ", " " * 12).encode())


def test_touching_numbers_are_parted_in_one_way_only(tmp_path):
    """Of ".11.1" either number may have the second 1: thirty of them are a thousand million ways to fail."""
    (tmp_path / "x.csv").write_text("1.0 2.0\n" * 5 + "1.1-1" + ".11" * 60 + "x\n")
    with bounds(5, 300):
        (file,) = read_motions(tmp_path).unusable
    assert "line 6" in file.reason


def test_a_file_of_more_pieces_than_a_network_has_is_refused(tmp_path, monkeypatch):
    """Each is a component, which is compared with all others of its folder."""
    monkeypatch.setattr(miniseed, "_MOST_PIECES", 3)
    write_mseed(tmp_path / "x.mseed", *(trace("HNN", start=START + 1e5 * day) for day in range(4)))
    write_mseed(tmp_path / "y.mseed", *(trace("HNN", start=START + 1e5 * day) for day in range(3)))
    found = read_motions(tmp_path, options=ReadOptions(unit="m/s2"), confirmed=["*"])
    assert [(file.source, file.reason) for file in found.unusable] == [
        ("x.mseed", "holds 4 pieces of channels; at most 3 are read: divide it by stations")
    ]
    assert found.motions


@pytest.mark.parametrize("dt", ["1e200", "10.", "1E-7"])
def test_an_interval_that_no_recorder_has_costs_its_file_only(tmp_path, dt):
    write_at2(tmp_path, "bad000.AT2", wiggle(), dt=dt)
    write_at2(tmp_path, "badUP.AT2", wiggle(seed=3), dt=dt)
    write_at2(tmp_path, "good000.AT2", wiggle(seed=2))
    with bounds(10, 500):
        found = read_motions(tmp_path)
    assert names(found) == ["good000"]
    assert {one.name for one in found.unusable} == {"bad000", "badUP"}
    assert all("1e-05 to 1 s" in one.reason for one in found.unusable)


@pytest.mark.parametrize("key", ["dt = 1e200", "dt = 1e-9"])
def test_a_manifest_states_no_such_interval(tmp_path, key):
    write_at2(tmp_path, "a000.AT2", wiggle())
    (tmp_path / "motions.toml").write_text(f'[[record]]\nfile = "a000.AT2"\n{key}\n')
    with pytest.raises(InputError, match="1e-05 to 1 s"):
        read_motions(tmp_path)


def test_a_scale_that_takes_a_record_beyond_all_numbers_costs_this_record_only(tmp_path, monkeypatch):
    monkeypatch.setattr("rockbatch.motions.formats.HUGE", 1e10)
    write_at2(tmp_path, "a000.AT2", wiggle())
    write_at2(tmp_path, "b000.AT2", wiggle(seed=2))
    (tmp_path / "motions.toml").write_text('[[record]]\nfile = "a000.AT2"\nscale = 1e15\n')
    found = read_motions(tmp_path)
    assert names(found) == ["b000"]
    assert "beyond 1e+10 m/s²" in found.unusable[0].reason


@pytest.mark.parametrize("dt", [1e-5, 2e-5])
def test_a_vertical_of_a_far_finer_step_is_not_used(tmp_path, dt):
    """A grid of the finer step over the whole of the coarser record would be a thousand times its size."""
    write_at2(tmp_path, "a000.AT2", wiggle(60_000), dt="0.02", title="X, 1/17/1994, S, 000")
    write_at2(tmp_path, "aUP.AT2", wiggle(200, 2), dt=f"{dt:g}", title="X, 1/17/1994, S, UP")
    with bounds(20, 300):
        found = read_motions(tmp_path, confirmed=["*"])
    assert names(found) == ["a000"]
    assert found.motions[0].lacks_vertical
    assert [one.reason for one in found.unusable] == [f"dt = {dt:g} s beside 0.02 s of a000, more than 20 times apart"]
    with bounds(20, 300):
        turned = read_motions(tmp_path, azimuths=(45.0,))
    assert not turned.motions


def test_a_record_of_more_samples_than_a_day_has_is_refused(tmp_path, monkeypatch):
    write_at2(tmp_path, "a000.AT2", wiggle(300))
    write_at2(tmp_path, "b000.AT2", wiggle(100, 2))
    for module in ("formats", "formats.at2", "identity.common_span"):
        monkeypatch.setattr(f"rockbatch.motions.{module}.MOST_SAMPLES", 200)
    (tmp_path / "c_HNE.csv").write_text("acc [g]\n" + "".join(f"{a:.5f}\n" for a in wiggle(300, 3)))
    found = read_motions(tmp_path, options=ReadOptions(dt=0.01))
    assert names(found) == ["b000"]
    assert ["200" in one.reason for one in found.unusable] == [True, True]


def test_components_whose_common_samples_would_be_too_many_are_not_brought_together(tmp_path, monkeypatch):
    monkeypatch.setattr("rockbatch.motions.identity.common_span.MOST_SAMPLES", 250)
    write_at2(tmp_path, "a000.AT2", wiggle(200), dt="0.02", title="X, 1/17/1994, S, 000")
    write_at2(tmp_path, "aUP.AT2", wiggle(400, 2), dt="0.01", title="X, 1/17/1994, S, UP")
    found = read_motions(tmp_path, confirmed=["*"])
    assert [motion.vertical for motion in found.motions] == [None]
    assert "more than 250 common samples" in found.unusable[0].reason


@pytest.mark.parametrize(
    ("first", "second", "fit"),
    [
        ((0.01, 251), (0.02, 126), True),  # 2.5 s
        ((0.01, 252), (0.02, 127), False),
        ((0.01, 9), (0.02, 900), True),
        ((0.01, 900), (0.02, 9), True),
        ((0.01, 9), (0.2, 9), True),
        ((0.01, 9), (0.201, 9), False),
    ],
)
def test_the_shorter_component_and_the_finer_step_decide_how_many_samples_are_common(monkeypatch, first, second, fit):
    monkeypatch.setattr("rockbatch.motions.identity.common_span.MOST_SAMPLES", 250)
    components = [Component("c", dt, np.zeros(npts)) for dt, npts in (first, second)]
    assert [too_unlike(*pair) == "" for pair in (components, components[::-1])] == [fit, fit]


@pytest.mark.parametrize("late", [0.0, 0.013, 0.5, -0.013])
@pytest.mark.parametrize("steps", [(0.02, 0.03), (0.03, 0.02), (0.02, 0.02)])
def test_components_that_are_the_time_itself_are_the_same_on_common_samples(steps, late):
    starts = (0.0, late)
    parts = [
        Component("c", dt, start + dt * np.arange(200), start=start) for dt, start in zip(steps, starts, strict=True)
    ]
    common = on_common_samples(*parts, ("one", "two"))
    np.testing.assert_allclose(common.first, common.second, atol=1e-12)
    assert common.first[0] == pytest.approx(max(starts), abs=common.dt)
    for note in common.notes:
        if "interpolated" in note:
            of_steps = re.findall(r"([\d.]+) s (one|two)", note)
            assert [(float(dt), name) for dt, name in of_steps] == [(steps[0], "one"), (steps[1], "two")]


def test_a_common_span_is_built_where_both_are_and_nowhere_else():
    """Ten samples at the end of a long record take memory for ten samples."""
    from rockbatch.motions.labels.orientation import Orientation

    long = Component("h", 0.01, wiggle(10**6), Orientation("000", azimuth=0.0), start=1e9)
    short = Component("v", 0.005, wiggle(200, 2), Orientation("UP", vertical=True), start=1e9 + 5000.0025)
    tracemalloc.start()
    try:
        common = on_common_samples(long, short, ("horizontal", "vertical"))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert 195 <= len(common.first) == len(common.second) <= 200
    assert common.begins == pytest.approx((5000.005, 0.0025), abs=1e-6)
    assert peak < 10e6 + 8 * 10**6  # the indices of the long one's samples, once


def test_a_large_file_takes_a_few_times_its_size():
    """One with all its words as Python's objects takes 36 times as much."""
    from pathlib import Path

    from rockbatch.motions.formats import read_record
    from rockbatch.motions.sources.record_file import RecordFile

    small, data = (at2_text(wiggle(number), number="{:15.7E}".format).encode() for number in (100, 50_000))
    read_record(RecordFile(Path("x000.AT2"), "x000.AT2", small))  # what is loaded once
    tracemalloc.start()
    try:
        (found,) = read_record(RecordFile(Path("x000.AT2"), "x000.AT2", data))
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert isinstance(found, Component)
    assert len(found.acceleration) == 50_000
    assert peak < 15 * len(data) + 2**20


ESCAPE = "\x1b]0;owned\x07\x1b[31m"


def test_words_of_a_header_come_no_further_than_the_reader(tmp_path):
    """A vertical without a horizontal is told with its station's words; a label stands in its name."""
    text = "\n".join(csmip_channel("Up", wiggle(50), volume=2, number=1, place=f"Ground {ESCAPE}")) + "\n"
    (tmp_path / "x.V2").write_text(text)
    write_at2(tmp_path, "b.AT2", wiggle(), title=f"Ev{ESCAPE}ent, 1/17/1994, Sta\x7ftion\u009b5m, 21\x1b[31m")
    write_at2(tmp_path, "c\x1b[2J000.AT2", wiggle(seed=4))
    found = read_motions(tmp_path)
    texts = repr([vars(one) for one in (*found.motions, *found.unusable, *found.left_out)])
    shown = [*(str(v) for one in (*found.unusable, *found.left_out) for v in vars(one).values())]
    shown += [word for motion in found.motions for word in (motion.name, motion.source, *motion.notes)]
    assert len(found.unusable) >= 1
    assert "owned" in texts
    assert not any(ord(sign) < 32 or 127 <= ord(sign) < 160 for text in shown for sign in text)


def test_station_xml_is_not_followed_out_of_the_folder(tmp_path):
    outside = tmp_path / "outside"
    outside.mkdir()
    station_xml(outside, channel_xml("HNN"))
    records = tmp_path / "records"
    (records / "below").mkdir(parents=True)
    write_mseed(records / "below" / "x.mseed", trace("HNN"))
    (records / "below" / "stations.xml").symlink_to(outside / "stations.xml")
    found = read_motions(records)
    assert not found.motions
    reasons = {one.source: one.reason for one in found.unusable}
    assert "stations.xml: a link that leads out of the folder" in reasons["below/x.mseed"]
    assert "a link that leads out" in reasons["below/stations.xml"]
    station_xml(records, channel_xml("HNN"))
    (records / "below" / "stations.xml").unlink()
    (records / "below" / "stations.xml").symlink_to(records / "stations.xml")
    assert names(read_motions(records)) == ["x"]


@pytest.mark.slow
def test_a_stray_xml_costs_no_record_whatever_it_is(tmp_path, monkeypatch):
    station_xml(tmp_path, channel_xml("HNN"))
    write_mseed(tmp_path / "x.mseed", trace("HNN"))
    (tmp_path / "a.xml").write_text('<?xml version="1.0" encoding="no-such-thing"?><a/>')
    (tmp_path / "b.xml").write_bytes(b"\xff\xfe\x00")
    (tmp_path / "c.xml").write_text('<?xml version="1.0" encoding="utf-32"?><a/>')
    (tmp_path / "d.xml").write_text("<FDSNStationXML>" + "<a>" * 20_000)
    entities = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * 10}">' for i in range(1, 12))
    (tmp_path / "e.xml").write_text(f'<!DOCTYPE a [<!ENTITY e0 "ha">{entities}]><FDSNStationXML>&e11;</FDSNStationXML>')
    with bounds(10, 500):
        assert names(read_motions(tmp_path)) == ["x"]


def test_station_xml_is_read_up_to_a_stated_size_and_no_tree_is_built(tmp_path, monkeypatch):
    from rockbatch.motions.sources import stationxml

    write_mseed(tmp_path / "x.mseed", trace("HNN"))
    station_xml(tmp_path, "<abc/>" * 30_000, channel_xml("HNN"))
    tracemalloc.start()
    try:
        beside = stationxml.Inventories([(tmp_path / "stations.xml", "stations.xml", "")])
        assert len(beside.epochs_of("CI.LRL..HNN")) == 1
        assert tracemalloc.get_traced_memory()[1] < 2**20  # of a file of 0.2 MB, whose tree would take 2.5
    finally:
        tracemalloc.stop()
    assert names(read_motions(tmp_path)) == ["x"]
    monkeypatch.setattr(stationxml, "LARGEST", 2**20)
    station_xml(tmp_path, "<abc/>" * 200_000, channel_xml("HNN"))
    (told,) = read_motions(tmp_path).unusable
    assert "stations.xml: larger than 1 MiB" in told.reason


@pytest.mark.parametrize("digits", [b"xx", b"99", b"1.", b"  "])
def test_a_seed_volume_whose_records_have_no_length_is_refused_by_what_it_says(digits):
    volume = b"000001V 0100023 2.4" + digits + b"0" * 500
    with pytest.raises(InputError, match="bytes; expected 07 to 20") as refused:
        CHECKS["MSEED"](volume)
    assert f'2^"{digits.decode()}"' in str(refused.value)


def test_a_column_described_by_a_repeated_word_is_read_in_proportion_to_its_length():
    line = "column 1: " + "acc " * 3000
    started = time.process_time()
    assert spelled_out(line) == [line]
    assert time.process_time() - started < 0.2  # s; 1 ms, and 2 s if it grew with the square
